// The errors of many pixels, summed up. Internal to Transport.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace brume
{

/// Collects standard errors, and tells what their picture's errors come to.
class PathError
{
public:
  /// A pixel: the variances of the means of its three channels.
  void add(const double variance[3]);

  /// Root mean square over pixels and channels.
  double rms() const;

  /// What all but a share of the pixels' errors are expected to be below, each pixel's error being
  /// normally distributed with the largest standard error of its channels. To 1 %; +infinity where a
  /// variance is no number.
  double quantile(double beyond = 0.001) const;

private:
  /// Standard errors by their binary logarithm, 64 to an octave from 2⁻⁴⁰ to 2²⁴.
  static constexpr int least_exponent = -40;
  static constexpr int parts = 64;
  std::array<std::uint64_t, 64 * parts> Bins{};
  std::uint64_t Pixels = 0;
  bool Unknown = false; ///< some variance is no number
  double Sum = 0.0;
};

}
