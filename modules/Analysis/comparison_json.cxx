#include "comparison_json.h"

#include "difference_picture.h"
#include "figures.h"
#include "headline.h"
#include "statistics.h"

#include <nlohmann/json.hpp>

#include <cmath>

namespace brume
{

namespace
{

using Json = nlohmann::ordered_json;

Json number(double value)
{
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json text_or_null(const std::string& text)
{
  return text.empty() ? Json(nullptr) : Json(valid_utf8(text));
}

template <typename Numbers>
Json numbers(const Numbers& values)
{
  Json list = Json::array();
  for (const auto value : values)
  {
    list.push_back(number(value));
  }
  return list;
}

Json errors_json(const ImageErrors& errors)
{
  if (errors.values == 0)
  {
    return nullptr;
  }
  Json json;
  json["mean_shift"] = number(errors.mean_shift);
  json["mean_absolute"] = number(errors.mean_absolute);
  json["rms"] = number(errors.rms);
  json["percentile_99_9"] = number(errors.percentile_999);
  json["largest"] = number(errors.largest);
  json["values"] = errors.values;
  json["non_finite_values"] = errors.non_finite_test;
  json["non_finite_truth_values"] = errors.non_finite_truth;
  json["non_finite_pixels"] = errors.non_finite_pixels;
  if (!std::isfinite(errors.largest) || !std::isfinite(errors.mean_absolute))
  {
    json["not_finite"] = std::to_string(errors.non_finite_pixels) +
      " pixels are not finite and count as an infinite error";
  }
  return json;
}

Json seconds_json(const Timing& timing)
{
  return { { "median", number(timing.median) }, { "min", number(timing.min) },
    { "max", number(timing.max) }, { "repetitions", timing.repetitions },
    { "warm_up", number(timing.warm_up) }, { "prepare", number(timing.prepare) } };
}

Json scene_json(const SceneDescription& scene)
{
  Json camera{ { "position", numbers(scene.camera.position) },
    { "focal_point", numbers(scene.camera.focal_point) },
    { "view_up", numbers(scene.camera.view_up) },
    { "projection", scene.camera.parallel ? "parallel" : "perspective" } };
  if (scene.camera.parallel)
  {
    camera["parallel_scale"] = number(scene.camera.parallel_scale);
  }
  else
  {
    camera["view_angle"] = number(scene.camera.view_angle);
  }
  Json lights = Json::array();
  for (const std::string& light : scene.lights)
  {
    lights.push_back(valid_utf8(light));
  }
  Json matched = Json::array();
  for (const MatchedSetting& setting : scene.matched)
  {
    matched.push_back({ { "name", valid_utf8(setting.name) },
      { "value", valid_utf8(setting.value) }, { "applies_to", valid_utf8(setting.applies_to) } });
  }
  const auto or_null = [](double v) { return v > 0 ? number(v) : Json(nullptr); };
  return { { "input", valid_utf8(scene.input) }, { "dimensions", scene.dimensions },
    { "spacing", numbers(scene.spacing) }, { "unit", text_or_null(scene.unit) },
    { "preset", text_or_null(scene.preset) }, { "resolution", { scene.width, scene.height } },
    { "sample_distance", or_null(scene.step) },
    { "sample_distance_voxels", or_null(scene.step_voxels) },
    { "opacity_unit_distance", or_null(scene.opacity_unit_distance) }, { "camera", camera },
    { "background", numbers(scene.background) }, { "lights", lights },
    { "shading", scene.shading }, { "interpolation", text_or_null(scene.interpolation) },
    { "matched", matched } };
}

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
  const Truth& truth = comparison.truth;
  const Machine& machine = comparison.machine;
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
    { "truth",
      { { "method", text_or_null(truth.method) },
        { "refinement_levels", truth.refinement_levels },
        { "remaining_mean", number(truth.remaining_mean) },
        { "remaining_largest", number(truth.remaining_largest) },
        { "seconds", number(truth.seconds) } } },
    { "machine",
      { { "cpu", text_or_null(machine.cpu) }, { "threads", machine.threads },
        { "simd", text_or_null(machine.simd) }, { "os", text_or_null(machine.os) },
        { "brume_version", text_or_null(machine.brume_version) },
        { "vtk_version", text_or_null(machine.vtk_version) } } } };
  return json.dump(2) + "\n";
}

}
