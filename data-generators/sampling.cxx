#include "data-generators/sampling.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace brume
{

Extent whole_extent(const Lattice& grid)
{
  return { glm::ivec3(0), grid.dimensions - 1 };
}

Lattice grid_over(const Box& box, int size)
{
  const glm::dvec3 side = box.upper - box.lower;
  if (size < 2)
  {
    throw std::invalid_argument(
      "a grid needs 2 voxels or more a side, not " + std::to_string(size));
  }
  if (!(side.x > 0.0 && side.y > 0.0 && side.z > 0.0))
  {
    throw std::invalid_argument("a grid needs a box with a volume");
  }
  const glm::dvec3 centre = 0.5 * (box.lower + box.upper);
  if (!std::isfinite(side.x + side.y + side.z) || !std::isfinite(centre.x + centre.y + centre.z))
  {
    throw std::invalid_argument("a grid needs a box whose sides and place are finite");
  }
  Lattice grid;
  const double step = std::max({ side.x, side.y, side.z }) / size;
  grid.spacing = glm::dvec3(step);
  for (int a = 0; a < 3; ++a)
  {
    grid.dimensions[a] = std::max(2, static_cast<int>(std::floor(side[a] / step + 0.5)));
    const double middle = 0.5 * (box.lower[a] + box.upper[a]);
    grid.origin[a] = middle - 0.5 * (grid.dimensions[a] - 1) * step;
  }
  return grid;
}

bool for_each_row(const Extent& extent,
  const std::function<void(int j, int k, std::size_t offset)>& row,
  const Progress& progress)
{
  const long width = extent.last.x - extent.first.x + 1;
  const long rows_a_slice = extent.last.y - extent.first.y + 1;
  const long rows = rows_a_slice * (extent.last.z - extent.first.z + 1);
  if (width <= 0 || rows_a_slice <= 0 || rows <= 0)
  {
    return true;
  }
  // Batches small enough to stop soon, large enough to keep every thread busy to the end of each.
  const long batch = std::max(rows / 64, 256L);
  for (long begin = 0; begin < rows; begin += batch)
  {
    const long end = std::min(begin + batch, rows);
    tbb::parallel_for(tbb::blocked_range<long>(begin, end, 8),
      [&](const tbb::blocked_range<long>& range)
      {
        for (long r = range.begin(); r != range.end(); ++r)
        {
          row(extent.first.y + static_cast<int>(r % rows_a_slice),
            extent.first.z + static_cast<int>(r / rows_a_slice),
            static_cast<std::size_t>(r) * width);
        }
      });
    if (progress && !progress(static_cast<double>(end) / rows))
    {
      return false;
    }
  }
  return true;
}

bool sample(const Field& field,
  double time,
  const Lattice& grid,
  const Extent& extent,
  float* values,
  const Progress& progress)
{
  const int width = extent.last.x - extent.first.x + 1;
  return for_each_row(
    extent,
    [&, width](int j, int k, std::size_t offset)
    {
      field.values(
        { grid.origin, grid.spacing, { extent.first.x, j, k }, { width, 1, 1 } },
        time,
        values + offset);
    },
    progress);
}

}
