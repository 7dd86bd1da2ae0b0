// A node of a shape's tree. Not installed.
#pragma once

#include "data-generators/shape.h"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace brume
{

struct ShapeNode
{
  virtual ~ShapeNode() = default;

  virtual double distance(const glm::dvec3& p) const = 0;
  /// A box that holds every place with distance(p) <= level; level is not below 0.
  virtual Box reach(double level) const = 0;

  double lipschitz = 1.0;
  /// How many nodes distance() asks at most, itself among them.
  double cost = 1.0;
  bool exact_outside = true;
  bool exact_inside = true;
};

namespace shapes
{

constexpr double infinity = std::numeric_limits<double>::infinity();

inline void require(bool holds, const std::string& what)
{
  if (!holds)
  {
    throw std::invalid_argument(what);
  }
}

inline bool finite(const glm::dvec3& v)
{
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

inline bool finite(const Box& b)
{
  return finite(b.lower) && finite(b.upper);
}

/// Distance to a box, below 0 inside; also of boxes with faces at infinity, where it may be
/// -infinity.
double distance_to(const Box& box, const glm::dvec3& p);

}

}
