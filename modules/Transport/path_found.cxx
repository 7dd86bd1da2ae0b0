#include "Transport/path_found.h"

#include <algorithm>

namespace brume
{

FoundLight::FoundLight(const PathSums& paths, int width, int height)
{
  for (bool first = true; first || width > 1 || height > 1; first = false)
  {
    const Level* const finer = this->Levels.empty() ? nullptr : &this->Levels.back();
    Level level{ (width + 1) / 2, (height + 1) / 2, {} };
    level.sums.assign(6 * static_cast<std::size_t>(level.width) * level.height, 0.0);
    for (int y = 0; y < height; ++y)
    {
      for (int x = 0; x < width; ++x)
      {
        const std::size_t from = static_cast<std::size_t>(y) * width + x;
        const std::size_t to = static_cast<std::size_t>(y / 2) * level.width + x / 2;
        for (int c = 0; c < 3; ++c)
        {
          level.sums[6 * to + c] += finer ? finer->sums[6 * from + c] : paths.sums[3 * from + c];
          level.sums[6 * to + 3 + c] +=
            finer ? finer->sums[6 * from + 3 + c] : paths.squares[3 * from + c];
        }
      }
    }
    width = level.width;
    height = level.height;
    this->Levels.push_back(std::move(level));
  }
}

double FoundLight::brought(int x, int y, int channel) const
{
  for (const Level& level : this->Levels)
  {
    x /= 2;
    y /= 2;
    const double* const sums = &level.sums[6 * (static_cast<std::size_t>(y) * level.width + x)];
    if (sums[channel] > 0.0)
    {
      return sums[3 + channel] / sums[channel];
    }
  }
  return 0.0;
}

}
