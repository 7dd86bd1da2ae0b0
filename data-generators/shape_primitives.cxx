// The shapes that others are made of: exact inside and outside.
#include "data-generators/shape_node.h"
#include "data-generators/signed_distance.h"

#include <algorithm>
#include <utility>

namespace brume
{
namespace shapes
{

namespace
{

using glm::dvec3;

/// A primitive: its distance as a function object, and its box.
template <typename Distance>
struct Primitive : ShapeNode
{
  Primitive(const Box& box, Distance distance)
    : box(box)
    , function(std::move(distance))
  {
  }
  double distance(const dvec3& p) const override { return function(p); }
  // Exact distances: all places within `level` of the inside.
  Box reach(double level) const override { return { box.lower - level, box.upper + level }; }

  Box box;
  Distance function;
};

template <typename Distance>
Shape primitive(const dvec3& half, Distance distance)
{
  return Shape(
    std::make_shared<const Primitive<Distance>>(Box{ -half, half }, std::move(distance)));
}

bool positive(double x)
{
  return x > 0.0 && std::isfinite(x);
}

/// In the half plane of distances r from the axis and heights z: the square of the distance to the
/// line from a to b.
double square_to_line(double r, double z, double ar, double az, double br, double bz)
{
  const double ur = br - ar;
  const double uz = bz - az;
  const double t = std::clamp(((r - ar) * ur + (z - az) * uz) / (ur * ur + uz * uz), 0.0, 1.0);
  const double dr = r - ar - t * ur;
  const double dz = z - az - t * uz;
  return dr * dr + dz * dz;
}

/// radii from the largest to the smallest, with the places along them.
double sorted_ellipsoid_distance(const dvec3& radii, const dvec3& place)
{
  // In units of the smallest radius r2, u = t/r2^2 + 1: the sum of (n_i/(u + b_i))^2 must be 1.
  const double tiny = 1e-100; // in place of 0, where the nearest places would be a pair
  const dvec3 z(place.x / radii.x, place.y / radii.y, std::max(place.z / radii.z, tiny));
  const dvec3 ratio(
    (radii.x / radii.z) * (radii.x / radii.z), (radii.y / radii.z) * (radii.y / radii.z), 1.0);
  const dvec3 n = ratio * z;
  const dvec3 b(((radii.x - radii.z) / radii.z) * ((radii.x + radii.z) / radii.z),
    ((radii.y - radii.z) / radii.z) * ((radii.y + radii.z) / radii.z),
    0.0);
  double u = std::max({ z.z, n.x - b.x, n.y - b.y }); // each term alone is at most 1
  for (int step = 0; step < 100; ++step)
  {
    double sum = 0.0;
    double slope = 0.0;
    for (int a = 0; a < 3; ++a)
    {
      const double term = n[a] / (u + b[a]);
      sum += term * term;
      slope += term * term / (u + b[a]);
    }
    // Newton on 1/sqrt(sum) - 1: concave and rising, so that u never passes the root.
    const double next = u + (sum * std::sqrt(sum) - sum) / slope;
    if (!(next > u))
    {
      break;
    }
    u = next;
  }
  dvec3 nearest;
  for (int a = 0; a < 3; ++a)
  {
    nearest[a] = radii[a] * n[a] / (u + b[a]);
  }
  const double d = glm::length(place - nearest);
  return glm::dot(z, z) < 1.0 ? -d : d;
}

}

double distance_to(const Box& box, const dvec3& p)
{
  const dvec3 q = glm::max(box.lower - p, p - box.upper);
  return glm::length(glm::max(q, dvec3(0.0))) + std::min(std::max({ q.x, q.y, q.z }), 0.0);
}

Shape sphere(double radius)
{
  require(positive(radius), "sphere: the radius must be above 0");
  return primitive(
    dvec3(radius), [=](const dvec3& p) { return sphere_distance(p, dvec3(0.0), radius); });
}

Shape box(const dvec3& half, double rounding)
{
  require(positive(half.x) && positive(half.y) && positive(half.z),
    "box: the half sides must be above 0");
  require(rounding >= 0.0 && rounding <= std::min({ half.x, half.y, half.z }),
    "box: the rounding must be from 0 to the least half side");
  return primitive(
    half, [=](const dvec3& p) { return box_distance(p, dvec3(0.0), half, rounding); });
}

Shape torus(double ring_radius, double tube_radius)
{
  require(positive(ring_radius) && positive(tube_radius), "torus: the radii must be above 0");
  // A tube thicker than the ring meets itself in the middle; distances inside are then too small.
  require(tube_radius <= ring_radius, "torus: the tube's radius must not be above the ring's");
  const double wide = ring_radius + tube_radius;
  return primitive(dvec3(wide, wide, tube_radius),
    [=](const dvec3& p) { return torus_distance(p, dvec3(0.0), ring_radius, tube_radius); });
}

Shape capsule(const dvec3& a, const dvec3& b, double radius)
{
  require(finite(a) && finite(b), "capsule: the ends must be finite");
  require(positive(radius), "capsule: the radius must be above 0");
  const auto distance = [=](const dvec3& p) { return capsule_distance(p, a, b, radius, radius); };
  const Box box{ glm::min(a, b) - radius, glm::max(a, b) + radius };
  return Shape(std::make_shared<const Primitive<decltype(distance)>>(box, distance));
}

Shape cylinder(double radius, double half_height)
{
  require(positive(radius) && positive(half_height),
    "cylinder: the radius and the half height must be above 0");
  return primitive(dvec3(radius, radius, half_height),
    [=](const dvec3& p)
    {
      const double r = std::sqrt(p.x * p.x + p.y * p.y) - radius;
      const double z = std::fabs(p.z) - half_height;
      const double or_0 = std::max(r, 0.0);
      const double oz_0 = std::max(z, 0.0);
      return std::sqrt(or_0 * or_0 + oz_0 * oz_0) + std::min(std::max(r, z), 0.0);
    });
}

Shape cone(double bottom, double top, double half_height)
{
  require(bottom >= 0.0 && top >= 0.0 && positive(bottom + top),
    "cone: the radii must not be below 0, and one must be above 0");
  require(positive(half_height), "cone: the half height must be above 0");
  const double wide = std::max(bottom, top);
  return primitive(dvec3(wide, wide, half_height),
    [=](const dvec3& p)
    {
      // The outline in the half plane of r and z: the lower disc, the side, the upper disc.
      const double h = half_height;
      const double r = std::sqrt(p.x * p.x + p.y * p.y);
      double square = square_to_line(r, p.z, bottom, -h, top, h);
      for (const auto& [radius, z] : { std::pair(bottom, -h), std::pair(top, h) })
      {
        const double over = std::max(r - radius, 0.0);
        square = std::min(square, over * over + (p.z - z) * (p.z - z));
      }
      const double side = bottom + (top - bottom) * (p.z + h) / (2.0 * h);
      return std::fabs(p.z) < h && r < side ? -std::sqrt(square) : std::sqrt(square);
    });
}

Shape ellipsoid(const dvec3& radii)
{
  require(positive(radii.x) && positive(radii.y) && positive(radii.z),
    "ellipsoid: the radii must be above 0");
  int order[3] = { 0, 1, 2 };
  std::sort(order, order + 3, [&](int a, int b) { return radii[a] > radii[b]; });
  const dvec3 sorted(radii[order[0]], radii[order[1]], radii[order[2]]);
  const glm::ivec3 from(order[0], order[1], order[2]);
  return primitive(radii,
    [=](const dvec3& p)
    {
      return sorted_ellipsoid_distance(
        sorted, dvec3(std::fabs(p[from.x]), std::fabs(p[from.y]), std::fabs(p[from.z])));
    });
}

Shape plane(const dvec3& normal, double offset)
{
  const double length = glm::length(normal);
  require(positive(length) && std::isfinite(offset),
    "plane: the normal must be finite and not of length 0, and the offset finite");
  const dvec3 n = normal / length;
  Box box{ dvec3(-infinity), dvec3(infinity) };
  for (int a = 0; a < 3; ++a)
  {
    if (n[a] == 1.0)
    {
      box.upper[a] = offset;
    }
    if (n[a] == -1.0)
    {
      box.lower[a] = -offset;
    }
  }
  const auto distance = [=](const dvec3& p) { return glm::dot(n, p) - offset; };
  return Shape(std::make_shared<const Primitive<decltype(distance)>>(box, distance));
}

}
}
