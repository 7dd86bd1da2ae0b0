// What every generator is: a scalar as a function of place and time.
#pragma once

#include <glm/vec3.hpp>

namespace brume
{

/// A box with faces along the axes, in world units.
struct Box
{
  glm::dvec3 lower{ 0.0 };
  glm::dvec3 upper{ 0.0 };
};

/// A scalar as a function of place and time: a density, a Hounsfield number, a temperature.
/// Each generator documents the units of place and time, and the range of its values.
class Field
{
public:
  virtual ~Field() = default;

  /// The box in which the field is worth sampling.
  virtual Box bounds() const = 0;

  /// The value there and then. Any number of threads may call it at once.
  virtual float value(const glm::dvec3& place, double time) const = 0;
};

}
