#include "Transport/plan_bounds.h"

#include "Transport/black_body.h"
#include "Transport/exponential_integral.h"
#include "Transport/zoom.h"

#include <glm/common.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>

namespace brume
{

namespace
{

glm::dvec3 max_of(const glm::dvec3& a, const glm::dvec3& b)
{
  return glm::max(a, b);
}

/// sup over t in [0, depth] of |e^{−a t} − e^{−b t}|: largest at ln(a/b) / (a − b), if it gets
/// there.
double largest_difference(double a, double b, double depth)
{
  if (a == b)
  {
    return 0.0;
  }
  double at = depth;
  if (a > 0.0 && b > 0.0)
  {
    at = std::min(depth, std::log(a / b) / (a - b));
  }
  return std::abs(std::exp(-a * at) - std::exp(-b * at));
}

/// ∫ |a e^{−a t} − b e^{−b t}| dt over [0, depth]: the integrand changes its sign once, where the
/// function before is largest.
double variation(double a, double b, double depth)
{
  const double most = largest_difference(a, b, depth);
  const double end = std::abs(std::exp(-a * depth) - std::exp(-b * depth));
  return 2.0 * most - end;
}

std::vector<double> ends_of(const ChannelRanges::Range& range)
{
  return range.lower == range.upper ? std::vector<double>{ range.lower }
                                    : std::vector<double>{ range.lower, range.upper };
}

double opacity(double depth)
{
  return -std::expm1(-depth);
}

}

EffectBounds::EffectBounds(const Scene& scene, const PlanFigures& figures)
  : TheScene(scene)
  , Figures(figures)
  , Gain(scene.mixture == Mixture::Components ? static_cast<double>(scene.volumes.size()) : 1.0)
  , Channels(channel_ranges(scene))
  , Light(find_light(scene, figures, Channels))
  , FogSeen(look_at_fog(scene))
{
  for (std::size_t k = 0; k < scene.volumes.size(); ++k)
  {
    const Volume& volume = scene.volumes[k];
    const Medium& medium = volume.medium;
    glm::dvec3 sent(0.0);
    if (medium.lit)
    {
      sent = medium.emission;
      if (medium.black_body > 0.0 && medium.temperature.voxels)
      {
        sent += medium.black_body *
                black_body_radiance(figures.matter[k].kelvin, medium.black_body_reference);
      }
      if (volume.meaning == ValueMeaning::Density)
      {
        const double extinction = volume.density.extinction * volume.weight;
        if (extinction > 0.0)
        {
          sent /= extinction;
        }
        else
        {
          this->Clear += sent * figures.matter[k].amount;
          sent = glm::dvec3(0.0);
        }
      }
      else
      {
        sent *= figures.matter[k].colour;
      }
    }
    this->Emission.push_back(sent);
  }
  this->find_channel_changes();
  if (!scene.surface_depth.empty())
  {
    double farthest = -1.0;
    for (const glm::dvec3& corner : corners_of_volumes(scene, scene.volumes.size()))
    {
      const glm::dvec4 clip = scene.camera.clip_from_world * glm::dvec4(corner, 1.0);
      farthest = clip.w > 0.0 ? std::max(farthest, clip.z / clip.w) : farthest;
    }
    this->SurfacesBefore = *std::min_element(scene.surface_depth.begin(),
                             scene.surface_depth.end()) < std::min(farthest, 1.0);
  }
}

void EffectBounds::find_channel_changes()
{
  const double toward =
    this->Figures.lights.empty()
      ? 0.0
      : *std::max_element(this->Figures.lights.begin(), this->Figures.lights.end());
  for (int c = 0; c < 3; ++c)
  {
    for (const double a : ends_of(this->Channels.of[c]))
    {
      for (const double b : ends_of(this->Channels.mean))
      {
        this->ShadowChange[c] = std::max(this->ShadowChange[c], largest_difference(a, b, toward));
        for (int i = 0; i <= 32 && a != b; ++i)
        {
          // The difference rises and falls once; between the places looked at it is no tenth
          // larger.
          const double x = this->Figures.vertical * std::pow(2.0, 0.5 * (i - 32));
          this->SkyChange[c] = std::max(this->SkyChange[c],
            1.1 * std::abs(exponential_integral_2(a * x) - exponential_integral_2(b * x)));
        }
      }
    }
  }
}

ChannelRanges::Range EffectBounds::channel(int c, const EffectSet& on) const
{
  return on.has(Effect::ColouredExtinction) ? this->Channels.of[c] : this->Channels.mean;
}

double EffectBounds::weight(std::size_t ray, int c, const EffectSet& on) const
{
  const double depth = this->channel(c, on).upper * this->Figures.view.depth[ray];
  return this->Gain * (on.has(Effect::Absorption) ? opacity(depth) : depth);
}

glm::dvec3 EffectBounds::tint(std::size_t k) const
{
  const Volume& volume = this->TheScene.volumes[k];
  return volume.medium.albedo * this->Figures.matter[k].colour;
}

glm::dvec3 EffectBounds::behind(const EffectSet& on) const
{
  return 1.0 +
         (on.has(Effect::Fog) ? this->FogSeen.radiance + this->FogSeen.deviation : glm::dvec3(0.0));
}

glm::dvec3 EffectBounds::ambient() const
{
  return 0.5 * (this->TheScene.sky.radiance + this->TheScene.sky.ground);
}

glm::dvec3 EffectBounds::lights(const Volume& volume,
  const RaySource& sums,
  const EffectSet& on) const
{
  const RaySource::Sum* sum = on.has(Effect::PhaseAnisotropy) ? sums.lobes : sums.even;
  glm::dvec3 result = sum[0].all;
  if (on.has(Effect::Octaves))
  {
    result += sum[1].all;
  }
  if (on.has(Effect::SilverLining) && volume.medium.silver_lining.enabled)
  {
    result += sums.lining.all;
  }
  return result;
}

glm::dvec3 EffectBounds::shaded(const Volume& volume, std::size_t ray, bool dimmed) const
{
  const RayShading& light = this->Light.shadings[ray];
  const Shading& s = volume.shading;
  const glm::dvec3 diffuse = dimmed ? light.diffuse.dimmed : light.diffuse.all;
  return s.diffuse * diffuse + (dimmed ? glm::dvec3(0.0) : s.ambient * s.ambient_light);
}

glm::dvec3 EffectBounds::scattered(std::size_t k, std::size_t ray, const EffectSet& on) const
{
  const Volume& volume = this->TheScene.volumes[k];
  if (!volume.medium.lit || !on.has(Effect::Scattering))
  {
    return glm::dvec3(0.0);
  }
  const glm::dvec3 around = on.has(Effect::Ambient) ? this->ambient() : glm::dvec3(0.0);
  const bool surface = volume.shading.enabled && volume.meaning == ValueMeaning::Classified;
  if (surface && on.has(Effect::GradientShading))
  {
    return this->tint(k) * (around + this->shaded(volume, ray, false)) +
           volume.shading.specular * this->Light.shadings[ray].specular.all;
  }
  return this->tint(k) * (around + this->lights(volume, this->Light.sources[k][ray], on));
}

glm::dvec3 EffectBounds::emitted(std::size_t ray, const EffectSet& on) const
{
  glm::dvec3 most(0.0);
  if (!on.has(Effect::Emission))
  {
    return most;
  }
  for (std::size_t k = 0; k < this->TheScene.volumes.size(); ++k)
  {
    const Volume& volume = this->TheScene.volumes[k];
    glm::dvec3 sent(0.0);
    for (int c = 0; c < 3; ++c)
    {
      const double weight = this->weight(ray, c, on);
      if (volume.meaning == ValueMeaning::Classified && !volume.medium.lit)
      {
        const double colour = this->Figures.matter[k].colour[c];
        const bool surface = volume.shading.enabled && on.has(Effect::GradientShading);
        sent[c] =
          weight * (surface ? colour * this->shaded(volume, ray, false)[c] +
                                volume.shading.specular * this->Light.shadings[ray].specular.all[c]
                            : colour);
      }
      else if (volume.meaning == ValueMeaning::Classified)
      {
        sent[c] = weight * this->Emission[k][c];
      }
      else if (this->Emission[k][c] > 0.0)
      {
        // Per unit of density: it does not fall with the channel's extinction.
        const double depth = this->Figures.view.depth[ray];
        const double least = this->channel(c, on).lower;
        const bool dims = on.has(Effect::Absorption) && least > 0.0;
        sent[c] = this->Emission[k][c] * (dims ? opacity(least * depth) / least : depth);
      }
    }
    most = max_of(most, sent);
  }
  return most + this->Clear;
}

glm::dvec3 EffectBounds::radiance(std::size_t ray, const EffectSet& on) const
{
  glm::dvec3 most(0.0);
  for (std::size_t k = 0; k < this->TheScene.volumes.size(); ++k)
  {
    most = max_of(most, this->scattered(k, ray, on));
  }
  for (int c = 0; c < 3; ++c)
  {
    most[c] *= this->weight(ray, c, on);
  }
  return most + this->emitted(ray, on);
}

glm::dvec3 EffectBounds::change_by_powder(std::size_t ray, const EffectSet& on) const
{
  glm::dvec3 most(0.0);
  for (std::size_t k = 0; k < this->TheScene.volumes.size(); ++k)
  {
    const Volume& volume = this->TheScene.volumes[k];
    const Powder& powder = volume.medium.powder;
    if (!volume.medium.lit || !powder.enabled)
    {
      continue;
    }
    const MatterFigures& matter = this->Figures.matter[k];
    const bool density = volume.meaning == ValueMeaning::Density;
    const double d =
      std::clamp(powder.scale * (density ? matter.density : matter.opacity), 0.0, 1.0);
    const double share =
      powder.strength * (powder.form == Powder::Form::Height ? std::sqrt(d) : 1.0);
    most = max_of(most, std::min(share, 1.0) * this->scattered(k, ray, on));
  }
  return most;
}

glm::dvec3 EffectBounds::change_by_shading(std::size_t ray, const EffectSet& on) const
{
  EffectSet without = on;
  without.set(Effect::GradientShading, false);
  glm::dvec3 most(0.0);
  for (std::size_t k = 0; k < this->TheScene.volumes.size(); ++k)
  {
    const Volume& volume = this->TheScene.volumes[k];
    if (!volume.shading.enabled || volume.meaning != ValueMeaning::Classified)
    {
      continue;
    }
    if (volume.medium.lit)
    {
      most = max_of(most, max_of(this->scattered(k, ray, on), this->scattered(k, ray, without)));
    }
    else if (on.has(Effect::Emission))
    {
      // colour · f + highlight in place of colour, f between its ambient part and the brightest.
      const glm::dvec3 least = volume.shading.ambient * volume.shading.ambient_light;
      const glm::dvec3 factor =
        max_of(glm::abs(1.0 - least), glm::abs(this->shaded(volume, ray, false) - 1.0));
      most = max_of(most,
        this->Figures.matter[k].colour * factor +
          volume.shading.specular * this->Light.shadings[ray].specular.all);
    }
  }
  return most;
}

glm::dvec3 EffectBounds::change_by_channels(std::size_t ray, const EffectSet& on) const
{
  const double depth = this->Figures.view.depth[ray];
  const bool absorbs = on.has(Effect::Absorption);
  const bool one = this->TheScene.volumes.size() == 1;
  EffectSet no_sky = on;
  no_sky.set(Effect::Ambient, false);
  glm::dvec3 result(0.0);
  for (int c = 0; c < 3; ++c)
  {
    const ChannelRanges::Range& coloured = this->Channels.of[c];
    const ChannelRanges::Range& mean = this->Channels.mean;
    double view = 0.0;  // of the transmittance
    double share = 0.0; // of σ T along the ray
    for (const double a : ends_of(coloured))
    {
      for (const double b : ends_of(mean))
      {
        view = std::max(view, largest_difference(a, b, depth));
        share = std::max(share, absorbs ? variation(a, b, depth) : std::abs(a - b) * depth);
      }
    }
    if (!one && (coloured.lower != coloured.upper || mean.lower != mean.upper))
    {
      // Where volumes of different channels mix, nothing is known of how they follow one another.
      share = absorbs ? opacity(coloured.upper * depth) + opacity(mean.upper * depth)
                      : std::max(coloured.upper, mean.upper) * depth;
    }
    double lit = 0.0;
    double lit_by_lights = 0.0;
    for (std::size_t k = 0; k < this->TheScene.volumes.size(); ++k)
    {
      lit = std::max(lit, this->scattered(k, ray, on)[c]);
      lit_by_lights = std::max(lit_by_lights, this->scattered(k, ray, no_sky)[c]);
    }
    EffectSet grey = on;
    grey.set(Effect::ColouredExtinction, false);
    const double grey_weight = this->weight(ray, c, grey);
    const double around = this->ambient()[c] * (on.has(Effect::Ambient) ? 1.0 : 0.0);
    result[c] =
      (absorbs ? view : 0.0) + this->Gain * share * lit +
      (on.has(Effect::Shadows) ? this->ShadowChange[c] * grey_weight * lit_by_lights : 0.0) +
      this->SkyChange[c] * grey_weight * around;
    // Emission: by unit of density, or in a mixture with matter whose extinction is another.
    double emission = 0.0;
    for (std::size_t k = 0; k < this->TheScene.volumes.size(); ++k)
    {
      const Volume& volume = this->TheScene.volumes[k];
      const double sent = this->Emission[k][c];
      if (volume.meaning == ValueMeaning::Density && sent > 0.0 && absorbs)
      {
        emission = std::max(emission, sent * depth * view);
      }
    }
    if (!one)
    {
      emission = std::max(emission, this->emitted(ray, on)[c]);
    }
    result[c] += on.has(Effect::Emission) ? emission : 0.0;
  }
  if (on.has(Effect::Fog)) // on the way to the eye, and to matter
  {
    result += 2.0 * this->FogSeen.grey_dims * this->radiance(ray, on);
  }
  return result;
}

glm::dvec3 EffectBounds::change(Effect effect, std::size_t ray, const EffectSet& on) const
{
  const std::vector<Volume>& volumes = this->TheScene.volumes;
  EffectSet without = on;
  without.set(effect, false);
  glm::dvec3 result(0.0);
  const auto weighted = [&](const glm::dvec3& source)
  {
    glm::dvec3 weighted_source;
    for (int c = 0; c < 3; ++c)
    {
      weighted_source[c] = source[c] * this->weight(ray, c, on);
    }
    return weighted_source;
  };
  /// The largest of what volumes send, by a function of a volume's number.
  const auto largest = [&](auto&& of_volume)
  {
    glm::dvec3 most(0.0);
    for (std::size_t k = 0; k < volumes.size(); ++k)
    {
      if (volumes[k].medium.lit && on.has(Effect::Scattering))
      {
        most = max_of(most, of_volume(k, this->Light.sources[k][ray]));
      }
    }
    return weighted(most);
  };
  const auto is_surface = [&](std::size_t k)
  {
    return volumes[k].shading.enabled && volumes[k].meaning == ValueMeaning::Classified &&
           on.has(Effect::GradientShading);
  };
  const int phase = on.has(Effect::PhaseAnisotropy);
  switch (effect)
  {
    case Effect::Absorption:
    {
      const glm::dvec3 all = this->radiance(ray, without);
      const glm::dvec3 some = this->Light.lamps ? glm::dvec3(0.0) : this->radiance(ray, on);
      for (int c = 0; c < 3; ++c)
      {
        const double passes = opacity(this->channel(c, on).upper * this->Figures.view.depth[ray]);
        result[c] = passes * this->behind(on)[c] + std::max(0.0, all[c] - some[c]);
      }
      return result;
    }
    case Effect::Emission:
      return this->emitted(ray, on);
    case Effect::Scattering:
      for (std::size_t k = 0; k < volumes.size(); ++k)
      {
        result = max_of(result, this->scattered(k, ray, on));
      }
      return weighted(result);
    case Effect::PhaseAnisotropy:
      return largest(
        [&](std::size_t k, const RaySource& source)
        {
          if (is_surface(k))
          {
            return glm::dvec3(0.0);
          }
          return this->tint(k) *
                 (source.deviation[0] +
                   (on.has(Effect::Octaves) ? source.deviation[1] : glm::dvec3(0.0)));
        });
    case Effect::ColouredExtinction:
      return this->change_by_channels(ray, on);
    case Effect::Shadows:
      return largest(
        [&](std::size_t k, const RaySource& source)
        {
          if (is_surface(k))
          {
            return this->tint(k) * this->shaded(volumes[k], ray, true) +
                   volumes[k].shading.specular * this->Light.shadings[ray].specular.dimmed;
          }
          const RaySource::Sum* sum = phase ? source.lobes : source.even;
          glm::dvec3 lost = sum[0].dimmed;
          lost += on.has(Effect::Octaves) ? sum[1].dimmed : glm::dvec3(0.0);
          lost += on.has(Effect::SilverLining) ? source.lining.dimmed : glm::dvec3(0.0);
          return this->tint(k) * lost;
        });
    case Effect::Ambient:
      return largest(
        [&](std::size_t k, const RaySource&) { return this->tint(k) * this->ambient(); });
    case Effect::Octaves:
      return largest(
        [&](std::size_t k, const RaySource& source)
        {
          return is_surface(k) ? glm::dvec3(0.0)
                               : this->tint(k) * (phase ? source.lobes : source.even)[1].all;
        });
    case Effect::GradientShading:
      return weighted(this->change_by_shading(ray, on));
    case Effect::SilverLining:
      return largest([&](std::size_t k, const RaySource& source)
        { return is_surface(k) ? glm::dvec3(0.0) : this->tint(k) * source.lining.all; });
    case Effect::Powder:
      return weighted(this->change_by_powder(ray, on));
    case Effect::Surfaces:
    {
      if (!this->SurfacesBefore)
      {
        return result;
      }
      const glm::dvec3 behind = this->radiance(ray, on);
      for (int c = 0; c < 3; ++c)
      {
        const double passes = opacity(this->channel(c, on).upper * this->Figures.view.depth[ray]);
        result[c] = on.has(Effect::Absorption) ? std::max(passes * this->behind(on)[c], behind[c])
                                               : behind[c];
      }
      return result;
    }
    case Effect::Fog: // what it takes of the light to volumes and from them
      return this->FogSeen.any ? this->FogSeen.takes * this->radiance(ray, on) : result;
    case Effect::SpaceLeaping:
      return result;
  }
  return result;
}

double EffectBounds::of(Effect effect, const EffectSet& on) const
{
  glm::dvec3 most(0.0);
  for (std::size_t ray = 0; ray < this->Figures.view.depth.size(); ++ray)
  {
    if (this->Figures.view.depth[ray] > 0.0 || this->Clear != glm::dvec3(0.0))
    {
      most = max_of(most, this->change(effect, ray, on));
    }
  }
  most += change_in_fog(effect, this->FogSeen, on);
  return std::max({ most.x, most.y, most.z });
}

}
