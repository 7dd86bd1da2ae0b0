// Noise as a field: many places at once, tiled where asked, warped where asked.
#pragma once

#include "data-generators/field.h"
#include "data-generators/noise.h"

namespace brume
{

enum class NoiseKind
{
  Perlin,      ///< fbm(): range [-1, 1]
  Worley,      ///< billow_fbm(), that is 1 - worley: range [0, 1]
  Simplex,     ///< simplex_fbm(): range [-1, 1]
  PerlinWorley ///< perlin_worley_noise(): range [0, 1]
};

struct NoiseOptions
{
  NoiseKind kind = NoiseKind::Perlin;
  std::uint32_t seed = 1;

  /// Edge of the cube [0, width]^3 in which it is sampled, in the unit of the place. Above 0. The
  /// noise itself has no end.
  double width = 8.0;

  /// Size of the features of the first octave, in the unit of the place. Above 0.
  double feature_size = 1.0;

  NoiseOctaves octaves;

  /// Domain warp, both in features of the first octave: the size of its eddies (0: no warp), and
  /// the largest shift along an axis.
  double warp_size = 0.0;
  double warp_amplitude = 0.0;

  /// Period along each axis in features of the first octave; the warp has the same. 0: none. A cube
  /// of `width` tiles where width = period * feature_size.
  NoisePeriod period = NoisePeriod(0);
};

/// Noise as a field. It does not move: time does not matter. Highway's targets all give the bits of
/// value(), which evaluates one place in plain C++.
///
/// Throws std::invalid_argument from the constructor for options out of their range, and for
/// simplex noise with a period.
class NoiseField : public Field
{
public:
  explicit NoiseField(const NoiseOptions& options = {});

  Box bounds() const override;
  float value(const glm::dvec3& place, double time) const override;
  void values(const PlaceBlock& places, double time, float* out) const override;
  FieldRange range_in(const Box& box, double time) const override;

  const NoiseOptions& options() const { return m_options; }

private:
  NoiseOptions m_options;
};

}
