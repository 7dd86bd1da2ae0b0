// From a function of place and time to the voxels of a dense grid.
#pragma once

#include "data-generators/field.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>

namespace brume
{

/// A dense grid of voxel centres: voxel (i, j, k) stands at origin + (i, j, k) * spacing.
struct Lattice
{
  glm::ivec3 dimensions{ 0 }; ///< voxels along each axis
  glm::dvec3 origin{ 0.0 };   ///< centre of voxel (0, 0, 0), world units
  glm::dvec3 spacing{ 1.0 };  ///< world units between centres

  glm::dvec3 place(int i, int j, int k) const
  {
    return { origin.x + i * spacing.x, origin.y + j * spacing.y, origin.z + k * spacing.z };
  }
};

/// A block of voxels, first and last index along each axis, both within it.
struct Extent
{
  glm::ivec3 first{ 0 };
  glm::ivec3 last{ -1 };

  std::size_t voxels() const
  {
    return static_cast<std::size_t>(last.x - first.x + 1) * (last.y - first.y + 1) *
           (last.z - first.z + 1);
  }
};

/// All voxels of a grid.
Extent whole_extent(const Lattice& grid);

/// The grid of cubic voxels that fill a box, `size` of them along its longest side (at least 2) and
/// as many along the others as fit, rounded to the nearest, at least 2. The grid has the box's
/// centre; each voxel's centre stands half a voxel or more within the longest side's ends.
/// Throws std::invalid_argument for a size below 2 or a box without a volume.
Lattice grid_over(const Box& box, int size);

/// Called now and then, from the thread that asked for the work, with the fraction done in (0, 1].
/// To return false is to ask for the work to stop.
using Progress = std::function<bool(double)>;

/// The field at the centre of each voxel of a block of the grid, on all threads that TBB gives.
/// A voxel's value does not depend on the block, so pieces equal the whole.
/// `values` has extent.voxels() elements, x fastest and z slowest. False if `progress` asked to
/// stop; the values are then partly written.
bool sample(const Field& field,
  double time,
  const Lattice& grid,
  const Extent& extent,
  float* values,
  const Progress& progress = {});

/// The loop below sample(), for those who do more with a voxel than ask a field: `row` fills the
/// voxels (extent.first.x … extent.last.x, j, k) at `offset` elements from the block's first one.
/// Rows run on all threads that TBB gives, in any order. An exception in `row` stops the work and
/// comes out of here.
bool for_each_row(const Extent& extent,
  const std::function<void(int j, int k, std::size_t offset)>& row,
  const Progress& progress = {});

}
