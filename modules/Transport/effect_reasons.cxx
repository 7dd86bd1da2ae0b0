#include "Transport/effect_reasons.h"

#include "Transport/fog.h"
#include "Transport/phase.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace brume
{

namespace
{

const glm::dvec3 black(0.0);

template <class Condition>
bool any(const Scene& scene, Condition condition)
{
  return std::any_of(scene.volumes.begin(), scene.volumes.end(), condition);
}

const char* mode_name(BlendMode mode)
{
  switch (mode)
  {
    case BlendMode::Composite:
      return "composite";
    case BlendMode::MaximumIntensity:
      return "maximum intensity";
    case BlendMode::MinimumIntensity:
      return "minimum intensity";
    case BlendMode::AverageIntensity:
      return "average intensity";
    case BlendMode::Additive:
      return "additive";
    case BlendMode::Isosurface:
      return "isosurface";
    case BlendMode::Slice:
      return "slice";
  }
  return "";
}

bool is_shaded(const Volume& volume)
{
  return volume.shading.enabled && volume.meaning == ValueMeaning::Classified;
}

/// Whether a lit volume sends any of the light that it gets by its phase function.
bool has_phase(const Volume& volume)
{
  return volume.medium.lit && volume.medium.albedo != black;
}

bool emits(const Volume& volume)
{
  const Medium& medium = volume.medium;
  return medium.lit
           ? medium.emission != black || (medium.black_body > 0.0 && medium.temperature.voxels)
           : volume.meaning == ValueMeaning::Classified;
}

bool fog_scatters(const Scene& scene)
{
  return has_fog(scene) && scene.fog.albedo != black;
}

bool has_sky(const Scene& scene)
{
  return scene.sky.radiance != black || scene.sky.ground != black;
}

bool has_lights(const Scene& scene)
{
  return std::any_of(scene.lights.begin(),
    scene.lights.end(),
    [](const Light& light) { return light.diffuse != black || light.specular != black; });
}

std::string no_scattering(const Scene& scene, const PlanFigures& figures)
{
  const bool fog = fog_scatters(scene);
  if (!any(scene, [](const Volume& v) { return v.medium.lit; }) && !fog)
  {
    return "no medium is lit";
  }
  if (figures.visible_bricks == 0 && !fog)
  {
    return "no matter can be seen";
  }
  if (!fog &&
      !any(scene, [](const Volume& v) { return has_phase(v) || (v.medium.lit && is_shaded(v)); }))
  {
    return "the albedo is 0";
  }
  const bool even = any(scene,
    [](const Volume& v) {
      return v.medium.lit && is_shaded(v) && v.shading.ambient * v.shading.ambient_light != black;
    });
  if (!has_lights(scene) && !has_sky(scene) && !even)
  {
    return "no light is on and the sky is black";
  }
  return "";
}

double most_of(const glm::dvec3& v)
{
  return std::max({ v.x, v.y, v.z });
}

double deepest_toward_lights(const PlanFigures& figures)
{
  return figures.lights.empty() ? 0.0
                                : *std::max_element(figures.lights.begin(), figures.lights.end());
}

std::string lobes_in_words(const Scene& scene)
{
  double least = 1.0;
  double most = -1.0;
  const auto look = [&](const std::vector<PhaseLobe>& lobes)
  {
    for (const PhaseLobe& lobe : lobes)
    {
      const bool even =
        lobe.function == PhaseFunction::Isotropic || lobe.function == PhaseFunction::Rayleigh;
      least = std::min(least, even ? 0.0 : lobe.anisotropy);
      most = std::max(most, even ? 0.0 : lobe.anisotropy);
    }
  };
  for (const Volume& volume : scene.volumes)
  {
    look(volume.medium.lobes);
  }
  if (scene.fog.enabled)
  {
    look(scene.fog.lobes);
  }
  return least == most ? "g = " + two_digits(most)
                       : "g from " + two_digits(least) + " to " + two_digits(most);
}

}

std::string two_digits(double value)
{
  char text[40];
  std::snprintf(text, sizeof(text), "%.2g", value);
  return text;
}

std::string absence(Effect effect, const Scene& scene, const PlanFigures& figures)
{
  if (effect == Effect::Surfaces)
  {
    return scene.surface_depth.empty() ? "no opaque geometry is shown with the volume" : "";
  }
  if (effect == Effect::SpaceLeaping)
  {
    return figures.visible_bricks < figures.bricks ? "" : "every brick holds something";
  }
  if (effect == Effect::GradientShading)
  {
    const bool surfaces =
      scene.blend_mode == BlendMode::Isosurface || scene.blend_mode == BlendMode::Slice;
    if (scene.blend_mode != BlendMode::Composite && !surfaces)
    {
      return std::string("the blend mode is ") + mode_name(scene.blend_mode);
    }
    return any(scene, is_shaded) ? "" : "no volume is shaded";
  }
  if (scene.blend_mode != BlendMode::Composite)
  {
    return std::string("the blend mode is ") + mode_name(scene.blend_mode);
  }
  const std::string dark = no_scattering(scene, figures);
  switch (effect)
  {
    case Effect::Absorption:
      return figures.visible_bricks > 0 || has_fog(scene) ? "" : "no matter can be seen";
    case Effect::Emission:
      return any(scene, emits) ? "" : "no matter sends light by itself";
    case Effect::Scattering:
      return dark;
    case Effect::PhaseAnisotropy:
    {
      if (!dark.empty())
      {
        return dark;
      }
      const auto even = [](const std::vector<PhaseLobe>& lobes)
      {
        const PhaseModel model = prepare_phase(lobes);
        return model.is_isotropic();
      };
      const bool volumes =
        any(scene, [&](const Volume& v) { return has_phase(v) && !even(v.medium.lobes); });
      const bool fog = fog_scatters(scene) && !even(scene.fog.lobes);
      return volumes || fog ? "" : "every phase function is isotropic";
    }
    case Effect::ColouredExtinction:
    {
      const auto differ = [](const glm::dvec3& v) { return v.x != v.y || v.x != v.z; };
      const bool volumes = any(scene,
        [&](const Volume& v)
        { return v.meaning == ValueMeaning::Density && differ(v.density.channels); });
      return volumes || (scene.fog.enabled && differ(scene.fog.extinction))
               ? ""
               : "R, G and B have the same extinction";
    }
    case Effect::Shadows:
      if (!dark.empty())
      {
        return dark;
      }
      if (!any(scene, [](const Volume& v) { return v.medium.lit; }))
      {
        return "no volume is lit";
      }
      return has_lights(scene) ? "" : "no light is on";
    case Effect::Ambient:
      if (!has_sky(scene))
      {
        return "sky and ground are black";
      }
      return any(scene, has_phase) || fog_scatters(scene) ? ""
             : dark.empty()                               ? "no phase function scatters it"
                                                          : dark;
    case Effect::Octaves:
      if (!dark.empty())
      {
        return dark;
      }
      return any(scene, [](const Volume& v) { return has_phase(v) && v.medium.octaves.count > 1; })
               ? ""
               : "there is one octave: single scattering";
    case Effect::SilverLining:
      return any(scene,
               [](const Volume& v) {
                 return has_phase(v) && v.medium.silver_lining.enabled &&
                        v.medium.silver_lining.strength > 0.0;
               })
               ? ""
               : "silver lining is not asked for";
    case Effect::Powder:
      return any(scene,
               [](const Volume& v) {
                 return has_phase(v) && v.medium.powder.enabled && v.medium.powder.strength > 0.0;
               })
               ? ""
               : "powder is not asked for";
    case Effect::Fog:
      return has_fog(scene) ? "" : "there is no fog";
    default:
      return "";
  }
}

std::string figures_of(Effect effect, const Scene& scene, const PlanFigures& figures)
{
  const std::string toward =
    "optical depth toward the lights is at most " + two_digits(deepest_toward_lights(figures));
  switch (effect)
  {
    case Effect::Absorption:
      return "optical depth along the view is at most " + two_digits(figures.view.deepest);
    case Effect::Emission:
      return any(scene, [](const Volume& v) { return v.medium.lit && emits(v); })
               ? "matter sends light by itself"
               : "the transfer functions' colour is the source";
    case Effect::Scattering:
      return std::to_string(scene.lights.size()) +
             (scene.lights.size() == 1 ? " light" : " lights") +
             (has_sky(scene) ? " and the sky" : "") + ", optical depth along the view at most " +
             two_digits(figures.view.deepest);
    case Effect::PhaseAnisotropy:
      return lobes_in_words(scene);
    case Effect::ColouredExtinction:
    {
      glm::dvec3 channels(1.0);
      for (const Volume& volume : scene.volumes)
      {
        const glm::dvec3& c = volume.density.channels;
        channels =
          volume.meaning == ValueMeaning::Density && (c.x != c.y || c.x != c.z) ? c : channels;
      }
      return "extinction of R, G, B is as " + two_digits(channels.x) + " to " +
             two_digits(channels.y) + " to " + two_digits(channels.z);
    }
    case Effect::Shadows:
      return toward;
    case Effect::Ambient:
      return "the sky sends up to " + two_digits(most_of(scene.sky.radiance)) +
             " and the ground up to " + two_digits(most_of(scene.sky.ground));
    case Effect::Octaves:
    {
      int count = 1;
      double contribution = 0.0;
      for (const Volume& volume : scene.volumes)
      {
        count = std::max(count, volume.medium.octaves.count);
        contribution = std::max(contribution, volume.medium.octaves.contribution);
      }
      return std::to_string(count) + " octaves, each " + two_digits(contribution) +
             " of the one before";
    }
    case Effect::GradientShading:
      return "shading by the gradient is on; it is not physical";
    case Effect::SilverLining:
      return "silver lining is asked for; it is not physical";
    case Effect::Powder:
      return "powder is asked for; it is not physical";
    case Effect::Fog:
      return "there is fog";
    case Effect::Surfaces:
      return "opaque geometry ends rays";
    case Effect::SpaceLeaping:
      return std::to_string(figures.bricks - figures.visible_bricks) + " of " +
             std::to_string(figures.bricks) +
             " bricks hold nothing; leaping over them changes no picture";
  }
  return "";
}

}
