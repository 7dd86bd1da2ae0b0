#include "Transport/field_view.h"

#include "Transport/sparse_voxels.h"

#include <limits>

namespace brume
{

FieldView view_field(const Grid& grid, int component, bool non_finite, float empty_value)
{
  FieldView view;
  view.type = grid.type;
  view.linear = grid.linear;
  view.non_finite = non_finite;
  view.empty_value = empty_value;
  for (int axis = 0; axis < 3; ++axis)
  {
    view.last[axis] = grid.dims[axis] - 1;
    view.last_cell[axis] = grid.dims[axis] > 1 ? grid.dims[axis] - 2 : 0;
  }
  constexpr std::size_t most = std::numeric_limits<std::int32_t>::max();
  if (grid.sparse)
  {
    view.table = &grid.sparse->table();
    view.base = static_cast<const std::uint8_t*>(grid.sparse->pool());
    // Words are gathered by their number, what is smaller by its bytes.
    view.far = (grid.type == VoxelType::Float32 ? grid.voxel_count() : grid.bytes()) > most;
    return view;
  }
  const std::size_t offset = component * size_of(grid.type);
  view.base = static_cast<const std::uint8_t*>(grid.voxels) + offset;
  view.stride[0] = size_of(grid.type) * grid.components;
  view.stride[1] = view.stride[0] * grid.dims[0];
  view.stride[2] = view.stride[1] * grid.dims[1];
  for (int axis = 0; axis < 3; ++axis)
  {
    view.row[axis] = grid.dims[axis] > 1 ? static_cast<std::ptrdiff_t>(view.stride[axis]) : 0;
  }
  view.last_word = grid.bytes() - sizeof(std::int32_t) - offset;
  view.far = grid.bytes() > most;
  return view;
}

}
