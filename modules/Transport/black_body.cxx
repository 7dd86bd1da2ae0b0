#include "Transport/black_body.h"

#include <glm/common.hpp>
#include <glm/mat3x3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace brume
{

namespace
{

constexpr int first_nanometre = 360;
constexpr int last_nanometre = 830;

/// A Gaussian lobe, wider on one side than on the other.
double lobe(double nanometres, double middle, double below, double above)
{
  const double t = (nanometres - middle) / (nanometres < middle ? below : above);
  return std::exp(-0.5 * t * t);
}

glm::dvec3 matching_functions(double l)
{
  return { 1.056 * lobe(l, 599.8, 37.9, 31.0) + 0.362 * lobe(l, 442.0, 16.0, 26.7) -
             0.065 * lobe(l, 501.1, 20.4, 26.2),
    0.821 * lobe(l, 568.8, 46.9, 40.5) + 0.286 * lobe(l, 530.9, 16.3, 31.1),
    1.217 * lobe(l, 437.0, 11.8, 36.0) + 0.681 * lobe(l, 459.0, 26.0, 13.8) };
}

/// Of each nanometre: h c / k λ in kelvin, and what the matching functions make of the rest of
/// Planck's law, 2 h c² / λ⁵ · 1 nm.
struct Line
{
  double kelvin;
  glm::dvec3 weight;
};

std::array<Line, last_nanometre - first_nanometre + 1> make_lines()
{
  // Exact since the SI of 2019.
  constexpr double planck = 6.62607015e-34;
  constexpr double speed = 299792458.0;
  constexpr double boltzmann = 1.380649e-23;
  std::array<Line, last_nanometre - first_nanometre + 1> lines;
  for (int nanometres = first_nanometre; nanometres <= last_nanometre; ++nanometres)
  {
    const double metres = nanometres * 1e-9;
    Line& line = lines[nanometres - first_nanometre];
    line.kelvin = planck * speed / (boltzmann * metres);
    line.weight = matching_functions(nanometres) *
                  (2.0 * planck * speed * speed / std::pow(metres, 5.0) * 1e-9);
  }
  return lines;
}

void check_reference(double reference)
{
  if (!(reference >= coldest_black_body_reference && reference <= hottest_black_body))
  {
    throw std::invalid_argument(
      "a black body's reference temperature must be from 800 to 100000 kelvin");
  }
}

/// Not in units of anything yet.
glm::dvec3 rgb(double temperature)
{
  const glm::dmat3 from_xyz = glm::transpose(glm::dmat3( // IEC 61966-2-1
    3.2406,
    -1.5372,
    -0.4986,
    -0.9689,
    1.8758,
    0.0415,
    0.0557,
    -0.2040,
    1.0570));
  return glm::max(from_xyz * black_body_xyz(temperature), 0.0);
}

}

glm::dvec3 black_body_xyz(double temperature)
{
  static const auto lines = make_lines();
  const double kelvin = std::min(temperature, hottest_black_body);
  glm::dvec3 sum(0.0);
  if (!(kelvin > 0.0))
  {
    return sum;
  }
  // The trapezoidal rule; at its ends the functions are as good as 0.
  for (const Line& line : lines)
  {
    sum += line.weight / std::expm1(line.kelvin / kelvin);
  }
  return sum;
}

glm::dvec3 black_body_radiance(double temperature, double reference)
{
  check_reference(reference);
  return rgb(temperature) / black_body_xyz(reference).y;
}

BlackBodyTable make_black_body_table(double hottest, double reference)
{
  check_reference(reference);
  const double unit = 1.0 / black_body_xyz(reference).y;
  const double top = hottest > 0.0 ? std::min(hottest, hottest_black_body) : hottest_black_body;
  BlackBodyTable table;
  int intervals = BlackBodyTable::least_intervals;
  std::vector<glm::dvec3> nodes;
  for (int i = 0; i <= intervals; ++i)
  {
    nodes.push_back(rgb(top * i / intervals) * unit);
  }
  // Middles are looked at, and become nodes where they are needed.
  while (intervals < BlackBodyTable::most_intervals)
  {
    const glm::dvec3 largest = nodes.back();
    const double most = std::max({ largest.x, largest.y, largest.z });
    std::vector<glm::dvec3> finer{ nodes.front() };
    bool close = true;
    for (int i = 0; i < intervals; ++i)
    {
      const glm::dvec3 middle = rgb(top * (i + 0.5) / intervals) * unit;
      for (int c = 0; c < 3; ++c)
      {
        const double off = std::abs(0.5 * (nodes[i][c] + nodes[i + 1][c]) - middle[c]);
        close = close && off <= 1e-4 * middle[c] + 1e-6 * most;
      }
      finer.push_back(middle);
      finer.push_back(nodes[i + 1]);
    }
    if (close)
    {
      break;
    }
    nodes = std::move(finer);
    intervals *= 2;
  }
  nodes.push_back(nodes.back());
  table.intervals = intervals;
  table.scale = static_cast<float>(intervals / top);
  for (const glm::dvec3& node : nodes)
  {
    table.nodes.push_back(
      { static_cast<float>(node.x), static_cast<float>(node.y), static_cast<float>(node.z) });
    table.brightest = std::max({ table.brightest,
      table.nodes.back().red,
      table.nodes.back().green,
      table.nodes.back().blue });
  }
  return table;
}

}
