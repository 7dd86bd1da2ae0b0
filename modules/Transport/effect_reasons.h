// What is said about an effect in a plan. Internal to Transport.
#pragma once

#include "Transport/effect_plan.h"
#include "Transport/plan_probe.h"

#include <string>

namespace brume
{

/// Why a scene has nothing of an effect, in words; empty where it has.
std::string absence(Effect effect, const Scene& scene, const PlanFigures& figures);

/// The figures of a scene that tell how much an effect matters, in words.
std::string figures_of(Effect effect, const Scene& scene, const PlanFigures& figures);

/// A figure with two digits.
std::string two_digits(double value);

}
