// The height of the ground as a function of place.
#pragma once

#include "data-generators/field.h"

#include <cstdint>
#include <functional>
#include <glm/vec2.hpp>
#include <vector>

namespace brume
{

/// Heights on a grid, bilinear between, and beyond its ends those of the nearest place within.
struct HeightMap
{
  glm::ivec2 dimensions{ 0 }; ///< heights along x and y, 2 or more each
  glm::dvec2 origin{ 0.0 };   ///< where the first one is, metres
  glm::dvec2 spacing{ 1.0 };  ///< metres between, above 0
  std::vector<float> heights; ///< metres, x fastest; finite

  /// Samples a function of x and y at the corners of `size` by `size` squares that fill
  /// [-width/2, width/2]^2, all threads.
  static HeightMap from(const std::function<double(double x, double y)>& ground,
    double width,
    int size = 256);

  /// Within a square in single precision; the fog of every SIMD target stands on the same bits. What
  /// is no number counts as the first place.
  float at(double x, double y) const;

  /// The height below which this fraction of the ground lies; fraction in [0, 1].
  double quantile(double fraction) const;

  /// Throws std::invalid_argument where the numbers above are not what they must be.
  void check() const;
};

/// Hills that nobody has seen: a valley that winds along y between ridges, in a square of `width`
/// metres, from 0 up to `relief` metres. Any seed has its own.
///   h = relief (0.6 s(d) + 0.4 s(d)^(1/2) r),  d = |x - 0.12 width n(y)| / (0.36 width)
/// with s(d) = 3 d^2 - 2 d^3 held to [0, 1], n gradient noise of features of 0.5 width, and r
/// ridges, (1 - |fbm|)^2 with features of 0.22 width.
HeightMap valley_terrain(std::uint32_t seed, double width, double relief);

}
