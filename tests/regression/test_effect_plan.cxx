// Plans against pictures: what a plan leaves out changes no pixel by more than the plan says, and
// not by so much less that the bound is idle.
#include "../support/plan_scenes.h"

#include "Transport/effect_plan.h"
#include "Transport/fog_film.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>

using namespace brume;
using namespace plan_scenes;

namespace
{

constexpr double rounding = 2e-6;

class Pictures
{
public:
  explicit Pictures(const Scene& scene)
    : TheScene(scene)
  {
  }

  Film film(const EffectSet& effects)
  {
    Film film(pixels, pixels);
    MarchSettings settings;
    settings.step = 0.5 / (n - 1);
    settings.leave_error = 0.0;
    settings.shadows = ShadowMethod::Volume;
    settings.precise_shadows = true;
    apply_effects(effects, settings);
    TheMarcher.render(simplified(TheScene, effects), settings, film);
    return film;
  }

  /// The largest change of a pixel over white by switching one effect, the others as they are.
  double change(const EffectSet& effects, Effect effect)
  {
    EffectSet with = effects;
    with.set(effect, true);
    EffectSet without = effects;
    without.set(effect, false);
    return difference(film(with), film(without));
  }

  static double difference(const Film& a, const Film& b)
  {
    double most = 0.0;
    for (int c = 0; c < 3; ++c)
    {
      for (std::size_t i = 0; i < a.size(); ++i)
      {
        const double d = std::abs((double(a.radiance[c][i]) + a.transmittance[c][i]) -
                                  (double(b.radiance[c][i]) + b.transmittance[c][i]));
        most = d <= most ? most : d; // a NaN wins
      }
    }
    return most;
  }

  Marcher& marcher() { return TheMarcher; }

private:
  const Scene& TheScene;
  Marcher TheMarcher;
};

class Plans : public testing::TestWithParam<Case>
{
};

TEST_P(Plans, LeaveOutNoMoreThanTheySay)
{
  const Scene& scene = GetParam().scene;
  Pictures pictures(scene);
  const Film full = pictures.film(EffectSet());
  for (const double tolerance : { 0.0, 0.004, 0.05 })
  {
    const EffectPlan plan = plan_effects(pictures.marcher(), scene, tolerance);
    EXPECT_LE(plan.error_bound(), 0.25 * tolerance);
    EXPECT_LE(Pictures::difference(pictures.film(plan.on()), full), plan.error_bound() + rounding);
    for (const PlannedEffect& planned : plan.effects)
    {
      EXPECT_FALSE(planned.reason.empty());
      if (planned.on)
      {
        EXPECT_EQ(planned.error_bound, 0.0);
        continue;
      }
      const double change = pictures.change(plan.on(), planned.effect);
      SCOPED_TRACE(std::string(effect_name(planned.effect)) + ": " + planned.reason);
      EXPECT_LE(change, planned.error_bound + rounding);
      if (change > 1e-4)
      {
        EXPECT_LE(planned.error_bound, 20.0 * change);
      }
    }
  }
}

TEST_P(Plans, TellWhatAForcedEffectCosts)
{
  const Scene& scene = GetParam().scene;
  Pictures pictures(scene);
  const Film full = pictures.film(EffectSet());
  for (int i = 0; i < effect_count; ++i)
  {
    const auto effect = static_cast<Effect>(i);
    const EffectPlan plan = plan_effects(pictures.marcher(), scene, 0.0, { { effect, false } });
    EXPECT_FALSE(plan[effect].on);
    EXPECT_TRUE(plan[effect].forced);
    EXPECT_LE(Pictures::difference(pictures.film(plan.on()), full), plan.error_bound() + rounding);
    const double change = pictures.change(EffectSet(), effect);
    const double bound = plan[effect].error_bound;
    SCOPED_TRACE(std::string(effect_name(effect)) + ": " + plan[effect].reason);
    EXPECT_LE(change, bound + rounding);
    if (change > 1e-4)
    {
      std::printf("%s, %s: bound %.3g, change %.3g, %.1f times\n",
        GetParam().name.c_str(),
        effect_name(effect),
        bound,
        change,
        bound / change);
      EXPECT_LE(bound, 100.0 * change);
    }
  }
}

/// Of fog alone pictures are in closed form.
class FogPlans : public testing::TestWithParam<Case>
{
public:
  static Film film(const Scene& scene, const EffectSet& effects)
  {
    Film film(pixels, pixels);
    render_fog(simplified(scene, effects), film);
    return film;
  }
};

TEST_P(FogPlans, TellWhatAnEffectCosts)
{
  const Scene& scene = GetParam().scene;
  Marcher marcher;
  const Film full = film(scene, EffectSet());
  for (const Effect effect : { Effect::Scattering,
         Effect::PhaseAnisotropy,
         Effect::ColouredExtinction,
         Effect::Ambient,
         Effect::Fog,
         Effect::Surfaces })
  {
    EffectSet without;
    without.set(effect, false);
    const double change = Pictures::difference(film(scene, without), full);
    const EffectPlan plan = plan_effects(marcher, scene, 0.0, { { effect, false } });
    SCOPED_TRACE(std::string(effect_name(effect)) + ": " + plan[effect].reason);
    EXPECT_LE(change, plan[effect].error_bound + rounding);
    if (change > 1e-4)
    {
      std::printf("%s, %s: bound %.3g, change %.3g, %.1f times\n",
        GetParam().name.c_str(),
        effect_name(effect),
        plan[effect].error_bound,
        change,
        plan[effect].error_bound / change);
      EXPECT_LE(plan[effect].error_bound, 100.0 * change);
    }
  }
  for (const double tolerance : { 0.0, 0.004, 0.05 })
  {
    const EffectPlan plan = plan_effects(marcher, scene, tolerance);
    EXPECT_LE(plan.error_bound(), 0.25 * tolerance);
    EXPECT_LE(Pictures::difference(film(scene, plan.on()), full), plan.error_bound() + rounding);
  }
}

std::string name_of(const testing::TestParamInfo<Case>& info)
{
  std::string name = info.param.name;
  name.erase(std::remove(name.begin(), name.end(), ','), name.end());
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(EffectPlan, Plans, testing::ValuesIn(all_cases()), name_of);
INSTANTIATE_TEST_SUITE_P(EffectPlan, FogPlans, testing::ValuesIn(fogs()), name_of);

TEST(EffectPlanner, KeepsWhatHolds)
{
  Case c = lit_ball("", 0.5);
  Marcher marcher;
  EffectPlanner planner;
  const EffectPlan* plan = &planner.plan(marcher, c.scene, 0.004);
  EXPECT_EQ(&planner.plan(marcher, c.scene, 0.004), plan);
  // What changed is seen, whatever is kept: each as a planner has it that knows nothing.
  std::vector<std::function<void(Scene&)>> changes = {
    [](Scene& s) {
      s.camera = view_of(s, { 0.7, -0.1, 0.3 }, true).camera(1.0);
    },
    [](Scene& s) {
      s.lights[0] = sun({ 0.1, 0.2, 1.0 });
    },
    [](Scene& s) { s.lights[0].diffuse = glm::dvec3(0.01); },
    [](Scene& s) {
      s.volumes[0].density.channels = { 1.0, 0.9, 0.9 };
    },
    [](Scene& s) { s.volumes[0].medium.octaves.count = 2; },
    [](Scene& s) { s.volumes[0].density.extinction *= 0.3, s.volumes[0].medium_revision += 1000; },
    [](Scene& s) { s.sky.radiance = glm::dvec3(0.1); },
    [](Scene& s) { s.volumes[0].medium.silver_lining.enabled = true; },
    [](Scene& s) { s.volumes[0].medium.emission = glm::dvec3(0.01); },
  };
  for (std::size_t i = 0; i < changes.size(); ++i)
  {
    changes[i](c.scene);
    const EffectPlan& now = planner.plan(marcher, c.scene, 0.004);
    Marcher fresh;
    const EffectPlan anew = plan_effects(fresh, c.scene, 0.004);
    for (int e = 0; e < effect_count; ++e)
    {
      EXPECT_EQ(now.effects[e].on, anew.effects[e].on) << i;
      EXPECT_EQ(now.effects[e].error_bound, anew.effects[e].error_bound) << i;
      EXPECT_EQ(now.effects[e].reason, anew.effects[e].reason) << i;
    }
  }
}

TEST(EffectPlanner, RefusesWhatCannotBePlanned)
{
  Case c = lit_ball("", 0.5);
  Marcher marcher;
  EXPECT_THROW(plan_effects(marcher, c.scene, -0.1), std::invalid_argument);
  EXPECT_THROW(plan_effects(marcher, c.scene, std::nan("")), std::invalid_argument);
}

}
