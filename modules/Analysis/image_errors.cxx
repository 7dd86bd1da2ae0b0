#include "image_errors.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace brume
{

namespace
{

std::string size_text(const Picture& picture)
{
  return std::to_string(picture.width) + " x " + std::to_string(picture.height);
}

}

ImageErrors measure(const Picture& test, const Picture& truth)
{
  check_shape(test, "picture to measure");
  check_shape(truth, "truth");
  if (test.width != truth.width || test.height != truth.height)
  {
    throw std::invalid_argument("picture to measure: it is " + size_text(test) +
      " pixels and its truth is " + size_text(truth) + ": draw both at one resolution");
  }

  constexpr double infinity = std::numeric_limits<double>::infinity();
  const std::size_t count = test.rgb.size();
  ImageErrors errors;
  errors.values = count;
  std::vector<double> magnitudes(count);
  double sum = 0.0;
  double sum_absolute = 0.0;
  double sum_squares = 0.0;
  for (std::size_t pixel = 0; pixel < count; pixel += 3)
  {
    bool finite_pixel = true;
    for (std::size_t i = pixel; i < pixel + 3; ++i)
    {
      const bool finite_test = std::isfinite(test.rgb[i]);
      const bool finite_truth = std::isfinite(truth.rgb[i]);
      errors.non_finite_test += finite_test ? 0 : 1;
      errors.non_finite_truth += finite_truth ? 0 : 1;
      const bool finite = finite_test && finite_truth;
      finite_pixel = finite_pixel && finite;
      const double error =
        finite ? static_cast<double>(test.rgb[i]) - static_cast<double>(truth.rgb[i]) : infinity;
      magnitudes[i] = std::abs(error);
      sum += error;
      sum_absolute += magnitudes[i];
      sum_squares += error * error;
    }
    errors.non_finite_pixels += finite_pixel ? 0 : 1;
  }
  const double n = static_cast<double>(count);
  errors.mean_shift = sum / n;
  errors.mean_absolute = sum_absolute / n;
  errors.rms = std::sqrt(sum_squares / n);
  errors.largest = *std::max_element(magnitudes.begin(), magnitudes.end());

  // ⌈0.999 N⌉ in integers, so that no rounding of 0.999 moves the rank.
  const std::size_t rank = count - count / 1000;
  const auto at_rank = magnitudes.begin() + static_cast<std::ptrdiff_t>(rank - 1);
  std::nth_element(magnitudes.begin(), at_rank, magnitudes.end());
  errors.percentile_999 = *at_rank;
  return errors;
}

}
