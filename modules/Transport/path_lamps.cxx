#include "Transport/path_lamps.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace brume
{

namespace
{

constexpr double pi = 3.14159265358979323846;
constexpr double tiny = 1e-150; // its square is within range

/// Distances up to `most` with the density scale / (scale² + r²), by that density's integral.
struct Distances
{
  double scale;
  double most;

  double angle() const { return std::atan(this->most / this->scale); }
  double sample(double u) const
  {
    return std::min(this->scale * std::tan(u * this->angle()), this->most);
  }
  double density(double r) const
  {
    return r <= this->most ? this->scale / ((this->scale * this->scale + r * r) * this->angle())
                           : 0.0;
  }
};

}

double NearLamp::core() const
{
  const glm::dvec3& a = this->lamp->light().attenuation;
  return a.x / a.z;
}

LampPlace NearLamp::on_ray(const glm::dvec3& begin,
  const glm::dvec3& along,
  double length,
  RandomStream& random) const
{
  LampPlace result;
  const double foot = glm::dot(this->centre() - begin, along);
  const double passes = glm::length(begin + foot * along - this->centre());
  const double half = std::sqrt(std::max(this->radius * this->radius - passes * passes, 0.0));
  const double from = std::max(foot - half, 0.0);
  const double to = std::min(foot + half, length);
  if (!(from < to))
  {
    return result;
  }
  // Light of 1 / (c₀ + c₂ d²) is even in the angle at a point that is farther from the line by c₀ / c₂.
  const double away = std::max(std::sqrt(passes * passes + this->core()), tiny);
  // The angle there between both ends, and the tangent of the sum of the first end's and a part
  // of it, without differences of angles that are all but the same: a lamp may lie on the ray's line.
  const double first = from - foot;
  const double last = to - foot;
  const double angle = std::atan2(away * (last - first), away * away + first * last);
  const double turn = std::tan(random.uniform() * angle);
  const double off = away * (first + away * turn) / (away - first * turn);
  result.way = std::clamp(foot + off, from, to);
  result.along = along;
  result.place = begin + result.way * along;
  result.weight = angle * (away * away + off * off) / away;
  return result;
}

LampPlace NearLamp::from_place(const glm::dvec3& begin,
  const glm::dvec3& from,
  const PhaseSampler& phase,
  RandomStream& random) const
{
  LampPlace result;
  const glm::dvec3 apart = begin - this->centre();
  const double scale = std::max(glm::length(apart), tiny);
  const Distances around_lamp{ std::sqrt(scale * scale + this->core()), this->radius };
  const Distances around_place{ scale, scale + this->radius };
  // From far away, places are only drawn around the lamp: the way is then no shorter than half as
  // far.
  const bool near = scale < 2.0 * this->radius;
  const bool by_phase = near && random.uniform() < 0.5;
  double r;
  if (by_phase)
  {
    result.along = phase.sample(from, random);
    result.way = around_place.sample(random.uniform());
    result.place = begin + result.way * result.along;
    r = glm::length(apart + result.way * result.along);
    if (!(r < this->radius))
    {
      return result;
    }
  }
  else
  {
    r = around_lamp.sample(random.uniform());
    const double height = 2.0 * random.uniform();
    const glm::dvec3 off =
      r * direction_around(glm::dvec3(0.0, 0.0, 1.0), height, random.uniform());
    result.place = this->centre() + off;
    result.along = off - apart;
    result.way = glm::length(result.along);
    if (!(result.way > 0.0))
    {
      return result;
    }
    result.along /= result.way;
  }
  // p / way², by the mean of p q / way² and q / 4π r²; times all squares.
  const double p = phase.value(from, result.along);
  const double lamp = around_lamp.density(r) / (4.0 * pi) * result.way * result.way;
  const double both = near ? 0.5 * (lamp + p * around_place.density(result.way) * r * r) : lamp;
  result.weight = both > 0.0 ? p * r * r / both : 0.0;
  return result;
}

}
