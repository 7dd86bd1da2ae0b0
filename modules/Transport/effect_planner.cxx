#include "Transport/effect_plan.h"

#include "Transport/plan_probe.h"
#include "Transport/settle_effects.h"

#include <algorithm>
#include <stdexcept>

namespace brume
{

namespace
{

void add(PlanKey& key, const std::vector<PhaseLobe>& lobes)
{
  key.add(std::uint64_t{ lobes.size() });
  for (const PhaseLobe& lobe : lobes)
  {
    key.add(static_cast<std::uint64_t>(lobe.function));
    key.add(lobe.weight);
    key.add(lobe.anisotropy);
  }
}

void add(PlanKey& key, const Medium& medium)
{
  key.add(std::uint64_t{ medium.lit });
  key.add(medium.albedo);
  add(key, medium.lobes);
  key.add(static_cast<std::uint64_t>(medium.octaves.count));
  key.add({ medium.octaves.attenuation, medium.octaves.contribution, medium.octaves.anisotropy });
  key.add(medium.emission);
  key.add({ medium.black_body, medium.black_body_reference, medium.temperature_scale });
  key.add(static_cast<std::uint64_t>(reinterpret_cast<std::uintptr_t>(medium.temperature.voxels)));
  key.add(std::uint64_t{ medium.silver_lining.enabled });
  key.add(
    { medium.silver_lining.strength, medium.silver_lining.spread, medium.silver_lining.back });
  key.add(std::uint64_t{ medium.powder.enabled });
  key.add(static_cast<std::uint64_t>(medium.powder.form));
  key.add(medium.powder.strength);
  key.add(medium.powder.scale);
}

void add(PlanKey& key, const Light& light)
{
  key.add(light.diffuse);
  key.add(light.specular);
  key.add(light.direction);
  key.add(std::uint64_t{ light.positional });
  key.add(light.position);
  key.add(light.attenuation);
  key.add(light.cone_angle);
  key.add(light.exponent);
}

/// All that a plan is made from but what PlanProbe::matter_key names.
void add(PlanKey& key, const Scene& scene)
{
  for (const Volume& volume : scene.volumes)
  {
    key.add(volume.density.channels);
    add(key, volume.medium);
    const Shading& shading = volume.shading;
    key.add(std::uint64_t{ shading.enabled });
    key.add({ shading.ambient, shading.diffuse, shading.specular });
    key.add(shading.ambient_light);
  }
  key.add(std::uint64_t{ scene.lights.size() });
  for (const Light& light : scene.lights)
  {
    add(key, light);
  }
  key.add(scene.sky.radiance);
  key.add(scene.sky.ground);
  key.add(scene.sky.up);
  key.add(std::uint64_t{ scene.fog.enabled });
  key.add(scene.fog.extinction);
  key.add(scene.fog.albedo);
  add(key, scene.fog.lobes);
  key.add(scene.fog.falloff);
  key.add(scene.fog.base_height);
  key.add(scene.camera.clip_from_world);
  const bool surfaces = !scene.surface_depth.empty();
  key.add(std::uint64_t{ surfaces });
  key.add(surfaces
            ? double(*std::min_element(scene.surface_depth.begin(), scene.surface_depth.end()))
            : 0.0);
}

}

struct EffectPlanner::Kept
{
  PlanProbe probe;
  PlanKey key;
  EffectPlan plan;
};

EffectPlanner::EffectPlanner()
  : TheKept(std::make_unique<Kept>())
{
}

EffectPlanner::~EffectPlanner() = default;

const EffectPlan& EffectPlanner::plan(Marcher& marcher,
  const Scene& scene,
  double tolerance,
  const std::map<Effect, bool>& forced,
  int threads)
{
  if (!(tolerance >= 0.0))
  {
    throw std::invalid_argument("the tolerance of a plan must not be negative");
  }
  PlanKey key = this->TheKept->probe.matter_key(scene);
  add(key, scene);
  key.add(tolerance);
  for (const auto& [effect, on] : forced)
  {
    key.add(static_cast<std::uint64_t>(effect));
    key.add(std::uint64_t{ on });
  }
  if (!(key == this->TheKept->key))
  {
    this->TheKept->key = PlanKey(); // until all is done
    const PlanFigures& figures = this->TheKept->probe.look(marcher, scene, threads);
    this->TheKept->plan = settle_effects(scene, figures, tolerance, forced);
    this->TheKept->key = key;
  }
  return this->TheKept->plan;
}

EffectPlan plan_effects(Marcher& marcher,
  const Scene& scene,
  double tolerance,
  const std::map<Effect, bool>& forced,
  int threads)
{
  EffectPlanner planner;
  return planner.plan(marcher, scene, tolerance, forced, threads);
}

}
