#include "data-generators/piles.h"

#include "data-generators/heap_cloud.h"

#include <algorithm>
#include <cmath>
#include <glm/vec2.hpp>

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

/// What reaches past the room that the box's border leaves is drawn in.
void draw_in(std::vector<Puff>& puffs)
{
  const double room = 0.5 - HeapCloud::border_fade;
  for (Puff& p : puffs)
  {
    for (int a = 0; a < 2; ++a)
    {
      p.radii[a] = std::min(p.radii[a], room);
      p.centre[a] = std::clamp(p.centre[a], p.radii[a] - room, room - p.radii[a]);
    }
  }
}

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

std::vector<Puff> pile_cumulus_field(const CloudOptions& o)
{
  std::vector<Puff> puffs;
  RandomSequence random(substream(o.seed, 106));
  const double base = o.base / o.width;
  const double height = (o.top - o.base) / o.width;
  const double room = 0.5 - HeapCloud::border_fade;

  // The ground under cloud is counted on a grid, so that overlaps count once, and each cloud stands
  // where there is none yet.
  constexpr int side = 128;
  std::vector<char> covered(side * side, 0);
  const auto coordinate = [](int n) { return (n + 0.5) / side - 0.5; };
  std::vector<int> open;
  for (int n = 0; n < side * side; ++n)
  {
    if (std::max(std::fabs(coordinate(n % side)), std::fabs(coordinate(n / side))) < room)
    {
      open.push_back(n);
    }
  }
  const std::size_t left = static_cast<std::size_t>((1.0 - o.coverage) * open.size() + 0.5);
  const auto cover = [&](double x, double y, double radius)
  {
    const auto first = [&](double c)
    { return std::clamp(static_cast<int>((c - radius + 0.5) * side), 0, side - 1); };
    const auto last = [&](double c)
    { return std::clamp(static_cast<int>((c + radius + 0.5) * side), 0, side - 1); };
    for (int j = first(y); j <= last(y); ++j)
    {
      for (int i = first(x); i <= last(x); ++i)
      {
        const double dx = coordinate(i) - x, dy = coordinate(j) - y;
        if (dx * dx + dy * dy < radius * radius)
        {
          covered[j * side + i] = 1;
        }
      }
    }
  };
  for (int cloud = 0; cloud < 1000 && open.size() > left; ++cloud)
  {
    // Few large clouds and many small ones.
    const double u = random.next();
    const double size = 0.25 + 0.75 * u * u * u;
    const double reach = std::min(0.75 * size * height, room);
    const int n = open[static_cast<std::size_t>(random.next() * open.size())];
    const glm::dvec2 centre(std::clamp(coordinate(n % side), reach - room, room - reach),
      std::clamp(coordinate(n / side), reach - room, room - reach));
    covered[n] = 1;
    const int towers = 2 + static_cast<int>(size * 5.0);
    for (int t = 0; t < towers; ++t)
    {
      double x = centre.x + (t == 0 ? 0.0 : 0.75 * reach * random.between(-1.0, 1.0));
      double y = centre.y + (t == 0 ? 0.0 : 0.75 * reach * random.between(-1.0, 1.0));
      const double top = size * height * (t == 0 ? 0.75 : random.between(0.1, 0.5));
      double radius = size * height * (t == 0 ? 0.36 : random.between(0.22, 0.34));
      for (double z = base + 0.1 * radius; z <= base + top; z += 0.8 * radius)
      {
        const Puff puff{ { x, y, z }, glm::dvec3(radius) };
        add_buds(puffs, puff, size > 0.5 ? 2 : 1, random);
        cover(x, y, radius);
        radius *= random.between(0.84, 0.94);
        x += radius * random.between(-0.25, 0.25);
        y += radius * random.between(-0.25, 0.25);
      }
    }
    open.erase(std::remove_if(open.begin(), open.end(), [&](int at) { return covered[at] != 0; }),
      open.end());
  }
  draw_in(puffs);
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
  draw_in(puffs);
  return puffs;
}

}
