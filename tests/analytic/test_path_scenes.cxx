// Path tracing against the other integrators and against itself: one scattering is the reference's,
// and nothing that only saves time or memory moves the mean.
#include "../support/lit_scenes.h"

#include "Transport/path_tracer.h"

#include <iostream>
#include <memory>
#include <string>
#include <utility>

using namespace lit_scenes;

namespace
{

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr int edge = 8; // each path takes many times as long
constexpr int samples = 100;
#else
constexpr int edge = 24;
constexpr int samples = 400;
#endif

/// How far estimates are from the truth, in their own standard errors: over all pixels that paths
/// differ in.
struct Agreement
{
  double mean = 0.0;   ///< of the sum over all pixels, in the worst channel; single ones are skew
  double square = 0.0; ///< mean square of the pixels' deviations in their worst channel: about 1
  int count = 0;
  int lost = 0;        ///< numbers that are wrong where paths do not differ
};

Agreement agreement(const Film& estimate, const Film& truth)
{
  Agreement result;
  double squares = 0.0;
  double variance = 0.0;
  double sums[3] = { 0.0, 0.0, 0.0 };
  for (std::size_t i = 0; i < estimate.size(); ++i)
  {
    // The error is three times the largest of the channels'.
    const double sigma = estimate.error[i] / 3.0;
    double largest_off = 0.0;
    for (int c = 0; c < 3; ++c)
    {
      const double off = double(estimate.radiance[c][i]) - truth.radiance[c][i];
      sums[c] += off;
      largest_off = std::max(largest_off, std::abs(off));
      result.lost += !(sigma > 0.0) && std::abs(off) > 1e-2;
    }
    if (sigma > 0.0)
    {
      variance += sigma * sigma;
      squares += largest_off * largest_off / (sigma * sigma);
      ++result.count;
    }
  }
  for (double sum : sums)
  {
    result.mean = std::max(result.mean, std::abs(sum) / std::sqrt(variance));
  }
  result.square = squares / result.count;
  return result;
}

/// Scenes that go every way of the tracer. They own their voxels.
struct Named
{
  std::string name;
  std::shared_ptr<void> voxels;
  Scene scene;
};

template <class T>
std::shared_ptr<Voxels<T>> uneven(double scale, double least = 0.0)
{
  return std::make_shared<Voxels<T>>(20, 18, 17,
    [=](int i, int j, int k)
    {
      const double v = std::sin(0.9 * i) * std::cos(0.7 * j) * std::sin(0.5 * k + 0.3);
      return static_cast<T>(scale * std::max(v, least));
    });
}

View view_of_all()
{
  View view;
  view.centre = glm::dvec3(9.5, 8.5, 8.0);
  view.forward = glm::normalize(glm::dvec3(-0.5, -0.6, -0.62));
  view.distance = 60.0;
  view.half_height = 11.0;
  view.far_plane = 120.0;
  return view;
}

template <class T>
Named density(const std::string& name, double extinction, double scale = 1.0, double least = 0.0)
{
  auto voxels = uneven<T>(scale, least);
  Named named{ name, voxels, {} };
  Volume& volume = named.scene.volumes[0];
  volume.grid = voxels->grid();
  volume.meaning = ValueMeaning::Density;
  volume.density.extinction = extinction;
  volume.medium.lit = true;
  volume.medium.albedo = glm::dvec3(0.9, 0.95, 1.0);
  volume.medium.lobes = { { PhaseFunction::HenyeyGreenstein, 0.7, 0.5 },
    { PhaseFunction::Rayleigh, 0.2, 0.0 }, { PhaseFunction::Schlick, 0.1, -0.3 } };
  Light sun;
  sun.direction = glm::normalize(glm::dvec3(0.3, -0.8, -0.5));
  sun.diffuse = glm::dvec3(2.0, 1.8, 1.5);
  named.scene.lights = { sun };
  named.scene.camera = view_of_all().camera(1.0);
  return named;
}

void classify(Volume& volume)
{
  volume.meaning = ValueMeaning::Classified;
  Classification& c = volume.classification;
  c.opacity.clear();
  c.lower = 0.0;
  c.upper = 1.0;
  // Nodes so close that it does not matter what is straight between them, opacity or extinction.
  const double opacity[5] = { 0.0, 0.0, 0.3, 0.05, 0.6 };
  const double rgb[5][3] = { { 0, 0, 0 }, { 1, 0.2, 0.1 }, { 0.2, 0.9, 0.3 }, { 0.3, 0.4, 1 }, { 1, 1, 1 } };
  constexpr int nodes = 4097;
  for (int i = 0; i < nodes; ++i)
  {
    const double at = 4.0 * i / (nodes - 1.0);
    const int n = std::min(static_cast<int>(at), 3);
    c.opacity.push_back(opacity[n] + (at - n) * (opacity[n + 1] - opacity[n]));
    for (int k = 0; k < 3; ++k)
    {
      c.rgb.push_back(rgb[n][k] + (at - n) * (rgb[n + 1][k] - rgb[n][k]));
    }
  }
  c.unit_distance = 1.0;
}

std::vector<Named> scenes()
{
  std::vector<Named> all;
  all.push_back(density<float>("floats", 0.5));
  all.push_back(density<std::uint8_t>("bytes, moved and stretched", 0.003, 200.0));
  all.back().scene.volumes[0].data_from_index = placed(glm::dvec3(1.2, 0.8, 1.1), glm::dvec3(-1.0, 2.0, 0.5));
  all.push_back(density<std::int16_t>("shorts, some below 0", 0.001, 1000.0, -0.4));
  all.push_back(density<float>("coloured extinction", 1.0));
  all.back().scene.volumes[0].density.channels = glm::dvec3(1.0, 0.3, 0.05);
  all.push_back(density<float>("lamps in and beside", 0.4));
  {
    Light lamp;
    lamp.positional = true;
    lamp.position = glm::dvec3(4.0, 20.0, 9.0);
    lamp.diffuse = glm::dvec3(20.0);
    lamp.attenuation = glm::dvec3(0.0, 0.0, 0.2);
    all.back().scene.lights.push_back(lamp);
    lamp.position = glm::dvec3(9.3, 8.1, 8.7);
    lamp.attenuation = glm::dvec3(1.0, 0.0, 0.1);
    lamp.cone_angle = 50.0;
    lamp.exponent = 2.0;
    all.back().scene.lights.push_back(lamp);
  }
  all.push_back(density<float>("twenty lamps", 0.4));
  for (int i = 0; i < 20; ++i)
  {
    Light lamp;
    lamp.positional = true;
    lamp.position = glm::dvec3(30.0 * std::sin(i), 30.0 * std::cos(1.7 * i), 25.0 * std::sin(2.3 * i));
    lamp.diffuse = glm::dvec3(0.02 * (i % 7), 0.05, 0.03 * (i % 5));
    all.back().scene.lights.push_back(lamp);
  }
  all.push_back(density<float>("cropped and clipped", 0.6));
  {
    Volume& volume = all.back().scene.volumes[0];
    volume.cropping.enabled = true;
    volume.cropping.regions = 0x2000 | 1;
    for (int a = 0; a < 3; ++a)
    {
      volume.cropping.lower[a] = 5.5;
      volume.cropping.upper[a] = 13.2;
    }
    volume.clipping_planes = { glm::dvec4(glm::normalize(glm::dvec3(1.0, 0.4, -0.2)), -6.0) };
  }
  all.push_back(density<float>("classified", 1.0));
  classify(all.back().scene.volumes[0]);
  all.push_back(density<float>("two volumes", 0.3));
  {
    Scene& scene = all.back().scene;
    scene.volumes.push_back(scene.volumes[0]);
    scene.volumes[1].world_from_data = placed(glm::dvec3(0.7, 0.7, 0.9), glm::dvec3(6.0, 3.0, 1.0));
    scene.volumes[1].medium.lobes.clear();
    scene.volumes[1].density.channels = glm::dvec3(0.5, 0.8, 1.0);
    scene.volumes[1].weight = 1.5;
  }
  all.push_back(density<float>("glowing", 0.3));
  all.back().scene.volumes[0].medium.emission = glm::dvec3(0.05, 0.1, 0.02);
  all.back().scene.volumes[0].medium.albedo = glm::dvec3(0.0); // the reference does not scatter it
  all.push_back(density<float>("glowing without extinction", 0.0));
  all.back().scene.volumes[0].medium.emission = glm::dvec3(0.05, 0.1, 0.02);
  all.push_back(density<float>("unlit beside lit", 0.3));
  {
    Scene& scene = all.back().scene;
    scene.volumes.push_back(scene.volumes[0]);
    classify(scene.volumes[1]);
    scene.volumes[1].medium.lit = false;
    scene.volumes[0].medium.albedo = glm::dvec3(0.0);
    scene.volumes[1].world_from_data = placed(glm::dvec3(0.5, 0.5, 0.5), glm::dvec3(2.0, 3.0, 1.0));
  }
  all.push_back(density<float>("cells, of a weaker colour", 0.8));
  all.back().scene.volumes[0].grid.cell_centred = true;
  all.back().scene.volumes[0].density.channels = glm::dvec3(0.5, 0.5, 0.25);
  all.push_back(density<float>("nearest voxels", 0.5));
  all.back().scene.volumes[0].grid.linear = false;
  all.push_back(density<float>("masked, by gradient", 1.0));
  {
    Volume& volume = all.back().scene.volumes[0];
    classify(volume);
    volume.classification.gradient_opacity = { 0.1, 0.6, 1.0 };
    volume.classification.gradient_upper = 0.5;
    auto voxels = std::static_pointer_cast<Voxels<float>>(all.back().voxels);
    auto labels = std::make_shared<std::vector<std::uint8_t>>(voxels->values.size());
    for (std::size_t i = 0; i < labels->size(); ++i)
    {
      (*labels)[i] = i / 5 % 3 == 0;
    }
    volume.mask.labels = labels->data();
    volume.mask.classification_of_label[1] = Mask::hidden;
    all.back().voxels = std::make_shared<std::pair<std::shared_ptr<void>, decltype(labels)>>(voxels, labels);
  }
  all.push_back(density<float>("behind a surface", 0.5));
  all.back().scene.surface_depth.assign(edge * edge, 0.99833f);
  all.push_back(density<float>("not a number here and there", 0.5));
  {
    auto voxels = std::static_pointer_cast<Voxels<float>>(all.back().voxels);
    for (std::size_t i = 0; i < voxels->values.size(); i += 97)
    {
      voxels->values[i] = i % 2 ? NAN : INFINITY;
    }
  }
  return all;
}

Film trace(const Scene& scene, const PathSettings& settings, int width = edge, int height = edge)
{
  Film film(width, height);
  PathTracer tracer;
  EXPECT_TRUE(tracer.render(scene, settings, film).completed);
  return film;
}

}

// The same light, found by quadrature in double precision.
TEST(PathScenes, OneScatteringIsTheReferences)
{
  for (const Named& named : scenes())
  {
    Film truth(edge, edge);
    ReferenceSettings exact;
    exact.tolerance = 5e-4;
    exact.most_pieces = 4;
    ASSERT_TRUE(render_reference(named.scene, exact, truth).completed);
    PathSettings settings;
    settings.samples_per_pixel = samples;
    settings.most_scatterings = 1;
    const Film film = trace(named.scene, settings);
    const Agreement a = agreement(film, truth);
    std::cout << named.name << ": " << a.mean << " standard errors off, mean square " << a.square
              << ", of " << a.count << " pixels\n";
    EXPECT_GT(a.count, edge * edge / 8) << named.name;
    EXPECT_LE(a.mean, 4.0) << named.name;
    EXPECT_LE(a.square, samples < 400 ? 6.0 : 2.5) << named.name; // few samples are skew
    EXPECT_LE(a.lost, 3) << named.name; // rays that graze
    for (std::size_t i = 0; i < film.size(); ++i)
    {
      // The marcher's steps of an eighth of a voxel; the classification and mask are as steep as they come.
      ASSERT_NEAR(film.transmittance[0][i], truth.transmittance[0][i], 2e-2) << named.name;
    }
  }
}

// Same seed, same bytes, whatever the threads and however often it was interrupted; another seed,
// another picture of the same mean.
TEST(PathScenes, AreTheSameForAllThreadsAndPasses)
{
  const Named named = density<float>("floats", 0.5);
  PathSettings settings;
  settings.samples_per_pixel = 24;
  settings.threads = 1;
  const Film one = trace(named.scene, settings);
  settings.threads = 5;
  EXPECT_TRUE(same_bits(one, trace(named.scene, settings)));
  Film film(edge, edge);
  PathTracer tracer;
  for (int samples : { 1, 3, 8, 24 })
  {
    settings.samples_per_pixel = samples;
    const PathStatistics s = tracer.render(named.scene, settings, film);
    EXPECT_EQ(s.samples_per_pixel, samples);
    settings.resume = true;
  }
  EXPECT_TRUE(same_bits(one, film));
  settings.resume = false;
  settings.seed = 2;
  EXPECT_FALSE(same_bits(one, trace(named.scene, settings)));
}

// A volume cut in two, whose halves are tracked apart and read in another way (cut volumes have no
// control extinction and no plain voxels), sends what the whole sends, after any number of scatterings.
TEST(PathScenes, HalvesSendWhatTheWholeSends)
{
  Named named = density<float>("floats", 1.2);
  named.scene.sky.radiance = glm::dvec3(0.5, 0.6, 0.9);
  Named cut = named;
  cut.scene.volumes.push_back(cut.scene.volumes[0]);
  cut.scene.volumes[0].clipping_planes = { glm::dvec4(1.0, 0.0, 0.0, -9.3) };
  cut.scene.volumes[1].clipping_planes = { glm::dvec4(-1.0, 0.0, 0.0, 9.3) };
  PathSettings settings;
  settings.samples_per_pixel = samples;
  const Film whole = trace(named.scene, settings);
  settings.seed = 77;
  const Film halves = trace(cut.scene, settings);
  double sum = 0.0;
  double variance = 0.0;
  double squares = 0.0;
  int count = 0;
  for (std::size_t i = 0; i < whole.size(); ++i)
  {
    const double sigma = std::hypot(whole.error[i], halves.error[i]) / 3.0;
    if (sigma > 0.0)
    {
      const double off = double(whole.radiance[0][i]) - halves.radiance[0][i];
      sum += off;
      variance += sigma * sigma;
      squares += off * off / (sigma * sigma);
      ++count;
    }
  }
  EXPECT_LE(std::abs(sum) / std::sqrt(variance), 3.5);
  EXPECT_LE(squares / count, 1.3);
}

TEST(PathScenes, StopWhenTheyAreAskedTo)
{
  const Named named = density<float>("floats", 0.5);
  Film film(edge, edge);
  PathTracer tracer;
  PathSettings settings;
  settings.samples_per_pixel = 1 << 20;
  settings.tolerance = 0.2;
  PathStatistics s = tracer.render(named.scene, settings, film);
  EXPECT_LE(s.estimated_error, 0.2);
  EXPECT_GE(s.samples_per_pixel, 16);
  EXPECT_LT(s.samples_per_pixel, 1 << 14);
  settings.tolerance = 0.0;
  settings.seconds = 0.2;
  s = tracer.render(named.scene, settings, film);
  EXPECT_LT(s.samples_per_pixel, 1 << 20); // how many is the machine's to say
  int asked = 0;
  s = tracer.render(named.scene, settings, film, [&](double) { return ++asked < 3; });
  EXPECT_FALSE(s.completed);
  EXPECT_TRUE(all_finite(film));
  settings.samples_per_pixel = 0;
  EXPECT_THROW(tracer.render(named.scene, settings, film), std::invalid_argument);
}
