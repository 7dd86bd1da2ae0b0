// Scenes and settings without the effects that are off; names; sums of plans.
#include "Transport/effect_plan.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

using namespace brume;

namespace
{

EffectSet all_but(Effect effect)
{
  EffectSet set;
  set.set(effect, false);
  return set;
}

/// A density with everything that light can do.
Scene lit_density()
{
  Scene scene;
  Volume& volume = scene.volumes[0];
  volume.meaning = ValueMeaning::Density;
  volume.density.extinction = 6.0;
  volume.density.channels = { 1.0, 0.5, 0.6 };
  volume.medium_revision = 7;
  Medium& medium = volume.medium;
  medium.lit = true;
  medium.albedo = { 0.9, 0.8, 0.7 };
  medium.lobes = { { PhaseFunction::HenyeyGreenstein, 1.0, 0.8 } };
  medium.octaves.count = 4;
  medium.emission = { 0.1, 0.2, 0.3 };
  medium.black_body = 2.0;
  medium.silver_lining.enabled = true;
  medium.powder.enabled = true;
  scene.lights.resize(2);
  scene.sky.radiance = { 0.3, 0.4, 0.5 };
  scene.sky.ground = { 0.1, 0.1, 0.1 };
  scene.fog.enabled = true;
  scene.fog.extinction = { 0.1, 0.2, 0.6 };
  scene.fog.lobes = medium.lobes;
  scene.surface_depth = { 0.5f };
  return scene;
}

Scene shaded_classified()
{
  Scene scene;
  scene.volumes[0].shading.enabled = true;
  scene.lights.resize(1);
  return scene;
}

TEST(Effects, HaveNamesOfTheirOwn)
{
  std::set<std::string> names;
  for (int i = 0; i < effect_count; ++i)
  {
    names.insert(effect_name(static_cast<Effect>(i)));
    EXPECT_GE(effect_cost(static_cast<Effect>(i)), 0.0);
  }
  EXPECT_EQ(names.size(), std::size_t(effect_count));
  EXPECT_EQ(names.count(""), 0u);
}

TEST(Effects, OneGoesAndTheOthersStay)
{
  const Scene scene = lit_density();
  const auto without = [&](Effect effect) { return simplified(scene, all_but(effect)); };
  EXPECT_TRUE(without(Effect::PhaseAnisotropy).volumes[0].medium.lobes.empty());
  EXPECT_TRUE(without(Effect::PhaseAnisotropy).fog.lobes.empty());
  EXPECT_EQ(without(Effect::PhaseAnisotropy).lights.size(), 2u);
  EXPECT_EQ(without(Effect::Octaves).volumes[0].medium.octaves.count, 1);
  EXPECT_EQ(without(Effect::Octaves).volumes[0].medium.lobes.size(), 1u);
  EXPECT_EQ(without(Effect::Ambient).sky.radiance, glm::dvec3(0.0));
  EXPECT_EQ(without(Effect::Ambient).sky.ground, glm::dvec3(0.0));
  EXPECT_EQ(without(Effect::Ambient).lights.size(), 2u);
  EXPECT_EQ(without(Effect::Emission).volumes[0].medium.emission, glm::dvec3(0.0));
  EXPECT_EQ(without(Effect::Emission).volumes[0].medium.black_body, 0.0);
  EXPECT_TRUE(without(Effect::Emission).volumes[0].medium.lit);
  EXPECT_FALSE(without(Effect::SilverLining).volumes[0].medium.silver_lining.enabled);
  EXPECT_FALSE(without(Effect::Powder).volumes[0].medium.powder.enabled);
  EXPECT_FALSE(without(Effect::Fog).fog.enabled);
  EXPECT_TRUE(without(Effect::Surfaces).surface_depth.empty());
  const Scene whole = simplified(scene, EffectSet());
  EXPECT_EQ(whole.volumes[0].medium.octaves.count, 4);
  EXPECT_EQ(whole.volumes[0].medium_revision, 7u);
  EXPECT_EQ(whole.volumes[0].density.channels, scene.volumes[0].density.channels);
  EXPECT_EQ(whole.surface_depth.size(), 1u);
  EXPECT_TRUE(whole.fog.enabled);
}

TEST(Effects, EqualChannelsKeepTheMeanExtinction)
{
  const Scene scene = simplified(lit_density(), all_but(Effect::ColouredExtinction));
  const Volume& volume = scene.volumes[0];
  EXPECT_EQ(volume.density.channels, glm::dvec3(1.0));
  EXPECT_NEAR(volume.density.extinction, 6.0 * 0.7, 1e-12);
  EXPECT_NEAR(scene.fog.extinction.x, 0.3, 1e-12);
  EXPECT_EQ(scene.fog.extinction.x, scene.fog.extinction.z);
  // Another matter has another key, the same one each time.
  EXPECT_NE(volume.medium_revision, 7u);
  EXPECT_NE(volume.medium_revision, 0u);
  EXPECT_EQ(
    simplified(lit_density(), all_but(Effect::ColouredExtinction)).volumes[0].medium_revision,
    volume.medium_revision);
  Scene unkept = lit_density();
  unkept.volumes[0].medium_revision = 0;
  EXPECT_EQ(simplified(unkept, all_but(Effect::ColouredExtinction)).volumes[0].medium_revision, 0u);
}

TEST(Effects, ADensityThatSendsNothingIsNoLitMedium)
{
  EffectSet on = all_but(Effect::Scattering);
  const Scene glows = simplified(lit_density(), on);
  EXPECT_TRUE(glows.volumes[0].medium.lit);
  EXPECT_EQ(glows.volumes[0].medium.albedo, glm::dvec3(0.0));
  EXPECT_TRUE(glows.lights.empty());
  EXPECT_EQ(glows.sky.radiance, glm::dvec3(0.0));
  on.set(Effect::Emission, false);
  EXPECT_FALSE(simplified(lit_density(), on).volumes[0].medium.lit);
  // Nor is one that no light reaches.
  Scene night = lit_density();
  night.lights.clear();
  EXPECT_TRUE(simplified(night, all_but(Effect::Emission)).volumes[0].medium.lit);
  EffectSet dark = all_but(Effect::Emission);
  dark.set(Effect::Ambient, false);
  EXPECT_FALSE(simplified(night, dark).volumes[0].medium.lit);
}

TEST(Effects, ShadingOfWhatIsNotLitKeepsItsLights)
{
  const Scene scene = simplified(shaded_classified(), all_but(Effect::Scattering));
  EXPECT_EQ(scene.lights.size(), 1u);
  EXPECT_TRUE(scene.volumes[0].shading.enabled);
  EXPECT_FALSE(scene.volumes[0].medium.lit);
  EXPECT_FALSE(
    simplified(shaded_classified(), all_but(Effect::GradientShading)).volumes[0].shading.enabled);
  // Beside it, a lit volume still sends nothing on.
  Scene both = shaded_classified();
  both.volumes.push_back(lit_density().volumes[0]);
  const Scene without = simplified(both, all_but(Effect::Scattering));
  EXPECT_EQ(without.lights.size(), 1u);
  EXPECT_EQ(without.volumes[1].medium.albedo, glm::dvec3(0.0));
}

TEST(Effects, ClassifiedMatterWithoutEmissionIsBlack)
{
  const Volume volume = simplified(shaded_classified(), all_but(Effect::Emission)).volumes[0];
  EXPECT_TRUE(volume.medium.lit);
  EXPECT_EQ(volume.medium.albedo, glm::dvec3(0.0));
  EXPECT_EQ(volume.medium.emission, glm::dvec3(0.0));
  EXPECT_FALSE(volume.shading.enabled);
}

TEST(Effects, ProjectionsKeepTheirColours)
{
  Scene scene = shaded_classified();
  scene.blend_mode = BlendMode::Isosurface;
  EffectSet none;
  for (int i = 0; i < effect_count; ++i)
  {
    none.set(static_cast<Effect>(i), false);
  }
  none.set(Effect::GradientShading, true);
  const Scene same = simplified(scene, none);
  EXPECT_FALSE(same.volumes[0].medium.lit);
  EXPECT_TRUE(same.volumes[0].shading.enabled);
  EXPECT_EQ(same.lights.size(), 1u);
  none.set(Effect::GradientShading, false);
  EXPECT_FALSE(simplified(scene, none).volumes[0].shading.enabled);
}

TEST(Effects, SettingsAreSwitchedOffAlone)
{
  MarchSettings settings;
  apply_effects(EffectSet(), settings);
  EXPECT_TRUE(settings.absorption);
  EXPECT_TRUE(settings.leaping);
  EXPECT_EQ(settings.shadows, ShadowMethod::Volume);
  EffectSet on = all_but(Effect::Shadows);
  on.set(Effect::Absorption, false);
  on.set(Effect::SpaceLeaping, false);
  apply_effects(on, settings);
  EXPECT_FALSE(settings.absorption);
  EXPECT_FALSE(settings.leaping);
  EXPECT_EQ(settings.shadows, ShadowMethod::None);
  apply_effects(EffectSet(), settings); // what a caller has off stays off
  EXPECT_FALSE(settings.absorption);
}

TEST(Effects, PlansAddUp)
{
  EffectPlan plan;
  for (int i = 0; i < effect_count; ++i)
  {
    plan.effects[i].effect = static_cast<Effect>(i);
    plan.effects[i].on = i % 2 == 0;
    plan.effects[i].error_bound = i % 2 ? 0.01 : 0.0;
  }
  EXPECT_NEAR(plan.error_bound(), 0.07, 1e-12);
  EXPECT_TRUE(plan.on().has(Effect::Absorption));
  EXPECT_FALSE(plan.on().has(Effect::Emission));
  EXPECT_FALSE(plan[Effect::Emission].on);
  double cost = 0.0;
  for (int i = 0; i < effect_count; i += 2)
  {
    cost += effect_cost(static_cast<Effect>(i));
  }
  EXPECT_NEAR(plan.expected_cost(), cost, 1e-12);
}

}
