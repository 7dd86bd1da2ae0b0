#include "Transport/bricks.h"

#include "Transport/sparse_bricks.h"
#include "Transport/row_ranges.h"
#include "Transport/thread_arena.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <type_traits>

namespace brume
{

namespace
{

/// The least and the greatest of each column of a brick row's voxels.
template <class T>
struct Columns
{
  std::vector<T> lower;
  std::vector<T> upper;
  /// Where only finite values count, nothing is yet the least or the greatest.
  static constexpr T highest = std::is_floating_point_v<T> ? std::numeric_limits<T>::infinity()
                                                           : std::numeric_limits<T>::max();
  static constexpr T lowest =
    std::is_floating_point_v<T> ? -highest : std::numeric_limits<T>::lowest();

  explicit Columns(std::size_t count)
    : lower(count)
    , upper(count)
  {
  }
  void clear()
  {
    std::fill(this->lower.begin(), this->lower.end(), highest);
    std::fill(this->upper.begin(), this->upper.end(), lowest);
  }
};

template <class T>
void measure(const Grid& grid, BrickRanges& result)
{
  const int edge = result.edge();
  const int* n = grid.dims;
  const std::size_t stride = grid.components;
  const std::size_t row_values = n[0] * stride;
  const T* values = static_cast<const T*>(grid.voxels);
  if constexpr (std::is_floating_point_v<T>)
  {
    result.reaches_non_finite.resize(result.size());
  }
  std::atomic<std::size_t> non_finite{ 0 };
  const auto row_at = [&](int y, int z)
  { return values + (static_cast<std::size_t>(z) * n[1] + y) * row_values; };

  // Marks the bricks of a row that reach a voxel that is not finite, and counts the voxels that are
  // the row's own.
  const auto find_non_finite = [&](int by, int y_end, int bz, int z_end, std::size_t first)
  {
    std::size_t bad = 0;
    for (int z = edge * bz; z <= z_end; ++z)
    {
      for (int y = edge * by; y <= y_end; ++y)
      {
        const T* row = row_at(y, z) + grid.component;
        const bool own = z < edge * (bz + 1) && y < edge * (by + 1);
        for (int x = 0; x < n[0]; ++x)
        {
          if (std::isfinite(static_cast<float>(row[x * stride])))
          {
            continue;
          }
          bad += own && x < n[0] - grid.padding_x;
          result.reaches_non_finite[first + std::min(x / edge, result.dims[0] - 1)] = 1;
          if (x % edge == 0 && x > 0)
          {
            result.reaches_non_finite[first + x / edge - 1] = 1;
          }
        }
      }
    }
    non_finite += bad;
  };

  // A layer of bricks is a task. Its rows of voxels are read in the order in which they lie in
  // memory, those on the border of two bricks twice.
  tbb::parallel_for(tbb::blocked_range<int>(0, result.dims[2]),
    [&](const tbb::blocked_range<int>& layers)
    {
      Columns<T> columns(row_values);
      for (int bz = layers.begin(); bz != layers.end(); ++bz)
      {
        const int z_end = std::min(edge * (bz + 1), n[2] - 1);
        for (int by = 0; by < result.dims[1]; ++by)
        {
          const int y_end = std::min(edge * (by + 1), n[1] - 1);
          const std::size_t first =
            (static_cast<std::size_t>(bz) * result.dims[1] + by) * result.dims[0];
          columns.clear();
          bool all_finite = true;
          for (int z = edge * bz; z <= z_end; ++z)
          {
            for (int y = edge * by; y <= y_end; ++y)
            {
              all_finite &=
                widen_ranges(row_at(y, z), row_values, columns.lower.data(), columns.upper.data());
            }
          }
          for (int bx = 0; bx < result.dims[0]; ++bx)
          {
            const int x_end = std::min(edge * (bx + 1), n[0] - 1);
            T lower = Columns<T>::highest;
            T upper = Columns<T>::lowest;
            for (int x = edge * bx; x <= x_end; ++x)
            {
              lower = std::min(lower, columns.lower[x * stride + grid.component]);
              upper = std::max(upper, columns.upper[x * stride + grid.component]);
            }
            result.minimum[first + bx] = static_cast<float>(lower);
            result.maximum[first + bx] = static_cast<float>(upper);
          }
          if constexpr (std::is_floating_point_v<T>)
          {
            if (!all_finite)
            {
              find_non_finite(by, y_end, bz, z_end, first);
            }
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
  ThreadArena arena(threads);
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

namespace
{

/// Whether bricks can be seen. Neighbours are often alike, so the last answer is kept.
class Sight
{
public:
  Sight(const BrickRanges& ranges,
    const std::function<bool(float, float)>& can_show,
    float empty_value)
    : Ranges(ranges)
    , CanShow(can_show)
    , EmptyValue(empty_value)
  {
  }
  bool can_see(std::size_t brick)
  {
    float lower = this->Ranges.minimum[brick];
    float upper = this->Ranges.maximum[brick];
    if (!this->Ranges.reaches_non_finite.empty() && this->Ranges.reaches_non_finite[brick])
    {
      lower = std::min(lower, this->EmptyValue);
      upper = std::max(upper, this->EmptyValue);
    }
    if (!(lower <= upper))
    {
      return false;
    }
    if (lower != this->LastLower || upper != this->LastUpper)
    {
      this->LastLower = lower;
      this->LastUpper = upper;
      this->LastAnswer = this->CanShow(lower, upper);
    }
    return this->LastAnswer;
  }

private:
  const BrickRanges& Ranges;
  const std::function<bool(float, float)>& CanShow;
  float EmptyValue;
  float LastLower = std::numeric_limits<float>::quiet_NaN();
  float LastUpper = std::numeric_limits<float>::quiet_NaN();
  bool LastAnswer = false;
};

/// Lets each brick of a row be as near as one more than the nearest of its three neighbours in the
/// row beside it.
void come_nearer(const std::int32_t* beside, int count, std::int32_t* row)
{
  if (count == 1)
  {
    row[0] = std::min(row[0], beside[0] + 1);
    return;
  }
  row[0] = std::min(row[0], std::min(beside[0], beside[1]) + 1);
  for (int x = 1; x < count - 1; ++x)
  {
    row[x] = std::min(row[x], std::min(std::min(beside[x - 1], beside[x]), beside[x + 1]) + 1);
  }
  row[count - 1] = std::min(row[count - 1], std::min(beside[count - 2], beside[count - 1]) + 1);
}

}

VisibleBricks find_visible_bricks(const BrickRanges& ranges,
  const std::function<bool(float, float)>& can_show,
  float empty_value)
{
  VisibleBricks result;
  result.shift = ranges.shift;
  std::copy(ranges.dims, ranges.dims + 3, result.dims);
  const int nx = ranges.dims[0];
  const int ny = ranges.dims[1];
  const int nz = ranges.dims[2];
  const std::size_t plane = static_cast<std::size_t>(nx) * ny;
  const std::int32_t far = nx + ny + nz; // farther than any brick
  result.distance.resize(ranges.size());
  std::int32_t* distance = result.distance.data();
  std::atomic<std::size_t> visible{ 0 };
  // A chess king's shortest way to a brick can be ordered: first along z and then along y, a step
  // aside in the same move where that is nearer, and the rest along x. So the distance is exact
  // after a pass to and fro along x, one along y that looks at three neighbours, and one along z
  // that looks at nine (cf. Rosenfeld and Pfaltz, Sequential operations in digital picture
  // processing, 1966).
  tbb::parallel_for(tbb::blocked_range<int>(0, nz),
    [&](const tbb::blocked_range<int>& planes)
    {
      Sight sight(ranges, can_show, empty_value);
      std::size_t seen = 0;
      for (int z = planes.begin(); z != planes.end(); ++z)
      {
        const std::size_t first = z * plane;
        for (int y = 0; y < ny; ++y)
        {
          const std::size_t start = first + static_cast<std::size_t>(y) * nx;
          std::int32_t* row = distance + start;
          std::int32_t nearest = far;
          for (int x = 0; x < nx; ++x)
          {
            const bool sees = sight.can_see(start + x);
            seen += sees;
            nearest = sees ? 0 : std::min(nearest + 1, far);
            row[x] = nearest;
          }
          for (int x = nx - 1; x >= 0; --x)
          {
            nearest = std::min(nearest + 1, row[x]);
            row[x] = nearest;
          }
        }
        std::int32_t* rows = distance + first;
        for (int y = 1; y < ny; ++y)
        {
          come_nearer(rows + std::size_t(y - 1) * nx, nx, rows + std::size_t(y) * nx);
        }
        for (int y = ny - 2; y >= 0; --y)
        {
          come_nearer(rows + std::size_t(y + 1) * nx, nx, rows + std::size_t(y) * nx);
        }
      }
      visible += seen;
    });
  const auto along_z = [&](int z, int beside)
  {
    tbb::parallel_for(tbb::blocked_range<int>(0, ny, 16),
      [&](const tbb::blocked_range<int>& range)
      {
        std::vector<std::int32_t> nearest(nx);
        for (int y = range.begin(); y != range.end(); ++y)
        {
          const std::int32_t* middle = distance + beside * plane + std::size_t(y) * nx;
          const std::int32_t* before = y > 0 ? middle - nx : middle;
          const std::int32_t* after = y < ny - 1 ? middle + nx : middle;
          for (int x = 0; x < nx; ++x)
          {
            nearest[x] = std::min(std::min(before[x], middle[x]), after[x]);
          }
          come_nearer(nearest.data(), nx, distance + z * plane + std::size_t(y) * nx);
        }
      });
  };
  for (int z = 1; z < nz; ++z)
  {
    along_z(z, z - 1);
  }
  for (int z = nz - 2; z >= 0; --z)
  {
    along_z(z, z + 1);
  }
  result.visible = visible;
  return result;
}

}
