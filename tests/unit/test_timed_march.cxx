// What a few strips tell of a picture: how long it takes, and how few rays it needs.
#include "../support/transport_scenes.h"

#include "Transport/reference.h"
#include "Transport/timed_march.h"

#include <gtest/gtest.h>

#include <random>

using namespace transport_scenes;

namespace
{

Scene scene_of(const Voxels<float>& voxels, double steepness)
{
  Scene scene;
  scene.volumes[0].grid = voxels.grid();
  scene.volumes[0].classification = classify(
    0.0,
    1.0,
    [&](double v) { return 0.9 * v * v / (1.0 + std::exp(-(v - 0.5) * steepness)); },
    [](double v) { return glm::dvec3(1.0, 0.5 + 0.5 * v, 0.2); });
  scene.camera = view_of(scene, glm::dvec3(-0.5, 0.3, -0.9), false).camera(1.0);
  return scene;
}

Voxels<float> soft_ball()
{
  return Voxels<float>(24,
    24,
    24,
    [](int i, int j, int k)
    {
      const double r = std::hypot(i - 11.5, j - 11.5, k - 11.5);
      return 0.6 / (1.0 + std::exp(0.6 * (r - 7.0)));
    });
}

Voxels<float> noise()
{
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  return Voxels<float>(24, 24, 24, [&](int, int, int) { return uniform(random); });
}

/// The error that so many in a thousand of the pixels exceed at the most.
double error_of(const Film& film, const Film& truth, int of_thousand)
{
  std::vector<double> errors(film.size(), 0.0);
  for (std::size_t i = 0; i < film.size(); ++i)
  {
    for (int c = 0; c < 3; ++c)
    {
      errors[i] = std::max({ errors[i],
        std::abs(double(film.radiance[c][i]) - truth.radiance[c][i]),
        std::abs(double(film.transmittance[c][i]) - truth.transmittance[c][i]) });
    }
  }
  std::sort(errors.begin(), errors.end(), std::greater<>());
  return errors[errors.size() * static_cast<std::size_t>(of_thousand) / 1000];
}

constexpr int size = 256;

TEST(ForecastMarch, FindsHowFarApartRaysMayBe)
{
  const Voxels<float> voxels = soft_ball();
  const Scene scene = scene_of(voxels, 4.0);
  Marcher marcher;
  MarchSettings settings;
  settings.step = 0.5;
  Film truth(size, size);
  render_reference(scene, {}, truth);
  int last = 4;
  for (const double room : { 0.05, 0.004, 0.0005, 0.00002 })
  {
    const MarchForecast forecast = forecast_march(marcher, scene, settings, size, size, room, 8e-4);
    EXPECT_LE(forecast.distance, last) << room;
    last = forecast.distance;
    Film film(size / forecast.distance, size / forecast.distance);
    marcher.render(scene, settings, film);
    const double error = error_of(scaled(film, size, size), truth, 1);
    if (forecast.distance == 1)
    {
      EXPECT_TRUE(std::isnan(forecast.error)) << room;
      continue;
    }
    EXPECT_LE(forecast.error, room);
    EXPECT_LE(error, 1.1 * forecast.error)
      << room << ", rays " << forecast.distance << " pixels apart";
  }
  EXPECT_EQ(last, 1) << "some tolerance asks for all rays";
  EXPECT_EQ(forecast_march(marcher, scene, settings, size, size, 0.05, 8e-4).distance, 4);
}

TEST(ForecastMarch, TakesAllRaysWhereNothingIsAllowedOrSurfacesEndThem)
{
  const Voxels<float> voxels = soft_ball();
  Scene scene = scene_of(voxels, 4.0);
  Marcher marcher;
  MarchSettings settings;
  EXPECT_EQ(forecast_march(marcher, scene, settings, size, size).distance, 1);
  scene.surface_depth.assign(static_cast<std::size_t>(size) * size, 1.0f);
  EXPECT_EQ(forecast_march(marcher, scene, settings, size, size, 0.5, 8e-4).distance, 1);
}

TEST(ForecastMarch, SeesWhatIsTooFineForFewerRays)
{
  const Voxels<float> voxels = noise();
  const Scene scene = scene_of(voxels, 40.0);
  Marcher marcher;
  MarchSettings settings;
  settings.step = 0.25;
  EXPECT_EQ(forecast_march(marcher, scene, settings, 96, 96, 0.02, 6e-4).distance, 1);
}

TEST(ErrorOfScaled, IsThatOfThePicture)
{
  const Voxels<float> soft = soft_ball();
  const Voxels<float> rough = noise();
  for (const Voxels<float>* voxels : { &soft, &rough })
  {
    const Scene scene = scene_of(*voxels, 4.0);
    Marcher marcher;
    MarchSettings settings;
    settings.step = 0.25;
    constexpr int edge = 96;
    ReferenceSettings reference;
    reference.tolerance = 2e-3;
    Film truth(edge, edge);
    render_reference(scene, reference, truth);
    Film small(edge / 4, edge / 4);
    marcher.render(scene, settings, small);
    const double error = error_of(scaled(small, edge, edge), truth, 1);
    const double found = error_of_scaled(marcher, scene, settings, small, 8e-4);
    EXPECT_GE(found, 0.7 * error);
    EXPECT_LE(found, 3.0 * error);
    // A picture that misses all of it.
    EXPECT_GE(error_of_scaled(marcher, scene, settings, Film(edge / 4, edge / 4), 8e-4), 0.3);
  }
}

TEST(Reference, DoesNotSettleByChance)
{
  // Sharp surfaces: the pieces' middles lie on this side or the other, and pictures of few and of
  // twice as many pieces are wrong alike at some pixels.
  const Voxels<float> voxels = noise();
  const Scene scene = scene_of(voxels, 200.0);
  ReferenceSettings settings;
  settings.most_pieces = 4096;
  constexpr double tolerance = 1e-3;
  settings.tolerance = tolerance;
  Film film(32, 32);
  const ReferenceStatistics statistics = render_reference(scene, settings, film);
  EXPECT_EQ(statistics.unsettled_rays, 0u);
  settings.tolerance = 1e-6;
  Film truth(32, 32);
  render_reference(scene, settings, truth);
  EXPECT_LE(error_of(film, truth, 10), 0.5 * tolerance);
  EXPECT_LE(error_of(film, truth, 0), 3.0 * tolerance);
}

}
