#include "Transport/fog.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace brume
{

namespace
{

constexpr double pi = 3.14159265358979323846;
/// Deeper makes no difference, and its square is within range.
constexpr double largest_depth = 1e150;
constexpr double infinity = std::numeric_limits<double>::infinity();

void require(bool condition, const char* otherwise)
{
  if (!condition)
  {
    throw std::invalid_argument(otherwise);
  }
}

bool within(const glm::dvec3& v, double lower, double upper)
{
  return v.x >= lower && v.y >= lower && v.z >= lower && v.x <= upper && v.y <= upper &&
         v.z <= upper;
}

/// k · amount, 0 where k is 0 and the amount infinite.
double times(double k, double amount)
{
  return k > 0.0 ? k * amount : 0.0;
}

}

bool has_fog(const Scene& scene)
{
  const Fog& fog = scene.fog;
  return scene.blend_mode == BlendMode::Composite && fog.enabled &&
         (fog.extinction.x > 0.0 || fog.extinction.y > 0.0 || fog.extinction.z > 0.0);
}

FogModel::FogModel(const Scene& scene)
{
  constexpr double most = std::numeric_limits<double>::max();
  const Fog& fog = scene.fog;
  require(within(fog.extinction, 0.0, most),
    "the fog's extinction must be finite and not negative in each channel");
  require(within(fog.albedo, 0.0, 1.0), "the fog's albedo must be from 0 to 1 in each channel");
  require(fog.falloff >= 0.0 && std::isfinite(fog.falloff),
    "the fog's falloff must be finite and not negative: turn Sky::up round for fog that thickens "
    "upward");
  require(std::isfinite(fog.base_height), "the fog's base height must be finite");
  require(within(scene.sky.radiance, 0.0, most) && within(scene.sky.ground, 0.0, most),
    "the radiances of sky and ground must be finite and not negative");
  require(std::abs(glm::length(scene.sky.up) - 1.0) < 1e-6, "Sky::up must be a unit vector");
  if (fog.enabled)
  {
    this->Extinction = fog.extinction;
  }
  this->Albedo = fog.albedo;
  this->Up = scene.sky.up;
  this->SkyRadiance = scene.sky.radiance;
  this->Ground = scene.sky.ground;
  this->Falloff = fog.falloff;
  this->BaseHeight = fog.base_height;
  this->Phase = prepare_phase(fog.lobes);
  this->Largest = std::max({ this->Extinction.x, this->Extinction.y, this->Extinction.z });
  for (const Light& light : scene.lights)
  {
    Lamp lamp;
    lamp.irradiance = light.diffuse * pi;
    lamp.direction = light.direction;
    lamp.position = light.position;
    lamp.rise = -glm::dot(light.direction, this->Up);
    lamp.profile = this->profile(light.position);
    lamp.positional = light.positional;
    lamp.shape = prepare_light(light);
    std::fill(lamp.shape.position, lamp.shape.position + 3, 0.0f);
    this->Lamps.push_back(lamp);
  }
}

FogRay FogModel::ray(const glm::dvec3& origin, const glm::dvec3& direction, double spread) const
{
  return { origin, direction, glm::dot(origin, this->Up) - this->BaseHeight,
    glm::dot(direction, this->Up), spread };
}

double FogModel::profile(const glm::dvec3& place) const
{
  return std::exp(-this->Falloff * (glm::dot(place, this->Up) - this->BaseHeight));
}

double FogModel::profile(const FogRay& ray, double s) const
{
  const double fall = this->Falloff * ray.slope;
  // Infinitely far along a level ray the height is the same.
  return std::exp(-(this->Falloff * ray.height + (fall != 0.0 ? fall * s : 0.0)));
}

double FogModel::column(const FogRay& ray, double from, double to) const
{
  const double length = to - from;
  if (!(length > 0.0))
  {
    return 0.0;
  }
  const double fall = this->Falloff * ray.slope;
  const double begin = this->profile(ray, from);
  if (length == infinity)
  {
    return fall > 0.0 ? begin / fall : fall < 0.0 || begin > 0.0 ? infinity : 0.0;
  }
  const double end = fall != 0.0 ? this->profile(ray, to) : begin;
  return column_between(begin, end, std::abs(fall), length);
}

double FogModel::column_between(double begin, double end, double fall, double length)
{
  const double densest = std::max(begin, end);
  if (!(densest < infinity))
  {
    return infinity;
  }
  // So steep that the product may overflow.
  return fall * length > 1e100 ? densest / fall
                               : scalar::fog_column(begin, end, fall * length, length);
}

// amount = f (1 − e^(−b L)) / b, f at `from`, b the falloff along the ray, solved for L.
double FogModel::place_of_column(const FogRay& ray, double from, double amount) const
{
  if (!(amount > 0.0) || amount == infinity)
  {
    return amount > 0.0 ? infinity : from;
  }
  const double fall = this->Falloff * ray.slope;
  const double begin = this->profile(ray, from);
  const double z = fall * amount / begin;
  if (fall > 0.0 && !(z < 1.0))
  {
    return infinity;
  }
  if (fall < 0.0 && !(z > -1e12))
  {
    // So far above the fog that f may be 0 in the computer.
    const double log_begin = -(this->Falloff * ray.height + fall * from);
    return from + std::max(0.0, (std::log(-fall * amount) - log_begin) / -fall);
  }
  if (!(begin > 0.0))
  {
    return infinity;
  }
  const double stretched = std::abs(z) < 1e-8 ? 1.0 + 0.5 * z : -std::log1p(-z) / z;
  return from + amount / begin * stretched;
}

glm::dvec3 FogModel::optical_depth(double column) const
{
  return { times(this->Extinction.x, column), times(this->Extinction.y, column),
    times(this->Extinction.z, column) };
}

glm::dvec3 FogModel::transmittance(const FogRay& ray, double from, double to) const
{
  const glm::dvec3 depth = this->optical_depth(ray, from, to);
  const double first = std::exp(-depth.x);
  const double second = depth.y == depth.x ? first : std::exp(-depth.y);
  return { first, second, depth.z == depth.x ? first : std::exp(-depth.z) };
}

glm::dvec3 FogModel::radiance(const FogRay& ray, double from, double to) const
{
  glm::dvec3 sum = this->ambient(ray, from, to);
  for (std::size_t i = 0; i < this->Lamps.size(); ++i)
  {
    sum += this->lit_by(i, ray, from, to);
  }
  return sum;
}

glm::dvec3 FogModel::lit_by(std::size_t light, const FogRay& ray, double from, double to) const
{
  const Lamp& lamp = this->Lamps[light];
  if (!this->visible() || lamp.irradiance == glm::dvec3(0.0) || !(to > from))
  {
    return glm::dvec3(0.0);
  }
  return lamp.positional ? this->lit_by_lamp(lamp, ray, from, to)
                         : this->lit_by_sun(lamp, ray, from, to);
}

glm::dvec3 FogModel::lit_by_sun(
  const Lamp& lamp, const FogRay& ray, double from, double to) const
{
  const double column = this->column(ray, from, to);
  // Columns up to the light from both ends, and how the one falls while the other grows.
  double up_begin = 0.0;
  double up_end = 0.0;
  double ratio = 0.0;
  if (this->Falloff > 0.0)
  {
    const double fall = this->Falloff * lamp.rise;
    if (!(fall > 0.0))
    {
      return glm::dvec3(0.0);
    }
    up_begin = this->profile(ray, from) / fall;
    up_end = this->profile(ray, to) / fall;
    ratio = std::clamp(ray.slope / lamp.rise, -largest_depth, largest_depth);
  }
  // Directions of travel before and after: of the light, and from the fog to the ray's origin.
  const glm::dvec3 turn = lamp.direction + ray.direction;
  const glm::dvec3 straight = lamp.direction - ray.direction;
  const double p = scalar::phase<double>(
    this->Phase, 0.5 * glm::dot(turn, turn), 0.5 * glm::dot(straight, straight));
  glm::dvec3 depth(0.0);
  for (int c = 0; c < 3; ++c)
  {
    const double k = this->Extinction[c];
    if (c > 0 && k == this->Extinction[c - 1])
    {
      depth[c] = depth[c - 1];
      continue;
    }
    const double view = std::min(times(k, column), largest_depth);
    const double begin = times(k, up_begin);
    const double end = times(k, up_end);
    if (!(view > 0.0) || begin == infinity)
    {
      continue; // no fog, or no light that gets so deep
    }
    depth[c] = scalar::fog_lit_depth(view, begin, end, ratio);
  }
  return this->Albedo * lamp.irradiance * depth * p;
}

glm::dvec3 FogModel::light_transmittance(std::size_t light, const glm::dvec3& place) const
{
  const Lamp& lamp = this->Lamps[light];
  double column = 0.0;
  if (lamp.positional)
  {
    column = this->lamp_column(lamp, this->profile(place), place - lamp.position);
  }
  else if (this->Falloff > 0.0)
  {
    const double fall = this->Falloff * lamp.rise;
    column = fall > 0.0 ? this->profile(place) / fall : infinity;
  }
  const glm::dvec3 depth = this->optical_depth(column);
  return { std::exp(-depth.x), std::exp(-depth.y), std::exp(-depth.z) };
}

glm::dvec3 FogModel::sky_transmittance(const glm::dvec3& place) const
{
  if (!(this->Falloff > 0.0))
  {
    return glm::dvec3(1.0);
  }
  const glm::dvec3 depth = this->optical_depth(this->profile(place) / this->Falloff);
  return { quick_exponential_integral_2(depth.x), quick_exponential_integral_2(depth.y),
    quick_exponential_integral_2(depth.z) };
}

glm::dvec3 FogModel::source(const glm::dvec3& place, const glm::dvec3& direction) const
{
  const glm::dvec3 ground = this->Falloff > 0.0 ? glm::dvec3(0.0) : this->Ground;
  glm::dvec3 sum = (this->SkyRadiance * this->sky_transmittance(place) + ground) * 0.5;
  for (std::size_t i = 0; i < this->Lamps.size(); ++i)
  {
    const Lamp& lamp = this->Lamps[i];
    const glm::dvec3 offset = place - lamp.position;
    const scalar::Incidence<double> light =
      scalar::incidence<double>(lamp.shape, { offset.x, offset.y, offset.z });
    const glm::dvec3 travel(-light.toward.x, -light.toward.y, -light.toward.z);
    const glm::dvec3 turn = travel - direction;
    const glm::dvec3 straight = travel + direction;
    const double p = scalar::phase<double>(
      this->Phase, 0.5 * glm::dot(turn, turn), 0.5 * glm::dot(straight, straight));
    sum += lamp.irradiance * this->light_transmittance(i, place) * (p * light.strength);
  }
  return this->Albedo * sum;
}

double FogModel::half_column(const glm::dvec3& through) const
{
  double column = 0.0;
  for (int c = 0; c < 3; ++c)
  {
    const double depth = std::log(2.0 * through[c]); // that is to come
    if (depth >= 0.0)
    {
      column = this->Extinction[c] > 0.0 ? std::max(column, depth / this->Extinction[c]) : infinity;
    }
  }
  return column;
}

}
