#include "Transport/bricks.h"

#include "Transport/sparse_bricks.h"

#include <tbb/blocked_range.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <type_traits>

namespace brume
{

namespace
{

/// The range of the voxels [x0, x1] × [y0, y1] × [z0, z1] of one component.
template <class T>
struct RangeOf
{
  float lower = std::numeric_limits<float>::infinity();
  float upper = -std::numeric_limits<float>::infinity();
  bool all_finite = true;

  void read_row(const T* row, int count, int stride)
  {
    if constexpr (std::is_floating_point_v<T>)
    {
      for (int i = 0; i < count; ++i)
      {
        // A NaN fails both comparisons; infinities are told apart by the finite bounds.
        const T value = row[i * stride];
        const bool finite = std::abs(value) <= std::numeric_limits<T>::max();
        all_finite = all_finite && finite;
        lower = finite && value < lower ? value : lower;
        upper = finite && value > upper ? value : upper;
      }
    }
    else
    {
      T least = std::numeric_limits<T>::max();
      T most = std::numeric_limits<T>::lowest();
      for (int i = 0; i < count; ++i)
      {
        const T value = row[i * stride];
        least = std::min(least, value);
        most = std::max(most, value);
      }
      lower = std::min(lower, static_cast<float>(least));
      upper = std::max(upper, static_cast<float>(most));
    }
  }
};

template <class T>
void measure(const Grid& grid, BrickRanges& result)
{
  const int edge = result.edge();
  const int* n = grid.dims;
  const int stride = grid.components;
  if constexpr (std::is_floating_point_v<T>)
  {
    result.reaches_non_finite.resize(result.size());
  }
  const T* values = static_cast<const T*>(grid.voxels) + grid.component;
  std::atomic<std::size_t> non_finite{ 0 };

  // A layer of bricks is a task; each row of voxels is read once for each row of bricks it serves.
  tbb::parallel_for(0, result.dims[2],
    [&](int bz)
    {
      const int z_end = std::min(edge * (bz + 1), n[2] - 1);
      for (int by = 0; by < result.dims[1]; ++by)
      {
        const int y_end = std::min(edge * (by + 1), n[1] - 1);
        const std::size_t first =
          (static_cast<std::size_t>(bz) * result.dims[1] + by) * result.dims[0];
        std::vector<RangeOf<T>> row_ranges(result.dims[0]);
        for (int z = edge * bz; z <= z_end; ++z)
        {
          for (int y = edge * by; y <= y_end; ++y)
          {
            const T* row =
              values + (static_cast<std::size_t>(z) * n[1] + y) * n[0] * stride;
            for (int bx = 0; bx < result.dims[0]; ++bx)
            {
              const int x = edge * bx;
              const int x_end = std::min(x + edge, n[0] - 1);
              row_ranges[bx].read_row(row + static_cast<std::size_t>(x) * stride, x_end - x + 1,
                stride);
            }
            if constexpr (std::is_floating_point_v<T>)
            {
              if (z < edge * (bz + 1) && y < edge * (by + 1))
              {
                std::size_t bad = 0;
                for (int x = 0; x < n[0] - grid.padding_x; ++x)
                {
                  bad += !std::isfinite(row[static_cast<std::size_t>(x) * stride]);
                }
                non_finite += bad;
              }
            }
          }
        }
        for (int bx = 0; bx < result.dims[0]; ++bx)
        {
          result.minimum[first + bx] = row_ranges[bx].lower;
          result.maximum[first + bx] = row_ranges[bx].upper;
          if constexpr (std::is_floating_point_v<T>)
          {
            result.reaches_non_finite[first + bx] = !row_ranges[bx].all_finite;
          }
        }
      }
    });
  result.non_finite_voxels = non_finite;
  if (result.non_finite_voxels == 0)
  {
    result.reaches_non_finite.clear();
  }
}

void measure_type(const Grid& grid, BrickRanges& result)
{
  switch (grid.type)
  {
    case VoxelType::UInt8:
      measure<std::uint8_t>(grid, result);
      break;
    case VoxelType::Int8:
      measure<std::int8_t>(grid, result);
      break;
    case VoxelType::UInt16:
      measure<std::uint16_t>(grid, result);
      break;
    case VoxelType::Int16:
      measure<std::int16_t>(grid, result);
      break;
    case VoxelType::Float32:
      measure<float>(grid, result);
      break;
    case VoxelType::Float16: // refused by Grid::validate
      break;
  }
}

}

BrickRanges measure_bricks(const Grid& grid, int threads)
{
  grid.validate();
  if (grid.sparse)
  {
    return measure_sparse_bricks(*grid.sparse, threads);
  }
  BrickRanges result;
  for (int axis = 0; axis < 3; ++axis)
  {
    result.dims[axis] = (grid.dims[axis] - 1) / result.edge() + 1;
  }
  result.minimum.resize(result.size());
  result.maximum.resize(result.size());
  tbb::task_arena arena(threads > 0 ? threads : tbb::info::default_concurrency());
  arena.execute([&] { measure_type(grid, result); });
  const float lower = *std::min_element(result.minimum.begin(), result.minimum.end());
  const float upper = *std::max_element(result.maximum.begin(), result.maximum.end());
  if (lower <= upper)
  {
    result.lower = lower;
    result.upper = upper;
  }
  return result;
}

VisibleBricks find_visible_bricks(const BrickRanges& ranges,
  const std::function<bool(float, float)>& can_show, float empty_value)
{
  VisibleBricks result;
  result.shift = ranges.shift;
  std::copy(ranges.dims, ranges.dims + 3, result.dims);
  const int nx = ranges.dims[0];
  const int ny = ranges.dims[1];
  const int nz = ranges.dims[2];
  const std::int32_t far = nx + ny + nz; // farther than any brick
  result.distance.assign(ranges.size(), far);
  for (std::size_t i = 0; i < ranges.size(); ++i)
  {
    float lower = ranges.minimum[i];
    float upper = ranges.maximum[i];
    if (!ranges.reaches_non_finite.empty() && ranges.reaches_non_finite[i])
    {
      lower = std::min(lower, empty_value);
      upper = std::max(upper, empty_value);
    }
    if (lower <= upper && can_show(lower, upper))
    {
      result.distance[i] = 0;
      ++result.visible;
    }
  }
  // The chessboard distance is exact after one pass forward and one backward over all 26
  // neighbours (Rosenfeld and Pfaltz, Sequential operations in digital picture processing, 1966).
  auto sweep = [&](int begin, int end, int step)
  {
    const auto at = [&](int x, int y, int z) -> std::int32_t&
    { return result.distance[(static_cast<std::size_t>(z) * ny + y) * nx + x]; };
    const int zb = step > 0 ? 0 : nz - 1;
    const int yb = step > 0 ? 0 : ny - 1;
    const int xb = step > 0 ? 0 : nx - 1;
    for (int z = zb; z >= 0 && z < nz; z += step)
    {
      for (int y = yb; y >= 0 && y < ny; y += step)
      {
        for (int x = xb; x >= 0 && x < nx; x += step)
        {
          std::int32_t& here = at(x, y, z);
          // The 13 neighbours that this pass has already been to.
          for (int dz = begin; dz <= end && here > 1; ++dz)
          {
            for (int dy = -1; dy <= 1; ++dy)
            {
              for (int dx = -1; dx <= 1; ++dx)
              {
                const int order = dz * 9 + dy * 3 + dx;
                if (order * step >= 0)
                {
                  continue;
                }
                const int X = x + dx;
                const int Y = y + dy;
                const int Z = z + dz;
                if (X >= 0 && X < nx && Y >= 0 && Y < ny && Z >= 0 && Z < nz)
                {
                  here = std::min(here, at(X, Y, Z) + 1);
                }
              }
            }
          }
        }
      }
    }
  };
  sweep(-1, 0, 1);
  sweep(0, 1, -1);
  return result;
}

}
