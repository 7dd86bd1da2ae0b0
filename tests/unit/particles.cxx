// Particles that are emitted, carried and faded, and the voxels made of them: closed forms, what is
// kept, and the same bytes whatever the order of moments, the threads and the pieces.
#include "data-generators/flow.h"
#include "data-generators/particles.h"
#include "data-generators/portable_math.h"
#include "data-generators/random.h"
#include "data-generators/sparse_sampling.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <vector>

namespace
{

using brume::Particle;
using glm::dvec3;

double random_number(int n)
{
  return brume::mix_bits(0x7f4a7c15u + n) / 4294967296.0;
}

dvec3 random_place(int n, double half)
{
  return half *
         (2.0 * dvec3(random_number(3 * n), random_number(3 * n + 1), random_number(3 * n + 2)) -
           1.0);
}

bool same_bytes(const std::vector<Particle>& a, const std::vector<Particle>& b)
{
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Particle)) == 0;
}

std::vector<float> voxels(const std::vector<Particle>& particles,
  const brume::Lattice& grid,
  const brume::Extent& extent)
{
  std::vector<float> values(extent.voxels(), -1.0f);
  EXPECT_TRUE(brume::deposit(particles, grid, extent, values.data()));
  return values;
}

std::vector<float> voxels(const std::vector<Particle>& particles, const brume::Lattice& grid)
{
  return voxels(particles, grid, brume::whole_extent(grid));
}

double total(const std::vector<float>& values)
{
  double sum = 0.0;
  for (const float v : values)
  {
    sum += v;
  }
  return sum;
}

brume::Lattice cube_grid(double half, int size)
{
  return brume::grid_over({ dvec3(-half), dvec3(half) }, size);
}

brume::ParticleCloudOptions few()
{
  brume::ParticleCloudOptions options;
  options.emitters.front().rate = 200.0;
  return options;
}

}

TEST(Flow, HasNoDivergence)
{
  const brume::Flow flow;
  const double h = 1e-4;
  for (int n = 0; n < 200; ++n)
  {
    const dvec3 p = random_place(n, 5.0);
    double divergence = 0.0, turning = 0.0;
    for (int a = 0; a < 3; ++a)
    {
      dvec3 e(0.0);
      e[a] = h;
      const dvec3 slope = (flow.velocity(p + e, 1.3) - flow.velocity(p - e, 1.3)) / (2.0 * h);
      divergence += slope[a];
      turning += glm::length(slope);
    }
    EXPECT_NEAR(divergence, 0.0, 1e-5 * turning);
  }
}

TEST(Flow, HasItsSpeedAndItsWind)
{
  brume::FlowOptions options;
  options.wind = { 2.0, -1.0, 0.5 };
  options.turbulence = 0.7;
  for (std::uint32_t seed : { 1u, 2u, 3u })
  {
    options.seed = seed;
    const brume::Flow flow(options);
    dvec3 mean(0.0);
    double square = 0.0;
    const int places = 20000;
    for (int n = 0; n < places; ++n)
    {
      const dvec3 u =
        flow.velocity(random_place(n, 500.0), 100.0 * random_number(n)) - options.wind;
      mean += u / double(places);
      square += glm::dot(u, u) / places;
    }
    EXPECT_NEAR(glm::length(mean), 0.0, 4.0 * 0.7 / std::sqrt(double(places)));
    EXPECT_NEAR(std::sqrt(square), 0.7, 0.02);
  }
  options.turbulence = 0.0;
  EXPECT_EQ(brume::Flow(options).velocity({ 1, 2, 3 }, 4.0), options.wind);
  options.eddy_size = 0.0;
  EXPECT_THROW(brume::Flow{ options }, std::invalid_argument);
}

TEST(Particles, MoveAsTheClosedFormSays)
{
  // Still air: v falls off as exp(-t/response), the place nears start + v response.
  brume::ParticleCloudOptions options = few();
  options.flow.turbulence = 0.0;
  options.rise = 0.0;
  options.response = 0.8;
  options.step = 0.001;
  options.growth = 0.0;
  brume::Emitter& emitter = options.emitters.front();
  emitter.radius = 0.0;
  emitter.spread = 0.0;
  emitter.place = { 1.0, 2.0, 3.0 };
  emitter.velocity = { 2.0, -1.0, 4.0 };
  const std::vector<Particle> particles = brume::ParticleCloud(options).particles(4.0);
  ASSERT_GT(particles.size(), 200u);
  for (const Particle& p : particles)
  {
    // Which age has this height? The others must agree with it.
    const double gone = (p.place.z - 3.0) / (4.0 * 0.8);
    ASSERT_GE(gone, 0.0);
    ASSERT_LE(gone, 1.0 - std::exp(-5.0 / 0.8) + 1e-3);
    EXPECT_NEAR(p.place.x, 1.0 + 2.0 * 0.8 * gone, 1e-12);
    EXPECT_NEAR(p.place.y, 2.0 - 1.0 * 0.8 * gone, 1e-12);
  }
  // The first one alive after a time: its age is known to within one birth.
  emitter.rate = 1.0;
  options.life = 100.0;
  const std::vector<Particle> one = brume::ParticleCloud(options).particles(1.0);
  const std::vector<Particle> later = brume::ParticleCloud(options).particles(1.5);
  ASSERT_GE(one.size(), 1u);
  const auto age_of = [](const Particle& p)
  { return -0.8 * std::log(1.0 - (p.place.z - 3.0) / 3.2); };
  EXPECT_NEAR(age_of(later.front()) - age_of(one.front()), 0.5, 1e-3);
}

TEST(Particles, AreBornAndDieAtTheirRate)
{
  brume::ParticleCloudOptions options;
  options.emitters.front().rate = 4000.0;
  options.emitters.front().start = 1.0;
  options.emitters.front().stop = 20.0;
  options.life = 2.0;
  options.flow.turbulence = 0.0;
  const brume::ParticleCloud cloud(options);
  EXPECT_TRUE(cloud.particles(0.999).empty());
  EXPECT_TRUE(cloud.particles(-1e9).empty());
  EXPECT_TRUE(cloud.particles(22.1).empty());
  EXPECT_TRUE(cloud.particles(1e300).empty());
  EXPECT_TRUE(cloud.particles(std::nan("")).empty());
  // Lives are 0.6 to 1 times 2 s, evenly: 1.6 s in the mean, and so many are alive.
  EXPECT_NEAR(cloud.particles(10.0).size(), 4000 * 1.6, 4.0 * std::sqrt(4000.0 * 0.4));
  EXPECT_NEAR(cloud.particles(1.5).size(), 2000.0, 2.0);
  options.emitters.push_back(options.emitters.front());
  options.emitters.back().place.x = 3.0;
  const std::vector<Particle> two = brume::ParticleCloud(options).particles(10.0);
  EXPECT_NEAR(two.size(), 2 * 4000 * 1.6, 8.0 * std::sqrt(4000.0 * 0.4));
  EXPECT_NE(two.front().place.z, two[two.size() / 2].place.z)
    << "each emitter has numbers of its own";
}

TEST(Particles, AMomentIsTheSameWhateverWasAskedBefore)
{
  const brume::ParticleCloud cloud(few());
  const std::vector<Particle> at_7 = cloud.particles(7.0);
  const std::vector<Particle> at_3 = cloud.particles(3.0);
  EXPECT_FALSE(same_bytes(at_7, at_3));
  EXPECT_TRUE(same_bytes(cloud.particles(7.0), at_7));
  EXPECT_TRUE(same_bytes(brume::ParticleCloud(few()).particles(3.0), at_3));
  {
    tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    EXPECT_TRUE(same_bytes(cloud.particles(7.0), at_7));
  }
  brume::ParticleCloudOptions other = few();
  other.seed = 2;
  EXPECT_FALSE(same_bytes(brume::ParticleCloud(other).particles(7.0), at_7));
}

TEST(Particles, TellHowFarTheyAreAndStop)
{
  brume::ParticleCloudOptions options;
  options.emitters = { {} };
  options.emitters[0].rate = 10000.0;
  options.life = 2.0;
  const brume::ParticleField field(
    options, { glm::dvec3(-3.0, -3.0, 0.0), glm::dvec3(3.0, 3.0, 6.0) }, 0.05);
  std::vector<double> parts;
  EXPECT_FALSE(field.prepare(3.0,
    [&](double done)
    {
      parts.push_back(done);
      return parts.size() < 3;
    }));
  EXPECT_EQ(parts.size(), 3u);
  parts.clear();
  EXPECT_TRUE(field.prepare(3.0,
    [&](double done)
    {
      parts.push_back(done);
      return true;
    }));
  ASSERT_GT(parts.size(), 5u);
  EXPECT_TRUE(std::is_sorted(parts.begin(), parts.end()));
  EXPECT_EQ(parts.back(), 1.0);
  EXPECT_EQ(field.particles(3.0)->size(),
    brume::ParticleField(options, field.bounds(), 0.05).particles(3.0)->size());
}

TEST(Particles, HaveTheSameBytesEverywhere)
{
  const brume::Lattice grid = brume::grid_over({ { -3, -3, -1 }, { 3, 3, 5 } }, 32);
  const std::vector<float> values = voxels(brume::ParticleCloud(few()).particles(4.0), grid);
  std::uint64_t hash = 0xcbf29ce484222325ull;
  const auto* bytes = reinterpret_cast<const unsigned char*>(values.data());
  for (std::size_t n = 0; n < values.size() * sizeof(float); ++n)
  {
    hash = (hash ^ bytes[n]) * 0x100000001b3ull;
  }
  EXPECT_EQ(hash, 4354542013327920541ull);
}

TEST(Particles, RefuseOptionsThatMakeNone)
{
  const auto refused = [](void (*change)(brume::ParticleCloudOptions&))
  {
    brume::ParticleCloudOptions options;
    change(options);
    EXPECT_THROW(brume::ParticleCloud{ options }, std::invalid_argument);
  };
  refused([](brume::ParticleCloudOptions& o) { o.life = 0.0; });
  refused([](brume::ParticleCloudOptions& o) { o.radius = -1.0; });
  refused([](brume::ParticleCloudOptions& o) { o.response = std::nan(""); });
  refused([](brume::ParticleCloudOptions& o) { o.step = 1e-9; });
  refused([](brume::ParticleCloudOptions& o) { o.emitters.front().rate = 1e9; });
  refused(
    [](brume::ParticleCloudOptions& o)
    {
      o.emitters.front().rate = 100.0; // 1e6 alive at once, 2.5e5 steps each
      o.life = 1e4;
    });
  refused([](brume::ParticleCloudOptions& o) { o.emitters.front().place.y = std::nan(""); });
}

TEST(Deposit, FallsFromTheCentreToTheRim)
{
  const brume::Lattice grid = cube_grid(1.0, 33); // a voxel stands at the origin
  const Particle ball{ dvec3(0.0), 0.7, 2.0 };
  const std::vector<float> values = voxels({ ball }, grid);
  double last = 1e9;
  for (int i = 16; i < 33; ++i)
  {
    const double d = grid.place(i, 16, 16).x;
    const double value = values[(16 * 33 + 16) * 33 + i];
    const double t = std::max(1.0 - d * d / 0.49, 0.0);
    EXPECT_NEAR(value, 2.0 * t * t, 1e-6) << "at " << d;
    EXPECT_TRUE(value < last || value == 0.0) << "at " << d;
    last = value;
  }
  EXPECT_EQ(values[(16 * 33 + 16) * 33 + 16], 2.0f);
}

TEST(Deposit, KeepsWhatParticlesHold)
{
  const brume::Lattice grid = cube_grid(1.0, 40); // voxels of 0.05
  for (double radius : { 0.004, 0.06, 0.13, 0.4 })
  {
    std::vector<Particle> particles;
    double held = 0.0;
    for (int n = 0; n < 50; ++n)
    {
      particles.push_back({ random_place(n, 0.55), radius, 0.5 + random_number(n) });
      held += brume::amount_of(particles.back());
    }
    const double found = total(voxels(particles, grid)) * 0.05 * 0.05 * 0.05;
    EXPECT_NEAR(found / held, 1.0, radius > 0.1 ? 0.005 : 0.03) << "radius " << radius;
  }
  const Particle one{ dvec3(0.0), 2.0, 3.0 };
  EXPECT_NEAR(brume::amount_of(one), 3.0 * 8.0 * 32.0 * brume::pi / 105.0, 1e-12);
}

TEST(Deposit, IsTheSumOfAllParticles)
{
  const brume::Lattice grid = cube_grid(1.0, 21);
  std::vector<Particle> particles;
  for (int n = 0; n < 60; ++n)
  {
    particles.push_back(
      { random_place(n, 1.4), 0.2 + 0.5 * random_number(n), random_number(n + 999) });
  }
  const std::vector<float> values = voxels(particles, grid);
  for (int k = 0; k < 21; ++k)
    for (int j = 0; j < 21; ++j)
      for (int i = 0; i < 21; ++i)
      {
        double sum = 0.0;
        for (const Particle& p : particles)
        {
          const dvec3 d = (grid.place(i, j, k) - p.place) / p.radius;
          const double t = std::max(1.0 - glm::dot(d, d), 0.0);
          sum += p.peak * t * t;
        }
        ASSERT_NEAR(values[(k * 21 + j) * 21 + i], sum, 1e-6) << i << ' ' << j << ' ' << k;
      }
}

TEST(Deposit, NeitherThreadsNorPiecesChangeAByte)
{
  const brume::Lattice grid = brume::grid_over({ { -2, -2, -1 }, { 2, 2, 3 } }, 45);
  const std::vector<Particle> particles = brume::ParticleCloud(few()).particles(5.0);
  const std::vector<float> whole = voxels(particles, grid);
  EXPECT_GT(total(whole), 1.0);
  {
    tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    EXPECT_EQ(voxels(particles, grid), whole);
  }
  const int cuts[4] = { 0, 13, 30, 45 };
  for (int c = 0; c < 27; ++c)
  {
    const int at[3] = { c % 3, c / 3 % 3, c / 9 };
    brume::Extent piece;
    for (int a = 0; a < 3; ++a)
    {
      piece.first[a] = cuts[at[a]];
      piece.last[a] = cuts[at[a] + 1] - 1;
    }
    const std::vector<float> part = voxels(particles, grid, piece);
    std::size_t n = 0;
    for (int k = piece.first.z; k <= piece.last.z; ++k)
      for (int j = piece.first.y; j <= piece.last.y; ++j)
        for (int i = piece.first.x; i <= piece.last.x; ++i, ++n)
        {
          ASSERT_EQ(part[n], whole[(k * 45 + j) * 45 + i]);
        }
  }
}

TEST(Deposit, DoesNotOverflow)
{
  // A fixed-point sum of 32 bits would be full after 4000 of these at 20 bits after the point.
  const brume::Lattice grid = cube_grid(1.0, 9);
  const std::vector<Particle> heap(200000, Particle{ dvec3(0.0), 0.5, 1.0 });
  EXPECT_EQ(voxels(heap, grid)[(4 * 9 + 4) * 9 + 4], 200000.0f);
}

TEST(Deposit, LeavesOutWhatIsNowhere)
{
  const brume::Lattice grid = cube_grid(1.0, 16);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double endless = std::numeric_limits<double>::infinity();
  const std::vector<Particle> odd{ { { 1e300, 0, 0 }, 0.1, 1.0 },
    { { 0, nan, 0 }, 0.1, 1.0 },
    { { 0, 0, 0 }, nan, 1.0 },
    { { 0, 0, 0 }, -1.0, 1.0 },
    { { 0, 0, 0 }, 0.1, endless },
    { { 0, 0, 7.0 }, 0.1, 1.0 } };
  for (const float v : voxels(odd, grid))
  {
    ASSERT_EQ(v, 0.0f);
  }
  EXPECT_EQ(total(voxels({}, grid)), 0.0);
  brume::Lattice flat = grid;
  flat.spacing.z *= 2.0;
  std::vector<float> out(16 * 16 * 16);
  EXPECT_THROW(
    brume::deposit(odd, flat, brume::whole_extent(flat), out.data()), std::invalid_argument);
}

TEST(Deposit, ReportsProgressAndStops)
{
  const brume::Lattice grid = cube_grid(1.0, 64);
  std::vector<float> out(64 * 64 * 64);
  int calls = 0;
  EXPECT_FALSE(brume::deposit({ { dvec3(0.0), 1.0, 1.0 } },
    grid,
    brume::whole_extent(grid),
    out.data(),
    [&](double) { return ++calls < 3; }));
  EXPECT_EQ(calls, 3);
}

TEST(ParticleField, HasTheBitsOfTheDeposit)
{
  const brume::Box box{ { -2, -2, -1 }, { 2, 2, 3 } };
  const brume::Lattice grid = brume::grid_over(box, 40);
  const double least = 1.5 * grid.spacing.x;
  const brume::ParticleField field(few(), box, least);
  for (double time : { 5.0, 2.0 })
  {
    const std::vector<float> gathered = voxels(brume::ParticleCloud(few()).particles(time), grid);
    EXPECT_GT(total(gathered), 1.0);
    std::vector<float> sampled(gathered.size());
    EXPECT_TRUE(brume::sample(field, time, grid, brume::whole_extent(grid), sampled.data()));
    EXPECT_EQ(sampled, gathered);
    for (int n = 0; n < 300; ++n)
    {
      const glm::ivec3 v(
        random_number(n) * 40, random_number(n + 300) * 40, random_number(n + 600) * 40);
      EXPECT_EQ(
        field.value(grid.place(v.x, v.y, v.z), time), gathered[(v.z * 40 + v.y) * 40 + v.x]);
    }
  }
  EXPECT_TRUE(brume::sample_sparse(field, -1.0, grid).voxels == nullptr) << "nothing was born yet";
}

TEST(ParticleField, ItsBoundsHoldAndLeaveTheEmptyOut)
{
  const brume::Box box{ dvec3(-3.0), dvec3(3.0) };
  const brume::ParticleField field(few(), box, 0.1);
  int empty = 0;
  for (int n = 0; n < 800; ++n)
  {
    const dvec3 centre = random_place(2 * n, 3.2);
    const dvec3 half = glm::abs(random_place(2 * n + 1, 0.3));
    const brume::FieldRange range = field.range_in({ centre - half, centre + half }, 4.0);
    empty += range.upper == 0.0f;
    for (int m = 0; m < 20; ++m)
    {
      const float value = field.value(centre + half * random_place(30 * n + m, 1.0), 4.0);
      ASSERT_GE(value, range.lower);
      ASSERT_LE(value, range.upper);
    }
  }
  EXPECT_GT(empty, 400);
  EXPECT_LT(empty, 790);
  EXPECT_EQ(field.value({ 0, 0, std::nan("") }, 4.0), 0.0f);
  EXPECT_THROW(brume::ParticleField(few(), { dvec3(1.0), dvec3(0.0) }, 0.1), std::invalid_argument);
  EXPECT_THROW(brume::ParticleField(few(), box, -1.0), std::invalid_argument);
}
