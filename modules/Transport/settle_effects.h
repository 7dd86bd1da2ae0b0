// From the figures of a scene to a plan. Internal to Transport.
#pragma once

#include "Transport/effect_plan.h"
#include "Transport/plan_probe.h"

#include <map>

namespace brume
{

/// As plan_effects, whose tolerance it takes.
EffectPlan settle_effects(const Scene& scene,
  const PlanFigures& figures,
  double tolerance,
  const std::map<Effect, bool>& forced);

}
