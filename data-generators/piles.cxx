#include "data-generators/piles.h"

#include "data-generators/heap_cloud.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <iterator>
#include <stdexcept>

namespace brume
{

namespace
{

/// A direction at random, sides and top rather than below. By rejection: no sine, no cosine.
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

/// Of a field: some 3 GB while it is made.
constexpr std::size_t most_puffs = std::size_t(1) << 24;

/// What reaches past the room that the box's border leaves is drawn in.
void draw_in(Puff& p, double room)
{
  for (int a = 0; a < 2; ++a)
  {
    p.radii[a] = std::min(p.radii[a], room);
    p.centre[a] = std::clamp(p.centre[a], p.radii[a] - room, room - p.radii[a]);
  }
}

/// Which of the ground is under cloud, while clouds are added: places of a square grid, each with
/// the heap (puffs.h) at some heights above it. A place is under cloud as soon as the heap at one
/// of them is so high that noise of the usual strength leaves something of it.
class Ground
{
public:
  Ground(const CloudOptions& o, double room)
    : m_room(room)
    , m_base(o.base / o.width)
    , m_height((o.top - o.base) / o.width)
    , m_side(static_cast<int>(std::clamp(2.0 * room / (0.06 * m_height), 128.0, 768.0)))
    , m_rest(static_cast<std::size_t>(m_side) * m_side * std::size(levels), 1.0f)
    , m_open(static_cast<std::size_t>(m_side) * m_side)
    , m_at(m_open.size())
  {
    constexpr double usual_noise = 0.7; // the strongest in a column, measured
    const double enough = (HeapCloud::threshold + CloudOptions::thinnest / o.crispness) /
                          (0.8 * usual_noise + o.offset);
    m_enough = static_cast<float>(1.0 - std::min(enough, 1.0));
    for (std::size_t n = 0; n < m_open.size(); ++n)
    {
      m_open[n] = m_at[n] = static_cast<std::uint32_t>(n);
    }
  }

  std::size_t places() const { return m_at.size(); }
  std::size_t open() const { return m_open.size(); }

  /// The open place of this number.
  glm::dvec2 open_place(std::size_t n) const
  {
    return { this->coordinate(m_open[n] % m_side), this->coordinate(m_open[n] / m_side) };
  }

  /// Takes it that the open place of this number is under cloud.
  void close(std::size_t n)
  {
    const std::uint32_t place = m_open[n];
    m_open[n] = m_open.back();
    m_at[m_open[n]] = static_cast<std::uint32_t>(n);
    m_open.pop_back();
    m_at[place] = closed;
  }

  void add(const Puff& puff)
  {
    const int first[2] = { this->index(puff.centre.x - puff.radii.x),
      this->index(puff.centre.y - puff.radii.y) };
    const int last[2] = { this->index(puff.centre.x + puff.radii.x),
      this->index(puff.centre.y + puff.radii.y) };
    const auto square = [](double d) { return d * d; };
    for (int j = first[1]; j <= last[1]; ++j)
    {
      const double y = square((this->coordinate(j) - puff.centre.y) / puff.radii.y);
      for (int i = first[0]; i <= last[0]; ++i)
      {
        const double xy = y + square((this->coordinate(i) - puff.centre.x) / puff.radii.x);
        const std::size_t place = static_cast<std::size_t>(j) * m_side + i;
        if (xy >= 1.0 || m_at[place] == closed)
        {
          continue;
        }
        float* rest = &m_rest[place * std::size(levels)];
        bool covered = false;
        for (std::size_t level = 0; level < std::size(levels); ++level)
        {
          const double z = m_base + levels[level] * m_height;
          const double f = 1.0 - xy - square((z - puff.centre.z) / puff.radii.z);
          if (f > 0.0)
          {
            rest[level] *= static_cast<float>(1.0 - f * f);
            covered = covered || rest[level] < m_enough;
          }
        }
        if (covered)
        {
          this->close(m_at[place]);
        }
      }
    }
  }

private:
  /// In heights of the clouds above their base: closer below, where the small ones are.
  static constexpr double levels[] = { 0.05, 0.09, 0.14, 0.2, 0.27, 0.35, 0.45, 0.58, 0.72, 0.88 };
  static constexpr std::uint32_t closed = 0xffffffffu;

  double coordinate(int n) const { return ((n + 0.5) / m_side - 0.5) * 2.0 * m_room; }
  int index(double x) const
  {
    return std::clamp(static_cast<int>((x / (2.0 * m_room) + 0.5) * m_side), 0, m_side - 1);
  }

  double m_room;
  double m_base;
  double m_height;
  int m_side;
  float m_enough;                    ///< one less the heap that is enough
  std::vector<float> m_rest;         ///< one less the heap, at each level of each place
  std::vector<std::uint32_t> m_open; ///< places that are not under cloud, in no order
  std::vector<std::uint32_t> m_at;   ///< where among these each place stands, or `closed`
};

}

void add_buds(std::vector<Puff>& puffs, const Puff& parent, int generations, RandomSequence& random)
{
  puffs.push_back(parent);
  if (generations == 0)
  {
    return;
  }
  const int count = generations == 2 ? 7 : 6;
  for (int b = 0; b < count; ++b)
  {
    const glm::dvec3 direction = upward_direction(random);
    const glm::dvec3 centre = parent.centre + direction * parent.radii * random.between(0.62, 0.8);
    const Puff bud{ centre, parent.radii * random.between(0.42, 0.58) };
    add_buds(puffs, bud, generations - 1, random);
  }
}

std::vector<Puff> pile_cumulus_field(const CloudOptions& o, double border)
{
  std::vector<Puff> puffs;
  RandomSequence random(substream(o.seed, 106));
  const double base = o.base / o.width;
  const double height = (o.top - o.base) / o.width;
  const double room = 0.5 - border;

  // What is under cloud is counted, so that overlaps count once, and each cloud stands where there
  // is none yet. Each closes its own place at least, so this ends.
  Ground ground(o, room);
  const auto left = static_cast<std::size_t>((1.0 - o.coverage) * ground.places() + 0.5);
  while (ground.open() > left)
  {
    // Few large clouds and many small ones; the last ones no larger than what is missing, by the
    // ground that a cloud of size 1 takes, in squares of its height (measured).
    constexpr double usual_area = 1.2;
    const double missing = 4.0 * room * room * double(ground.open() - left) / ground.places();
    const double u = random.next();
    const double size =
      std::clamp(std::sqrt(missing / usual_area) / height, 0.1, 0.25 + 0.75 * u * u * u);
    const double reach = std::min(0.75 * size * height, room);
    const auto n = static_cast<std::size_t>(random.next() * ground.open());
    const glm::dvec2 centre =
      glm::clamp(ground.open_place(n), glm::dvec2(reach - room), glm::dvec2(room - reach));
    ground.close(n);
    const std::size_t first = puffs.size();
    const int towers = 2 + static_cast<int>(size * 5.0);
    for (int t = 0; t < towers; ++t)
    {
      double x = centre.x + (t == 0 ? 0.0 : 0.75 * reach * random.between(-1.0, 1.0));
      double y = centre.y + (t == 0 ? 0.0 : 0.75 * reach * random.between(-1.0, 1.0));
      const double top = size * height * (t == 0 ? 0.75 : random.between(0.1, 0.5));
      double radius = size * height * (t == 0 ? 0.36 : random.between(0.22, 0.34));
      for (double z = base + 0.1 * radius; z <= base + top; z += 0.8 * radius)
      {
        add_buds(puffs, { { x, y, z }, glm::dvec3(radius) }, size > 0.5 ? 2 : 1, random);
        radius *= random.between(0.84, 0.94);
        x += radius * random.between(-0.25, 0.25);
        y += radius * random.between(-0.25, 0.25);
      }
    }
    for (std::size_t p = first; p < puffs.size(); ++p)
    {
      draw_in(puffs[p], room);
      ground.add(puffs[p]);
    }
    if (puffs.size() > most_puffs)
    {
      throw std::invalid_argument("cloud: the field is too wide for so many clouds: make it "
                                  "narrower, higher or less covered");
    }
  }
  return puffs;
}

std::vector<Puff> pile_cumulonimbus(const CloudOptions& o)
{
  std::vector<Puff> puffs;
  RandomSequence random(substream(o.seed, 107));
  const double base = o.base / o.width;
  const double height = (o.top - o.base) / o.width;
  const double speed = std::sqrt(o.wind.x * o.wind.x + o.wind.y * o.wind.y);
  const glm::dvec2 downwind =
    speed > 0.0 ? glm::dvec2(o.wind.x / speed, o.wind.y / speed) : glm::dvec2(1.0, 0.0);
  const glm::dvec2 across(-downwind.y, downwind.x);
  // The tower stands upwind of the middle, for the anvil goes downwind.
  const glm::dvec2 foot = downwind * -0.12;

  const auto place = [&](const glm::dvec2& at, double up)
  { return glm::dvec3(at.x, at.y, base + up * height); };

  // The main tower leans a little downwind; it flares at its foot and under the anvil.
  for (double up = 0.04; up < 0.86; up += 0.07)
  {
    const double lean = 0.09 * up * up;
    const double radius =
      (0.125 + 0.09 * (up - 0.45) * (up - 0.45) + 0.05 * std::max(0.0, up - 0.65)) *
      random.between(0.9, 1.15);
    const glm::dvec2 shift(random.between(-0.04, 0.04), random.between(-0.04, 0.04));
    const Puff core{ place(foot + downwind * lean + shift, up), glm::dvec3(radius) };
    add_buds(puffs, core, 2, random);
  }
  // Younger towers along its upwind flank, the farther the lower.
  for (int t = 0; t < 6; ++t)
  {
    const double far = 0.10 + 0.035 * t;
    const glm::dvec2 at = foot - downwind * far * 0.8 +
                          across * ((t % 2 == 0 ? 1.0 : -1.0) * random.between(0.04, 0.17));
    const double top = random.between(0.5, 0.75) * std::max(0.1, 0.62 - 0.09 * t);
    double radius = random.between(0.085, 0.115) - 0.005 * t;
    for (double up = 0.03; up < top; up += 0.85 * radius / height)
    {
      add_buds(puffs, { place(at, up), glm::dvec3(radius) }, 2, random);
      radius *= random.between(0.86, 0.95);
    }
  }
  // The anvil: flat puffs near one level, spread downwind, thinner and ever smaller the farther; it
  // begins under the tropopause, where what rises stops.
  for (int n = 0; n < 130; ++n)
  {
    const double t = random.next();
    const double far = -0.2 + 0.62 * t;
    const double wide = 0.34 * (1.0 - 0.4 * t) * random.between(-1.0, 1.0);
    const double thin = (0.05 - 0.032 * t) * random.between(0.6, 1.2);
    const double radius = random.between(0.05, 0.15) * (1.0 - 0.35 * t);
    const glm::dvec2 at = foot + downwind * (0.06 + far) + across * wide;
    const double up = 0.87 - 0.05 * random.next() * (1.0 - t) + 0.02 * random.next();
    puffs.push_back({ place(at, up), { radius * 1.5, radius, thin } });
  }
  // What overshoots: a low dome over the tower.
  add_buds(puffs, { place(foot + downwind * 0.075, 0.87), { 0.1, 0.1, 0.07 * height } }, 1, random);
  for (Puff& puff : puffs)
  {
    draw_in(puff, 0.5 - HeapCloud::usual_fade);
  }
  return puffs;
}

}
