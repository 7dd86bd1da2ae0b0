#include "image_filters.h"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace brume
{

namespace
{

constexpr float white_luminance = 100.0f; ///< cd/m²
constexpr double pixels_per_degree = 40.0;
/// Below, the metric's pyramid has too little to go by.
constexpr float least_field = 1.0f; ///< degrees

OIIO::ImageBuf buffer_of(std::vector<float>& rgb, int width, int height)
{
  return OIIO::ImageBuf(OIIO::ImageSpec(width, height, 3, OIIO::TypeDesc::FLOAT), rgb.data());
}

}

double perceptual_difference(const Picture& test, const Picture& truth)
{
  check_shape(test, "picture to measure");
  check_shape(truth, "truth");
  if (test.width != truth.width || test.height != truth.height)
  {
    throw std::invalid_argument("picture to measure: it is not of its truth's size");
  }
  std::vector<float> one = test.rgb;
  std::vector<float> other = truth.rgb;
  std::size_t broken = 0;
  for (std::size_t pixel = 0; pixel < one.size(); pixel += 3)
  {
    bool finite = true;
    for (std::size_t i = pixel; i < pixel + 3; ++i)
    {
      finite = finite && std::isfinite(one[i]) && std::isfinite(other[i]);
      one[i] = std::max(one[i], 0.0f);
      other[i] = std::max(other[i], 0.0f);
    }
    if (!finite)
    {
      ++broken;
      std::fill_n(one.begin() + static_cast<std::ptrdiff_t>(pixel), 3, 0.0f);
      std::fill_n(other.begin() + static_cast<std::ptrdiff_t>(pixel), 3, 0.0f);
    }
  }
  const OIIO::ImageBuf a = buffer_of(one, test.width, test.height);
  const OIIO::ImageBuf b = buffer_of(other, test.width, test.height);
  OIIO::ImageBufAlgo::CompareResults result;
  const float field = std::max(least_field, static_cast<float>(test.width / pixels_per_degree));
  const int told = OIIO::ImageBufAlgo::compare_Yee(a, b, result, white_luminance, field);
  const std::size_t pixels = one.size() / 3;
  return static_cast<double>(std::min(pixels, static_cast<std::size_t>(std::max(told, 0)) + broken)) /
    static_cast<double>(pixels);
}

Picture scaled(const Picture& picture, int width, int height)
{
  check_shape(picture, "picture to scale");
  if (width < 1 || height < 1)
  {
    throw std::invalid_argument("picture to scale: its size must be positive");
  }
  std::vector<float> from = picture.rgb;
  Picture result{ width, height, std::vector<float>(3 * static_cast<std::size_t>(width) * height) };
  OIIO::ImageBuf target = buffer_of(result.rgb, width, height);
  if (!OIIO::ImageBufAlgo::resize(
        target, buffer_of(from, picture.width, picture.height), "triangle"))
  {
    throw std::runtime_error("picture to scale: " + target.geterror());
  }
  return result;
}

}
