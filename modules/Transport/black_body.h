// The colour and the brightness of what glows. Theory: docs/theory/light.md.
#pragma once

#include <glm/vec3.hpp>

#include <vector>

namespace brume
{

/// The temperatures that black bodies are drawn for, in kelvin. Hotter matter counts as the
/// hottest.
constexpr double hottest_black_body = 1e5;
/// The coldest that others may be measured by. Below, nothing is seen to glow (Draper's point, 798
/// K), and the fits of the matching functions know nothing of the far red that is left.
constexpr double coldest_black_body_reference = 800.0;

/// Planck's spectral radiance B_λ(T) = 2 h c² / λ⁵ / (e^(h c / λ k T) − 1) weighted with the CIE
/// 1931 colour matching functions x̄, ȳ, z̄ and integrated over 360 to 830 nm, in W sr⁻¹ m⁻²; 683
/// lm/W times the second is the luminance in cd/m². `temperature` in kelvin, in [0,
/// hottest_black_body]; values outside are cut to it, NaN counts as 0. The matching functions are
/// the multi-lobe fits of C. Wyman, P.-P. Sloan, P. Shirley, Simple Analytic Approximations to the
/// CIE XYZ Color Matching Functions, JCGT 2(2), 2013; chromaticities x, y are within 0.003 from
/// 2000 K up, 0.011 at 1000 K.
glm::dvec3 black_body_xyz(double temperature);

/// The radiance of a black body in linear sRGB (primaries and white of IEC 61966-2-1), in units of
/// the luminance that one of `reference` kelvin has, so that the luminance of the reference is 1.
/// Finite and not negative: what lies outside of sRGB's gamut (blue below 1900 K, green below 800
/// K) is cut to 0, by which the luminance grows by 0.5 % at 1500 K and 3.5 % at 800 K. Throws
/// std::invalid_argument for a reference that is not in [coldest_black_body_reference,
/// hottest_black_body].
glm::dvec3 black_body_radiance(double temperature, double reference);

/// A node of the table; four floats, as kernels gather them.
struct BlackBodyNode
{
  float red;
  float green;
  float blue;
  float unused = 0.0f;
};

/// black_body_radiance at even distances from 0 K on. Between nodes kernels interpolate.
struct BlackBodyTable
{
  static constexpr int least_intervals = 256;
  static constexpr int most_intervals = 16384;
  /// Intervals between the nodes, a power of two: the fewest with which interpolation is within
  /// 1e-4 of the value and 1e-6 of the largest value, or the most.
  int intervals = least_intervals;
  /// intervals + 2 of them: one node more, so that the last interval has two ends like any other.
  std::vector<BlackBodyNode> nodes;
  /// Position in the table = temperature · scale, clamped to [0, intervals].
  float scale = 1.0f;
  /// The largest component of any node.
  float brightest = 0.0f;
};

/// A table from 0 K to `hottest` kelvin, which is cut to (0, hottest_black_body]. Throws as
/// black_body_radiance does.
BlackBodyTable make_black_body_table(double hottest, double reference);

}
