#include "data-generators/cumulus.h"

#include "data-generators/heap_cloud.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
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

struct Sphere
{
  glm::dvec3 centre;
  double radius;
};

/// A direction at random in the unit ball's shell, sides and top rather than below. By rejection:
/// no sine, no cosine.
glm::dvec3 upward_direction(RandomSequence& random)
{
  for (;;)
  {
    const glm::dvec3 d(
      random.between(-1.0, 1.0), random.between(-1.0, 1.0), random.between(-0.35, 1.0));
    const double square = d.x * d.x + d.y * d.y + d.z * d.z;
    if (square > 0.04 && square <= 1.0)
    {
      return d / std::sqrt(square);
    }
  }
}

void add_buds(std::vector<Sphere>& spheres,
  const Sphere& parent,
  int generation,
  RandomSequence& random)
{
  spheres.push_back(parent);
  if (generation == 0)
  {
    return;
  }
  const int count = generation == 2 ? 7 : 6;
  for (int b = 0; b < count; ++b)
  {
    const glm::dvec3 direction = upward_direction(random);
    const Sphere bud{ parent.centre + direction * (parent.radius * random.between(0.62, 0.8)),
      parent.radius * random.between(0.42, 0.58) };
    add_buds(spheres, bud, generation - 1, random);
  }
}

/// The spheres of a cloud in a box of width 1.
std::vector<Sphere> pile_spheres(std::uint32_t seed)
{
  std::vector<Sphere> spheres;
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
      add_buds(spheres, { { x, y, z }, size }, 2, random);
      size *= random.between(0.84, 0.94);
      x += size * random.between(-0.25, 0.25);
      y += size * random.between(-0.25, 0.25);
    }
  }
  // What would reach the border is drawn in, so that the border's fade has little to cut.
  const double room = 0.5 - HeapCloud::border_fade;
  for (Sphere& s : spheres)
  {
    s.radius = std::min(s.radius, room);
    s.centre.x = std::clamp(s.centre.x, s.radius - room, room - s.radius);
    s.centre.y = std::clamp(s.centre.y, s.radius - room, room - s.radius);
    s.centre.z = std::min(s.centre.z, box_height - HeapCloud::border_fade - s.radius);
  }
  return spheres;
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
  require(base >= HeapCloud::below_base && top > base && top < 20.0,
    "the base must be at 0.03 width or higher, and the top above it, below 20 widths");
  const double stretch = (top - base) / (top_height - base_height);
  std::vector<Puff> puffs;
  for (const Sphere& s : pile_spheres(options.seed))
  {
    puffs.push_back({ { s.centre.x, s.centre.y, base + (s.centre.z - base_height) * stretch },
      { s.radius, s.radius, s.radius * stretch } });
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
