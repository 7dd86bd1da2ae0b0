// Runs a study: its truth, and its settings as far as time allows.
#pragma once

#include "cost_knobs.h"
#include "study_clock.h"

#include "Analysis/study.h"

#include <string>
#include <vector>

namespace brume::app
{

/// What of a study the user asks for.
struct CostRequest
{
  std::vector<std::string> knobs; ///< by name; empty: all
  int repetitions = 3;            ///< renders of a setting that are timed, at the most
  double seconds = 240.0;         ///< of the whole study
};

/// Measures one scene. Settings are drawn from the quickest to the slowest, as far as is known of them;
/// what there is no time for is skipped, with the reason.
class CostMeasure
{
public:
  /// Scene, clock and study must outlive it; the study has its scene's description and gets the rest.
  CostMeasure(CostScene& scene, const CostRequest& request, StudyClock& clock, Study& study);

  /// Computes the truth. To be called first.
  void measure_truth();
  /// Draws and measures all that is asked for.
  void measure_settings();

private:
  struct Job;
  /// Draws the settings of these knobs, whatever their order, and appends their points to the study;
  /// leaves `reserve` seconds of its time.
  void run(std::vector<CostKnob> knobs, double reserve);
  void draw(Job& job, double share, double reserve);
  /// Seconds that a setting's first render is expected to take; negative where nothing is known.
  double expected(const std::vector<Job>& jobs, const Job& job) const;
  bool wants(const std::string& knob) const;
  /// The number of octaves with the least error of those measured; the scene's own without any.
  int best_octaves() const;
  /// The rule of steps that erred least with long steps; midpoints without any.
  StepRule best_rule() const;

  CostScene& Scene;
  CostRequest Request;
  StudyClock& Clock;
  Study& Result;
};

}
