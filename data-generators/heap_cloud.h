// A cloud that is a heap of puffs, eroded by noise: what cumulus and cumulonimbus have in common.
// Internal to the generators.
#pragma once

#include "data-generators/puffs.h"

namespace brume
{

/// Lengths in metres, or in widths of the cloud's box where it says so.
struct HeapCloud
{
  const PuffHeap* heap = nullptr; ///< in widths

  std::uint32_t seed = 1;
  double width = 1.0;
  double height = 1.0; ///< of the box, widths
  double base = 0.0;   ///< widths

  double detail_size = 1.0;
  int octaves = 5;
  double offset = 0.12;
  double crispness = 4.0;
  double warp_amplitude = 0.0;
  double warp_size = 1.0;
  glm::dvec3 wind{ 0.0 };

  /// How far below the base density may begin, in widths: how ragged the base is.
  double below_base = 0.03;

  /// Height from which the cloud is ice, in widths: fibrous, softer, smoother. Above the box: none.
  double ice = 2.0;

  // Of the recipe (cumulus.h), in widths.
  static constexpr double usual_fade = 0.06;
  double border_fade = usual_fade;        ///< full density this far from the faces
  double empty_border = usual_fade / 3.0; ///< no density nearer to a face than this
  static constexpr double threshold = 0.25;
  /// The heap below which even the strongest noise leaves nothing.
  double needed() const { return threshold / (0.8 + offset); }

  FieldRange range_in(const Box& box) const;
};

/// The density at a place and at all places of a block: the same bits.
float heap_cloud_value(const HeapCloud& cloud, const glm::dvec3& place, double time);
void heap_cloud_packets(const HeapCloud& cloud, const PlaceBlock& places, double time, float* out);

}
