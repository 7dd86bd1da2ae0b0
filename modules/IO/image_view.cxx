#include "image_view.h"

#include "vtkBitArray.h"
#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkMatrix3x3.h"
#include "vtkPointData.h"
#include "vtkType.h"

#include <algorithm>
#include <stdexcept>
#include <type_traits>

namespace brume::io
{

namespace
{

template <class T>
Scalar scalar_of()
{
  if constexpr (std::is_floating_point_v<T>)
  {
    return sizeof(T) == 4 ? Scalar::Float32 : Scalar::Float64;
  }
  constexpr bool sign = std::is_signed_v<T>;
  switch (sizeof(T))
  {
    case 1:
      return sign ? Scalar::Int8 : Scalar::UInt8;
    case 2:
      return sign ? Scalar::Int16 : Scalar::UInt16;
    case 4:
      return sign ? Scalar::Int32 : Scalar::UInt32;
    default:
      return sign ? Scalar::Int64 : Scalar::UInt64;
  }
}

}

Scalar scalar_of_vtk(int type)
{
  switch (type)
  {
    vtkTemplateMacro(return scalar_of<VTK_TT>());
  }
  throw std::runtime_error("VTK's type of numbers " + std::to_string(type) +
    " is none that is written: convert the array to another");
}

ImageFile view_of(vtkImageData* image, const std::string& path)
{
  if (!image || image->GetNumberOfPoints() < 1)
  {
    fail(path, "there are no voxels to write", "see what made the volume");
  }
  vtkDataArray* scalars = image->GetPointData()->GetScalars();
  if (!scalars || scalars->GetNumberOfTuples() != image->GetNumberOfPoints())
  {
    fail(path, "the volume has no scalars on its points", "mark an array as its scalars");
  }
  if (vtkBitArray::SafeDownCast(scalars))
  {
    fail(path, "its scalars are single bits", "convert them to unsigned char");
  }
  ImageFile file;
  int dimensions[3];
  image->GetDimensions(dimensions);
  std::copy(dimensions, dimensions + 3, file.dimensions.begin());
  file.components = scalars->GetNumberOfComponents();
  file.scalar = scalar_of_vtk(scalars->GetDataType());
  file.voxels = scalars->GetVoidPointer(0);
  file.array = scalars->GetName() ? scalars->GetName() : "";
  double first[3]; // an extent may not begin at 0
  image->GetPoint(0, first);
  const double* turn = image->GetDirectionMatrix()->GetData();
  for (int row = 0; row < 3; ++row)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      file.affine[4 * row + axis] = turn[3 * row + axis] * image->GetSpacing()[axis];
    }
    file.affine[4 * row + 3] = first[row];
  }
  return file;
}

}
