// Shapes moved, turned, scaled, repeated and twisted.
#include "data-generators/portable_math.h"
#include "data-generators/shape_node.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

namespace brume
{
namespace shapes
{

namespace
{

using glm::dvec3;

constexpr double degree = pi / 180.0;

struct Rigid : ShapeNode
{
  Rigid(const Shape& part, const glm::dmat3& turn, const dvec3& by)
    : part(part)
    , turn(turn)
    , back(glm::transpose(turn))
    , by(by)
  {
    cost = 1.0 + part.node().cost;
    lipschitz = part.lipschitz();
    exact_outside = part.exact_outside();
    exact_inside = part.exact_inside();
  }
  double distance(const dvec3& p) const override { return part.node().distance(back * (p - by)); }
  Box reach(double level) const override
  {
    const Box box = part.node().reach(level);
    if (turn == glm::dmat3(1.0))
    {
      return { box.lower + by, box.upper + by };
    }
    if (!finite(box))
    {
      return { dvec3(-infinity), dvec3(infinity) };
    }
    const dvec3 middle = turn * (0.5 * (box.lower + box.upper)) + by;
    const dvec3 half = 0.5 * (box.upper - box.lower);
    dvec3 wide(0.0);
    for (int a = 0; a < 3; ++a)
    {
      wide += glm::abs(turn[a]) * half[a];
    }
    return { middle - wide, middle + wide };
  }
  Shape part;
  glm::dmat3 turn, back;
  dvec3 by;
};

struct Scaled : ShapeNode
{
  Scaled(const Shape& part, double factor)
    : part(part)
    , factor(factor)
  {
    cost = 1.0 + part.node().cost;
    lipschitz = part.lipschitz();
    exact_outside = part.exact_outside();
    exact_inside = part.exact_inside();
  }
  double distance(const dvec3& p) const override
  {
    return factor * part.node().distance(p / factor);
  }
  Box reach(double level) const override
  {
    const Box box = part.node().reach(level / factor);
    return { factor * box.lower, factor * box.upper };
  }
  Shape part;
  double factor;
};

/// Copies at the places o * spacing, o from `first` to `last` along each axis.
///
/// Take the axis alone and let a copy lie within [lo, hi] + o s. A place of copy o at a distance of
/// s/2 or more along the axis is no nearer than its twin in the next copy toward p. So only those o
/// can be the nearest with lo + o s < p + s/2 and hi + o s > p - s/2.
struct Repeated : ShapeNode
{
  Repeated(const Shape& part, const dvec3& spacing, const dvec3& first, const dvec3& last)
    : part(part)
    , box(part.bounds())
    , spacing(spacing)
    , first(first)
    , last(last)
  {
    exact_outside = part.exact_outside();
    exact_inside = part.exact_inside();
    lipschitz = exact_outside ? part.lipschitz() : std::max(part.lipschitz(), 1.0);
    double most = 1.0;
    for (int a = 0; a < 3; ++a)
    {
      if (!this->along(a))
      {
        continue;
      }
      const double width = box.upper[a] - box.lower[a];
      require(
        std::isfinite(width), "repeat: the shape must be bounded along the axes that are repeated");
      most *= std::min(std::floor(width / spacing[a]) + 2.0, last[a] - first[a] + 1.0);
      exact_inside = exact_inside && width < spacing[a];
      // From anywhere in its cell, what lies beyond the copies asked is so far away.
      nearest_unasked = std::min(nearest_unasked, 0.5 * spacing[a]);
    }
    require(most <= 1000.0, "repeat: the shape is too wide for so small a spacing");
    cost = 1.0 + most * part.node().cost;
  }

  bool along(int a) const { return spacing[a] > 0.0 && first[a] < last[a]; }

  double distance(const dvec3& p) const override
  {
    dvec3 begin(0.0);
    glm::ivec3 count(1);
    for (int a = 0; a < 3; ++a)
    {
      if (!this->along(a))
      {
        begin[a] = spacing[a] > 0.0 ? first[a] : 0.0;
        continue;
      }
      const double s = spacing[a];
      double low = std::floor((p[a] - 0.5 * s - box.upper[a]) / s) + 1.0;
      double high = std::ceil((p[a] + 0.5 * s - box.lower[a]) / s) - 1.0;
      low = std::clamp(low, first[a], last[a]);
      high = std::clamp(std::max(low, high), first[a], last[a]);
      begin[a] = low;
      // Not more, where p is so far out that the quotients are rounded.
      const double most = std::max(std::floor((box.upper[a] - box.lower[a]) / s) + 2.0, 1.0);
      count[a] = static_cast<int>(std::min(most, high - low + 1.0));
    }
    double d = exact_outside ? infinity : nearest_unasked;
    glm::ivec3 o;
    for (o.z = 0; o.z < count.z; ++o.z)
      for (o.y = 0; o.y < count.y; ++o.y)
        for (o.x = 0; o.x < count.x; ++o.x)
        {
          const dvec3 q = p - (begin + dvec3(o)) * spacing;
          double f = part.node().distance(q);
          if (!exact_outside)
          {
            // At least the distance to the box: so a copy that stops being asked is no nearer than
            // nearest_unasked, and f has no jump there.
            const double to_box = distance_to(box, q);
            f = to_box > 0.0 ? std::max(f, to_box) : f;
          }
          d = std::min(d, f);
        }
    if (!exact_outside)
    {
      const double to_all = distance_to(this->reach(0.0), p);
      d = to_all > 0.0 ? std::max(d, to_all) : d;
    }
    return d;
  }

  Box reach(double level) const override
  {
    Box all;
    for (int a = 0; a < 3; ++a)
    {
      all.lower[a] = box.lower[a] - level;
      all.upper[a] = box.upper[a] + level;
      if (spacing[a] > 0.0)
      {
        all.lower[a] += first[a] * spacing[a];
        all.upper[a] += last[a] * spacing[a];
      }
    }
    return all;
  }

  Shape part;
  Box box;
  dvec3 spacing, first, last;
  double nearest_unasked = infinity;
};

struct Twisted : ShapeNode
{
  Twisted(const Shape& part, double degrees)
    : part(part)
    , turn(degrees * degree)
  {
    const Box box = part.bounds();
    const dvec3 wide = glm::max(glm::abs(box.lower), glm::abs(box.upper));
    require(std::isfinite(wide.x) && std::isfinite(wide.y),
      "twist: the shape must be bounded in x and y");
    radius = std::sqrt(wide.x * wide.x + wide.y * wide.y);
    cost = 1.0 + part.node().cost;
    const double shear = std::fabs(turn) * radius;
    lipschitz = std::max(part.lipschitz() * 0.5 * (shear + std::sqrt(shear * shear + 4.0)), 1.0);
    exact_outside = exact_inside = false;
  }
  double distance(const dvec3& p) const override
  {
    const double r = std::sqrt(p.x * p.x + p.y * p.y);
    const double inward = r > radius ? radius / r : 1.0;
    const SineCosine by = portable_sincos(-turn * p.z);
    const dvec3 q(
      inward * (by.cosine * p.x - by.sine * p.y), inward * (by.sine * p.x + by.cosine * p.y), p.z);
    // Moving to the cylinder brings no place of the shape farther away; and r - radius is a bound
    // of its own.
    const double f = part.node().distance(q);
    return r > radius ? std::max(f, r - radius) : f;
  }
  Box reach(double level) const override
  {
    const Box box = part.node().reach(level);
    const double r = radius + level;
    return { dvec3(-r, -r, box.lower.z), dvec3(r, r, box.upper.z) };
  }
  Shape part;
  double turn; ///< radians a world unit
  double radius = 0.0;
};

}

Shape moved(const Shape& part, const dvec3& by)
{
  require(finite(by), "move: the vector must be finite");
  return Shape(std::make_shared<const Rigid>(part, glm::dmat3(1.0), by));
}

Shape rotated(const Shape& part, const dvec3& axis, double degrees)
{
  const double length = glm::length(axis);
  require(
    length > 0.0 && std::isfinite(length), "rotate: the axis must be finite and not of length 0");
  require(std::fabs(degrees) <= 1e6, "rotate: the angle must be within a million degrees");
  const dvec3 n = axis / length;
  const SineCosine by = portable_sincos(degrees * degree);
  glm::dmat3 turn;
  for (int a = 0; a < 3; ++a)
  {
    dvec3 e(0.0);
    e[a] = 1.0; // Rodrigues' formula
    turn[a] = by.cosine * e + by.sine * glm::cross(n, e) + (1.0 - by.cosine) * n[a] * n;
  }
  return Shape(std::make_shared<const Rigid>(part, turn, dvec3(0.0)));
}

Shape scaled(const Shape& part, double factor)
{
  require(factor > 0.0 && std::isfinite(factor), "scale: the factor must be above 0");
  return Shape(std::make_shared<const Scaled>(part, factor));
}

Shape repeated(const Shape& part, const dvec3& spacing)
{
  require(finite(spacing) && spacing.x >= 0.0 && spacing.y >= 0.0 && spacing.z >= 0.0,
    "repeat: the spacing must not be below 0");
  return Shape(std::make_shared<const Repeated>(part, spacing, dvec3(-infinity), dvec3(infinity)));
}

Shape repeated(const Shape& part, const dvec3& spacing, const glm::ivec3& counts)
{
  require(finite(spacing) && spacing.x >= 0.0 && spacing.y >= 0.0 && spacing.z >= 0.0,
    "repeat: the spacing must not be below 0");
  require(counts.x > 0 && counts.y > 0 && counts.z > 0, "repeat: the counts must be above 0");
  const glm::ivec3 first = -((counts - 1) / 2);
  return Shape(
    std::make_shared<const Repeated>(part, spacing, dvec3(first), dvec3(first + counts - 1)));
}

Shape twisted(const Shape& part, double degrees)
{
  require(std::isfinite(degrees), "twist: the angle must be finite");
  return Shape(std::make_shared<const Twisted>(part, degrees));
}

}
}
