// The exponential integral that light from all around brings into layered matter.
// Theory: docs/theory/light.md.
#pragma once

namespace brume
{

/// E₂(x) = ∫₁^∞ e^(−x t) / t² dt = ∫₀¹ e^(−x/μ) dμ: the mean transmittance from a point inside a
/// slab to its surface, over the directions of a half sphere, x being the optical depth straight to
/// the surface. x ≥ 0, E₂(0) = 1; below 0 counts as 0, NaN gives NaN, +∞ gives 0. The relative
/// error is under 1e-14 up to x = 700, beyond which the result is about to underflow. Source: M.
/// Abramowitz, I. Stegun, Handbook of Mathematical Functions, 1964, 5.1.12 (the series) and 5.1.22
/// (the continued fraction).
double exponential_integral_2(double x);

}
