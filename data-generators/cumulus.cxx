#include "data-generators/cumulus.h"

#include "data-generators/random.h"
#include "data-generators/shaping.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>
#include <vector>

namespace brume
{

namespace
{

// The cloud's proportions, in widths of its box.
constexpr double box_height = 0.6;
constexpr double base_height = 0.08;
constexpr double empty_border = 0.02; ///< no density nearer to a face than this
constexpr double border_fade = 0.06;  ///< full density from here on
constexpr double largest_warp = 0.06;
constexpr double threshold = 0.25;

struct Sphere
{
  glm::dvec3 centre;
  double radius;
};

/// Random numbers in [0, 1), one after the other.
class Sequence
{
public:
  explicit Sequence(std::uint32_t key)
    : m_key(key)
  {
  }
  double next() { return unit_float(hash_lattice(m_counter++, 0, 0, m_key)); }
  double between(double low, double high) { return mix(low, high, next()); }

private:
  std::uint32_t m_key;
  std::uint32_t m_counter = 0;
};

/// A direction at random in the unit ball's shell, sides and top rather than below. By rejection:
/// no sine, no cosine.
glm::dvec3 upward_direction(Sequence& random)
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

void add_buds(std::vector<Sphere>& spheres, const Sphere& parent, int generation, Sequence& random)
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
  Sequence random(substream(seed, 105));
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
  const double room = 0.5 - border_fade;
  for (Sphere& s : spheres)
  {
    s.radius = std::min(s.radius, room);
    s.centre.x = std::clamp(s.centre.x, s.radius - room, room - s.radius);
    s.centre.y = std::clamp(s.centre.y, s.radius - room, room - s.radius);
    s.centre.z = std::min(s.centre.z, box_height - border_fade - s.radius);
  }
  return spheres;
}

}

/// The spheres of the cloud, sorted into cells so that a place asks only those that reach it.
class Cumulus::Heap
{
public:
  /// `reach` is how far a place may be moved along each axis before it asks, in widths.
  Heap(std::uint32_t seed, double reach)
  {
    const std::vector<Sphere> spheres = pile_spheres(seed);
    std::vector<std::vector<Sphere>> lists(cells * cells * cells);
    for (const Sphere& s : spheres)
    {
      int low[3], high[3];
      for (int a = 0; a < 3; ++a)
      {
        low[a] = cell_of(s.centre[a] - s.radius - reach, a);
        high[a] = cell_of(s.centre[a] + s.radius + reach, a);
      }
      for (int k = low[2]; k <= high[2]; ++k)
      {
        for (int j = low[1]; j <= high[1]; ++j)
        {
          for (int i = low[0]; i <= high[0]; ++i)
          {
            lists[(k * cells + j) * cells + i].push_back(s);
          }
        }
      }
    }
    m_begin.push_back(0);
    for (const std::vector<Sphere>& list : lists)
    {
      m_spheres.insert(m_spheres.end(), list.begin(), list.end());
      m_begin.push_back(m_spheres.size());
    }
  }

  /// The cell of a place, in widths of the box, before it is moved.
  int find(const glm::dvec3& p) const
  {
    return (cell_of(p.z, 2) * cells + cell_of(p.y, 1)) * cells + cell_of(p.x, 0);
  }

  bool empty(int cell) const { return m_begin[cell] == m_begin[cell + 1]; }

  /// 1 - prod(1 - f_b^2), in [0, 1], at a place moved from within that cell.
  double at(int cell, const glm::dvec3& p) const
  {
    double rest = 1.0;
    for (std::size_t b = m_begin[cell]; b < m_begin[cell + 1]; ++b)
    {
      const Sphere& s = m_spheres[b];
      const glm::dvec3 d = p - s.centre;
      const double f = 1.0 - (d.x * d.x + d.y * d.y + d.z * d.z) / (s.radius * s.radius);
      if (f > 0.0)
      {
        rest *= 1.0 - f * f;
      }
    }
    return 1.0 - rest;
  }

private:
  static constexpr int cells = 32;

  static int cell_of(double x, int axis)
  {
    const double low = axis == 2 ? 0.0 : -0.5;
    const double size = axis == 2 ? box_height : 1.0;
    return static_cast<int>(std::clamp((x - low) / size * cells, 0.0, cells - 1.0));
  }

  std::vector<Sphere> m_spheres;
  std::vector<std::size_t> m_begin; ///< of each cell in m_spheres, and the end of the last
};

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
  m_heap = std::make_unique<Heap>(options.seed, m_options.warp_amplitude / options.width);
}

Cumulus::~Cumulus() = default;

Box Cumulus::bounds() const
{
  const double half = 0.5 * m_options.width;
  return { { -half, -half, 0.0 }, { half, half, box_height * m_options.width } };
}

float Cumulus::value(const glm::dvec3& place, double time) const
{
  const CumulusOptions& o = m_options;

  // Distance to the nearest face, and the height over the base: nothing outside, nothing below.
  const glm::dvec3 unit = place / o.width;
  const double inside =
    std::min({ 0.5 - std::fabs(unit.x), 0.5 - std::fabs(unit.y), unit.z, box_height - unit.z });
  if (!std::isfinite(unit.x + unit.y + unit.z) || !(inside > empty_border) ||
      unit.z <= base_height - 0.03)
  {
    return 0.0f;
  }

  const int cell = m_heap->find(unit);
  if (m_heap->empty(cell))
  {
    return 0.0f;
  }

  // Even the strongest noise leaves nothing where heap * (0.8 + offset) is below the threshold.
  const double needed = threshold / (0.8 + o.offset);
  const glm::dvec3 drift = std::isfinite(time) ? o.wind * time : glm::dvec3(0.0);
  const glm::dvec3 warped =
    warp(place - drift, o.warp_size, o.warp_amplitude, substream(o.seed, 1)) + drift;
  const double heap = m_heap->at(cell, warped / o.width);
  if (heap <= needed)
  {
    return 0.0f;
  }

  const glm::dvec3 at = (warped - drift) / o.detail_size;
  const double billows = billow_fbm(at, substream(o.seed, 2), { std::min(o.octaves, 4), 2.0, 0.5 });
  const double gradient = 0.5 + 0.5 * fbm(at, substream(o.seed, 3), { o.octaves, 2.0, 0.5 });
  const double noise = remap(0.5 * (billows + gradient), 0.33, 0.63, 0.0, 1.0);

  const double body = saturate(o.crispness * (heap * (0.8 * noise + o.offset) - threshold));
  const double base =
    smooth_ramp(unit.z, base_height - 0.03 + 0.03 * noise, base_height + 0.015 + 0.03 * noise);
  return static_cast<float>(body * base * smooth_ramp(inside, empty_border, border_fade));
}

}
