#include "controls.h"

#include "phase_words.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>

namespace brume::app
{

namespace
{

/// Right-handed axes with `up`: east for azimuth 0, north for 90 degrees.
void horizon(const Triple& up, glm::dvec3& east, glm::dvec3& north, glm::dvec3& zenith)
{
  zenith = glm::normalize(glm::dvec3(up[0], up[1], up[2]));
  // As near to x as may be.
  const glm::dvec3 side = std::abs(zenith.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  east = glm::normalize(side - glm::dot(side, zenith) * zenith);
  north = glm::cross(zenith, east);
}

double degrees(double radians)
{
  return radians * 180.0 / pi;
}

}

double place_of(const Control& control, const ControlScene& scene, double value)
{
  double lower = control.lower(scene);
  double upper = control.upper(scene);
  if (control.scale == ControlScale::Logarithmic)
  {
    lower = std::log(lower);
    upper = std::log(upper);
    value = std::log(value);
  }
  return std::clamp((value - lower) / (upper - lower), 0.0, 1.0);
}

double value_at(const Control& control, const ControlScene& scene, double place)
{
  place = std::clamp(place, 0.0, 1.0);
  const double lower = control.lower(scene);
  const double upper = control.upper(scene);
  if (control.scale == ControlScale::Logarithmic)
  {
    return lower * std::pow(upper / lower, place);
  }
  const double value = lower + place * (upper - lower);
  return control.scale == ControlScale::Whole ? std::round(value) : value;
}

Triple tinted(const Control& control, const ControlScene& scene, double hue, double saturation)
{
  const std::optional<double> value = control.get(scene);
  const double brightness =
    value && *value > 0.0 ? *value : value_at(control, scene, control.first);
  return colour_of({ hue, saturation, brightness });
}

std::vector<LobeChoice> lobes_of(const MediumOptions& medium)
{
  if (!medium.lobes.empty())
  {
    return medium.lobes;
  }
  std::string wrong; // the parse of the scene has refused what is
  std::vector<LobeChoice> lobes;
  if (!medium.phase.empty())
  {
    lobes = read_lobes(medium.phase, wrong);
  }
  if (lobes.empty())
  {
    lobes.push_back({ LobeChoice::Function::HenyeyGreenstein, 1.0, medium.anisotropy });
  }
  return lobes;
}

std::optional<SunAngles> sun_angles(const MediumOptions& medium)
{
  return medium.sun_direction
           ? std::optional<SunAngles>(sun_angles(*medium.sun_direction, medium.up))
           : std::nullopt;
}

SunAngles sun_angles(const Triple& direction, const Triple& up)
{
  glm::dvec3 east, north, zenith;
  horizon(up, east, north, zenith);
  const glm::dvec3 sun = glm::normalize(glm::dvec3(direction[0], direction[1], direction[2]));
  return { degrees(std::atan2(glm::dot(sun, north), glm::dot(sun, east))),
    degrees(std::asin(std::clamp(glm::dot(sun, zenith), -1.0, 1.0))) };
}

Triple sun_direction(const SunAngles& angles, const Triple& up)
{
  glm::dvec3 east, north, zenith;
  horizon(up, east, north, zenith);
  const double azimuth = angles.azimuth * pi / 180.0;
  // A hair off the zenith, so that the azimuth is not lost there.
  const double elevation = std::clamp(angles.elevation, -89.9, 89.9) * pi / 180.0;
  const glm::dvec3 d =
    std::cos(elevation) * (std::cos(azimuth) * east + std::sin(azimuth) * north) +
    std::sin(elevation) * zenith;
  return { d.x, d.y, d.z };
}

}
