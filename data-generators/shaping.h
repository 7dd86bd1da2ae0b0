// The small curves that shape a density.
#pragma once

namespace brume
{

/// x held to [0, 1]; NaN gives 0.
inline double saturate(double x)
{
  return x > 0.0 ? (x < 1.0 ? x : 1.0) : 0.0;
}

/// Linear interpolation: a at t = 0, b at t = 1; t is not held to [0, 1].
inline double mix(double a, double b, double t)
{
  return a + (b - a) * t;
}

/// The place of x between `from` and `to`, held to [0, 1]: 0 at `from`, 1 at `to`. Where the two
/// are the same it is the step at that place: 0 below, 1 at it and above.
inline double ramp(double x, double from, double to)
{
  return from == to ? (x < from ? 0.0 : 1.0) : saturate((x - from) / (to - from));
}

/// The linear map that sends [from_low, from_high] to [to_low, to_high], held to the latter.
/// In the volume-rendering texts: R(x; from_low, from_high -> to_low, to_high).
inline double remap(double x, double from_low, double from_high, double to_low, double to_high)
{
  return mix(to_low, to_high, ramp(x, from_low, from_high));
}

/// 3 t^2 - 2 t^3 of the ramp: as ramp(), with no kink at either end.
inline double smooth_ramp(double x, double from, double to)
{
  const double t = ramp(x, from, to);
  return t * t * (3.0 - 2.0 * t);
}

}
