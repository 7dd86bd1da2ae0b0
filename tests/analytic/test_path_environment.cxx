// Light from all around as paths find it: directions drawn by their density, and media that a
// picture lights, not lights in its place.
#include "../support/path_truth.h"

#include "Transport/environment.h"
#include "Transport/path_environment.h"

#include <glm/ext/matrix_transform.hpp>

#include <iostream>
#include <memory>

using namespace path_truth;

namespace
{

template <class Value>
std::shared_ptr<PlacedEnvironment> map_of(int width, int height, Value value)
{
  auto placed = std::make_shared<PlacedEnvironment>();
  placed->map.width = width;
  placed->map.height = height;
  for (int y = 0; y < height; ++y)
  {
    for (int x = 0; x < width; ++x)
    {
      const glm::dvec3 v = value(x, y);
      placed->map.rgb.insert(placed->map.rgb.end(), { float(v.x), float(v.y), float(v.z) });
    }
  }
  return placed;
}

/// Uneven matter that absorbs a little, seen along one ray.
struct Cloud
{
  Voxels<float> voxels{ 9, 8, 7, [](int i, int j, int k) {
                         return 0.5f + 0.5f * std::sin(1.3f * i) * std::cos(2.1f * j + k);
                       } };
  Scene scene;

  explicit Cloud(double albedo)
  {
    Volume& volume = scene.volumes[0];
    volume.grid = voxels.grid();
    volume.meaning = ValueMeaning::Density;
    volume.density.extinction = 0.8;
    volume.medium.lit = true;
    volume.medium.albedo = glm::dvec3(albedo);
    volume.medium.lobes = { { PhaseFunction::HenyeyGreenstein, 1.0, 0.6 } };
    scene.camera =
      pencil(glm::dvec3(4.0, 3.5, 3.0), glm::dvec3(-0.4, -0.7, -0.5), 20.0).camera(1.0);
  }
  Film trace(std::shared_ptr<const PlacedEnvironment> map,
    int samples,
    std::uint32_t seed = 1,
    int scatterings = 0) const
  {
    PathSettings settings;
    settings.samples_per_pixel = samples;
    settings.seed = seed;
    settings.most_scatterings = scatterings;
    settings.environment = std::move(map);
    return traced(scene, settings, 32, 32);
  }
};

void expect_alike(const Mean& a, const Mean& b, double relative = 0.0)
{
  for (int c = 0; c < 3; ++c)
  {
    std::cout << "  " << a.value[c] << " +- " << a.error[c] << ", " << b.value[c] << " +- "
              << b.error[c] << '\n';
    EXPECT_NEAR(
      a.value[c], b.value[c], 4.0 * std::hypot(a.error[c], b.error[c]) + relative * b.value[c]);
  }
}

}

TEST(PathEnvironment, DirectionsFollowTheirDensity)
{
  constexpr int width = 9;
  constexpr int height = 6;
  const auto placed = map_of(width,
    height,
    [](int x, int y)
    {
      return x == 3 && y == 5 ? glm::dvec3(30.0, 3.0, 1.0)
                              : glm::dvec3(0.1 * ((x * y) % 5), 0.3, 0.0);
    });
  placed->world_from_map = world_from_environment(glm::normalize(glm::dvec3(0.3, -0.5, 0.6)), 33.0);
  Sky sky;
  sky.radiance = glm::dvec3(0.5, 0.7, 0.9);
  sky.ground = glm::dvec3(0.2, 0.1, 0.0);
  sky.up = glm::normalize(glm::dvec3(0.1, 0.9, -0.3));
  const PathEnvironment environment(sky, placed);
  RandomStream random(1, 0, 0);
  // Sums over cells of 1 over the density are solid angles, those of 1 the chances.
  constexpr int count = 400000;
  constexpr int cells = 12 * 8;
  std::vector<double> counts(cells, 0.0);
  std::vector<double> chances(cells, 0.0);
  for (int n = 0; n < count; ++n)
  {
    const glm::dvec3 d = environment.sample(random);
    ASSERT_NEAR(glm::length(d), 1.0, 1e-12);
    const int u = std::min(int((std::atan2(d.y, d.x) / (2.0 * pi) + 0.5) * 12), 11);
    const int v = std::min(int((0.5 * d.z + 0.5) * 8), 7);
    counts[8 * u + v] += 1.0;
  }
  // The chance of a cell, by a fine midpoint rule over the sphere.
  constexpr int fine = 200;
  double whole = 0.0;
  for (int u = 0; u < 12 * fine; ++u)
  {
    for (int v = 0; v < 8 * fine; ++v)
    {
      const double z = 2.0 * (v + 0.5) / (8 * fine) - 1.0;
      const double angle = 2.0 * pi * ((u + 0.5) / (12 * fine) - 0.5);
      const double r = std::sqrt(1.0 - z * z);
      const double part = environment.density({ r * std::cos(angle), r * std::sin(angle), z }) *
                          4.0 * pi / (96.0 * fine * fine);
      chances[8 * (u / fine) + v / fine] += part;
      whole += part;
    }
  }
  EXPECT_NEAR(whole, 1.0, 1e-3);
  double chi_square = 0.0;
  for (int i = 0; i < cells; ++i)
  {
    const double expected = chances[i] * count;
    chi_square += (counts[i] - expected) * (counts[i] - expected) / expected;
  }
  std::cout << "chi square " << chi_square << " of " << cells - 1 << '\n';
  EXPECT_LE(
    chi_square, cells - 1 + 5.0 * std::sqrt(2.0 * cells)); // the midpoint rule's error in it
}

// A picture as bright everywhere is a furnace, and one of two halves is sky and ground.
TEST(PathEnvironment, PicturesOfSkiesAreSkies)
{
  const Cloud white(1.0);
  const Film furnace = white.trace(map_of(8, 4, [](int, int) { return glm::dvec3(1.0); }), 60);
  const Mean mean = mean_of(furnace);
  for (int c = 0; c < 3; ++c)
  {
    EXPECT_NEAR(mean.value[c] + furnace.transmittance[c][0], 1.0, 4.0 * mean.error[c]);
    EXPECT_LE(mean.error[c], 3e-3);
  }
  Cloud grey(0.9);
  const auto halves = map_of(16,
    8,
    [](int, int y) { return y >= 4 ? glm::dvec3(0.5, 0.7, 0.9) : glm::dvec3(0.2, 0.1, 0.0); });
  const Mean of_map = mean_of(grey.trace(halves, 100));
  grey.scene.sky.radiance = glm::dvec3(0.5, 0.7, 0.9);
  grey.scene.sky.ground = glm::dvec3(0.2, 0.1, 0.0);
  expect_alike(of_map, mean_of(grey.trace(nullptr, 100, 2)));
}

// One small bright pixel is a sun: of its irradiance, and with the noise of one, not of a path that
// meets it by chance.
TEST(PathEnvironment, SmallSunsAreSuns)
{
  Cloud cloud(0.95);
  constexpr int width = 256;
  constexpr int height = 128;
  const int x = 100;
  const int y = 100;
  const auto picture = map_of(width,
    height,
    [&](int i, int j)
    { return i == x && j == y ? glm::dvec3(5000.0, 4000.0, 3000.0) : glm::dvec3(0.0); });
  picture->world_from_map = world_from_environment(glm::normalize(glm::dvec3(0.2, 0.7, 0.4)), 20.0);
  for (const int scatterings : { 1, 0 })
  {
    const Mean of_map = mean_of(cloud.trace(picture, 100, 1, scatterings));
    Cloud sunny(0.95);
    sunny.scene.lights = environment_lights(picture->map, 1, picture->world_from_map);
    const Mean of_sun = mean_of(sunny.trace(nullptr, 100, 2, scatterings));
    expect_alike(of_map, of_sun, 1e-3); // the pixel is 1.4 degrees wide
    EXPECT_LE(of_map.error.x, 2.0 * of_sun.error.x);
  }
}
