// Colours as people choose them: by hue, saturation and brightness.
#pragma once

#include "medium_options.h"

namespace brume::app
{

/// A colour's largest channel is its brightness, which may be above 1; of grey the hue is 0.
struct Tint
{
  double hue = 0.0;        ///< from red 0 by green 1/3 and blue 2/3 round to 1
  double saturation = 0.0; ///< 0 grey, 1 without white
  double brightness = 0.0; ///< 0 or more
};

Tint tint_of(const Triple& colour);
Triple colour_of(const Tint& tint);

/// The largest channel.
double brightness_of(const Triple& colour);

/// The colour with another brightness; white's where it is black.
Triple with_brightness(const Triple& colour, double brightness);

}
