// Where in the picture an error lies.
#pragma once

#include "study_errors.h"

#include <cstddef>
#include <string>
#include <vector>

namespace brume
{

/// The truth's pixels in classes.
struct ErrorClasses
{
  std::vector<std::string> names;      ///< for people, e.g. "thin edges"
  std::vector<std::string> bounds;     ///< e.g. "optical depth 0.01 to 0.5"
  std::vector<std::size_t> pixels;     ///< how many in each; 0 for a class that is left out
  std::vector<unsigned char> of_pixel; ///< the class of each pixel; 255 for none
  std::vector<double> brightness;      ///< the truth's mean over each class and all channels
};

/// A picture's error in one class.
struct ClassError
{
  double mean_shift = 0.0;       ///< signed
  double mean_shift_error = 0.0; ///< its standard error, from the truth's noise
  double rms = 0.0;              ///< freed of the truth's noise
};

/// Classes by the optical depth of a pixel, −ln of the truth's mean transmittance: thin edges (0.01 to
/// 0.5), middle depths (0.5 to 3), thick cores (3 and more), nothing (below). A class of less than a
/// two-hundredth of the pixels that hold matter is left out.
VTKBRUMEANALYSIS_EXPORT ErrorClasses classes_by_depth(
  const std::vector<float> transmittance[3], const Picture& truth);

/// The tenth of the pixels with matter where the transmittance changes most from pixel to pixel, and the
/// others: outlines, and the rest.
VTKBRUMEANALYSIS_EXPORT ErrorClasses classes_by_outline(
  const std::vector<float> transmittance[3], const Picture& truth);

/// A picture's errors class by class, in the classes' order; `by_chance` as in measure_against().
VTKBRUMEANALYSIS_EXPORT std::vector<ClassError> errors_by_class(const Picture& picture,
  const Picture& truth,
  const TruthHalves& halves,
  const ErrorClasses& classes,
  bool by_chance = false);

/// The share of all squared error that lies in a class, in [0, 1]; 0 where there is no error.
VTKBRUMEANALYSIS_EXPORT double share_of_class(
  const std::vector<ClassError>& errors, const ErrorClasses& classes, std::size_t which);

}
