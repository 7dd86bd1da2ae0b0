#include "statistics.h"

#include "figures.h"

#include <stdexcept>

namespace brume
{

nlohmann::ordered_json parse_statistics(const ComparisonEntry& entry)
{
  return parse_object(entry.statistics, entry.mapper);
}

nlohmann::ordered_json parse_object(const std::string& text, const std::string& name)
{
  using Json = nlohmann::ordered_json;
  if (text.empty())
  {
    return Json::object();
  }
  // The statistics may quote a file's name, which need not be UTF-8.
  Json json = Json::parse(valid_utf8(text), nullptr, false);
  if (!json.is_object())
  {
    throw std::invalid_argument("statistics of " + valid_utf8(name) +
      ": not a JSON object: pass what the mapper reports, or nothing");
  }
  return json;
}

}
