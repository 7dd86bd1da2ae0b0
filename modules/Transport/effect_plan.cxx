#include "Transport/effect_plan.h"

#include "Transport/effect_reasons.h"
#include "Transport/plan_bounds.h"
#include "Transport/settle_effects.h"

#include <algorithm>
#include <cmath>

namespace brume
{

namespace
{

/// The share of the tolerance that may be spent on leaving out effects; the rest is the steps'.
constexpr double share_of_tolerance = 0.25;

/// Settles the effects of one scene.
class Settling
{
public:
  Settling(const Scene& scene, const PlanFigures& figures, const std::map<Effect, bool>& forced)
    : TheScene(scene)
    , Figures(figures)
    , Forced(forced)
    , Bounds(scene, figures)
  {
    for (int i = 0; i < effect_count; ++i)
    {
      const auto effect = static_cast<Effect>(i);
      this->Absences[i] = absence(effect, scene, figures);
      const auto asked = forced.find(effect);
      const bool off = !this->Absences[i].empty();
      this->On.set(effect, asked == forced.end() ? !off : true);
    }
    for (const auto& [effect, on] : forced)
    {
      if (!on)
      {
        const auto i = static_cast<std::size_t>(effect);
        this->AtRemoval[i] = this->Absences[i].empty() ? this->Bounds.of(effect, this->On) : 0.0;
        this->On.set(effect, false);
      }
    }
  }

  void leave_out(double budget)
  {
    while (this->leave_out_one(budget))
    {
    }
  }

  EffectPlan plan() const
  {
    EffectPlan plan;
    for (int i = 0; i < effect_count; ++i)
    {
      const auto effect = static_cast<Effect>(i);
      PlannedEffect& planned = plan.effects[i];
      planned.effect = effect;
      planned.on = this->On.has(effect);
      planned.forced = this->Forced.count(effect) > 0;
      if (!planned.on && this->Absences[i].empty())
      {
        planned.error_bound = std::max(this->AtRemoval[i], this->bound(effect, this->On));
      }
      planned.reason = this->reason(planned);
    }
    return plan;
  }

private:
  /// Of an effect that the others in `on` go with.
  double bound(Effect effect, EffectSet on) const
  {
    on.set(effect, true);
    return this->Bounds.of(effect, on);
  }

  bool may_go(Effect effect) const
  {
    return this->On.has(effect) && this->Forced.count(effect) == 0 &&
           // These two save work, and what they leave out cannot be seen.
           effect != Effect::SpaceLeaping && effect != Effect::Surfaces &&
           // Of surfaces and slices no bound is known.
           (this->TheScene.blend_mode == BlendMode::Composite);
  }

  /// What is left out by choice, if `on` were the effects.
  double sum(const EffectSet& on, const std::array<double, effect_count>& at_removal) const
  {
    double sum = 0.0;
    for (int i = 0; i < effect_count; ++i)
    {
      const auto effect = static_cast<Effect>(i);
      if (!on.has(effect) && this->Forced.count(effect) == 0 && this->Absences[i].empty())
      {
        sum += std::max(at_removal[i], this->bound(effect, on));
      }
    }
    return sum;
  }

  bool leave_out_one(double budget)
  {
    int least = -1;
    double least_bound = budget;
    for (int i = 0; i < effect_count; ++i)
    {
      const auto effect = static_cast<Effect>(i);
      if (this->may_go(effect))
      {
        const double bound = this->Bounds.of(effect, this->On);
        if (bound <= least_bound)
        {
          least = i;
          least_bound = bound;
        }
      }
    }
    if (least < 0)
    {
      return false;
    }
    EffectSet on = this->On;
    on.set(static_cast<Effect>(least), false);
    std::array<double, effect_count> at_removal = this->AtRemoval;
    at_removal[least] = least_bound;
    if (this->sum(on, at_removal) > budget)
    {
      return false;
    }
    this->On = on;
    this->AtRemoval = at_removal;
    return true;
  }

  std::string reason(const PlannedEffect& planned) const
  {
    const int i = static_cast<int>(planned.effect);
    const std::string asked = planned.forced ? (planned.on ? "asked for; " : "switched off; ") : "";
    if (!this->Absences[i].empty())
    {
      return asked + this->Absences[i];
    }
    const std::string figures = figures_of(planned.effect, this->TheScene, this->Figures);
    if (planned.effect == Effect::SpaceLeaping)
    {
      return asked + figures;
    }
    if (!planned.on)
    {
      const bool dark = !this->On.has(Effect::Scattering) && planned.error_bound == 0.0;
      return asked + figures + (dark ? "; scattering is left out" : "") +
             ": without it no pixel changes by more than " + two_digits(planned.error_bound);
    }
    if (this->TheScene.blend_mode != BlendMode::Composite)
    {
      return asked + figures;
    }
    const double bound = this->Bounds.of(planned.effect, this->On);
    return asked + figures + ": without it pixels could change by " + two_digits(bound);
  }

  const Scene& TheScene;
  const PlanFigures& Figures;
  const std::map<Effect, bool>& Forced;
  EffectBounds Bounds;
  EffectSet On;
  std::array<std::string, effect_count> Absences;
  std::array<double, effect_count> AtRemoval{};
};

}

EffectSet EffectPlan::on() const
{
  EffectSet set;
  for (const PlannedEffect& planned : this->effects)
  {
    set.set(planned.effect, planned.on);
  }
  return set;
}

double EffectPlan::error_bound() const
{
  double sum = 0.0;
  for (const PlannedEffect& planned : this->effects)
  {
    sum += planned.error_bound;
  }
  return sum;
}

double EffectPlan::expected_cost() const
{
  double sum = 0.0;
  for (const PlannedEffect& planned : this->effects)
  {
    sum += planned.on ? effect_cost(planned.effect) : 0.0;
  }
  return sum;
}

EffectPlan settle_effects(const Scene& scene,
  const PlanFigures& figures,
  double tolerance,
  const std::map<Effect, bool>& forced)
{
  Settling settling(scene, figures, forced);
  settling.leave_out(share_of_tolerance * tolerance);
  return settling.plan();
}

}
