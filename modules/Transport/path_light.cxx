// What light arrives where a path scatters, and paths as a whole. The collisions with volumes:
// path_scene.cxx.
#include "Transport/path_lamps.h"
#include "Transport/path_scene.h"
#include "Transport/path_state.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace brume
{

namespace
{

using path_state::largest;
using path_state::most_candidates;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Below this weight a path goes on with a chance that is as small, and more weight if it does.
constexpr double least_weight = 0.25;

/// The distance of a place from a volume's box, or more where the volume is sheared.
double distance_from(const Volume& volume, const glm::dvec3& place)
{
  const glm::dmat4 world_from_index = volume.world_from_data * volume.data_from_index;
  glm::dvec4 nearest = glm::inverse(world_from_index) * glm::dvec4(place, 1.0);
  for (int axis = 0; axis < 3; ++axis)
  {
    nearest[axis] = std::clamp(nearest[axis], volume.grid.lower(axis), volume.grid.upper(axis));
  }
  return glm::length(glm::dvec3(world_from_index * nearest) - place);
}

double diagonal(const Volume& volume)
{
  const glm::dmat3 world_from_index(volume.world_from_data * volume.data_from_index);
  glm::dvec3 box;
  for (int axis = 0; axis < 3; ++axis)
  {
    box[axis] = volume.grid.upper(axis) - volume.grid.lower(axis);
  }
  return glm::length(world_from_index * box);
}

}

/// In the sphere light is found in one more way than by collisions, which is dear: it is no larger
/// than what light passes through, and than a quarter of what the lamp is in.
double PathScene::near_radius(const Lamp& lamp) const
{
  const Light& light = lamp.light();
  if (!light.positional || !(light.attenuation.z > 0.0))
  {
    return 0.0;
  }
  const glm::dvec3& place = light.position;
  double radius = infinity;
  double extinction = 0.0;
  if (this->Fog)
  {
    extinction = largest(this->Fog->extinction(place));
    radius = extinction > 0.0 ? radius : 0.0;
  }
  double reach = 0.0;
  for (std::size_t i = 0; i < this->Matter.size(); ++i)
  {
    const Volume& volume = this->TheScene.volumes[std::min(i, this->TheScene.volumes.size() - 1)];
    const MatterRay ray = this->Matter[i]->ray(place, glm::dvec3(1.0, 0.0, 0.0));
    const double off = distance_from(volume, place);
    const double own = 0.25 * diagonal(volume);
    if (off > own)
    {
      continue;
    }
    reach = std::max(reach, own);
    const PathBricks& bricks = this->Matter[i]->bricks();
    std::size_t brick = 0;
    for (int axis = 2; axis >= 0; --axis)
    {
      const int at = static_cast<int>(std::clamp(ray.begin[axis], 0.0, 2e9)) >> bricks.shift;
      brick = brick * bricks.dims[axis] + std::min(at, bricks.dims[axis] - 1);
    }
    extinction += bricks.rate[brick] * ray.scale;
  }
  if (reach > 0.0)
  {
    radius = reach;
  }
  else if (!this->Fog)
  {
    return 0.0;
  }
  radius = std::min(radius, 1.0 / extinction);
  // Within it the light has to fall off as 1/d².
  const glm::dvec3& a = light.attenuation;
  return a.x + a.y * radius <= a.z * radius * radius ? radius : 0.0;
}

/// What is scattered at a place of light along `along` toward `toward`, per world unit on the way
/// along it.
glm::dvec3 PathScene::scattered(const glm::dvec3& place,
  const glm::dvec3& along,
  const glm::dvec3& toward,
  bool with_volumes,
  Path& path) const
{
  glm::dvec3 sum(0.0);
  for (const auto& matter : this->Matter)
  {
    if (!with_volumes || !matter->scatters())
    {
      continue;
    }
    const MatterRay ray = matter->ray(place, along);
    if (ray.from > 0.0 || !(ray.to > 0.0))
    {
      continue;
    }
    ++path.counts.collisions;
    const double density = matter->density(ray.begin, path.random);
    if (density > 0.0)
    {
      sum += density * ray.scale * matter->phase().value(along, toward) * matter->channels() *
             matter->albedo(ray.begin);
    }
  }
  if (this->Fog)
  {
    sum +=
      this->Fog->extinction(place) * this->Fog->albedo() * this->Fog->phase().value(along, toward);
  }
  return sum;
}

/// The transmittance of everything between two places; an infinite length is toward light there.
glm::dvec3 PathScene::clearance(const glm::dvec3& begin,
  const glm::dvec3& along,
  double length,
  Path& path) const
{
  glm::dvec3 passes(1.0);
  if (this->Fog)
  {
    const FogRay ray = this->Fog->ray(begin, along);
    passes = length == infinity ? this->Fog->transmittance_to_infinity(ray)
                                : this->Fog->transmittance(ray, length);
    if (!(largest(passes) > 0.0))
    {
      return passes;
    }
  }
  return passes * this->transmittance(begin, along, length, path);
}

/// What a lamp sends on at a place that was drawn, seen from where the way to it begins.
glm::dvec3 PathScene::lit_at(
  const NearLamp& near, const LampPlace& at, bool with_volumes, Path& path) const
{
  if (!(at.weight > 0.0))
  {
    return glm::dvec3(0.0);
  }
  const Lamp& lamp = *near.lamp;
  const glm::dvec3 offset = lamp.offset(at.place);
  const glm::dvec3 toward = -lamp.travel(offset);
  glm::dvec3 light = at.weight * lamp.irradiance(offset);
  if (largest(light) > 0.0)
  {
    light *= this->scattered(at.place, at.along, toward, with_volumes, path);
  }
  if (largest(light) > 0.0)
  {
    ++path.counts.shadow_rays;
    light *= this->clearance(at.place, toward, glm::length(offset), path);
  }
  return light;
}

/// Light of near lamps that is scattered once more on a ray of the camera. `before` of it is fog
/// alone, in front of its begin.
glm::dvec3 PathScene::near_on_ray(const Sight& sight, Path& path) const
{
  glm::dvec3 sum(0.0);
  const glm::dvec3 origin = sight.begin - sight.fog_before * sight.along;
  for (const NearLamp& near : this->NearLamps)
  {
    const double length = this->Fog ? sight.fog_before + sight.fog_length : sight.length;
    const LampPlace at = near.on_ray(origin, sight.along, length, path.random);
    // Volumes are drawn from the near plane on, and to what is opaque; fog from the eye.
    const double way = at.way - (this->Fog ? sight.fog_before : 0.0);
    const bool with_volumes = way >= 0.0 && way <= sight.length;
    glm::dvec3 light = this->lit_at(near, at, with_volumes, path);
    if (largest(light) > 0.0)
    {
      ++path.counts.shadow_rays;
      if (this->Fog)
      {
        light *= this->Fog->transmittance(this->Fog->ray(origin, sight.along), at.way);
      }
      sum += light *
             this->transmittance(
               sight.begin, sight.along, std::min(at.way - sight.fog_before, sight.length), path);
    }
  }
  return sum;
}

/// Light of one near lamp that is scattered once more after a scattering here.
glm::dvec3 PathScene::near_from(const glm::dvec3& place,
  const glm::dvec3& along,
  const PhaseSampler& phase,
  Path& path) const
{
  if (this->NearLamps.empty())
  {
    return glm::dvec3(0.0);
  }
  // One is drawn by what it may bring, and seldom where that is little.
  const NearLamp* chosen = nullptr;
  double sum = 0.0;
  double weight_of_chosen = 0.0;
  double chance = 0.0;
  for (const NearLamp& near : this->NearLamps)
  {
    const glm::dvec3 off = place - near.centre();
    const double square = glm::dot(off, off);
    const double r = near.radius;
    const double weight = largest(near.lamp->light().diffuse) * r /
                          (near.lamp->light().attenuation.z * (square + r * r));
    chance = std::max(chance, square > 4.0 * r * r ? 2.0 * r / std::sqrt(square) : 1.0);
    sum += weight;
    if (!chosen || path.random.uniform() * sum < weight)
    {
      chosen = &near;
      weight_of_chosen = weight;
    }
  }
  if (!(sum > 0.0) || (chance < 1.0 && path.random.uniform() >= chance))
  {
    return glm::dvec3(0.0);
  }
  const LampPlace at = chosen->from_place(place, along, phase, path.random);
  glm::dvec3 light = this->lit_at(*chosen, at, true, path);
  if (largest(light) > 0.0)
  {
    ++path.counts.shadow_rays;
    light *= this->clearance(place, at.along, at.way, path);
  }
  return light * (sum / weight_of_chosen / chance);
}

/// One lamp is followed, with a chance that is its share of what would arrive from all without
/// shadows. Of many lamps a few are drawn by their power first, and that is done among them, which
/// is unbiased, too (J. Talbot, D. Cline, P. Egbert, Importance resampling for global illumination,
/// EGSR 2005).
glm::dvec3 PathScene::lit(const glm::dvec3& place,
  const glm::dvec3& along,
  const PhaseSampler& phase,
  Path& path) const
{
  const std::size_t lamps = this->Lamps.size();
  const bool all = lamps <= most_candidates;
  const Lamp* chosen = nullptr;
  glm::dvec3 arrives(0.0);
  double chosen_brightness = 0.0;
  double sum = 0.0;
  for (std::size_t i = 0; i < std::min(lamps, most_candidates); ++i)
  {
    std::size_t which = i;
    double weight = 1.0; // of one candidate, by the chance to be one
    if (!all)
    {
      const auto end = this->LampUpTo.end() - 1;
      const auto at = std::upper_bound(this->LampUpTo.begin(), end, path.random.uniform());
      which = at - this->LampUpTo.begin();
      const double chance = *at - (which > 0 ? this->LampUpTo[which - 1] : 0.0);
      weight = 1.0 / (chance * static_cast<double>(most_candidates));
    }
    const Lamp& lamp = this->Lamps[which];
    const glm::dvec3 offset = lamp.offset(place);
    if (this->NearRadius[which] > 0.0 && glm::length(offset) < this->NearRadius[which])
    {
      continue; // near_on_ray and near_from find it
    }
    const glm::dvec3 light = lamp.irradiance(offset) * phase.value(along, -lamp.travel(offset));
    const double brightness = largest(path.kept * light);
    if (!(brightness > 0.0))
    {
      continue;
    }
    sum += weight * brightness;
    if (!chosen || path.random.uniform() * sum < weight * brightness)
    {
      chosen = &lamp;
      arrives = light;
      chosen_brightness = brightness;
    }
  }
  if (!chosen)
  {
    return glm::dvec3(0.0);
  }
  const glm::dvec3 offset = chosen->offset(place);
  const double way = chosen->is_positional() ? glm::length(offset) : infinity;
  ++path.counts.shadow_rays;
  return arrives * (sum / chosen_brightness) *
         this->clearance(place, -chosen->travel(offset), way, path);
}

/// Light from all around, in a direction drawn by how much of it comes from there; weighted with
/// the balance heuristic against directions drawn by the phase function (E. Veach, L. J. Guibas,
/// Optimally combining sampling techniques for Monte Carlo rendering, SIGGRAPH 1995).
glm::dvec3 PathScene::lit_from_around(const glm::dvec3& place,
  const glm::dvec3& along,
  const PhaseSampler& phase,
  Path& path) const
{
  const glm::dvec3 toward = this->Around.sample(path.random);
  const double p = phase.value(along, toward);
  const double density = this->Around.density(toward);
  if (!(p > 0.0) || !(density > 0.0))
  {
    return glm::dvec3(0.0);
  }
  ++path.counts.shadow_rays;
  return this->Around.radiance(toward) * (p / (p + density)) *
         this->clearance(place, toward, infinity, path);
}

/// What comes from all around to a path that was sent this way by a phase function of this value.
glm::dvec3 PathScene::sky(const glm::dvec3& toward, double phase) const
{
  const glm::dvec3 radiance = this->Around.radiance(toward);
  return this->AroundIsSought ? radiance / (1.0 + this->Around.density(toward) / phase) : radiance;
}

/// The first collision with a volume or the fog, or its floor. Fog is one more Poisson process,
/// whose first collision is drawn in closed form.
bool PathScene::meet(const Sight& sight, double floor, Path& path, Collision& found) const
{
  if (!this->Fog)
  {
    return this->collide(sight.begin, sight.along, sight.length, path, found);
  }
  const FogRay ray = this->Fog->ray(sight.begin - sight.fog_before * sight.along, sight.along);
  const FogVeil veil(*this->Fog, ray, sight.fog_before, sight.fog_undrawn);
  path.veil = &veil;
  double fog_at = infinity;
  double floor_at = infinity;
  if (!sight.fog_undrawn)
  {
    const double depth = -std::log(path.random.uniform());
    fog_at = this->Fog->place_of_depth(ray, depth, path.hero) - sight.fog_before;
    floor_at = PathFog::floor_place(ray, floor) - sight.fog_before;
  }
  const double end = std::min({ sight.fog_length, fog_at, floor_at });
  const bool volume =
    this->collide(sight.begin, sight.along, std::min(sight.length, end), path, found);
  path.veil = nullptr;
  if (sight.fog_undrawn)
  {
    return volume;
  }
  if (this->Coloured)
  {
    path.chances *= veil.passed(volume ? found.at : end, path.hero);
  }
  if (volume)
  {
    return true;
  }
  found.at = end;
  found.floor = floor_at < infinity && floor_at <= end;
  if (!found.floor && fog_at < infinity && fog_at <= end)
  {
    const glm::dvec3& k = this->Fog->base_extinction();
    path.chances *= k / k[path.hero];
    return true;
  }
  return found.floor;
}

glm::dvec3 PathScene::radiance(const Sight& from, RandomStream& random, PathCounts& counts) const
{
  const int most_scatterings = this->MostScatterings;
  Path path{ random, counts };
  if (this->Coloured)
  {
    path.hero = static_cast<int>(3.0 * random.uniform());
  }
  Sight sight = from;
  glm::dvec3 sum = this->near_on_ray(sight, path);
  double floor = this->Fog ? this->Fog->floor(sight.begin) : -infinity;
  double phase_value = 0.0;
  for (int scatterings = 0;; ++scatterings)
  {
    Collision found;
    const bool last = most_scatterings > 0 && scatterings == most_scatterings;
    // Light from infinity is undimmed in fog without falloff, and with a limit on scatterings that
    // is the last leg of the path.
    sight.fog_undrawn = this->Fog && last && !this->Fog->is_layered();
    const bool collides = this->meet(sight, floor, path, found);
    sum += found.emitted;
    if (!collides)
    {
      return scatterings > 0 ? sum + path.weight() * this->sky(sight.along, phase_value) : sum;
    }
    sight.begin += found.at * sight.along;
    sight.fog_before = 0.0;
    sight.length = sight.fog_length = infinity;
    if (found.floor)
    {
      // The channels that fog absorbs go on below it.
      const glm::dvec3& reflected = this->Fog->conservative();
      const glm::dvec3 others = 1.0 - reflected;
      const bool both = largest(path.kept * reflected) > 0.0 && largest(path.kept * others) > 0.0;
      const bool reflects = both ? random.uniform() < 0.5 : largest(path.kept * reflected) > 0.0;
      path.kept *= (both ? 2.0 : 1.0) * (reflects ? reflected : others);
      if (reflects)
      {
        sight.along = this->Fog->from_floor(random);
        phase_value = infinity; // nothing else looks for light there
      }
      else
      {
        floor = -infinity;
      }
      continue;
    }
    const bool in_fog = !found.matter;
    if (last || !(in_fog ? this->Fog->scatters() : found.matter->scatters()))
    {
      return sum;
    }
    path.kept *= in_fog ? this->Fog->albedo() : found.matter->albedo(found.place);
    const double weight = largest(path.weight());
    if (weight < least_weight)
    {
      const double chance = weight / (2.0 * least_weight);
      if (!(weight > 0.0) || random.uniform() >= chance)
      {
        return sum;
      }
      path.kept /= chance;
    }
    counts.scatter();
    const PhaseSampler& phase = in_fog ? this->Fog->phase() : found.matter->phase();
    glm::dvec3 arrives = this->lit(sight.begin, sight.along, phase, path);
    if (this->AroundIsSought)
    {
      arrives += this->lit_from_around(sight.begin, sight.along, phase, path);
    }
    const bool ends = scatterings + 1 == most_scatterings;
    if (!ends)
    {
      arrives += this->near_from(sight.begin, sight.along, phase, path);
    }
    sum += path.weight() * arrives;
    if (ends && !this->Glows)
    {
      return sum; // nothing more can come
    }
    const glm::dvec3 before = sight.along;
    sight.along = phase.sample(before, random);
    phase_value = this->AroundIsSought ? phase.value(before, sight.along) : 0.0;
  }
}

}
