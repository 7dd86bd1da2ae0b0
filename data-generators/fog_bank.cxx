#define BRUME_ONE_LANE
#include "data-generators/fog_bank.h"

#include "data-generators/fog_bank-inl.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

namespace brume
{

namespace
{

constexpr int square = 16; ///< heights along a square of the coarse map

FogKernel kernel_of(const FogBank& fog, const Box& box)
{
  return { fog.options(), fog.ground().get(), fog.level(), box };
}

}

FogBank::FogBank(const FogOptions& options, std::shared_ptr<const HeightMap> ground)
  : m_options(options)
{
  const auto require = [](bool holds, const char* what)
  {
    if (!holds)
    {
      throw std::invalid_argument(std::string("fog: ") + what);
    }
  };
  const auto above_zero = [](double x) { return x > 0.0 && std::isfinite(x); };
  const auto fraction = [](double x) { return x >= 0.0 && x <= 1.0; };
  const FogOptions& o = m_options;
  require(above_zero(o.width), "the width must be above 0");
  require(above_zero(o.detail_size), "the detail size must be above 0");
  require(o.octaves >= 1 && o.octaves <= 8, "the octaves must be 1 to 8");
  require(fraction(o.noise), "the noise must be in [0, 1]");
  require(std::isfinite(o.wind.x) && std::isfinite(o.wind.y) && std::isfinite(o.wind.z),
    "the wind must be finite");
  const double half = 0.5 * o.width;
  if (o.kind != FogKind::Valley)
  {
    require(std::isfinite(o.base) && std::isfinite(o.top) && o.base < o.top,
      "the base must be below the top");
    require(o.kind == FogKind::Homogeneous || above_zero(o.scale_height),
      "the scale height must be above 0");
    m_box = { { -half, -half, o.base }, { half, half, o.top } };
    return;
  }
  require(fraction(o.coverage), "the coverage must be in [0, 1]");
  require(above_zero(o.softness), "the softness must be above 0");
  require(o.sink >= 0.0 && std::isfinite(o.sink), "the sink must be 0 or more");
  m_ground = ground ? std::move(ground)
                    : std::make_shared<const HeightMap>(valley_terrain(o.seed, o.width, o.relief));
  m_ground->check();
  m_level = m_ground->quantile(o.coverage);
  const HeightMap& map = *m_ground;
  const glm::ivec2 squares = (map.dimensions - 2) / square + 1;
  for (int j = 0; j < squares.y; ++j)
  {
    for (int i = 0; i < squares.x; ++i)
    {
      float lowest = std::numeric_limits<float>::infinity();
      for (int y = j * square; y <= std::min((j + 1) * square, map.dimensions.y - 1); ++y)
      {
        for (int x = i * square; x <= std::min((i + 1) * square, map.dimensions.x - 1); ++x)
        {
          lowest =
            std::min(lowest, map.heights[static_cast<std::size_t>(y) * map.dimensions.x + x]);
        }
      }
      m_lowest.push_back(lowest);
    }
  }
  const double floor = *std::min_element(map.heights.begin(), map.heights.end()) - o.sink;
  const double ceiling = m_level + (o.noise + 0.05) * o.softness;
  m_box = { { -half, -half, floor }, { half, half, std::max(ceiling, floor + 0.1 * o.softness) } };
}

FogBank::~FogBank() = default;

Box FogBank::bounds() const
{
  return m_box;
}

float FogBank::value(const glm::dvec3& place, double time) const
{
  return one_lane::fog(kernel_of(*this, m_box),
    { place.x, place.y, place.z },
    one_lane::drift_of(m_options.wind, time));
}

void FogBank::values(const PlaceBlock& places, double time, float* out) const
{
  fog_packets(kernel_of(*this, m_box), places, time, out);
}

double FogBank::lowest_ground(const Box& box) const
{
  const HeightMap& map = *m_ground;
  const glm::ivec2 squares = (map.dimensions - 2) / square + 1;
  glm::ivec2 first, last;
  for (int a = 0; a < 2; ++a)
  {
    const auto square_of = [&](double x, double margin)
    {
      const double at = (x - map.origin[a]) / map.spacing[a] + margin;
      return at > 0.0 ? static_cast<int>(std::min(at / square, squares[a] - 1.0)) : 0;
    };
    first[a] = square_of(box.lower[a], -0.01);
    last[a] = square_of(box.upper[a], 0.01);
  }
  float lowest = std::numeric_limits<float>::infinity();
  for (int j = first.y; j <= last.y; ++j)
  {
    for (int i = first.x; i <= last.x; ++i)
    {
      lowest = std::min(lowest, m_lowest[static_cast<std::size_t>(j) * squares.x + i]);
    }
  }
  return lowest;
}

FieldRange FogBank::range_in(const Box& box, double) const
{
  constexpr FieldRange empty{ 0.0f, 0.0f };
  const double margin = 1e-5 * std::max(m_box.upper.x, m_box.upper.z - m_box.lower.z);
  bool all_within = true;
  for (int a = 0; a < 3; ++a)
  {
    if (box.upper[a] < m_box.lower[a] - margin || box.lower[a] > m_box.upper[a] + margin)
    {
      return empty;
    }
    all_within = all_within && box.lower[a] >= m_box.lower[a] + margin &&
                 box.upper[a] <= m_box.upper[a] - margin;
  }
  const FogOptions& o = m_options;
  if (o.kind == FogKind::Homogeneous)
  {
    return { all_within ? 1.0f : 0.0f, 1.0f };
  }
  if (o.kind == FogKind::Valley && (box.upper.z < this->lowest_ground(box) - o.sink - margin ||
                                     box.lower.z > m_level + o.noise * o.softness + margin))
  {
    return empty;
  }
  return { 0.0f, 1.0f };
}

}
