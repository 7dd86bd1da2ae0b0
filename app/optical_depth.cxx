#include "optical_depth.h"

#include "memory_limit.h"

#include "Transport/sparse_voxels.h"

#include "vtkBrumeSparseVolume.h"

#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkPointData.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <vector>

namespace brume::app
{

namespace
{

/// What of a value counts as density.
double density(double value)
{
  return std::isfinite(value) && value > 0.0 ? value : 0.0;
}

AxisDepth summarize(std::vector<double>& depths)
{
  depths.erase(std::remove_if(depths.begin(), depths.end(), [](double d) { return !(d > 0.0); }),
    depths.end());
  AxisDepth result;
  result.lines = depths.size();
  if (depths.empty())
  {
    return result;
  }
  const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
  std::nth_element(depths.begin(), middle, depths.end());
  result.median = *middle;
  result.largest = *std::max_element(depths.begin(), depths.end());
  return result;
}

template <class T>
std::array<AxisDepth, 3> depths_of(const T* values,
  int components,
  const int dims[3],
  const double spacing[3],
  double extinction)
{
  std::array<std::vector<double>, 3> sums;
  for (int axis = 0; axis < 3; ++axis)
  {
    sums[axis].assign(static_cast<std::size_t>(dims[(axis + 1) % 3]) *
                        static_cast<std::size_t>(dims[(axis + 2) % 3]),
      0.0);
  }
  // A line that is one voxel long has no length.
  const auto weight = [dims](int axis, int i) {
    return dims[axis] == 1 ? 0.0 : i == 0 || i == dims[axis] - 1 ? 0.5 : 1.0;
  };
  for (int k = 0; k < dims[2]; ++k)
  {
    for (int j = 0; j < dims[1]; ++j)
    {
      for (int i = 0; i < dims[0]; ++i, values += components)
      {
        const double d = density(static_cast<double>(*values));
        const int at[3] = { i, j, k };
        for (int axis = 0; axis < 3; ++axis)
        {
          const int u = (axis + 1) % 3;
          const int v = (axis + 2) % 3;
          sums[axis][static_cast<std::size_t>(at[v]) * static_cast<std::size_t>(dims[u]) +
                     static_cast<std::size_t>(at[u])] += d * weight(axis, at[axis]);
        }
      }
    }
  }
  std::array<AxisDepth, 3> result;
  for (int axis = 0; axis < 3; ++axis)
  {
    for (double& sum : sums[axis])
    {
      sum *= extinction * spacing[axis];
    }
    result[axis] = summarize(sums[axis]);
  }
  return result;
}

/// The lines of one axis that go through bricks, 64 to a column of bricks.
using Columns = std::unordered_map<std::uint64_t, std::array<double, 64>>;

/// The most that these lines and their depths take: a column for each brick and for each place of a
/// tile, and no more than the box has.
double bytes_of_columns(const SparseVoxels& voxels, int axis)
{
  const int u = (axis + 1) % 3;
  const int v = (axis + 2) % 3;
  double columns = static_cast<double>(voxels.places().size());
  for (const BrickBox& tile : voxels.tiles())
  {
    columns += (tile.last[u] - tile.first[u] + 1.0) * (tile.last[v] - tile.first[v] + 1.0);
  }
  // A box that is not at a brick's corner touches one more brick along each axis.
  const double box = (voxels.dims()[u] / 8.0 + 2) * (voxels.dims()[v] / 8.0 + 2);
  constexpr double node = sizeof(Columns::value_type) + 4 * sizeof(void*);
  return std::min(columns, box) * (node + 64 * sizeof(double));
}

}

std::array<AxisDepth, 3> optical_depths(vtkImageData* image, double extinction)
{
  vtkDataArray* scalars = image->GetPointData()->GetScalars();
  switch (scalars->GetDataType())
  {
    vtkTemplateMacro(return depths_of(static_cast<const VTK_TT*>(scalars->GetVoidPointer(0)),
      scalars->GetNumberOfComponents(),
      image->GetDimensions(),
      image->GetSpacing(),
      extinction));
  }
  return {};
}

std::array<AxisDepth, 3> optical_depths(vtkBrumeSparseVolume* volume,
  double extinction,
  const std::string& name,
  std::uint64_t max_memory)
{
  const SparseVoxels& voxels = *volume->GetVoxels();
  for (int axis = 0; axis < 3; ++axis)
  {
    io::check_memory(name, bytes_of_columns(voxels, axis), max_memory);
  }
  double spacing[3];
  volume->GetSpacing(spacing);
  const double background = density(voxels.background());
  std::array<AxisDepth, 3> result;
  for (int axis = 0; axis < 3; ++axis)
  {
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    // Where there is no brick there is background, all along the box: what bricks hold is counted
    // beyond that.
    const double everywhere =
      background * static_cast<double>(voxels.dims()[axis] - 1 - voxels.first()[axis]);
    Columns columns;
    const auto column = [&](std::int32_t bu, std::int32_t bv) -> std::array<double, 64>&
    {
      return columns
        .emplace(static_cast<std::uint64_t>(static_cast<std::uint32_t>(bu)) << 32 |
                   static_cast<std::uint32_t>(bv),
          std::array<double, 64>{})
        .first->second;
    };
    for (const BrickBox& tile : voxels.tiles())
    {
      const double value =
        density(voxels.value_in_slot(static_cast<std::size_t>(tile.slot), 0)) - background;
      const double sum = value * 8.0 * (tile.last[axis] - tile.first[axis] + 1);
      for (std::int32_t bu = tile.first[u]; bu <= tile.last[u]; ++bu)
      {
        for (std::int32_t bv = tile.first[v]; bv <= tile.last[v]; ++bv)
        {
          for (double& line : column(bu, bv))
          {
            line += sum;
          }
        }
      }
    }
    const std::size_t first_slot = 1 + voxels.tile_slots();
    for (std::size_t i = 0; i < voxels.places().size(); ++i)
    {
      const BrickPlace& place = voxels.places()[i];
      std::array<double, 64>& lines = column(place[u], place[v]);
      for (int n = 0; n < SparseVoxels::brick_voxels; ++n)
      {
        const int at[3] = { n & 7, n >> 3 & 7, n >> 6 };
        lines[static_cast<std::size_t>(at[v] * 8 + at[u])] +=
          density(voxels.value_in_slot(first_slot + i, n)) - background;
      }
    }
    std::vector<double> depths;
    depths.reserve(64 * columns.size());
    for (const auto& entry : columns)
    {
      for (double line : entry.second)
      {
        depths.push_back((line + everywhere) * spacing[axis] * extinction);
      }
    }
    result[axis] = summarize(depths);
  }
  return result;
}

}
