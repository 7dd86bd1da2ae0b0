// A comparison of mappers on one scene, as plain data: what compare.json, report.html, panel.png
// and the table of the terminal are made of.
#pragma once

#include "image_errors.h"
#include "picture.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace brume
{

/// The camera of every picture; lengths in world units, as vtkCamera has them.
struct CameraDescription
{
  std::array<double, 3> position{ 0, 0, 1 };
  std::array<double, 3> focal_point{ 0, 0, 0 };
  std::array<double, 3> view_up{ 0, 1, 0 };
  double view_angle = 30.0;    ///< degrees, of the picture's height; perspective alone
  bool parallel = false;       ///< parallel projection
  double parallel_scale = 1.0; ///< half the view's height in world units; parallel alone
};

/// One setting that was made the same for several mappers so that they draw the same scene.
struct MatchedSetting
{
  std::string name;       ///< e.g. "sample distance"
  std::string value;      ///< with its unit, e.g. "0.5 mm"
  std::string applies_to; ///< e.g. "all mappers"
};

/// What was drawn.
struct SceneDescription
{
  std::string input; ///< for people: a file's or folder's name, or sample:NAME
  std::array<int, 3> dimensions{ 0, 0, 0 };  ///< voxels; 0 where unknown
  std::array<double, 3> spacing{ 0, 0, 0 };  ///< world units
  std::string unit;   ///< the world unit, e.g. "mm"; empty: "world units"
  std::string preset; ///< the transfer functions' name; empty: none
  int width = 0;      ///< resolution, pixels
  int height = 0;
  double step = 0.0;        ///< sample distance in world units; 0: chosen by each mapper
  double step_voxels = 0.0; ///< the same in voxels (of the smallest spacing)
  double opacity_unit_distance = 0.0; ///< world units; 0: does not apply
  CameraDescription camera;
  std::array<double, 3> background{ 0, 0, 0 }; ///< linear RGB
  std::vector<std::string> lights;             ///< one in words each; empty: no light
  bool shading = false;
  std::string interpolation; ///< "linear" or "nearest"
  std::vector<MatchedSetting> matched;
};

/// Seconds of one mapper's renders, wall clock.
struct Timing
{
  double median = 0.0;   ///< of the repetitions, the render alone
  double min = 0.0;      ///< the fastest repetition
  double max = 0.0;      ///< the slowest
  int repetitions = 0;   ///< how many were timed
  double warm_up = 0.0;  ///< the first render, not among the repetitions
  double prepare = 0.0;  ///< what comes before any render: tables, grids, uploads
};

/// One cause of a mapper's error, measured by letting it act alone (or by taking it away, as the
/// explanation says).
struct Contribution
{
  std::string name;        ///< e.g. "step", "ray start", "fixed point and 8-bit tables"
  std::string explanation; ///< one sentence: how it was isolated
  ImageErrors errors;
};

/// One mapper's part.
struct ComparisonEntry
{
  std::string mapper;     ///< the name of the command line, e.g. "raymarch"
  std::string title;      ///< for people, e.g. "Brume ray march"
  std::string class_name; ///< e.g. "vtkBrumeRayMarchMapper"; may be empty
  std::string skipped;    ///< why nothing was drawn; empty when it was. The rest is then unused.
  /// What of the scene the mapper knows nothing of, in a few words each: its picture lacks them, and
  /// its errors hold them. Empty where it draws the whole scene.
  std::vector<std::string> left_out;
  Picture picture;
  Timing timing;
  ImageErrors against_truth;
  std::optional<ImageErrors> against_reference; ///< against the reference mapper's picture
  std::vector<Contribution> contributions;      ///< in any order; shown largest first
  /// The mapper's own statistics, a JSON object as text; empty for none. Its member `effects`, a
  /// list of {name, on, reason, error_bound}, is shown in the report.
  std::string statistics;
};

/// What every picture was measured against.
struct Truth
{
  std::string method;        ///< one or two sentences
  int refinement_levels = 0; ///< how many times the step was halved; 0: does not apply
  double remaining_mean = 0.0;    ///< estimate of its own mean error, fraction of white
  double remaining_largest = 0.0; ///< and of its largest
  double seconds = 0.0;
  Picture picture; ///< may be empty: then no truth is shown and no difference is drawn
};

/// Where it was drawn.
struct Machine
{
  std::string cpu;
  int threads = 0;
  std::string simd; ///< the instruction set that was dispatched to, e.g. "AVX2"
  std::string os;
  std::string brume_version;
  std::string vtk_version;
};

/// The whole comparison. Every text is UTF-8; bytes that are not become U+FFFD in the outputs.
struct Comparison
{
  SceneDescription scene;
  std::vector<ComparisonEntry> entries; ///< in the order they are shown
  /// The entry that the headline is about; empty or skipped: the first that was drawn.
  std::string subject_mapper = "raymarch";
  /// The entry that others are set against: the stock CPU mapper. It may be missing or skipped.
  std::string reference_mapper = "vtk-fixed-point";
  Truth truth;
  Machine machine;
  std::string command_line; ///< exactly what repeats the comparison
  std::string date;         ///< e.g. "2024-05-01 12:00 UTC"; empty: left out
  DisplayCurve display_curve = DisplayCurve::Identity; ///< how pictures are shown, not measured
  double exposure = 0.0; ///< stops that pictures are shown brighter by, not measured
};

/// What an entry leaves out, for people: "no fog, no shadows in the medium"; empty for nothing.
VTKBRUMEANALYSIS_EXPORT std::string left_out_words(const ComparisonEntry& entry);

/// The entry of that mapper's name that was drawn (not skipped), or null.
VTKBRUMEANALYSIS_EXPORT const ComparisonEntry* find_drawn(
  const Comparison& comparison, const std::string& mapper);

/// The entry that the headline is about; null when nothing was drawn.
VTKBRUMEANALYSIS_EXPORT const ComparisonEntry* subject_of(const Comparison& comparison);

}
