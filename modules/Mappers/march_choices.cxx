#include "march_choices.h"

#include <algorithm>

namespace brume
{

namespace
{

/// What parts of the tolerance are spent on. plan_effects takes a quarter of what it is given.
constexpr double leave_share = 0.25;
constexpr double shadow_share = 0.25;
constexpr double step_share = 0.75;
constexpr double lit_step_share = 0.25;
/// The least tolerance that steps and shadows are chosen by.
constexpr double least = 1e-9;
/// Light volumes of given settings are of 32 bits for tolerances below this.
constexpr double precise_below = 1e-3;

}

bool MarchChoices::Made::Holds(const Scene& scene,
  const std::vector<double>& more,
  const EffectSet& now) const
{
  for (int i = 0; i < effect_count; ++i)
  {
    const auto effect = static_cast<Effect>(i);
    if (now.has(effect) && !this->Effects.has(effect))
    {
      return false;
    }
  }
  return this->Key.Holds(scene, more);
}

void MarchChoices::Made::Take(const Scene& scene,
  const std::vector<double>& more,
  const EffectSet& now)
{
  this->Effects = now;
  this->Key.Take(scene, more, false);
}

void MarchChoices::Forget()
{
  this->PlanKey.Clear();
  this->ShadowsMade.Key.Clear();
  this->StepMade.Key.Clear();
}

void MarchChoices::Update(Marcher& marcher, const Scene& whole, const ChoiceSettings& wanted)
{
  this->MakePlan(marcher, whole, wanted);
  // What VTK draws too stays as it is, unless an effect is forced.
  const bool plain = !is_lit(whole) && wanted.forces.empty();
  this->Simple = plain ? Scene() : simplified(whole, this->Effects);
  this->TheScene = plain ? &whole : &this->Simple;
  this->Settings = MarchSettings();
  this->Settings.threads = wanted.threads;
  this->Settings.leave_error = leave_share * wanted.tolerance;
  this->Settings.jitter = wanted.jitter;
  this->ChooseShadows(marcher, whole, wanted);
  if (!plain)
  {
    apply_effects(this->Effects, this->Settings);
  }
  this->ChooseStep(marcher, whole, wanted);
}

void MarchChoices::MakePlan(Marcher& marcher, const Scene& whole, const ChoiceSettings& wanted)
{
  const bool lit = is_lit(whole);
  const double tolerance = lit ? wanted.tolerance : 0.0;
  std::vector<double> key{ tolerance, static_cast<double>(whole.surface_depth.empty()) };
  for (const auto& force : wanted.forces)
  {
    key.push_back(static_cast<double>(force.first));
    key.push_back(force.second);
  }
  // Without light and forces bounds are 0 from all sides.
  const bool by_view = !wanted.coarse && (lit || !wanted.forces.empty());
  if (by_view || !this->PlanKey.Holds(whole, key))
  {
    this->Plan = this->Planner.plan(marcher, whole, tolerance, wanted.forces, wanted.threads);
    this->PlanKey.Take(whole, key);
  }
  this->Effects = this->Plan.on();
}

void MarchChoices::ChooseShadows(Marcher& marcher, const Scene& whole, const ChoiceSettings& wanted)
{
  this->ShadowsChosen = false;
  this->Settings.shadows = ShadowMethod::None;
  if (!is_lit(*this->TheScene) || !this->Effects.has(Effect::Shadows))
  {
    return;
  }
  this->Settings.shadows = wanted.shadows;
  this->Settings.precise_shadows = wanted.tolerance < precise_below;
  if (wanted.choose_shadows)
  {
    const double tolerance = std::max(shadow_share * wanted.tolerance, least);
    if (!this->ShadowsMade.Holds(whole, { tolerance }, this->Effects))
    {
      this->Shadows = choose_shadows(marcher, *this->TheScene, tolerance, wanted.threads);
      this->ShadowsMade.Take(whole, { tolerance }, this->Effects);
    }
    this->Settings.shadows = this->Shadows.method;
    this->Settings.shadow_step = this->Shadows.step;
    this->Settings.precise_shadows = this->Shadows.precise;
    this->ShadowsChosen = !(wanted.shadow_step > 0.0);
  }
  if (wanted.shadow_step > 0.0)
  {
    this->Settings.shadow_step = wanted.shadow_step;
  }
}

void MarchChoices::ChooseStep(Marcher& marcher, const Scene& whole, const ChoiceSettings& wanted)
{
  if (!wanted.choose_step)
  {
    this->Settings.step = wanted.step;
    return;
  }
  const bool lit = is_lit(*this->TheScene);
  const double share = lit ? lit_step_share : step_share;
  const double tolerance = std::max(share * wanted.tolerance, least);
  const std::vector<double> key{ tolerance,
    static_cast<double>(wanted.choose_shadows),
    static_cast<double>(wanted.shadows),
    wanted.shadow_step,
    wanted.beyond,
    static_cast<double>(wanted.step_edge) };
  if (!this->StepMade.Holds(whole, key, this->Effects))
  {
    this->Step = choose_step(marcher, *this->TheScene, tolerance, wanted.threads,
      lit ? this->Settings : MarchSettings(), wanted.beyond, wanted.step_edge);
    this->StepMade.Take(whole, key, this->Effects);
  }
  this->Settings.rule = this->Step.rule;
  this->Settings.step = this->Step.step;
  this->Settings.refinements = this->Step.refinements;
  this->Settings.refine_error = this->Step.refine_error;
}

double MarchChoices::GetEstimatedError() const
{
  return this->Step.estimated_error + this->Settings.leave_error + this->Plan.error_bound() +
         (this->ShadowsChosen ? this->Shadows.estimated_error : 0.0);
}

bool MarchChoices::IsToleranceMet() const
{
  return this->Step.met && (!this->ShadowsChosen || this->Shadows.met);
}

}
