#include "Transport/grid.h"

#include "Transport/sparse_voxels.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace brume
{

std::size_t size_of(VoxelType type)
{
  switch (type)
  {
    case VoxelType::UInt8:
    case VoxelType::Int8:
      return 1;
    case VoxelType::UInt16:
    case VoxelType::Int16:
    case VoxelType::Float16:
      return 2;
    case VoxelType::Float32:
      return 4;
  }
  return 0;
}

std::size_t Grid::voxel_count() const
{
  return sparse ? sparse->slot_count() * SparseVoxels::brick_voxels
                : static_cast<std::size_t>(dims[0]) * dims[1] * dims[2];
}

void Grid::validate() const
{
  if (sparse)
  {
    if (voxels || components != 1 || sparse->type() != type ||
        !std::equal(dims, dims + 3, sparse->dims().begin()))
    {
      throw std::invalid_argument("a sparse grid is of one component, and as its voxels say: take "
                                  "it from SparseVoxels::grid()");
    }
    return;
  }
  if (type == VoxelType::Float16)
  {
    throw std::invalid_argument("a dense grid of half precision is not read: convert it to float");
  }
  if (!voxels)
  {
    throw std::invalid_argument("the grid has no voxels");
  }
  if (dims[0] < 2 || dims[1] < 1 || dims[2] < 1 || bytes() < 4)
  {
    throw std::invalid_argument("a grid needs at least 2 x 1 x 1 voxels and 4 bytes, not " +
      std::to_string(dims[0]) + " x " + std::to_string(dims[1]) + " x " + std::to_string(dims[2]));
  }
  if (components < 1 || components > 4 || component < 0 || component >= components)
  {
    throw std::invalid_argument("a grid has 1 to 4 components, and its value is one of them, not " +
                                std::to_string(component) + " of " + std::to_string(components));
  }
  if (colour == VoxelColour::RGB && (components != 4 || type != VoxelType::UInt8))
  {
    throw std::invalid_argument("voxels that carry colours have 4 components of 8 bits");
  }
}

}
