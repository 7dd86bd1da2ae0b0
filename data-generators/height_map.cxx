#define BRUME_ONE_LANE
#include "data-generators/height_map.h"

#include "data-generators/height_map-inl.h"
#include "data-generators/noise.h"
#include "data-generators/random.h"
#include "data-generators/shaping.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <tbb/parallel_for.h>

namespace brume
{

HeightMap HeightMap::from(const std::function<double(double x, double y)>& ground,
  double width,
  int size)
{
  if (!(width > 0.0 && std::isfinite(width)) || size < 1 || size > 16384)
  {
    throw std::invalid_argument("a height map has a width above 0 and 1 to 16384 squares a side");
  }
  HeightMap map;
  map.dimensions = glm::ivec2(size + 1);
  map.origin = glm::dvec2(-0.5 * width);
  map.spacing = glm::dvec2(width / size);
  map.heights.resize(static_cast<std::size_t>(size + 1) * (size + 1));
  tbb::parallel_for(0,
    size + 1,
    [&](int j)
    {
      for (int i = 0; i <= size; ++i)
      {
        map.heights[static_cast<std::size_t>(j) * (size + 1) + i] = static_cast<float>(
          ground(map.origin.x + i * map.spacing.x, map.origin.y + j * map.spacing.y));
      }
    });
  return map;
}

float HeightMap::at(double x, double y) const
{
  return one_lane::ground_at(*this, x, y);
}

double HeightMap::quantile(double fraction) const
{
  std::vector<float> sorted = heights;
  const auto at = static_cast<std::size_t>(saturate(fraction) * (sorted.size() - 1) + 0.5);
  std::nth_element(sorted.begin(), sorted.begin() + at, sorted.end());
  return sorted[at];
}

void HeightMap::check() const
{
  if (dimensions.x < 2 || dimensions.y < 2 || dimensions.x > 16385 || dimensions.y > 16385 ||
      heights.size() != static_cast<std::size_t>(dimensions.x) * dimensions.y)
  {
    throw std::invalid_argument("a height map has 2 to 16385 heights along each axis");
  }
  if (!(spacing.x > 0.0 && spacing.y > 0.0) ||
      !std::isfinite(origin.x + origin.y + spacing.x + spacing.y) ||
      !std::all_of(heights.begin(), heights.end(), [](float h) { return std::isfinite(h); }))
  {
    throw std::invalid_argument("a height map's spacing is above 0 and its heights are finite");
  }
}

HeightMap valley_terrain(std::uint32_t seed, double width, double relief)
{
  if (!std::isfinite(relief) || relief < 0.0)
  {
    throw std::invalid_argument("a terrain's relief is 0 or more");
  }
  return HeightMap::from(
    [=](double x, double y)
    {
      const double bend = perlin_noise({ 0.5, y / (0.5 * width), 0.5 }, substream(seed, 20));
      const double d = saturate(std::fabs(x - 0.12 * width * bend) / (0.36 * width));
      const double s = d * d * (3.0 - 2.0 * d);
      const double f =
        fbm({ x / (0.22 * width), y / (0.22 * width), 0.5 }, substream(seed, 21), { 6, 2.0, 0.5 });
      const double ridge = (1.0 - std::fabs(f)) * (1.0 - std::fabs(f));
      return relief * (0.6 * s + 0.4 * std::sqrt(s) * ridge);
    },
    width);
}

}
