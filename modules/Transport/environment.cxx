#include "Transport/environment.h"

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/vec2.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <stdexcept>
#include <utility>

namespace brume
{

namespace
{

constexpr double pi = glm::pi<double>();

/// Luminance of linear Rec. 709 primaries.
const glm::dvec3 luminance_weights(0.2126, 0.7152, 0.0722);

glm::dvec3 radiance(const EnvironmentMap& map, int x, int y)
{
  const float* pixel = &map.rgb[3 * (static_cast<std::size_t>(y) * map.width + x)];
  glm::dvec3 result;
  for (int c = 0; c < 3; ++c)
  {
    result[c] = std::isfinite(pixel[c]) ? std::max(0.0, static_cast<double>(pixel[c])) : 0.0;
  }
  return result;
}

/// Pixels from (x0, y0) to before (x1, y1), and their energy.
struct Part
{
  int x0, y0, x1, y1;
  double energy;

  bool whole() const { return this->x1 - this->x0 == 1 && this->y1 - this->y0 == 1; }
  bool operator<(const Part& other) const { return this->energy < other.energy; }
};

/// Sums of energy over rectangles in constant time.
class Energies
{
public:
  explicit Energies(const EnvironmentMap& map)
    : Width(map.width)
    , Sums(static_cast<std::size_t>(map.width + 1) * (map.height + 1), 0.0)
  {
    for (int y = 0; y < map.height; ++y)
    {
      const double solid_angle = environment_solid_angle(y, map.width, map.height);
      double row = 0.0;
      for (int x = 0; x < map.width; ++x)
      {
        row += glm::dot(radiance(map, x, y), luminance_weights) * solid_angle;
        this->at(x + 1, y + 1) = this->at(x + 1, y) + row;
      }
    }
  }
  double of(int x0, int y0, int x1, int y1)
  {
    return this->at(x1, y1) - this->at(x0, y1) - this->at(x1, y0) + this->at(x0, y0);
  }

private:
  double& at(int x, int y)
  {
    return this->Sums[static_cast<std::size_t>(y) * (this->Width + 1) + x];
  }

  int Width;
  std::vector<double> Sums;
};

}

glm::dvec3 environment_direction(double x, double y, int width, int height)
{
  const double longitude = 2.0 * pi * (x / width - 0.5);
  const double latitude = pi * (y / height - 0.5);
  return { std::cos(latitude) * std::sin(longitude),
    std::cos(latitude) * std::cos(longitude),
    std::sin(latitude) };
}

double environment_solid_angle(int row, int width, int height)
{
  // sin b − sin a as a product, which keeps its digits for rows that are thin.
  const double middle = pi * ((row + 0.5) / height - 0.5);
  return 2.0 * pi / width * 2.0 * std::cos(middle) * std::sin(0.5 * pi / height);
}

glm::dmat3 world_from_environment(const glm::dvec3& up, double degrees)
{
  const double across = up.x * up.x + up.y * up.y;
  // 1 + up.z without cancellation; up = −z is turned about x.
  const double sum = up.z >= 0.0 ? 1.0 + up.z : across / (1.0 - up.z);
  const glm::dmat3 raised =
    sum > 0.0
      ? glm::dmat3(glm::dvec3(1.0 - up.x * up.x / sum, -up.x * up.y / sum, -up.x),
          glm::dvec3(-up.x * up.y / sum, 1.0 - up.y * up.y / sum, -up.y),
          up)
      : glm::dmat3(
          glm::dvec3(1.0, 0.0, 0.0), glm::dvec3(0.0, -1.0, 0.0), glm::dvec3(0.0, 0.0, -1.0));
  const double angle = std::remainder(degrees, 360.0) * pi / 180.0;
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return raised *
         glm::dmat3(glm::dvec3(c, s, 0.0), glm::dvec3(-s, c, 0.0), glm::dvec3(0.0, 0.0, 1.0));
}

namespace
{

/// Cuts a part in two where their energies differ the least.
std::pair<Part, Part> cut(const Part& part, Energies& energies, const EnvironmentMap& map)
{
  const double latitude = pi * (0.5 * (part.y0 + part.y1) / map.height - 0.5);
  const double across = (part.x1 - part.x0) * 2.0 * pi / map.width * std::cos(latitude);
  const double upward = (part.y1 - part.y0) * pi / map.height;
  const bool along_x = part.y1 - part.y0 == 1 || (part.x1 - part.x0 > 1 && across >= upward);
  const int begin = along_x ? part.x0 : part.y0;
  const int end = along_x ? part.x1 : part.y1;
  int best = begin + 1;
  double least = std::numeric_limits<double>::infinity();
  for (int at = begin + 1; at < end; ++at)
  {
    const double first = along_x ? energies.of(part.x0, part.y0, at, part.y1)
                                 : energies.of(part.x0, part.y0, part.x1, at);
    const double off = std::abs(part.energy - 2.0 * first);
    if (off < least)
    {
      least = off;
      best = at;
    }
  }
  Part a = part;
  Part b = part;
  (along_x ? a.x1 : a.y1) = best;
  (along_x ? b.x0 : b.y0) = best;
  a.energy = energies.of(a.x0, a.y0, a.x1, a.y1);
  b.energy = energies.of(b.x0, b.y0, b.x1, b.y1);
  return { a, b };
}

/// The directions of a row's pixels for the latitude 0.
std::vector<glm::dvec2> directions_of_columns(const EnvironmentMap& map)
{
  std::vector<glm::dvec2> columns(map.width);
  for (int x = 0; x < map.width; ++x)
  {
    columns[x] =
      glm::dvec2(environment_direction(x + 0.5, 0.5 * map.height, map.width, map.height));
  }
  return columns;
}

/// A light with all that a part sends; none where it is dark.
void add_light(const Part& part,
  const EnvironmentMap& map,
  const std::vector<glm::dvec2>& columns,
  const glm::dmat3& world_from_environment,
  std::vector<Light>& lights)
{
  glm::dvec3 irradiance(0.0);
  glm::dvec3 middle(0.0);
  for (int y = part.y0; y < part.y1; ++y)
  {
    glm::dvec3 row(0.0);
    glm::dvec2 across(0.0);
    for (int x = part.x0; x < part.x1; ++x)
    {
      const glm::dvec3 pixel = radiance(map, x, y);
      row += pixel;
      across += glm::dot(pixel, luminance_weights) * columns[x];
    }
    const double solid_angle = environment_solid_angle(y, map.width, map.height);
    const double latitude = pi * ((y + 0.5) / map.height - 0.5);
    irradiance += solid_angle * row;
    middle += solid_angle * glm::dvec3(std::cos(latitude) * across,
                              std::sin(latitude) * glm::dot(row, luminance_weights));
  }
  if (irradiance == glm::dvec3(0.0))
  {
    return;
  }
  if (glm::length(middle) < 1e-9 * glm::dot(irradiance, luminance_weights))
  {
    // As much from each side as from the other: the part's own middle.
    middle = environment_direction(
      0.5 * (part.x0 + part.x1), 0.5 * (part.y0 + part.y1), map.width, map.height);
  }
  Light light;
  light.diffuse = irradiance / pi;
  light.specular = light.diffuse;
  light.direction = -glm::normalize(world_from_environment * middle);
  lights.push_back(light);
}

}

std::vector<Light> environment_lights(const EnvironmentMap& map,
  int count,
  const glm::dmat3& world_from_environment)
{
  if (map.width < 1 || map.height < 1 ||
      map.rgb.size() != 3 * static_cast<std::size_t>(map.width) * map.height)
  {
    throw std::invalid_argument("an environment map needs pixels of R, G and B");
  }
  if (count < 1)
  {
    throw std::invalid_argument("an environment map becomes one light at least");
  }
  Energies energies(map);
  const Part all{ 0, 0, map.width, map.height, energies.of(0, 0, map.width, map.height) };
  std::priority_queue<Part> parts;
  std::vector<Part> whole; // single pixels
  const auto keep = [&](const Part& part)
  {
    // Differences of sums are not 0 to the last bit where it is dark.
    if (part.energy > 1e-12 * all.energy)
    {
      part.whole() ? whole.push_back(part) : parts.push(part);
    }
  };
  keep(all);
  while (!parts.empty() && static_cast<int>(parts.size() + whole.size()) < count)
  {
    const Part part = parts.top();
    parts.pop();
    const auto [a, b] = cut(part, energies, map);
    keep(a);
    keep(b);
  }
  const std::vector<glm::dvec2> columns = directions_of_columns(map);
  std::vector<Light> lights;
  for (; !parts.empty(); parts.pop())
  {
    add_light(parts.top(), map, columns, world_from_environment, lights);
  }
  for (const Part& part : whole)
  {
    add_light(part, map, columns, world_from_environment, lights);
  }
  return lights;
}

}
