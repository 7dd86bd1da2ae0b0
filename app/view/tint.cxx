#include "tint.h"

#include <algorithm>
#include <cmath>

namespace brume::app
{

double brightness_of(const Triple& colour)
{
  return std::max({ colour[0], colour[1], colour[2] });
}

Triple with_brightness(const Triple& colour, double brightness)
{
  const double most = brightness_of(colour);
  // Grey as it is: divided and multiplied its channels might differ by a bit.
  if (most <= 0.0 || (colour[0] == colour[1] && colour[0] == colour[2]))
  {
    return { brightness, brightness, brightness };
  }
  return {
    colour[0] / most * brightness, colour[1] / most * brightness, colour[2] / most * brightness
  };
}

Tint tint_of(const Triple& colour)
{
  Tint tint;
  tint.brightness = brightness_of(colour);
  const double range = tint.brightness - std::min({ colour[0], colour[1], colour[2] });
  if (tint.brightness <= 0.0 || range <= 0.0)
  {
    return tint;
  }
  tint.saturation = range / tint.brightness;
  const double sixths = colour[0] == tint.brightness   ? (colour[1] - colour[2]) / range
                        : colour[1] == tint.brightness ? 2.0 + (colour[2] - colour[0]) / range
                                                       : 4.0 + (colour[0] - colour[1]) / range;
  tint.hue = (sixths < 0.0 ? sixths + 6.0 : sixths) / 6.0;
  return tint;
}

Triple colour_of(const Tint& tint)
{
  const double sixths = 6.0 * (tint.hue - std::floor(tint.hue));
  Triple colour;
  const double peaks[] = { 0.0, 2.0, 4.0 }; // of red, green, blue
  for (int c = 0; c < 3; ++c)
  {
    const double off = std::abs(sixths - peaks[c]);
    const double pure = std::clamp(2.0 - std::min(off, 6.0 - off), 0.0, 1.0);
    colour[static_cast<std::size_t>(c)] = tint.brightness * (1.0 - tint.saturation * (1.0 - pure));
  }
  return colour;
}

}
