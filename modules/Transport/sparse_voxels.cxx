#include "Transport/sparse_voxels.h"

#include "Transport/half.h"
#include "Transport/thread_arena.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#ifdef __linux__
#include <sys/mman.h>
#endif

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <new>
#include <stdexcept>
#include <string>

namespace brume
{

namespace
{

/// The value as a voxel of the type.
std::uint32_t to_voxel(VoxelType type, double value)
{
  const auto whole = [value](double lower, double upper)
  {
    return std::isnan(value) ? 0u
                             : static_cast<std::uint32_t>(static_cast<std::int32_t>(
                                 std::lround(std::clamp(value, lower, upper))));
  };
  switch (type)
  {
    case VoxelType::UInt8:
      return whole(0.0, 255.0);
    case VoxelType::Int8:
      return whole(-128.0, 127.0);
    case VoxelType::UInt16:
      return whole(0.0, 65535.0);
    case VoxelType::Int16:
      return whole(-32768.0, 32767.0);
    case VoxelType::Float16:
      return half_from_float(static_cast<float>(value));
    case VoxelType::Float32:
      break;
  }
  const float single = static_cast<float>(value);
  std::uint32_t bits;
  std::memcpy(&bits, &single, sizeof(bits));
  return bits;
}

template <class T>
T read(const void* pool, std::size_t voxel)
{
  return static_cast<const T*>(pool)[voxel];
}

}

void SparseVoxels::Free::operator()(void* memory) const
{
  std::free(memory);
}

SparseVoxels::SparseVoxels(VoxelType type,
  double background,
  const SparseTopology& topology,
  const Fill& fill,
  int threads,
  std::size_t most_bytes)
  : Type(type)
  , Background(background)
{
  this->settle_box(topology);
  const std::vector<double> values = this->settle_tiles(topology);
  const std::size_t count = topology.bricks.size();
  if (count + this->TileSlots + 1 > static_cast<std::size_t>(std::numeric_limits<int>::max()))
  {
    throw std::length_error("the sparse grid has more than 2^31 bricks");
  }
  const std::size_t pool_bytes =
    (count + this->TileSlots + 1) * static_cast<std::size_t>(brick_voxels) * size_of(type);
  if (pool_bytes > most_bytes)
  {
    throw std::length_error(
      "the sparse grid would take " + std::to_string(pool_bytes >> 20) + " MiB");
  }
  ThreadArena arena(threads);
  arena.execute(
    [&]
    {
      // Bricks near one another come to lie near one another in the pool.
      struct Entry
      {
        std::uint64_t number;
        std::size_t index;
      };
      std::vector<Entry> order(count);
      this->Places.resize(count);
      tbb::parallel_for(std::size_t(0),
        count,
        [&](std::size_t i)
        {
          BrickPlace place = topology.bricks[i];
          for (int axis = 0; axis < 3; ++axis)
          {
            place[axis] -= this->Origin[axis] >> brick_shift;
          }
          order[i] = { morton(place), i };
        });
      tbb::parallel_sort(order.begin(),
        order.end(),
        [](const Entry& a, const Entry& b) { return a.number < b.number; });
      tbb::parallel_for(std::size_t(0),
        count,
        [&](std::size_t i) { this->Places[i] = from_morton(order[i].number); });

      this->allocate();
      std::array<std::int32_t, 3> bricks;
      for (int axis = 0; axis < 3; ++axis)
      {
        bricks[axis] = ((this->Dims[axis] - 1) >> brick_shift) + 1;
      }
      this->Table = SparseTable(bricks,
        this->Places,
        static_cast<std::int32_t>(1 + this->TileSlots),
        this->Tiles,
        this->PoolBytes,
        most_bytes - std::min(pool_bytes, most_bytes));

      this->fill_constant(0, background);
      for (std::size_t i = 0; i < values.size(); ++i)
      {
        this->fill_constant(1 + i, values[i]);
      }
      const std::size_t brick_bytes = brick_voxels * size_of(type);
      char* first = static_cast<char*>(this->Pool.get()) + (1 + this->TileSlots) * brick_bytes;
      tbb::parallel_for(std::size_t(0),
        count,
        [&](std::size_t i) { fill(order[i].index, first + i * brick_bytes); });
    });
  this->Background = this->value_in_slot(0, 0);
}

SparseVoxels::~SparseVoxels() = default;

void SparseVoxels::settle_box(const SparseTopology& topology)
{
  BrickPlace first, last;
  first.fill(std::numeric_limits<std::int32_t>::max());
  last.fill(std::numeric_limits<std::int32_t>::min());
  const auto include = [&](const BrickPlace& lower, const BrickPlace& upper)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      if (lower[axis] > upper[axis])
      {
        throw std::invalid_argument("a tile of the sparse grid ends before it begins");
      }
      first[axis] = std::min(first[axis], lower[axis]);
      last[axis] = std::max(last[axis], upper[axis]);
    }
  };
  for (const BrickPlace& brick : topology.bricks)
  {
    include(brick, brick);
  }
  for (const SparseTile& tile : topology.tiles)
  {
    include(tile.first, tile.last);
  }
  if (first[0] > last[0])
  {
    throw std::invalid_argument("the sparse grid has no voxels");
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    // A brick of background on each side.
    const std::int64_t bricks = std::int64_t(last[axis]) - first[axis] + 3;
    if (bricks > most_bricks || std::abs(std::int64_t(first[axis])) >= (std::int64_t(1) << 28))
    {
      throw std::invalid_argument("the box around the sparse grid is wider than " +
                                  std::to_string(std::int64_t(most_bricks) << brick_shift) +
                                  " voxels");
    }
    this->Origin[axis] = (first[axis] - 1) * brick_edge;
    this->First[axis] = brick_edge - 1;
    this->Dims[axis] = static_cast<std::int32_t>((bricks - 1) * brick_edge + 1);
  }
}

std::vector<double> SparseVoxels::settle_tiles(const SparseTopology& topology)
{
  std::vector<double> values;
  for (const SparseTile& tile : topology.tiles)
  {
    values.push_back(tile.value);
  }
  // NaN is less than nothing and equal to nothing: it would break the order.
  const auto is_nan = [](double value) { return std::isnan(value); };
  const bool any_nan = std::any_of(values.begin(), values.end(), is_nan);
  values.erase(std::remove_if(values.begin(), values.end(), is_nan), values.end());
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  if (any_nan)
  {
    values.push_back(std::numeric_limits<double>::quiet_NaN());
  }
  for (const SparseTile& tile : topology.tiles)
  {
    BrickBox box;
    for (int axis = 0; axis < 3; ++axis)
    {
      box.first[axis] = tile.first[axis] - (this->Origin[axis] >> brick_shift);
      box.last[axis] = tile.last[axis] - (this->Origin[axis] >> brick_shift);
    }
    const std::size_t at =
      std::isnan(tile.value)
        ? values.size() - 1
        : std::lower_bound(values.begin(), values.end() - any_nan, tile.value) - values.begin();
    box.slot = static_cast<std::int32_t>(1 + at);
    this->Tiles.push_back(box);
  }
  this->TileSlots = values.size();
  return values;
}

void SparseVoxels::allocate()
{
  // Whole large pages: fewer faults while it is filled, fewer misses while it is read.
  constexpr std::size_t large_page = std::size_t(1) << 21;
  const std::size_t bricks = this->TileSlots + 1 + this->Places.size();
  const std::size_t need = bricks * brick_voxels * size_of(this->Type) + sizeof(std::uint32_t);
  const std::size_t alignment = need >= 4 * large_page ? large_page : 64;
  this->PoolBytes = (need + alignment - 1) / alignment * alignment;
  this->Pool.reset(std::aligned_alloc(alignment, this->PoolBytes));
  if (!this->Pool)
  {
    throw std::bad_alloc();
  }
#ifdef __linux__
  if (alignment == large_page)
  {
    madvise(this->Pool.get(), this->PoolBytes, MADV_HUGEPAGE); // a wish; nothing hangs on it
  }
#endif
  std::memset(
    static_cast<char*>(this->Pool.get()) + need - sizeof(std::uint32_t), 0, sizeof(std::uint32_t));
}

void SparseVoxels::fill_constant(std::size_t slot, double value)
{
  const std::size_t bytes = size_of(this->Type);
  const std::uint32_t bits = to_voxel(this->Type, value);
  char* voxels = static_cast<char*>(this->Pool.get()) + slot * brick_voxels * bytes;
  for (int i = 0; i < brick_voxels; ++i)
  {
    std::memcpy(voxels + i * bytes, &bits, bytes); // the lowest bytes come first
  }
}

double SparseVoxels::value_in_slot(std::size_t slot, int voxel) const
{
  const void* pool = this->Pool.get();
  const std::size_t at = slot * brick_voxels + static_cast<std::size_t>(voxel);
  switch (this->Type)
  {
    case VoxelType::UInt8:
      return read<std::uint8_t>(pool, at);
    case VoxelType::Int8:
      return read<std::int8_t>(pool, at);
    case VoxelType::UInt16:
      return read<std::uint16_t>(pool, at);
    case VoxelType::Int16:
      return read<std::int16_t>(pool, at);
    case VoxelType::Float16:
      return float_from_half(read<std::uint16_t>(pool, at));
    case VoxelType::Float32:
      return read<float>(pool, at);
  }
  return 0.0;
}

double SparseVoxels::value(std::int32_t i, std::int32_t j, std::int32_t k) const
{
  if (i < 0 || j < 0 || k < 0 || i >= this->Dims[0] || j >= this->Dims[1] || k >= this->Dims[2])
  {
    return this->Background;
  }
  const std::int32_t slot = this->Table.slot(i >> brick_shift, j >> brick_shift, k >> brick_shift);
  return this->value_in_slot(static_cast<std::size_t>(slot), (k & 7) << 6 | (j & 7) << 3 | (i & 7));
}

std::size_t SparseVoxels::memory_bytes() const
{
  return sizeof(*this) + this->PoolBytes + this->Table.memory_bytes() +
         this->Places.capacity() * sizeof(BrickPlace) + this->Tiles.capacity() * sizeof(BrickBox);
}

Grid SparseVoxels::grid() const
{
  Grid grid;
  grid.sparse = this;
  grid.type = this->Type;
  std::copy(this->Dims.begin(), this->Dims.end(), grid.dims);
  std::copy(this->First.begin(), this->First.end(), grid.first);
  return grid;
}

}
