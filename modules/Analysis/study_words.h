// What a study shows, in plain words.
#pragma once

#include "study.h"

#include <string>
#include <vector>

namespace brume
{

/// What was found, a sentence or two each: how far the truth can be trusted, what the last halving of
/// the error cost, what each approximation gets wrong and where, whether settings that were chosen for a
/// tolerance or a time kept it. Every word follows from the study's figures; what they do not show is
/// not said.
VTKBRUMEANALYSIS_EXPORT std::vector<std::string> study_words(const Study& study);

/// A point by name: "octaves 4", "step 1/2 voxel".
VTKBRUMEANALYSIS_EXPORT std::string point_name(const Study& study, const StudyPoint& point);

/// What a halving of the error costs between two costs of a front, as a factor on the time, if error and
/// time follow a power law there: (t₂/t₁)^(ln 2 / ln(e₁/e₂)). `from` has the larger error. 0 where it
/// cannot be told.
VTKBRUMEANALYSIS_EXPORT double price_of_halving(double from_seconds,
  double from_error,
  double to_seconds,
  double to_error);

}
