#include "path_report.h"

#include "march_report.h"

#include "Transport/fog.h"

#include <glm/vec3.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

namespace brume
{

namespace
{

bool shines(const glm::dvec3& light)
{
  return light.x > 0.0 || light.y > 0.0 || light.z > 0.0;
}

}

EffectPlan plan_of_paths(const Scene& scene, int most_scatterings, bool environment)
{
  const auto any = [&scene](auto condition)
  { return std::any_of(scene.volumes.begin(), scene.volumes.end(), condition); };
  const bool fog = has_fog(scene);
  const bool lit = any([](const Volume& v) { return v.medium.lit; }) || (fog && shines(scene.fog.albedo));
  const bool lamps = !scene.lights.empty();
  const bool sky = shines(scene.sky.radiance) || shines(scene.sky.ground) || environment;
  const bool emits = any(
    [](const Volume& v)
    {
      const Medium& m = v.medium;
      return m.lit ? shines(m.emission) || (m.black_body > 0.0 && m.temperature.voxels)
                   : v.meaning == ValueMeaning::Classified;
    });
  const bool coloured = any([](const Volume& v)
    { return v.meaning == ValueMeaning::Density && v.density.channels != glm::dvec3(1.0); }) ||
    (fog && scene.fog.extinction != glm::dvec3(scene.fog.extinction.x));
  const auto turns = [](const std::vector<PhaseLobe>& lobes)
  {
    return std::any_of(lobes.begin(), lobes.end(),
      [](const PhaseLobe& lobe) { return lobe.function != PhaseFunction::Isotropic; });
  };
  const bool anisotropic =
    any([&](const Volume& v) { return v.medium.lit && turns(v.medium.lobes); }) ||
    (fog && turns(scene.fog.lobes));
  const std::string scatterings =
    most_scatterings > 0 ? "up to " + std::to_string(most_scatterings) + " scatterings are followed"
                         : "all scatterings are followed";
  EffectPlan plan;
  const auto settle = [&plan](Effect effect, bool on, const std::string& reason)
  {
    plan.effects[static_cast<std::size_t>(effect)] = { effect, on, false, reason, 0.0 };
  };
  settle(Effect::Absorption, true, "paths collide with matter by its extinction");
  settle(Effect::Emission, emits, emits ? "matter sends light by itself" : "no matter sends light by itself");
  settle(Effect::Scattering, lit && (lamps || sky),
    !lit ? "no medium is lit" : lamps || sky ? scatterings : "there is no light");
  settle(Effect::PhaseAnisotropy, anisotropic,
    anisotropic ? "directions are drawn from the phase functions" : "all phase functions are isotropic");
  settle(Effect::ColouredExtinction, coloured,
    coloured ? "a path is of one channel, and weighted for the others" : "extinction is the same in all channels");
  settle(Effect::Shadows, lit && lamps,
    lit && lamps ? "the transmittance toward a light is estimated at each scattering" : "no light shines on a lit medium");
  settle(Effect::Ambient, lit && sky,
    !(lit && sky) ? "there is no sky, or no lit medium"
      : environment ? "paths that leave the matter see sky and ground, and the environment map, which is also looked for at each scattering"
                    : "paths that leave the matter see sky and ground");
  settle(Effect::Octaves, false, scatterings + ": nothing is left to approximate");
  const bool shaded = any([](const Volume& v) { return v.shading.enabled; });
  settle(Effect::GradientShading, false,
    shaded ? "the phase function scatters light; shading by the gradient is no transport"
           : "shading is off");
  const bool lining = any([](const Volume& v) { return v.medium.lit && v.medium.silver_lining.enabled; });
  settle(Effect::SilverLining, false,
    lining ? "not physical: paths leave it out" : "silver lining is off");
  const bool powder = any([](const Volume& v) { return v.medium.lit && v.medium.powder.enabled; });
  settle(Effect::Powder, false, powder ? "not physical: paths leave it out" : "powder is off");
  settle(Effect::Fog, fog,
    fog ? "paths collide with it, in closed form, and it is shadowed" : "the scene has no fog");
  const bool surfaces = !scene.surface_depth.empty();
  settle(Effect::Surfaces, surfaces,
    surfaces ? "rays of the camera end at opaque surfaces" : "there are no surfaces");
  settle(Effect::SpaceLeaping, true, "paths leap over bricks that hold nothing; changes no picture");
  return plan;
}

nlohmann::json effects_of(const EffectPlan& plan)
{
  nlohmann::json effects = nlohmann::json::array();
  for (const PlannedEffect& planned : plan.effects)
  {
    effects.push_back({ { "name", effect_name(planned.effect) },
      { "on", planned.on },
      { "reason", planned.reason },
      { "error_bound", planned.error_bound },
      { "forced", planned.forced } });
  }
  return effects;
}

nlohmann::json statistics_of(const Scene& scene,
  const PathSettings& settings,
  const PathStatistics& paths,
  const EffectPlan& plan,
  bool window_level)
{
  nlohmann::json statistics;
  statistics["seconds"] = paths.seconds;
  statistics["samples"] = paths.collisions;
  statistics["rays"] = paths.paths;
  statistics["samples_per_pixel"] = paths.samples_per_pixel;
  statistics["mean_samples_per_pixel"] = paths.mean_samples;
  statistics["scatterings"] = paths.scatterings;
  statistics["shadow_rays"] = paths.shadow_rays;
  statistics["threads"] = paths.threads;
  statistics["simd"] = paths.simd;
  statistics["seed"] = settings.seed;
  statistics["maximum_scatterings"] = settings.most_scatterings;
  statistics["blend_mode"] = blend_mode_name(scene.blend_mode);
  statistics["volumes"] = scene.volumes.size();
  // Infinite before there are samples enough: null, which JSON has in its place.
  const bool known = std::isfinite(paths.estimated_error);
  statistics["estimated_error"] = known ? nlohmann::json(paths.estimated_error) : nullptr;
  statistics["rms_error"] = known ? nlohmann::json(paths.rms_error) : nullptr;
  statistics["effects"] = effects_of(plan);
  statistics["non_finite_voxels"] = paths.non_finite_voxels;
  statistics["radiometric"] = is_radiometric_as_paths(scene, window_level);
  statistics["peak_memory_bytes"] = peak_memory_bytes();
  statistics["completed"] = paths.completed;
  return statistics;
}

bool is_radiometric_as_paths(const Scene& scene, bool window_level)
{
  Scene traced = scene;
  for (Volume& volume : traced.volumes)
  {
    volume.shading.enabled = false;
    volume.medium.silver_lining.enabled = false;
    volume.medium.powder.enabled = false;
  }
  return is_radiometric(traced, window_level);
}

}
