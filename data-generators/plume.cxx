#include "data-generators/plume.h"

#include "data-generators/noise.h"
#include "data-generators/random.h"
#include "data-generators/shaping.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace brume
{

namespace
{

// In widths of the box.
constexpr double box_height = 2.0;
constexpr double source_radius = 0.05;
constexpr double widening = 0.13;
constexpr double meander_size = 0.6;   ///< of the bends of the axis
constexpr double meander_reach = 0.12; ///< of the axis, a unit of height
constexpr double eddy_size = 0.22;
constexpr double detail_size = 0.11;
constexpr double largest_warp = 0.1; ///< of the turbulence, once it is stirred
constexpr double stirred_from = 0.5; ///< from this height on it is
constexpr double empty_border = 0.02;
constexpr double border_fade = 0.08;

}

Plume::Plume(const PlumeOptions& options)
  : m_options(options)
{
  const auto require = [](bool holds, const char* what)
  {
    if (!holds)
    {
      throw std::invalid_argument(std::string("plume: ") + what);
    }
  };
  require(options.width > 0.0 && std::isfinite(options.width), "the width must be above 0");
  require(std::isfinite(options.rise), "the rise must be finite");
  require(options.air_temperature > 0.0 && options.air_temperature <= options.source_temperature &&
            std::isfinite(options.source_temperature),
    "the air's temperature must be above 0 and not above the source's");
}

Box Plume::bounds() const
{
  const double half = 0.5 * m_options.width;
  return { { -half, -half, 0.0 }, { half, half, box_height * m_options.width } };
}

float Plume::value(const glm::dvec3& place, double time) const
{
  return this->at(place, time).density;
}

FieldRange Plume::range_in(const Box& box, double) const
{
  const Box p{ box.lower / m_options.width, box.upper / m_options.width };
  const FieldRange air{ 0.0f, 0.0f };
  // The nearest to the axis that a place of the box is, level, before the warp and the bends move
  // it; both grow with the height, and so does the radius.
  double square = 0.0;
  const double top = std::clamp(p.upper.z, 0.0, box_height);
  const double moved =
    largest_warp * smooth_ramp(top, 0.0, stirred_from) + meander_reach * top + 1e-6;
  for (int axis = 0; axis < 2; ++axis)
  {
    if (p.lower[axis] > 0.5 - empty_border || p.upper[axis] < empty_border - 0.5)
    {
      return air;
    }
    const double from_axis = std::max({ p.lower[axis], -p.upper[axis], 0.0 });
    const double nearest = std::max(from_axis - moved, 0.0);
    square += nearest * nearest;
  }
  const double radius = source_radius + widening * top;
  if (p.upper.z < empty_border || p.lower.z > box_height - empty_border || square > radius * radius)
  {
    return air;
  }
  return { 0.0f, 1.0f };
}

FieldRange PlumeTemperature::range_in(const Box& box, double time) const
{
  const PlumeOptions& o = m_plume->options();
  const auto air = static_cast<float>(o.air_temperature);
  return { air,
    m_plume->range_in(box, time).upper == 0.0f ? air : static_cast<float>(o.source_temperature) };
}

Plume::State Plume::at(const glm::dvec3& place, double time) const
{
  const PlumeOptions& o = m_options;
  const State air{ 0.0f, static_cast<float>(o.air_temperature) };
  const glm::dvec3 p = place / o.width;
  const double inside =
    std::min({ 0.5 - std::fabs(p.x), 0.5 - std::fabs(p.y), p.z, box_height - p.z });
  if (!std::isfinite(p.x + p.y + p.z) || !(inside > empty_border))
  {
    return air;
  }
  const glm::dvec3 drift(0.0, 0.0, std::isfinite(time) ? o.rise * time / o.width : 0.0);

  // The turbulence grows from nothing at the source.
  const double stirred = smooth_ramp(p.z, 0.0, stirred_from);
  const glm::dvec3 warped =
    warp(p - drift, eddy_size, largest_warp * stirred, substream(o.seed, 11)) + drift;

  const glm::dvec3 bend(0.0, 0.0, (p.z - drift.z) / meander_size);
  const double reach = meander_reach * p.z;
  const double x = warped.x - reach * perlin_noise(bend, substream(o.seed, 12));
  const double y = warped.y - reach * perlin_noise(bend, substream(o.seed, 13));
  const double radius = source_radius + widening * p.z;
  const double f = 1.0 - (x * x + y * y) / (radius * radius);
  if (f <= 0.0)
  {
    return air;
  }

  const glm::dvec3 q = (warped - drift) / detail_size;
  const double billows = billow_fbm(q, substream(o.seed, 14), { 4, 2.0, 0.5 });
  const double gradient = 0.5 + 0.5 * fbm(q, substream(o.seed, 15), { 5, 2.0, 0.5 });
  const double noise = remap(0.5 * (billows + gradient), 0.33, 0.63, 0.0, 1.0);

  const double thinning = source_radius / radius;
  const double border = smooth_ramp(inside, empty_border, border_fade);
  const double top = smooth_ramp(p.z, 1.95, 1.3);
  const double density = thinning * saturate(5.0 * (f * (0.8 * noise + 0.12) - 0.2)) * border * top;
  const double heat =
    saturate(1.7 * thinning) * saturate(2.0 * f) * (0.4 + 0.6 * noise) * border * top;
  return { static_cast<float>(density),
    static_cast<float>(o.air_temperature + (o.source_temperature - o.air_temperature) * heat) };
}

}
