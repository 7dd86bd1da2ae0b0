#include "Transport/path_fog.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace brume
{

namespace
{

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Transport depths between the floor and what is over it.
constexpr double floor_depth = 16.0;

double mean_cosine(const std::vector<PhaseLobe>& lobes)
{
  double sum = 0.0;
  double weights = 0.0;
  for (const PhaseLobe& lobe : lobes)
  {
    const double weight = std::max(lobe.weight, 0.0);
    const bool has_one =
      lobe.function == PhaseFunction::HenyeyGreenstein || lobe.function == PhaseFunction::Schlick;
    sum += has_one ? weight * std::clamp(lobe.anisotropy, -most_anisotropy, most_anisotropy) : 0.0;
    weights += weight;
  }
  return weights > 0.0 ? sum / weights : 0.0;
}

bool shines(const glm::dvec3& light)
{
  return light.x > 0.0 || light.y > 0.0 || light.z > 0.0;
}

void check(const Scene& scene, int most_scatterings, bool from_infinity)
{
  const Fog& fog = scene.fog;
  if (fog.falloff > 0.0 || !shines(fog.albedo))
  {
    return;
  }
  if (from_infinity && most_scatterings != 1)
  {
    throw std::invalid_argument(
      "light from infinity never comes to an end in fog without falloff: give the fog a falloff, "
      "or follow one scattering, as the ray march does");
  }
  if (most_scatterings == 0 && std::max({ fog.albedo.x, fog.albedo.y, fog.albedo.z }) >= 1.0)
  {
    throw std::invalid_argument(
      "paths never come to an end in fog without falloff that absorbs nothing: give the fog a "
      "falloff or an albedo below 1, or limit the scatterings");
  }
}

}

PathFog::PathFog(const Scene& scene, int most_scatterings)
  : Model(scene)
  , Phase(scene.fog.lobes)
  , Extinction(scene.fog.extinction)
  , Albedo(scene.fog.albedo)
  , Up(scene.sky.up)
  , Falloff(scene.fog.falloff)
  , BaseHeight(scene.fog.base_height)
{
  const auto lower = [this](const glm::dvec3& place)
  { this->Lowest = std::min(this->Lowest, glm::dot(place, this->Up) - this->BaseHeight); };
  bool from_infinity = shines(scene.sky.radiance) || shines(scene.sky.ground);
  for (const Light& light : scene.lights)
  {
    if (light.positional)
    {
      lower(light.position);
    }
    else
    {
      from_infinity |= shines(light.diffuse);
    }
  }
  check(scene, most_scatterings, from_infinity);
  for (const Volume& volume : scene.volumes)
  {
    for (int corner = 0; corner < 8; ++corner)
    {
      glm::dvec4 place(1.0);
      for (int axis = 0; axis < 3; ++axis)
      {
        place[axis] = corner >> axis & 1 ? volume.grid.upper(axis) : volume.grid.lower(axis);
      }
      lower(glm::dvec3(volume.world_from_data * volume.data_from_index * place));
    }
  }
  double clearest = infinity;
  for (int c = 0; c < 3; ++c)
  {
    if (this->Albedo[c] >= 1.0 && this->Extinction[c] > 0.0)
    {
      this->Conservative[c] = 1.0;
      clearest = std::min(clearest, this->Extinction[c]);
    }
  }
  this->HasFloor = this->Falloff > 0.0 && most_scatterings == 0 && clearest < infinity;
  if (this->HasFloor)
  {
    const double forward = std::max(mean_cosine(scene.fog.lobes), 0.0);
    this->Added = floor_depth * this->Falloff / (clearest * (1.0 - forward));
  }
}

double PathFog::place_of_depth(const FogRay& ray, double depth, int channel) const
{
  const double extinction = this->Extinction[channel];
  return extinction > 0.0 ? this->Model.place_of_column(ray, 0.0, depth / extinction) : infinity;
}

glm::dvec3 PathFog::transmittance_to_infinity(const FogRay& ray) const
{
  return this->Falloff > 0.0 ? this->transmittance(ray, infinity) : glm::dvec3(1.0);
}

double PathFog::floor(const glm::dvec3& begin) const
{
  if (!this->HasFloor)
  {
    return -infinity;
  }
  const double lowest = std::min(this->Lowest, glm::dot(begin, this->Up) - this->BaseHeight);
  const double profile = std::exp(-this->Falloff * lowest) + this->Added;
  return profile < infinity ? -std::log(profile) / this->Falloff : -infinity;
}

double PathFog::floor_place(const FogRay& ray, double floor)
{
  return ray.slope < 0.0 && floor > -infinity ? std::max((floor - ray.height) / ray.slope, 0.0)
                                              : infinity;
}

glm::dvec3 PathFog::from_floor(RandomStream& random) const
{
  const double cosine = std::sqrt(random.uniform());
  return direction_around(this->Up, 1.0 - cosine, random.uniform());
}

glm::dvec3 FogVeil::passed(double at, int hero) const
{
  const glm::dvec3& k = this->Fog->base_extinction();
  const double column = this->Fog->column(this->Ray, at + this->Before);
  const double drawn = this->Undrawn ? 0.0 : k[hero];
  glm::dvec3 result(1.0);
  for (int c = 0; c < 3; ++c)
  {
    if (k[c] != drawn)
    {
      result[c] = std::exp(-(k[c] - drawn) * column);
    }
  }
  return result;
}

}
