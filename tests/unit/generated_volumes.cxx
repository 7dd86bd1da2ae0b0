// The head phantom and the cumulus as functions of place: the right tissue in the right place, the
// cloud within its box; and sampling: any piece, any number of threads, the same values.
#include "data-generators/cumulus.h"
#include "data-generators/head_ct.h"
#include "data-generators/hounsfield.h"
#include "data-generators/painted_volume.h"
#include "data-generators/plume.h"
#include "data-generators/random.h"
#include "data-generators/sampling.h"
#include "data-generators/signed_distance.h"
#include "every_target.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

namespace
{

using glm::dvec3;
namespace hu = brume::hounsfield;

template <typename T>
std::uint64_t fingerprint(const std::vector<T>& values)
{
  std::uint64_t hash = 0xcbf29ce484222325ull;
  const auto* bytes = reinterpret_cast<const unsigned char*>(values.data());
  for (std::size_t n = 0; n < values.size() * sizeof(T); ++n)
  {
    hash = (hash ^ bytes[n]) * 0x100000001b3ull;
  }
  return hash;
}

std::vector<float> sampled(const brume::Field& field, int size, double time = 0.0)
{
  const brume::Lattice grid = brume::grid_over(field.bounds(), size);
  std::vector<float> values(brume::whole_extent(grid).voxels());
  EXPECT_TRUE(brume::sample(field, time, grid, brume::whole_extent(grid), values.data()));
  return values;
}

std::vector<std::int16_t> scanned(int size, double noise)
{
  const brume::HeadCT head;
  const brume::Lattice grid = brume::grid_over(head.bounds(), size);
  std::vector<std::int16_t> values(brume::whole_extent(grid).voxels());
  brume::sample_head_ct(head, noise, 1, grid, brume::whole_extent(grid), values.data());
  return values;
}

const brume::HeadCT& head()
{
  static const brume::HeadCT phantom;
  return phantom;
}

double at(double x, double y, double z)
{
  return head().value({ x, y, z }, 0.0);
}

/// Mean over a cube of 2 * reach mm.
double around(double x, double y, double z, double reach)
{
  double sum = 0.0;
  for (int n = 0; n < 1000; ++n)
  {
    sum += at(x + reach * ((n % 10) - 4.5) / 4.5,
      y + reach * ((n / 10 % 10) - 4.5) / 4.5,
      z + reach * ((n / 100) - 4.5) / 4.5);
  }
  return sum / 1000;
}

}

TEST(SignedDistance, AgreesWithClosedForms)
{
  EXPECT_DOUBLE_EQ(brume::sphere_distance({ 3, 4, 0 }, dvec3(0.0), 2.0), 3.0);
  EXPECT_NEAR(brume::ellipsoid_distance({ 6, 0, 0 }, dvec3(0.0), { 4, 2, 1 }), 2.0, 1e-12);
  EXPECT_NEAR(
    brume::ellipsoid_distance({ 1, 1, 1 }, dvec3(0.0), dvec3(2.0)), std::sqrt(3.0) - 2.0, 1e-12);
  EXPECT_DOUBLE_EQ(brume::ellipsoid_distance(dvec3(0.0), dvec3(0.0), { 4, 2, 1 }), -1.0);
  EXPECT_DOUBLE_EQ(brume::capsule_distance({ 1, 5, 0 }, { 0, 0, 0 }, { 2, 0, 0 }, 1, 1), 4.0);
  EXPECT_DOUBLE_EQ(brume::capsule_distance({ 1, 0, 0 }, { 0, 0, 0 }, { 0, 0, 0 }, 0.5, 1), 0.5);
  EXPECT_DOUBLE_EQ(brume::box_distance({ 5, 6, 0 }, dvec3(0.0), { 2, 2, 2 }, 0.5),
    std::sqrt(3.5 * 3.5 + 4.5 * 4.5) - 0.5);
  EXPECT_DOUBLE_EQ(brume::torus_distance({ 3, 0, 4 }, dvec3(0.0), 3.0, 1.0), 3.0);
  EXPECT_DOUBLE_EQ(brume::smooth_union(1.0, 5.0, 2.0), 1.0);
  EXPECT_DOUBLE_EQ(brume::smooth_union(1.0, 1.0, 2.0), 0.5);
  EXPECT_DOUBLE_EQ(brume::smooth_difference(-3.0, -1.0, 0.5), 1.0);
}

TEST(PaintedVolume, LeavesOutOnlyWhatDoesNotShow)
{
  const brume::Box box = head().bounds();
  double worst = 0.0;
  for (std::uint32_t n = 0; n < 40000; ++n)
  {
    const dvec3 u(brume::unit_float(brume::mix_bits(3 * n + 1)),
      brume::unit_float(brume::mix_bits(3 * n + 2)),
      brume::unit_float(brume::mix_bits(3 * n + 3)));
    const dvec3 p = box.lower + u * (box.upper - box.lower);
    worst =
      std::max(worst, std::fabs(head().painting().value(p) - head().painting().value_by_all(p)));
  }
  EXPECT_LT(worst, 1e-9);
}

TEST(HeadCT, HasEachTissueWhereItBelongs)
{
  EXPECT_EQ(at(-94, 118, 126), -1000.0f) << "a corner of the box";
  EXPECT_EQ(at(0, 118, 100), -1000.0f) << "before the forehead";
  EXPECT_EQ(at(0, 5.5, -75), -1000.0f) << "throat";
  EXPECT_EQ(at(27, 56, -24), -1000.0f) << "right maxillary sinus";
  EXPECT_EQ(at(-27, 56, -24), -1000.0f) << "left maxillary sinus";
  EXPECT_NEAR(at(32, 66, 2), hu::vitreous, 1) << "right eye";
  EXPECT_NEAR(at(32, 78, 2), hu::lens, 10) << "right lens";
  EXPECT_NEAR(at(25, 57.5, -5), hu::fat, 40) << "fat behind the eye";
  EXPECT_NEAR(at(10, -18, 64), hu::cerebrospinal_fluid, 1) << "right lateral ventricle";
  EXPECT_NEAR(at(0, -2, 40), hu::cerebrospinal_fluid, 1) << "third ventricle";
  EXPECT_NEAR(at(28, -20, 66), hu::white_matter, 1) << "deep white matter";
  EXPECT_NEAR(at(11, -12, 46), hu::grey_matter, 1) << "thalamus";
  EXPECT_GT(at(0, 1, 12), 250.0) << "basilar artery";
  EXPECT_NEAR(at(0, -30, 44), hu::calcification, 5) << "pineal gland";
}

TEST(HeadCT, BoneIsBoneAndBrainIsBrain)
{
  const double brain = around(25, -10, 75, 10);
  EXPECT_GT(brain, 20.0);
  EXPECT_LT(brain, 45.0);
  // From outside to inside, at the right temple: skin, fat, outer table, diploe, inner table,
  // fluid.
  bool bone = false, fat = false, skin = false;
  double diploe = 0.0;
  int voxels_of_diploe = 0;
  for (double x = 95; x > 40; x -= 0.25)
  {
    const double value = at(x, -30, 60);
    skin = skin || (!bone && value > 30 && value < 70);
    fat = fat || (skin && !bone && value < -70 && value > -130);
    bone = bone || (fat && value > 1300);
  }
  for (double x : { 66.0, 67.0 })
  {
    for (double y = -40; y < 0; y += 0.5)
    {
      diploe += at(x, y, 56);
      ++voxels_of_diploe;
    }
  }
  EXPECT_TRUE(skin);
  EXPECT_TRUE(fat);
  EXPECT_TRUE(bone);
  EXPECT_GT(diploe / voxels_of_diploe, 200.0);
  EXPECT_LT(diploe / voxels_of_diploe, 1500.0);
}

TEST(HeadCT, TellsThePatientsLeftFromRight)
{
  EXPECT_NEAR(at(-75, 22, 24), hu::marker, 1);
  EXPECT_LT(at(75, 22, 24), 200.0);
  EXPECT_LT(brume::head_marker[0], 0.0) << "RAS+: the patient's left has x below 0";
}

TEST(HeadCT, FacesForwardAndStandsUpright)
{
  // RAS+: the nose in front (+y), teeth below the eyes, the neck at the bottom, air above the
  // crown.
  EXPECT_GT(at(0, 104, -28), -200.0) << "tip of the nose";
  EXPECT_EQ(at(0, -112, -28), -1000.0f);
  EXPECT_GT(at(4, 78.8, -60), 1500.0) << "upper incisor";
  EXPECT_GT(at(0, -36, -126), -200.0) << "neck";
  EXPECT_EQ(at(0, -36, 126), -1000.0f) << "above the crown";
}

TEST(HeadCT, NoiseHasItsDeviationAndNoBias)
{
  const brume::Lattice grid = brume::grid_over(head().bounds(), 256);
  const brume::Extent air{ { 0, 0, 200 }, { 25, 25, 255 } }; // a corner outside the head
  std::vector<std::int16_t> values(air.voxels());
  brume::sample_head_ct(head(), 5.0, 3, grid, air, values.data());
  double mean = 0.0, square = 0.0;
  for (const std::int16_t v : values)
  {
    mean += (v + 1000.0) / values.size();
    square += (v + 1000.0) * (v + 1000.0) / values.size();
  }
  EXPECT_NEAR(mean, 0.0, 5 * 5.0 / std::sqrt(double(values.size())));
  // Rounding adds 1/12 to the variance; -1024 cuts nothing at 5 sigma.
  EXPECT_NEAR(square / (25.0 + 1.0 / 12.0), 1.0, 5 * std::sqrt(2.0 / values.size()));
}

TEST(HeadCT, HasTheSameBytesEverywhere)
{
  EXPECT_EQ(fingerprint(scanned(48, 10.0)), 1568917927712949739ull);
}

TEST(HeadCT, RefusesAnEdgeThatIsNone)
{
  EXPECT_THROW(brume::HeadCT({ 1, 0.0 }), std::invalid_argument);
  EXPECT_THROW(
    brume::HeadCT({ 1, std::numeric_limits<double>::quiet_NaN() }), std::invalid_argument);
}

TEST(Cumulus, FillsAFairPartOfItsBox)
{
  for (std::uint32_t seed : { 1u, 2u, 3u, 99u })
  {
    brume::CumulusOptions options;
    options.seed = seed;
    const std::vector<float> density = sampled(brume::Cumulus(options), 64);
    double sum = 0.0;
    std::size_t filled = 0;
    float highest = 0.0f;
    for (const float d : density)
    {
      ASSERT_GE(d, 0.0f);
      ASSERT_LE(d, 1.0f);
      sum += d;
      filled += d > 0.0f;
      highest = std::max(highest, d);
    }
    EXPECT_GT(sum / density.size(), 0.02) << "seed " << seed;
    EXPECT_LT(sum / density.size(), 0.12) << "seed " << seed;
    EXPECT_GT(sum / filled, 0.4) << "seed " << seed;
    EXPECT_EQ(highest, 1.0f);
  }
}

TEST(Cumulus, NeverTouchesItsBox)
{
  for (int size : { 26, 64 })
  {
    for (double time : { 0.0, 1000.0 })
    {
      brume::CumulusOptions options;
      options.warp_amplitude = 1e6;
      const brume::Cumulus cloud(options);
      const brume::Lattice grid = brume::grid_over(cloud.bounds(), size);
      const std::vector<float> density = sampled(cloud, size, time);
      std::size_t n = 0;
      for (int k = 0; k < grid.dimensions.z; ++k)
        for (int j = 0; j < grid.dimensions.y; ++j)
          for (int i = 0; i < grid.dimensions.x; ++i, ++n)
          {
            if (i == 0 || j == 0 || k == 0 || i == grid.dimensions.x - 1 ||
                j == grid.dimensions.y - 1 || k == grid.dimensions.z - 1)
            {
              ASSERT_EQ(density[n], 0.0f) << i << ' ' << j << ' ' << k;
            }
          }
    }
  }
  EXPECT_EQ(brume::Cumulus().value({ 5000, 0, 500 }, 0.0), 0.0f);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(brume::Cumulus().value({ 0, nan, 500 }, 0.0), 0.0f);
  EXPECT_EQ(brume::Cumulus().value({ 0, 0, nan }, 0.0), 0.0f);
}

TEST(Cumulus, HasAFlatBase)
{
  // No cloud below the base; within a tenth of the height above it, a wide one.
  const brume::Cumulus cloud;
  int below = 0, above = 0;
  for (double x = -900; x < 900; x += 20)
    for (double y = -900; y < 900; y += 20)
    {
      below += cloud.value({ x, y, 95.0 }, 0.0) > 0.0f;
      above += cloud.value({ x, y, 240.0 }, 0.0) > 0.0f;
    }
  EXPECT_EQ(below, 0);
  EXPECT_GT(above, 1000);
}

TEST(Cumulus, TheWindMovesItsNoise)
{
  const brume::Cumulus cloud;
  EXPECT_NE(sampled(cloud, 32, 0.0), sampled(cloud, 32, 60.0));
  brume::CumulusOptions still;
  still.wind = dvec3(0.0);
  EXPECT_EQ(sampled(brume::Cumulus(still), 32, 0.0), sampled(brume::Cumulus(still), 32, 60.0));
}

TEST(Cumulus, HasTheSameBytesEverywhere)
{
  EXPECT_EQ(fingerprint(sampled(brume::Cumulus(), 48, 3.5)), 11078721624907771432ull);
}

TEST(Cumulus, EveryTargetGivesTheBitsOfOneLane)
{
  const brume::Cumulus cloud;
  const brume::Lattice grid = brume::grid_over(cloud.bounds(), 40);
  brume_tests::expect_bits_of_one_lane(
    cloud, { grid.origin, grid.spacing, { 0, 0, 0 }, grid.dimensions }, 12.0);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  brume_tests::expect_bits_of_one_lane(
    cloud, { dvec3(0, nan, 500), dvec3(20.0), { -30, 0, 0 }, { 61, 1, 1 } }, 0.0);
  brume_tests::expect_bits_of_one_lane(
    cloud, { dvec3(0, 0, 500), dvec3(1e30, 1.0, 1.0), { -3, 0, 0 }, { 7, 3, 1 } }, 0.0);
}

TEST(Cumulus, ItsBoundsHold)
{
  const brume::Cumulus cloud;
  brume::CumulusOptions flat;
  flat.base = 500.0;
  flat.top = 900.0;
  flat.warp_amplitude = 120.0;
  flat.offset = 0.3;
  const brume::Cumulus other(flat);
  // With no warp the bounds are tight, and small boxes find out where they are too tight.
  brume::CumulusOptions plain;
  plain.warp_amplitude = 0.0;
  plain.offset = 0.5;
  const brume::Cumulus unmoved(plain);
  for (const brume::Cumulus* c : { &cloud, &other, &unmoved })
  {
    constexpr int parts = 40;
    int left_out = 0;
    const dvec3 size = (c->bounds().upper - c->bounds().lower) / double(parts);
    for (int n = 0; n < parts * parts * parts; ++n)
    {
      const dvec3 first =
        c->bounds().lower + dvec3(n % parts, n / parts % parts, n / parts / parts) * size;
      const brume::FieldRange range = c->range_in({ first, first + size }, 5.0);
      left_out += range.upper == 0.0f;
      if (range.upper == 0.0f)
      {
        std::vector<float> inside(4 * 4 * 4);
        c->values({ first, size / 3.0, { 0, 0, 0 }, { 4, 4, 4 } }, 5.0, inside.data());
        ASSERT_EQ(*std::max_element(inside.begin(), inside.end()), 0.0f);
      }
    }
    EXPECT_GT(left_out, parts * parts * parts / 3);
  }
}

TEST(Cumulus, StandsBetweenItsBaseAndItsTop)
{
  brume::CumulusOptions options;
  options.base = 700.0;
  options.top = 2500.0;
  const brume::Cumulus cloud(options);
  EXPECT_NEAR(cloud.bounds().upper.z, 2660.0, 1e-9);
  const brume::Lattice grid = brume::grid_over(cloud.bounds(), 96);
  const std::vector<float> density = sampled(cloud, 96);
  int lowest = grid.dimensions.z, highest = 0;
  std::size_t n = 0;
  for (int k = 0; k < grid.dimensions.z; ++k)
    for (int j = 0; j < grid.dimensions.y; ++j)
      for (int i = 0; i < grid.dimensions.x; ++i, ++n)
        if (density[n] > 0.1f)
        {
          lowest = std::min(lowest, k);
          highest = std::max(highest, k);
        }
  EXPECT_NEAR(grid.place(0, 0, lowest).z, 700.0, 80.0);
  EXPECT_NEAR(grid.place(0, 0, highest).z, 2500.0, 350.0);
  options.top = 600.0;
  EXPECT_THROW(brume::Cumulus{ options }, std::invalid_argument);
}

TEST(Cumulus, RefusesOptionsThatMakeNoCloud)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  brume::CumulusOptions options;
  options.width = 0.0;
  EXPECT_THROW(brume::Cumulus{ options }, std::invalid_argument);
  options = {};
  options.octaves = 0;
  EXPECT_THROW(brume::Cumulus{ options }, std::invalid_argument);
  options = {};
  options.wind.y = nan;
  EXPECT_THROW(brume::Cumulus{ options }, std::invalid_argument);
}

TEST(Plume, RisesFromItsSourceAndThins)
{
  for (std::uint32_t seed : { 1u, 2u, 77u })
  {
    brume::PlumeOptions options;
    options.seed = seed;
    const brume::Plume plume(options);
    const brume::Lattice grid = brume::grid_over(plume.bounds(), 96);
    ASSERT_EQ(grid.dimensions, glm::ivec3(48, 48, 96));
    // By layers: how wide it is (voxels with smoke), and its highest temperature.
    const auto layer = [&](double height)
    {
      struct
      {
        int wide = 0;
        float hottest = 0.0f;
      } found;
      for (int j = 0; j < 48; ++j)
        for (int i = 0; i < 48; ++i)
        {
          const brume::Plume::State s =
            plume.at(grid.place(i, j, static_cast<int>(height * 95)), 0.0);
          EXPECT_GE(s.density, 0.0f);
          EXPECT_LE(s.density, 1.0f);
          EXPECT_GE(s.temperature, 300.0f);
          EXPECT_LE(s.temperature, 1900.0f);
          found.wide += s.density > 0.0f;
          found.hottest = std::max(found.hottest, s.temperature);
        }
      return found;
    };
    const auto low = layer(0.1), middle = layer(0.4), high = layer(0.7);
    EXPECT_GT(low.wide, 10) << "seed " << seed;
    EXPECT_GT(middle.wide, 2 * low.wide) << "seed " << seed;
    EXPECT_GT(high.wide, middle.wide) << "seed " << seed;
    EXPECT_GT(low.hottest, 900.0f) << "seed " << seed;
    EXPECT_GT(low.hottest, middle.hottest + 300.0f) << "seed " << seed;
    EXPECT_GT(middle.hottest, high.hottest) << "seed " << seed;
  }
}

TEST(Plume, NeverTouchesItsBox)
{
  const brume::Plume plume;
  const brume::Lattice grid = brume::grid_over(plume.bounds(), 64);
  for (double time : { 0.0, 1000.0 })
  {
    const std::vector<float> density = sampled(plume, 64, time);
    std::size_t n = 0;
    for (int k = 0; k < grid.dimensions.z; ++k)
      for (int j = 0; j < grid.dimensions.y; ++j)
        for (int i = 0; i < grid.dimensions.x; ++i, ++n)
        {
          if (i == 0 || j == 0 || k == 0 || i == grid.dimensions.x - 1 ||
              j == grid.dimensions.y - 1 || k == grid.dimensions.z - 1)
          {
            ASSERT_EQ(density[n], 0.0f) << i << ' ' << j << ' ' << k;
          }
        }
  }
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const dvec3& outside : { dvec3(0, 0, 9), dvec3(nan, 0, 1), dvec3(0, 0, nan) })
  {
    EXPECT_EQ(plume.at(outside, 0.0).density, 0.0f);
    EXPECT_EQ(plume.at(outside, 0.0).temperature, 300.0f);
  }
}

TEST(Plume, ItsTurbulenceRises)
{
  EXPECT_NE(sampled(brume::Plume(), 32, 0.0), sampled(brume::Plume(), 32, 3.0));
  brume::PlumeOptions still;
  still.rise = 0.0;
  EXPECT_EQ(sampled(brume::Plume(still), 32, 0.0), sampled(brume::Plume(still), 32, 3.0));
}

TEST(Plume, HasTheSameBytesEverywhere)
{
  EXPECT_EQ(fingerprint(sampled(brume::Plume(), 48, 3.5)), 17583272377612584305ull);
}

TEST(Plume, RefusesOptionsThatMakeNone)
{
  brume::PlumeOptions options;
  options.width = -1.0;
  EXPECT_THROW(brume::Plume{ options }, std::invalid_argument);
  options = {};
  options.source_temperature = 200.0;
  EXPECT_THROW(brume::Plume{ options }, std::invalid_argument);
  options = {};
  options.rise = std::numeric_limits<double>::infinity();
  EXPECT_THROW(brume::Plume{ options }, std::invalid_argument);
}

TEST(Sampling, GridsFillTheirBoxAndShareItsCentre)
{
  const brume::Lattice grid = brume::grid_over({ { -96, -120, -128 }, { 96, 120, 128 } }, 256);
  EXPECT_EQ(grid.dimensions, glm::ivec3(192, 240, 256));
  EXPECT_EQ(grid.spacing, dvec3(1.0));
  EXPECT_EQ(grid.origin, dvec3(-95.5, -119.5, -127.5));
  EXPECT_EQ(brume::grid_over({ { 0, 0, 0 }, { 1, 1, 100 } }, 2).dimensions, glm::ivec3(2));
  EXPECT_THROW(brume::grid_over({ { 0, 0, 0 }, { 1, 1, 1 } }, 1), std::invalid_argument);
  EXPECT_THROW(brume::grid_over({ { 0, 0, 0 }, { 1, 0, 1 } }, 8), std::invalid_argument);
}

TEST(Sampling, DoesNotDependOnTheThreads)
{
  const brume::Cumulus cloud;
  const std::vector<float> many = sampled(cloud, 40);
  const std::vector<std::int16_t> scan = scanned(40, 10.0);
  tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(sampled(cloud, 40), many);
  EXPECT_EQ(scanned(40, 10.0), scan);
}

TEST(Sampling, ReportsProgressAndStops)
{
  const brume::Cumulus cloud;
  const brume::Lattice grid = brume::grid_over(cloud.bounds(), 64);
  std::vector<float> values(brume::whole_extent(grid).voxels());
  std::vector<double> reports;
  EXPECT_TRUE(brume::sample(cloud,
    0.0,
    grid,
    brume::whole_extent(grid),
    values.data(),
    [&](double done)
    {
      reports.push_back(done);
      return true;
    }));
  ASSERT_GT(reports.size(), 5u);
  EXPECT_TRUE(std::is_sorted(reports.begin(), reports.end()));
  EXPECT_GT(reports.front(), 0.0);
  EXPECT_EQ(reports.back(), 1.0);

  int calls = 0;
  EXPECT_FALSE(brume::sample(cloud,
    0.0,
    grid,
    brume::whole_extent(grid),
    values.data(),
    [&](double) { return ++calls < 3; }));
  EXPECT_EQ(calls, 3);
}

TEST(Sampling, AnExceptionComesOut)
{
  const brume::Extent extent{ { 0, 0, 0 }, { 3, 3, 3 } };
  EXPECT_THROW(
    brume::for_each_row(extent, [](int, int, std::size_t) { throw std::runtime_error("row"); }),
    std::runtime_error);
}
