#include "../support/transport_scenes.h"

#include "Transport/bricks.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

using namespace transport_scenes;

namespace
{

template <class T>
class BrickRange : public testing::Test
{
};
using Types = testing::Types<std::uint8_t, std::int8_t, std::uint16_t, std::int16_t, float>;
TYPED_TEST_SUITE(BrickRange, Types);

template <class T>
void expect_brute_force(const Grid& grid)
{
  const BrickRanges ranges = measure_bricks(grid);
  const T* values = static_cast<const T*>(grid.voxels);
  float lower = std::numeric_limits<float>::infinity();
  float upper = -lower;
  std::size_t bad = 0;
  const int* n = grid.dims;
  for (int bz = 0; bz < ranges.dims[2]; ++bz)
    for (int by = 0; by < ranges.dims[1]; ++by)
      for (int bx = 0; bx < ranges.dims[0]; ++bx)
      {
        float a = std::numeric_limits<float>::infinity();
        float b = -a;
        for (int z = 8 * bz; z <= std::min(8 * bz + 8, n[2] - 1); ++z)
          for (int y = 8 * by; y <= std::min(8 * by + 8, n[1] - 1); ++y)
            for (int x = 8 * bx; x <= std::min(8 * bx + 8, n[0] - 1); ++x)
            {
              const float v = static_cast<float>(
                values[((std::size_t(z) * n[1] + y) * n[0] + x) * grid.components +
                       grid.components - 1]);
              if (std::isfinite(v))
              {
                a = std::min(a, v);
                b = std::max(b, v);
              }
            }
        const std::size_t i = (std::size_t(bz) * ranges.dims[1] + by) * ranges.dims[0] + bx;
        ASSERT_EQ(ranges.minimum[i], a);
        ASSERT_EQ(ranges.maximum[i], b);
        lower = std::min(lower, a);
        upper = std::max(upper, b);
      }
  for (std::size_t i = 0; i < grid.voxel_count(); ++i)
  {
    bad += !std::isfinite(static_cast<double>(values[i * grid.components]));
  }
  EXPECT_EQ(ranges.non_finite_voxels, bad);
  if (lower <= upper)
  {
    EXPECT_EQ(ranges.lower, lower);
    EXPECT_EQ(ranges.upper, upper);
  }
  else
  {
    EXPECT_GT(ranges.lower, ranges.upper);
  }
}

TYPED_TEST(BrickRange, IsThatOfAllVoxelsWithinReach)
{
  std::mt19937 random(7);
  // Rows shorter and longer than the widest register, and no multiple of it.
  for (const auto& n : { glm::ivec3(9, 8, 7),
         glm::ivec3(17, 1, 16),
         glm::ivec3(5, 25, 1),
         glm::ivec3(32, 9, 10),
         glm::ivec3(4, 1, 1),
         glm::ivec3(64, 3, 2),
         glm::ivec3(201, 10, 11) })
  {
    SCOPED_TRACE(n.x);
    const Voxels<TypeParam> voxels(n.x,
      n.y,
      n.z,
      [&](int, int, int)
      {
        if constexpr (std::is_floating_point_v<TypeParam>)
        {
          return float(int(random() % 20001) - 10000) / 7.0f;
        }
        else
        {
          return TypeParam(random());
        }
      });
    for (const std::string& target : targets())
    {
      SCOPED_TRACE(target);
      ASSERT_TRUE(force_simd_target(target));
      expect_brute_force<TypeParam>(voxels.grid());
    }
    force_simd_target("");
  }
}

TEST(BrickRange, OfFourComponentsIsTheLasts)
{
  std::mt19937 random(9);
  const Voxels<std::uint8_t> voxels(
    11, 9, 10, [&](int, int, int, int c) { return c == 3 ? 50 + random() % 60 : random() % 256; });
  expect_brute_force<std::uint8_t>(voxels.grid());
}

TEST(BrickRange, LeavesNonFiniteVoxelsOut)
{
  Voxels<float> voxels(19, 18, 17, [](int i, int j, int k) { return i + 100 * j - 10 * k; });
  std::mt19937 random(3);
  const float bad[] = { std::numeric_limits<float>::quiet_NaN(),
    std::numeric_limits<float>::infinity(),
    -std::numeric_limits<float>::infinity() };
  for (int i = 0; i < 400; ++i)
  {
    voxels.values[random() % voxels.values.size()] = bad[i % 3];
  }
  expect_brute_force<float>(voxels.grid());
  std::fill(voxels.values.begin(), voxels.values.end(), bad[0]);
  expect_brute_force<float>(voxels.grid());
  voxels.values[5] = std::numeric_limits<float>::max();
  voxels.values[6] = std::numeric_limits<float>::lowest();
  expect_brute_force<float>(voxels.grid());
}

TEST(BrickRange, KnowsTheBricksThatReachANonFiniteVoxel)
{
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::mt19937 random(5);
  for (const int one_in : { 3000, 50, 1 })
  {
    const Voxels<float> voxels(
      75, 18, 17, [&](int i, int, int) { return random() % one_in == 0 ? nan : float(i); });
    const Grid grid = voxels.grid();
    const BrickRanges ranges = measure_bricks(grid);
    ASSERT_EQ(ranges.reaches_non_finite.size(), ranges.size());
    std::size_t at = 0;
    for (int bz = 0; bz < ranges.dims[2]; ++bz)
      for (int by = 0; by < ranges.dims[1]; ++by)
        for (int bx = 0; bx < ranges.dims[0]; ++bx, ++at)
        {
          bool reaches = false;
          for (int z = 8 * bz; z <= std::min(8 * bz + 8, 16); ++z)
            for (int y = 8 * by; y <= std::min(8 * by + 8, 17); ++y)
              for (int x = 8 * bx; x <= std::min(8 * bx + 8, 74); ++x)
                reaches = reaches || std::isnan(voxels.values[(std::size_t(z) * 18 + y) * 75 + x]);
          ASSERT_EQ(ranges.reaches_non_finite[at], reaches) << bx << ' ' << by << ' ' << bz;
        }
  }
}

TEST(BrickRange, CountsAPaddedVoxelOnce)
{
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const Voxels<float> voxels(2, 3, 3, [&](int, int j, int) { return j == 1 ? nan : 1.0f; });
  Grid grid = voxels.grid();
  grid.padding_x = 1;
  EXPECT_EQ(measure_bricks(grid).non_finite_voxels, 3u);
}

TEST(VisibleBricks, WhatReachesANonFiniteVoxelCountsTheEmptyValue)
{
  // Interpolation runs from 10 to the empty value, 0, and so through 5, which can be seen.
  BrickRanges ranges;
  ranges.dims[0] = 2;
  ranges.dims[1] = ranges.dims[2] = 1;
  ranges.minimum = { 10.0f, 10.0f };
  ranges.maximum = { 10.0f, 10.0f };
  ranges.reaches_non_finite = { 1, 0 };
  const VisibleBricks bricks = find_visible_bricks(
    ranges, [](float lower, float upper) { return lower <= 5.0f && upper >= 5.0f; }, 0.0f);
  EXPECT_EQ(bricks.distance[0], 0);
  EXPECT_EQ(bricks.distance[1], 1);
}

TEST(VisibleBricks, DistanceIsThatToTheNearestVisibleOne)
{
  std::mt19937 random(11);
  for (int round = 0; round < 60; ++round)
  {
    BrickRanges ranges;
    for (int axis = 0; axis < 3; ++axis)
    {
      ranges.dims[axis] = 1 + random() % (round % 10 == 9 ? 22 : 9);
    }
    ranges.minimum.assign(ranges.size(), 0.0f);
    ranges.maximum.assign(ranges.size(), 0.0f);
    const int one_in = round % 10 == 9 ? 3000 : 1 + (round % 3) * 30;
    for (float& v : ranges.maximum)
    {
      v = random() % one_in == 0 && round != 4 ? 1.0f : 0.0f;
    }
    // A brick without a finite voxel cannot be seen, whatever can_show would say.
    ranges.minimum[0] = std::numeric_limits<float>::infinity();
    ranges.maximum[0] = -std::numeric_limits<float>::infinity();
    const VisibleBricks visible = find_visible_bricks(
      ranges, [](float lower, float upper) { return lower > upper || upper > 0.5f; }, 0.0f);
    const int* n = ranges.dims;
    std::size_t seen = 0;
    const auto at = [&](int x, int y, int z) { return (z * n[1] + y) * n[0] + x; };
    for (int z = 0; z < n[2]; ++z)
      for (int y = 0; y < n[1]; ++y)
        for (int x = 0; x < n[0]; ++x)
        {
          int nearest = 1 << 20;
          for (int c = 0; c < n[2]; ++c)
            for (int b = 0; b < n[1]; ++b)
              for (int a = 0; a < n[0]; ++a)
                if (ranges.maximum[at(a, b, c)] > 0.5f)
                  nearest = std::min(
                    nearest, std::max({ std::abs(a - x), std::abs(b - y), std::abs(c - z) }));
          seen += nearest == 0;
          const int got = visible.distance[at(x, y, z)];
          if (nearest == 1 << 20)
          {
            ASSERT_GE(got, std::max({ n[0], n[1], n[2] }));
          }
          else
          {
            ASSERT_EQ(got, nearest) << round;
          }
        }
    EXPECT_EQ(visible.visible, seen);
  }
}

}
