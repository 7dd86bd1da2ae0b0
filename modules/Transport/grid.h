// A grid of voxels, read in place: the caller owns the memory.
#pragma once

#include <cstddef>

namespace brume
{

class SparseVoxels;

/// The types of voxel that are read as they are. Others are converted to Float32 by the caller.
enum class VoxelType
{
  UInt8,
  Int8,
  UInt16,
  Int16,
  Float32,
  Float16, ///< half precision; sparse grids only
};

/// Bytes of one component of one voxel.
std::size_t size_of(VoxelType type);

/// Where the colour of a voxel comes from.
enum class VoxelColour
{
  Value, ///< the classification's colour at the value
  First, ///< the classification's colour at the voxel's first component (two dependent components)
  RGB,   ///< the first three components, UInt8, 255 for 1 (four dependent components)
};

/// A view of voxels: dense ones, x fastest, then y, then z, components interleaved; or sparse ones.
///
/// Index space: voxel (i, j, k) sits at the point (i, j, k). Between voxels the value is trilinear,
/// or that of the nearest voxel. The grid fills the box from `lower(axis)` to `upper(axis)`: from
/// the first voxel to the last where voxels are points, half a voxel more on each side where they
/// are cells; in that outer half the nearest value is kept.
struct Grid
{
  const void* voxels = nullptr;
  /// In place of `voxels`, which is null then: SparseVoxels::grid() fills in the rest.
  const SparseVoxels* sparse = nullptr;
  VoxelType type = VoxelType::UInt8;
  /// Components of a voxel, 1 to 4.
  int components = 1;
  /// The component that carries the value: what is classified, and what the gradient is of.
  int component = 0;
  VoxelColour colour = VoxelColour::Value;
  /// Voxels along x, y and z; of a sparse grid, those of the box around it. At least 2 along x
  /// (repeat the voxel to pad a thinner grid) and 1 along y and z.
  int dims[3] = { 0, 0, 0 };
  /// The first voxel that the grid reaches along each axis; 0 for dense grids. Coordinates still
  /// count from voxel 0.
  int first[3] = { 0, 0, 0 };
  /// Voxels are cells (VTK's cell data) rather than points.
  bool cell_centred = false;
  /// Voxels that are read but that the grid does not reach along x: 1 for a grid that was padded
  /// from one voxel to two, else 0.
  int padding_x = 0;
  /// Trilinear, rather than the nearest voxel.
  bool linear = true;

  double lower(int axis) const { return first[axis] - (cell_centred ? 0.5 : 0.0); }
  double upper(int axis) const
  {
    const int last = dims[axis] - 1 - (axis == 0 ? padding_x : 0);
    return cell_centred ? last + 0.5 : last;
  }
  /// Voxels in memory: of a sparse grid those of its bricks, not those of the box.
  std::size_t voxel_count() const;
  /// What they take.
  std::size_t bytes() const { return voxel_count() * components * size_of(type); }

  /// Throws std::invalid_argument for what the integrators cannot read: no memory, a size out of
  /// range, a component that is not there, colours in voxels that are not 4 × UInt8, a dense grid
  /// of Float16.
  void validate() const;
};

}
