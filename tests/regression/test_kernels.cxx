// The kernels against themselves and against the slow double-precision path: SIMD targets, threads,
// space leaping, leaving early, non-finite voxels, the ends of the voxels' memory, caches, abort.
#include "../support/transport_scenes.h"

#include "Transport/reference.h"

#include <gtest/gtest.h>

#include <sys/mman.h>
#include <unistd.h>

#include <cstring>
#include <limits>
#include <random>

using namespace transport_scenes;

namespace
{

constexpr int width = 37; // no multiple of a packet
constexpr int height = 29;

/// A smooth ball with bumps, in [0, 100].
double ball(double x, double y, double z)
{
  const double r = std::sqrt(x * x + y * y + z * z);
  const double bumps = 0.08 * std::sin(9.0 * x) * std::sin(8.0 * y) * std::sin(7.0 * z);
  return 100.0 / (1.0 + std::exp(14.0 * (r + bumps - 0.7)));
}

template <class T>
Voxels<T> ball_voxels()
{
  const double shift = std::is_signed_v<T> ? -30.0 : 0.0;
  return Voxels<T>(27, 22, 19, [&](int i, int j, int k)
    { return ball(i / 13.0 - 1.0, j / 10.5 - 1.0, k / 9.0 - 1.0) + shift; });
}

Voxels<std::uint8_t> rgba_voxels()
{
  return Voxels<std::uint8_t>(27, 22, 19, [](int i, int j, int k, int c)
    { return c == 3 ? ball(i / 13.0 - 1.0, j / 10.5 - 1.0, k / 9.0 - 1.0)
                    : 127.0 + 120.0 * std::sin(0.3 * (i + c * j) + k); });
}

template <class T>
Scene ball_scene(const Voxels<T>& voxels, bool perspective = true)
{
  Scene scene;
  scene.volumes[0].grid = voxels.grid();
  scene.volumes[0].data_from_index =
    placed(glm::dvec3(0.8, 1.0, 1.3), glm::dvec3(4.0, -9.0, 100.0));
  scene.volumes[0].world_from_data = glm::rotate(glm::dmat4(1.0), 0.4, glm::dvec3(1.0, 2.0, -0.5));
  const double shift = std::is_signed_v<T> ? -30.0 : 0.0;
  scene.volumes[0].classification = classify(
    shift,
    100.0 + shift,
    [&](double v)
    {
      const double u = (v - shift) / 100.0;
      return u < 0.1 ? 0.0 : 0.6 * (u - 0.1) * (u - 0.1); // smooth: a jump would show the table
    },
    [&](double v)
    {
      const double u = (v - shift) / 100.0;
      return glm::dvec3(u, 1.0 - 0.5 * u, 0.3 + 0.4 * std::sin(5.0 * u));
    },
    4097);
  scene.volumes[0].classification.unit_distance = 2.0;
  if (voxels.components == 4)
  {
    scene.volumes[0].classification.rgb.clear();
  }
  scene.camera = view_of(scene, glm::dvec3(-0.5, 0.3, -0.9), !perspective)
                   .camera(double(width) / height);
  return scene;
}

void add_shading(Scene& scene)
{
  scene.volumes[0].shading.enabled = true;
  const glm::dvec3 centre(scene.volumes[0].world_from_data * scene.volumes[0].data_from_index *
                          glm::dvec4(13.0, 10.0, 9.0, 1.0));
  Light sun;
  sun.direction = glm::normalize(glm::dvec3(0.2, -1.0, -0.4));
  sun.diffuse = { 1.0, 0.9, 0.8 };
  Light lamp;
  lamp.positional = true;
  lamp.position = centre + glm::dvec3(15.0, 8.0, 20.0);
  lamp.direction = glm::normalize(centre - lamp.position);
  lamp.attenuation = { 0.5, 0.02, 0.001 };
  Light spot = lamp;
  spot.position = centre + glm::dvec3(-20.0, 10.0, 5.0);
  spot.direction = glm::normalize(centre - spot.position);
  spot.cone_angle = 80.0; // wider than the ball: its rim is a jump
  spot.exponent = 3.0;
  scene.lights = { sun, lamp, spot };
}

void add_gradient_opacity(Scene& scene)
{
  for (int i = 0; i <= 1000; ++i)
  {
    scene.volumes[0].classification.gradient_opacity.push_back(std::min(1.0, i / 500.0));
  }
  scene.volumes[0].classification.gradient_upper = 30.0;
  scene.volumes[0].classification.gradient_scale = glm::dvec3(0.8, 1.0, 1.3) / 1.0333;
}

/// What differs between two pictures that rounding alone sets apart. Where a nearest voxel's border
/// is met exactly, or nearly, a sample may fall on either side: few pixels, judged by the mean.
void expect_same_picture(const Film& a, const Film& b, double tolerance, bool jumps)
{
  if (!jumps)
  {
    EXPECT_LE(difference(a, b), tolerance);
    return;
  }
  std::size_t apart = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    double most = 0.0;
    for (int c = 0; c < 3; ++c)
    {
      most = std::max({ most, double(std::abs(a.radiance[c][i] - b.radiance[c][i])),
        double(std::abs(a.transmittance[c][i] - b.transmittance[c][i])) });
    }
    apart += !(most <= tolerance);
  }
  EXPECT_LE(apart, a.size() / 50);
  EXPECT_LE(difference(a, b), 0.05);
}

/// Every target against the double-precision path of the same steps.
void expect_all_targets_right(const Scene& scene, double tolerance = 1e-5)
{
  for (double step : { 0.45, 3.0 })
  {
    Film truth(width, height);
    render_fixed_step(scene, step, SamplePlacement::Middle, 0.0, 0, truth);
    for (const std::string& target : targets())
    {
      ASSERT_TRUE(force_simd_target(target));
      SCOPED_TRACE(target + ", step " + std::to_string(step));
      MarchStatistics statistics;
      const Film film = march(scene, width, height, step, 0.0, 0, &statistics);
      EXPECT_EQ(statistics.simd, target);
      expect_same_picture(film, truth, tolerance, !scene.volumes[0].grid.linear);
      force_simd_target("");
    }
  }
}

template <class T>
class Kernel : public testing::Test
{
};
using Types = testing::Types<std::uint8_t, std::int8_t, std::uint16_t, std::int16_t, float>;
TYPED_TEST_SUITE(Kernel, Types);

TYPED_TEST(Kernel, AgreesWithDoublePrecision)
{
  const Voxels<TypeParam> voxels = ball_voxels<TypeParam>();
  for (bool linear : { true, false })
  {
    for (bool cells : { false, true })
    {
      for (int effects = 0; effects < 4; ++effects)
      {
        Scene scene = ball_scene(voxels, !cells);
        scene.volumes[0].grid.linear = linear;
        scene.volumes[0].grid.cell_centred = cells;
        SCOPED_TRACE("linear " + std::to_string(linear) + ", cells " + std::to_string(cells) +
          ", effects " + std::to_string(effects));
        if (effects & 1)
        {
          add_shading(scene);
        }
        if (effects & 2)
        {
          add_gradient_opacity(scene);
        }
        // Shaded: pow(cos, 10) and normals of small gradients magnify rounding some tenfold.
        expect_all_targets_right(scene, effects & 1 ? 1e-4 : 2e-5);
      }
    }
  }
}

// Noise up to the grid's faces: no neighbour is like another, so each must be the right one.
TYPED_TEST(Kernel, AgreesForNoiseUpToTheFaces)
{
  std::mt19937 random(2);
  const Voxels<TypeParam> voxels(11, 10, 12, [&](int, int, int) { return random() % 100; });
  for (bool linear : { true, false })
  {
    Scene scene = ball_scene(voxels);
    scene.volumes[0].grid.linear = linear;
    scene.volumes[0].classification.lower = 0.0;
    scene.volumes[0].classification.upper = 100.0;
    expect_all_targets_right(scene, 1e-4); // a place's rounding times a slope of 100 a voxel
    scene.volumes[0].meaning = ValueMeaning::Density;
    scene.volumes[0].density.extinction = 0.002;
    expect_all_targets_right(scene, 2e-5);
  }
}

TYPED_TEST(Kernel, AgreesForDensities)
{
  const Voxels<TypeParam> voxels = ball_voxels<TypeParam>();
  Scene scene = ball_scene(voxels);
  scene.volumes[0].meaning = ValueMeaning::Density;
  scene.volumes[0].density.extinction = 0.002;
  expect_all_targets_right(scene);
}

TEST(Kernel, AgreesForColoursOfTheirOwn)
{
  const Voxels<std::uint8_t> voxels = rgba_voxels();
  for (bool linear : { true, false })
  {
    Scene scene = ball_scene(voxels);
    scene.volumes[0].grid.linear = linear;
    expect_all_targets_right(scene, 2e-5);
    add_shading(scene);
    add_gradient_opacity(scene);
    expect_all_targets_right(scene, 1e-4);
  }
}

TEST(Kernel, AgreesForThinGrids)
{
  for (const auto& n : { glm::ivec3(2, 1, 9), glm::ivec3(9, 1, 1), glm::ivec3(2, 9, 1),
         glm::ivec3(4, 2, 2) })
  {
    const Voxels<std::uint8_t> voxels(
      n.x, n.y, n.z, [](int i, int j, int k) { return 20 + 7 * i + 5 * j + 9 * k; });
    Scene scene;
    scene.volumes[0].grid = voxels.grid();
    scene.volumes[0].grid.cell_centred = true;
    scene.volumes[0].grid.padding_x = n.x == 2 ? 1 : 0;
    scene.volumes[0].classification = classify(
      0.0,
      120.0,
      [](double v) { return v / 150.0; },
      [](double v) { return glm::dvec3(v / 120.0); });
    scene.camera =
      view_of(scene, glm::dvec3(-0.5, 0.3, -0.9), false).camera(double(width) / height);
    expect_all_targets_right(scene, 2e-5);
    add_shading(scene);
    expect_all_targets_right(scene, 1e-4);
  }
}

TEST(Kernel, TakesNonFiniteVoxelsAsEmpty)
{
  Voxels<float> voxels = ball_voxels<float>();
  std::mt19937 random(1);
  const float bad[] = { std::numeric_limits<float>::quiet_NaN(),
    std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity() };
  for (int i = 0; i < 300; ++i)
  {
    voxels.values[random() % voxels.values.size()] = bad[i % 3];
  }
  Voxels<float> cleaned = voxels;
  for (float& v : cleaned.values)
  {
    v = std::isfinite(v) ? v : -30.0f; // the first value of no opacity
  }
  for (int effects = 0; effects < 2; ++effects)
  {
    Scene scene = ball_scene(voxels);
    Scene clean = ball_scene(cleaned);
    if (effects)
    {
      add_shading(scene);
      add_shading(clean);
    }
    MarchStatistics statistics;
    const Film film = march(scene, width, height, 0.5, 0.0, 0, &statistics);
    EXPECT_GT(statistics.non_finite_voxels, 200u);
    EXPECT_TRUE(all_finite(film));
    EXPECT_LE(difference(film, march(clean, width, height, 0.5)), 1e-6);
    expect_all_targets_right(scene, effects ? 1e-4 : 2e-5);
  }
  Scene density = ball_scene(voxels);
  density.volumes[0].meaning = ValueMeaning::Density;
  density.volumes[0].density.extinction = 0.01;
  EXPECT_TRUE(all_finite(march(density, width, height, 0.5)));
  expect_all_targets_right(density);
}

// No value, however large, makes a pixel that is not a number.
TEST(Kernel, SurvivesTheLargestFloats)
{
  Voxels<float> voxels = ball_voxels<float>();
  const float most = std::numeric_limits<float>::max();
  for (std::size_t i = 0; i < voxels.values.size(); i += 7)
  {
    voxels.values[i] = i % 2 ? most : -most;
  }
  Scene scene = ball_scene(voxels);
  add_shading(scene);
  for (const std::string& target : targets())
  {
    force_simd_target(target);
    EXPECT_TRUE(all_finite(march(scene, width, height, 0.5))) << target;
    scene.volumes[0].classification.lower = -most;
    scene.volumes[0].classification.upper = most;
    EXPECT_TRUE(all_finite(march(scene, width, height, 0.5))) << target;
    scene.volumes[0].meaning = ValueMeaning::Density;
    EXPECT_TRUE(all_finite(march(scene, width, height, 0.5))) << target;
    scene.volumes[0].meaning = ValueMeaning::Classified;
    scene.volumes[0].classification.lower = -30.0;
    scene.volumes[0].classification.upper = 70.0;
  }
  force_simd_target("");
}

/// Voxels whose last byte is the last of a page, with no memory behind it and none before the page
/// that they begin in.
template <class T>
struct FencedGrid
{
  Grid grid;
  void* memory;
  std::size_t bytes;

  explicit FencedGrid(const Voxels<T>& voxels, bool at_end)
    : grid(voxels.grid())
  {
    const std::size_t page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    const std::size_t inside = (grid.bytes() + page - 1) / page * page;
    bytes = inside + 2 * page;
    memory = mmap(nullptr, bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    char* begin = static_cast<char*>(memory) + page;
    mprotect(begin, inside, PROT_READ | PROT_WRITE);
    if (at_end)
    {
      begin += inside - grid.bytes();
    }
    std::memcpy(begin, voxels.values.data(), grid.bytes());
    grid.voxels = begin;
  }
  ~FencedGrid() { munmap(memory, bytes); }
};

template <class T>
void expect_no_read_beyond(const Voxels<T>& voxels)
{
  for (bool at_end : { true, false })
  {
    const FencedGrid<T> fenced(voxels, at_end);
    for (int effects = 0; effects < 8; ++effects)
    {
      Scene scene = ball_scene(voxels);
      const Film truth = [&]
      {
        scene.volumes[0].grid.linear = !(effects & 1);
        scene.volumes[0].grid.cell_centred = effects & 2;
        if (effects & 4)
        {
          add_shading(scene);
        }
        return march(scene, width, height, 0.9);
      }();
      scene.volumes[0].grid.voxels = fenced.grid.voxels;
      for (const std::string& target : targets())
      {
        force_simd_target(target);
        const Film film = march(scene, width, height, 0.9);
        expect_same_picture(film, truth, 1e-4, !scene.volumes[0].grid.linear);
        force_simd_target("");
      }
    }
  }
}

TYPED_TEST(Kernel, ReadsNothingBeyondTheVoxels)
{
  expect_no_read_beyond(ball_voxels<TypeParam>());
  // The fewest and odd numbers of voxels.
  for (const auto& n : { glm::ivec3(4, 1, 1), glm::ivec3(5, 1, 1), glm::ivec3(3, 3, 3),
         glm::ivec3(2, 7, 3) })
  {
    expect_no_read_beyond(Voxels<TypeParam>(
      n.x, n.y, n.z, [](int i, int j, int k) { return 10 + 7 * i + 5 * j + 3 * k; }));
  }
}

TEST(Kernel, ReadsNothingBeyondColours)
{
  expect_no_read_beyond(rgba_voxels());
  expect_no_read_beyond(Voxels<std::uint8_t>(
    3, 3, 1, [](int i, int j, int, int c) { return 30 + 7 * i + 5 * j + 9 * c; }));
}

// A grid of more than 2 GiB: its lit voxels lie on both sides of the 32-bit border. The memory is
// zero pages that are never written, so it costs next to nothing.
TEST(Kernel, ReadsGridsBeyondTwoGibibytes)
{
  const int nx = 1100;
  const int ny = 1024;
  const int nz = 2050; // 2.3e9 bytes
  const std::size_t bytes = std::size_t(nx) * ny * nz;
  void* memory = mmap(
    nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (memory == MAP_FAILED)
  {
    GTEST_SKIP() << "no address space for a grid of 2 GiB";
  }
  auto* voxels = static_cast<std::uint8_t*>(memory);
  const auto light = [&](int cx, int cy, int cz)
  {
    for (int z = cz - 3; z <= cz + 3; ++z)
      for (int y = cy - 3; y <= cy + 3; ++y)
        for (int x = cx - 3; x <= cx + 3; ++x)
          if (x < nx && y < ny && z < nz)
            voxels[(std::size_t(z) * ny + y) * nx + x] = 100 + 10 * (x - cx) + 5 * (y - cy) + z - cz;
  };
  light(300, 500, 1000);
  light(700, 520, 2000);
  light(nx - 2, ny - 2, nz - 2);
  Scene scene;
  scene.volumes[0].grid.voxels = voxels;
  scene.volumes[0].grid.dims[0] = nx;
  scene.volumes[0].grid.dims[1] = ny;
  scene.volumes[0].grid.dims[2] = nz;
  // Ranges by hand: bricks near the lights may be seen, no voxel needs to be read for it.
  auto ranges = std::make_shared<BrickRanges>();
  const int bricks[3] = { (nx - 1) / 8 + 1, (ny - 1) / 8 + 1, (nz - 1) / 8 + 1 };
  std::copy(bricks, bricks + 3, ranges->dims);
  ranges->minimum.assign(ranges->size(), 0.0f);
  ranges->maximum.assign(ranges->size(), 0.0f);
  ranges->upper = 255.0f;
  Marcher marcher; // one: looking for visible bricks takes longest here
  MarchSettings settings;
  settings.step = 0.5;
  settings.leave_error = 0.0;
  Film film(16, 16);
  const glm::ivec3 lights[] = { { 300, 500, 1000 }, { 700, 520, 2000 }, { nx - 2, ny - 2, nz - 2 } };
  for (const glm::ivec3& at : lights)
    for (int z = at.z / 8 - 1; z <= std::min(at.z / 8 + 1, bricks[2] - 1); ++z)
      for (int y = at.y / 8 - 1; y <= std::min(at.y / 8 + 1, bricks[1] - 1); ++y)
        for (int x = at.x / 8 - 1; x <= std::min(at.x / 8 + 1, bricks[0] - 1); ++x)
          ranges->maximum[(std::size_t(z) * bricks[1] + y) * bricks[0] + x] = 255.0f;
  scene.volumes[0].ranges = ranges;
  scene.volumes[0].classification = classify(
    0.0,
    255.0,
    [](double v) { return v / 300.0; },
    [](double v) { return glm::dvec3(v / 255.0, 1.0, 0.5); });
  for (const glm::ivec3& at : lights)
  {
    View view = view_of(scene, glm::dvec3(0.1, 0.05, -1.0), true);
    view.centre = glm::dvec3(at);
    view.half_height = 6.0;
    view.distance = 20.0;
    view.near_plane = 5.0;
    view.far_plane = 35.0;
    scene.camera = view.camera(1.0);
    Film truth(16, 16);
    render_fixed_step(scene, 0.5, SamplePlacement::Middle, 0.0, 0, truth);
    EXPECT_GT(truth.radiance[1][8 * 16 + 8], 0.1f);
    for (const std::string& target : targets())
    {
      force_simd_target(target);
      // Places near 2000 have a float's rounding of 1e-4 voxels.
      marcher.render(scene, settings, film);
      EXPECT_LE(difference(truth, film), 2e-3) << target;
      force_simd_target("");
    }
  }
  munmap(memory, bytes);
}

TEST(Marcher, MakesTheSameBitsWithAnyNumberOfThreads)
{
  const Voxels<std::uint16_t> voxels = ball_voxels<std::uint16_t>();
  Scene scene = ball_scene(voxels);
  add_shading(scene);
  const Film one = march(scene, 150, 97, 0.5, 0.001, 1);
  for (int threads : { 2, 7 })
  {
    MarchStatistics statistics;
    EXPECT_TRUE(same_bits(one, march(scene, 150, 97, 0.5, 0.001, threads, &statistics)));
    EXPECT_EQ(statistics.threads, threads);
  }
}

/// As the scene's, but no brick that cannot be seen.
std::shared_ptr<const BrickRanges> all_visible(const Scene& scene)
{
  auto ranges = std::make_shared<BrickRanges>(measure_bricks(scene.volumes[0].grid));
  std::fill(ranges->minimum.begin(), ranges->minimum.end(), -1e30f);
  std::fill(ranges->maximum.begin(), ranges->maximum.end(), 1e30f);
  return ranges;
}

TEST(Marcher, LeapsOverNothingThatShows)
{
  // Two small blobs in much emptiness, in a corner and off the middle.
  for (bool cells : { false, true })
  {
    const Voxels<std::int16_t> voxels(70, 61, 83, [](int i, int j, int k)
      {
        const double a = (i - 60) * (i - 60) + (j - 9) * (j - 9) + (k - 75) * (k - 75);
        const double b = (i - 20) * (i - 20) + (j - 33) * (j - 33) + (k - 30) * (k - 30);
        return 300.0 * std::exp(-a / 20.0) + 200.0 * std::exp(-b / 60.0);
      });
    Scene scene;
    scene.volumes[0].grid = voxels.grid();
    scene.volumes[0].grid.cell_centred = cells;
    scene.volumes[0].grid.linear = !cells;
    scene.volumes[0].classification = classify(
      0.0,
      300.0,
      [](double v) { return v < 20.0 ? 0.0 : 0.2; },
      [](double v) { return glm::dvec3(1.0, v / 300.0, 0.4); });
    for (const glm::dvec3& forward : { glm::dvec3(0, 0, -1), glm::dvec3(1, 0, 0),
           glm::dvec3(0, 1, 0), glm::dvec3(-0.5, 0.3, -0.9), glm::dvec3(0.3, -0.5, 0.1) })
    {
      for (double step : { 0.3, 1.0, 5.0 })
      {
        scene.camera = view_of(scene, forward, cells).camera(1.0);
        scene.volumes[0].ranges = nullptr;
        MarchStatistics leaping, slow;
        const Film film = march(scene, 64, 64, step, 0.0, 0, &leaping);
        scene.volumes[0].ranges = all_visible(scene);
        const Film truth = march(scene, 64, 64, step, 0.0, 0, &slow);
        EXPECT_LT(leaping.visible_bricks, leaping.bricks / 2);
        EXPECT_EQ(slow.visible_bricks, slow.bricks);
        EXPECT_LT(leaping.samples, slow.samples);
        EXPECT_LE(difference(film, truth), 1e-7) << step;
      }
    }
  }
}

// What is behind a ray that is left early changes no pixel by more than what was asked for: matter
// behind an almost opaque veil, dim of colour but bright of highlights.
TEST(Marcher, LeavesRaysWithinTheErrorAskedFor)
{
  const Voxels<std::uint8_t> voxels(12, 12, 60, [](int i, int j, int k)
    { return k > 30 ? 100.0 : 180.0 + 20.0 * std::sin(0.9 * i) * std::sin(0.8 * j + 0.5 * k); });
  for (bool highlights : { false, true })
  {
    Scene scene;
    scene.volumes[0].grid = voxels.grid();
    scene.volumes[0].classification = classify(
      0.0,
      255.0,
      [](double v) { return v < 150.0 ? 0.2 : 0.9; },
      [&](double v) {
        return glm::dvec3(v < 150.0 ? 0.0 : highlights ? 0.05 : 1.0);
      });
    if (highlights)
    {
      scene.volumes[0].shading.enabled = true;
      scene.volumes[0].shading.specular = 10.0;
      scene.volumes[0].shading.diffuse = 0.0;
      scene.volumes[0].shading.ambient = 0.0;
      scene.volumes[0].shading.specular_power = 1.0;
      scene.lights.resize(1);
    }
    View view = view_of(scene, glm::dvec3(0, 0, -1), true);
    view.half_height = 5.0;
    scene.camera = view.camera(1.0);
    const Film truth = march(scene, 24, 24, 0.5, 0.0);
    for (double allowed : { 1e-4, 1e-3, 1e-2, 1e-1 })
    {
      MarchStatistics statistics;
      const Film film = march(scene, 24, 24, 0.5, allowed, 0, &statistics);
      EXPECT_LE(difference(film, truth), allowed * 1.001) << "highlights " << highlights;
      EXPECT_GT(statistics.samples, 0u);
      for (std::size_t i = 0; i < film.size(); ++i)
      {
        // The estimate has the error of the steps beside that of leaving.
        EXPECT_LE(std::abs(double(film.transmittance[0][i]) - truth.transmittance[0][i]),
          film.error[i] * 1.001 + 1e-7);
      }
    }
    EXPECT_GT(difference(march(scene, 24, 24, 0.5, 0.1), truth), 0.0); // it does leave
  }
}

TEST(Marcher, LeavesRaysWithinTheErrorUnderALampThatGainsStrength)
{
  const Voxels<std::uint8_t> voxels(12, 12, 60, [](int i, int j, int k)
    { return k > 30 ? 100.0 : 180.0 + 20.0 * std::sin(0.9 * i) * std::sin(0.8 * j + 0.5 * k); });
  Scene scene;
  scene.volumes[0].grid = voxels.grid();
  scene.volumes[0].classification = classify(
    0.0,
    255.0,
    [](double v) { return v < 150.0 ? 0.2 : 0.9; },
    [&](double v) { return glm::dvec3(v < 150.0 ? 0.0 : 1.0); });
  scene.volumes[0].shading.enabled = true;
  Light lamp;
  lamp.positional = true;
  lamp.position = { 5.0, 5.0, 36.0 };
  lamp.attenuation = { 0.01, 0.0, 0.0 };
  scene.lights = { lamp };
  View view = view_of(scene, glm::dvec3(0, 0, -1), true);
  view.half_height = 5.0;
  scene.camera = view.camera(1.0);
  const Film truth = march(scene, 24, 24, 0.5, 0.0);
  for (double allowed : { 1e-3, 1e-2 })
  {
    EXPECT_LE(difference(march(scene, 24, 24, 0.5, allowed), truth), allowed * 1.001);
  }
}

TEST(Marcher, TellsDepthOfDensitiesAndClassifiedGridsInWorldUnits)
{
  const Voxels<float> voxels(5, 5, 11, [](int, int, int) { return 1.0f; });
  for (double scale : { 1.0, 3.0 })
  {
    Scene scene;
    scene.volumes[0].grid = voxels.grid();
    scene.volumes[0].world_from_data = glm::scale(glm::dmat4(1.0), glm::dvec3(scale));
    View view = view_of(scene, glm::dvec3(0, 0, -1), true);
    view.near_plane = view.distance - scale * 5.0 - 2.0; // the grid's face is 2 behind it
    scene.camera = view.camera(1.0);
    scene.volumes[0].density.extinction =
      std::log(2.0) / 4.0; // half is gone 4 of the data's units in
    scene.volumes[0].classification = classify(
      0.0, 2.0, [](double) { return 0.5; }, [](double) { return glm::dvec3(1.0); }, 2);
    scene.volumes[0].classification.unit_distance = 4.0;
    for (ValueMeaning meaning : { ValueMeaning::Density, ValueMeaning::Classified })
    {
      scene.volumes[0].meaning = meaning;
      Film slow(3, 3);
      render_fixed_step(scene, 0.01, SamplePlacement::Middle, 0.0, 1, slow);
      EXPECT_NEAR(slow.depth[4], 2.0 + 4.0 * scale, 0.02 * scale) << scale;
      EXPECT_NEAR(march(scene, 3, 3, 0.01).depth[4], 2.0 + 4.0 * scale, 0.02 * scale) << scale;
      scene.volumes[0].density.extinction *= 0.1;
      scene.volumes[0].classification.unit_distance *= 10.0;
      EXPECT_TRUE(std::isinf(march(scene, 3, 3, 0.01).depth[4])); // half is never gone
      scene.volumes[0].density.extinction *= 10.0;
      scene.volumes[0].classification.unit_distance *= 0.1;
    }
  }
}

TEST(Marcher, StopsWhenProgressSaysSo)
{
  const Voxels<std::uint8_t> voxels = ball_voxels<std::uint8_t>();
  const Scene scene = ball_scene(voxels);
  Marcher marcher;
  Film film(400, 400);
  MarchSettings settings;
  settings.threads = 1;
  int calls = 0;
  double last = 0.0;
  MarchStatistics statistics = marcher.render(scene, settings, film,
    [&](double fraction)
    {
      EXPECT_GE(fraction, 0.0);
      EXPECT_LE(fraction, 1.0);
      last = fraction;
      return ++calls < 3;
    });
  EXPECT_FALSE(statistics.completed);
  EXPECT_EQ(calls, 3);
  // Of several threads the caller's may come to speak late, but is heard whenever it does.
  settings.threads = 2;
  calls = 0;
  statistics = marcher.render(scene, settings, film, [&](double) { return ++calls < 1; });
  EXPECT_FALSE(statistics.completed);
  EXPECT_EQ(calls, 1);
  statistics = marcher.render(scene, settings, film, [&](double f) { last = f; return true; });
  EXPECT_TRUE(statistics.completed);
  EXPECT_EQ(last, 1.0);
}

// The caches' keys are the revisions alone.
TEST(Marcher, KeepsWhatItsRevisionsSayIsTheSame)
{
  Voxels<std::uint8_t> voxels = ball_voxels<std::uint8_t>();
  Scene scene = ball_scene(voxels);
  Marcher marcher;
  MarchSettings settings;
  Film film(40, 40);
  scene.volumes[0].data_revision = 1;
  scene.volumes[0].medium_revision = 1;
  marcher.render(scene, settings, film);
  const Film first = film;

  const std::vector<double> opacity = scene.volumes[0].classification.opacity;
  for (double& a : scene.volumes[0].classification.opacity)
  {
    a *= 0.5;
  }
  marcher.render(scene, settings, film);
  EXPECT_TRUE(same_bits(film, first)); // same medium_revision: the old table
  scene.volumes[0].medium_revision = 2;
  marcher.render(scene, settings, film);
  EXPECT_FALSE(same_bits(film, first));

  scene.volumes[0].classification.opacity = opacity;
  scene.volumes[0].medium_revision = 3;
  marcher.render(scene, settings, film);
  EXPECT_TRUE(same_bits(film, first));

  // An empty grid, then one with matter under the same number: still taken as empty.
  std::vector<std::uint8_t> matter = voxels.values;
  std::fill(voxels.values.begin(), voxels.values.end(), 0);
  scene.volumes[0].data_revision = 2;
  marcher.render(scene, settings, film);
  const Film empty(40, 40);
  EXPECT_TRUE(same_bits(film, empty));
  voxels.values = matter;
  scene.volumes[0].grid.voxels = voxels.values.data();
  marcher.render(scene, settings, film);
  EXPECT_TRUE(same_bits(film, empty));
  scene.volumes[0].data_revision = 3;
  marcher.render(scene, settings, film);
  EXPECT_TRUE(same_bits(film, first));

  // The number 0 keeps nothing.
  scene.volumes[0].data_revision = 0;
  scene.volumes[0].medium_revision = 0;
  marcher.render(scene, settings, film);
  std::fill(scene.volumes[0].classification.opacity.begin(),
    scene.volumes[0].classification.opacity.end(),
    0.0);
  marcher.render(scene, settings, film);
  EXPECT_TRUE(same_bits(film, empty));
  scene.volumes[0].classification.opacity = opacity;

  // Another step is another table.
  settings.step = 0.3;
  marcher.render(scene, settings, film);
  EXPECT_LE(difference(film, march(scene, 40, 40, 0.3, settings.leave_error)), 0.0);
}

TEST(Marcher, PreparesNothingForAMovedCamera)
{
  const Voxels<float> voxels(128, 128, 128, [](int i, int j, int k)
    { return 100.0 * std::exp(-0.001 * ((i - 64) * (i - 64) + (j - 64) * (j - 64) + (k - 64) * (k - 64))); });
  Scene scene = ball_scene(voxels);
  scene.volumes[0].data_revision = 1;
  scene.volumes[0].medium_revision = 1;
  Marcher marcher;
  Film film(16, 16);
  const MarchStatistics first = marcher.render(scene, {}, film);
  scene.camera = view_of(scene, glm::dvec3(1, 1, 0), false).camera(1.0);
  double best = 1.0;
  for (int i = 0; i < 3; ++i) // the machine may be busy
  {
    best = std::min(best, marcher.render(scene, {}, film).seconds_prepare);
  }
  EXPECT_LT(best, 0.001);
  EXPECT_LT(best, 0.2 * first.seconds_prepare);
}

TEST(SimdTarget, UnknownNamesChangeNothing)
{
  const std::vector<std::string> names = targets();
  ASSERT_FALSE(names.empty());
  ASSERT_TRUE(force_simd_target(names.back()));
  EXPECT_EQ(simd_targets(), names.back());
  EXPECT_FALSE(force_simd_target("no such target"));
  EXPECT_EQ(simd_targets(), names.back());
  EXPECT_TRUE(force_simd_target(names.front())); // another one that this machine has
  EXPECT_EQ(simd_targets(), names.front());
  EXPECT_TRUE(force_simd_target(""));
  EXPECT_EQ(targets(), names);
}

}
