// Paths where they could go on without end or stop too soon: a voxel of a thousand million times
// the others' density, matter that no path leaves, pixels that no path has found light in.
#include "../support/path_truth.h"

#include <chrono>
#include <iostream>

using namespace path_truth;

namespace
{

/// Thin matter with a dense voxel in it, or all dense.
struct Hot
{
  Voxels<float> voxels;
  Scene scene;

  Hot(double thin, double dense)
    : voxels(24,
        24,
        24,
        [=](int i, int j, int k)
        { return static_cast<float>(i == 12 && j == 11 && k == 13 ? dense : thin); })
  {
    Volume& volume = scene.volumes[0];
    volume.grid = voxels.grid();
    volume.meaning = ValueMeaning::Density;
    volume.medium.lit = true;
    Light sun;
    sun.direction = glm::normalize(glm::dvec3(0.4, -0.7, -0.6));
    scene.lights = { sun };
    View view = view_of(scene, glm::dvec3(-0.3, 0.2, -0.9), false);
    view.half_height *= 0.4;
    scene.camera = view.camera(1.0);
  }
};

double seconds_since(std::chrono::steady_clock::time_point start)
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr int edge = 6; // each path takes many times as long
#else
constexpr int edge = 16;
#endif
constexpr double waited = 10.0; // s; a busy machine's, where it takes a fraction: what is wrong takes for ever

}

// Bounds of its cells alone: the light of all others is found as quickly as without it.
TEST(PathLimits, ADenseVoxelIsNotAllOfItsBrick)
{
  double collisions[2];
  for (const int hot : { 0, 1 })
  {
    Hot matter(0.02, hot ? 1e9 : 0.02);
    // What absorbs nothing keeps a path in as long as it is dense, by right.
    matter.scene.volumes[0].medium.albedo = glm::dvec3(0.9);
    Film film(edge, edge);
    PathTracer tracer;
    PathSettings settings;
    settings.samples_per_pixel = 16;
    settings.threads = 1;
    const auto start = std::chrono::steady_clock::now();
    const PathStatistics s = tracer.render(
      matter.scene, settings, film, [&](double) { return seconds_since(start) < 20.0; });
    EXPECT_TRUE(s.completed);
    EXPECT_EQ(s.samples_per_pixel, 16);
    collisions[hot] = double(s.collisions) / s.paths;
    std::cout << collisions[hot] << " collisions a path, " << s.seconds << " s\n";
  }
  EXPECT_LE(collisions[1], 1e4);
}

// The bounds of cells are bounds: what is in them sends what the reference says.
TEST(PathLimits, CellsSendWhatTheReferenceSays)
{
  for (const bool coloured : { false, true })
  {
    Hot matter(0.02, 2000.0);
    if (coloured)
    {
      matter.scene.volumes[0].density.channels = glm::dvec3(1.0, 0.5, 0.2);
    }
    PathSettings settings;
    settings.samples_per_pixel = 256;
    settings.most_scatterings = 1;
    const Film film = traced(matter.scene, settings, edge, edge);
    const Film truth = by_reference(1e-4, 64)(matter.scene, edge, edge);
    double sum = 0.0;
    double variance = 0.0;
    double squares = 0.0;
    for (std::size_t i = 0; i < film.size(); ++i)
    {
      const double off = double(film.radiance[0][i]) - truth.radiance[0][i];
      const double sigma = film.error[i] / 3.0;
      ASSERT_GT(sigma, 0.0);
      sum += off;
      variance += sigma * sigma;
      squares += off * off / (sigma * sigma);
    }
    std::cout << sum / std::sqrt(variance) << " standard errors off, mean square "
              << squares / film.size() << "\n";
    EXPECT_LE(std::abs(sum) / std::sqrt(variance), 4.0);
    EXPECT_LE(squares / film.size(), 3.0); // few paths find the dense voxel: not Gaussian
  }
}

// Paths of millions of collisions are left within the path, in packets and one by one.
TEST(PathLimits, LongPathsAreLeft)
{
  for (const bool one_by_one : { false, true })
  {
    Hot matter(1e5, 1e5);
    if (one_by_one)
    {
      matter.scene.volumes[0].density.channels = glm::dvec3(1.0, 0.9, 0.8);
    }
    matter.scene.volumes[0].medium.lobes = { { PhaseFunction::HenyeyGreenstein, 1.0, 0.999 } };
    Film film(edge, edge);
    PathSettings settings;
    settings.samples_per_pixel = 1 << 20;
    settings.threads = 1;
    {
      PathTracer tracer;
      const auto start = std::chrono::steady_clock::now();
      const PathStatistics s = tracer.render(
        matter.scene, settings, film, [&](double) { return seconds_since(start) < 0.1; });
      EXPECT_FALSE(s.completed);
      EXPECT_LE(seconds_since(start), waited);
      EXPECT_TRUE(all_finite(film));
    }
    settings.seconds = 0.1;
    PathTracer tracer;
    const auto start = std::chrono::steady_clock::now();
    const PathStatistics s = tracer.render(matter.scene, settings, film);
    EXPECT_TRUE(s.completed);
    std::cout << seconds_since(start) << " s, " << s.samples_per_pixel << " paths a pixel\n";
    EXPECT_LE(seconds_since(start), waited);
    EXPECT_TRUE(all_finite(film));
    // What was left is not in the way of going on.
    settings.resume = true;
    settings.seconds = 0.2;
    EXPECT_TRUE(tracer.render(matter.scene, settings, film).completed);
  }
}

namespace
{

/// Dark matter in front of a lamp's light: one path in some hundred finds it.
struct Veiled
{
  Voxels<float> voxels{ 16, 16, 16, [](int, int, int k) { return k > 8 ? 0.8f : 0.1f; } };
  Scene scene;

  Veiled()
  {
    Volume& volume = scene.volumes[0];
    volume.grid = voxels.grid();
    volume.meaning = ValueMeaning::Density;
    volume.medium.lit = true;
    volume.medium.albedo = glm::dvec3(0.5);
    Light sun;
    sun.direction = glm::dvec3(0.0, 0.0, 1.0); // from behind, away from the eye
    sun.diffuse = glm::dvec3(20.0);
    scene.lights = { sun };
    View view = view_of(scene, glm::dvec3(0.0, 0.0, -1.0), false);
    view.half_height *= 1.4;
    scene.camera = view.camera(1.0);
  }
};

}

// Pixels whose paths are all black so far are as likely as others to be off, and are not said to be
// exact; those that look past all matter are.
TEST(PathLimits, BlackPathsTellNoError)
{
  Veiled veiled;
  PathSettings settings;
  settings.samples_per_pixel = 16;
  settings.most_scatterings = 1;
  const Film few = traced(veiled.scene, settings, 24, 24);
  const Film truth = by_reference(1e-5, 16)(veiled.scene, 24, 24);
  int black = 0;
  int exact = 0;
  for (std::size_t i = 0; i < few.size(); ++i)
  {
    if (truth.transmittance[0][i] == 1.0f)
    {
      EXPECT_EQ(few.error[i], 0.0f);
      ++exact;
    }
    else if (few.radiance[0][i] == 0.0f)
    {
      ++black;
      EXPECT_GE(few.error[i], truth.radiance[0][i]);
    }
  }
  std::cout << black << " pixels without light so far, " << exact << " without matter\n";
  EXPECT_GT(black, 20);
  EXPECT_GT(exact, 20);
}

// Adaptive: nearly no pixel is beyond what is asked for.
TEST(PathLimits, BlackPixelsGoOn)
{
  Veiled veiled;
  PathSettings settings;
  settings.samples_per_pixel = 1 << 20;
  settings.most_scatterings = 1;
  settings.adaptive = true;
  settings.tolerance = 0.03;
  settings.beyond = 0.01;
  Film film(24, 24);
  const Film truth = by_reference(1e-5, 16)(veiled.scene, 24, 24);
  int beyond = 0;
  int all = 0;
  for (const std::uint32_t seed : { 1u, 2u, 3u, 4u, 5u, 6u })
  {
    settings.seed = seed;
    PathTracer tracer;
    const PathStatistics s = tracer.render(veiled.scene, settings, film);
    EXPECT_LE(s.estimated_error, 0.2);
    for (std::size_t i = 0; i < film.size(); ++i)
    {
      beyond += std::abs(film.radiance[0][i] - truth.radiance[0][i]) > settings.tolerance;
      ++all;
    }
  }
  std::cout << beyond << " of " << all << " pixels beyond the tolerance\n";
  EXPECT_LE(beyond, 3 * settings.beyond * all);
}

// Paths of a pixel are not independent: the first numbers of each eight are stratified. The error
// that is told is that of means over seeds, in packets and one by one; single paths differ more.
TEST(PathLimits, ErrorsAreThoseOfStratifiedPaths)
{
  for (const bool one_by_one : { false, true })
  {
    Hot smoke(0.06, 0.06);
    smoke.scene.volumes[0].medium.albedo = glm::dvec3(0.8);
    if (one_by_one)
    {
      smoke.scene.volumes[0].medium.emission = glm::dvec3(1e-9);
    }
    PathSettings settings;
    settings.samples_per_pixel = 128;
    constexpr int seeds = 16;
    std::vector<double> sums(edge * edge);
    std::vector<double> squares(edge * edge);
    double stated = 0.0;
    for (int seed = 1; seed <= seeds; ++seed)
    {
      settings.seed = seed;
      const Film film = traced(smoke.scene, settings, edge, edge);
      for (std::size_t i = 0; i < film.size(); ++i)
      {
        sums[i] += film.radiance[1][i];
        squares[i] += double(film.radiance[1][i]) * film.radiance[1][i];
        stated += film.error[i] * film.error[i] / 9.0 / seeds;
      }
    }
    double variance = 0.0;
    for (std::size_t i = 0; i < sums.size(); ++i)
    {
      variance += (squares[i] - sums[i] * sums[i] / seeds) / (seeds - 1);
    }
    std::cout << "stated by true variance: " << stated / variance << "\n";
    EXPECT_NEAR(stated / variance, 1.0, 0.15 * 16 / edge);
  }
}
