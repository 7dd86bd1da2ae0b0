// A number for each pixel, the same in every picture.
#pragma once

#include <cmath>

namespace brume
{

/// In [0, 1), spread so evenly that any few neighbouring pixels cover the range (interleaved
/// gradient noise: Jimenez, Next generation post processing in Call of Duty: Advanced Warfare,
/// SIGGRAPH 2014).
inline double pixel_hash(int x, int y)
{
  const double inner = 0.06711056 * x + 0.00583715 * y;
  const double outer = 52.9829189 * (inner - std::floor(inner));
  return outer - std::floor(outer);
}

}
