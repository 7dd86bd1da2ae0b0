#include "render_timing.h"

#include <algorithm>

namespace brume::app
{

void summarise(std::vector<double> seconds, Timing& timing)
{
  std::sort(seconds.begin(), seconds.end());
  const std::size_t middle = seconds.size() / 2;
  timing.median =
    seconds.size() % 2 ? seconds[middle] : 0.5 * (seconds[middle - 1] + seconds[middle]);
  timing.min = seconds.front();
  timing.max = seconds.back();
  timing.repetitions = static_cast<int>(seconds.size());
}

}
