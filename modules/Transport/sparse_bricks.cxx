#include "Transport/sparse_bricks.h"

#include "Transport/half.h"
#include "Transport/thread_arena.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

namespace brume
{

namespace
{

constexpr int edge = SparseVoxels::brick_edge;
constexpr float infinity = std::numeric_limits<float>::infinity();

/// The least number of ranges that is worth to be made.
constexpr std::size_t few_ranges = std::size_t(1) << 15;

/// So many bricks a tile counts for at the most, when the number of ranges is settled: of a wide one
/// there is little to tell, and a file may hold one of a billion bricks.
constexpr std::size_t most_of_tile = 64;

/// Range of finite values; lower > upper where there are none.
struct Range
{
  float lower = infinity;
  float upper = -infinity;
  bool all_finite = true;

  void include(float value)
  {
    const bool finite = std::abs(value) <= std::numeric_limits<float>::max();
    all_finite = all_finite && finite;
    lower = finite ? std::min(lower, value) : lower;
    upper = finite ? std::max(upper, value) : upper;
  }
};

/// The ranges of a brick that its neighbours reach: entry s is that of the voxels at the brick's
/// low end along x (bit 0 of s), y (bit 1) and z (bit 2); entry 0 is the whole brick's.
struct BrickReach
{
  Range part[8];
  std::uint32_t non_finite = 0; ///< voxels

  explicit BrickReach(const float* voxels)
  {
    // A lane for each voxel of a row, an accumulator for rows at the low ends of y and z.
    float lower[4][edge];
    float upper[4][edge];
    float taint[edge] = {}; // NaN where a voxel is not finite
    std::fill(&lower[0][0], &lower[0][0] + 4 * edge, infinity);
    std::fill(&upper[0][0], &upper[0][0] + 4 * edge, -infinity);
    for (int z = 0; z < edge; ++z)
    {
      for (int y = 0; y < edge; ++y)
      {
        const float* row = voxels + (z * edge + y) * edge;
        const int rows = (y == 0 ? 1 : 0) | (z == 0 ? 2 : 0);
        for (int x = 0; x < edge; ++x)
        {
          taint[x] += row[x] * 0.0f;
        }
        for (int part = rows;; part = (part - 1) & rows)
        {
          for (int x = 0; x < edge; ++x)
          {
            lower[part][x] = row[x] < lower[part][x] ? row[x] : lower[part][x];
            upper[part][x] = row[x] > upper[part][x] ? row[x] : upper[part][x];
          }
          if (part == 0)
          {
            break;
          }
        }
      }
    }
    if (std::any_of(taint, taint + edge, [](float t) { return t != 0.0f; }))
    {
      this->read_slowly(voxels);
      return;
    }
    for (int rows = 0; rows < 4; ++rows)
    {
      this->part[2 * rows].lower = *std::min_element(lower[rows], lower[rows] + edge);
      this->part[2 * rows].upper = *std::max_element(upper[rows], upper[rows] + edge);
      this->part[2 * rows + 1].lower = lower[rows][0];
      this->part[2 * rows + 1].upper = upper[rows][0];
    }
  }

private:
  void read_slowly(const float* voxels)
  {
    for (int i = 0; i < SparseVoxels::brick_voxels; ++i)
    {
      const int low = ((i & 7) == 0 ? 1 : 0) | ((i >> 3 & 7) == 0 ? 2 : 0) | (i >> 6 == 0 ? 4 : 0);
      for (int s = 0; s < 8; ++s)
      {
        if ((s & low) == s)
        {
          this->part[s].include(voxels[i]);
        }
      }
      this->non_finite += !std::isfinite(voxels[i]);
    }
  }
};

BrickReach reach_of(const SparseVoxels& voxels, std::size_t slot)
{
  float numbers[SparseVoxels::brick_voxels];
  const auto convert = [&](const auto* stored, auto to_float)
  {
    stored += slot * SparseVoxels::brick_voxels;
    for (int i = 0; i < SparseVoxels::brick_voxels; ++i)
    {
      numbers[i] = to_float(stored[i]);
    }
  };
  const auto plain = [](auto value) { return static_cast<float>(value); };
  const void* pool = voxels.pool();
  switch (voxels.type())
  {
    case VoxelType::UInt8:
      convert(static_cast<const std::uint8_t*>(pool), plain);
      break;
    case VoxelType::Int8:
      convert(static_cast<const std::int8_t*>(pool), plain);
      break;
    case VoxelType::UInt16:
      convert(static_cast<const std::uint16_t*>(pool), plain);
      break;
    case VoxelType::Int16:
      convert(static_cast<const std::int16_t*>(pool), plain);
      break;
    case VoxelType::Float16:
      convert(static_cast<const std::uint16_t*>(pool), float_from_half);
      break;
    case VoxelType::Float32:
      return BrickReach(static_cast<const float*>(pool) + slot * SparseVoxels::brick_voxels);
  }
  return BrickReach(numbers);
}

/// The ranges of cubes of (2^shift)³ bricks while many threads widen them.
class Cubes
{
public:
  explicit Cubes(BrickRanges& ranges)
    : Ranges(ranges)
    , Shift(ranges.shift - SparseVoxels::brick_shift)
    , Reached(ranges.size(), 0)
    , NonFinite(ranges.size(), 0)
  {
    ranges.minimum.assign(ranges.size(), infinity);
    ranges.maximum.assign(ranges.size(), -infinity);
  }

  /// A brick at a place: widens the cube that it is in, and those before it that reach it.
  void include(const BrickPlace& place, const BrickReach& reach)
  {
    for (int s = 0; s < 8; ++s)
    {
      std::size_t cube = 0;
      bool other = true; // a cube that no smaller part has widened already
      for (int axis = 2; axis >= 0; --axis)
      {
        const int before = s >> axis & 1;
        other = other && (!before || (place[axis] & ((1 << this->Shift) - 1)) == 0);
        cube = cube * this->Ranges.dims[axis] + ((place[axis] - before) >> this->Shift);
      }
      if (other)
      {
        this->widen(cube, reach.part[s], 1);
      }
    }
  }

  /// A box of bricks of one value.
  void include(const BrickBox& box, const Range& range)
  {
    BrickPlace lower, upper, cube;
    for (int axis = 0; axis < 3; ++axis)
    {
      lower[axis] = (box.first[axis] - 1) >> this->Shift;
      upper[axis] = box.last[axis] >> this->Shift;
    }
    for (cube[2] = lower[2]; cube[2] <= upper[2]; ++cube[2])
    {
      for (cube[1] = lower[1]; cube[1] <= upper[1]; ++cube[1])
      {
        for (cube[0] = lower[0]; cube[0] <= upper[0]; ++cube[0])
        {
          std::size_t at = 0;
          std::int64_t bricks = 1; // that the cube reaches, one more than its edge along each axis
          for (int axis = 2; axis >= 0; --axis)
          {
            const std::int32_t first = cube[axis] << this->Shift;
            bricks *= std::min(box.last[axis], first + (1 << this->Shift)) -
                      std::max(box.first[axis], first) + 1;
            at = at * this->Ranges.dims[axis] + cube[axis];
          }
          this->widen(at, range, bricks);
        }
      }
    }
  }

  /// Where a cube reaches bricks that are not there, it reaches the background.
  void finish(const Range& background)
  {
    const std::int64_t edge_bricks = (std::int64_t(1) << this->Shift) + 1;
    const std::int64_t all = edge_bricks * edge_bricks * edge_bricks;
    for (std::size_t cube = 0; cube < this->Reached.size(); ++cube)
    {
      if (this->Reached[cube] < all)
      {
        this->widen(cube, background, 0);
      }
    }
    if (std::find(this->NonFinite.begin(), this->NonFinite.end(), 1) != this->NonFinite.end())
    {
      this->Ranges.reaches_non_finite = std::move(this->NonFinite);
    }
  }

private:
  void widen(std::size_t cube, const Range& range, std::int64_t bricks)
  {
    std::atomic_ref<float> lower(this->Ranges.minimum[cube]);
    float seen = lower.load(std::memory_order_relaxed);
    while (range.lower < seen && !lower.compare_exchange_weak(seen, range.lower))
    {
    }
    std::atomic_ref<float> upper(this->Ranges.maximum[cube]);
    seen = upper.load(std::memory_order_relaxed);
    while (range.upper > seen && !upper.compare_exchange_weak(seen, range.upper))
    {
    }
    if (!range.all_finite)
    {
      std::atomic_ref<std::uint8_t>(this->NonFinite[cube]).store(1, std::memory_order_relaxed);
    }
    std::atomic_ref<std::int64_t>(this->Reached[cube]).fetch_add(bricks, std::memory_order_relaxed);
  }

  BrickRanges& Ranges;
  int Shift;                         ///< log2 of a cube's edge in bricks
  std::vector<std::int64_t> Reached; ///< bricks and parts of tiles that each cube reaches
  std::vector<std::uint8_t> NonFinite;
};

}

std::array<double, 2> value_range(const SparseVoxels& voxels, int threads)
{
  const BrickRanges ranges = measure_sparse_bricks(voxels, threads);
  return { { ranges.lower, ranges.upper } };
}

BrickRanges measure_sparse_bricks(const SparseVoxels& voxels, int threads)
{
  std::size_t bricks = voxels.places().size();
  for (const BrickBox& box : voxels.tiles())
  {
    bricks += std::min(box.size(), most_of_tile);
  }
  const std::size_t most = std::max(few_ranges, 2 * bricks);
  BrickRanges result;
  for (result.shift = SparseVoxels::brick_shift;; ++result.shift)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      result.dims[axis] = ((voxels.dims()[axis] - 1) >> result.shift) + 1;
    }
    if (result.size() <= most)
    {
      break;
    }
  }

  Cubes cubes(result);
  std::atomic<std::size_t> non_finite{ 0 };
  ThreadArena arena(threads);
  arena.execute(
    [&]
    {
      const std::size_t first = 1 + voxels.tile_slots();
      tbb::parallel_for(std::size_t(0),
        voxels.places().size(),
        [&](std::size_t i)
        {
          const BrickReach reach = reach_of(voxels, first + i);
          cubes.include(voxels.places()[i], reach);
          if (reach.non_finite > 0)
          {
            non_finite += reach.non_finite;
          }
        });
    });
  for (const BrickBox& box : voxels.tiles())
  {
    Range range;
    range.include(static_cast<float>(voxels.value_in_slot(box.slot, 0)));
    cubes.include(box, range);
    non_finite += range.all_finite ? 0 : box.size() * SparseVoxels::brick_voxels;
  }
  Range background;
  background.include(static_cast<float>(voxels.background()));
  cubes.finish(background);
  result.non_finite_voxels = non_finite;
  const float lower = *std::min_element(result.minimum.begin(), result.minimum.end());
  const float upper = *std::max_element(result.maximum.begin(), result.maximum.end());
  if (lower <= upper)
  {
    result.lower = lower;
    result.upper = upper;
  }
  return result;
}

}
