// How the kernels read a grid: addresses and limits, worked out once. Internal to Transport.
#pragma once

#include "Transport/grid.h"
#include "Transport/sparse_table.h"

#include <cstddef>
#include <cstdint>

namespace brume
{

/// One component of a dense grid, or a sparse grid.
struct FieldView
{
  /// Of a sparse grid: `base` is its pool then, and strides, rows and the last word mean nothing.
  const SparseTable* table = nullptr;
  const std::uint8_t* base = nullptr; ///< the component of voxel (0, 0, 0)
  VoxelType type = VoxelType::UInt8;
  std::size_t stride[3] = { 0, 0, 0 }; ///< bytes from a voxel to the next along x, y, z
  /// Bytes from a cell's first row to its second along y and z; 0 where the grid is one voxel
  /// thick.
  std::ptrdiff_t row[3] = { 0, 0, 0 };
  int last[3] = { 0, 0, 0 };      ///< the last voxel
  int last_cell[3] = { 0, 0, 0 }; ///< the last voxel that begins a cell
  /// Offset from `base` of the last 4 bytes of the voxels: kernels read whole words.
  std::size_t last_word = 0;
  bool far = false;        ///< offsets (of a sparse grid: indices) do not fit a gather's 32 bits
  bool linear = true;      ///< trilinear, else the nearest voxel
  bool non_finite = false; ///< NaN or infinities are there, and read as `empty_value`
  float empty_value = 0.0f;
};

FieldView view_field(const Grid& grid, int component, bool non_finite, float empty_value);

}
