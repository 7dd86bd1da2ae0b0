// How far one picture is from another, in a handful of numbers.
#pragma once

#include "picture.h"

#include <cstddef>

namespace brume
{

/// The errors of a picture against another, over all pixels and channels alike.
///
/// Every number is in linear RGB as a fraction of white (multiply by 255 for steps of an 8-bit
/// display). With N = 3 * width * height values and e_i = test_i - truth_i in double precision:
///
///     mean_shift       (1/N) Σ e_i            signed: positive where the test is too bright
///     mean_absolute    (1/N) Σ |e_i|
///     rms              sqrt((1/N) Σ e_i²)
///     percentile_999   the smallest |e_i| such that at least 99.9 % of all |e| are no larger:
///                      element ⌈0.999 N⌉ (counted from 1) of the sorted |e|; never interpolated
///     largest          max |e_i|
///
/// Values are measured as they are: nothing is clamped to what a display can show.
///
/// A value that is NaN or infinite in either picture counts as an error of infinity, so a single
/// one makes mean_shift, mean_absolute, rms and largest +infinity (mean_shift's sign then says
/// nothing), and more than 0.1 % of them make percentile_999 infinite too.
struct ImageErrors
{
  double mean_shift = 0.0;
  double mean_absolute = 0.0;
  double rms = 0.0;
  double percentile_999 = 0.0;
  double largest = 0.0;

  std::size_t values = 0;            ///< N; 0 means that nothing was measured
  std::size_t non_finite_test = 0;   ///< values of the test that are NaN or infinite
  std::size_t non_finite_truth = 0;  ///< values of the truth that are NaN or infinite
  std::size_t non_finite_pixels = 0; ///< pixels with such a value in either picture
};

/// Measures `test` against `truth`. Symmetric but for the sign of mean_shift and the two counts.
/// Throws std::invalid_argument when the pictures differ in width or height, are empty, or do not
/// hold 3 values a pixel.
VTKBRUMEANALYSIS_EXPORT ImageErrors measure(const Picture& test, const Picture& truth);

}
