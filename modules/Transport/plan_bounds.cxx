#include "Transport/plan_bounds.h"

#include "Transport/black_body.h"
#include "Transport/exponential_integral.h"
#include "Transport/phase.h"
#include "Transport/step_control.h"
#include "Transport/zoom.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace brume
{

namespace
{

constexpr double pi = 3.14159265358979323846;
constexpr double even_phase = 1.0 / (4.0 * pi);

glm::dvec3 max_of(const glm::dvec3& a, const glm::dvec3& b)
{
  return glm::max(a, b);
}

/// max |p − 1/4π| over a range of angles.
double largest_deviation(const PhaseModel& model, double least_cosine, double largest_cosine)
{
  const double most = largest_phase(model, least_cosine, largest_cosine);
  // Each part by itself is least at an end of the range, Rayleigh's where cos² is.
  const bool side = least_cosine <= 0.0 && largest_cosine >= 0.0;
  const double square =
    side ? 0.0 : std::min(least_cosine * least_cosine, largest_cosine * largest_cosine);
  double least = model.isotropic + model.rayleigh * (1.0 + square);
  for (const PhaseTerm& term : model.terms)
  {
    PhaseModel part;
    part.terms = { term };
    least += std::min(largest_phase(part, least_cosine, least_cosine),
      largest_phase(part, largest_cosine, largest_cosine));
  }
  return std::max({ most - even_phase, even_phase - least, 0.0 });
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

double opacity(double depth)
{
  return -std::expm1(-depth);
}

}

EffectBounds::EffectBounds(const Scene& scene, const PlanFigures& figures)
  : TheScene(scene)
  , Figures(figures)
  , Gain(scene.mixture == Mixture::Components ? static_cast<double>(scene.volumes.size()) : 1.0)
{
  this->find_channels();
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
  this->find_rays();
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

void EffectBounds::find_channels()
{
  constexpr double infinite = std::numeric_limits<double>::infinity();
  for (Range& range : this->Channels)
  {
    range = { infinite, 0.0 };
  }
  this->Mean = { infinite, 0.0 };
  for (const Volume& volume : this->TheScene.volumes)
  {
    const bool density = volume.meaning == ValueMeaning::Density;
    const glm::dvec3 channels = density ? volume.density.channels : glm::dvec3(1.0);
    const double mean = (channels.x + channels.y + channels.z) / 3.0;
    const auto include = [](Range& range, double value)
    {
      range.lower = std::min(range.lower, value);
      range.upper = std::max(range.upper, value);
    };
    for (int c = 0; c < 3; ++c)
    {
      include(this->Channels[c], channels[c]);
    }
    include(this->Mean, mean);
  }
  const double toward =
    this->Figures.lights.empty()
      ? 0.0
      : *std::max_element(this->Figures.lights.begin(), this->Figures.lights.end());
  for (int c = 0; c < 3; ++c)
  {
    for (const double a : { this->Channels[c].lower, this->Channels[c].upper })
    {
      for (const double b : { this->Mean.lower, this->Mean.upper })
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

double EffectBounds::thickest_channel() const
{
  return std::max({ this->Channels[0].upper, this->Channels[1].upper, this->Channels[2].upper });
}

bool EffectBounds::inside(std::size_t ray, double& from, double& to) const
{
  const ViewFigures& view = this->Figures.view;
  from = std::numeric_limits<double>::infinity();
  to = -from;
  for (const Volume& volume : this->TheScene.volumes)
  {
    const glm::dmat4 index_from_world =
      glm::inverse(volume.world_from_data * volume.data_from_index);
    const glm::dvec3 origin(index_from_world * glm::dvec4(view.origin[ray], 1.0));
    const glm::dvec3 way(index_from_world * glm::dvec4(view.direction[ray], 0.0));
    double enter = 0.0;
    double leave = view.reach[ray];
    for (int axis = 0; axis < 3; ++axis)
    {
      // Some way beyond, for the rays between this one and its neighbours.
      const double size = volume.grid.upper(axis) - volume.grid.lower(axis);
      const double margin = size / ViewFigures::edge;
      double a = (volume.grid.lower(axis) - margin - origin[axis]) / way[axis];
      double b = (volume.grid.upper(axis) + margin - origin[axis]) / way[axis];
      if (way[axis] == 0.0)
      {
        const bool between = origin[axis] >= volume.grid.lower(axis) - margin &&
                             origin[axis] <= volume.grid.upper(axis) + margin;
        a = between ? -std::numeric_limits<double>::infinity() : leave + 1.0;
        b = between ? std::numeric_limits<double>::infinity() : leave + 1.0;
      }
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    if (enter < leave)
    {
      from = std::min(from, enter);
      to = std::max(to, leave);
    }
  }
  return from < to;
}

EffectBounds::LightOnRay EffectBounds::light_on_ray(const Light& light, std::size_t ray) const
{
  const ViewFigures& view = this->Figures.view;
  const glm::dvec3& direction = view.direction[ray];
  const auto angle_of = [&](const glm::dvec3& travel)
  { return std::acos(std::clamp(-glm::dot(travel, direction), -1.0, 1.0)); };
  LightOnRay result;
  const auto between = [&](double a, double b, double margin)
  {
    result.largest_cosine = std::cos(std::max(0.0, std::min(a, b) - margin));
    result.least_cosine = std::cos(std::min(pi, std::max(a, b) + margin));
  };
  if (!light.positional)
  {
    const double angle = angle_of(glm::normalize(light.direction));
    between(angle, angle, view.angle);
    result.strength = 1.0;
    return result;
  }
  double from = 0.0;
  double to = 0.0;
  if (!this->inside(ray, from, to))
  {
    return result;
  }
  // s: from the place nearest to the lamp, whose distance is `aside`.
  const glm::dvec3 offset = light.position - view.origin[ray];
  const double middle = glm::dot(offset, direction);
  const double begin = from - middle;
  const double end = to - middle;
  const double width = view.width + view.angle * to;
  const double aside = std::max(0.0, glm::length(offset - direction * middle) - width);
  const double beyond = std::max({ begin, -end, 0.0 });
  const double nearest = std::sqrt(aside * aside + beyond * beyond);
  const auto travel = [&](double s)
  {
    const glm::dvec3 way = direction * (s + middle) - offset;
    const double length = glm::length(way);
    return length > 0.0 ? way / length : direction;
  };
  const double turn = nearest > width ? view.angle + std::asin(width / nearest) : pi;
  between(angle_of(travel(begin)), angle_of(travel(end)), turn);

  const glm::dvec3& a = light.attenuation;
  const double strongest = 1.0 / std::max(a.x + a.y * nearest + a.z * nearest * nearest, 1e-12);
  result.strength = strongest;
  if (a.z > 0.0)
  {
    // ∫ ds / (a + c (aside² + s²)), times the largest extinction, is a bound of its own.
    const double least = 1e-6 * view.edge_of_voxel;
    const double r = std::sqrt(std::max(aside * aside + a.x / a.z, least * least));
    const double integral = (std::atan(end / r) - std::atan(begin / r)) / (a.z * r);
    double extinction = 0.0;
    double least_channel = this->Mean.lower;
    double largest_channel = this->Mean.upper;
    for (const Range& range : this->Channels)
    {
      least_channel = std::min(least_channel, range.lower);
      largest_channel = std::max(largest_channel, range.upper);
    }
    for (std::size_t k = 0; k < this->TheScene.volumes.size(); ++k)
    {
      const glm::dmat3 data_from_world =
        glm::inverse(glm::dmat3(this->TheScene.volumes[k].world_from_data));
      extinction += this->Figures.matter[k].extinction * glm::length(data_from_world * direction);
    }
    const double weight = opacity(least_channel * view.depth[ray]);
    if (weight > 0.0)
    {
      result.strength = std::min(strongest, largest_channel * extinction * integral / weight);
    }
  }
  return result;
}

void EffectBounds::find_rays()
{
  const std::size_t rays = this->Figures.view.depth.size();
  const std::vector<Volume>& volumes = this->TheScene.volumes;
  const std::vector<Light>& all = this->TheScene.lights;
  struct Prepared
  {
    double attenuation;
    double contribution;
    PhaseModel phase;
  };
  std::vector<std::vector<Prepared>> octaves(volumes.size());
  std::vector<PhaseModel> linings(volumes.size());
  bool shaded = false;
  for (std::size_t k = 0; k < volumes.size(); ++k)
  {
    const Medium& medium = volumes[k].medium;
    shaded = shaded || volumes[k].shading.enabled;
    if (!medium.lit)
    {
      continue;
    }
    double a = 1.0;
    double b = 1.0;
    double c = 1.0;
    for (int m = 0; m < medium.octaves.count; ++m)
    {
      octaves[k].push_back({ a, b, prepare_phase(medium.lobes, c) });
      a *= medium.octaves.attenuation;
      b *= medium.octaves.contribution;
      c *= medium.octaves.anisotropy;
    }
    add_silver_lining(medium.silver_lining, linings[k]);
  }
  this->Sources.assign(volumes.size(), {});
  for (std::size_t k = 0; k < volumes.size(); ++k)
  {
    this->Sources[k].resize(volumes[k].medium.lit ? rays : 0);
  }
  this->Shadings.resize(shaded ? rays : 0);
  for (const Light& light : all)
  {
    this->Lamps = this->Lamps || light.positional;
  }
  for (std::size_t l = 0; l < all.size(); ++l)
  {
    // What of the light each octave can lose on its way, R, G, B.
    glm::dvec3 depth;
    for (int c = 0; c < 3; ++c)
    {
      depth[c] = this->Figures.lights[l] * std::max(this->Channels[c].upper, this->Mean.upper);
    }
    const auto dimmed = [&](double attenuation)
    {
      return glm::dvec3(opacity(attenuation * depth.x),
        opacity(attenuation * depth.y),
        opacity(attenuation * depth.z));
    };
    for (std::size_t ray = 0; ray < rays; ++ray)
    {
      if (!(this->Figures.view.depth[ray] > 0.0))
      {
        continue;
      }
      const LightOnRay here = this->light_on_ray(all[l], ray);
      if (shaded)
      {
        this->Shadings[ray].diffuse.add(all[l].diffuse * here.strength, dimmed(1.0));
        this->Shadings[ray].specular.add(all[l].specular * here.strength, dimmed(1.0));
      }
      const glm::dvec3 irradiance = all[l].diffuse * (pi * here.strength);
      for (std::size_t k = 0; k < volumes.size(); ++k)
      {
        for (std::size_t m = 0; m < octaves[k].size(); ++m)
        {
          const Prepared& octave = octaves[k][m];
          const glm::dvec3 light = irradiance * octave.contribution;
          RaySource& source = this->Sources[k][ray];
          const int part = m > 0;
          const glm::dvec3 lost = dimmed(octave.attenuation);
          source.even[part].add(light * even_phase, lost);
          if (octave.phase.is_isotropic())
          {
            source.lobes[part].add(light * octave.phase.isotropic, lost);
            source.deviation[part] += light * std::abs(octave.phase.isotropic - even_phase);
            continue;
          }
          source.lobes[part].add(
            light * largest_phase(octave.phase, here.least_cosine, here.largest_cosine), lost);
          source.deviation[part] +=
            light * largest_deviation(octave.phase, here.least_cosine, here.largest_cosine);
        }
        if (volumes[k].medium.lit && volumes[k].medium.silver_lining.enabled)
        {
          this->Sources[k][ray].lining.add(
            irradiance * largest_phase(linings[k], here.least_cosine, here.largest_cosine),
            dimmed(1.0));
        }
      }
    }
  }
}

EffectBounds::Range EffectBounds::channel(int c, const EffectSet& on) const
{
  return on.has(Effect::ColouredExtinction) ? this->Channels[c] : this->Mean;
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
  const RayShading& light = this->Shadings[ray];
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
           volume.shading.specular * this->Shadings[ray].specular.all;
  }
  return this->tint(k) * (around + this->lights(volume, this->Sources[k][ray], on));
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
                                volume.shading.specular * this->Shadings[ray].specular.all[c]
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
          volume.shading.specular * this->Shadings[ray].specular.all);
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
    const Range& coloured = this->Channels[c];
    const Range& mean = this->Mean;
    double view = 0.0;  // of the transmittance
    double share = 0.0; // of σ T along the ray
    for (const double a : { coloured.lower, coloured.upper })
    {
      for (const double b : { mean.lower, mean.upper })
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
        most = max_of(most, of_volume(k, this->Sources[k][ray]));
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
      const glm::dvec3 some = this->Lamps ? glm::dvec3(0.0) : this->radiance(ray, on);
      for (int c = 0; c < 3; ++c)
      {
        const double passes = opacity(this->channel(c, on).upper * this->Figures.view.depth[ray]);
        result[c] = passes + std::max(0.0, all[c] - some[c]);
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
                   volumes[k].shading.specular * this->Shadings[ray].specular.dimmed;
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
        result[c] = on.has(Effect::Absorption) ? std::max(passes, behind[c]) : behind[c];
      }
      return result;
    }
    case Effect::Fog:
    case Effect::SpaceLeaping:
      return result;
  }
  return result;
}

double EffectBounds::of(Effect effect, const EffectSet& on) const
{
  double most = 0.0;
  for (std::size_t ray = 0; ray < this->Figures.view.depth.size(); ++ray)
  {
    if (this->Figures.view.depth[ray] > 0.0 || this->Clear != glm::dvec3(0.0))
    {
      const glm::dvec3 change = this->change(effect, ray, on);
      most = std::max({ most, change.x, change.y, change.z });
    }
  }
  return most;
}

}
