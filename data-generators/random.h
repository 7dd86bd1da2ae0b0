// Random numbers without a state: each is a hash of its own counter, so that a volume is the same
// whatever the order, the threads or the pieces it is made in, and on every machine. Integer
// arithmetic, and of floating point only what IEEE 754 rounds exactly (+ - * / sqrt): no libm.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

namespace brume
{

/// A bijection of the 32-bit integers in which each bit of the input moves about half of the bits
/// of the output. Constants: Wellons, "Prospecting for hash functions" (2018), lowbias32.
inline std::uint32_t mix_bits(std::uint32_t h)
{
  h ^= h >> 16;
  h *= 0x7feb352du;
  h ^= h >> 15;
  h *= 0x846ca68bu;
  h ^= h >> 16;
  return h;
}

/// A seed of its own for the part `stream` of a thing that was given `seed`: octaves, components of
/// a warp, blobs.
inline std::uint32_t substream(std::uint32_t seed, std::uint32_t stream)
{
  return mix_bits(mix_bits(seed + 0x9e3779b9u) ^ (stream * 0x85ebca6bu + 0x27d4eb2fu));
}

/// The hash of a place on the integer lattice. `key` is a seed that has been through substream().
/// Coordinates count modulo 2^32.
inline std::uint32_t hash_lattice(std::uint32_t i,
  std::uint32_t j,
  std::uint32_t k,
  std::uint32_t key)
{
  return mix_bits((i * 0x8da6b343u + j * 0xd8163841u + k * 0xcb1ab31fu) ^ key);
}

/// A hash as a number in [0, 1): its upper 24 bits, which a float holds exactly.
inline float unit_float(std::uint32_t h)
{
  return static_cast<float>(h >> 8) * (1.0f / 16777216.0f);
}

/// Natural logarithm of a positive normal number, within 1e-12 of it, with the same bits on every
/// machine. x = m 2^e with m in [sqrt(1/2), sqrt(2)], ln m = 2 artanh((m - 1)/(m + 1)) by its
/// series.
inline double portable_log(double x)
{
  std::uint64_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  int exponent = static_cast<int>(bits >> 52) - 1023;
  bits = (bits & 0xfffffffffffffull) | 0x3ff0000000000000ull;
  double m;
  std::memcpy(&m, &bits, sizeof m);
  if (m > 1.4142135623730951)
  {
    m *= 0.5;
    ++exponent;
  }
  const double t = (m - 1.0) / (m + 1.0);
  const double s = t * t;
  double sum = 1.0 / 15.0;
  for (int n = 13; n >= 1; n -= 2)
  {
    sum = sum * s + 1.0 / n;
  }
  return 2.0 * t * sum + exponent * 0.6931471805599453;
}

/// A hash as a standard normal deviate: the inverse of the normal distribution at (h + 1/2)/2^32,
/// within 1e-6 relative, so in about [-6.4, 6.4].
/// Wichura, "Algorithm AS 241: The percentage points of the normal distribution" (1988), PPND7.
inline double unit_normal(std::uint32_t h)
{
  const double p = (h + 0.5) / 4294967296.0;
  const double q = p - 0.5;
  if (std::fabs(q) <= 0.425)
  {
    const double r = 0.180625 - q * q;
    return q * (((59.109374720 * r + 159.29113202) * r + 50.434271938) * r + 3.3871327179) /
           (((67.187563600 * r + 78.757757664) * r + 17.895169469) * r + 1.0);
  }
  const double r = std::sqrt(-portable_log(q < 0.0 ? p : 1.0 - p)) - 1.6; // at most 3.2 here
  const double x = (((0.17023821103 * r + 1.3067284816) * r + 2.7568153900) * r + 1.4234372777) /
                   ((0.12021132975 * r + 0.73700164250) * r + 1.0);
  return q < 0.0 ? -x : x;
}

}
