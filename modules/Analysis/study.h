// A study of what accuracy costs in time, as plain data: what cost.csv, cost.json, cost.png and the
// report of `brume cost` are made of.
#pragma once

#include "comparison.h"
#include "error_classes.h"
#include "study_errors.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace brume
{

/// One setting of a knob: a picture, what it cost and how wrong it is.
struct StudyPoint
{
  std::string knob;     ///< the knob's name, as --knobs takes it
  std::string setting;  ///< its value, in a few words: "1/2 voxel"
  std::string settings; ///< all that was set, a JSON object as text; "{}" for nothing
  std::string mapper;   ///< the name of the command line
  bool stock = false;   ///< one of VTK's own mappers
  bool by_chance = false; ///< its picture has noise of its own
  /// The setting of the same knob that asks for most: what `own` measures against.
  bool finest = false;
  std::string skipped; ///< why it was not drawn; empty when it was. The rest is then unused.
  std::vector<std::string> left_out; ///< as ComparisonEntry has it
  Timing timing;
  StudyErrors errors; ///< against the truth
  /// Against the knob's finest setting: what this knob alone does. No truth, and so no noise of it, is
  /// in it. Of the finest itself and of knobs that draw by chance: none.
  std::optional<ImageErrors> own;
  /// Where the error lies: against the truth, and against the finest setting; empty where not measured.
  ///@{
  std::vector<ClassError> by_depth;
  std::vector<ClassError> by_outline;
  std::vector<ClassError> own_by_depth;
  std::vector<ClassError> own_by_outline;
  ///@}
  Picture picture;
  std::string statistics; ///< the mapper's own, a JSON object as text; empty for none
  /// A tolerance that the mapper was asked to keep, as a fraction of white, or seconds that it was to
  /// take; 0 where it was asked for neither.
  ///@{
  double asked_tolerance = 0.0;
  double asked_seconds = 0.0;
  ///@}
  bool on_front = false;            ///< of RMS error against seconds
  bool on_percentile_front = false; ///< of the 99.9th percentile against seconds
};

/// A knob: what trades accuracy for time.
struct StudyKnob
{
  std::string name;    ///< as --knobs takes it
  std::string title;   ///< for people
  std::string what;    ///< what it does, and what stands still meanwhile: a sentence
  std::string skipped; ///< why no setting of it was drawn; empty where some were
};

/// The truth of a study: a Truth, and the noise of one that was found by chance.
struct StudyTruth
{
  Truth truth;
  std::string kind; ///< "quadrature", "march" or "paths"
  TruthHalves halves; ///< of paths; empty otherwise
  TruthNoise noise;   ///< of either kind
  int samples_per_pixel = 0; ///< of paths, both halves together; 0 otherwise
};

/// The whole study. Every text is UTF-8.
struct Study
{
  SceneDescription scene;
  StudyTruth truth;
  std::vector<StudyKnob> knobs;
  std::vector<StudyPoint> points; ///< knob by knob, within one from cheap to dear
  ErrorClasses depths;            ///< of the truth's pixels (classes_by_depth)
  ErrorClasses outlines;          ///< of the truth's pixels (classes_by_outline)
  Machine machine;
  std::string command_line;
  std::string date;
  double seconds = 0.0;        ///< that the study took
  double seconds_asked = 0.0;  ///< that it was to take at the most
  double load = 0.0;           ///< of the machine when it began: runnable tasks, of others too
  DisplayCurve display_curve = DisplayCurve::Identity;
  double exposure = 0.0;
};

/// The pixel errors that pixels are counted by: at most this much wrong, as fractions of white.
constexpr std::array<double, 3> study_tolerances{ 0.05, 0.01, 0.002 };

/// Measures the picture of a point of this study: errors, perceptual difference, classes.
VTKBRUMEANALYSIS_EXPORT void measure_point(StudyPoint& point, const Study& study);

/// What can be told when all points are measured: the fronts, and what each point's knob alone does.
VTKBRUMEANALYSIS_EXPORT void finish(Study& study);

/// The cheapest point but `apart_from` with at least 99.9 % of its pixels within a tolerance; null for
/// none.
VTKBRUMEANALYSIS_EXPORT const StudyPoint* cheapest_within(
  const Study& study, double tolerance, const StudyPoint* apart_from = nullptr);

/// The points of the RMS front, from the cheapest to the most accurate.
VTKBRUMEANALYSIS_EXPORT std::vector<const StudyPoint*> front_of(const Study& study);

}
