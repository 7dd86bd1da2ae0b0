// Which effects a scene calls for, why, and how wrong a picture is without the others.
#pragma once

#include "Transport/effects.h"
#include "Transport/marcher.h"
#include "Transport/scene.h"

#include <array>
#include <map>
#include <memory>
#include <string>

namespace brume
{

/// What was settled for one effect.
struct PlannedEffect
{
  Effect effect = Effect::Absorption;
  bool on = true;
  bool forced = false; ///< settled by the caller
  std::string reason;  ///< in words, with the figures that led to it
  /// The largest change of a pixel (radiance + transmittance · 1, as a fraction of white) that
  /// leaving the effect out makes; 0 where it is on.
  double error_bound = 0.0;
};

struct EffectPlan
{
  std::array<PlannedEffect, effect_count> effects;
  const PlannedEffect& operator[](Effect effect) const
  {
    return this->effects[static_cast<std::size_t>(effect)];
  }
  EffectSet on() const;
  /// The sum of the bounds: how wrong the picture is at the most for what it leaves out.
  double error_bound() const;
  /// The time that the picture is expected to take, in that of emission and absorption with the same
  /// steps: the sum of the costs (effect_cost) of what is on.
  double expected_cost() const;
};

/// Settles each effect. What the scene has nothing of (no sky, equal channels, …) is off with a bound
/// of 0. Of the rest, those are left out, the least first, whose bounds together are within a quarter
/// of `tolerance` (a fraction of white, ≥ 0; 0 leaves out nothing that matters). `forced` overrules,
/// and the bound says what that costs. Surfaces and space leaping save work: they are never left out
/// but by force. In blend modes other than Composite bounds are not known: what is there is on.
///
/// The figures: optical depths along the view and toward each light are the largest of 4096 rays of
/// the camera, and of parallel views along the lights; phase functions are looked at over the angles
/// between the view's rays and the lights. The bounds follow in closed form (docs/theory/plan.md).
///
/// The marcher's caches are brought up to date for the scene, and used; those of its light stay as they
/// are. Throws std::invalid_argument for a scene that cannot be drawn (Scene::validate) or a tolerance
/// that is negative. To plan again and again, use an EffectPlanner.
EffectPlan plan_effects(Marcher& marcher,
  const Scene& scene,
  double tolerance,
  const std::map<Effect, bool>& forced = {},
  int threads = 0);

/// Plans for one picture after another, and keeps what still holds: the whole plan while scene, camera,
/// tolerance and forced effects stay; the optical depths toward a light while it and the volumes stay.
/// So a camera that moves costs one film of 4096 rays and the arithmetic of the bounds, and
/// the plan is right for where it is; call it for every picture. Of volumes whose revisions are 0
/// nothing is kept. Voxels are read only where Volume::ranges is null: give it.
class EffectPlanner
{
public:
  EffectPlanner();
  ~EffectPlanner();
  EffectPlanner(const EffectPlanner&) = delete;
  EffectPlanner& operator=(const EffectPlanner&) = delete;

  /// As plan_effects. The plan stays until the next call.
  const EffectPlan& plan(Marcher& marcher,
    const Scene& scene,
    double tolerance,
    const std::map<Effect, bool>& forced = {},
    int threads = 0);

private:
  struct Kept;
  std::unique_ptr<Kept> TheKept;
};

/// The scene without the effects that are off, so that the marcher finds nothing of them and takes
/// the kernel compiled for what is left. Absorption, shadows and leaping are settings: see
/// apply_effects.
Scene simplified(const Scene& scene, const EffectSet& effects);
/// Switches off absorption, shadows and leaping in the settings where the effects are off.
void apply_effects(const EffectSet& effects, MarchSettings& settings);

}
