#include "Transport/grid.h"

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
      return 2;
    case VoxelType::Float32:
      return 4;
  }
  return 0;
}

void Grid::validate() const
{
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
