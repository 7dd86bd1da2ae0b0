#include "image_sampling.h"

#include <algorithm>
#include <cmath>

namespace brume
{

ImageSampling::ImageSampling(int w, int h, double d)
  : width(w)
  , height(h)
  , per_pixel(1)
  , distance(1.0)
{
  if (d < 1.0)
  {
    per_pixel = std::max(1, static_cast<int>(std::lround(1.0 / d)));
    width = w * per_pixel;
    height = h * per_pixel;
    distance = 1.0 / per_pixel;
  }
  else if (d > 1.0)
  {
    width = std::max(1, static_cast<int>(std::lround(w / d)));
    height = std::max(1, static_cast<int>(std::lround(h / d)));
    distance = std::sqrt(static_cast<double>(w) * h / (static_cast<double>(width) * height));
  }
}

std::vector<float> at_rays(const std::vector<float>& depth,
  int width,
  int height,
  const ImageSampling& rays)
{
  std::vector<float> result(static_cast<std::size_t>(rays.width) * rays.height);
  for (int y = 0; y < rays.height; ++y)
  {
    const int row = std::min(height - 1, static_cast<int>((y + 0.5) * height / rays.height));
    for (int x = 0; x < rays.width; ++x)
    {
      const int column = std::min(width - 1, static_cast<int>((x + 0.5) * width / rays.width));
      result[static_cast<std::size_t>(y) * rays.width + x] =
        depth[static_cast<std::size_t>(row) * width + column];
    }
  }
  return result;
}

Film averaged(const Film& film, int per_pixel)
{
  Film result(film.width / per_pixel, film.height / per_pixel);
  const float share = 1.0f / (per_pixel * per_pixel);
  for (int c = 0; c < 3; ++c)
  {
    std::fill(result.transmittance[c].begin(), result.transmittance[c].end(), 0.0f);
  }
  for (int y = 0; y < result.height * per_pixel; ++y)
  {
    for (int x = 0; x < result.width * per_pixel; ++x)
    {
      const std::size_t from = static_cast<std::size_t>(y) * film.width + x;
      const std::size_t to = static_cast<std::size_t>(y / per_pixel) * result.width + x / per_pixel;
      for (int c = 0; c < 3; ++c)
      {
        result.radiance[c][to] += share * film.radiance[c][from];
        result.transmittance[c][to] += share * film.transmittance[c][from];
      }
      result.depth[to] = std::min(result.depth[to], film.depth[from]);
      result.error[to] = std::max(result.error[to], film.error[from]);
    }
  }
  return result;
}

void apply_window_level(Film& film, double window, double level)
{
  const float scale = static_cast<float>(1.0 / window);
  const float bias = static_cast<float>(0.5 - level / window);
  for (int c = 0; c < 3; ++c)
  {
    for (std::size_t i = 0; i < film.size(); ++i)
    {
      film.radiance[c][i] =
        std::max(0.0f, film.radiance[c][i] * scale + bias * (1.0f - film.transmittance[c][i]));
    }
  }
}

}
