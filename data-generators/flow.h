// A turbulent wind as a function of place and time, in closed form.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

namespace brume
{

/// What wind it is. Lengths in metres, times in seconds.
struct FlowOptions
{
  std::uint32_t seed = 1;
  /// The steady wind, metres a second. Finite.
  glm::dvec3 wind{ 0.0 };
  /// Speed of the eddies, metres a second, root mean square over place and time. Not below 0.
  double turbulence = 0.8;
  /// Size of the largest eddies, metres: half a wavelength. Above 0.
  double eddy_size = 1.0;
};

/// The velocity
///   u(x, t) = wind + sum over modes of a_m cos(k_m . x - w_m t + phase_m),
/// with 12 modes in 3 octaves: directions of k_m and phases at random, |k| = pi/eddy_size times 1,
/// 2 and 4, a_m at right angles to k_m, so that no mode has a divergence; |a| as k^(-1/3) and w =
/// |a| |k|, as in Kolmogorov's cascade; the sum's mean square is turbulence^2. Kraichnan,
/// "Diffusion by a random velocity field", Physics of Fluids 13 (1970). Same bits on every machine.
class Flow
{
public:
  /// Throws std::invalid_argument for options out of their range.
  explicit Flow(const FlowOptions& options = {});

  glm::dvec3 velocity(const glm::dvec3& place, double time) const;

private:
  struct Mode
  {
    glm::dvec3 wave, amplitude;
    double frequency, phase;
  };
  glm::dvec3 m_wind;
  std::vector<Mode> m_modes;
};

}
