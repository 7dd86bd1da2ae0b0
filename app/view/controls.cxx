#include "controls.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>

namespace brume::app
{

namespace
{

using nlohmann::ordered_json;

template <int Numerator, int Denominator = 1>
double constant(const ControlScene&)
{
  return double(Numerator) / Denominator;
}

double largest(const Triple& v)
{
  return std::max({ v[0], v[1], v[2] });
}

std::string always(const ControlScene&)
{
  return {};
}

std::string of_densities(const ControlScene& scene)
{
  return scene.options->density() ? "" : "the values are classified, not a density";
}

std::string of_classified(const ControlScene& scene)
{
  return scene.options->density() ? "the values are a density: turn the extinction" : "";
}

std::string of_composite(const ControlScene& scene)
{
  return scene.options->modes.blend_mode == "composite" ? "" : "light in matter is composite mode's";
}

/// A colour of the scene's keys with another largest channel.
void scale_colour(ordered_json& scene, const char* key, const Triple& now, double value)
{
  const double most = largest(now);
  if (most <= 0.0 || (now[0] == now[1] && now[0] == now[2]))
  {
    scene[key] = { value, value, value };
    return;
  }
  scene[key] = { now[0] / most * value, now[1] / most * value, now[2] / most * value };
}

void set_sun(ordered_json& scene, const ControlScene& s, const SunAngles& angles)
{
  const Triple d = sun_direction(angles, s.options->medium.up);
  scene["sun-direction"] = { d[0], d[1], d[2] };
}

SunAngles sun_of(const ControlScene& s)
{
  return sun_angles(s.options->medium).value_or(s.first_sun);
}

std::optional<double> positive(double value)
{
  return value > 0.0 ? std::optional<double>(value) : std::nullopt;
}

/// Sets a key, or takes it out at 0, which is "off".
void set_or_erase(ordered_json& scene, const char* key, double value)
{
  if (value > 0.0)
  {
    scene[key] = value;
  }
  else
  {
    scene.erase(key);
  }
}

std::vector<Control> make_controls()
{
  using S = const ControlScene&;
  using J = ordered_json&;
  constexpr auto light = ControlPage::Light;
  constexpr auto matter = ControlPage::Matter;
  constexpr auto look = ControlPage::Look;
  constexpr auto linear = ControlScale::Linear;
  constexpr auto logarithmic = ControlScale::Logarithmic;
  return {
    { "sun azimuth", "sun-direction", "deg", light, linear, "Left", "Right", constant<-180>, constant<180>,
      [](S s)
      {
        const auto sun = sun_angles(s.options->medium);
        return sun ? std::optional<double>(sun->azimuth) : std::nullopt;
      },
      [](J j, S s, double v) { set_sun(j, s, { v, sun_of(s).elevation }); }, of_composite },
    { "sun elevation", "sun-direction", "deg", light, linear, "Down", "Up", constant<-90>, constant<90>,
      [](S s)
      {
        const auto sun = sun_angles(s.options->medium);
        return sun ? std::optional<double>(sun->elevation) : std::nullopt;
      },
      [](J j, S s, double v) { set_sun(j, s, { sun_of(s).azimuth, v }); }, of_composite },
    { "sun irradiance", "sun-irradiance", "", light, linear, "", "", constant<0>, constant<20>,
      [](S s)
      {
        return s.options->medium.sun_direction
          ? std::optional<double>(largest(s.options->medium.sun_irradiance))
          : std::nullopt;
      },
      [](J j, S s, double v)
      {
        scale_colour(j, "sun-irradiance", s.options->medium.sun_irradiance, v);
        if (!s.options->medium.sun_direction)
        {
          set_sun(j, s, s.first_sun);
        }
      },
      of_composite },
    { "sky radiance", "sky-radiance", "", light, linear, "", "", constant<0>, constant<2>,
      [](S s) { return positive(largest(s.options->medium.sky_radiance)); },
      [](J j, S s, double v)
      {
        if (v > 0.0)
        {
          scale_colour(j, "sky-radiance", s.options->medium.sky_radiance, v);
        }
        else
        {
          j.erase("sky-radiance");
        }
      },
      of_composite },
    { "exposure", "exposure", "stops", light, linear, "minus", "plus", constant<-8>, constant<8>,
      [](S s) { return std::optional<double>(s.exposure); },
      [](J j, S, double v) { j["exposure"] = v; }, always },

    { "extinction", "extinction", "per unit length", matter, logarithmic, "bracketleft", "bracketright",
      [](S s) { return 1e-3 / s.size; }, [](S s) { return 1e5 / s.size; },
      [](S s) { return positive(largest(s.options->extinction)); },
      [](J j, S s, double v)
      {
        const Triple& now = s.options->extinction;
        if (now[0] == now[1] && now[0] == now[2])
        {
          j["extinction"] = v;
          return;
        }
        scale_colour(j, "extinction", now, v);
      },
      of_densities },
    { "opacity distance", "opacity-unit-distance", "length", matter, logarithmic, "bracketleft", "bracketright",
      [](S s) { return 1e-5 * s.size; }, [](S s) { return 10.0 * s.size; },
      [](S s) { return positive(s.opacity_unit_distance); },
      [](J j, S, double v) { j["opacity-unit-distance"] = v; }, of_classified },
    { "albedo", "albedo", "", matter, linear, "", "", constant<0>, constant<1>,
      [](S s)
      {
        return s.options->medium.has_medium()
          ? std::optional<double>(largest(s.options->medium.albedo))
          : std::nullopt;
      },
      [](J j, S s, double v)
      {
        const Triple& now = s.options->medium.albedo;
        if (now[0] == now[1] && now[0] == now[2])
        {
          j["albedo"] = v;
          return;
        }
        scale_colour(j, "albedo", now, v);
      },
      of_composite },
    { "anisotropy", "anisotropy", "", matter, linear, "g", "h", constant<-95, 100>, constant<95, 100>,
      [](S s)
      {
        const MediumOptions& m = s.options->medium;
        return m.has_medium() && m.phase.empty() && m.lobes.empty()
          ? std::optional<double>(m.anisotropy)
          : std::nullopt;
      },
      [](J j, S, double v)
      {
        j.erase("phase");
        j.erase("lobes");
        j["anisotropy"] = v;
      },
      of_composite },
    { "octaves", "octaves", "", matter, ControlScale::Whole, "comma", "period", constant<1>, constant<16>,
      [](S s)
      {
        return s.options->medium.has_medium() ? std::optional<double>(s.options->medium.octaves)
                                              : std::nullopt;
      },
      [](J j, S, double v) { j["octaves"] = v; }, of_composite },
    { "silver lining", "silver-lining", "", matter, linear, "", "", constant<0>, constant<4>,
      [](S s) { return s.options->medium.silver_lining; },
      [](J j, S, double v) { set_or_erase(j, "silver-lining", v); }, of_composite },
    { "powder", "powder", "", matter, linear, "", "", constant<0>, constant<1>,
      [](S s) { return s.options->medium.powder; },
      [](J j, S, double v) { set_or_erase(j, "powder", v); }, of_composite },

    { "tolerance", "tolerance", "of white", look, logarithmic, "less", "greater", constant<1, 2000>,
      constant<1, 10>, [](S s) { return std::optional<double>(s.options->tolerance); },
      [](J j, S, double v) { j["tolerance"] = v; }, always },
  };
}

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

const std::vector<Control>& controls()
{
  static const std::vector<Control> all = make_controls();
  return all;
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
  const glm::dvec3 d = std::cos(elevation) * (std::cos(azimuth) * east + std::sin(azimuth) * north) +
    std::sin(elevation) * zenith;
  return { d.x, d.y, d.z };
}

}
