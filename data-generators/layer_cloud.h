// Clouds that lie in layers: stratus, stratocumulus, cirrus. Internal to the generators; the recipe
// stands in clouds.h.
#pragma once

#include "data-generators/clouds.h"

namespace brume
{

struct LayerCloud
{
  CloudOptions options;
  double height = 1.0;  ///< from base to top, metres
  double along_x = 1.0; ///< the wind's direction, level, of length 1
  double along_y = 0.0;
  double cover_size = 1.0;      ///< of the patches or cells, metres
  double cover_threshold = 0.0; ///< of the cover noise: there is cloud above it

  /// Of half the width, from the sides: no cloud nearer than the first, all of it from the second
  /// on.
  double empty_border = 0.02;
  double border_fade = 0.4;
  static constexpr double empty_above = 0.1; ///< of the height: the box's room above and below
};

/// The density at a place and at all places of a block: the same bits.
float layer_cloud_value(const LayerCloud& cloud, const glm::dvec3& place, double time);
void layer_cloud_packets(const LayerCloud& cloud,
  const PlaceBlock& places,
  double time,
  float* out);

}
