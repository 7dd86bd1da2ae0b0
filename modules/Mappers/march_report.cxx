#include "march_report.h"

#include "Transport/step_control.h"

#include <nlohmann/json.hpp>

#include <sys/resource.h>

#include <algorithm>
#include <string>

namespace brume
{

namespace
{

nlohmann::json effect(const char* name,
  bool on,
  const std::string& reason,
  double bound = 0.0,
  bool forced = false)
{
  return { { "name", name },
    { "on", on },
    { "reason", reason },
    { "error_bound", bound },
    { "forced", forced } };
}

template <class Condition>
bool any(const Scene& scene, Condition condition)
{
  return std::any_of(scene.volumes.begin(), scene.volumes.end(), condition);
}

bool shades(const Scene& scene)
{
  const bool lit = scene.blend_mode == BlendMode::Composite ||
    scene.blend_mode == BlendMode::Isosurface || scene.blend_mode == BlendMode::Slice;
  return lit && any(scene, [](const Volume& v) { return v.shading.enabled; });
}

bool shines_unphysically(const Scene& scene)
{
  return any(scene,
    [](const Volume& v)
    {
      const bool lining = v.medium.silver_lining.enabled && v.medium.silver_lining.strength > 0.0;
      const bool powder = v.medium.powder.enabled && v.medium.powder.strength > 0.0;
      return v.medium.lit && (lining || powder);
    });
}

bool has_gradient_opacity(const Scene& scene)
{
  const auto has = [](const Classification& c)
  { return !c.gradient_opacity.empty() || !c.value_gradient.empty(); };
  return any(scene,
    [&](const Volume& v)
    {
      return has(v.classification) ||
             std::any_of(v.label_classifications.begin(), v.label_classifications.end(), has);
    });
}

}

std::int64_t peak_memory_bytes()
{
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return std::int64_t{ usage.ru_maxrss } * 1024; // Linux counts in KiB
}

const char* blend_mode_name(BlendMode mode)
{
  switch (mode)
  {
    case BlendMode::MaximumIntensity:
      return "mip";
    case BlendMode::MinimumIntensity:
      return "minip";
    case BlendMode::AverageIntensity:
      return "average";
    case BlendMode::Additive:
      return "additive";
    case BlendMode::Isosurface:
      return "isosurface";
    case BlendMode::Slice:
      return "slice";
    default:
      return "composite";
  }
}

nlohmann::json statistics_of(const Scene& scene,
  const MarchSettings& settings,
  const MarchStatistics& march,
  const EffectPlan& plan,
  bool window_level)
{
  nlohmann::json statistics;
  statistics["seconds"] = march.seconds;
  statistics["samples"] = march.samples;
  statistics["rays"] = march.rays;
  statistics["threads"] = march.threads;
  statistics["simd"] = march.simd;
  statistics["step"] = march.step;
  statistics["step_rule"] = step_rule_name(march.rule);
  statistics["refinements"] = settings.refinements;
  statistics["step_in_voxels"] = march.step / smallest_voxel_edge(scene);
  statistics["blend_mode"] = blend_mode_name(scene.blend_mode);
  statistics["volumes"] = scene.volumes.size();
  statistics["shadow_method"] = shadow_method_name(march.shadows);
  statistics["shadow_step"] = march.shadow_step;
  statistics["light_bytes"] = march.light_bytes;
  statistics["seconds_light"] = march.seconds_light;
  statistics["effects"] = effects_of(scene, settings, march, plan, window_level);
  statistics["effects_error_bound"] = plan.error_bound();
  statistics["non_finite_voxels"] = march.non_finite_voxels;
  statistics["bricks"] = march.bricks;
  statistics["visible_bricks"] = march.visible_bricks;
  statistics["radiometric"] = is_radiometric(scene, window_level);
  statistics["peak_memory_bytes"] = peak_memory_bytes();
  statistics["completed"] = march.completed;
  return statistics;
}

bool is_radiometric(const Scene& scene, bool window_level)
{
  const bool components = scene.volumes.size() > 1 && scene.mixture == Mixture::Components;
  return scene.blend_mode == BlendMode::Composite && !components && !window_level && !shades(scene) &&
    !has_gradient_opacity(scene) && !shines_unphysically(scene);
}

nlohmann::json effects_of(const Scene& scene,
  const MarchSettings& settings,
  const MarchStatistics& march,
  const EffectPlan& plan,
  bool window_level)
{
  const bool composite = scene.blend_mode == BlendMode::Composite;
  const bool gradient = has_gradient_opacity(scene);
  const bool masked = any(scene, [](const Volume& v) { return v.mask.labels != nullptr; });
  const bool cropped = any(scene, [](const Volume& v) { return v.cropping.enabled; });
  const bool clipped = any(scene, [](const Volume& v) { return !v.clipping_planes.empty(); });
  const std::string mode = blend_mode_name(scene.blend_mode);
  nlohmann::json effects = nlohmann::json::array();
  for (const PlannedEffect& planned : plan.effects)
  {
    effects.push_back(effect(effect_name(planned.effect),
      planned.on,
      planned.reason,
      planned.error_bound,
      planned.forced));
  }
  effects.push_back(effect("projection",
    !composite,
    composite ? "the blend mode is composite"
              : "the blend mode is " + mode + "; not a physical term"));
  effects.push_back(effect("several volumes",
    composite && scene.volumes.size() > 1,
    std::to_string(scene.volumes.size()) +
      (scene.volumes.size() == 1                    ? " volume"
          : scene.mixture == Mixture::Components ? " components, mixed as VTK's mappers do"
                                                 : " volumes: their extinctions add up")));
  effects.push_back(effect("gradient opacity",
    gradient,
    gradient ? "the property has a function of the gradient; not a physical term"
             : "the property has no function of the gradient"));
  effects.push_back(
    effect("mask", masked, masked ? "the mapper has a mask" : "the mapper has no mask"));
  effects.push_back(effect("cropping",
    cropped,
    cropped ? "vtkVolumeMapper::Cropping is on" : "vtkVolumeMapper::Cropping is off"));
  effects.push_back(effect("clipping planes",
    clipped,
    clipped ? "the mapper has clipping planes" : "the mapper has no clipping planes"));
  effects.push_back(effect("jitter",
    settings.jitter,
    settings.jitter ? "the mapper's UseJittering is on: bands of steps become noise"
                    : "the mapper's UseJittering is off"));
  effects.push_back(effect("final colour window",
    window_level,
    window_level ? "FinalColorWindow or FinalColorLevel is set; not a physical term"
                 : "FinalColorWindow is 1 and FinalColorLevel is 0.5"));
  effects.push_back(effect("leaving rays early",
    march.visible_bricks > 0,
    "a ray ends when what is behind cannot change its pixel by more than the bound",
    settings.leave_error));
  return effects;
}

}
