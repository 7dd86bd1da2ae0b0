// Fields sampled into sparse grids: what dense sampling gives, with any number of threads, and
// nothing where there is nothing.
#include "Transport/half.h"
#include "data-generators/cumulus.h"
#include "data-generators/sparse_sampling.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <atomic>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <vector>

namespace
{

/// 1 in the lower half of a cube of 64, a ramp in a slab, 0 above: bounds that prove it all, and a
/// count of the places that were asked.
class Steps : public brume::Field
{
public:
  brume::Box bounds() const override { return { glm::dvec3(0.0), glm::dvec3(64.0) }; }
  float value(const glm::dvec3& p, double) const override
  {
    ++Asked;
    return p.z < 31.0 ? 1.0f : p.z < 37.0 ? static_cast<float>((37.0 - p.z) / 6.0) : 0.0f;
  }
  brume::FieldRange range_in(const brume::Box& box, double) const override
  {
    if (box.upper.z < 31.0)
    {
      return { 1.0f, 1.0f };
    }
    return box.lower.z >= 37.0 ? brume::FieldRange{ 0.0f, 0.0f } : brume::FieldRange{ 0.0f, 1.0f };
  }
  mutable std::atomic<long> Asked{ 0 };
};

/// Nothing at all, and it does not say so.
class Nothing : public brume::Field
{
public:
  brume::Box bounds() const override { return { glm::dvec3(0.0), glm::dvec3(1.0) }; }
  float value(const glm::dvec3&, double) const override { return 0.0f; }
};

double sparse_value(const brume::SparseSample& sample, int i, int j, int k)
{
  const auto& origin = sample.voxels->origin();
  return sample.voxels->value(i - origin[0], j - origin[1], k - origin[2]);
}

/// All voxels of the sparse sample against those of the dense one.
void expect_same(const brume::SparseSample& sparse,
  const brume::Lattice& grid,
  const std::vector<float>& dense)
{
  std::int64_t active = 0;
  std::size_t n = 0;
  for (int k = 0; k < grid.dimensions.z; ++k)
    for (int j = 0; j < grid.dimensions.y; ++j)
      for (int i = 0; i < grid.dimensions.x; ++i, ++n)
      {
        ASSERT_EQ(sparse_value(sparse, i, j, k), dense[n]) << i << ' ' << j << ' ' << k;
        active += dense[n] != 0.0f;
      }
  EXPECT_EQ(sparse.active_voxels, active);
}

/// The bytes of the bricks, in their order.
std::vector<float> pool_of(const brume::SparseSample& sample)
{
  const float* pool = static_cast<const float*>(sample.voxels->pool());
  return { pool, pool + sample.voxels->slot_count() * brume::SparseVoxels::brick_voxels };
}

}

TEST(SparseSampling, HoldsWhatDenseSamplingGives)
{
  const brume::Cumulus cloud;
  const brume::Lattice grid = brume::grid_over(cloud.bounds(), 90); // no multiple of 8
  std::vector<float> dense(brume::whole_extent(grid).voxels());
  brume::sample(cloud, 7.0, grid, brume::whole_extent(grid), dense.data());
  const brume::SparseSample sparse = brume::sample_sparse(cloud, 7.0, grid);
  ASSERT_TRUE(sparse.voxels);
  expect_same(sparse, grid, dense);
  // Only bricks with an active voxel are stored.
  for (std::size_t b = 0; b < sparse.voxels->places().size(); ++b)
  {
    bool any = false;
    for (int v = 0; v < brume::SparseVoxels::brick_voxels; ++v)
    {
      any = any || sparse.voxels->value_in_slot(1 + b, v) != 0.0;
    }
    ASSERT_TRUE(any) << "brick " << b;
  }
}

TEST(SparseSampling, MakesTheSameBytesWithAnyNumberOfThreads)
{
  const brume::Cumulus cloud;
  const brume::Lattice grid = brume::grid_over(cloud.bounds(), 128);
  tbb::global_control sixteen(tbb::global_control::max_allowed_parallelism, 16);
  brume::SparseSampleOptions options;
  options.threads = 1;
  const brume::SparseSample one = brume::sample_sparse(cloud, 0.0, grid, options);
  for (const int threads : { 2, 5, 16 })
  {
    options.threads = threads;
    const brume::SparseSample many = brume::sample_sparse(cloud, 0.0, grid, options);
    EXPECT_EQ(one.active_voxels, many.active_voxels);
    EXPECT_EQ(one.voxels->places(), many.voxels->places());
    EXPECT_EQ(pool_of(one), pool_of(many)) << threads << " threads";
  }
}

TEST(SparseSampling, TakesMemoryByTheActiveVoxels)
{
  const brume::Cumulus cloud;
  const auto bytes = [&](int size)
  {
    const brume::SparseSample s =
      brume::sample_sparse(cloud, 0.0, brume::grid_over(cloud.bounds(), size));
    return static_cast<double>(s.voxels->memory_bytes()) / s.active_voxels;
  };
  // A voxel takes 4 bytes; the rest are bricks that are not full, fewer the finer the grid is.
  EXPECT_LT(bytes(256), 8.0);
  EXPECT_LT(bytes(256), bytes(128));
}

TEST(SparseSampling, LeavesOutWhatIsProvedToBeEmptyAndTilesWhatIsConstant)
{
  const Steps steps;
  brume::Lattice grid;
  grid.dimensions = glm::ivec3(61, 64, 64); // the last bricks along x have voxels beyond the grid
  const brume::SparseSample sparse = brume::sample_sparse(steps, 0.0, grid);
  std::vector<float> dense(brume::whole_extent(grid).voxels());
  const long asked = steps.Asked;
  brume::sample(steps, 0.0, grid, brume::whole_extent(grid), dense.data());
  ASSERT_TRUE(sparse.voxels);
  expect_same(sparse, grid, dense);
  EXPECT_GT(sparse.voxels->tiles().size(), 0u);
  // Two layers of bricks hold the ramp, and there are those at the end of x.
  EXPECT_EQ(sparse.voxels->places().size(), 8u * 8u * 2u + 8u * 3u);
  EXPECT_LT(asked, 61 * 64 * 64 / 2);
  // Beyond the grid's end there is nothing.
  EXPECT_EQ(sparse_value(sparse, 61, 3, 3), 0.0);
  EXPECT_EQ(sparse_value(sparse, 60, 3, 3), 1.0);
}

TEST(SparseSampling, AHugeGridTakesNoMemoryOfItsOwn)
{
  /// A speck of 12 voxels' radius in 10^18 of them.
  class Speck : public brume::Field
  {
  public:
    brume::Box bounds() const override { return { glm::dvec3(0.0), glm::dvec3(1048576.0) }; }
    float value(const glm::dvec3& p, double) const override
    {
      return glm::length(p - middle) < 12.0 ? 1.0f : 0.0f;
    }
    brume::FieldRange range_in(const brume::Box& box, double) const override
    {
      const glm::dvec3 nearest = glm::clamp(middle, box.lower, box.upper);
      return { 0.0f, glm::length(nearest - middle) < 12.0 ? 1.0f : 0.0f };
    }
    glm::dvec3 middle{ 777777.0, 123456.0, 900001.0 };
  };
  const brume::SparseSample sample =
    brume::sample_sparse(Speck(), 0.0, { glm::ivec3(1 << 20), glm::dvec3(0.0), glm::dvec3(1.0) });
  ASSERT_TRUE(sample.voxels);
  EXPECT_NEAR(static_cast<double>(sample.active_voxels), 4.0 / 3.0 * 3.14159 * 1728.0, 200.0);
  EXPECT_EQ(sparse_value(sample, 777777, 123456, 900001), 1.0);
}

TEST(SparseSampling, TheBackgroundMayBeAnyNumber)
{
  const Steps steps;
  brume::Lattice grid;
  grid.dimensions = glm::ivec3(64);
  brume::SparseSampleOptions options;
  options.background = 1.0f;
  const brume::SparseSample sparse = brume::sample_sparse(steps, 0.0, grid, options);
  ASSERT_TRUE(sparse.voxels);
  EXPECT_EQ(sparse.voxels->background(), 1.0);
  EXPECT_EQ(sparse.active_voxels, 64 * 64 * 32); // from 32 up; 31 is 1 still
  EXPECT_EQ(sparse_value(sparse, 5, 5, 60), 0.0);
  EXPECT_EQ(sparse_value(sparse, 5, 5, 3), 1.0);
}

TEST(SparseSampling, HalvesAreTheSingleVoxelsRounded)
{
  const brume::Cumulus cloud;
  const brume::Lattice grid = brume::grid_over(cloud.bounds(), 64);
  brume::SparseSampleOptions options;
  const brume::SparseSample whole = brume::sample_sparse(cloud, 0.0, grid, options);
  options.type = brume::VoxelType::Float16;
  const brume::SparseSample half = brume::sample_sparse(cloud, 0.0, grid, options);
  ASSERT_EQ(whole.voxels->places(), half.voxels->places());
  for (std::size_t slot = 1; slot < whole.voxels->slot_count(); ++slot)
    for (int v = 0; v < brume::SparseVoxels::brick_voxels; ++v)
    {
      const float value = static_cast<float>(whole.voxels->value_in_slot(slot, v));
      ASSERT_EQ(
        half.voxels->value_in_slot(slot, v), brume::float_from_half(brume::half_from_float(value)));
    }
  EXPECT_LT(half.voxels->memory_bytes(), 0.6 * whole.voxels->memory_bytes());
}

TEST(SparseSampling, NothingIsNoVoxels)
{
  brume::Lattice grid;
  grid.dimensions = glm::ivec3(20);
  const brume::SparseSample sparse = brume::sample_sparse(Nothing(), 0.0, grid);
  EXPECT_FALSE(sparse.voxels);
  EXPECT_FALSE(sparse.stopped);
  EXPECT_EQ(sparse.active_voxels, 0);
}

TEST(SparseSampling, ReportsProgressAndStops)
{
  const brume::Cumulus cloud;
  const brume::Lattice grid = brume::grid_over(cloud.bounds(), 128);
  double last = 0.0;
  bool rose = true;
  brume::sample_sparse(cloud,
    0.0,
    grid,
    {},
    [&](double done)
    {
      rose = rose && done > last;
      last = done;
      return true;
    });
  EXPECT_TRUE(rose);
  EXPECT_EQ(last, 1.0);
  for (const double when : { 0.05, 0.5 }) // in either pass
  {
    for (const int threads : { 1, 2 })
    {
      last = 0.0;
      brume::SparseSampleOptions options;
      options.threads = threads;
      const brume::SparseSample stopped = brume::sample_sparse(cloud,
        0.0,
        grid,
        options,
        [&](double done)
        {
          last = done;
          return done < when;
        });
      EXPECT_TRUE(stopped.stopped);
      EXPECT_FALSE(stopped.voxels);
      EXPECT_GE(last, when);
      if (threads == 1)
      {
        EXPECT_LT(last, 0.9); // another thread may do all the rest while this one is off its processor
      }
    }
  }
}

TEST(SparseSampling, RefusesWhatIsNoSparseGrid)
{
  const Nothing nothing;
  brume::Lattice grid;
  grid.dimensions = glm::ivec3(8);
  brume::SparseSampleOptions options;
  options.type = brume::VoxelType::Int16;
  EXPECT_THROW(brume::sample_sparse(nothing, 0.0, grid, options), std::invalid_argument);
  options = {};
  options.background = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(brume::sample_sparse(nothing, 0.0, grid, options), std::invalid_argument);
  grid.dimensions.y = 0;
  EXPECT_THROW(brume::sample_sparse(nothing, 0.0, grid), std::invalid_argument);
}
