#include "mask_from_vtk.h"

#include "Transport/grid.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkPointData.h"

#include <algorithm>

namespace brume
{

std::string MaskFromVTK::Update(vtkImageData* mask, const Grid& grid)
{
  vtkDataArray* array = nullptr;
  int dims[3] = { 0, 0, 0 };
  if (mask)
  {
    array = mask->GetPointData()->GetScalars();
    const bool cells = !array;
    array = cells ? mask->GetCellData()->GetScalars() : array;
    mask->GetDimensions(dims);
    for (int& n : dims)
    {
      n -= cells ? 1 : 0;
    }
    if (!array || array->GetNumberOfComponents() != 1 ||
        array->GetDataType() != VTK_UNSIGNED_CHAR || dims[0] < 1 || dims[1] < 1 || dims[2] < 1 ||
        array->GetNumberOfTuples() != static_cast<vtkIdType>(dims[0]) * dims[1] * dims[2])
    {
      return "the mask is not an image of one component of unsigned char: cast it "
             "(vtkImageCast)";
    }
  }
  const Key key{ array,
    array ? static_cast<unsigned long>(array->GetMTime()) : 0ul,
    mask ? static_cast<unsigned long>(mask->GetMTime()) : 0ul,
    grid.dims[0],
    grid.dims[1],
    grid.dims[2],
    grid.padding_x };
  this->New = key != this->Last;
  if (!this->New)
  {
    return {};
  }
  this->Last = Key{};
  this->Labels = nullptr;
  this->Copy.clear();
  this->Present.fill(false);
  if (array)
  {
    const int nx = grid.dims[0] - grid.padding_x;
    const bool same = grid.padding_x == 0 && dims[0] == nx && dims[1] == grid.dims[1] &&
                      dims[2] == grid.dims[2] && array->HasStandardMemoryLayout();
    if (same)
    {
      this->Labels = static_cast<const std::uint8_t*>(array->GetVoidPointer(0));
    }
    else
    {
      this->Copy.resize(grid.voxel_count());
      std::uint8_t* out = this->Copy.data();
      const auto nearest = [](int i, int n, int m)
      { return static_cast<vtkIdType>((2 * i + 1) * static_cast<long long>(m) / (2 * n)); };
      for (int k = 0; k < grid.dims[2]; ++k)
      {
        for (int j = 0; j < grid.dims[1]; ++j)
        {
          const vtkIdType row =
            (nearest(k, grid.dims[2], dims[2]) * dims[1] + nearest(j, grid.dims[1], dims[1])) *
            dims[0];
          for (int i = 0; i < grid.dims[0]; ++i)
          {
            const int x = std::min(i, nx - 1);
            *out++ =
              static_cast<std::uint8_t>(array->GetComponent(row + nearest(x, nx, dims[0]), 0));
          }
        }
      }
      this->Labels = this->Copy.data();
    }
    const std::size_t count = grid.voxel_count();
    for (std::size_t i = 0; i < count; ++i)
    {
      this->Present[this->Labels[i]] = true;
    }
  }
  this->Last = key;
  return {};
}

}
