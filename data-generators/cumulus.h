// A cumulus: a fair-weather cloud with a flat base, a cauliflower top and wispy edges.
#pragma once

#include "data-generators/field.h"
#include "data-generators/noise.h"

#include <cstdint>
#include <memory>

namespace brume
{

struct HeapCloud;
class PuffHeap;

/// The shape of a cumulus. Lengths are metres, time is in seconds.
struct CumulusOptions
{
  /// Which cloud: places and sizes of the heaps it is piled from, and its noise. Any value.
  std::uint32_t seed = 1;

  /// Width of the cloud's box, metres: x and y in [-width/2, width/2], z in [0, 0.6 width], z up,
  /// the base of the cloud at 0.08 width. Everything in the cloud grows with it, but for the
  /// lengths below. The cloud itself is some 0.75 width across. Above 0.
  double width = 2000.0;

  /// Height of the cloud's base over the box's floor, and of its top, metres. 0 and below: 0.08
  /// width, and 0.44 width above the base. The pile is stretched between the two (its noise is
  /// not), and the box ends 0.08 width above the top. The base is at 0.03 width or above; the
  /// highest tower ends near the top, within some tenths of the cloud's height.
  double base = 0.0;
  double top = 0.0;

  /// Size of the largest features of the noise, metres; the finest are 2^(octaves - 1) times
  /// smaller. Above 0.
  double detail_size = 160.0;

  /// Octaves of the noise, each half as large and half as strong as the one before. 1 … 8.
  int octaves = 5;

  /// What the heaps weigh with no noise: the recipe's offset, (0.8 noise + offset). Larger fills
  /// the cloud and smooths its surface, smaller frays it, and tears it below about 0.1. 0 … 1.
  double offset = 0.12;

  /// Contrast of the cloud's edge: how fast density climbs from 0 to 1 where the cloud begins.
  /// Larger is crisper. Above 0.
  double crispness = 4.0;

  /// Domain warp: the largest shift along an axis, metres, and the size of its eddies, metres.
  /// A warp of 0 is none. The amplitude is held to [0, 0.06 width].
  double warp_amplitude = 50.0;
  double warp_size = 300.0;

  /// Wind, metres a second: the noise moves through the heaps with it, which themselves stay where
  /// they are, so that the cloud boils and never leaves its box.
  glm::dvec3 wind{ 4.0, 1.0, 1.5 };
};

/// The density of a cumulus, in [0, 1] without a unit: the fraction of the thickest part's water,
/// to be multiplied by an extinction in 1/metre (0.02 to 0.1 for real cumulus).
///
/// The recipe: heap(p) * (0.8 noise(p) + offset), a threshold, and a ramp upward from the base:
///   density = ramp(z) * saturate(crispness * (heap(p') * (0.8 noise(p' - wind t) + offset) - 1/4))
/// p' is the warped place. heap is 1 - prod(1 - f_b^2) over the spheres b, f_b = (1 - |p' - c_b|^2
/// / r_b^2) held to 0 and above. noise is half gradient fBm, half billows, its middle (0.33 … 0.63)
/// stretched over [0, 1]. The spheres are piled in three generations: towers on the base, buds on
/// the towers, buds on the buds.
///
/// Density is exactly 0 within 0.02 width of the box's faces, and outside the box: a grid
/// whose voxels are no larger than 0.04 width has an empty border.
///
/// Throws std::invalid_argument from the constructor for options out of their range.
class Cumulus : public Field
{
public:
  explicit Cumulus(const CumulusOptions& options = {});
  ~Cumulus() override;

  Box bounds() const override;
  /// Time in seconds; a time that is not finite counts as 0.
  float value(const glm::dvec3& place, double time) const override;
  void values(const PlaceBlock& places, double time, float* out) const override;
  FieldRange range_in(const Box& box, double time) const override;

  const CumulusOptions& options() const { return m_options; }

private:
  CumulusOptions m_options;
  std::unique_ptr<const PuffHeap> m_heap;
  std::unique_ptr<const HeapCloud> m_cloud;
};

}
