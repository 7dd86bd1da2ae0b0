// Signed distances to simple shapes: below 0 inside, above 0 outside, in the unit of the place.
//
// Each is exact, or no larger than the true distance outside, and changes by no more than the way
// that one moves (a slope of at most 1, but for the ellipsoid, see there): what painted_volume.h
// needs to leave shapes out. After Quilez, "Distance functions"
// (iquilezles.org/articles/distfunctions).
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <initializer_list>
#include <vector>

namespace brume
{

inline double sphere_distance(const glm::dvec3& p, const glm::dvec3& centre, double radius)
{
  return glm::length(p - centre) - radius;
}

/// Distance to an ellipsoid with axes along x, y, z, to first order: right at the surface. Outside
/// it is at most the true distance, inside it is held to the smallest radius.
inline double ellipsoid_distance(const glm::dvec3& p,
  const glm::dvec3& centre,
  const glm::dvec3& radii)
{
  const glm::dvec3 q = (p - centre) / radii;
  const double k0 = glm::length(q);
  const double k1 = glm::length(q / radii);
  const double inmost = -std::min({ radii.x, radii.y, radii.z });
  return k1 > 0.0 ? std::max(k0 * (k0 - 1.0) / k1, inmost) : inmost;
}

/// A line from a to b, thickened by a radius that runs from `ra` to `rb`.
inline double capsule_distance(const glm::dvec3& p,
  const glm::dvec3& a,
  const glm::dvec3& b,
  double ra,
  double rb)
{
  const glm::dvec3 along = b - a;
  const glm::dvec3 from = p - a;
  const double square = glm::dot(along, along);
  const double t = square > 0.0 ? std::clamp(glm::dot(from, along) / square, 0.0, 1.0) : 0.0;
  return glm::length(from - along * t) - (ra + (rb - ra) * t);
}

/// A chain of lines through the points, thickened by one radius.
inline double tube_distance(const glm::dvec3& p,
  const std::vector<glm::dvec3>& points,
  double radius)
{
  double nearest = glm::length(p - points.front()) - radius;
  for (std::size_t i = 1; i < points.size(); ++i)
  {
    nearest = std::min(nearest, capsule_distance(p, points[i - 1], points[i], radius, radius));
  }
  return nearest;
}

/// A box of half sizes `half` (roundness included) along the axes, with edges rounded by a radius.
inline double box_distance(const glm::dvec3& p,
  const glm::dvec3& centre,
  const glm::dvec3& half,
  double roundness)
{
  const glm::dvec3 q = glm::abs(p - centre) - (half - roundness);
  return glm::length(glm::max(q, glm::dvec3(0.0))) + std::min(std::max({ q.x, q.y, q.z }), 0.0) -
         roundness;
}

/// A ring around an axis along z.
inline double torus_distance(const glm::dvec3& p,
  const glm::dvec3& centre,
  double ring_radius,
  double tube_radius)
{
  const glm::dvec3 q = p - centre;
  const double r = std::sqrt(q.x * q.x + q.y * q.y) - ring_radius;
  return std::sqrt(r * r + q.z * q.z) - tube_radius;
}

/// Union with a fillet: the polynomial smooth minimum, which differs from min(a, b) only where the
/// two lie within k of each other, by at most k/4. k above 0.
inline double smooth_union(double a, double b, double k)
{
  const double h = std::max(k - std::fabs(a - b), 0.0) / k;
  return std::min(a, b) - h * h * k * 0.25;
}

inline double smooth_intersection(double a, double b, double k)
{
  return -smooth_union(-a, -b, k);
}

/// a without b, with a fillet.
inline double smooth_difference(double a, double b, double k)
{
  return -smooth_union(-a, b, k);
}

}
