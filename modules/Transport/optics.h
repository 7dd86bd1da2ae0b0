// The formulas of optics in double precision. Theory and sources: docs/theory/optics.md.
//
// packet-inl.h has the one that packets of rays need, opacity_from_optical_depth, as the series that
// single precision allows; longer formulas are templates that serve both (shading-inl.h).
#pragma once

#include <algorithm>
#include <cmath>

namespace brume
{

/// The smallest transmittance that an opacity is taken to leave over its unit distance, so that an
/// opacity of 1 is a finite extinction (36.7 per unit distance).
constexpr double smallest_unit_transmittance = 1e-16;

/// Extinction coefficient σt = −ln(1 − α) / d of a material with opacity α over the distance d > 0,
/// in 1 / (unit of d). Opacities outside [0, 1] are clamped to it, NaN counts as 0.
/// From Beer and Lambert's law, 1 − α = exp(−σt d).
inline double extinction_from_opacity(double opacity, double distance)
{
  if (!(opacity > 0.0))
  {
    return 0.0;
  }
  const double most = 1.0 - smallest_unit_transmittance;
  return -std::log1p(-std::min(opacity, most)) / distance;
}

/// Opacity 1 − exp(−τ) of the optical depth τ ≥ 0, right to the last digits for small τ.
inline double opacity_from_optical_depth(double optical_depth)
{
  return -std::expm1(-optical_depth);
}

/// Transmittance exp(−τ).
inline double transmittance_from_optical_depth(double optical_depth)
{
  return std::exp(-optical_depth);
}

}
