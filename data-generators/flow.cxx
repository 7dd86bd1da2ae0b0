#include "data-generators/flow.h"

#include "data-generators/portable_math.h"
#include "data-generators/random.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>

namespace brume
{

namespace
{

/// A direction from two numbers in [0, 1).
glm::dvec3 direction(double u, double v)
{
  const double z = 2.0 * u - 1.0;
  const double r = std::sqrt(1.0 - z * z);
  const SineCosine turn = portable_sincos(2.0 * pi * v);
  return { r * turn.cosine, r * turn.sine, z };
}

}

Flow::Flow(const FlowOptions& options)
  : m_wind(options.wind)
{
  if (!std::isfinite(options.wind.x + options.wind.y + options.wind.z))
  {
    throw std::invalid_argument("flow: the wind must be finite");
  }
  if (!(options.turbulence >= 0.0) || !std::isfinite(options.turbulence) ||
      !(options.eddy_size > 0.0) || !std::isfinite(options.eddy_size))
  {
    throw std::invalid_argument(
      "flow: the turbulence must not be below 0, the size of eddies above 0");
  }
  constexpr int modes_an_octave = 4;
  // k^(-1/3) for k = 1, 2, 4.
  constexpr double weights[3] = { 1.0, 0.7937005259840998, 0.6299605249474366 };
  double squares = 0.0;
  for (const double w : weights)
  {
    squares += modes_an_octave * 0.5 * w * w;
  }
  for (int n = 0; n < 3 * modes_an_octave && options.turbulence > 0.0; ++n)
  {
    const std::uint32_t key = substream(options.seed, 80 + n);
    const auto number = [&](std::uint32_t i) { return double(unit_float(mix_bits(key + i))); };
    const int octave = n / modes_an_octave;
    const double k = pi / options.eddy_size * (1 << octave);
    const double speed = options.turbulence * weights[octave] / std::sqrt(squares);
    const glm::dvec3 along = direction(number(0), number(1));
    // Some direction that is not along; what is left of it across.
    glm::dvec3 across = direction(number(2), number(3));
    across -= glm::dot(across, along) * along;
    if (glm::dot(across, across) < 1e-6)
    {
      across = std::fabs(along.z) < 0.5 ? glm::dvec3(along.y, -along.x, 0.0)
                                        : glm::dvec3(0.0, along.z, -along.y);
    }
    m_modes.push_back(
      { k * along, speed * glm::normalize(across), speed * k, 2.0 * pi * number(4) });
  }
}

glm::dvec3 Flow::velocity(const glm::dvec3& place, double time) const
{
  glm::dvec3 sum = m_wind;
  for (const Mode& m : m_modes)
  {
    sum +=
      m.amplitude * portable_sincos(glm::dot(m.wave, place) - m.frequency * time + m.phase).cosine;
  }
  return sum;
}

}
