// Noise: smooth pseudo-random functions of place, from which clouds and textures are made.
//
// Every function here is deterministic: the same place, options and seed give the same bits on
// every machine, compiler, SIMD target and thread count (integer hashes, no tables, no libm, and
// the library is compiled without contraction of a*b+c into one rounding). Different seeds give
// unrelated noise. All have a feature size of about 1: divide the place by the size that you want.
// A place that is not finite, or farther than 1e15 from the origin, gives 0.
//
// One place at a time here; many at once, some times faster and with the very same bits, by a
// NoiseField (noise_field.h).
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

namespace brume
{

/// After how many features noise repeats itself along each axis; 0 and less: never.
/// noise(place + period) = noise(place), as exactly as the sum of the places is rounded. An octave
/// whose features would not fit a whole number of times into the period takes the nearest size that
/// does.
using NoisePeriod = glm::ivec3;

/// Gradient noise. Range [-1, 1], mean 0, 0 at each lattice point, standard deviation about 0.26;
/// its first and second derivatives are continuous, its slope is less than 4.
/// Perlin, "Improving noise" (2002), with a hash in place of the permutation table, divided by the
/// largest value that the formula can take (1.0363539).
float perlin_noise(const glm::dvec3& place,
  std::uint32_t seed,
  const NoisePeriod& period = NoisePeriod(0));

/// Cellular noise: the distance to the nearest of a set of points, one at random in each unit cell,
/// cut off at 1. Range [0, 1], mean about 0.52, continuous, with a slope of at most 1.
/// Worley, "A cellular texture basis function" (1996), F1. With the cut-off, which less than one
/// place in a hundred meets, the 27 cells around a place are all that matter: there is no seam.
float worley_noise(const glm::dvec3& place,
  std::uint32_t seed,
  const NoisePeriod& period = NoisePeriod(0));

/// Gradient noise on a lattice of tetrahedra: four corners in place of eight, and no axes to be
/// seen. Range [-1, 1], mean 0, standard deviation about 0.39; its first and second derivatives are
/// continuous. Its features are some 1.3 times smaller than those of perlin_noise. It does not
/// tile. Perlin, "Noise hardware" (2001), as Gustavson, "Simplex noise demystified" (2005), writes
/// it, with a falloff of (1/2 - r^2)^4 that ends at the tetrahedron's far side, so that there is no
/// seam.
float simplex_noise(const glm::dvec3& place, std::uint32_t seed);

/// A sum of octaves, each finer and weaker than the one before.
struct NoiseOctaves
{
  /// How many octaves; 0 and less give 0, above 24 counts as 24.
  int count = 5;
  /// Factor of the frequency from each octave to the next.
  double lacunarity = 2.0;
  /// Factor of the amplitude from each octave to the next; not negative.
  double gain = 0.5;
};

/// Fractional Brownian motion over gradient noise: sum of gain^i perlin(lacunarity^i place) over
/// the sum of gain^i. Range [-1, 1], mean 0. Each octave has a seed of its own. Its finest feature
/// has the size lacunarity^-(count - 1).
float fbm(const glm::dvec3& place,
  std::uint32_t seed,
  const NoiseOctaves& octaves = {},
  const NoisePeriod& period = NoisePeriod(0));

/// The same over simplex noise. It does not tile.
float simplex_fbm(const glm::dvec3& place, std::uint32_t seed, const NoiseOctaves& octaves = {});

/// The same over 1 - worley: billows, round and bulging with creases between. Range [0, 1], mean
/// about 0.48.
float billow_fbm(const glm::dvec3& place,
  std::uint32_t seed,
  const NoiseOctaves& octaves = {},
  const NoisePeriod& period = NoisePeriod(0));

/// Perlin-Worley noise: billows b, between which gradient noise g = 1/2 + 1/2 fbm fills up,
/// b + (1 - b) g; connected as gradient noise is, round as billows are. Range [0, 1], mean about
/// 0.74. Schneider, "The real-time volumetric cloudscapes of Horizon: Zero Dawn" (2015), dilates
/// one by the other so.
float perlin_worley_noise(const glm::dvec3& place,
  std::uint32_t seed,
  const NoiseOctaves& octaves = {},
  const NoisePeriod& period = NoisePeriod(0));

/// Domain warp: the place moved by a vector of gradient noise, at most `amplitude` along each axis
/// (in the unit of the place) and with features of the size `scale` (the same unit; not above 0
/// leaves the place alone).
glm::dvec3 warp(const glm::dvec3& place, double scale, double amplitude, std::uint32_t seed);

}
