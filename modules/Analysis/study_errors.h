// How far a picture is from a truth that has noise of its own.
#pragma once

#include "image_errors.h"
#include "picture.h"

#include <array>
#include <string>
#include <vector>

namespace brume
{

/// Two independent estimates A and B of the same true picture; the truth is their mean. Empty pictures
/// where the truth was not found by chance.
struct TruthHalves
{
  Picture a;
  Picture b;
  bool empty() const { return this->a.rgb.empty(); }
};

/// The error of the truth itself, in the figures that pictures are measured by.
struct TruthNoise
{
  double rms = 0.0;            ///< standard error of a value, root mean square over all
  double mean = 0.0;           ///< standard error of the mean over all pixels
  double percentile_999 = 0.0; ///< what 99.9 % of the truth's values are within of the mean that it estimates
  double largest = 0.0;        ///< likewise, of all
  double perceptual = 0.0; ///< share of pixels that tell one half from the other
};

/// What (A − B) / 2 says of the noise of (A + B) / 2: it has the same distribution. Throws
/// std::invalid_argument as measure() does.
VTKBRUMEANALYSIS_EXPORT TruthNoise noise_of(const TruthHalves& halves);

/// (A + B) / 2.
VTKBRUMEANALYSIS_EXPORT Picture mean_of(const TruthHalves& halves);

/// The errors of a picture against a truth with noise. With e = picture − (A + B)/2 and d = A − B,
///
///     mean square = mean(e²) − mean(d²)/4 = mean((picture − A)(picture − B))
///
/// whose expectation holds no noise of the truth, as that of A and of B are independent and of mean 0.
/// Its own standard error is √Σ(Σ_c e d)² / N over pixels and their channels c: e d has the mean 0.
/// Percentile and largest cannot be freed of noise like that: they are measured against the mean, and
/// TruthNoise tells what of them may be the truth's.
struct StudyErrors
{
  ImageErrors measured; ///< against the mean of the halves, as measure() has it
  double rms = 0.0;     ///< √mean square, freed of the truth's noise; 0 where that is below 0
  double rms_upper = 0.0; ///< the same, two standard errors further; `rms` for a truth without noise
  double mean_shift_error = 0.0; ///< standard error of measured.mean_shift
  double perceptual = 0.0; ///< share of pixels that an eye tells from the truth's (image_filters.h)
  /// Shares of pixels whose worst channel is within each of study_tolerances.
  std::array<double, 3> within{ 0.0, 0.0, 0.0 };
  /// Whether the truth's own error is so near that the figure says what the truth is rather than the
  /// picture.
  ///@{
  bool rms_limited = false;        ///< rms is less than two of its standard errors above 0, or than the truth's error
  bool percentile_limited = false; ///< less than twice the truth's
  ///@}
};

/// Measures a picture, but for `perceptual`. Without halves the noise's figures stand for the truth's
/// error. `by_chance`: the picture has noise of its own, which its mean's standard error is to hold.
VTKBRUMEANALYSIS_EXPORT StudyErrors measure_against(const Picture& picture,
  const Picture& truth,
  const TruthHalves& halves,
  const TruthNoise& noise,
  bool by_chance = false);

/// The share of pixels whose worst channel is off by no more than this; what is not finite is off.
VTKBRUMEANALYSIS_EXPORT double share_within(
  const Picture& picture, const Picture& truth, double tolerance);

}
