// What every generator is: a scalar as a function of place and time.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <limits>

namespace brume
{

/// A box with faces along the axes, in world units.
struct Box
{
  glm::dvec3 lower{ 0.0 };
  glm::dvec3 upper{ 0.0 };
};

/// Places in rows: place (i, j, k), 0 <= i < count.x and so on, is
/// origin + (first + (i, j, k)) * spacing, each coordinate computed in double precision just so.
/// A row along x has the count (n, 1, 1).
struct PlaceBlock
{
  glm::dvec3 origin{ 0.0 };
  glm::dvec3 spacing{ 1.0 };
  glm::ivec3 first{ 0 };
  glm::ivec3 count{ 0 };

  std::size_t size() const { return static_cast<std::size_t>(count.x) * count.y * count.z; }
  glm::dvec3 place(int i, int j, int k) const
  {
    return { origin.x + (first.x + i) * spacing.x,
      origin.y + (first.y + j) * spacing.y,
      origin.z + (first.z + k) * spacing.z };
  }
};

/// Bounds of a field's values: lower <= value <= upper. The default knows nothing.
struct FieldRange
{
  float lower = -std::numeric_limits<float>::infinity();
  float upper = std::numeric_limits<float>::infinity();
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

  /// The values at all places of a block, x fastest, z slowest: the very bits that value() gives,
  /// as fast as the generator can. By default it calls value(). As many threads as value().
  virtual void values(const PlaceBlock& places, double time, float* out) const
  {
    for (int k = 0; k < places.count.z; ++k)
    {
      for (int j = 0; j < places.count.y; ++j)
      {
        for (int i = 0; i < places.count.x; ++i)
        {
          *out++ = this->value(places.place(i, j, k), time);
        }
      }
    }
  }

  /// Bounds of the values at all places in a closed box. They need not be tight, but no value there
  /// may lie outside them; where lower and upper are the same, each value is just that. Sparse
  /// sampling leaves out what it proves to be empty. By default nothing is known. As many threads
  /// as value().
  virtual FieldRange range_in(const Box& /* box */, double /* time */) const { return {}; }
};

}
