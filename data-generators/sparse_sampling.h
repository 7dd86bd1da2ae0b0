// From a function of place and time straight to a sparse grid: it is never dense on the way.
#pragma once

#include "Transport/sparse_voxels.h"
#include "data-generators/field.h"
#include "data-generators/sampling.h"

#include <cstdint>
#include <memory>

namespace brume
{

struct SparseSampleOptions
{
  /// The value that is not stored: a voxel is active where its value is another. Not NaN.
  float background = 0.0f;

  /// Float32, or Float16, which halves the memory and rounds to 11 bits.
  VoxelType type = VoxelType::Float32;

  /// Threads; 0: as many as the machine has processors.
  int threads = 0;
};

struct SparseSample
{
  /// The bricks. Voxel (i, j, k) of the grid is the source's voxel (i, j, k) of these, which stands
  /// at grid.place(i, j, k). Null where no voxel is active, and where the work was stopped.
  std::shared_ptr<const SparseVoxels> voxels;
  std::int64_t active_voxels = 0;
  bool stopped = false; ///< `progress` asked for it
};

/// The field at the voxels' centres of a grid, in bricks of 8^3 wherever a voxel is active; all
/// other voxels, and those of the bricks beyond the grid's ends, are the background.
///
/// Two passes over the grid, both parallel. The first finds the topology: blocks of bricks are
/// halved and halved again, and left out as soon as Field::range_in() proves them to be all
/// background, or become a tile where it proves them to have one other value; of a brick that is
/// left, so many values are computed as it takes to meet one that is active. The second fills the
/// bricks.
///
/// Memory: what SparseVoxels takes, and while it is made 12 bytes more a brick and at most 13 MB for
/// the blocks of the first pass: it goes with the active bricks, not with the grid. The voxels are those of sample(), to the bit, for any number
/// of threads.
///
/// Throws std::invalid_argument for a type that is no floating-point one, a background that is NaN,
/// and a grid of more than 2^20 voxels along an axis.
SparseSample sample_sparse(const Field& field,
  double time,
  const Lattice& grid,
  const SparseSampleOptions& options = {},
  const Progress& progress = {});

}
