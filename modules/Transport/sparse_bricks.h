// Ranges of the values of sparse grids. Internal to Transport.
#pragma once

#include "Transport/bricks.h"
#include "Transport/sparse_voxels.h"

namespace brume
{

/// As measure_bricks(), from the topology and the bricks alone: neither time nor memory grows with
/// the box. Each voxel is read once. Voxels of the background are not counted as non-finite.
BrickRanges measure_sparse_bricks(const SparseVoxels& voxels, int threads = 0);

}
