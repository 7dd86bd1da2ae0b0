#include "study_errors.h"

#include "image_filters.h"
#include "noise_sums.h"
#include "study.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace brume
{

Picture mean_of(const TruthHalves& halves)
{
  check_shape(halves.a, "first half of the truth");
  check_shape(halves.b, "second half of the truth");
  if (halves.a.rgb.size() != halves.b.rgb.size())
  {
    throw std::invalid_argument("halves of the truth: they differ in size");
  }
  Picture mean = halves.a;
  for (std::size_t i = 0; i < mean.rgb.size(); ++i)
  {
    mean.rgb[i] = 0.5f * (halves.a.rgb[i] + halves.b.rgb[i]);
  }
  return mean;
}

TruthNoise noise_of(const TruthHalves& halves)
{
  const ImageErrors apart = measure(halves.a, halves.b);
  const Picture mean = mean_of(halves);
  NoiseSums sums;
  for (std::size_t pixel = 0; pixel < mean.rgb.size() / 3; ++pixel)
  {
    sums.add(mean, mean, halves, false, pixel);
  }
  return { 0.5 * apart.rms, sums.mean_error(), 0.5 * apart.percentile_999, 0.5 * apart.largest,
    perceptual_difference(halves.a, halves.b) };
}

double share_within(const Picture& picture, const Picture& truth, double tolerance)
{
  std::size_t within = 0;
  const std::size_t pixels = picture.rgb.size() / 3;
  for (std::size_t pixel = 0; pixel < pixels; ++pixel)
  {
    bool good = true;
    for (std::size_t i = 3 * pixel; i < 3 * pixel + 3; ++i)
    {
      good = good && std::abs(double(picture.rgb[i]) - double(truth.rgb[i])) <= tolerance;
    }
    within += good ? 1 : 0;
  }
  return pixels ? static_cast<double>(within) / static_cast<double>(pixels) : 0.0;
}

StudyErrors measure_against(const Picture& picture,
  const Picture& truth,
  const TruthHalves& halves,
  const TruthNoise& noise,
  bool by_chance)
{
  StudyErrors errors;
  errors.measured = measure(picture, truth);
  for (std::size_t i = 0; i < study_tolerances.size(); ++i)
  {
    errors.within[i] = share_within(picture, truth, study_tolerances[i]);
  }
  if (!std::isfinite(errors.measured.rms))
  {
    errors.rms = errors.rms_upper = errors.measured.rms;
    return errors;
  }
  NoiseSums sums;
  for (std::size_t pixel = 0; pixel < truth.rgb.size() / 3; ++pixel)
  {
    sums.add(picture, truth, halves, by_chance, pixel);
  }
  errors.mean_shift_error = sums.mean_error();
  if (halves.empty())
  {
    errors.rms = errors.rms_upper = errors.measured.rms;
    errors.mean_shift_error = std::max(errors.mean_shift_error, noise.mean);
    errors.rms_limited = errors.rms < 2.0 * noise.rms;
  }
  else
  {
    const double square = sums.mean_square();
    const double uncertain = 2.0 * sums.mean_square_error();
    errors.rms = std::sqrt(std::max(0.0, square));
    errors.rms_upper = std::sqrt(std::max(0.0, square) + uncertain);
    errors.rms_limited = square <= uncertain;
  }
  errors.percentile_limited = errors.measured.percentile_999 < 2.0 * noise.percentile_999;
  return errors;
}

}
