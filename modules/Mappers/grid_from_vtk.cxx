#include "grid_from_vtk.h"

#include "vtk_to_glm.h"

#include "Transport/sparse_voxels.h"

#include "vtkBrumeSparseVolume.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkMatrix3x3.h"
#include "vtkMatrix4x4.h"
#include "vtkPointData.h"
#include "vtkVolumeMapper.h"
#include "vtkVolumeProperty.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <limits>

namespace brume
{

std::uint64_t next_revision()
{
  static std::atomic<std::uint64_t> last{ 0 };
  return ++last;
}

std::string array_names(vtkImageData* image, bool cells)
{
  vtkDataSetAttributes* arrays = cells ? static_cast<vtkDataSetAttributes*>(image->GetCellData())
                                       : static_cast<vtkDataSetAttributes*>(image->GetPointData());
  std::string names;
  for (int i = 0; i < arrays->GetNumberOfArrays(); ++i)
  {
    if (const char* name = arrays->GetArrayName(i))
    {
      names += (names.empty() ? "" : ", ") + std::string(name);
    }
  }
  return names.empty() ? "none that has a name" : names;
}

namespace
{

/// The voxel type that is read in place, or Float32 and `converts` for those that are not.
VoxelType voxel_type(int vtkType, bool& converts)
{
  converts = false;
  switch (vtkType)
  {
    case VTK_UNSIGNED_CHAR:
      return VoxelType::UInt8;
    case VTK_CHAR:
    case VTK_SIGNED_CHAR:
      return VoxelType::Int8;
    case VTK_UNSIGNED_SHORT:
      return VoxelType::UInt16;
    case VTK_SHORT:
      return VoxelType::Int16;
    case VTK_FLOAT:
      return VoxelType::Float32;
    default:
      converts = true;
      return VoxelType::Float32;
  }
}

/// Numbers beyond the largest float count as that; infinities stay what they are.
float nearest_float(double value)
{
  constexpr double most = std::numeric_limits<float>::max();
  return static_cast<float>(std::isinf(value) ? value : std::min(std::max(value, -most), most));
}

}

std::string GridFromVTK::Update(vtkVolumeMapper* mapper,
  vtkVolumeProperty* property,
  const std::string& array,
  int threads)
{
  this->TheGrid.linear = property->GetInterpolationType() != VTK_NEAREST_INTERPOLATION;
  vtkDataObject* input = mapper->GetDataObjectInput();
  if (auto* sparse = vtkBrumeSparseVolume::SafeDownCast(input))
  {
    return array.empty() ? this->UpdateSparse(sparse, threads)
                         : "a sparse volume has one grid and no array '" + array +
                             "': call vtkBrumeMedium::SetDensityArrayName(nullptr)";
  }
  if (auto* image = vtkImageData::SafeDownCast(input))
  {
    int cells = 0;
    vtkDataArray* scalars = array.empty() ? vtkAbstractMapper::GetScalars(image,
                                              mapper->GetScalarMode(),
                                              mapper->GetArrayAccessMode(),
                                              mapper->GetArrayId(),
                                              mapper->GetArrayName(),
                                              cells)
                                          : image->GetPointData()->GetArray(array.c_str());
    if (!array.empty() && !scalars)
    {
      return "the input's points have no array '" + array +
             "': give vtkBrumeMedium::SetDensityArrayName one of theirs: " +
             array_names(image, false);
    }
    return this->UpdateImage(image, scalars, cells == 1, property, threads);
  }
  return "there is no image data to draw: connect a vtkImageData or a vtkBrumeSparseVolume to the "
         "mapper";
}

std::string GridFromVTK::UpdateSparse(vtkBrumeSparseVolume* volume, int threads)
{
  if (!volume->GetVoxels())
  {
    return "the sparse volume has no voxels: see whether its reader failed";
  }
  // Place: cheap, so always made anew.
  const SparseVoxels& voxels = *volume->GetVoxels();
  glm::dmat4 shift(1.0);
  volume->GetSpacing(this->Spacing);
  for (int axis = 0; axis < 3; ++axis)
  {
    this->First[axis] = voxels.origin()[axis];
    this->Origin[axis] = volume->GetIndexToWorld()->GetElement(axis, 3);
    shift[3][axis] = this->First[axis];
    for (int row = 0; row < 3; ++row)
    {
      this->Direction[3 * row + axis] =
        volume->GetIndexToWorld()->GetElement(row, axis) / this->Spacing[axis];
    }
  }
  this->DataFromIndex = to_glm(volume->GetIndexToWorld()) * shift;
  const DataKey key{ volume, static_cast<unsigned long>(volume->GetMTime()), 0, 0, 0, 0, 0, 0 };
  if (key == this->LastData && this->Sparse == volume->GetVoxels())
  {
    return {};
  }
  this->LastData = DataKey{}; // until all is done: memory may run out on the way
  this->TheMeaning = Meaning::Independent;
  this->Converted.clear();
  this->Sparse = volume->GetVoxels();
  const bool linear = this->TheGrid.linear;
  this->TheGrid = voxels.grid();
  this->TheGrid.linear = linear;
  this->MeasureRanges(threads);
  this->LastData = key;
  this->Revision = next_revision();
  return {};
}

std::string GridFromVTK::UpdateImage(vtkImageData* image,
  vtkDataArray* scalars,
  bool cells,
  vtkVolumeProperty* property,
  int threads)
{
  if (!scalars || scalars->GetNumberOfTuples() == 0)
  {
    return "the input has no scalars: name an array with SelectScalarArray and SetScalarMode";
  }
  const int components = scalars->GetNumberOfComponents();
  Meaning meaning = Meaning::Independent;
  if (components > 1 && !property->GetIndependentComponents())
  {
    meaning = components == 2 ? Meaning::ColourOpacity : Meaning::RGBOpacity;
    if (components != 2 && (components != 4 || scalars->GetDataType() != VTK_UNSIGNED_CHAR))
    {
      return "dependent scalars of " + std::to_string(components) +
             " components are not drawn: take 2 of any type, 4 of unsigned char, or "
             "IndependentComponentsOn";
    }
  }
  if (components > VTK_MAX_VRCOMP)
  {
    return "scalars of " + std::to_string(components) +
           " components are not drawn: take at most 4 (vtkImageExtractComponents)";
  }

  int extent[6];
  image->GetExtent(extent);
  int dims[3];
  vtkIdType voxels = 1;
  for (int axis = 0; axis < 3; ++axis)
  {
    dims[axis] = extent[2 * axis + 1] - extent[2 * axis] + (cells ? 0 : 1);
    voxels *= dims[axis];
  }
  if (voxels <= 0)
  {
    return "the input has no voxels: check its extent";
  }
  if (voxels != scalars->GetNumberOfTuples())
  {
    return "the scalars are " + std::to_string(scalars->GetNumberOfTuples()) + " values for " +
           std::to_string(voxels) + " voxels: give one to each";
  }
  std::string wrong = this->UpdatePlace(image, extent, cells); // cheap, so always made anew
  if (!wrong.empty())
  {
    return wrong;
  }

  const DataKey key{ scalars,
    static_cast<unsigned long>(scalars->GetMTime()),
    static_cast<unsigned long>(image->GetMTime()),
    dims[0],
    dims[1],
    dims[2],
    cells,
    static_cast<int>(meaning) };
  if (key == this->LastData)
  {
    return {};
  }
  this->LastData = DataKey{}; // until all is done: memory may run out on the way
  this->TheMeaning = meaning;
  this->Sparse.reset();
  const bool linear = this->TheGrid.linear;
  this->TheGrid = Grid();
  this->TheGrid.linear = linear;
  this->ReadVoxels(scalars, dims, cells);
  this->MeasureRanges(threads);
  this->LastData = key;
  this->Revision = next_revision();
  return {};
}

std::string GridFromVTK::UpdatePlace(vtkImageData* image, const int extent[6], bool cells)
{
  image->GetSpacing(this->Spacing);
  image->GetOrigin(this->Origin);
  glm::dmat4 shift(1.0);
  for (int axis = 0; axis < 3; ++axis)
  {
    this->Spacing[axis] = std::abs(this->Spacing[axis]);
    if (!(this->Spacing[axis] > 0.0) || !std::isfinite(this->Spacing[axis]))
    {
      return "the input's spacing must not be 0: set it with vtkImageData::SetSpacing";
    }
    if (!std::isfinite(this->Origin[axis]))
    {
      return "the input's origin is not finite: set it with vtkImageData::SetOrigin";
    }
    this->First[axis] = extent[2 * axis] + (cells ? 0.5 : 0.0);
    shift[3][axis] = this->First[axis];
  }
  const double* direction = image->GetDirectionMatrix()->GetData();
  const double* spacing = image->GetSpacing();
  for (int i = 0; i < 9; ++i)
  {
    // A negative spacing is a direction turned round.
    this->Direction[i] = spacing[i % 3] < 0.0 ? -direction[i] : direction[i];
  }
  this->DataFromIndex = to_glm(image->GetIndexToPhysicalMatrix()) * shift;
  return {};
}

void GridFromVTK::ReadVoxels(vtkDataArray* scalars, const int dims[3], bool cells)
{
  Grid& grid = this->TheGrid;
  bool converts = false;
  grid.type = voxel_type(scalars->GetDataType(), converts);
  grid.components = scalars->GetNumberOfComponents();
  grid.cell_centred = cells;
  grid.padding_x = dims[0] == 1 ? 1 : 0;
  std::copy(dims, dims + 3, grid.dims);
  grid.dims[0] += grid.padding_x;
  this->Converted.clear();
  const bool rgb = this->TheMeaning == Meaning::RGBOpacity;
  if (!rgb && (!scalars->HasStandardMemoryLayout() || grid.bytes() < 4))
  {
    // Kernels read 4 bytes at a time: the smallest grids are read as floats.
    converts = true;
    grid.type = VoxelType::Float32;
  }
  if (!converts && !grid.padding_x && scalars->HasStandardMemoryLayout())
  {
    grid.voxels = scalars->GetVoidPointer(0);
    return;
  }
  // One voxel along x becomes two alike, so that pairs can be read.
  const int copies = 1 + grid.padding_x;
  const std::size_t voxelBytes = size_of(grid.type) * grid.components;
  const vtkIdType voxels = scalars->GetNumberOfTuples();
  this->Converted.resize(voxels * copies * voxelBytes);
  unsigned char* out = this->Converted.data();
  const auto* in =
    converts ? nullptr : static_cast<const unsigned char*>(scalars->GetVoidPointer(0));
  std::vector<float> voxel(grid.components);
  for (vtkIdType i = 0; i < voxels; ++i)
  {
    const void* from = in ? static_cast<const void*>(in + i * voxelBytes) : voxel.data();
    for (int c = 0; !in && c < grid.components; ++c)
    {
      voxel[c] = nearest_float(scalars->GetComponent(i, c));
    }
    for (int copy = 0; copy < copies; ++copy, out += voxelBytes)
    {
      std::memcpy(out, from, voxelBytes);
    }
  }
  grid.voxels = this->Converted.data();
}

Grid GridFromVTK::GetGrid(int volume) const
{
  Grid grid = this->TheGrid;
  switch (this->TheMeaning)
  {
    case Meaning::Independent:
      grid.component = volume;
      grid.colour = VoxelColour::Value;
      break;
    case Meaning::ColourOpacity:
      grid.component = 1;
      grid.colour = VoxelColour::First;
      break;
    case Meaning::RGBOpacity:
      grid.component = 3;
      grid.colour = VoxelColour::RGB;
      break;
  }
  return grid;
}

void GridFromVTK::MeasureRanges(int threads)
{
  for (int c = 0; c < 4; ++c)
  {
    this->Ranges[c].reset();
    this->Range[c][0] = this->Range[c][1] = 0.0;
    // Of RGBOpacity the value and, for projections, the first colour are asked for.
    if (c >= this->TheGrid.components || (this->TheMeaning == Meaning::RGBOpacity && c % 3))
    {
      continue;
    }
    Grid grid = this->TheGrid;
    grid.component = c;
    grid.colour = VoxelColour::Value;
    this->Ranges[c] = std::make_shared<const BrickRanges>(measure_bricks(grid, threads));
    if (this->Ranges[c]->lower <= this->Ranges[c]->upper) // else not one finite value
    {
      this->Range[c][0] = this->Ranges[c]->lower;
      this->Range[c][1] = this->Ranges[c]->upper;
    }
  }
}

}
