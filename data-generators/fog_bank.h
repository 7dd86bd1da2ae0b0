// Fog on the ground: homogeneous, thinning with the height, in valleys.
#pragma once

#include "data-generators/field.h"
#include "data-generators/height_map.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace brume
{

enum class FogKind
{
  Homogeneous, ///< the same everywhere in its box
  Height,      ///< thinner the higher, in swathes
  Valley       ///< what has gathered in the hollows of a height map
};

/// What fog it is. Lengths are metres, time is in seconds, z is up.
struct FogOptions
{
  FogKind kind = FogKind::Height;

  /// Which fog, and which hills where none are given. Any value.
  std::uint32_t seed = 1;

  /// Width of the box: x and y in [-width/2, width/2]. Above 0.
  double width = 4000.0;

  /// The box's floor and ceiling, for homogeneous and height fog; base < top.
  double base = 0.0;
  double top = 400.0;

  /// Height over which height fog thins to 1/e. Above 0.
  double scale_height = 90.0;

  /// How much the noise takes at most: 0 none, 1 all. Valley and height fog; 0 … 1.
  double noise = 0.6;

  /// Size of the noise's largest features, level; they are a third as high. The finest are
  /// 2^(octaves - 1) times smaller. Above 0; octaves 1 … 8.
  double detail_size = 400.0;
  int octaves = 5;

  /// Fraction of the height map that lies under valley fog: its level is that quantile of the
  /// heights. 0 … 1.
  double coverage = 0.45;

  /// Depth below its surface at which valley fog is at its full density. Above 0.
  double softness = 60.0;

  /// How far valley fog goes on under the ground, so that interpolation at the ground finds fog on
  /// both sides. 0 or more.
  double sink = 30.0;

  /// Height of the hills of valley_terrain(), which stands in where no height map is given. 0 or
  /// more.
  double relief = 500.0;

  /// Wind, metres a second, which carries the noise; the fog stays.
  glm::dvec3 wind{ 1.5, 0.5, 0.0 };
};

/// The density of fog, in [0, 1] without a unit: multiply by the extinction of its thickest part,
/// per metre (dense fog of 100 m visibility: 0.04; of 1 km: 0.004, by Koschmieder's 3.912 /
/// visibility).
///
///   homogeneous   1
///   height        e^(-(z' - base) / scale_height) (1 - noise (1 - n)),  z' = z - noise H w / 2
///   valley        s((level' - z) / softness) (1 - noise (1 - n)) where z > ground - sink, else 0;
///                 level' = level + noise softness w
/// with n in [0, 1] the noise of clouds (half billows, half fBm) at the place moved back by the
/// wind, w in [-1, 1] wide waves of fBm, H the scale height, and s(t) = 3 t^2 - 2 t^3 held to [0,
/// 1]. The height is held to 0 and above before it goes into e, so that the ground's fog is at
/// most 1.
///
/// It is 0 outside its box; at the box's faces it is not, but for a valley's ceiling.
///
/// Throws std::invalid_argument from the constructor for options out of their range.
class FogBank : public Field
{
public:
  /// `ground` is the height map of valley fog; null: valley_terrain(seed, width, relief).
  explicit FogBank(const FogOptions& options = {},
    std::shared_ptr<const HeightMap> ground = nullptr);
  ~FogBank() override;

  Box bounds() const override;
  /// Time in seconds; a time that is not finite counts as 0.
  float value(const glm::dvec3& place, double time) const override;
  void values(const PlaceBlock& places, double time, float* out) const override;
  FieldRange range_in(const Box& box, double time) const override;

  const FogOptions& options() const { return m_options; }
  /// The height map of valley fog, and the height of its surface, metres; else null and 0.
  const std::shared_ptr<const HeightMap>& ground() const { return m_ground; }
  double level() const { return m_level; }

private:
  double lowest_ground(const Box& box) const;

  FogOptions m_options;
  std::shared_ptr<const HeightMap> m_ground;
  double m_level = 0.0;
  Box m_box;
  std::vector<float> m_lowest; ///< of the ground, by squares of 16 by 16 heights
};

/// What the kernel is told. Internal to the generators.
struct FogKernel
{
  FogOptions options;
  const HeightMap* ground = nullptr;
  double level = 0.0;
  Box box;
};

/// The density at all places of a block. Internal to the generators.
void fog_packets(const FogKernel& fog, const PlaceBlock& places, double time, float* out);

}
