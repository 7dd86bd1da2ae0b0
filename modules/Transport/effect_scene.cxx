// Scenes and settings without the effects that are off.
#include "Transport/effect_plan.h"

#include <algorithm>

namespace brume
{

namespace
{

bool is_black(const glm::dvec3& colour)
{
  return colour == glm::dvec3(0.0);
}

double mean_of_channels(const glm::dvec3& v)
{
  return (v.x + v.y + v.z) / 3.0;
}

/// Key of a medium that another one was made from, by a change of number `change`. The marcher's
/// caches must not take the one for the other; 0, which keeps nothing, stays 0. Doubles hold it.
std::uint64_t derived_revision(std::uint64_t revision, std::uint64_t change)
{
  if (revision == 0)
  {
    return 0;
  }
  std::uint64_t key = revision + change * 0x9e3779b97f4a7c15u; // splitmix64
  key = (key ^ (key >> 30)) * 0xbf58476d1ce4e5b9u;
  key = (key ^ (key >> 27)) * 0x94d049bb133111ebu;
  return (key ^ (key >> 31)) >> 11 | 1u << 31;
}

/// A lit medium that sends nothing on.
void stop_scattering(Volume& volume)
{
  volume.medium.albedo = glm::dvec3(0.0);
  volume.medium.lobes.clear();
  volume.medium.octaves.count = 1;
  volume.medium.silver_lining.enabled = false;
  volume.medium.powder.enabled = false;
  volume.shading.enabled = false;
}

/// Whether a lit volume sends any of the light that it gets.
bool scatters(const Volume& volume)
{
  // Highlights do not take the albedo. Densities are not shaded.
  const bool shaded = volume.shading.enabled && volume.meaning == ValueMeaning::Classified;
  return volume.medium.lit && (!is_black(volume.medium.albedo) || shaded);
}

bool emits(const Medium& medium)
{
  return !is_black(medium.emission) || medium.black_body > 0.0;
}

void simplify(Volume& volume, const EffectSet& effects)
{
  Medium& medium = volume.medium;
  const bool density = volume.meaning == ValueMeaning::Density;
  if (density && !effects.has(Effect::ColouredExtinction))
  {
    // Into the extinction, so that the kernels of one channel serve.
    const double mean = mean_of_channels(volume.density.channels);
    if (volume.density.channels != glm::dvec3(1.0))
    {
      volume.density.extinction *= mean;
      volume.density.channels = glm::dvec3(1.0);
      volume.medium_revision = derived_revision(volume.medium_revision, 1);
    }
  }
  if (!effects.has(Effect::GradientShading))
  {
    volume.shading.enabled = false;
  }
  if (!effects.has(Effect::Emission))
  {
    if (!medium.lit && !density)
    {
      medium = Medium(); // the colour of a lit volume is no source of its own
      medium.lit = true;
      stop_scattering(volume);
      return;
    }
    medium.emission = glm::dvec3(0.0);
    medium.black_body = 0.0;
    medium.temperature = Grid();
  }
  if (!medium.lit)
  {
    return;
  }
  if (!effects.has(Effect::Scattering))
  {
    stop_scattering(volume);
  }
  if (!effects.has(Effect::PhaseAnisotropy))
  {
    medium.lobes.clear();
  }
  if (!effects.has(Effect::Octaves))
  {
    medium.octaves.count = 1;
  }
  if (!effects.has(Effect::SilverLining))
  {
    medium.silver_lining.enabled = false;
  }
  if (!effects.has(Effect::Powder))
  {
    medium.powder.enabled = false;
  }
}

void simplify(Fog& fog, const EffectSet& effects)
{
  if (!effects.has(Effect::Fog))
  {
    fog = Fog();
    return;
  }
  if (!effects.has(Effect::ColouredExtinction))
  {
    fog.extinction = glm::dvec3(mean_of_channels(fog.extinction));
  }
  if (!effects.has(Effect::Scattering))
  {
    fog.albedo = glm::dvec3(0.0);
  }
  if (!effects.has(Effect::PhaseAnisotropy) || !effects.has(Effect::Scattering))
  {
    fog.lobes.clear();
  }
}

}

Scene simplified(const Scene& scene, const EffectSet& effects)
{
  Scene result = scene;
  if (!effects.has(Effect::Surfaces))
  {
    result.surface_depth.clear();
  }
  if (scene.blend_mode != BlendMode::Composite)
  {
    // Colours and opacities of projections and surfaces are no light of matter: they stay.
    for (Volume& volume : result.volumes)
    {
      volume.shading.enabled = volume.shading.enabled && effects.has(Effect::GradientShading);
    }
    return result;
  }
  for (Volume& volume : result.volumes)
  {
    simplify(volume, effects);
  }
  simplify(result.fog, effects);
  if (!effects.has(Effect::Ambient) || !effects.has(Effect::Scattering))
  {
    result.sky.radiance = glm::dvec3(0.0);
    result.sky.ground = glm::dvec3(0.0);
  }
  // What is lit by nothing, or lights nothing, is left out of the kernels.
  const bool lights_needed =
    (result.fog.enabled && !is_black(result.fog.albedo)) ||
    std::any_of(result.volumes.begin(),
      result.volumes.end(),
      [](const Volume& v) { return scatters(v) || (!v.medium.lit && v.shading.enabled); });
  if (!lights_needed)
  {
    result.lights.clear();
  }
  const bool dark =
    result.lights.empty() && is_black(result.sky.radiance) && is_black(result.sky.ground);
  for (Volume& volume : result.volumes)
  {
    if (volume.meaning == ValueMeaning::Density && volume.medium.lit && !emits(volume.medium) &&
        (dark || !scatters(volume)))
    {
      volume.medium = Medium(); // a density that only absorbs
    }
  }
  return result;
}

void apply_effects(const EffectSet& effects, MarchSettings& settings)
{
  settings.absorption = settings.absorption && effects.has(Effect::Absorption);
  settings.leaping = settings.leaping && effects.has(Effect::SpaceLeaping);
  if (!effects.has(Effect::Shadows))
  {
    settings.shadows = ShadowMethod::None;
  }
}

}
