// Sparse grids for the tests: dense voxels made sparse.
#pragma once

#include "Transport/half.h"
#include "Transport/sparse_voxels.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <memory>
#include <vector>

namespace sparse_grids
{

using namespace brume;

/// The topology of all bricks that hold a value(i, j, k) other than the background, for voxels from
/// `lower` to `upper`, both included.
template <class Value>
SparseTopology topology_of(const BrickPlace& lower,
  const BrickPlace& upper,
  double background,
  Value value)
{
  SparseTopology topology;
  const auto floor8 = [](std::int32_t v) { return v >> 3; };
  for (std::int32_t bz = floor8(lower[2]); bz <= floor8(upper[2]); ++bz)
    for (std::int32_t by = floor8(lower[1]); by <= floor8(upper[1]); ++by)
      for (std::int32_t bx = floor8(lower[0]); bx <= floor8(upper[0]); ++bx)
      {
        bool any = false;
        for (int i = 0; i < 512 && !any; ++i)
        {
          any = value(8 * bx + (i & 7), 8 * by + (i >> 3 & 7), 8 * bz + (i >> 6)) != background;
        }
        if (any)
        {
          topology.bricks.push_back({ { bx, by, bz } });
        }
      }
  return topology;
}

/// Fills bricks from value(i, j, k) in the topology's coordinates.
template <class Value>
SparseVoxels::Fill filler(const SparseTopology& topology, VoxelType type, Value value)
{
  return [&topology, type, value](std::size_t index, void* voxels)
  {
    const BrickPlace& b = topology.bricks[index];
    for (int i = 0; i < 512; ++i)
    {
      const double v = value(8 * b[0] + (i & 7), 8 * b[1] + (i >> 3 & 7), 8 * b[2] + (i >> 6));
      switch (type)
      {
        case VoxelType::UInt8:
          static_cast<std::uint8_t*>(voxels)[i] = static_cast<std::uint8_t>(v);
          break;
        case VoxelType::Int8:
          static_cast<std::int8_t*>(voxels)[i] = static_cast<std::int8_t>(v);
          break;
        case VoxelType::UInt16:
          static_cast<std::uint16_t*>(voxels)[i] = static_cast<std::uint16_t>(v);
          break;
        case VoxelType::Int16:
          static_cast<std::int16_t*>(voxels)[i] = static_cast<std::int16_t>(v);
          break;
        case VoxelType::Float16:
          static_cast<std::uint16_t*>(voxels)[i] = half_from_float(static_cast<float>(v));
          break;
        case VoxelType::Float32:
          static_cast<float*>(voxels)[i] = static_cast<float>(v);
          break;
      }
    }
  };
}

template <class Value>
std::unique_ptr<SparseVoxels> make_sparse(VoxelType type,
  const BrickPlace& lower,
  const BrickPlace& upper,
  double background,
  Value value)
{
  const SparseTopology topology = topology_of(lower, upper, background, value);
  return std::make_unique<SparseVoxels>(type, background, topology, filler(topology, type, value));
}

/// The same voxels, dense and single precision, x fastest.
inline std::vector<float> dense_copy(const SparseVoxels& sparse)
{
  std::vector<float> values;
  for (std::int32_t k = 0; k < sparse.dims()[2]; ++k)
    for (std::int32_t j = 0; j < sparse.dims()[1]; ++j)
      for (std::int32_t i = 0; i < sparse.dims()[0]; ++i)
        values.push_back(static_cast<float>(sparse.value(i, j, k)));
  return values;
}

/// A dense grid over such a copy.
inline Grid dense_grid(const SparseVoxels& sparse, const std::vector<float>& values)
{
  Grid grid = sparse.grid();
  grid.sparse = nullptr;
  grid.voxels = values.data();
  grid.type = VoxelType::Float32;
  return grid;
}

}
