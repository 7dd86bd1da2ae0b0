#include "Transport/plan_light.h"

#include "Transport/phase.h"

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

/// Lights times octaves beyond which phase functions are looked at for 4 rays at once, and for 16.
constexpr std::size_t few_phases = 12;
constexpr std::size_t many_phases = 96;

double opacity(double depth)
{
  return -std::expm1(-depth);
}

/// max |p − 1/4π| over a range of angles.
double largest_deviation(const PhaseModel& model,
  double most,
  double least_cosine,
  double largest_cosine)
{
  // Each part by itself is least at an end of the range, Rayleigh's where cos² is.
  const bool side = least_cosine <= 0.0 && largest_cosine >= 0.0;
  const double square =
    side ? 0.0 : std::min(least_cosine * least_cosine, largest_cosine * largest_cosine);
  double least = model.isotropic + model.rayleigh * (1.0 + square);
  for (const PhaseTerm& term : model.terms)
  {
    const double sign = term.forward ? 1.0 : -1.0;
    const double away = 1.0 - (term.forward ? least_cosine : largest_cosine) * sign;
    const double denominator = term.least + term.slope * away;
    least += term.scale * std::pow(denominator, term.schlick ? -2.0 : -1.5);
  }
  return std::max({ most - even_phase, even_phase - least, 0.0 });
}

struct Octave
{
  double attenuation;
  double contribution;
  PhaseModel phase;
};

/// What one light does to a ray.
struct LightOnRay
{
  double least_cosine = -1.0; ///< between the directions of travel before and after
  double largest_cosine = 1.0;
  /// The light's strength: ∫ T σt E ds along the ray is at most this times ∫ T σt ds.
  double strength = 0.0;
  /// Of a lamp: its least and largest distance from places of the ray.
  double nearest = 0.0;
  double farthest = 0.0;
};

class Finder
{
public:
  Finder(const Scene& scene, const PlanFigures& figures, const ChannelRanges& channels)
    : TheScene(scene)
    , Figures(figures)
    , Channels(channels)
  {
    this->Octaves.resize(scene.volumes.size());
    this->Linings.resize(scene.volumes.size());
    for (std::size_t k = 0; k < scene.volumes.size(); ++k)
    {
      const Volume& volume = scene.volumes[k];
      this->Shaded = this->Shaded || volume.shading.enabled;
      if (volume.medium.lit)
      {
        this->prepare(k, volume.medium);
      }
      const glm::dmat4 world_from_index = volume.world_from_data * volume.data_from_index;
      this->IndexFromWorld.push_back(glm::inverse(world_from_index));
      // No unit vector of the world is longer in the data than the largest of the squares allows.
      const glm::dmat3 data_from_world = glm::inverse(glm::dmat3(volume.world_from_data));
      const glm::dmat3 squares = glm::transpose(data_from_world) * data_from_world;
      double longest = 0.0;
      for (int column = 0; column < 3; ++column)
      {
        const glm::dvec3 v = glm::abs(squares[column]);
        longest = std::max(longest, v.x + v.y + v.z);
      }
      this->Extinction += figures.matter[k].extinction * std::sqrt(longest);
    }
  }

  PlanLight find()
  {
    const std::size_t rays = this->Figures.view.depth.size();
    PlanLight light;
    light.sources.resize(this->Octaves.size());
    std::size_t phases = 0;
    for (std::size_t k = 0; k < this->Octaves.size(); ++k)
    {
      light.sources[k].resize(this->Octaves[k].empty() ? 0 : rays);
      phases += this->Octaves[k].size() * this->TheScene.lights.size();
    }
    light.shadings.resize(this->Shaded ? rays : 0);
    if (rays == 0) // no volumes
    {
      return light;
    }
    const int block = phases <= few_phases ? 1 : phases <= many_phases ? 2 : 4;
    for (std::size_t l = 0; l < this->TheScene.lights.size(); ++l)
    {
      light.lamps = light.lamps || this->TheScene.lights[l].positional;
      for (int y = 0; y < ViewFigures::edge; y += block)
      {
        for (int x = 0; x < ViewFigures::edge; x += block)
        {
          this->add_block(l, x, y, block, light);
        }
      }
    }
    return light;
  }

private:
  void prepare(std::size_t k, const Medium& medium)
  {
    double a = 1.0;
    double b = 1.0;
    double c = 1.0;
    for (int m = 0; m < medium.octaves.count; ++m)
    {
      this->Octaves[k].push_back({ a, b, prepare_phase(medium.lobes, c) });
      a *= medium.octaves.attenuation;
      b *= medium.octaves.contribution;
      c *= medium.octaves.anisotropy;
    }
    add_silver_lining(medium.silver_lining, this->Linings[k]);
  }

  /// Rays whose angles to a light are looked at together, unless it is near.
  void add_block(std::size_t l, int x, int y, int block, PlanLight& result) const
  {
    const Light& light = this->TheScene.lights[l];
    LightOnRay shared;
    std::vector<RaySource> sums(this->Octaves.size());
    if (!light.positional)
    {
      const auto middle = static_cast<std::size_t>(y + block / 2) * ViewFigures::edge +
                          static_cast<std::size_t>(x + block / 2);
      const double angle = this->angle(glm::normalize(light.direction), middle);
      // Half a cell to each side, or from the ray beside the block's middle to its far corner.
      this->range(angle, angle, (block > 1 ? block + 1 : 1) * this->Figures.view.angle, shared);
      shared.strength = 1.0;
      this->add_phases(l, shared, sums);
    }
    for (int v = y; v < y + block; ++v)
    {
      for (int u = x; u < x + block; ++u)
      {
        const std::size_t ray = static_cast<std::size_t>(v) * ViewFigures::edge + u;
        if (!(this->Figures.view.depth[ray] > 0.0))
        {
          continue;
        }
        LightOnRay here = shared;
        if (light.positional)
        {
          here = this->lamp_on_ray(l, ray);
          std::fill(sums.begin(), sums.end(), RaySource());
          this->add_phases(l, here, sums);
        }
        for (std::size_t k = 0; k < this->Octaves.size(); ++k)
        {
          if (!this->Octaves[k].empty())
          {
            result.sources[k][ray].add(sums[k]);
          }
        }
        if (this->Shaded)
        {
          const glm::dvec3 lost = this->lost(l, here, 1.0);
          result.shadings[ray].diffuse.add(light.diffuse * here.strength, lost);
          result.shadings[ray].specular.add(light.specular * here.strength, lost);
        }
      }
    }
  }

  /// The share of light number l that matter can take on its way to a ray, R, G, B: of `strength`.
  glm::dvec3 lost(std::size_t l, const LightOnRay& here, double attenuation) const
  {
    glm::dvec3 result;
    for (int c = 0; c < 3; ++c)
    {
      const double channel =
        attenuation * std::max(this->Channels.of[c].upper, this->Channels.mean.upper);
      result[c] = opacity(channel * this->Figures.lights[l]);
      if (this->TheScene.lights[l].positional && here.strength > 0.0)
      {
        result[c] = std::min(result[c], this->lost_near(l, here, channel) / here.strength);
      }
    }
    return result;
  }

  /// Near a lamp, where it is brightest, there is little matter on the way: the largest of strength
  /// times what is lost, by distance, each as large as anywhere in an interval.
  double lost_near(std::size_t l, const LightOnRay& here, double channel) const
  {
    constexpr int intervals = 12;
    const Light& light = this->TheScene.lights[l];
    const double ratio =
      here.nearest > 0.0 ? std::pow(here.farthest / here.nearest, 1.0 / intervals) : 0.0;
    if (!(ratio > 1.0) || !std::isfinite(ratio))
    {
      return std::numeric_limits<double>::infinity();
    }
    double most = 0.0;
    double distance = here.nearest;
    for (int i = 0; i < intervals; ++i)
    {
      const double beyond = distance * ratio;
      const double depth = std::min(this->Figures.lights[l],
        this->Extinction * std::max(0.0, beyond - this->Figures.clearance[l]));
      most = std::max(most, strength_at(light, distance) * opacity(channel * depth));
      distance = beyond;
    }
    return most;
  }

  static double strength_at(const Light& light, double distance)
  {
    const glm::dvec3& a = light.attenuation;
    return 1.0 / std::max(a.x + a.y * distance + a.z * distance * distance, 1e-12);
  }

  /// To each volume's sums.
  void add_phases(std::size_t l, const LightOnRay& here, std::vector<RaySource>& sums) const
  {
    const glm::dvec3 irradiance = this->TheScene.lights[l].diffuse * (pi * here.strength);
    for (std::size_t k = 0; k < this->Octaves.size(); ++k)
    {
      for (std::size_t m = 0; m < this->Octaves[k].size(); ++m)
      {
        const Octave& octave = this->Octaves[k][m];
        const glm::dvec3 light = irradiance * octave.contribution;
        const int part = m > 0;
        const glm::dvec3 lost = this->lost(l, here, octave.attenuation);
        sums[k].even[part].add(light * even_phase, lost);
        double most = octave.phase.isotropic;
        double deviation = std::abs(most - even_phase);
        if (!octave.phase.is_isotropic())
        {
          most = largest_phase(octave.phase, here.least_cosine, here.largest_cosine);
          deviation = largest_deviation(octave.phase, most, here.least_cosine, here.largest_cosine);
        }
        sums[k].lobes[part].add(light * most, lost);
        sums[k].deviation[part] += light * deviation;
      }
      if (this->Linings[k].isotropic > 0.0 || !this->Linings[k].terms.empty())
      {
        sums[k].lining.add(
          irradiance * largest_phase(this->Linings[k], here.least_cosine, here.largest_cosine),
          this->lost(l, here, 1.0));
      }
    }
  }

  /// Between light's direction of travel and the way from matter to the eye.
  double angle(const glm::dvec3& travel, std::size_t ray) const
  {
    return std::acos(std::clamp(-glm::dot(travel, this->Figures.view.direction[ray]), -1.0, 1.0));
  }

  static void range(double a, double b, double margin, LightOnRay& result)
  {
    result.largest_cosine = std::cos(std::max(0.0, std::min(a, b) - margin));
    result.least_cosine = std::cos(std::min(pi, std::max(a, b) + margin));
  }

  LightOnRay lamp_on_ray(std::size_t l, std::size_t ray) const
  {
    const Light& light = this->TheScene.lights[l];
    LightOnRay result;
    double from = 0.0;
    double to = 0.0;
    if (!this->inside(ray, from, to))
    {
      return result;
    }
    // Places on the ray are counted from the one nearest to the lamp, whose distance is `aside`: at
    // the least, for any ray nearer to this one than to its neighbours.
    const ViewFigures& view = this->Figures.view;
    const glm::dvec3& direction = view.direction[ray];
    const glm::dvec3 offset = light.position - view.origin[ray];
    const double middle = glm::dot(offset, direction);
    const double begin = from - middle;
    const double end = to - middle;
    const double width = view.width + view.angle * to;
    const double aside = std::max(0.0, glm::length(offset - direction * middle) - width);
    const double beyond = std::max({ begin, -end, 0.0 });
    const double clear = this->Figures.clearance[l];
    const double nearest = std::max(clear, std::sqrt(aside * aside + beyond * beyond));
    const auto travel = [&](double s)
    {
      const glm::dvec3 way = direction * (s + middle) - offset;
      const double length = glm::length(way);
      return length > 0.0 ? way / length : direction;
    };
    const double turn = nearest > width ? view.angle + std::asin(width / nearest) : pi;
    range(this->angle(travel(begin), ray), this->angle(travel(end), ray), turn, result);

    const glm::dvec3& a = light.attenuation;
    result.strength = strength_at(light, nearest);
    // In intervals of distance, the first as short as to make no difference.
    result.nearest = std::max(nearest, 1e-4 * (width + clear));
    const double out = std::max(std::abs(begin), std::abs(end));
    result.farthest = std::sqrt(out * out + std::pow(aside + 2.0 * width, 2.0));
    if (a.z > 0.0)
    {
      // The largest extinction times ∫ ds / (a + c (aside² + s²)) is a bound of its own.
      const double least = 1e-6 * view.edge_of_voxel;
      const double r = std::sqrt(std::max(aside * aside + a.x / a.z, least * least));
      double integral = (std::atan(end / r) - std::atan(begin / r)) / (a.z * r);
      if (clear > 0.0) // there d² ≥ (clear² + s²) / 2
      {
        integral = std::min(
          integral, 2.0 * (std::atan(end / clear) - std::atan(begin / clear)) / (a.z * clear));
      }
      double least_channel = this->Channels.mean.lower;
      double largest_channel = this->Channels.mean.upper;
      for (const ChannelRanges::Range& channel : this->Channels.of)
      {
        least_channel = std::min(least_channel, channel.lower);
        largest_channel = std::max(largest_channel, channel.upper);
      }
      const double weight = opacity(least_channel * view.depth[ray]);
      if (weight > 0.0)
      {
        result.strength =
          std::min(result.strength, largest_channel * this->Extinction * integral / weight);
      }
    }
    return result;
  }

  /// The part of a ray in the volumes' boxes, or none.
  bool inside(std::size_t ray, double& from, double& to) const
  {
    constexpr double infinite = std::numeric_limits<double>::infinity();
    const ViewFigures& view = this->Figures.view;
    from = infinite;
    to = -infinite;
    for (std::size_t k = 0; k < this->IndexFromWorld.size(); ++k)
    {
      const Grid& grid = this->TheScene.volumes[k].grid;
      const glm::dvec3 origin(this->IndexFromWorld[k] * glm::dvec4(view.origin[ray], 1.0));
      const glm::dvec3 way(this->IndexFromWorld[k] * glm::dvec4(view.direction[ray], 0.0));
      double enter = 0.0;
      double leave = view.reach[ray];
      for (int axis = 0; axis < 3; ++axis)
      {
        // Some way beyond, for the rays between this one and its neighbours.
        const double margin = (grid.upper(axis) - grid.lower(axis)) / ViewFigures::edge;
        const double low = grid.lower(axis) - margin - origin[axis];
        const double high = grid.upper(axis) + margin - origin[axis];
        if (way[axis] == 0.0)
        {
          leave = low <= 0.0 && high >= 0.0 ? leave : -infinite;
          continue;
        }
        enter = std::max(enter, std::min(low / way[axis], high / way[axis]));
        leave = std::min(leave, std::max(low / way[axis], high / way[axis]));
      }
      if (enter < leave)
      {
        from = std::min(from, enter);
        to = std::max(to, leave);
      }
    }
    return from < to;
  }

  const Scene& TheScene;
  const PlanFigures& Figures;
  const ChannelRanges& Channels;
  std::vector<std::vector<Octave>> Octaves; ///< none for a volume that is not lit
  std::vector<PhaseModel> Linings;
  std::vector<glm::dmat4> IndexFromWorld;
  double Extinction = 0.0; ///< the largest, of a channel of 1, per unit of the world
  bool Shaded = false;
};

}

ChannelRanges channel_ranges(const Scene& scene)
{
  constexpr double infinite = std::numeric_limits<double>::infinity();
  ChannelRanges ranges;
  if (scene.volumes.empty())
  {
    return ranges;
  }
  ranges.mean = { infinite, 0.0 };
  std::fill(ranges.of, ranges.of + 3, ranges.mean);
  const auto include = [](ChannelRanges::Range& range, double value)
  {
    range.lower = std::min(range.lower, value);
    range.upper = std::max(range.upper, value);
  };
  for (const Volume& volume : scene.volumes)
  {
    const bool density = volume.meaning == ValueMeaning::Density;
    const glm::dvec3 channels = density ? volume.density.channels : glm::dvec3(1.0);
    for (int c = 0; c < 3; ++c)
    {
      include(ranges.of[c], channels[c]);
    }
    include(ranges.mean, (channels.x + channels.y + channels.z) / 3.0);
  }
  return ranges;
}

PlanLight find_light(const Scene& scene, const PlanFigures& figures, const ChannelRanges& channels)
{
  return Finder(scene, figures, channels).find();
}

}
