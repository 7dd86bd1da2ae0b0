// What paths are made of: random numbers, directions, the walk through bricks, errors summed up.
#include "Transport/path_bricks.h"
#include "Transport/path_error.h"
#include "Transport/phase_sampler.h"
#include "Transport/random_stream.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <vector>

using namespace brume;

// Known answers of the authors' own Random123 (kat_vectors, philox4x32 10).
TEST(RandomStream, IsPhilox)
{
  using Words = RandomStream::Words;
  EXPECT_EQ(RandomStream::block(Words{ 0, 0, 0, 0 }, { 0, 0 }),
    (Words{ 0x6627e8d5u, 0xe169c58du, 0xbc57ac4cu, 0x9b00dbd8u }));
  EXPECT_EQ(RandomStream::block(Words{ ~0u, ~0u, ~0u, ~0u }, { ~0u, ~0u }),
    (Words{ 0x408f276du, 0x41c83b0eu, 0xa20bc7c6u, 0x6d5451fdu }));
  EXPECT_EQ(RandomStream::block(
              Words{ 0x243f6a88u, 0x85a308d3u, 0x13198a2eu, 0x03707344u }, { 0xa4093822u, 0x299f31d0u }),
    (Words{ 0xd16cfe09u, 0x94fdccebu, 0x5001e420u, 0x24126ea1u }));
}

TEST(RandomStream, StreamsDifferAndRepeat)
{
  std::set<std::uint32_t> seen;
  for (std::uint32_t seed : { 1u, 2u })
    for (std::uint64_t pixel : { std::uint64_t(0), std::uint64_t(1), std::uint64_t(1) << 33 })
      for (std::uint32_t sample : { 0u, 1u })
      {
        RandomStream a(seed, pixel, sample);
        RandomStream b(seed, pixel, sample);
        for (int i = 0; i < 9; ++i)
        {
          const std::uint32_t bits = a.bits();
          EXPECT_EQ(bits, b.bits());
          EXPECT_TRUE(seen.insert(bits).second);
        }
      }
  RandomStream stream(7, 3, 5);
  double sum = 0.0;
  for (int i = 0; i < 100000; ++i)
  {
    const double u = stream.uniform();
    ASSERT_GT(u, 0.0);
    ASSERT_LT(u, 1.0);
    sum += u;
  }
  EXPECT_NEAR(sum / 1e5, 0.5, 4.0 / std::sqrt(12e5));
}

// Drawn directions have the density that value() tells: their mean cosine and their histogram.
// Of eight samples that follow one another one in each eighth, in another order each time; all else is
// what it is without.
TEST(RandomStream, FirstNumbersAreStratified)
{
  constexpr int strata = RandomStream::strata;
  int orders[strata] = {};
  double sum = 0.0;
  for (std::uint32_t group = 0; group < 4000; ++group)
  {
    unsigned met = 0;
    for (std::uint32_t i = 0; i < strata; ++i)
    {
      RandomStream stratified(3, 17, strata * group + i);
      RandomStream plain(3, 17, strata * group + i);
      stratified.stratify();
      const double u = stratified.uniform();
      const int part = static_cast<int>(u * strata);
      met |= 1u << part;
      orders[part] += i == 0;
      sum += u * strata - part;
      plain.bits();
      for (int k = 0; k < 9; ++k)
      {
        ASSERT_EQ(stratified.bits(), plain.bits());
      }
    }
    ASSERT_EQ(met, (1u << strata) - 1u);
  }
  for (int count : orders)
  {
    EXPECT_NEAR(count, 500, 5.0 * std::sqrt(500.0));
  }
  EXPECT_NEAR(sum / 32000.0, 0.5, 5.0 * std::sqrt(1.0 / 12.0 / 32000.0));
}

TEST(PhaseSampler, DrawsWhatItTells)
{
  const std::vector<std::vector<PhaseLobe>> mixtures{ {},
    { { PhaseFunction::Rayleigh, 1.0, 0.0 } },
    { { PhaseFunction::HenyeyGreenstein, 1.0, 0.6 } },
    { { PhaseFunction::HenyeyGreenstein, 1.0, -0.95 } },
    { { PhaseFunction::Schlick, 1.0, 0.5 } },
    { { PhaseFunction::Schlick, 1.0, -0.8 } },
    { { PhaseFunction::HenyeyGreenstein, 3.0, 0.8 }, { PhaseFunction::Isotropic, 1.0, 0.0 },
      { PhaseFunction::Schlick, 0.5, -0.3 } } };
  const glm::dvec3 from = glm::normalize(glm::dvec3(0.3, -0.5, -0.8));
  constexpr int bins = 20;
  constexpr int count = 200000;
  constexpr double pi = 3.14159265358979323846;
  for (std::size_t m = 0; m < mixtures.size(); ++m)
  {
    const PhaseSampler sampler(mixtures[m]);
    RandomStream random(11, m, 0);
    std::vector<int> histogram(bins, 0);
    for (int i = 0; i < count; ++i)
    {
      const glm::dvec3 to = sampler.sample(from, random);
      ASSERT_NEAR(glm::length(to), 1.0, 1e-12);
      const int bin = static_cast<int>((glm::dot(from, to) + 1.0) / 2.0 * bins);
      ++histogram[std::min(std::max(bin, 0), bins - 1)];
    }
    double chi_square = 0.0;
    double sum = 0.0;
    for (int b = 0; b < bins; ++b)
    {
      double expected = 0.0; // Simpson's rule in fine steps; forward peaks are steep
      constexpr int steps = 2000;
      for (int i = 0; i <= steps; ++i)
      {
        const double mu = -1.0 + 2.0 * (b + double(i) / steps) / bins;
        const double sine = std::sqrt(std::max(1.0 - mu * mu, 0.0));
        const glm::dvec3 across = glm::normalize(glm::cross(from, glm::dvec3(1.0, 0.0, 0.0)));
        const double weight = i == 0 || i == steps ? 1.0 : i % 2 ? 4.0 : 2.0;
        expected += weight * sampler.value(from, mu * from + sine * across);
      }
      expected *= 2.0 * pi * (2.0 / bins) / steps / 3.0;
      sum += expected;
      const double n = expected * count;
      chi_square += (histogram[b] - n) * (histogram[b] - n) / std::max(n, 1.0);
    }
    EXPECT_NEAR(sum, 1.0, 1e-6) << m;
    EXPECT_LT(chi_square, 55.0) << m; // of 19 degrees of freedom: once in 10⁴
  }
}

TEST(PhaseSampler, StaysItselfNearOne)
{
  for (const double g : { 0.9999, -0.9999, 0.5, 1e-7 })
  {
    const PhaseSampler sampler({ { PhaseFunction::HenyeyGreenstein, 1.0, g } });
    RandomStream random(3, 0, 0);
    const glm::dvec3 from(0.0, 0.0, -1.0);
    double sum = 0.0;
    for (int i = 0; i < 100000; ++i)
    {
      const glm::dvec3 to = sampler.sample(from, random);
      ASSERT_TRUE(std::isfinite(to.x + to.y + to.z));
      sum += glm::dot(from, to);
    }
    EXPECT_NEAR(sum / 1e5, g, 4.0 / std::sqrt(3e5));
  }
}

namespace
{

/// Every so many bricks hold anything; `cells`: every other of these a third of its cells.
PathBricks some_bricks(int nx, int ny, int nz, int every, bool cells)
{
  PathBricks bricks;
  const int dims[3] = { nx, ny, nz };
  std::copy(dims, dims + 3, bricks.dims);
  BrickRanges ranges;
  std::copy(dims, dims + 3, ranges.dims);
  for (int i = 0; i < nx * ny * nz; ++i)
  {
    const bool seen = every > 0 && (i * 7 + i / 5) % every == 0;
    bricks.rate.push_back(seen ? 1.0 : 0.0);
    if (cells)
    {
      const bool split = seen && i % 2 == 0;
      bricks.first_cell.push_back(split ? static_cast<int>(bricks.cell_rate.size()) : -1);
      for (int cell = 0; split && cell < 512; ++cell)
      {
        bricks.cell_rate.push_back((cell * 5 + cell / 7) % 3 == 0 ? 0.5 : 0.0);
        bricks.cell_least.push_back(0.0);
      }
    }
    bricks.least.push_back(0.0);
    ranges.minimum.push_back(0.0f);
    ranges.maximum.push_back(seen ? 1.0f : 0.0f);
  }
  bricks.distance =
    find_visible_bricks(ranges, [](float, float upper) { return upper > 0.0f; }, 0.0f).distance;
  return bricks;
}

/// The rate of the brick or cell that holds a place.
double rate_at(const PathBricks& bricks, const glm::dvec3& place)
{
  std::size_t brick = 0;
  std::size_t cell = 0;
  for (int axis = 2; axis >= 0; --axis)
  {
    const int b =
      std::min(std::max(static_cast<int>(std::floor(place[axis] / 8.0)), 0), bricks.dims[axis] - 1);
    const int c = std::min(std::max(static_cast<int>(std::floor(place[axis])) - 8 * b, 0), 7);
    brick = brick * bricks.dims[axis] + b;
    cell = cell * 8 + c;
  }
  const int first = bricks.has_cells() ? bricks.first_cell[brick] : -1;
  return first < 0 ? bricks.rate[brick] : bricks.cell_rate[first + cell];
}

}

// Every place of a ray that is in a brick of a rate above 0, and no other, is in one of its stretches,
// which follow one another; whatever the ray's direction. In cells the outer half voxel belongs, too.
TEST(BrickWalk, MeetsWhatThereIs)
{
  for (int kind : { 1, 3, 11, 60, 0, -1, -3, -11 })
  {
    const int every = std::abs(kind);
    const PathBricks bricks = some_bricks(5, 4, 6, every, kind < 0);
    RandomStream random(5, every, 0);
    for (int n = 0; n < 3000; ++n)
    {
      glm::dvec3 begin, along;
      for (int axis = 0; axis < 3; ++axis)
      {
        begin[axis] = -0.5 + random.uniform() * (8.0 * bricks.dims[axis] + 1.0);
        along[axis] = 2.0 * random.uniform() - 1.0;
        const std::uint32_t kind = random.bits() % 6;
        along[axis] = kind == 0 ? 0.0 : kind == 1 ? -0.0 : along[axis];
        begin[axis] = kind == 2 ? 8.0 * std::floor(std::max(begin[axis], 0.0) / 8.0) : begin[axis]; // on a border
      }
      if (glm::length(along) == 0.0)
      {
        along.x = 1.0;
      }
      double to = 1e9;
      for (int axis = 0; axis < 3; ++axis)
      {
        const double end = along[axis] > 0.0 ? 8.0 * bricks.dims[axis] + 0.5 : -0.5;
        to = along[axis] != 0.0 ? std::min(to, (end - begin[axis]) / along[axis]) : to;
      }
      BrickWalk walk(bricks, begin, along, 0.0, to);
      std::vector<std::pair<double, double>> stretches;
      double last = 0.0;
      while (walk.next())
      {
        ASSERT_LT(walk.from(), walk.to());
        ASSERT_GE(walk.from(), last);
        ASSERT_LE(walk.to(), to);
        const glm::dvec3 middle = begin + 0.5 * (walk.from() + walk.to()) * along;
        if (walk.to() - walk.from() > 1e-9)
        {
          ASSERT_EQ(walk.rate(), rate_at(bricks, middle)) << kind << ", ray " << n;
        }
        last = walk.to();
        stretches.emplace_back(walk.from(), walk.to());
        ASSERT_LT(stretches.size(), 200u);
      }
      for (int i = 0; i < 50; ++i)
      {
        const double t = to * random.uniform();
        const glm::dvec3 place = begin + t * along;
        bool near_border = false;
        for (int axis = 0; axis < 3; ++axis)
        {
          near_border |= std::abs(place[axis] - std::round(place[axis])) < 1e-8;
        }
        if (near_border)
        {
          continue; // either brick
        }
        const bool met = std::any_of(stretches.begin(), stretches.end(),
          [t](const auto& s) { return s.first <= t && t <= s.second; });
        ASSERT_EQ(met, rate_at(bricks, place) > 0.0) << kind << ", ray " << n << " at " << t;
      }
    }
  }
}

TEST(PathError, IsThatOfNormalErrors)
{
  PathError alike;
  const double one[3] = { 0.25, 1.0, 0.0 };
  for (int i = 0; i < 1000; ++i)
  {
    alike.add(one);
  }
  EXPECT_NEAR(alike.quantile(), 3.2905, 0.04); // of a normal distribution: 99.9 % on both sides
  EXPECT_NEAR(alike.rms(), std::sqrt(1.25 / 3.0), 1e-9);
  PathError nothing;
  const double zero[3] = { 0.0, 0.0, 0.0 };
  nothing.add(zero);
  EXPECT_EQ(nothing.quantile(), 0.0);
  const double none[3] = { std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0 };
  nothing.add(none);
  EXPECT_TRUE(std::isinf(nothing.quantile()));
}
