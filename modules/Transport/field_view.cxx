#include "Transport/field_view.h"

#include <limits>

namespace brume
{

FieldView view_field(const Grid& grid, int component, bool non_finite, float empty_value)
{
  FieldView view;
  const std::size_t offset = component * size_of(grid.type);
  view.base = static_cast<const std::uint8_t*>(grid.voxels) + offset;
  view.type = grid.type;
  view.stride[0] = size_of(grid.type) * grid.components;
  view.stride[1] = view.stride[0] * grid.dims[0];
  view.stride[2] = view.stride[1] * grid.dims[1];
  for (int axis = 0; axis < 3; ++axis)
  {
    view.last[axis] = grid.dims[axis] - 1;
    view.last_cell[axis] = grid.dims[axis] > 1 ? grid.dims[axis] - 2 : 0;
    view.row[axis] = grid.dims[axis] > 1 ? static_cast<std::ptrdiff_t>(view.stride[axis]) : 0;
  }
  view.last_word = grid.bytes() - sizeof(std::int32_t) - offset;
  view.far = grid.bytes() > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max());
  view.linear = grid.linear;
  view.non_finite = non_finite;
  view.empty_value = empty_value;
  return view;
}

}
