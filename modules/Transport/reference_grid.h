// Reading a grid of any voxel type in double precision. Internal to Transport.
#pragma once

#include "Transport/grid.h"

#include <glm/vec3.hpp>

#include <memory>

namespace brume
{

/// The interpolated values of a grid, and their gradient. Places are in index space; outside the
/// voxels the nearest value is kept.
class ReferenceGrid
{
public:
  virtual ~ReferenceGrid() = default;

  virtual double value(const glm::dvec3& place, int component) const = 0;
  /// Central differences of the voxels, in values per voxel, one-sided by half at the grid's ends,
  /// then interpolated. Of Grid::component.
  virtual glm::dvec3 gradient(const glm::dvec3& place) const = 0;

  /// `empty_value` stands in for voxels that are not finite.
  static std::unique_ptr<ReferenceGrid> make(const Grid& grid, double empty_value);
};

}
