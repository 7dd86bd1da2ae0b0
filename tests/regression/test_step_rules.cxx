// The rules of steps against the truth in double precision: what each is exact for, how the error of
// each falls, and whether the estimate that a pixel carries holds.
#include "../support/transport_scenes.h"

#include "Transport/reference.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace transport_scenes;

namespace
{

constexpr int size = 48;

double bumpy(double x, double y, double z)
{
  return 0.5 + 0.25 * std::sin(0.9 * x) * std::cos(0.7 * y + 1.0) + 0.2 * std::sin(0.8 * z);
}

Voxels<float> noise_voxels(unsigned seed)
{
  std::mt19937 random(seed);
  return Voxels<float>(17, 15, 13,
    [&](int, int, int) { return static_cast<float>(random() % 1000) / 1000.0f; });
}

Voxels<float> smooth_voxels()
{
  return Voxels<float>(
    24, 24, 24, [](int i, int j, int k) { return bumpy(0.3 * i, 0.3 * j, 0.3 * k); });
}

Scene scene_of(const Voxels<float>& voxels, const glm::dvec3& forward, bool parallel = false)
{
  Scene scene;
  scene.volumes[0].grid = voxels.grid();
  scene.volumes[0].data_from_index = placed(glm::dvec3(0.5, 1.0, 0.8), glm::dvec3(3.0, -2.0, 7.0));
  scene.camera = view_of(scene, forward, parallel).camera(1.0);
  return scene;
}

Film march(const Scene& scene, StepRule rule, double step, bool jitter = false)
{
  Film film(size, size);
  MarchSettings settings;
  settings.rule = rule;
  settings.step = step;
  settings.leave_error = 0.0;
  settings.jitter = jitter;
  const MarchStatistics statistics = Marcher().render(scene, settings, film);
  EXPECT_EQ(statistics.rule, rule);
  return film;
}

Film truth_of(const Scene& scene)
{
  Film truth(size, size);
  ReferenceSettings settings;
  settings.tolerance = 1e-6;
  settings.most_pieces = 1024;
  render_reference(scene, settings, truth);
  return truth;
}

/// The largest difference, relative, of what the transmittances say of optical depth.
double depth_error(const Film& film, const Film& truth)
{
  double most = 0.0;
  for (std::size_t i = 0; i < film.size(); ++i)
  {
    most = std::max(most,
      std::abs(double(film.transmittance[0][i]) - truth.transmittance[0][i]) /
        truth.transmittance[0][i]);
  }
  return most;
}

// A trilinear density is a cubic along a ray in a cell, however wild from cell to cell: two points
// are exact, whatever the step and however the ray lies.
TEST(Cells, AreExactForAnyTrilinearDensity)
{
  for (unsigned seed : { 1u, 2u, 3u })
  {
    const Voxels<float> voxels = noise_voxels(seed);
    for (const glm::dvec3& forward : { glm::dvec3(-0.5, 0.3, -0.9), glm::dvec3(0, 0, -1),
           glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 1e-4), glm::dvec3(1, 1, 1) })
    {
      for (bool linear : { true, false })
      {
        for (bool cells : { false, true })
        {
          Scene scene = scene_of(voxels, forward, seed == 2);
          scene.volumes[0].meaning = ValueMeaning::Density;
          scene.volumes[0].density.extinction = 0.2;
          scene.volumes[0].grid.linear = linear;
          scene.volumes[0].grid.cell_centred = cells;
          const Film truth = truth_of(scene);
          // Nearest voxels jump at borders that a ray may run along: rays there see either side.
          const bool along_borders = !linear && forward.x * forward.y * forward.z == 0.0;
          if (!along_borders)
          {
            EXPECT_LE(depth_error(march(scene, StepRule::Cells, 1.0), truth), 1e-5)
              << seed << " linear " << linear << " cells " << cells << " forward " << forward.x
              << ", " << forward.y << ", " << forward.z;
          }
        }
      }
    }
  }
}

TEST(Cells, LeapOverWhatIsEmpty)
{
  const Voxels<float> voxels(64, 40, 40,
    [](int i, int j, int k) { return i > 48 && j > 12 && k < 20 ? 1.0 + 0.1 * (i % 3) : 0.0; });
  Scene scene = scene_of(voxels, glm::dvec3(0.8, -0.2, 0.4));
  scene.volumes[0].meaning = ValueMeaning::Density;
  scene.volumes[0].density.extinction = 0.05;
  EXPECT_LE(depth_error(march(scene, StepRule::Cells, 1.0), truth_of(scene)), 1e-5);
}

Classification peak(double width)
{
  return classify(0.0, 1.0,
    [width](double v) { return std::abs(v - 0.5) < width ? 0.8 : 0.0; },
    [](double v) { return glm::dvec3(v, 1.0 - v, 0.5); });
}

// Values that run evenly along the ray make a thin peak of opacity a known optical depth, which long
// steps by the midpoint mostly miss.
TEST(Integrated, SeesPeaksThatFallBetweenSamples)
{
  const double width = 0.004;
  const Voxels<float> voxels(33, 9, 9, [](int i, int, int) { return i / 32.0; });
  Scene scene = scene_of(voxels, glm::dvec3(1.0, 0.0, 0.0), true);
  scene.volumes[0].data_from_index = glm::dmat4(1.0);
  scene.camera = view_of(scene, glm::dvec3(1.0, 0.0, 0.0), true).camera(1.0);
  scene.volumes[0].classification = peak(width);
  // −ln(1 − 0.8) a unit, over the 2 · width · 32 units in which the value is within the peak.
  const double depth = -std::log(0.2) * 2.0 * width * 32.0;
  const std::size_t middle = size / 2 * size + size / 2;
  for (double step : { 0.5, 1.0, 3.0, 7.0 })
  {
    const Film film = march(scene, StepRule::Integrated, step);
    EXPECT_NEAR(film.transmittance[0][middle], std::exp(-depth), 0.02 * depth) << step;
    EXPECT_NEAR(film.radiance[0][middle], 0.5 * (1.0 - std::exp(-depth)), 0.02 * depth) << step;
  }
  EXPECT_GT(march(scene, StepRule::Midpoint, 3.0).transmittance[0][middle], 0.99);
}

// Every table has its limits: values outside go on as the table's ends, also where a step leaves it.
TEST(Integrated, GoesOnBeyondTheEndsOfTheTable)
{
  const Voxels<float> voxels(33, 9, 9, [](int i, int, int) { return 3.0 * i / 32.0 - 1.0; });
  Scene scene = scene_of(voxels, glm::dvec3(1.0, 0.0, 0.0), true);
  scene.volumes[0].classification =
    classify(0.0, 1.0, [](double v) { return 0.05 + 0.1 * v; }, [](double v) { return glm::dvec3(v); });
  const Film truth = truth_of(scene);
  for (double step : { 0.4, 1.7, 5.0 })
  {
    const Film film = march(scene, StepRule::Integrated, step);
    double most = 0.0;
    for (std::size_t i = 0; i < film.size(); ++i)
    {
      most = std::max(most,
        std::abs(double(film.transmittance[0][i]) - truth.transmittance[0][i]));
    }
    EXPECT_LE(most, 2e-3) << step;
  }
}

// Of both rules the error falls with the square of the step where all is smooth.
TEST(Rules, ConvergeWithTheSquareOfTheStep)
{
  const Voxels<float> voxels = smooth_voxels();
  Scene scene = scene_of(voxels, glm::dvec3(-0.5, 0.3, -0.9));
  scene.volumes[0].classification = classify(0.0, 1.0, [](double v) { return 0.2 * v * v; },
    [](double v) { return glm::dvec3(v, 0.5, 1.0 - v); });
  const Film truth = truth_of(scene);
  for (StepRule rule : { StepRule::Midpoint, StepRule::Integrated })
  {
    const double coarse = difference(march(scene, rule, 1.0), truth);
    const double fine = difference(march(scene, rule, 0.25), truth);
    EXPECT_LE(fine, 0.12 * coarse + 2e-5) << step_rule_name(rule);
    EXPECT_LE(fine, 1e-3) << step_rule_name(rule);
  }
}

// The estimate is of the steps' order: not under the error for 97 pixels of 100, nor two hundred times
// it. (The spacing is ½, 1, 0.8: these are steps of half a voxel to two.)
TEST(Rules, TellTheErrorOfEachPixel)
{
  const Voxels<float> voxels = smooth_voxels();
  Scene scene = scene_of(voxels, glm::dvec3(-0.5, 0.3, -0.9));
  scene.volumes[0].classification = classify(0.0, 1.0,
    [](double v) { return 0.8 / (1.0 + std::exp(-30.0 * (v - 0.5))); },
    [](double v) { return glm::dvec3(v, 0.5, 1.0 - v); });
  const Film truth = truth_of(scene);
  for (StepRule rule : { StepRule::Midpoint, StepRule::Integrated })
  {
    for (double step : { 0.25, 0.5, 1.0 })
    {
      const Film film = march(scene, rule, step);
      int under = 0;
      double estimated = 0.0;
      double real = 0.0;
      for (std::size_t i = 0; i < film.size(); ++i)
      {
        double error = 0.0;
        for (int c = 0; c < 3; ++c)
        {
          error = std::max({ error,
            std::abs(double(film.radiance[c][i]) - truth.radiance[c][i]),
            std::abs(double(film.transmittance[c][i]) - truth.transmittance[c][i]) });
        }
        under += error > film.error[i] + 2e-4;
        estimated += film.error[i];
        real += error;
      }
      EXPECT_LE(under, size * size * 3 / 100) << step_rule_name(rule) << ' ' << step;
      EXPECT_GE(estimated, real) << step_rule_name(rule) << ' ' << step;
      EXPECT_LE(estimated, 200.0 * real) << step_rule_name(rule) << ' ' << step;
    }
  }
}

TEST(Rules, AreFollowedWhereTheyCanBe)
{
  const Voxels<float> voxels = smooth_voxels();
  Scene scene = scene_of(voxels, glm::dvec3(0, 0, -1));
  EXPECT_TRUE(follows_rule(scene, StepRule::Integrated));
  EXPECT_FALSE(follows_rule(scene, StepRule::Cells));
  scene.volumes[0].meaning = ValueMeaning::Density;
  EXPECT_FALSE(follows_rule(scene, StepRule::Integrated));
  EXPECT_TRUE(follows_rule(scene, StepRule::Cells));
  scene.volumes.push_back(scene.volumes[0]);
  EXPECT_FALSE(follows_rule(scene, StepRule::Cells));
  EXPECT_TRUE(follows_rule(scene, StepRule::Midpoint));
}

// Every instruction set draws the same picture to 10⁻⁵, by every rule.
TEST(Rules, AgreeOnEveryTarget)
{
  const Voxels<float> voxels = smooth_voxels();
  Scene scene = scene_of(voxels, glm::dvec3(-0.5, 0.3, -0.9));
  scene.volumes[0].classification = classify(0.0, 1.0,
    [](double v) { return 0.9 / (1.0 + std::exp(-30.0 * (v - 0.5))); },
    [](double v) { return glm::dvec3(v, 0.5, 1.0 - v); });
  Scene density = scene;
  density.volumes[0].meaning = ValueMeaning::Density;
  for (StepRule rule : { StepRule::Midpoint, StepRule::Integrated, StepRule::Cells })
  {
    const Scene& drawn = rule == StepRule::Cells ? density : scene;
    force_simd_target("");
    const Film best = march(drawn, rule, 0.5);
    for (const std::string& target : targets())
    {
      ASSERT_TRUE(force_simd_target(target));
      EXPECT_LE(difference(march(drawn, rule, 0.5), best), 1e-5)
        << step_rule_name(rule) << ' ' << target;
    }
    force_simd_target("");
  }
}

// Jitter moves the samples, not the picture: where all is smooth the error stays small, the same in
// every picture, and the optical depth of a constant is what it was.
TEST(Jitter, KeepsTheLengthOfRays)
{
  const Voxels<float> voxels(20, 20, 20, [](int, int, int) { return 1.0; });
  Scene scene = scene_of(voxels, glm::dvec3(-0.5, 0.3, -0.9));
  scene.volumes[0].meaning = ValueMeaning::Density;
  scene.volumes[0].density.extinction = 0.1;
  const Film plain = march(scene, StepRule::Midpoint, 0.7);
  EXPECT_LE(depth_error(march(scene, StepRule::Midpoint, 0.7, true), plain), 1e-5);

  const Voxels<float> smooth = smooth_voxels();
  Scene classified = scene_of(smooth, glm::dvec3(-0.5, 0.3, -0.9));
  classified.volumes[0].classification = classify(0.0, 1.0, [](double v) { return 0.3 * v * v; },
    [](double v) { return glm::dvec3(v); });
  const Film jittered = march(classified, StepRule::Midpoint, 2.0, true);
  EXPECT_TRUE(same_bits(jittered, march(classified, StepRule::Midpoint, 2.0, true)));
  EXPECT_FALSE(same_bits(jittered, march(classified, StepRule::Midpoint, 2.0)));
  EXPECT_LE(difference(jittered, truth_of(classified)), 0.02);
}

}
