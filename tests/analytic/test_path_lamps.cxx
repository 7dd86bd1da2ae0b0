// Lamps in matter, close to which light grows as 1/d²: paths find it without bias, and with a
// variance that is finite.
#include "../support/path_truth.h"

#include <iostream>

using namespace path_truth;

namespace
{

constexpr double albedo = 0.8;
constexpr double extinction = 0.5;

/// Infinite matter around a lamp in the origin, and a ray that passes it at a distance.
struct AroundLamp
{
  Scene scene;

  AroundLamp(double passes_at, const glm::dvec3& colours = glm::dvec3(1.0))
  {
    scene.volumes.clear();
    scene.fog.enabled = true;
    scene.fog.extinction = extinction * colours;
    scene.fog.albedo = glm::dvec3(albedo);
    Light lamp;
    lamp.positional = true;
    lamp.attenuation = glm::dvec3(0.0, 0.0, 1.0);
    scene.lights = { lamp };
    scene.camera =
      pencil(glm::dvec3(passes_at, 0.0, 0.0), glm::dvec3(0.0, 0.0, 1.0), 3.0).camera(1.0);
  }
};

/// Of matter of this extinction; the ray begins in z = −3 but for the near plane.
double truth(double passes_at, double sigma)
{
  const InfiniteMedium medium(albedo);
  const auto sends = [&](double z)
  {
    const double r = sigma * std::hypot(passes_at, z);
    // The fluence of a power of 4π² (irradiance π/d²), in units of 1/σ².
    return std::exp(-sigma * (z + 2.9)) * albedo * sigma / (4.0 * pi) * 4.0 * pi * pi * sigma *
           sigma * medium.fluence(r);
  };
  double sum = 0.0;
  std::vector<double> ends{ -2.9,
    -1.0,
    -10.0 * passes_at,
    -passes_at,
    0.0,
    passes_at,
    10.0 * passes_at,
    1.0,
    10.0,
    40.0 / sigma };
  ends.erase(
    std::remove_if(ends.begin(), ends.end(), [](double z) { return z < -2.9; }), ends.end());
  std::sort(ends.begin(), ends.end());
  for (std::size_t i = 1; i < ends.size(); ++i)
  {
    sum += integral(sends, ends[i - 1], ends[i]);
  }
  return sum;
}

/// The rays that a test's pixels stand for, as many independent estimates.
Mean mean_of_paths(const Scene& scene, int edge, int samples, std::uint32_t seed = 1)
{
  PathSettings settings;
  settings.samples_per_pixel = samples;
  settings.seed = seed;
  return mean_of(traced(scene, settings, edge, edge));
}

}

// A lamp that shines to all sides in matter without end: the closed form has all scatterings.
TEST(PathLamps, InfiniteMediumIsCasesAndZweifels)
{
  for (const double passes_at : { 0.01, 0.5 })
  {
    const AroundLamp around(passes_at);
    const Mean mean = mean_of_paths(around.scene, 40, 40);
    const double right = truth(passes_at, extinction);
    std::cout << "passing at " << passes_at << ": " << mean.value.x / right - 1.0 << " +- "
              << mean.error.x / right << '\n';
    EXPECT_NEAR(mean.value.x, right, 4.0 * mean.error.x);
    EXPECT_LE(mean.error.x, 0.01 * right);
  }
  const AroundLamp coloured(0.1, glm::dvec3(1.0, 0.3, 2.0));
  const Mean mean = mean_of_paths(coloured.scene, 40, 120);
  for (int c = 0; c < 3; ++c)
  {
    const double right = truth(0.1, coloured.scene.fog.extinction[c]);
    std::cout << "channel " << c << ": " << mean.value[c] / right - 1.0 << " +- "
              << mean.error[c] / right << '\n';
    EXPECT_NEAR(mean.value[c], right, 4.0 * mean.error[c]);
    EXPECT_LE(mean.error[c], 0.02 * right);
  }
}

// An error of finite variance falls as 1/√n; one that a 1/d² leaves to chance as n^(−1/3), so that
// times √n it grows threefold here.
TEST(PathLamps, ErrorFallsAsOneOverTheRootOfThePaths)
{
  const AroundLamp around(0.5);
  const double right = truth(0.5, extinction);
  double first = 0.0;
  double last = 0.0;
  for (int samples = 4; samples <= 4096; samples *= 8)
  {
    const int edge = samples < 100 ? 32 : 12;
    PathSettings settings;
    settings.samples_per_pixel = samples;
    const Film film = traced(around.scene, settings, edge, edge);
    double squares = 0.0;
    for (float v : film.radiance[0])
    {
      squares += (v - right) * (v - right);
    }
    last = std::sqrt(squares / film.size() * samples) / right;
    first = first > 0.0 ? first : last;
    std::cout << samples << " paths: " << last / std::sqrt(double(samples)) << ", times their root "
              << last << '\n';
  }
  EXPECT_NEAR(last / first, 1.0, 0.3);
}

// Lamps in and just outside of a box, with cones and other laws, scattered once: the reference's.
TEST(PathLamps, OneScatteringIsTheReferences)
{
  const Voxels<float> voxels{ 12, 11, 10, [](int i, int j, int k) {
                               return 0.6f +
                                      0.4f * std::sin(0.9f * i) * std::cos(0.7f * j + 0.4f * k);
                             } };
  Scene scene;
  Volume& volume = scene.volumes[0];
  volume.grid = voxels.grid();
  volume.data_from_index = placed(glm::dvec3(0.8, 1.1, 1.0), glm::dvec3(0.3, -0.2, 0.1));
  volume.world_from_data = placed(glm::dvec3(0.9, 0.7, 1.2), glm::dvec3(-1.0, 0.4, 0.2));
  volume.meaning = ValueMeaning::Density;
  volume.density.extinction = 0.4;
  volume.density.channels = glm::dvec3(0.5, 1.0, 0.25);
  volume.medium.lit = true;
  volume.medium.lobes = { { PhaseFunction::HenyeyGreenstein, 1.0, 0.6 } };
  const glm::dvec3 middle(3.2, 3.8, 5.5);
  View view;
  view.centre = middle;
  view.forward = glm::normalize(glm::dvec3(-0.3, -0.5, -0.8));
  view.distance = 20.0;
  view.half_height = 3.0;
  view.far_plane = 60.0;
  scene.camera = view.camera(1.0);
  Light lamp;
  lamp.positional = true;
  lamp.diffuse = glm::dvec3(1.0, 0.7, 1.5);
  lamp.attenuation = glm::dvec3(0.0, 0.0, 1.0);
  lamp.position = middle;
  scene.lights = { lamp };
  lamp.position = middle + glm::dvec3(0.6, 0.2, -0.4);
  lamp.attenuation = glm::dvec3(0.01, 0.1, 0.5);
  lamp.direction = glm::normalize(glm::dvec3(1.0, -0.2, 0.3));
  lamp.cone_angle = 60.0;
  scene.lights.push_back(lamp);
  lamp.position = middle + glm::dvec3(-4.4, 0.0, 1.0); // beside the box
  lamp.cone_angle = 180.0;
  scene.lights.push_back(lamp);
  constexpr int edge = 16;
  const Film exact = by_reference(1e-4, 8)(scene, edge, edge);
  PathSettings settings;
  settings.samples_per_pixel = 400;
  settings.most_scatterings = 1;
  const Film film = traced(scene, settings, edge, edge);
  double squares = 0.0;
  double sum = 0.0;
  double variance = 0.0;
  int count = 0;
  for (std::size_t i = 0; i < film.size(); ++i)
  {
    const double sigma = film.error[i] / 3.0;
    if (sigma > 0.0)
    {
      const double off = double(film.radiance[2][i]) - exact.radiance[2][i];
      sum += off;
      variance += sigma * sigma;
      squares += off * off / (sigma * sigma);
      ++count;
    }
  }
  std::cout << sum / std::sqrt(variance) << " standard errors off, mean square " << squares / count
            << '\n';
  EXPECT_GT(count, 150);
  EXPECT_LE(std::abs(sum) / std::sqrt(variance), 4.0);
  EXPECT_LE(squares / count, 1.5);
}
