#include "data-generators/cumulus.h"

#include "data-generators/heap_cloud.h"
#include "data-generators/piles.h"

#include <algorithm>
#include <cmath>
#include <glm/vec2.hpp>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace brume
{

namespace
{

// The cloud's proportions, in widths of its box.
constexpr double box_height = 0.6;
constexpr double base_height = 0.08;
constexpr double top_height = 0.52;
constexpr double largest_warp = 0.06;

/// The puffs of a cloud in a box of width 1.
std::vector<Puff> pile_cumulus(std::uint32_t seed)
{
  std::vector<Puff> puffs;
  RandomSequence random(substream(seed, 105));
  // The first tower stands near the middle and is the highest. The others lie around it at even
  // angles, on an ellipse longer in x, every other one nearer to it; the farther the lower.
  static const double around[8][2] = { { 1.0, 0.0 },
    { 0.7, 0.7 },
    { 0.0, 1.0 },
    { -0.7, 0.7 },
    { -1.0, 0.0 },
    { -0.7, -0.7 },
    { 0.0, -1.0 },
    { 0.7, -0.7 } };
  for (int t = 0; t < 9; ++t)
  {
    double x = random.between(-0.05, 0.05);
    double y = random.between(-0.05, 0.05);
    double top = random.between(0.24, 0.34);
    double radius = random.between(0.15, 0.18);
    if (t > 0)
    {
      const double reach = t % 2 == 1 ? random.between(0.6, 1.0) : random.between(0.35, 0.8);
      x += 0.35 * reach * around[t - 1][0];
      y += 0.31 * reach * around[t - 1][1];
      top = (1.25 - reach) * random.between(0.05, 0.3);
      radius = random.between(0.10, 0.16);
    }
    // Spheres from the base up to the top, each smaller and a little to the side.
    double size = radius;
    for (double z = base_height + 0.1 * radius; z <= base_height + top; z += 0.8 * size)
    {
      add_buds(puffs, { { x, y, z }, glm::dvec3(size) }, 2, random);
      size *= random.between(0.84, 0.94);
      x += size * random.between(-0.25, 0.25);
      y += size * random.between(-0.25, 0.25);
    }
  }
  // What would reach the border is drawn in, so that the border's fade has little to cut.
  const double room = 0.5 - HeapCloud::usual_fade;
  for (Puff& p : puffs)
  {
    const double radius = std::min(p.radii.x, room);
    p.radii = glm::dvec3(radius);
    p.centre.x = std::clamp(p.centre.x, radius - room, room - radius);
    p.centre.y = std::clamp(p.centre.y, radius - room, room - radius);
    p.centre.z = std::min(p.centre.z, box_height - HeapCloud::usual_fade - radius);
  }
  return puffs;
}

}

Cumulus::Cumulus(const CumulusOptions& options)
  : m_options(options)
{
  const auto require = [](bool holds, const char* what)
  {
    if (!holds)
    {
      throw std::invalid_argument(std::string("cumulus: ") + what);
    }
  };
  const auto above_zero = [](double x) { return x > 0.0 && std::isfinite(x); };
  require(above_zero(options.width), "the width must be above 0");
  require(std::isfinite(options.base) && std::isfinite(options.top), "base and top must be finite");
  require(above_zero(options.detail_size), "the detail size must be above 0");
  require(options.octaves >= 1 && options.octaves <= 8, "the octaves must be 1 to 8");
  require(options.offset >= 0.0 && options.offset <= 1.0, "the offset must be in [0, 1]");
  require(above_zero(options.crispness), "the crispness must be above 0");
  require(std::isfinite(options.warp_amplitude) && std::isfinite(options.warp_size),
    "the warp must be finite");
  require(
    std::isfinite(options.wind.x) && std::isfinite(options.wind.y) && std::isfinite(options.wind.z),
    "the wind must be finite");
  m_options.warp_amplitude = std::clamp(options.warp_amplitude, 0.0, largest_warp * options.width);

  // The pile's heights, stretched from its base and top to those that are asked for.
  const double base = options.base > 0.0 ? options.base / options.width : base_height;
  const double top =
    options.top > 0.0 ? options.top / options.width : base + top_height - base_height;
  require(base >= 0.03 && top > base && top < 20.0,
    "the base must be at 0.03 width or higher, and the top above it, below 20 widths");
  const double stretch = (top - base) / (top_height - base_height);
  std::vector<Puff> puffs = pile_cumulus(options.seed);
  for (Puff& p : puffs)
  {
    p.centre.z = base + (p.centre.z - base_height) * stretch;
    p.radii.z *= stretch;
  }
  auto cloud = std::make_unique<HeapCloud>();
  cloud->seed = options.seed;
  cloud->width = options.width;
  cloud->height = top + box_height - top_height;
  cloud->base = base;
  cloud->detail_size = options.detail_size;
  cloud->octaves = options.octaves;
  cloud->offset = options.offset;
  cloud->crispness = options.crispness;
  cloud->warp_amplitude = m_options.warp_amplitude;
  cloud->warp_size = options.warp_size;
  cloud->wind = options.wind;
  m_heap = std::make_unique<PuffHeap>(puffs,
    Box{ { -0.5, -0.5, 0.0 }, { 0.5, 0.5, cloud->height } },
    m_options.warp_amplitude / options.width);
  cloud->heap = m_heap.get();
  m_cloud = std::move(cloud);
}

Cumulus::~Cumulus() = default;

Box Cumulus::bounds() const
{
  const double half = 0.5 * m_options.width;
  return { { -half, -half, 0.0 }, { half, half, m_cloud->height * m_options.width } };
}

float Cumulus::value(const glm::dvec3& place, double time) const
{
  return heap_cloud_value(*m_cloud, place, time);
}

void Cumulus::values(const PlaceBlock& places, double time, float* out) const
{
  heap_cloud_packets(*m_cloud, places, time, out);
}

FieldRange Cumulus::range_in(const Box& box, double) const
{
  return m_cloud->range_in(box);
}

}
