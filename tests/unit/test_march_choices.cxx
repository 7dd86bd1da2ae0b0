// What is settled before a march, and for how long it holds.
#include "../../modules/Mappers/march_choices.h"

#include "Transport/film.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <vector>

using namespace brume;

namespace
{

/// A slab of density 1, thin along z, lit from above; it is alone in owning its voxels.
struct Slab
{
  static constexpr int nx = 24, ny = 24, nz = 5;
  std::vector<float> voxels = std::vector<float>(nx * ny * nz, 1.0f);
  Scene scene;
  Marcher marcher;
  MarchChoices choices;
  ChoiceSettings wanted;

  explicit Slab(bool lit = true)
  {
    Volume& v = scene.volumes[0];
    v.grid.voxels = voxels.data();
    v.grid.type = VoxelType::Float32;
    v.grid.dims[0] = nx;
    v.grid.dims[1] = ny;
    v.grid.dims[2] = nz;
    v.meaning = ValueMeaning::Density;
    v.density.extinction = 0.05;
    v.medium.lit = lit;
    v.data_revision = 1;
    v.medium_revision = 2;
    scene.lights.resize(1);
    look_along({ 0, 0, -1 });
  }
  void look_along(const glm::dvec3& direction)
  {
    const glm::dvec3 centre(0.5 * (nx - 1), 0.5 * (ny - 1), 0.5 * (nz - 1));
    scene.camera.clip_from_world =
      glm::ortho(-20.0, 20.0, -20.0, 20.0, 1.0, 100.0) *
      glm::lookAt(centre - 50.0 * direction, centre, glm::dvec3(0, 1, 0));
    scene.camera.direction = direction;
  }
  void update() { choices.Update(marcher, scene, wanted); }
  double bound(Effect effect) { return choices.GetPlan()[effect].error_bound; }
};

TEST(MarchChoices, PlainScenesAreMarchedAsTheyAre)
{
  Slab slab(false);
  slab.wanted.tolerance = 0.02;
  slab.wanted.jitter = true;
  slab.wanted.threads = 2;
  slab.update();
  EXPECT_EQ(&slab.choices.GetScene(), &slab.scene);
  EXPECT_EQ(slab.choices.GetPlan().error_bound(), 0.0);
  const MarchSettings& settings = slab.choices.GetSettings();
  EXPECT_EQ(settings.leave_error, 0.005);
  EXPECT_TRUE(settings.jitter);
  EXPECT_EQ(settings.threads, 2);
  EXPECT_TRUE(settings.absorption);
  EXPECT_TRUE(settings.leaping);
  EXPECT_EQ(settings.shadows, ShadowMethod::None);
  const StepChoice expected = choose_step(slab.marcher, slab.scene, 0.015, 2);
  EXPECT_EQ(settings.rule, expected.rule);
  EXPECT_EQ(settings.step, expected.step);
  EXPECT_EQ(slab.choices.GetEstimatedError(), 0.005 + expected.estimated_error);
  EXPECT_EQ(slab.choices.IsToleranceMet(), expected.met);
}

// However thin: without lit matter pictures are VTK's.
TEST(MarchChoices, PlansOfPlainScenesLeaveNothingOutThatMatters)
{
  Slab slab(false);
  slab.scene.volumes[0].density.extinction = 1e-5;
  slab.wanted.tolerance = 0.5;
  slab.update();
  EXPECT_TRUE(slab.choices.GetPlan()[Effect::Absorption].on);
  EXPECT_EQ(slab.choices.GetPlan().error_bound(), 0.0);
}

TEST(MarchChoices, WhatIsForcedOffIsOutOfTheScene)
{
  Slab slab;
  slab.update();
  EXPECT_FALSE(slab.choices.GetScene().lights.empty());
  slab.wanted.forces = { { Effect::Scattering, false }, { Effect::Absorption, false } };
  slab.update();
  EXPECT_TRUE(slab.choices.GetScene().lights.empty());
  EXPECT_FALSE(slab.choices.GetSettings().absorption);
  EXPECT_GT(slab.bound(Effect::Scattering), 0.001);
  EXPECT_TRUE(slab.choices.GetPlan()[Effect::Scattering].forced);
  EXPECT_GE(slab.choices.GetEstimatedError(), slab.bound(Effect::Scattering));
  EXPECT_FALSE(slab.scene.lights.empty()) << "the whole scene stays as it is";
}

TEST(MarchChoices, PlansAreMadeForTheViewButOfCoarsePictures)
{
  Slab slab;
  slab.wanted.forces = { { Effect::Absorption, false } };
  slab.update();
  const double through = slab.bound(Effect::Absorption); // 0.05 · 4: 1 − e^(−0.2) at the least
  EXPECT_GT(through, 0.18);
  slab.look_along({ 1, 0, 0 });
  slab.wanted.coarse = true;
  slab.update();
  const double coarse = slab.bound(Effect::Absorption);
  slab.wanted.coarse = false;
  slab.update();
  const double along = slab.bound(Effect::Absorption); // 0.05 · 23
  EXPECT_GT(along, 0.68);
  EXPECT_LT(through, 0.6 * along);
  // A coarse picture has a plan of its own kind, which another view does not end.
  slab.look_along({ 0, 0, -1 });
  slab.wanted.coarse = true;
  slab.update();
  const double first = slab.bound(Effect::Absorption);
  slab.look_along({ 1, 0, 0 });
  slab.update();
  EXPECT_EQ(slab.bound(Effect::Absorption), first);
  EXPECT_GT(coarse, 0.0);
}

TEST(MarchChoices, ShadowsAreThoseAskedForOrChosen)
{
  Slab slab;
  slab.wanted.choose_shadows = false;
  slab.wanted.shadows = ShadowMethod::Functions;
  slab.wanted.shadow_step = 0.5;
  slab.wanted.forces = { { Effect::Shadows, true } };
  slab.update();
  EXPECT_EQ(slab.choices.GetSettings().shadows, ShadowMethod::Functions);
  EXPECT_EQ(slab.choices.GetSettings().shadow_step, 0.5);
  EXPECT_FALSE(slab.choices.GetSettings().precise_shadows);
  EXPECT_FALSE(slab.choices.HasChosenShadows());
  slab.wanted.tolerance = 1e-4;
  slab.update();
  EXPECT_TRUE(slab.choices.GetSettings().precise_shadows);
  slab.wanted.choose_shadows = true;
  slab.wanted.shadow_step = 0.0;
  slab.update();
  EXPECT_TRUE(slab.choices.HasChosenShadows());
  const ShadowChoice chosen = choose_shadows(slab.marcher, slab.choices.GetScene(), 0.25e-4);
  EXPECT_EQ(slab.choices.GetSettings().shadows, chosen.method);
  EXPECT_EQ(slab.choices.GetSettings().shadow_step, chosen.step);
  // Asked for again, and back: what was chosen is still known.
  slab.wanted.choose_shadows = false;
  slab.wanted.shadows = ShadowMethod::None;
  slab.update();
  EXPECT_EQ(slab.choices.GetSettings().shadows, ShadowMethod::None);
  EXPECT_FALSE(slab.choices.HasChosenShadows());
  slab.wanted.choose_shadows = true;
  slab.update();
  EXPECT_EQ(slab.choices.GetSettings().shadows, chosen.method);
  slab.wanted.forces = { { Effect::Shadows, false } };
  slab.update();
  EXPECT_EQ(slab.choices.GetSettings().shadows, ShadowMethod::None);
}

// A choice that was made without an effect does not hold with it; one made with it holds without.
TEST(MarchChoices, EffectsThatComeOnChooseStepsAnew)
{
  Slab slab;
  slab.voxels.assign(slab.voxels.size(), 0.0f);
  for (int i = 0; i < static_cast<int>(slab.voxels.size()); ++i)
  {
    slab.voxels[i] = i % 3 ? 20.0f : 0.0f; // rough, and dark behind
  }
  slab.scene.lights[0].direction = glm::normalize(glm::dvec3(1.0, 0.3, 0.2));
  slab.wanted.choose_shadows = false;
  slab.wanted.shadows = ShadowMethod::Rays;
  slab.wanted.forces = { { Effect::Shadows, false } };
  slab.update();
  const double without = slab.choices.GetSettings().step;
  slab.wanted.forces = { { Effect::Shadows, true } };
  slab.update();
  const double with = slab.choices.GetSettings().step;
  Slab fresh;
  fresh.voxels = slab.voxels;
  fresh.scene.lights = slab.scene.lights;
  fresh.wanted = slab.wanted;
  fresh.update();
  EXPECT_EQ(with, fresh.choices.GetSettings().step);
  EXPECT_NE(with, without);
  slab.wanted.forces = { { Effect::Shadows, false } };
  slab.update();
  EXPECT_EQ(slab.choices.GetSettings().step, with);
}

TEST(MarchChoices, StepsMayBeTheCallers)
{
  Slab slab;
  slab.wanted.choose_step = false;
  slab.wanted.step = 0.3;
  slab.update();
  EXPECT_EQ(slab.choices.GetSettings().step, 0.3);
  EXPECT_EQ(slab.choices.GetSettings().rule, StepRule::Midpoint);
  EXPECT_EQ(slab.choices.GetSettings().refinements, 0);
}

}
