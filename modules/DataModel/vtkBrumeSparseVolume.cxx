#include "vtkBrumeSparseVolume.h"

#include "Transport/sparse_voxels.h"

#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMath.h"
#include "vtkMatrix4x4.h"
#include "vtkObjectFactory.h"

#include <algorithm>
#include <cmath>

vtkStandardNewMacro(vtkBrumeSparseVolume);

vtkBrumeSparseVolume::vtkBrumeSparseVolume() = default;

vtkBrumeSparseVolume::~vtkBrumeSparseVolume() = default;

void vtkBrumeSparseVolume::SetVoxels(std::shared_ptr<const brume::SparseVoxels> voxels)
{
  if (voxels == this->Voxels)
  {
    return;
  }
  this->Voxels = std::move(voxels);
  this->ValueRange[0] = 0.0;
  this->ValueRange[1] = -1.0;
  if (this->Voxels)
  {
    const std::array<double, 2> range = brume::value_range(*this->Voxels);
    std::copy(range.begin(), range.end(), this->ValueRange);
  }
  this->Modified();
}

void vtkBrumeSparseVolume::SetIndexToWorld(vtkMatrix4x4* matrix)
{
  const double* m = matrix->GetData();
  bool good = m[12] == 0.0 && m[13] == 0.0 && m[14] == 0.0 && m[15] == 1.0;
  for (int i = 0; i < 12; ++i)
  {
    good = good && std::isfinite(m[i]);
  }
  if (!good || matrix->Determinant() == 0.0)
  {
    vtkErrorMacro(
      "the matrix from index to world does not place voxels in space: give an affine one "
      "whose determinant is not 0");
    return;
  }
  if (!std::equal(m, m + 16, this->IndexToWorld->GetData()))
  {
    this->IndexToWorld->DeepCopy(matrix);
    this->Modified();
  }
}

vtkMatrix4x4* vtkBrumeSparseVolume::GetIndexToWorld()
{
  return this->IndexToWorld;
}

void vtkBrumeSparseVolume::SetName(const std::string& name)
{
  if (name != this->Name)
  {
    this->Name = name;
    this->Modified();
  }
}

void vtkBrumeSparseVolume::SetActiveVoxelCount(vtkIdType count)
{
  if (count != this->ActiveVoxelCount)
  {
    this->ActiveVoxelCount = count;
    this->Modified();
  }
}

void vtkBrumeSparseVolume::GetBounds(double bounds[6])
{
  vtkMath::UninitializeBounds(bounds);
  if (!this->Voxels)
  {
    return;
  }
  for (int corner = 0; corner < 8; ++corner)
  {
    double place[4] = { 0.0, 0.0, 0.0, 1.0 };
    for (int axis = 0; axis < 3; ++axis)
    {
      place[axis] =
        this->Voxels->origin()[axis] +
        (corner >> axis & 1 ? this->Voxels->dims()[axis] - 1 : this->Voxels->first()[axis]);
    }
    this->IndexToWorld->MultiplyPoint(place, place);
    for (int axis = 0; axis < 3; ++axis)
    {
      double* range = bounds + 2 * axis;
      range[0] = corner == 0 ? place[axis] : std::min(range[0], place[axis]);
      range[1] = corner == 0 ? place[axis] : std::max(range[1], place[axis]);
    }
  }
}

void vtkBrumeSparseVolume::GetSpacing(double spacing[3])
{
  for (int axis = 0; axis < 3; ++axis)
  {
    double edge[3];
    for (int row = 0; row < 3; ++row)
    {
      edge[row] = this->IndexToWorld->GetElement(row, axis);
    }
    spacing[axis] = vtkMath::Norm(edge);
  }
}

unsigned long vtkBrumeSparseVolume::GetActualMemorySize()
{
  const std::size_t bytes = this->Voxels ? this->Voxels->memory_bytes() : 0;
  return this->Superclass::GetActualMemorySize() +
         static_cast<unsigned long>((bytes + 1023) / 1024);
}

void vtkBrumeSparseVolume::Initialize()
{
  this->Superclass::Initialize();
  this->Voxels.reset();
  this->IndexToWorld->Identity();
  this->Name.clear();
  this->ActiveVoxelCount = 0;
  this->GridClass = GridClassUnknown;
  this->ValueRange[0] = 0.0;
  this->ValueRange[1] = -1.0;
}

void vtkBrumeSparseVolume::Share(vtkBrumeSparseVolume* source)
{
  if (!source || source == this)
  {
    return;
  }
  this->Voxels = source->Voxels;
  this->IndexToWorld->DeepCopy(source->IndexToWorld);
  this->Name = source->Name;
  this->ActiveVoxelCount = source->ActiveVoxelCount;
  this->GridClass = source->GridClass;
  std::copy(source->ValueRange, source->ValueRange + 2, this->ValueRange);
  this->Modified();
}

void vtkBrumeSparseVolume::ShallowCopy(vtkDataObject* source)
{
  this->Superclass::ShallowCopy(source);
  this->Share(vtkBrumeSparseVolume::SafeDownCast(source));
}

void vtkBrumeSparseVolume::DeepCopy(vtkDataObject* source)
{
  this->Superclass::DeepCopy(source);
  this->Share(vtkBrumeSparseVolume::SafeDownCast(source));
}

vtkBrumeSparseVolume* vtkBrumeSparseVolume::GetData(vtkInformation* information)
{
  return information
           ? vtkBrumeSparseVolume::SafeDownCast(information->Get(vtkDataObject::DATA_OBJECT()))
           : nullptr;
}

vtkBrumeSparseVolume* vtkBrumeSparseVolume::GetData(vtkInformationVector* vector, int port)
{
  return vtkBrumeSparseVolume::GetData(vector->GetInformationObject(port));
}

void vtkBrumeSparseVolume::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Name: " << (this->Name.empty() ? "(none)" : this->Name) << '\n';
  os << indent << "ActiveVoxelCount: " << this->ActiveVoxelCount << '\n';
  os << indent << "GridClass: " << this->GridClass << '\n';
  os << indent << "ValueRange: " << this->ValueRange[0] << ' ' << this->ValueRange[1] << '\n';
  os << indent << "IndexToWorld:\n";
  this->IndexToWorld->PrintSelf(os, indent.GetNextIndent());
  os << indent << "Voxels: ";
  if (!this->Voxels)
  {
    os << "(none)\n";
    return;
  }
  os << this->Voxels->places().size() << " bricks, " << this->Voxels->tiles().size()
     << " tiles in a box of";
  for (int axis = 0; axis < 3; ++axis)
  {
    os << (axis == 0 ? " " : " x ") << this->Voxels->dims()[axis] - this->Voxels->first()[axis];
  }
  os << " voxels, " << this->Voxels->memory_bytes() << " bytes\n";
}
