#include "data-generators/scan.h"

#include "data-generators/hounsfield.h"
#include "data-generators/painted_volume.h"
#include "data-generators/random.h"

#include <algorithm>
#include <cmath>

namespace brume
{

bool sample_scan(const PaintedVolume& phantom,
  double noise,
  std::uint32_t noise_seed,
  const Lattice& grid,
  const Extent& extent,
  std::int16_t* values,
  const Progress& progress)
{
  const std::uint32_t key = substream(noise_seed, 50);
  return for_each_row(
    extent,
    [&](int j, int k, std::size_t offset)
    {
      for (int i = extent.first.x; i <= extent.last.x; ++i)
      {
        double value = phantom.value(grid.place(i, j, k));
        if (noise > 0.0)
        {
          value += noise * unit_normal(hash_lattice(i, j, k, key));
        }
        value = std::clamp(value, hounsfield::lowest, hounsfield::highest);
        values[offset++] = static_cast<std::int16_t>(std::floor(value + 0.5));
      }
    },
    progress);
}

}
