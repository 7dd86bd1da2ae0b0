#include "comparison_json.h"

#include "difference_picture.h"
#include "figures.h"
#include "headline.h"
#include "json_parts.h"
#include "statistics.h"

#include <nlohmann/json.hpp>

namespace brume
{

namespace
{

using Json = nlohmann::ordered_json;

Json entry_json(const ComparisonEntry& entry)
{
  Json json{ { "mapper", valid_utf8(entry.mapper) }, { "title", valid_utf8(entry.title) },
    { "class", text_or_null(entry.class_name) }, { "skipped", text_or_null(entry.skipped) } };
  if (!entry.skipped.empty())
  {
    return json;
  }
  json["left_out"] = Json::array();
  for (const std::string& name : entry.left_out)
  {
    json["left_out"].push_back(valid_utf8(name));
  }
  json["seconds"] = seconds_json(entry.timing);
  json["errors_against_truth"] = errors_json(entry.against_truth);
  json["errors_against_reference"] =
    entry.against_reference ? errors_json(*entry.against_reference) : Json(nullptr);
  Json contributions = Json::array();
  for (const Contribution& contribution : entry.contributions)
  {
    contributions.push_back({ { "name", valid_utf8(contribution.name) },
      { "explanation", valid_utf8(contribution.explanation) },
      { "errors", errors_json(contribution.errors) } });
  }
  json["contributions"] = contributions;
  json["statistics"] = parse_statistics(entry);
  return json;
}

}

std::string to_json(const Comparison& comparison)
{
  Json entries = Json::array();
  std::vector<ImageErrors> drawn;
  for (const ComparisonEntry& entry : comparison.entries)
  {
    entries.push_back(entry_json(entry));
    if (entry.skipped.empty())
    {
      drawn.push_back(entry.against_truth);
    }
  }
  const Json json{ { "format", "brume-compare" }, { "version", 1 },
    { "headline", valid_utf8(headline(comparison)) },
    { "command_line", text_or_null(comparison.command_line) },
    { "date", text_or_null(comparison.date) }, { "scene", scene_json(comparison.scene) },
    { "subject_mapper", text_or_null(comparison.subject_mapper) },
    { "reference_mapper", text_or_null(comparison.reference_mapper) },
    { "difference_gain", shared_gain(drawn) },
    { "display_curve",
      comparison.display_curve == DisplayCurve::Srgb ? "srgb" : "identity" },
    { "exposure", number(comparison.exposure) },
    { "entries", entries },
    { "truth", truth_json(comparison.truth) }, { "machine", machine_json(comparison.machine) } };
  return json.dump(2) + "\n";
}

}
