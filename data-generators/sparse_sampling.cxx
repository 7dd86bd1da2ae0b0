#include "data-generators/sparse_sampling.h"

#include "Transport/half.h"
#include "Transport/thread_arena.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <stdexcept>
#include <tbb/parallel_for.h>
#include <thread>
#include <vector>

namespace brume
{

namespace
{

constexpr int edge = SparseVoxels::brick_edge;
constexpr int least_block = 8;         ///< bricks along a block, the unit of work of the first pass
constexpr long most_blocks = 1 << 18;  ///< more, and they get larger: lists of theirs are kept
constexpr double topology_share = 0.3; ///< of the time, as progress counts it

/// The wish to stop, on its way out of the second pass.
struct Stopped
{
};

/// A cube of bricks, from its first one.
struct Block
{
  glm::ivec3 first;
  int bricks;
};

class Sampler
{
public:
  Sampler(const Field& field,
    double time,
    const Lattice& grid,
    const SparseSampleOptions& options,
    const Progress& progress)
    : m_field(field)
    , m_time(time)
    , m_grid(grid)
    , m_options(options)
    , m_progress(progress)
    , m_bricks((grid.dimensions + (edge - 1)) / edge)
  {
  }

  /// False where it was stopped.
  bool find_topology(SparseTopology& topology) const
  {
    int block_bricks = least_block;
    glm::ivec3 blocks;
    long count;
    for (;; block_bricks *= 2)
    {
      blocks = (m_bricks + (block_bricks - 1)) / block_bricks;
      count = static_cast<long>(blocks.x) * blocks.y * blocks.z;
      if (count <= most_blocks)
      {
        break;
      }
    }
    std::vector<SparseTopology> parts(count);
    const long batch = std::max(count / 64, 16L);
    for (long begin = 0; begin < count; begin += batch)
    {
      const long end = std::min(begin + batch, count);
      tbb::parallel_for(begin,
        end,
        [&](long b)
        {
          const glm::ivec3 at(b % blocks.x, b / blocks.x % blocks.y, b / blocks.x / blocks.y);
          this->descend({ at * block_bricks, block_bricks }, parts[b]);
        });
      if (m_progress && !m_progress(topology_share * static_cast<double>(end) / count))
      {
        return false;
      }
    }
    for (SparseTopology& part : parts)
    {
      topology.bricks.insert(topology.bricks.end(), part.bricks.begin(), part.bricks.end());
      topology.tiles.insert(topology.tiles.end(), part.tiles.begin(), part.tiles.end());
      part = {};
    }
    return true;
  }

  void fill(const BrickPlace& brick, float* values) const
  {
    const glm::ivec3 first = first_voxel(brick);
    const glm::ivec3 count = voxels_within(first);
    if (count == glm::ivec3(edge))
    {
      m_field.values({ m_grid.origin, m_grid.spacing, first, count }, m_time, values);
      return;
    }
    float some[SparseVoxels::brick_voxels];
    m_field.values({ m_grid.origin, m_grid.spacing, first, count }, m_time, some);
    std::fill(values, values + SparseVoxels::brick_voxels, m_options.background);
    const float* from = some;
    for (int k = 0; k < count.z; ++k)
    {
      for (int j = 0; j < count.y; ++j, from += count.x)
      {
        std::copy(from, from + count.x, values + (k * edge + j) * edge);
      }
    }
  }

private:
  static glm::ivec3 first_voxel(const BrickPlace& brick)
  {
    return glm::ivec3(brick[0], brick[1], brick[2]) * edge;
  }

  /// How many voxels of a brick, from its first one, the grid has.
  glm::ivec3 voxels_within(const glm::ivec3& first) const
  {
    glm::ivec3 count;
    for (int axis = 0; axis < 3; ++axis)
    {
      count[axis] = std::min(edge, m_grid.dimensions[axis] - first[axis]);
    }
    return count;
  }

  void descend(const Block& block, SparseTopology& found) const
  {
    const glm::ivec3 first = block.first * edge;
    glm::ivec3 last = first + block.bricks * edge - 1;
    bool whole = true;
    for (int axis = 0; axis < 3; ++axis)
    {
      if (first[axis] >= m_grid.dimensions[axis])
      {
        return;
      }
      whole = whole && last[axis] < m_grid.dimensions[axis];
      last[axis] = std::min(last[axis], m_grid.dimensions[axis] - 1);
    }
    const glm::dvec3 a = m_grid.place(first.x, first.y, first.z);
    const glm::dvec3 b = m_grid.place(last.x, last.y, last.z);
    Box box;
    for (int axis = 0; axis < 3; ++axis)
    {
      box.lower[axis] = std::min(a[axis], b[axis]);
      box.upper[axis] = std::max(a[axis], b[axis]);
    }
    const FieldRange range = m_field.range_in(box, m_time);
    const auto place_of = [](const glm::ivec3& brick) {
      return BrickPlace{ { brick.x, brick.y, brick.z } };
    };
    if (range.lower == range.upper)
    {
      if (range.lower == m_options.background)
      {
        return;
      }
      if (whole)
      {
        found.tiles.push_back(
          { place_of(block.first), place_of(block.first + (block.bricks - 1)), range.lower });
        return;
      }
    }
    if (block.bricks > 1)
    {
      const int half = block.bricks / 2;
      for (int child = 0; child < 8; ++child)
      {
        this->descend(
          { block.first + half * glm::ivec3(child & 1, child >> 1 & 1, child >> 2), half }, found);
      }
    }
    else if (this->is_active(first))
    {
      found.bricks.push_back(place_of(block.first));
    }
  }

  bool is_active(const glm::ivec3& first) const
  {
    const glm::ivec3 count = voxels_within(first);
    static constexpr int order[edge] = { 4, 0, 7, 2, 5, 1, 6, 3 }; // layers, far from one another
    for (const int k : order)
    {
      if (k >= count.z)
      {
        continue;
      }
      float layer[edge * edge];
      const int size = count.x * count.y;
      m_field.values(
        { m_grid.origin, m_grid.spacing, first + glm::ivec3(0, 0, k), { count.x, count.y, 1 } },
        m_time,
        layer);
      if (!std::all_of(layer, layer + size, [this](float v) { return v == m_options.background; }))
      {
        return true;
      }
    }
    return false;
  }

  const Field& m_field;
  double m_time;
  const Lattice& m_grid;
  const SparseSampleOptions& m_options;
  const Progress& m_progress;
  glm::ivec3 m_bricks;
};

}

SparseSample sample_sparse(const Field& field,
  double time,
  const Lattice& grid,
  const SparseSampleOptions& options,
  const Progress& progress)
{
  if (options.type != VoxelType::Float32 && options.type != VoxelType::Float16)
  {
    throw std::invalid_argument("sparse voxels of a field are of 32 or of 16 bits, floating point");
  }
  if (std::isnan(options.background))
  {
    throw std::invalid_argument("the background of sparse voxels must be a number");
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    if (grid.dimensions[axis] < 1 || grid.dimensions[axis] > 1 << 20)
    {
      throw std::invalid_argument("a sparse grid has 1 to 2^20 voxels along an axis");
    }
  }
  SparseSample sample;
  const Sampler sampler(field, time, grid, options, progress);
  SparseTopology topology;
  bool complete = false;
  ThreadArena(options.threads).execute([&] { complete = sampler.find_topology(topology); });
  if (!complete)
  {
    sample.stopped = true;
    return sample;
  }
  if (topology.bricks.empty() && topology.tiles.empty())
  {
    return sample;
  }

  std::atomic<std::int64_t> active{ 0 };
  std::atomic<std::size_t> filled{ 0 };
  std::size_t told = 0; // by the thread that asked for the work alone
  const std::thread::id asker = std::this_thread::get_id();
  const auto fill = [&](std::size_t index, void* voxels)
  {
    float own[SparseVoxels::brick_voxels];
    float* values = options.type == VoxelType::Float32 ? static_cast<float*>(voxels) : own;
    sampler.fill(topology.bricks[index], values);
    active += std::count_if(values,
      values + SparseVoxels::brick_voxels,
      [&](float v) { return v != options.background; });
    if (values == own)
    {
      std::transform(own,
        own + SparseVoxels::brick_voxels,
        static_cast<std::uint16_t*>(voxels),
        [](float v) { return half_from_float(v); });
    }
    const std::size_t done = ++filled;
    if (progress && std::this_thread::get_id() == asker &&
        done - told > topology.bricks.size() / 100 &&
        done < topology.bricks.size()) // the end is told below
    {
      told = done;
      const double part = static_cast<double>(done) / topology.bricks.size();
      if (!progress(topology_share + (1.0 - topology_share) * part))
      {
        throw Stopped();
      }
    }
  };
  try
  {
    sample.voxels = std::make_shared<const SparseVoxels>(
      options.type, options.background, topology, fill, options.threads);
  }
  catch (const Stopped&)
  {
    sample.stopped = true;
    return sample;
  }
  for (const SparseTile& tile : topology.tiles)
  {
    std::int64_t voxels = SparseVoxels::brick_voxels;
    for (int axis = 0; axis < 3; ++axis)
    {
      voxels *= tile.last[axis] - tile.first[axis] + 1;
    }
    active += voxels;
  }
  sample.active_voxels = active;
  if (progress && !progress(1.0))
  {
    return { nullptr, 0, true };
  }
  return sample;
}

}
