// The settings of a study: what is to be drawn, and how.
#pragma once

#include "scene_march.h"

#include "Analysis/study.h"

#include <functional>
#include <string>
#include <vector>

namespace brume::app
{

/// One render of a setting.
struct CostRender
{
  Picture picture;
  double seconds = 0.0; ///< of the render alone
  double prepare = 0.0; ///< before it
  std::string statistics;
};

/// A setting of a knob, and how it is drawn.
struct CostSetting
{
  StudyPoint point; ///< its names are filled in, its figures are not
  /// What it is expected to cost, as a multiple of the other settings of the same knob and mapper: by
  /// what they took it is known beforehand.
  double effort = 1.0;
  /// Draws it once. Throws SceneMarch::Stopped where the watch stopped it, Failure where it cannot be
  /// drawn.
  std::function<CostRender(const Watch&)> draw;
};

/// A knob and its settings, from cheap to dear.
struct CostKnob
{
  StudyKnob knob;
  std::vector<CostSetting> settings;
  /// Whether the dearest setting that is drawn is the measure of the others (StudyPoint::own).
  bool has_finest = true;
};

}
