#include "Transport/path_environment.h"

#include "Transport/phase_sampler.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace brume
{

namespace
{

constexpr double pi = 3.14159265358979323846;

double mean(const glm::dvec3& v)
{
  return (v.x + v.y + v.z) / 3.0;
}

/// The first of sums above `amount`, the place within it as a fraction, and never one without
/// power.
template <class Iterator>
Iterator find_sum(Iterator begin, Iterator end, double amount, double& fraction)
{
  Iterator found = std::upper_bound(begin, end, amount);
  if (found == end)
  {
    found = std::lower_bound(begin, end, *(end - 1));
  }
  const double before = found == begin ? 0.0 : *(found - 1);
  fraction = std::clamp((amount - before) / (*found - before), 0.0, 1.0);
  return found;
}

/// The sine of a row's lower edge's latitude; of `height`, that of the last row's upper edge.
double edge_sine(int row, int height)
{
  return std::sin(pi * (static_cast<double>(row) / height - 0.5));
}

}

PathEnvironment::PathEnvironment(const Sky& sky, std::shared_ptr<const PlacedEnvironment> map)
  : Halves(sky)
  , Placed(std::move(map))
  , Map(this->Placed ? &this->Placed->map : nullptr)
  , SkyPower(2.0 * pi * mean(sky.radiance))
  , GroundPower(2.0 * pi * mean(sky.ground))
{
  this->Power = this->SkyPower + this->GroundPower;
  if (!this->Map)
  {
    return;
  }
  const int width = this->Map->width;
  const int height = this->Map->height;
  if (width < 1 || height < 1 ||
      this->Map->rgb.size() != 3 * static_cast<std::size_t>(width) * height)
  {
    throw std::invalid_argument("an environment map needs pixels of R, G and B");
  }
  double sum = 0.0;
  this->ColumnUpTo.reserve(static_cast<std::size_t>(width) * height);
  for (int y = 0; y < height; ++y)
  {
    double row = 0.0;
    for (int x = 0; x < width; ++x)
    {
      this->ColumnUpTo.push_back(row += mean(this->map_radiance(x, y)));
    }
    this->RowUpTo.push_back(sum += row * environment_solid_angle(y, width, height));
  }
  if (!(sum > 0.0))
  {
    this->Map = nullptr;
    return;
  }
  this->Power += sum;
}

glm::dvec3 PathEnvironment::map_radiance(int x, int y) const
{
  const float* pixel = &this->Map->rgb[3 * (static_cast<std::size_t>(y) * this->Map->width + x)];
  glm::dvec3 result;
  for (int c = 0; c < 3; ++c)
  {
    result[c] = std::isfinite(pixel[c]) ? std::max(0.0, static_cast<double>(pixel[c])) : 0.0;
  }
  return result;
}

// The inverse of environment_direction().
void PathEnvironment::find_pixel(const glm::dvec3& toward, int& x, int& y) const
{
  const glm::dvec3 d = toward * this->Placed->world_from_map;
  const double across = std::atan2(d.x, d.y) / (2.0 * pi) + 0.5;
  const double up = std::atan2(d.z, std::hypot(d.x, d.y)) / pi + 0.5;
  x = std::clamp(static_cast<int>(across * this->Map->width), 0, this->Map->width - 1);
  y = std::clamp(static_cast<int>(up * this->Map->height), 0, this->Map->height - 1);
}

glm::dvec3 PathEnvironment::radiance(const glm::dvec3& toward) const
{
  glm::dvec3 result =
    glm::dot(toward, this->Halves.up) >= 0.0 ? this->Halves.radiance : this->Halves.ground;
  if (this->Map)
  {
    int x, y;
    this->find_pixel(toward, x, y);
    result += this->map_radiance(x, y);
  }
  return result;
}

glm::dvec3 PathEnvironment::sample(RandomStream& random) const
{
  double amount = random.uniform() * this->Power;
  if (amount < this->SkyPower)
  {
    return direction_around(this->Halves.up, random.uniform(), random.uniform());
  }
  amount -= this->SkyPower;
  if (amount < this->GroundPower || !this->Map)
  {
    return direction_around(-this->Halves.up, random.uniform(), random.uniform());
  }
  amount -= this->GroundPower;
  double up, across;
  const auto row = find_sum(this->RowUpTo.begin(), this->RowUpTo.end(), amount, up);
  const int y = static_cast<int>(row - this->RowUpTo.begin());
  const int width = this->Map->width;
  const int height = this->Map->height;
  const auto begin = this->ColumnUpTo.begin() + static_cast<std::ptrdiff_t>(y) * width;
  const auto column =
    find_sum(begin, begin + width, random.uniform() * *(begin + width - 1), across);
  // Evenly over the pixel's part of the sphere. What picked the row tells no more than 32 bits
  // hold: within the row another number.
  const double lower = edge_sine(y, height);
  const double sine =
    std::clamp(lower + random.uniform() * (edge_sine(y + 1, height) - lower), -1.0, 1.0);
  const double longitude = 2.0 * pi * ((column - begin + across) / width - 0.5);
  const double cosine = std::sqrt((1.0 - sine) * (1.0 + sine));
  return this->Placed->world_from_map *
         glm::dvec3(cosine * std::sin(longitude), cosine * std::cos(longitude), sine);
}

double PathEnvironment::density(const glm::dvec3& toward) const
{
  return mean(this->radiance(toward)) / this->Power;
}

}
