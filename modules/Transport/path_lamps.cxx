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

LampPlace NearLamp::on_ray(const glm::dvec3& begin,
  const glm::dvec3& along,
  double length,
  RandomStream& random) const
{
  LampPlace result;
  const double foot = glm::dot(this->centre() - begin, along);
  const double away = std::max(glm::length(begin + foot * along - this->centre()), tiny);
  const double half = std::sqrt(std::max(this->radius * this->radius - away * away, 0.0));
  const double from = std::max(foot - half, 0.0);
  const double to = std::min(foot + half, length);
  if (!(from < to))
  {
    return result;
  }
  const double first = std::atan((from - foot) / away);
  const double last = std::atan((to - foot) / away);
  const double off = away * std::tan(first + random.uniform() * (last - first));
  result.way = std::clamp(foot + off, from, to);
  result.along = along;
  result.place = begin + result.way * along;
  result.weight = (last - first) * (away * away + off * off) / away;
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
  const Distances around_lamp{ scale, this->radius };
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
