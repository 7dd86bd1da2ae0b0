// Noise: ranges and means as documented, smoothness, and the same bits everywhere.
#include "data-generators/noise.h"
#include "data-generators/noise_field.h"
#include "data-generators/random.h"
#include "every_target.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <glm/common.hpp>
#include <limits>
#include <stdexcept>
#include <vector>

namespace
{

using Octaves = brume::NoiseOctaves;
using glm::dvec3;

/// Places at random in a cube of 2000 features, both signs.
dvec3 random_place(std::uint32_t n)
{
  const auto coordinate = [n](std::uint32_t axis)
  { return 2000.0 * brume::mix_bits(3 * n + axis + 12345) / 4294967296.0 - 1000.0; };
  return { coordinate(0), coordinate(1), coordinate(2) };
}

struct Statistics
{
  double low = 1e9, high = -1e9, mean = 0.0, deviation = 0.0;
};

Statistics statistics(const std::function<double(const dvec3&)>& noise, int count = 200000)
{
  Statistics s;
  double squares = 0.0;
  for (int n = 0; n < count; ++n)
  {
    const double v = noise(random_place(n));
    s.low = std::min(s.low, v);
    s.high = std::max(s.high, v);
    s.mean += v / count;
    squares += v * v / count;
  }
  s.deviation = std::sqrt(squares - s.mean * s.mean);
  return s;
}

/// FNV-1a of the bits of a noise at many places.
std::uint64_t fingerprint(const std::function<float(const dvec3&)>& noise)
{
  std::uint64_t hash = 0xcbf29ce484222325ull;
  for (int n = 0; n < 5000; ++n)
  {
    const float value = noise(random_place(n));
    std::uint32_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    hash = (hash ^ bits) * 0x100000001b3ull;
  }
  return hash;
}

}

TEST(Noise, PerlinHasItsDocumentedRangeMeanAndDeviation)
{
  const Statistics s = statistics([](const dvec3& p) { return brume::perlin_noise(p, 7); });
  EXPECT_GE(s.low, -1.0);
  EXPECT_LE(s.high, 1.0);
  EXPECT_LT(s.low, -0.75); // the range is used
  EXPECT_GT(s.high, 0.75);
  EXPECT_NEAR(s.mean, 0.0, 5 * s.deviation / std::sqrt(200000.0));
  EXPECT_NEAR(s.deviation, 0.26, 0.02);
}

TEST(Noise, PerlinsFormulaCannotPassItsScale)
{
  // The best gradient at each corner is the one along the two larger offsets.
  const auto fade = [](double t) { return t * t * t * (t * (t * 6 - 15) + 10); };
  double largest = 0.0;
  const int steps = 80;
  for (int i = 0; i <= steps; ++i)
    for (int j = 0; j <= steps; ++j)
      for (int k = 0; k <= steps; ++k)
      {
        const double p[3] = { i / double(steps), j / double(steps), k / double(steps) };
        double sum = 0.0;
        for (int corner = 0; corner < 8; ++corner)
        {
          double weight = 1.0, all = 0.0, smallest = 2.0;
          for (int a = 0; a < 3; ++a)
          {
            const int side = corner >> a & 1;
            const double offset = std::fabs(p[a] - side);
            weight *= side ? fade(p[a]) : 1.0 - fade(p[a]);
            all += offset;
            smallest = std::min(smallest, offset);
          }
          sum += weight * (all - smallest);
        }
        largest = std::max(largest, sum);
      }
  EXPECT_LE(largest, 1.0363539);
  EXPECT_GT(largest, 1.0355);
}

TEST(Noise, SimplexsFormulaCannotPassItsScale)
{
  // The coordinates of a place from its tetrahedron's first corner, in falling order; the best
  // gradient at each corner is the one along the two larger offsets.
  double largest = 0.0;
  const int steps = 90;
  for (int i = 0; i <= steps; ++i)
    for (int j = 0; j <= i; ++j)
      for (int k = 0; k <= j; ++k)
      {
        // In the skewed cube, 1 >= a >= b >= c >= 0, and back.
        const double skewed[3] = { i / double(steps), j / double(steps), k / double(steps) };
        const double back = (skewed[0] + skewed[1] + skewed[2]) / 6.0;
        double sum = 0.0;
        for (int corner = 0; corner < 4; ++corner)
        {
          double offset[3], square = 0.0;
          for (int a = 0; a < 3; ++a)
          {
            offset[a] = std::fabs(skewed[a] - back - (a < corner ? 1.0 : 0.0) + corner / 6.0);
            square += offset[a] * offset[a];
          }
          std::sort(offset, offset + 3);
          sum += std::pow(std::max(0.5 - square, 0.0), 4) * (offset[1] + offset[2]);
        }
        largest = std::max(largest, sum);
      }
  EXPECT_LE(largest, 0.0130072);
  EXPECT_GT(largest, 0.01299);
}

TEST(Noise, PerlinIsZeroOnTheLattice)
{
  for (int n = -20; n < 20; ++n)
  {
    EXPECT_EQ(brume::perlin_noise({ n, 3 * n - 1, 5 - n }, 3), 0.0f);
  }
}

TEST(Noise, SimplexHasItsDocumentedRangeMeanAndDeviation)
{
  const Statistics s = statistics([](const dvec3& p) { return brume::simplex_noise(p, 7); });
  EXPECT_GE(s.low, -1.0);
  EXPECT_LE(s.high, 1.0);
  EXPECT_LT(s.low, -0.9);
  EXPECT_GT(s.high, 0.9);
  EXPECT_NEAR(s.mean, 0.0, 5 * s.deviation / std::sqrt(200000.0));
  EXPECT_NEAR(s.deviation, 0.39, 0.02);
}

TEST(Noise, SimplexIsContinuousEverywhere)
{
  // Along lines that cross many tetrahedra: no jump at any face.
  const double step = 1e-4;
  for (int n = 0; n < 200; ++n)
  {
    const dvec3 p = random_place(n) * 0.01;
    const dvec3 way(step * std::cos(n), step * std::sin(n), step * std::sin(2.0 * n + 1.0));
    float before = brume::simplex_noise(p, 5);
    for (int i = 1; i < 3000; ++i)
    {
      const float value = brume::simplex_noise(p + way * double(i), 5);
      ASSERT_NEAR(value, before, 10.0 * step);
      before = value;
    }
  }
}

TEST(Noise, PerlinWorleyHasItsDocumentedRangeAndMean)
{
  const Statistics s =
    statistics([](const dvec3& p) { return brume::perlin_worley_noise(p, 7); }, 50000);
  EXPECT_GE(s.low, 0.0);
  EXPECT_LE(s.high, 1.0);
  EXPECT_NEAR(s.mean, 0.74, 0.01);
}

TEST(Noise, TilesWithItsPeriod)
{
  const brume::NoisePeriod period(3, 5, 1);
  const Octaves octaves{ 4, 2.3, 0.6 }; // frequencies that do not fit are fitted
  for (int n = 0; n < 2000; ++n)
  {
    // Places on a grid of 1/1024, so that the sum with a period is exact.
    dvec3 p = random_place(n);
    p = glm::floor(p * 1024.0) / 1024.0;
    for (const dvec3& tile : { dvec3(3, 0, 0), dvec3(0, -5, 0), dvec3(0, 0, 1), dvec3(-6, 10, 7) })
    {
      EXPECT_EQ(brume::perlin_noise(p, 2, period), brume::perlin_noise(p + tile, 2, period));
      EXPECT_EQ(brume::worley_noise(p, 2, period), brume::worley_noise(p + tile, 2, period));
      EXPECT_NEAR(
        brume::fbm(p, 2, octaves, period), brume::fbm(p + tile, 2, octaves, period), 1e-5);
      EXPECT_NEAR(brume::billow_fbm(p, 2, octaves, period),
        brume::billow_fbm(p + tile, 2, octaves, period),
        1e-5);
      EXPECT_NEAR(brume::perlin_worley_noise(p, 2, octaves, period),
        brume::perlin_worley_noise(p + tile, 2, octaves, period),
        1e-5);
    }
  }
  // And is no other noise between: the same but for what lies next to the seam.
  EXPECT_EQ(brume::perlin_noise({ 1.3, 2.4, 3.7 }, 2, { 9, 9, 9 }),
    brume::perlin_noise({ 1.3, 2.4, 3.7 }, 2));
  EXPECT_NE(brume::perlin_noise({ 8.3, 2.4, 3.7 }, 2, { 9, 9, 9 }),
    brume::perlin_noise({ 8.3, 2.4, 3.7 }, 2));
}

TEST(NoiseField, EveryTargetGivesTheBitsOfOneLane)
{
  for (const brume::NoiseKind kind : { brume::NoiseKind::Perlin,
         brume::NoiseKind::Worley,
         brume::NoiseKind::Simplex,
         brume::NoiseKind::PerlinWorley })
  {
    for (const bool special : { false, true })
    {
      brume::NoiseOptions options;
      options.kind = kind;
      options.octaves.count = 3;
      options.feature_size = 0.7;
      if (special)
      {
        options.warp_size = 2.0;
        options.warp_amplitude = 0.4;
        options.period =
          kind == brume::NoiseKind::Simplex ? brume::NoisePeriod(0) : brume::NoisePeriod(4, 0, 3);
      }
      const brume::NoiseField field(options);
      // Rows of an odd length, negative places, lattice points among them.
      brume_tests::expect_bits_of_one_lane(
        field, { dvec3(-3.5), dvec3(0.175, 0.7, 0.233), { 0, 0, 0 }, { 37, 9, 11 } }, 0.0);
      brume_tests::expect_bits_of_one_lane(
        field, { dvec3(1e3, -1e6, 1e12), dvec3(0.1), { 0, 0, 0 }, { 8, 8, 8 } }, 0.0);
      brume_tests::expect_bits_of_one_lane(
        field, { dvec3(0.0), dvec3(1e14, 1.0, 0.1), { -20, 0, 0 }, { 41, 2, 1 } }, 0.0);
    }
  }
}

TEST(NoiseField, StaysInTheRangeThatItStates)
{
  for (const brume::NoiseKind kind : { brume::NoiseKind::Perlin, brume::NoiseKind::Worley })
  {
    brume::NoiseOptions options;
    options.kind = kind;
    const brume::NoiseField field(options);
    const brume::FieldRange range = field.range_in(field.bounds(), 0.0);
    for (int n = 0; n < 2000; ++n)
    {
      const float value = field.value(random_place(n), 0.0);
      EXPECT_GE(value, range.lower);
      EXPECT_LE(value, range.upper);
    }
  }
}

TEST(NoiseField, RefusesOptionsThatMakeNone)
{
  brume::NoiseOptions options;
  options.feature_size = 0.0;
  EXPECT_THROW(brume::NoiseField{ options }, std::invalid_argument);
  options = {};
  options.octaves.count = 0;
  EXPECT_THROW(brume::NoiseField{ options }, std::invalid_argument);
  options = {};
  options.octaves.gain = 1e7;
  EXPECT_THROW(brume::NoiseField{ options }, std::invalid_argument);
  options = {};
  options.kind = brume::NoiseKind::Simplex;
  options.period.y = 4;
  EXPECT_THROW(brume::NoiseField{ options }, std::invalid_argument);
}

TEST(Noise, WorleyHasItsDocumentedRangeAndMean)
{
  const Statistics s = statistics([](const dvec3& p) { return brume::worley_noise(p, 7); });
  EXPECT_GE(s.low, 0.0);
  EXPECT_LE(s.high, 1.0);
  EXPECT_LT(s.low, 0.05);
  EXPECT_NEAR(s.mean, 0.52, 0.01);
}

TEST(Noise, SumsOfOctavesStayInTheirRanges)
{
  const Statistics gradient = statistics([](const dvec3& p) { return brume::fbm(p, 7); }, 50000);
  EXPECT_GE(gradient.low, -1.0);
  EXPECT_LE(gradient.high, 1.0);
  EXPECT_NEAR(gradient.mean, 0.0, 0.005);
  // Independent octaves of weights 1, 1/2, … 1/16 over their sum.
  EXPECT_NEAR(gradient.deviation, 0.26 * std::sqrt(1.33203125) / 1.9375, 0.01);
  const Statistics billows =
    statistics([](const dvec3& p) { return brume::billow_fbm(p, 7); }, 50000);
  EXPECT_GE(billows.low, 0.0);
  EXPECT_LE(billows.high, 1.0);
  EXPECT_NEAR(billows.mean, 0.48, 0.01);
}

TEST(Noise, OneOctaveIsTheNoiseAndNoneIsNothing)
{
  const dvec3 p(1.3, -2.7, 0.4);
  EXPECT_EQ(brume::fbm(p, 9, { 1, 2.0, 0.5 }), brume::perlin_noise(p, brume::substream(9, 0)));
  EXPECT_EQ(brume::fbm(p, 9, { 0, 2.0, 0.5 }), 0.0f);
  EXPECT_EQ(brume::fbm(p, 9, { -3, 2.0, 0.5 }), 0.0f);
}

TEST(Noise, IsContinuousAcrossCells)
{
  const double step = 1e-4;
  for (int n = 0; n < 20000; ++n)
  {
    dvec3 p = random_place(n);
    p.x = std::floor(p.x) - 0.5 * step; // across a face of a cell
    const dvec3 q = p + dvec3(step, 0.0, 0.0);
    EXPECT_NEAR(brume::perlin_noise(p, 5), brume::perlin_noise(q, 5), 4.0 * step + 1e-6);
    EXPECT_NEAR(brume::worley_noise(p, 5), brume::worley_noise(q, 5), 1.0 * step + 1e-6);
  }
}

TEST(Noise, SeedsAreUnrelated)
{
  double product = 0.0;
  for (int n = 0; n < 50000; ++n)
  {
    const dvec3 p = random_place(n);
    product += brume::perlin_noise(p, 1) * brume::perlin_noise(p, 2) / 50000;
  }
  EXPECT_NEAR(product / (0.26 * 0.26), 0.0, 5.0 / std::sqrt(50000.0));
}

TEST(Noise, StrangePlacesGiveZero)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double far = 1e300;
  EXPECT_EQ(brume::perlin_noise({ nan, 0, 0 }, 1), 0.0f);
  EXPECT_EQ(brume::worley_noise({ 0, far, 0 }, 1), 0.0f);
  EXPECT_EQ(brume::fbm({ 0, 0, -std::numeric_limits<double>::infinity() }, 1), 0.0f);
  EXPECT_EQ(brume::perlin_worley_noise({ nan, 0, 0 }, 1), 0.0f);
  EXPECT_EQ(brume::perlin_worley_noise({ 0, far, 0 }, 1), 0.0f);
  brume::NoiseOctaves none;
  none.count = 0;
  EXPECT_EQ(brume::perlin_worley_noise({ 0.3, 0.2, 0.1 }, 1, none), 0.0f);
}

TEST(Noise, WarpMovesByNoMoreThanItsAmplitude)
{
  double farthest = 0.0;
  for (int n = 0; n < 20000; ++n)
  {
    const dvec3 p = random_place(n);
    const dvec3 moved = brume::warp(p, 3.0, 0.5, 4) - p;
    for (int a = 0; a < 3; ++a)
    {
      farthest = std::max(farthest, std::fabs(moved[a]));
    }
  }
  EXPECT_LE(farthest, 0.5 + 1e-9);
  EXPECT_GT(farthest, 0.3);
  EXPECT_EQ(brume::warp({ 1, 2, 3 }, 0.0, 0.5, 4), dvec3(1, 2, 3));
}

// The same bits as on the machine where these were written down. A change here changes every
// generated volume: make it on purpose, and say so in CHANGELOG.md.
TEST(Noise, HasTheSameBitsEverywhere)
{
  EXPECT_EQ(
    fingerprint([](const dvec3& p) { return brume::perlin_noise(p, 1); }), 3578823019006225644ull);
  EXPECT_EQ(
    fingerprint([](const dvec3& p) { return brume::worley_noise(p, 1); }), 2003843732513936470ull);
  EXPECT_EQ(fingerprint([](const dvec3& p) { return brume::fbm(brume::warp(p, 3, 1, 2), 1); }),
    646357105422222724ull);
  EXPECT_EQ(
    fingerprint([](const dvec3& p) { return brume::simplex_noise(p, 1); }), 2215778533023660991ull);
  EXPECT_EQ(fingerprint([](const dvec3& p) { return brume::perlin_worley_noise(p, 1); }),
    11744880916540874812ull);
}

TEST(Random, LogarithmAgreesWithTheLibrarys)
{
  for (double x :
    { 1e-300, 1e-10, 0.3, 0.70710678, 0.99999, 1.0, 1.4142135, 1.4142136, 7.0, 1e200 })
  {
    EXPECT_NEAR(brume::portable_log(x), std::log(x), 1e-12 * std::max(1.0, std::fabs(std::log(x))))
      << x;
  }
}

TEST(Random, NormalDeviatesInvertTheNormalDistribution)
{
  for (std::uint32_t h : { 0u,
         1000u,
         1u << 20,
         1u << 28,
         1u << 30,
         0x7fffffffu,
         0xc0000000u,
         0xf0000000u,
         0xffffff00u,
         0xffffffffu })
  {
    const double p = (h + 0.5) / 4294967296.0;
    const double x = brume::unit_normal(h);
    const double tail =
      p < 0.5 ? 0.5 * std::erfc(-x / std::sqrt(2.0)) : 0.5 * std::erfc(x / std::sqrt(2.0));
    const double expected = p < 0.5 ? p : 1.0 - p;
    EXPECT_NEAR(tail / expected, 1.0, 3e-5) << h;
  }
}
