#include "data-generators/shepp_logan.h"

#include "data-generators/portable_math.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace brume
{

namespace
{

using glm::dvec3;

struct Row
{
  double radii[3];
  double centre[3];
  double degrees;
  double kak_slaney, raised;
};

constexpr Row table[10] = {
  { { 0.69, 0.92, 0.9 }, { 0, 0, 0 }, 0, 2.0, 1.0 },
  { { 0.6624, 0.874, 0.88 }, { 0, 0, 0 }, 0, -0.98, -0.8 },
  { { 0.41, 0.16, 0.21 }, { -0.22, 0, -0.25 }, 108, -0.02, -0.2 },
  { { 0.31, 0.11, 0.22 }, { 0.22, 0, -0.25 }, 72, -0.02, -0.2 },
  { { 0.21, 0.25, 0.5 }, { 0, 0.35, -0.25 }, 0, 0.02, 0.2 },
  { { 0.046, 0.046, 0.046 }, { 0, 0.1, -0.25 }, 0, 0.02, 0.2 },
  { { 0.046, 0.023, 0.02 }, { -0.08, -0.65, -0.25 }, 0, 0.01, 0.1 },
  { { 0.046, 0.023, 0.02 }, { 0.06, -0.65, -0.25 }, 90, 0.01, 0.1 },
  { { 0.056, 0.04, 0.1 }, { 0.06, -0.105, 0.625 }, 90, 0.02, 0.2 },
  { { 0.056, 0.056, 0.1 }, { 0, 0.1, 0.625 }, 0, -0.02, -0.2 },
};

}

SheppLogan::SheppLogan(Contrast contrast)
  : ExactField({ dvec3(-1.0), dvec3(1.0) })
{
  for (const Row& row : table)
  {
    const SineCosine turn = portable_sincos(row.degrees * pi / 180.0);
    m_ellipsoids.push_back({ { row.centre[0], row.centre[1], row.centre[2] },
      { row.radii[0], row.radii[1], row.radii[2] },
      turn.cosine,
      turn.sine,
      contrast == Contrast::kak_slaney ? row.kak_slaney : row.raised,
      std::min({ row.radii[0], row.radii[1], row.radii[2] }) });
  }
}

dvec3 SheppLogan::Ellipsoid::within(const dvec3& v) const
{
  return dvec3(cosine * v.x + sine * v.y, cosine * v.y - sine * v.x, v.z) / radii;
}

double SheppLogan::density_inside(const dvec3& place) const
{
  double sum = 0.0;
  for (const Ellipsoid& e : m_ellipsoids)
  {
    const dvec3 p = e.within(place - e.centre);
    sum += glm::dot(p, p) <= 1.0 ? e.value : 0.0;
  }
  return std::max(sum, 0.0); // 1 - 0.8 - 0.2 rounds to something below 0
}

double SheppLogan::integral_inside(const dvec3& origin,
  const dvec3& direction,
  double from,
  double to) const
{
  double sum = 0.0;
  for (const Ellipsoid& e : m_ellipsoids)
  {
    // As with a ball, in units in which the ellipsoid is one.
    const dvec3 o = e.within(origin - e.centre);
    const dvec3 d = e.within(direction);
    const double length = glm::length(d);
    const dvec3 along = d / length;
    const double b = glm::dot(o, along);
    const double q = glm::length(o - b * along);
    if (q < 1.0)
    {
      const double h = std::sqrt((1.0 - q) * (1.0 + q));
      const double u = std::clamp(from * length + b, -h, h);
      const double v = std::clamp(to * length + b, -h, h);
      sum += e.value * (v - u) / length;
    }
  }
  return std::max(sum, 0.0);
}

int SheppLogan::Ellipsoid::side(const Box& box) const
{
  const dvec3 p = this->within(0.5 * (box.lower + box.upper) - centre);
  const double square = glm::dot(p, p);
  const double reach = 0.5 * glm::length(box.upper - box.lower) / least_radius + 1e-9;
  if (square > (1.0 + reach) * (1.0 + reach) * (1.0 + 1e-9))
  {
    return -1;
  }
  return reach < 1.0 && square < (1.0 - reach) * (1.0 - reach) ? 1 : 0;
}

double SheppLogan::mean_in(const Box& box) const
{
  double sum = 0.0;
  for (const Ellipsoid& e : m_ellipsoids)
  {
    const int side = e.side(box);
    int inside = side > 0 ? sample_places : 0;
    for (int n = 0; side == 0 && n < sample_places; ++n)
    {
      const dvec3 p = e.within(sample_place(box, n) - e.centre);
      inside += glm::dot(p, p) <= 1.0;
    }
    sum += e.value * inside / sample_places;
  }
  return std::max(sum, 0.0);
}

FieldRange SheppLogan::range_in(const Box& box, double) const
{
  double low = 0.0;
  double high = 0.0;
  for (const Ellipsoid& e : m_ellipsoids)
  {
    const int side = e.side(box);
    low += side > 0 ? e.value : side < 0 ? 0.0 : std::min(e.value, 0.0);
    high += side > 0 ? e.value : side < 0 ? 0.0 : std::max(e.value, 0.0);
  }
  return { static_cast<float>(std::max(low, 0.0)), static_cast<float>(std::max(high, 0.0)) };
}

}
