#include "temperature_from_vtk.h"

#include "grid_from_vtk.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkPointData.h"

#include <algorithm>

namespace brume
{

void TemperatureFromVTK::Clear()
{
  this->TheGrid = Grid();
  this->Copy.clear();
  this->Copy.shrink_to_fit();
  this->Revision = 0;
  this->Last = Key{};
}

std::string TemperatureFromVTK::Update(vtkDataObject* input,
  const std::string& name,
  const Grid& values)
{
  if (name.empty())
  {
    return "black-body light needs temperatures: name their array with "
           "vtkBrumeMedium::SetTemperatureArrayName, or call SetBlackBody(0)";
  }
  auto* image = vtkImageData::SafeDownCast(input);
  if (!image)
  {
    return "a sparse volume has no temperatures: call vtkBrumeMedium::SetBlackBody(0)";
  }
  vtkDataArray* array = values.cell_centred ? image->GetCellData()->GetArray(name.c_str())
                                            : image->GetPointData()->GetArray(name.c_str());
  const std::string places = values.cell_centred ? "cells" : "points";
  if (!array)
  {
    return "the input's " + places + " have no array '" + name +
           "': give vtkBrumeMedium::SetTemperatureArrayName one of theirs: " +
           array_names(image, values.cell_centred);
  }
  const vtkIdType voxels =
    static_cast<vtkIdType>(values.dims[0] - values.padding_x) * values.dims[1] * values.dims[2];
  if (array->GetNumberOfComponents() != 1 || array->GetNumberOfTuples() != voxels)
  {
    return "the temperatures of '" + name + "' are " + std::to_string(array->GetNumberOfTuples()) +
           " of " + std::to_string(array->GetNumberOfComponents()) +
           " components: give one number to each of the " + std::to_string(voxels) + " " + places;
  }
  const Key key{ array,
    static_cast<unsigned long>(array->GetMTime()),
    static_cast<unsigned long>(image->GetMTime()),
    values.dims[0],
    values.dims[1],
    values.dims[2],
    values.padding_x };
  this->TheGrid.linear = values.linear;
  if (key == this->Last)
  {
    return {};
  }
  this->Clear(); // until all is done: memory may run out on the way
  Grid& grid = this->TheGrid;
  grid.type = VoxelType::Float32;
  std::copy(values.dims, values.dims + 3, grid.dims);
  grid.cell_centred = values.cell_centred;
  grid.padding_x = values.padding_x;
  grid.linear = values.linear;
  if (array->GetDataType() == VTK_FLOAT && array->HasStandardMemoryLayout() && !values.padding_x)
  {
    grid.voxels = array->GetVoidPointer(0);
  }
  else
  {
    const int copies = 1 + values.padding_x;
    this->Copy.resize(static_cast<std::size_t>(voxels) * copies);
    float* out = this->Copy.data();
    for (vtkIdType i = 0; i < voxels; ++i, out += copies)
    {
      std::fill(out, out + copies, static_cast<float>(array->GetComponent(i, 0)));
    }
    grid.voxels = this->Copy.data();
  }
  this->Revision = next_revision();
  this->Last = key;
  return {};
}

}
