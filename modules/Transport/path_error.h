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
  /// A pixel: the variances of the means of its three channels, over so many paths.
  void add(const double variance[3], int paths = 0);

  /// Root mean square over pixels and channels.
  double rms() const;

  /// What all but a share of the pixels' errors are expected to be below, each pixel's error being
  /// normally distributed with the largest standard error of its channels. To 1 %; +infinity where
  /// a variance is no number.
  double quantile(double beyond = 0.001) const;

  /// Where the pixels are to have paths of their own number: the standard error that those with a
  /// larger one must come down to, so that all but a share of the errors are below `error`.
  /// +infinity where they are already, or a variance is no number.
  double cap(double error, double beyond) const;
  /// Paths that it takes to bring all standard errors down to this.
  double paths_to(double cap) const;
  /// The standard error that so many more paths bring the larger ones down to.
  double cap_of(double paths) const;

private:
  double share_beyond(double error, double cap) const;
  /// Standard errors by their binary logarithm, 64 to an octave from 2⁻⁴⁰ to 2²⁴.
  static constexpr int least_exponent = -40;
  static constexpr int parts = 64;
  std::array<std::uint64_t, 64 * parts> Bins{};
  std::array<double, 64 * parts> Paths{}; ///< of the pixels of each bin
  std::uint64_t Pixels = 0;
  bool Unknown = false; ///< some variance is no number
  double Sum = 0.0;
};

}
