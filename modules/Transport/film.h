// The picture as light, before any display: what an integrator writes and what a mapper blends,
// a writer stores and a comparison measures.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace brume
{

/// A rectangle of pixels that holds linear radiance, transmittance, depth and an error estimate.
///
/// Rows run from the bottom of the picture to its top, as in VTK; pixel (x, y) is element
/// y * width + x of each plane. A pixel of the finished picture is
///     radiance + transmittance * background   (for each of R, G, B).
struct Film
{
  int width = 0;  ///< pixels
  int height = 0; ///< pixels

  /// Linear radiance that reaches the eye with nothing behind the medium; W sr⁻¹ m⁻² in the
  /// scene's own scale, where a white emitter is 1. R, G, B planes, each width * height.
  std::vector<float> radiance[3];
  /// Fraction of the light from behind that passes, in [0, 1]. R, G, B planes.
  std::vector<float> transmittance[3];
  /// Distance along the pixel's ray, in world units from the camera's near plane, to where the
  /// transmittance first falls below one half; +infinity where it never does.
  std::vector<float> depth;
  /// Estimate of the largest error of the pixel's radiance + transmittance, as a fraction of white.
  std::vector<float> error;

  Film() = default;
  /// An empty picture: no radiance, all light passes. Throws std::invalid_argument for a width or
  /// height that is not positive.
  Film(int width, int height);

  /// Makes the picture empty again, in the memory that it has.
  void clear();

  std::size_t size() const { return static_cast<std::size_t>(width) * height; }
};

/// The finished picture over a background of one colour: interleaved R, G, B, linear, not clamped,
/// rows from the bottom up, 3 * width * height floats.
std::vector<float> over_background(const Film& film, const double background[3]);

}
