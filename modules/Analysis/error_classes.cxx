#include "error_classes.h"

#include "noise_sums.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace brume
{

namespace
{

constexpr unsigned char no_class = 255;
constexpr double nothing = 0.01; ///< optical depths
constexpr double thin = 0.5;
constexpr double thick = 3.0;
constexpr std::size_t smallest_share = 200; ///< one in so many
constexpr double steep_share = 0.1;

/// The mean of the channels.
std::vector<double> mean_transmittance(const std::vector<float> transmittance[3])
{
  std::vector<double> mean(transmittance[0].size());
  for (std::size_t i = 0; i < mean.size(); ++i)
  {
    mean[i] =
      (double(transmittance[0][i]) + double(transmittance[1][i]) + double(transmittance[2][i])) / 3.0;
  }
  return mean;
}

double depth_of(double transmittance)
{
  return transmittance > 0.0 ? -std::log(transmittance) : std::numeric_limits<double>::infinity();
}

/// Counts the pixels and takes the means of the truth; leaves small classes out.
void count(ErrorClasses& classes, const Picture& truth)
{
  classes.pixels.assign(classes.names.size(), 0);
  classes.brightness.assign(classes.names.size(), 0.0);
  std::size_t matter = 0;
  for (std::size_t pixel = 0; pixel < classes.of_pixel.size(); ++pixel)
  {
    const unsigned char which = classes.of_pixel[pixel];
    if (which == no_class)
    {
      continue;
    }
    ++classes.pixels[which];
    ++matter;
    for (std::size_t c = 0; c < 3; ++c)
    {
      classes.brightness[which] += truth.rgb[3 * pixel + c] / 3.0;
    }
  }
  for (std::size_t i = 0; i < classes.pixels.size(); ++i)
  {
    classes.pixels[i] = smallest_share * classes.pixels[i] < matter ? 0 : classes.pixels[i];
    classes.brightness[i] =
      classes.pixels[i] ? classes.brightness[i] / static_cast<double>(classes.pixels[i]) : 0.0;
  }
}

}

ErrorClasses classes_by_depth(const std::vector<float> transmittance[3], const Picture& truth)
{
  ErrorClasses classes;
  classes.names = { "thin edges", "middle depths", "thick cores" };
  classes.bounds = { "optical depth 0.01 to 0.5", "optical depth 0.5 to 3", "optical depth 3 and more" };
  for (const double passes : mean_transmittance(transmittance))
  {
    const double depth = depth_of(passes);
    classes.of_pixel.push_back(depth < nothing ? no_class : depth < thin ? 0 : depth < thick ? 1 : 2);
  }
  count(classes, truth);
  return classes;
}

ErrorClasses classes_by_outline(const std::vector<float> transmittance[3], const Picture& truth)
{
  const std::vector<double> mean = mean_transmittance(transmittance);
  const std::size_t width = static_cast<std::size_t>(truth.width);
  const std::size_t height = static_cast<std::size_t>(truth.height);
  std::vector<double> steepness(mean.size(), -1.0); // of pixels without matter
  std::vector<double> sorted;
  for (std::size_t y = 0; y < height; ++y)
  {
    for (std::size_t x = 0; x < width; ++x)
    {
      const std::size_t i = y * width + x;
      if (depth_of(mean[i]) < nothing)
      {
        continue;
      }
      const double across = mean[i + (x + 1 < width ? 1 : 0)] - mean[i - (x > 0 ? 1 : 0)];
      const double up = mean[i + (y + 1 < height ? width : 0)] - mean[i - (y > 0 ? width : 0)];
      steepness[i] = std::hypot(across, up);
      sorted.push_back(steepness[i]);
    }
  }
  ErrorClasses classes;
  classes.names = { "outlines", "the rest" };
  classes.bounds = { "the tenth of the pixels with matter where the transmittance changes most from pixel "
                     "to pixel",
    "the other pixels with matter" };
  const std::size_t steep = static_cast<std::size_t>(std::ceil(steep_share * sorted.size()));
  double least = std::numeric_limits<double>::infinity();
  if (steep > 0)
  {
    const auto at = sorted.begin() + static_cast<std::ptrdiff_t>(steep - 1);
    std::nth_element(sorted.begin(), at, sorted.end(), std::greater<double>());
    least = *at;
  }
  for (const double s : steepness)
  {
    classes.of_pixel.push_back(s < 0.0 ? no_class : s >= least && s > 0.0 ? 0 : 1);
  }
  count(classes, truth);
  return classes;
}

std::vector<ClassError> errors_by_class(const Picture& picture,
  const Picture& truth,
  const TruthHalves& halves,
  const ErrorClasses& classes,
  bool by_chance)
{
  std::vector<NoiseSums> sums(classes.pixels.size());
  for (std::size_t pixel = 0; pixel < classes.of_pixel.size(); ++pixel)
  {
    if (classes.of_pixel[pixel] < sums.size())
    {
      sums[classes.of_pixel[pixel]].add(picture, truth, halves, by_chance, pixel);
    }
  }
  std::vector<ClassError> errors(sums.size());
  for (std::size_t i = 0; i < sums.size(); ++i)
  {
    if (classes.pixels[i] > 0)
    {
      errors[i] = { sums[i].mean(), sums[i].mean_error(),
        std::sqrt(std::max(0.0, sums[i].mean_square())) };
    }
  }
  return errors;
}

double share_of_class(
  const std::vector<ClassError>& errors, const ErrorClasses& classes, std::size_t which)
{
  double all = 0.0;
  double here = 0.0;
  for (std::size_t i = 0; i < errors.size(); ++i)
  {
    const double square = errors[i].rms * errors[i].rms * static_cast<double>(classes.pixels[i]);
    all += square;
    here += i == which ? square : 0.0;
  }
  return all > 0.0 ? here / all : 0.0;
}

}
