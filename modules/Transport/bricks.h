// What is where: the range of values in each brick of a grid, and which bricks can be seen.
#pragma once

#include "Transport/grid.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace brume
{

/// Ranges of the values that can be met inside bricks of edge()³ cells.
///
/// Brick (i, j, k) covers index space from edge·i to edge·(i + 1) along x, and so on. Its range is
/// that of all voxels that interpolation can reach from there. Of several components it is the
/// range of Grid::component.
struct BrickRanges
{
  /// log2 of the edge: 3 for dense grids. Sparse ones in a wide box take larger bricks, so that
  /// there are at most 2¹⁵, or twice the grid's own bricks (a tile counts for up to 64) if that is more.
  int shift = 3;
  int edge() const { return 1 << shift; }

  int dims[3] = { 0, 0, 0 };
  std::vector<float> minimum;
  std::vector<float> maximum;
  /// Finite values of the whole grid; lower > upper where there are none.
  float lower = 0.0f;
  float upper = -1.0f;
  /// NaN or infinite voxels. They are drawn as empty, and are in no range.
  std::size_t non_finite_voxels = 0;
  /// 1 for each brick that can reach such a voxel, else 0; no entries where the grid has none.
  std::vector<std::uint8_t> reaches_non_finite;

  std::size_t size() const { return static_cast<std::size_t>(dims[0]) * dims[1] * dims[2]; }
};

/// Reads every voxel once, on so many threads (0: as many as the machine has processors).
BrickRanges measure_bricks(const Grid& grid, int threads = 0);

/// How far each brick is from one that can be seen, in bricks, the largest distance along an axis:
/// 0 for a brick that can be seen itself, 1 where only its neighbours can, and so on. A ray may
/// leap over the cube of 2·distance − 1 bricks around.
struct VisibleBricks
{
  int shift = 3; ///< log2 of a brick's edge, as BrickRanges has it
  int dims[3] = { 0, 0, 0 };
  std::vector<std::int32_t> distance;
  std::size_t visible = 0; ///< bricks that can be seen
};

/// `can_show(lower, upper)` tells whether any value in the range has an optical depth;
/// `empty_value` stands in for non-finite voxels when values are interpolated. It is asked from many
/// threads at once, and must give the same range the same answer.
VisibleBricks find_visible_bricks(const BrickRanges& ranges,
  const std::function<bool(float, float)>& can_show, float empty_value);

}
