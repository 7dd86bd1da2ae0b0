#include "json_parts.h"

#include "figures.h"

#include <cmath>

namespace brume
{

using Json = nlohmann::ordered_json;

namespace
{

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

}

Json number(double value)
{
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json text_or_null(const std::string& text)
{
  return text.empty() ? Json(nullptr) : Json(valid_utf8(text));
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

Json truth_json(const Truth& truth)
{
  return { { "method", text_or_null(truth.method) },
    { "refinement_levels", truth.refinement_levels },
    { "remaining_mean", number(truth.remaining_mean) },
    { "remaining_largest", number(truth.remaining_largest) },
    { "seconds", number(truth.seconds) } };
}

Json machine_json(const Machine& machine)
{
  return { { "cpu", text_or_null(machine.cpu) }, { "threads", machine.threads },
    { "simd", text_or_null(machine.simd) }, { "os", text_or_null(machine.os) },
    { "brume_version", text_or_null(machine.brume_version) },
    { "vtk_version", text_or_null(machine.vtk_version) } };
}

}
