// Sparse voxels: values, tables of every shape, tiles, memory, ranges of bricks, what is refused.
#include "../support/sparse_grids.h"

#include "Transport/bricks.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <iostream>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <stdexcept>

using namespace sparse_grids;

namespace
{

double ball(int i, int j, int k, double radius)
{
  const double r = std::sqrt(double(i) * i + double(j) * j + double(k) * k);
  return r < radius ? 1.0 + i * 0.01 : 0.0;
}

/// Checks each voxel of some places against value() in the source's coordinates.
template <class Value>
void expect_values(const SparseVoxels& sparse,
  const BrickPlace& lower,
  const BrickPlace& upper,
  Value value,
  double tolerance = 0.0)
{
  for (std::int32_t k = lower[2]; k <= upper[2]; ++k)
    for (std::int32_t j = lower[1]; j <= upper[1]; ++j)
      for (std::int32_t i = lower[0]; i <= upper[0]; ++i)
      {
        const auto& o = sparse.origin();
        ASSERT_NEAR(sparse.value(i - o[0], j - o[1], k - o[2]), value(i, j, k), tolerance)
          << i << ' ' << j << ' ' << k;
      }
}

void fill_nothing(std::size_t, void* voxels)
{
  std::memset(voxels, 0, SparseVoxels::brick_voxels * sizeof(float));
}

}

TEST(Half, EveryHalfComesBack)
{
  for (std::uint32_t h = 0; h < 65536; ++h)
  {
    const auto half = static_cast<std::uint16_t>(h);
    const float value = float_from_half(half);
    if ((half & 0x7c00) == 0x7c00 && (half & 0x3ff))
    {
      EXPECT_TRUE(std::isnan(value));
      EXPECT_TRUE(std::isnan(float_from_half(half_from_float(value))));
      continue;
    }
    ASSERT_EQ(half_from_float(value), half) << value;
    const double exponent = half >> 10 & 31;
    const double expected = exponent == 31  ? std::numeric_limits<double>::infinity()
                            : exponent == 0 ? std::ldexp(half & 0x3ff, -24)
                                            : std::ldexp(1024 + (half & 0x3ff), int(exponent) - 25);
    ASSERT_EQ(value, half & 0x8000 ? -expected : expected);
  }
}

TEST(Half, RoundsToTheNearestAndToEven)
{
  EXPECT_EQ(half_from_float(1.0f + 0x1p-11f), 0x3c00); // half-way, even below
  EXPECT_EQ(half_from_float(1.0f + 3 * 0x1p-11f), 0x3c02);
  EXPECT_EQ(half_from_float(1.0f + 0x1.2p-11f), 0x3c01);
  EXPECT_EQ(half_from_float(0x1p-25f), 0x0000);
  EXPECT_EQ(half_from_float(3 * 0x1p-25f), 0x0002);
  EXPECT_EQ(half_from_float(65519.0f), 0x7bff);
  EXPECT_EQ(half_from_float(65520.0f), 0x7c00);
  EXPECT_EQ(half_from_float(-1e9f), 0xfc00);
}

TEST(SparseTable, MortonNumbersComeBack)
{
  std::mt19937 random(7);
  for (int i = 0; i < 1000; ++i)
  {
    const BrickPlace place{ { int(random() >> 11), int(random() >> 11), int(random() >> 11) } };
    EXPECT_EQ(from_morton(morton(place)), place);
  }
  EXPECT_EQ(morton({ { 1, 0, 0 } }), 1u);
  EXPECT_EQ(morton({ { 0, 1, 0 } }), 2u);
  EXPECT_EQ(morton({ { 0, 0, 1 } }), 4u);
}

// Random bricks in boxes of many widths: dense, scattered, and so wide that there is a directory.
TEST(SparseTable, FindsEachBrickAndNothingElse)
{
  std::mt19937 random(1);
  bool directory = false;
  std::set<int> shifts;
  for (const int width : { 1, 3, 20, 300, 5000, 1 << 17 })
  {
    for (const int count : { 1, 40, width > 5000 ? 200 : 3000 })
    {
      std::map<std::uint64_t, BrickPlace> places;
      std::uniform_int_distribution<int> anywhere(0, width - 1);
      for (int i = 0; i < count; ++i)
      {
        BrickPlace p{ { anywhere(random), anywhere(random), anywhere(random) } };
        // Clusters of eight: what a cloud is like.
        for (int n = 0; n < 8; ++n)
        {
          const BrickPlace q{ { std::min(p[0] + (n & 1), width - 1),
            std::min(p[1] + (n >> 1 & 1), width - 1),
            std::min(p[2] + (n >> 2), width - 1) } };
          places[morton(q)] = q;
        }
      }
      std::vector<BrickPlace> list;
      for (const auto& [number, place] : places)
      {
        list.push_back(place);
      }
      const SparseTable table({ { width, width, width } }, list, 5, {}, list.size() * 2048);
      for (std::size_t i = 0; i < list.size(); ++i)
      {
        ASSERT_EQ(table.slot(list[i][0], list[i][1], list[i][2]), int(5 + i));
      }
      for (int i = 0; i < 1000; ++i)
      {
        const BrickPlace p{ { anywhere(random), anywhere(random), anywhere(random) } };
        if (!places.count(morton(p)))
        {
          ASSERT_EQ(table.slot(p[0], p[1], p[2]), 0);
        }
      }
      shifts.insert(table.page_shift);
      directory = directory || !table.directory.empty();
    }
  }
  EXPECT_TRUE(directory);
  EXPECT_GE(shifts.size(), 3u);
}

TEST(SparseVoxels, HoldsEachTypesValues)
{
  for (VoxelType type : { VoxelType::UInt8,
         VoxelType::Int8,
         VoxelType::UInt16,
         VoxelType::Int16,
         VoxelType::Float16,
         VoxelType::Float32 })
  {
    const auto value = [](int i, int j, int k)
    {
      return std::abs(i) < 12 && std::abs(j) < 9 && std::abs(k) < 5 ? (i + 2 * j + 3 * k + 60) % 120
                                                                    : 7.0;
    };
    const auto sparse = make_sparse(type, { { -20, -20, -20 } }, { { 20, 20, 20 } }, 7.0, value);
    expect_values(*sparse, { { -24, -24, -24 } }, { { 24, 24, 24 } }, value);
    EXPECT_EQ(sparse->background(), 7.0);
    EXPECT_EQ(sparse->value(-1, 0, 0), 7.0);
    EXPECT_EQ(sparse->value(1 << 20, 0, 0), 7.0);
  }
}

TEST(SparseVoxels, BeginsAndEndsWithOneVoxelOfBackground)
{
  SparseTopology topology;
  topology.bricks = { { { -3, 0, 10 } }, { { -1, 2, 10 } } };
  const SparseVoxels sparse(VoxelType::Float32, 0.0, topology, fill_nothing);
  EXPECT_EQ(sparse.origin(), (BrickPlace{ { -32, -8, 72 } }));
  EXPECT_EQ(sparse.first(), (BrickPlace{ { 7, 7, 7 } }));
  EXPECT_EQ(sparse.dims(), (BrickPlace{ { 33, 33, 17 } })); // voxel 32 is one after the last brick
  const Grid grid = sparse.grid();
  EXPECT_NO_THROW(grid.validate());
  EXPECT_EQ(grid.lower(0), 7.0);
  EXPECT_EQ(grid.upper(2), 16.0);
  EXPECT_EQ(grid.voxel_count(), 3u * 512u);
}

TEST(SparseVoxels, TilesAreTheirValueAndShareABrick)
{
  SparseTopology topology;
  topology.bricks = { { { 0, 0, 0 } }, { { 17, 0, 0 } } };
  topology.tiles = { { { { 1, 0, 0 } }, { { 16, 15, 15 } }, 0.25 },
    { { { 0, 1, 0 } }, { { 0, 1, 0 } }, 0.5 },
    { { { 20, -4, 3 } }, { { 27, 3, 10 } }, 0.25 },
    { { { -700, -600, -512 } }, { { -189, -89, -1 } }, 3.0 } }; // a whole 4096³ voxels
  const auto value = [&](int i, int j, int k)
  {
    const int b[3] = { i >> 3, j >> 3, k >> 3 };
    for (const SparseTile& t : topology.tiles)
    {
      bool in = true;
      for (int a = 0; a < 3; ++a)
      {
        in = in && b[a] >= t.first[a] && b[a] <= t.last[a];
      }
      if (in)
      {
        return t.value;
      }
    }
    const bool brick = (b[0] == 0 || b[0] == 17) && b[1] == 0 && b[2] == 0;
    return brick ? i + 0.125 * j + 0.01 * k : -1.0;
  };
  const SparseVoxels sparse(
    VoxelType::Float32, -1.0, topology, filler(topology, VoxelType::Float32, value));
  EXPECT_EQ(sparse.tile_slots(), 3u);
  EXPECT_EQ(sparse.slot_count(), 6u);
  EXPECT_LT(sparse.table().memory_bytes(), 40u << 20); // for 7·10¹⁰ voxels
  std::mt19937 random(3);
  for (int n = 0; n < 200000; ++n)
  {
    const auto within = [&](int lower, int upper)
    { return lower + int(random() % unsigned(upper - lower)); };
    const bool near = n % 2;
    const int i = near ? within(-20, 240) : within(-5800, 300);
    const int j = near ? within(-40, 140) : within(-5000, 200);
    const int k = near ? within(-20, 140) : within(-4300, 200);
    ASSERT_NEAR(
      sparse.value(i - sparse.origin()[0], j - sparse.origin()[1], k - sparse.origin()[2]),
      value(i, j, k),
      1e-5)
      << i << ' ' << j << ' ' << k;
  }
}

TEST(SparseVoxels, RefusesWhatItCannotHold)
{
  const auto make = [](const SparseTopology& topology)
  { SparseVoxels(VoxelType::Float32, 0.0, topology, fill_nothing); };
  SparseTopology topology;
  EXPECT_THROW(make(topology), std::invalid_argument);
  topology.bricks = { { { 1, 2, 3 } }, { { 1, 2, 3 } } };
  EXPECT_THROW(make(topology), std::invalid_argument);
  topology.bricks = { { { 1, 2, 3 } } };
  topology.tiles = { { { { 0, 0, 0 } }, { { 5, 5, 5 } }, 1.0 } };
  EXPECT_THROW(make(topology), std::invalid_argument);
  topology.tiles = { { { { 2, 2, 2 } }, { { 5, 5, 5 } }, 1.0 },
    { { { 5, 5, 5 } }, { { 6, 6, 6 } }, 1.0 } };
  EXPECT_THROW(make(topology), std::invalid_argument);
  topology.tiles = { { { { 2, 2, 2 } }, { { 1, 2, 2 } }, 1.0 } };
  EXPECT_THROW(make(topology), std::invalid_argument);
  topology.tiles.clear();
  topology.bricks = { { { 0, 0, 0 } }, { { 1 << 17, 0, 0 } } };
  EXPECT_THROW(make(topology), std::invalid_argument);
  topology.bricks = { { { 0, 0, 0 } } };
  EXPECT_THROW(SparseVoxels(VoxelType::Float32,
                 0.0,
                 topology,
                 [](std::size_t, void*) { throw std::runtime_error("cut short"); }),
    std::runtime_error);
}

namespace
{

/// Smooth noise in [-1, 1]: random numbers at whole places, interpolated.
double noise(double x, double y, double z)
{
  const auto at = [](int i, int j, int k)
  {
    std::uint32_t h =
      unsigned(i) * 0x9e3779b1u ^ unsigned(j) * 0x85ebca77u ^ unsigned(k) * 0xc2b2ae3du;
    h = (h ^ h >> 15) * 0x2c1b3c6du;
    h = (h ^ h >> 12) * 0x297a2d39u;
    return (h >> 8) / double(1 << 23) - 1.0;
  };
  const int i = int(std::floor(x)), j = int(std::floor(y)), k = int(std::floor(z));
  const double f[3] = { x - i, y - j, z - k };
  double sum = 0.0;
  for (int c = 0; c < 8; ++c)
  {
    double weight = 1.0;
    for (int a = 0; a < 3; ++a)
    {
      const double s = f[a] * f[a] * (3.0 - 2.0 * f[a]);
      weight *= c >> a & 1 ? s : 1.0 - s;
    }
    sum += weight * at(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2));
  }
  return sum;
}

/// A ball of 300 voxels that four octaves of noise have eaten into.
double cloud(int i, int j, int k)
{
  const double r = std::sqrt(double(i) * i + double(j) * j + double(k) * k) / 150.0;
  if (r > 1.0)
  {
    return 0.0;
  }
  double n = 0.0;
  double amplitude = 0.5;
  for (int octave = 0; octave < 4; ++octave, amplitude *= 0.5)
  {
    const double f = std::ldexp(1.0 / 64.0, octave);
    n += amplitude * noise(i * f + 99.5, j * f, k * f);
  }
  return std::max(0.0, 0.55 - r * r + 0.8 * n);
}

/// Bytes that the grid takes for each voxel that is not 0, with a brick more at `far` (unless 0).
double bytes_a_voxel(const SparseTopology& compact,
  std::size_t active,
  const BrickPlace& far,
  const char* name)
{
  SparseTopology topology = compact;
  if (far[0] != 0)
  {
    topology.bricks.push_back(far);
  }
  const SparseVoxels sparse(VoxelType::Float32, 0.0, topology, fill_nothing);
  const double each = double(sparse.memory_bytes()) / double(active);
  std::cout << name << " in a box of " << sparse.dims()[0] << " x " << sparse.dims()[1] << " x "
            << sparse.dims()[2] << ": " << each << " bytes a voxel, of which "
            << double(sparse.table().memory_bytes()) / double(active) << " for the table\n";
  return each;
}

template <class Value>
std::size_t count_active(const SparseTopology& topology, Value value)
{
  std::size_t active = 0;
  for (const BrickPlace& b : topology.bricks)
  {
    for (int i = 0; i < 512; ++i)
    {
      active += value(8 * b[0] + (i & 7), 8 * b[1] + (i >> 3 & 7), 8 * b[2] + (i >> 6)) != 0.0;
    }
  }
  return active;
}

const BrickPlace everywhere[] = { { { 0, 0, 0 } },
  { { 12500, 0, 0 } },
  { { 12500, 12500, 12500 } },
  { { -100000, 50000, 100000 } } };

}

// At most 5 bytes for a voxel that is not the background, however wide the box around a compact
// ball: alone, and with a brick 100 000 voxels away along one axis, along all three, and farther.
// As a damaged file may have it: tiles without number, none of them where pages begin.
TEST(SparseVoxels, TakesNoMoreThanItMay)
{
  SparseTopology topology;
  for (int i = 0; i < 16; ++i)
    for (int j = 0; j < 16; ++j)
      for (int k = 0; k < 16; ++k)
      {
        topology.tiles.push_back({ { { 16 * i, 16 * j, 16 * k } },
          { { 16 * i + 15, 16 * j + 15, 16 * k + 15 } }, double(i + j + k) });
      }
  const auto fill = [](std::size_t, void*) {};
  const SparseVoxels sparse(VoxelType::Float32, -1.0, topology, fill);
  EXPECT_EQ(sparse.value(8 + 128 * 3 + 127, 8 + 128 * 5, 8 + 128 * 7 + 4), 15.0);
  EXPECT_EQ(sparse.value(7, 8, 8), -1.0);
  const std::size_t all = sparse.memory_bytes();
  EXPECT_LE(all, std::size_t(1) << 31);
  EXPECT_NO_THROW(SparseVoxels(VoxelType::Float32, -1.0, topology, fill, 0, all));
  EXPECT_THROW(SparseVoxels(VoxelType::Float32, -1.0, topology, fill, 0, all / 2), std::length_error);
  // A few tiles of billions of voxels have few ranges.
  SparseTopology wide;
  wide.tiles.push_back({ { { 0, 0, 0 } }, { { 1023, 1023, 1023 } }, 1.0 });
  const SparseVoxels far(VoxelType::Float32, 0.0, wide, fill);
  EXPECT_LE(measure_bricks(far.grid()).size(), std::size_t(1) << 15);
}

TEST(SparseVoxels, MemoryOfABallDoesNotGrowWithTheBox)
{
  const auto value = [](int i, int j, int k) { return ball(i, j, k, 150.0); };
  const SparseTopology compact =
    topology_of({ { -150, -150, -150 } }, { { 150, 150, 150 } }, 0.0, value);
  const std::size_t active = count_active(compact, value);
  for (const BrickPlace& far : everywhere)
  {
    EXPECT_LE(bytes_a_voxel(compact, active, far, "ball"), far[0] < 0 ? 5.4 : 5.0);
  }
}

// A cloud's surface is rough: bricks at it are filled in part. The table adds next to nothing.
TEST(SparseVoxels, MemoryOfACloudDoesNotGrowWithTheBox)
{
  const SparseTopology compact =
    topology_of({ { -150, -150, -150 } }, { { 150, 150, 150 } }, 0.0, cloud);
  const std::size_t active = count_active(compact, cloud);
  const double alone = bytes_a_voxel(compact, active, everywhere[0], "cloud");
  EXPECT_LE(alone, 6.0);
  EXPECT_LE(bytes_a_voxel(compact, active, everywhere[1], "cloud"), alone + 0.1);
  EXPECT_LE(bytes_a_voxel(compact, active, everywhere[2], "cloud"), alone + 0.3);
}

// The ranges of the same voxels, dense, are the judge.
TEST(SparseBricks, RangesAreThoseOfTheSameVoxelsDense)
{
  std::mt19937 random(11);
  for (VoxelType type : { VoxelType::Float32, VoxelType::Float16, VoxelType::Int8 })
  {
    const auto value = [](int i, int j, int k)
    { return std::floor(20.0 * ball(i - 3, j + 2, k, 17.0)); };
    SparseTopology topology = topology_of({ { -20, -20, -20 } }, { { 24, 24, 24 } }, 0.0, value);
    topology.tiles = { { { { 4, 1, -2 } }, { { 6, 3, 1 } }, 30.0 } };
    const SparseVoxels sparse(type, 0.0, topology, filler(topology, type, value));
    const std::vector<float> values = dense_copy(sparse);
    const BrickRanges ranges = measure_bricks(sparse.grid());
    const BrickRanges dense = measure_bricks(dense_grid(sparse, values));
    EXPECT_EQ(ranges.shift, 3);
    ASSERT_EQ(ranges.size(), dense.size());
    EXPECT_EQ(ranges.lower, dense.lower);
    EXPECT_EQ(ranges.upper, dense.upper);
    EXPECT_EQ(ranges.minimum, dense.minimum);
    EXPECT_EQ(ranges.maximum, dense.maximum);
    EXPECT_TRUE(ranges.reaches_non_finite.empty());
  }
}

TEST(SparseBricks, NonFiniteVoxelsAreCountedAndInNoRange)
{
  const auto value = [](int i, int j, int k)
  {
    return i == 8 && j == 8 && k == 15   ? std::numeric_limits<double>::quiet_NaN()
           : i == 31 && j == 0 && k == 0 ? -std::numeric_limits<double>::infinity()
                                         : 1.0 + i;
  };
  const auto sparse =
    make_sparse(VoxelType::Float32, { { 0, 0, 0 } }, { { 31, 31, 31 } }, 0.0, value);
  const std::vector<float> values = dense_copy(*sparse);
  const BrickRanges ranges = measure_bricks(sparse->grid());
  const BrickRanges dense = measure_bricks(dense_grid(*sparse, values));
  EXPECT_EQ(ranges.non_finite_voxels, 2u);
  EXPECT_EQ(ranges.reaches_non_finite, dense.reaches_non_finite);
  EXPECT_EQ(ranges.minimum, dense.minimum);
  EXPECT_EQ(ranges.maximum, dense.maximum);
}

// In a wide box bricks are merged: the ranges hold those of the dense grid, and are few.
TEST(SparseBricks, RangesStayFewInAWideBox)
{
  const auto value = [](int i, int j, int k) { return ball(i, j, k, 40.0); };
  SparseTopology topology = topology_of({ { -40, -40, -40 } }, { { 40, 40, 40 } }, 0.0, value);
  topology.bricks.push_back({ { 600, 700, 800 } });
  topology.tiles.push_back({ { { 300, 300, 300 } }, { { 315, 331, 315 } }, 5.0 });
  const SparseVoxels sparse(
    VoxelType::Float32, 0.0, topology, filler(topology, VoxelType::Float32, value));
  const BrickRanges ranges = measure_bricks(sparse.grid());
  EXPECT_LE(ranges.size(), 1u << 15);
  EXPECT_GT(ranges.shift, 3);
  std::mt19937 random(5);
  for (int n = 0; n < 300000; ++n)
  {
    const auto near = [&](int middle, int around)
    { return middle + int(random() % unsigned(2 * around)) - around; };
    const bool at_ball = n % 2;
    const int v[3] = { at_ball ? near(0, 47) : near(2460, 200),
      at_ball ? near(0, 47) : near(2520, 200),
      at_ball ? near(0, 47) : near(2460, 200) };
    int low[3], high[3]; // cubes that reach the voxel
    for (int a = 0; a < 3; ++a)
    {
      const int i = v[a] - sparse.origin()[a];
      high[a] = i >> ranges.shift;
      low[a] = (i - 1) >> ranges.shift;
    }
    const double expected =
      sparse.value(v[0] - sparse.origin()[0], v[1] - sparse.origin()[1], v[2] - sparse.origin()[2]);
    for (int corner = 0; corner < 8; ++corner)
    {
      const int* c[2] = { low, high };
      const std::size_t at =
        (std::size_t(c[corner >> 2][2]) * ranges.dims[1] + c[corner >> 1 & 1][1]) * ranges.dims[0] +
        c[corner & 1][0];
      ASSERT_LE(ranges.minimum[at], expected);
      ASSERT_GE(ranges.maximum[at], expected);
    }
  }
  // Within the tile there is nothing but its value.
  const int middle[3] = { 307, 315, 307 };
  std::size_t at = 0;
  for (int a = 2; a >= 0; --a)
  {
    at = at * ranges.dims[a] + ((8 * middle[a] - sparse.origin()[a]) >> ranges.shift);
  }
  EXPECT_EQ(ranges.maximum[at], 5.0f);
  const VisibleBricks visible = find_visible_bricks(
    ranges, [](float, float upper) { return upper > 0.0f; }, 0.0f);
  EXPECT_EQ(visible.shift, ranges.shift);
  EXPECT_LT(visible.visible, ranges.size() / 20);
}
