#include "../support/transport_scenes.h"

#include "Transport/reference.h"
#include "Transport/step_control.h"

#include <gtest/gtest.h>

using namespace transport_scenes;

namespace
{

/// A ball whose edge is `softness` voxels wide.
Voxels<float> ball(double softness)
{
  return Voxels<float>(40, 40, 40, [&](int i, int j, int k)
    {
      const double r = std::sqrt((i - 19.5) * (i - 19.5) + (j - 19.5) * (j - 19.5) +
        (k - 19.5) * (k - 19.5));
      return 1.0 / (1.0 + std::exp((r - 13.0) * 4.0 / softness));
    });
}

Scene scene_of(const Voxels<float>& voxels, double threshold, double opacity = 0.1)
{
  Scene scene;
  scene.volumes[0].grid = voxels.grid();
  scene.volumes[0].classification = classify(
    0.0,
    1.0,
    [&](double v) { return opacity / (1.0 + std::exp(-(v - 0.5) * threshold)); },
    [](double v) { return glm::dvec3(1.0, 0.5 + 0.5 * v, 0.2); });
  scene.camera = view_of(scene, glm::dvec3(-0.5, 0.3, -0.9), false).camera(1.0);
  return scene;
}

StepChoice choose(const Scene& scene, double tolerance)
{
  Marcher marcher;
  return choose_step(marcher, scene, tolerance);
}

TEST(ChooseStep, TakesLongerStepsWhereThePictureIsSmooth)
{
  const Voxels<float> soft = ball(8.0);
  const Voxels<float> hard = ball(1.0);
  const StepChoice smooth = choose(scene_of(soft, 3.0), 0.003);
  const StepChoice sharp = choose(scene_of(hard, 400.0, 0.9), 0.003);
  EXPECT_TRUE(smooth.met);
  EXPECT_GE(smooth.step, 2.0);
  EXPECT_LE(sharp.step, 0.5);
  // A looser tolerance never gives a shorter step.
  double last = 0.0;
  for (double tolerance : { 1e-6, 1e-4, 1e-3, 1e-2, 1e-1, 1.0 })
  {
    const StepChoice choice = choose(scene_of(hard, 30.0, 0.9), tolerance);
    EXPECT_GE(choice.step, last);
    EXPECT_EQ(choice.met, choice.estimated_error <= tolerance);
    last = choice.step;
  }
}

TEST(ChooseStep, CountsInTheSmallestVoxelEdge)
{
  const Voxels<float> soft = ball(8.0);
  Scene scene = scene_of(soft, 3.0);
  scene.volumes[0].data_from_index = placed(glm::dvec3(0.5, 2.0, 1.0), glm::dvec3(0.0));
  EXPECT_DOUBLE_EQ(smallest_voxel_edge(scene), 0.5);
  scene.camera = view_of(scene, glm::dvec3(-0.5, 0.3, -0.9), false).camera(1.0);
  EXPECT_DOUBLE_EQ(choose(scene, 1.0).step, 2.0);
}

/// One picture with the steps that were chosen.
Film march(const Scene& scene, const StepChoice& choice, int size)
{
  Film film(size, size);
  MarchSettings settings;
  settings.rule = choice.rule;
  settings.step = choice.step;
  settings.refinements = choice.refinements;
  settings.refine_error = choice.refine_error;
  settings.leave_error = 0.0;
  Marcher().render(scene, settings, film);
  return film;
}

// What it calls met is met: the whole picture against the reference, with a little room for the
// pixels that were not probed.
TEST(ChooseStep, MetMeansMet)
{
  for (double softness : { 1.0, 3.0, 8.0 })
  {
    const Voxels<float> voxels = ball(softness);
    for (double threshold : { 3.0, 30.0, 400.0 })
    {
      const Scene scene = scene_of(voxels, threshold, 0.3);
      ReferenceSettings settings;
      settings.tolerance = 1e-5;
      Film truth(48, 48);
      render_reference(scene, settings, truth);
      for (double tolerance : { 0.03, 0.003 })
      {
        const StepChoice choice = choose(scene, tolerance);
        const double error = difference(march(scene, choice, 48), truth);
        if (choice.met)
        {
          EXPECT_LE(error, 1.25 * tolerance) << "softness " << softness << ", threshold "
                                             << threshold << ", step " << choice.step;
        }
        EXPECT_LE(error, 2.0 * choice.estimated_error + 1e-4)
          << "softness " << softness << ", threshold " << threshold << ", step " << choice.step;
      }
    }
  }
}

// The first volume is nearly even, what needs short steps lies beside it.
TEST(ChooseStep, LooksAtAllVolumes)
{
  const Voxels<float> soft = ball(8.0);
  const Voxels<float> hard = ball(0.5);
  Scene scene = scene_of(soft, 3.0);
  Scene sharp = scene_of(hard, 400.0, 0.9);
  sharp.volumes[0].data_from_index = placed(glm::dvec3(1.0), glm::dvec3(60.0, 0.0, 0.0));
  const StepChoice alone = choose(sharp, 0.003);
  scene.volumes.push_back(sharp.volumes[0]);
  View view = view_of(scene, glm::dvec3(0.1, 0.2, -1.0), true);
  view.centre.x += 30.0;
  view.half_height *= 2.0;
  scene.camera = view.camera(1.0);
  const StepChoice both = choose(scene, 0.003);
  EXPECT_LE(alone.step, 0.5);
  EXPECT_LE(both.step, 0.5);
}

// Where no light volume does, rays through one density go cell by cell, whatever was tried before.
TEST(ChooseShadows, RaysThroughOneDensityAreExact)
{
  const Voxels<float> voxels = ball(0.5);
  Scene scene = scene_of(voxels, 3.0);
  scene.volumes[0].meaning = ValueMeaning::Density;
  scene.volumes[0].density.extinction = 4.0;
  scene.volumes[0].medium.lit = true;
  Light sun;
  sun.direction = glm::normalize(glm::dvec3(-0.6, 0.35, -0.7));
  scene.lights = { sun };
  Marcher marcher;
  const ShadowChoice choice = choose_shadows(marcher, scene, 1.1e-4);
  EXPECT_EQ(choice.method, ShadowMethod::Rays);
  EXPECT_EQ(choice.step, 0.0);
  EXPECT_TRUE(choice.met);
}

}
