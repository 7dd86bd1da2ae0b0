// What is settled before a march: which effects are simulated, how shadows are made, which steps
// are taken. Internal to Mappers.
#ifndef march_choices_h
#define march_choices_h

#include "step_key.h"

#include "Transport/effect_plan.h"
#include "Transport/marcher.h"
#include "Transport/scene.h"
#include "Transport/step_control.h"

#include <map>
#include <vector>

namespace brume
{

/// What a mapper asks for.
struct ChoiceSettings
{
  double tolerance = 0.004; ///< of a pixel's largest error, as a fraction of white
  /// Effects that are on or off whatever the plan says.
  std::map<Effect, bool> forces;
  /// Of lit scenes: the method is chosen by the tolerance in place of `shadows`.
  bool choose_shadows = true;
  ShadowMethod shadows = ShadowMethod::Volume;
  double shadow_step = 0.0; ///< 0: chosen
  /// Steps are chosen by the tolerance in place of `step`.
  bool choose_step = true;
  double step = 1.0;
  /// The share of pixels that may have larger errors than the tolerance by their steps
  /// (choose_step).
  double beyond = 0.0;
  int step_edge = 64; ///< rays along each side of the square that tells them
  bool jitter = false;
  /// Of a coarse picture, which is to be there at once, the plan of another view is good enough.
  bool coarse = false;
  int threads = 0;
};

/// Makes choices and keeps them while they hold.
///
/// A quarter of the tolerance goes to leaving rays early. Of scenes without lit media and fog,
/// which are VTK's, the rest goes to steps, and nothing that changes a pixel is left out unless it
/// is forced to be. Of lit ones a quarter each goes to effects that are left out, to shadows and to
/// steps.
///
/// Plans are made for a view: anew when anything changes. Shadows and steps hold for all directions
/// of view and light, nearly: they are chosen anew when the matter, the lights' colours or the
/// settings change, or an effect is on that was off when they were chosen.
class MarchChoices
{
public:
  /// `whole` must stay as long as GetScene is asked.
  void Update(Marcher& marcher, const Scene& whole, const ChoiceSettings& wanted);
  /// Nothing that was chosen holds.
  void Forget();

  /// The scene that is to be marched: without the effects that are off.
  const Scene& GetScene() const { return *this->TheScene; }
  const MarchSettings& GetSettings() const { return this->Settings; }
  const EffectPlan& GetPlan() const { return this->Plan; }
  /// Whether the shadows were chosen by the tolerance.
  bool HasChosenShadows() const { return this->ShadowsChosen; }
  /// The largest error of a pixel that is expected, for all that was chosen by the tolerance, and
  /// whether each is within its part.
  double GetEstimatedError() const;
  /// The part of that which is the steps'.
  double GetStepError() const { return this->Step.estimated_error; }
  bool IsToleranceMet() const;

private:
  /// A choice with the effects that were on when it was made.
  struct Made
  {
    SceneKey Key;
    EffectSet Effects;
    bool Holds(const Scene& scene, const std::vector<double>& more, const EffectSet& now) const;
    void Take(const Scene& scene, const std::vector<double>& more, const EffectSet& now);
  };

  void MakePlan(Marcher& marcher, const Scene& whole, const ChoiceSettings& wanted);
  void ChooseShadows(Marcher& marcher, const Scene& whole, const ChoiceSettings& wanted);
  void ChooseStep(Marcher& marcher, const Scene& whole, const ChoiceSettings& wanted);

  const Scene* TheScene = nullptr;
  Scene Simple;
  MarchSettings Settings;
  EffectPlanner Planner; ///< keeps of a plan what holds
  SceneKey PlanKey;
  EffectPlan Plan;
  EffectSet Effects; ///< that are on
  Made ShadowsMade;
  ShadowChoice Shadows; ///< the last that were chosen by the tolerance
  bool ShadowsChosen = false;
  Made StepMade;
  StepChoice Step;
};

}

#endif
