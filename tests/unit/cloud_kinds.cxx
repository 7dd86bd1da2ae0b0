// Clouds by kind and fog banks: where they are and where they are not, the same bits on every SIMD
// target and in every piece, bounds that hold.
#include "data-generators/clouds.h"
#include "data-generators/fog_bank.h"
#include "data-generators/sampling.h"
#include "every_target.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <vector>

namespace
{

using brume::CloudKind;
using brume::FogKind;
using glm::dvec3;

const std::vector<CloudKind>& all_kinds()
{
  static const std::vector<CloudKind> kinds{ CloudKind::Cumulus,
    CloudKind::CumulusField,
    CloudKind::Stratus,
    CloudKind::Stratocumulus,
    CloudKind::Cirrus,
    CloudKind::Cumulonimbus };
  return kinds;
}

std::unique_ptr<brume::Field> usual(CloudKind kind)
{
  return brume::make_cloud(brume::cloud_defaults(kind));
}

brume::FogBank fog(FogKind kind)
{
  brume::FogOptions options;
  options.kind = kind;
  return brume::FogBank(options);
}

struct Sampled
{
  brume::Lattice grid;
  std::vector<float> values;

  Sampled(const brume::Field& field, int size, double time = 0.0)
    : grid(brume::grid_over(field.bounds(), size))
    , values(brume::whole_extent(grid).voxels())
  {
    brume::sample(field, time, grid, brume::whole_extent(grid), values.data());
  }
  float at(int i, int j, int k) const
  {
    return values[(std::size_t(k) * grid.dimensions.y + j) * grid.dimensions.x + i];
  }
};

/// Of the columns away from the box's sides, how many meet cloud.
double cover_of(const brume::CloudOptions& options)
{
  const std::unique_ptr<brume::Field> field = brume::make_cloud(options);
  const brume::Box box = field->bounds();
  const double width = options.width - 2.0 * brume::cloud_side_fade(options);
  constexpr int side = 96, heights = 30;
  std::vector<float> values(side * side * heights);
  const double step = width / side;
  brume::sample(*field,
    0.0,
    { { side, side, heights },
      { 0.5 * (step - width), 0.5 * (step - width), box.lower.z },
      { step, step, (box.upper.z - box.lower.z) / heights } },
    { { 0, 0, 0 }, { side - 1, side - 1, heights - 1 } },
    values.data());
  int covered = 0;
  for (int column = 0; column < side * side; ++column)
  {
    bool any = false;
    for (int k = 0; k < heights; ++k)
    {
      any = any || values[k * side * side + column] > brume::CloudOptions::thinnest;
    }
    covered += any;
  }
  return double(covered) / (side * side);
}

/// The lowest and the highest place with a density over 0.05.
std::pair<double, double> reach(const Sampled& s)
{
  int lowest = s.grid.dimensions.z, highest = -1;
  for (int k = 0; k < s.grid.dimensions.z; ++k)
    for (int j = 0; j < s.grid.dimensions.y; ++j)
      for (int i = 0; i < s.grid.dimensions.x; ++i)
        if (s.at(i, j, k) > 0.05f)
        {
          lowest = std::min(lowest, k);
          highest = k;
        }
  return { s.grid.place(0, 0, lowest).z, s.grid.place(0, 0, highest).z };
}

/// No value lies outside the bounds of the box that it is in; returns how many boxes are empty.
int expect_bounds_hold(const brume::Field& field, double time, int parts)
{
  int empty = 0;
  const brume::Box all = field.bounds();
  // Beyond the field's own box, too.
  const dvec3 size = 1.5 * (all.upper - all.lower) / double(parts);
  const dvec3 begin = all.lower - 0.25 * (all.upper - all.lower);
  for (int n = 0; n < parts * parts * parts; ++n)
  {
    const dvec3 first = begin + dvec3(n % parts, n / parts % parts, n / parts / parts) * size;
    const brume::FieldRange range = field.range_in({ first, first + size }, time);
    empty += range.upper == 0.0f;
    std::vector<float> inside(5 * 5 * 5);
    field.values({ first, size / 4.0, { 0, 0, 0 }, { 5, 5, 5 } }, time, inside.data());
    for (const float v : inside)
    {
      EXPECT_LE(v, range.upper);
      EXPECT_GE(v, range.lower);
    }
  }
  return empty;
}

}

TEST(CloudKinds, EveryTargetGivesTheBitsOfOneLane)
{
  for (const CloudKind kind : all_kinds())
  {
    const std::unique_ptr<brume::Field> cloud = usual(kind);
    const brume::Lattice grid = brume::grid_over(cloud->bounds(), 36);
    brume_tests::expect_bits_of_one_lane(
      *cloud, { grid.origin, grid.spacing, { 0, 0, 0 }, grid.dimensions }, 33.0);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double z = 0.5 * (grid.origin.z + cloud->bounds().upper.z);
    brume_tests::expect_bits_of_one_lane(
      *cloud, { dvec3(0, nan, z), dvec3(20.0), { -30, 0, 0 }, { 61, 1, 1 } }, 0.0);
    brume_tests::expect_bits_of_one_lane(
      *cloud, { dvec3(0, 0, z), dvec3(1e30, 1.0, 1.0), { -3, 0, 0 }, { 7, 3, 1 } }, 0.0);
  }
}

TEST(CloudKinds, AreTheSameBytesWithAnyNumberOfThreads)
{
  std::vector<std::unique_ptr<brume::Field>> fields;
  for (const CloudKind kind : all_kinds())
  {
    fields.push_back(usual(kind));
  }
  for (const FogKind kind : { FogKind::Height, FogKind::Valley })
  {
    brume::FogOptions options;
    options.kind = kind;
    fields.push_back(std::make_unique<brume::FogBank>(options));
  }
  for (const std::unique_ptr<brume::Field>& field : fields)
  {
    std::vector<float> one;
    for (const int threads : { 1, 2, 5, 16 })
    {
      tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      const std::vector<float> values = Sampled(*field, 48).values;
      if (threads == 1)
      {
        one = values;
      }
      EXPECT_EQ(one, values) << threads << " threads";
    }
  }
}

TEST(CloudKinds, HoldTheirBoundsAndLeaveTheirFacesEmpty)
{
  for (const CloudKind kind : all_kinds())
  {
    const std::unique_ptr<brume::Field> cloud = usual(kind);
    EXPECT_GT(expect_bounds_hold(*cloud, 20.0, 10), 100) << static_cast<int>(kind);
    for (const double time : { 0.0, 1000.0 })
    {
      const Sampled s(*cloud, 64, time);
      float highest = 0.0f;
      const glm::ivec3 d = s.grid.dimensions;
      for (int k = 0; k < d.z; ++k)
        for (int j = 0; j < d.y; ++j)
          for (int i = 0; i < d.x; ++i)
          {
            const float v = s.at(i, j, k);
            ASSERT_GE(v, 0.0f);
            ASSERT_LE(v, 1.0f);
            highest = std::max(highest, v);
            const bool side = i == 0 || j == 0 || i == d.x - 1 || j == d.y - 1;
            if (side || cloud->bounds().upper.z - s.grid.place(i, j, k).z < 1e-9)
            {
              ASSERT_EQ(v, 0.0f) << static_cast<int>(kind);
            }
          }
      EXPECT_GT(highest, 0.4f) << static_cast<int>(kind) << " at " << time;
    }
  }
}

TEST(CloudKinds, StrangePlacesAndBoxesAreNoTrouble)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  std::vector<std::unique_ptr<brume::Field>> fields;
  for (const CloudKind kind : all_kinds())
  {
    fields.push_back(usual(kind));
  }
  brume::FogOptions valley;
  valley.kind = FogKind::Valley;
  fields.push_back(std::make_unique<brume::FogBank>(valley));
  for (const std::unique_ptr<brume::Field>& field : fields)
  {
    for (const double odd : { nan, inf, -inf, 1e300, -1e18 })
    {
      for (const dvec3& p : { dvec3(odd, 0, 500), dvec3(0, odd, 500), dvec3(0, 0, odd) })
      {
        EXPECT_EQ(field->value(p, 0.0), 0.0f);
        EXPECT_GE(field->range_in({ p, p }, 0.0).upper, 0.0f);
      }
      EXPECT_LE(field->value({ 10, 20, 1000 }, odd), 1.0f);
    }
  }
  EXPECT_TRUE(std::isfinite(brume::valley_terrain(1, 100.0, 5.0).at(nan, inf)));
}

TEST(CloudKinds, LieBetweenTheirBaseAndTheirTop)
{
  for (const CloudKind kind : all_kinds())
  {
    brume::CloudOptions options = brume::cloud_defaults(kind);
    options.base = options.width * 0.15;
    options.top = options.width * 0.4;
    const auto [low, high] = reach(Sampled(*brume::make_cloud(options), 96));
    const double height = options.top - options.base;
    EXPECT_NEAR(low, options.base, 0.25 * height) << static_cast<int>(kind);
    EXPECT_NEAR(high, options.top, 0.3 * height) << static_cast<int>(kind);
  }
}

TEST(CloudKinds, CoverAsMuchOfTheGroundAsTheyAreToldToHoweverWide)
{
  // The size of a kind's largest clouds, in heights of the layer.
  const std::vector<std::pair<CloudKind, double>> sizes{ { CloudKind::CumulusField, 1.5 },
    { CloudKind::Stratus, 5.0 },
    { CloudKind::Stratocumulus, 1.6 },
    { CloudKind::Cirrus, 1.4 } };
  for (const auto& [kind, size] : sizes)
  {
    for (const double wide : { 1.0, 3.0, 9.0, 40.0 })
    {
      for (const double coverage : { 0.15, 0.5, 0.85 })
      {
        if (kind == CloudKind::CumulusField && wide > 9.0 && coverage > 0.2)
        {
          continue; // the same by more of the same, but seconds
        }
        brume::CloudOptions options = brume::cloud_defaults(kind);
        options.seed = 7;
        options.coverage = coverage;
        options.width = wide * size * (options.top - options.base);
        EXPECT_NEAR(cover_of(options), coverage, 0.05)
          << static_cast<int>(kind) << ", " << wide << " clouds wide";
      }
    }
    brume::CloudOptions options = brume::cloud_defaults(kind);
    options.coverage = 0.0;
    EXPECT_EQ(cover_of(options), 0.0);
    options.coverage = 1.0;
    EXPECT_GT(cover_of(options), 0.97);
  }
}

TEST(CloudKinds, AFieldThatIsTooWideIsRefused)
{
  brume::CloudOptions options = brume::cloud_defaults(CloudKind::CumulusField);
  options.width = 1e6;
  options.base = 30000.0;
  options.top = 30900.0;
  EXPECT_THROW(brume::make_cloud(options), std::invalid_argument);
}

TEST(CloudKinds, MoveWithTheWindAndWithNothingElse)
{
  for (const CloudKind kind : all_kinds())
  {
    brume::CloudOptions options = brume::cloud_defaults(kind);
    EXPECT_NE(Sampled(*brume::make_cloud(options), 32, 0.0).values,
      Sampled(*brume::make_cloud(options), 32, 60.0).values);
    options.wind = dvec3(0.0);
    EXPECT_EQ(Sampled(*brume::make_cloud(options), 32, 0.0).values,
      Sampled(*brume::make_cloud(options), 32, 60.0).values);
  }
  // A layer is carried whole: away from the sides the density is that of the place upwind.
  const std::unique_ptr<brume::Field> layer = usual(CloudKind::Stratocumulus);
  for (int n = 0; n < 400; ++n)
  {
    const dvec3 p(-400.0 + 50.0 * (n % 20), -500.0 + 50.0 * (n / 20), 1150.0);
    const dvec3 upwind = p - dvec3(8.0, 2.0, 0.0) * 10.0;
    EXPECT_NEAR(layer->value(p, 10.0), layer->value(upwind, 0.0), 1e-4);
  }
}

TEST(CloudKinds, AnAnvilIsWiderThanItsTower)
{
  const Sampled s(*usual(CloudKind::Cumulonimbus), 96);
  const auto wide_at = [&](double z)
  {
    const int k = static_cast<int>((z - s.grid.origin.z) / s.grid.spacing.z + 0.5);
    int count = 0;
    for (int j = 0; j < s.grid.dimensions.y; ++j)
      for (int i = 0; i < s.grid.dimensions.x; ++i)
      {
        count += s.at(i, j, k) > 0.05f;
      }
    return count;
  };
  EXPECT_GT(wide_at(10500.0), 1.5 * wide_at(7000.0));
  EXPECT_GT(wide_at(7000.0), 50);
}

TEST(CloudKinds, RefuseWhatMakesNone)
{
  const auto refused = [](CloudKind kind, void (*change)(brume::CloudOptions&))
  {
    brume::CloudOptions options = brume::cloud_defaults(kind);
    change(options);
    EXPECT_THROW(brume::make_cloud(options), std::invalid_argument);
  };
  for (const CloudKind kind : all_kinds())
  {
    refused(kind, [](brume::CloudOptions& o) { o.width = 0.0; });
    refused(kind, [](brume::CloudOptions& o) { o.coverage = 1.5; });
    refused(kind, [](brume::CloudOptions& o) { o.octaves = 9; });
    refused(kind, [](brume::CloudOptions& o) { o.crispness = 0.0; });
    refused(kind, [](brume::CloudOptions& o) { o.wind.x = std::nan(""); });
    refused(kind,
      [](brume::CloudOptions& o)
      {
        o.base = 500.0;
        o.top = 400.0;
      });
  }
}

TEST(FogBanks, EveryTargetGivesTheBitsOfOneLane)
{
  for (const FogKind kind : { FogKind::Homogeneous, FogKind::Height, FogKind::Valley })
  {
    const brume::FogBank bank = fog(kind);
    const brume::Lattice grid = brume::grid_over(bank.bounds(), 40);
    brume_tests::expect_bits_of_one_lane(
      bank, { grid.origin, grid.spacing, { -3, -3, -3 }, grid.dimensions + 6 }, 33.0);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    brume_tests::expect_bits_of_one_lane(
      bank, { dvec3(0, nan, 50.0), dvec3(20.0), { -30, 0, 0 }, { 61, 1, 1 } }, 0.0);
  }
}

TEST(FogBanks, HoldTheirBounds)
{
  for (const FogKind kind : { FogKind::Homogeneous, FogKind::Height, FogKind::Valley })
  {
    EXPECT_GT(expect_bounds_hold(fog(kind), 20.0, 12), 10) << static_cast<int>(kind);
  }
}

TEST(FogBanks, HomogeneousFogIsOneInItsBox)
{
  const brume::FogBank bank = fog(FogKind::Homogeneous);
  EXPECT_EQ(bank.value({ -2000, 2000, 0 }, 0.0), 1.0f);
  EXPECT_EQ(bank.value({ 10, 20, 399 }, 0.0), 1.0f);
  EXPECT_EQ(bank.value({ 10, 20, 401 }, 0.0), 0.0f);
  const brume::FieldRange range =
    bank.range_in({ dvec3(-100, -100, 50), dvec3(100, 100, 60) }, 0.0);
  EXPECT_EQ(range.lower, 1.0f);
  EXPECT_EQ(range.upper, 1.0f);
}

TEST(FogBanks, HeightFogFallsOffExponentially)
{
  brume::FogOptions options;
  options.noise = 0.0;
  options.base = 20.0;
  const brume::FogBank bank(options);
  for (double z = 20.0; z < 400.0; z += 7.0)
  {
    const double expected = std::exp(-(z - 20.0) / 90.0);
    EXPECT_NEAR(bank.value({ 100, -200, z }, 0.0), expected, 1e-6 * expected) << z;
  }
  // The noise only takes.
  options.noise = 0.5;
  const brume::FogBank noisy(options);
  double sum = 0.0;
  for (int n = 0; n < 1000; ++n)
  {
    const dvec3 p(-1900.0 + 3.8 * n, 1700.0 - 3.1 * n, 21.0);
    const float v = noisy.value(p, 0.0);
    EXPECT_LE(v, 1.0f);
    EXPECT_GE(v, 0.45f);
    sum += v / 1000;
  }
  EXPECT_LT(sum, 0.95);
}

TEST(FogBanks, ValleyFogFillsTheHollowsOfItsGround)
{
  // A bowl: the ground rises with the distance from the middle.
  auto bowl = std::make_shared<brume::HeightMap>(brume::HeightMap::from(
    [](double x, double y) { return 0.2 * std::sqrt(x * x + y * y); }, 4000.0, 128));
  brume::FogOptions options;
  options.kind = FogKind::Valley;
  options.noise = 0.0;
  options.coverage = 0.3;
  const brume::FogBank bank(options, bowl);
  // 30 % of a square of 4 km lie within 1236 m of the middle, where the ground is at 247 m.
  EXPECT_NEAR(bank.level(), 247.0, 5.0);
  EXPECT_EQ(bank.value({ 0, 0, bank.level() + 1.0 }, 0.0), 0.0f);
  EXPECT_EQ(bank.value({ 0, 0, bank.level() - 61.0 }, 0.0), 1.0f);
  EXPECT_NEAR(bank.value({ 0, 0, bank.level() - 30.0 }, 0.0), 0.5f, 1e-3);
  EXPECT_EQ(bank.value({ 0, 0, -25.0 }, 0.0), 1.0f) << "a little under the ground";
  EXPECT_EQ(bank.value({ 0, 0, -35.0 }, 0.0), 0.0f) << "deep under the ground";
  EXPECT_EQ(bank.value({ 1500, 0, bank.level() - 10.0 }, 0.0), 0.0f) << "in the hill";
  EXPECT_GT(expect_bounds_hold(bank, 0.0, 12), 300);
}

TEST(FogBanks, AHeightMapIsBilinearAndLevelBeyondItsEnds)
{
  brume::HeightMap map;
  map.dimensions = { 3, 2 };
  map.origin = { 10.0, 20.0 };
  map.spacing = { 2.0, 4.0 };
  map.heights = { 0, 1, 4, 10, 11, 14 };
  EXPECT_EQ(map.at(10.0, 20.0), 0.0f);
  EXPECT_EQ(map.at(13.0, 22.0), 7.5f);
  EXPECT_EQ(map.at(-100.0, 24.0), 10.0f);
  EXPECT_EQ(map.at(100.0, 100.0), 14.0f);
  EXPECT_EQ(map.quantile(0.0), 0.0);
  EXPECT_EQ(map.quantile(1.0), 14.0);
  EXPECT_NO_THROW(map.check());
  map.heights[2] = std::nanf("");
  EXPECT_THROW(map.check(), std::invalid_argument);
  map.heights.pop_back();
  EXPECT_THROW(map.check(), std::invalid_argument);
}

TEST(FogBanks, RefuseWhatMakesNone)
{
  brume::FogOptions options;
  options.noise = 2.0;
  EXPECT_THROW(brume::FogBank{ options }, std::invalid_argument);
  options = {};
  options.top = -1.0;
  EXPECT_THROW(brume::FogBank{ options }, std::invalid_argument);
  options = {};
  options.scale_height = 0.0;
  EXPECT_THROW(brume::FogBank{ options }, std::invalid_argument);
  options = {};
  options.kind = FogKind::Valley;
  options.softness = 0.0;
  EXPECT_THROW(brume::FogBank{ options }, std::invalid_argument);
  options.softness = 10.0;
  EXPECT_THROW(
    brume::FogBank(options, std::make_shared<brume::HeightMap>()), std::invalid_argument);
}
