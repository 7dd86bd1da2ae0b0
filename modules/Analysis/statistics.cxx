#include "statistics.h"

#include "figures.h"

#include <stdexcept>

namespace brume
{

nlohmann::ordered_json parse_statistics(const ComparisonEntry& entry)
{
  using Json = nlohmann::ordered_json;
  if (entry.statistics.empty())
  {
    return Json::object();
  }
  // The statistics may quote a file's name, which need not be UTF-8.
  Json json = Json::parse(valid_utf8(entry.statistics), nullptr, false);
  if (!json.is_object())
  {
    throw std::invalid_argument("statistics of " + valid_utf8(entry.mapper) +
      ": not a JSON object: pass what the mapper reports, or nothing");
  }
  return json;
}

}
