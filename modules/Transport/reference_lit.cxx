// Lit media and coloured extinction.
#include "Transport/reference_integrators.h"

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>

namespace brume
{

namespace
{

/// The three-stage Gauss–Legendre rule on [0, 1]: the points, and for each the weights of the three
/// values for the integral from 0 to it and, last, to 1 (E. Hairer, S. P. Nørsett, G. Wanner,
/// Solving Ordinary Differential Equations I, 1993, II.7).
constexpr double root_15 = 3.87298334620741688518;
constexpr double gauss_points[3] = { 0.5 - root_15 / 10.0, 0.5, 0.5 + root_15 / 10.0 };
constexpr double gauss_weights[4][3] = {
  { 5.0 / 36.0, 2.0 / 9.0 - root_15 / 15.0, 5.0 / 36.0 - root_15 / 30.0 },
  { 5.0 / 36.0 + root_15 / 24.0, 2.0 / 9.0, 5.0 / 36.0 - root_15 / 24.0 },
  { 5.0 / 36.0 + root_15 / 30.0, 2.0 / 9.0 + root_15 / 15.0, 5.0 / 36.0 },
  { 5.0 / 18.0, 4.0 / 9.0, 5.0 / 18.0 },
};

/// Below this transmittance nothing is followed; less than nothing_passes, as what is behind may be
/// far brighter than what is in front.
constexpr double nothing_lit_passes = 1e-14;

/// The places of a ray at which a light near it begins or ceases to shine, and ever closer ones
/// toward its foot, where attenuation and angle change with the logarithm of the distance.
void add_light_cuts(const Light& light, const PixelRay& ray, std::vector<double>& cuts)
{
  if (!light.positional || !(ray.world_length > 0.0))
  {
    return;
  }
  const glm::dvec3 offset = ray.world_begin - light.position;
  const double square = ray.world_length * ray.world_length;
  const double foot = -glm::dot(offset, ray.world_along) / square;
  cuts.push_back(foot);
  const double distance = glm::length(offset + foot * ray.world_along) / ray.world_length;
  const double furthest = std::max(std::abs(foot), std::abs(1.0 - foot));
  for (double away = std::max(distance, 1e-9 * furthest); away < furthest; away *= 2.0)
  {
    cuts.push_back(foot - away);
    cuts.push_back(foot + away);
  }
  if (light.cone_angle < 90.0)
  {
    // (axis · q)² = cos² · q² along q = offset + s · world_along.
    const double cosine = std::cos(light.cone_angle * (3.14159265358979323846 / 180.0));
    const double share = cosine * cosine;
    const glm::dvec3 axis = glm::normalize(light.direction);
    const double p = glm::dot(axis, offset);
    const double q = glm::dot(axis, ray.world_along);
    const double a = q * q - share * square;
    const double b = p * q - share * glm::dot(offset, ray.world_along);
    const double c = p * p - share * glm::dot(offset, offset);
    const double under_root = b * b - a * c;
    if (under_root >= 0.0)
    {
      // The form that does not cancel.
      const double t = -(b + std::copysign(std::sqrt(under_root), b));
      for (const double s : { t / a, c / t })
      {
        if (std::isfinite(s))
        {
          cuts.push_back(s);
        }
      }
    }
  }
}

/// Takes a stretch of the ray, as the fog has it, that lies in no volume. `depth` is that of all so far.
void pass_fog(const FogModel& fog,
  const PixelRay& ray,
  double from,
  double to,
  glm::dvec3& depth,
  RayResult& result)
{
  if (!(to > from))
  {
    return;
  }
  const double half = fog.half_column(result.transmittance);
  if (half < fog.column(ray.fog, from, to) && std::isinf(result.half_way))
  {
    const double way = fog.place_of_column(ray.fog, from, half) - ray.fog_near_plane;
    result.half_way = ray.world_length > 0.0 ? std::max(way, 0.0) / ray.world_length : 0.0;
  }
  result.radiance += result.transmittance * fog.radiance(ray.fog, from, to);
  depth += fog.optical_depth(ray.fog, from, to);
  result.transmittance = glm::exp(-depth);
}

class LitRay final : public RayIntegral
{
public:
  LitRay(const ReferenceScene& scene, const PixelRay& ray)
    : TheScene(scene)
    , TheRay(ray)
  {
    std::vector<double> cuts;
    for (const Light& light : scene.scene.lights)
    {
      add_light_cuts(light, ray, cuts);
    }
    std::sort(cuts.begin(), cuts.end());
    this->Intervals = ray.intervals();
    for (const RayInterval& interval : this->Intervals)
    {
      CellWalk walk({ interval.from, interval.to });
      for (int v : interval.volumes)
      {
        walk.add(ray.volumes[v], scene.scene.volumes[v]);
      }
      RayPart part;
      while (walk.next(part))
      {
        auto cut = std::upper_bound(cuts.begin(), cuts.end(), part.from);
        for (double from = part.from; from < part.to; ++cut)
        {
          const double to = cut == cuts.end() ? part.to : std::min(*cut, part.to);
          this->add(interval, { from, to });
          from = to;
          if (cut == cuts.end())
          {
            break;
          }
        }
      }
    }
  }

  RayResult integrate(int pieces) const override
  {
    RayResult result;
    glm::dvec3 depth(0.0);
    // Shadow rays get finer with the pieces, but more slowly: their rule is of a higher order.
    const int shadow_pieces = static_cast<int>(std::ceil(std::sqrt(double(pieces))));
    const FogModel* fog = this->TheScene.lighting->fog();
    const auto distance = [&](double s)
    { return this->TheRay.fog_near_plane + s * this->TheRay.world_length; };
    double fog_from = 0.0;
    auto interval = this->Intervals.begin();
    for (const Stretch& stretch : this->Stretches)
    {
      for (; fog && interval != this->Intervals.end() && interval->from <= stretch.part.from;
           ++interval)
      {
        pass_fog(*fog, this->TheRay, fog_from, distance(interval->from), depth, result);
        fog_from = distance(interval->to);
      }
      const int count = pieces * stretch.factor;
      const double width = (stretch.part.to - stretch.part.from) / count;
      for (int piece = 0; piece < count; ++piece)
      {
        const double begin = stretch.part.from + width * piece;
        Sent sent[3];
        for (int i = 0; i < 3; ++i)
        {
          sent[i] = this->TheScene.lighting->sent(this->TheRay,
            this->Volumes.data() + stretch.first_volume,
            stretch.volume_count,
            begin + width * gauss_points[i],
            shadow_pieces,
            result.samples);
        }
        const auto depth_of = [&](int i)
        {
          const double* w = gauss_weights[i];
          return width * (w[0] * sent[0].extinction + w[1] * sent[1].extinction +
                           w[2] * sent[2].extinction);
        };
        for (int i = 0; i < 3; ++i)
        {
          result.radiance +=
            width * gauss_weights[3][i] * glm::exp(-(depth + depth_of(i))) * sent[i].radiance;
        }
        depth += depth_of(3);
        result.transmittance = glm::exp(-depth);
        result.passed(begin + 0.5 * width);
      }
      if (result.passes() < nothing_lit_passes)
      {
        return result;
      }
    }
    if (fog)
    {
      pass_fog(*fog, this->TheRay, fog_from, this->TheRay.fog_end, depth, result);
    }
    return result;
  }

private:
  struct Stretch
  {
    RayPart part;
    int factor;
    std::size_t first_volume;
    std::size_t volume_count;
  };

  /// What of each channel lies at a place of the ray, per unit of s.
  glm::dvec3 extinction(const RayInterval& interval, double s) const
  {
    glm::dvec3 sum(0.0);
    for (int v : interval.volumes)
    {
      const ReferenceMedium& medium = this->TheScene.media[v];
      const VolumeRay& ray = this->TheRay.volumes[v];
      const Volume& volume = this->TheScene.scene.volumes[v];
      const glm::dvec3 channels =
        medium.is_density() ? volume.density.channels : glm::dvec3(1.0);
      sum += medium.extinction(ray.place(s)) * ray.length * volume.weight * channels;
    }
    if (const FogModel* fog = this->TheScene.lighting->fog())
    {
      sum += fog->optical_depth(
        fog->profile(this->TheRay.world_place(s)) * this->TheRay.world_length);
    }
    return sum;
  }

  /// Adds a part of the ray, in halves where it is too deep for its pieces. What lies behind matter
  /// that nothing passes is left whole.
  void add(const RayInterval& interval, const RayPart& part)
  {
    if (!(part.from < part.to))
    {
      return;
    }
    const double middle = 0.5 * (part.from + part.to);
    Stretch stretch{ part, 1, this->Volumes.size(), 0 };
    for (int v : interval.volumes)
    {
      const ReferenceMedium& medium = this->TheScene.media[v];
      const VolumeRay& ray = this->TheRay.volumes[v];
      if (!medium.visible(ray.place(middle)))
      {
        continue;
      }
      this->Volumes.push_back(v);
      ++stretch.volume_count;
      const double variation = medium.variation(medium.label(ray.place(middle)),
        medium.value(ray.place(part.from)),
        medium.value(ray.place(part.to)));
      stretch.factor = std::max(stretch.factor, extra_pieces(variation));
    }
    if (stretch.volume_count == 0 && !this->TheScene.lighting->fog())
    {
      return;
    }
    const glm::dvec3 ends[3] = { this->extinction(interval, part.from),
      this->extinction(interval, middle),
      this->extinction(interval, part.to) };
    const glm::dvec3 most = glm::max(glm::max(ends[0], ends[1]), ends[2]) * (part.to - part.from);
    double depth = 0.0; // of the channels that are not gone before
    for (int c = 0; c < 3; ++c)
    {
      depth = this->DepthBefore[c] < opaque ? std::max(depth, most[c]) : depth;
    }
    // The rule is at its best where no piece is deep.
    constexpr double most_pieces = 64.0;
    if (depth > most_pieces && part.from < middle && middle < part.to)
    {
      this->Volumes.resize(stretch.first_volume);
      this->add(interval, { part.from, middle });
      this->add(interval, { middle, part.to });
      return;
    }
    this->DepthBefore +=
      glm::min(glm::min(ends[0], ends[1]), ends[2]) * (part.to - part.from);
    stretch.factor =
      std::max(stretch.factor, static_cast<int>(std::min(std::ceil(depth), most_pieces)));
    this->Stretches.push_back(stretch);
  }

  /// An optical depth that nothing passes.
  static constexpr double opaque = 40.0;
  glm::dvec3 DepthBefore{ 0.0 }; ///< of all stretches that were added, at the least

  const ReferenceScene& TheScene;
  const PixelRay& TheRay;
  std::vector<RayInterval> Intervals;
  std::vector<int> Volumes;
  std::vector<Stretch> Stretches;
};

}

std::unique_ptr<RayIntegral> make_lit(const ReferenceScene& scene, const PixelRay& ray)
{
  return std::make_unique<LitRay>(scene, ray);
}

}
