#include "cost_voxels.h"

#include "Transport/half.h"
#include "Transport/sparse_voxels.h"

#include "vtkBrumeFog.h"
#include "vtkBrumeMedium.h"
#include "vtkBrumeSky.h"
#include "vtkBrumeSparseVolume.h"

#include "vtkCamera.h"
#include "vtkColorTransferFunction.h"
#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkLightCollection.h"
#include "vtkMatrix3x3.h"
#include "vtkMatrix4x4.h"
#include "vtkNew.h"
#include "vtkPiecewiseFunction.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace brume::app
{

namespace
{

/// A stretch of values: y = (x − lower) · scale.
struct Stretch
{
  double lower = 0.0;
  double scale = 1.0;
};

vtkSmartPointer<vtkPiecewiseFunction> stretched(vtkPiecewiseFunction* function, const Stretch& s)
{
  auto result = vtkSmartPointer<vtkPiecewiseFunction>::New();
  result->SetClamping(function->GetClamping());
  for (int i = 0; i < function->GetSize(); ++i)
  {
    double node[4]; // x, y, midpoint, sharpness
    function->GetNodeValue(i, node);
    result->AddPoint((node[0] - s.lower) * s.scale, node[1], node[2], node[3]);
  }
  return result;
}

vtkSmartPointer<vtkColorTransferFunction> stretched(vtkColorTransferFunction* function, const Stretch& s)
{
  auto result = vtkSmartPointer<vtkColorTransferFunction>::New();
  result->SetClamping(function->GetClamping());
  result->SetColorSpace(function->GetColorSpace());
  for (int i = 0; i < function->GetSize(); ++i)
  {
    double node[6]; // x, r, g, b, midpoint, sharpness
    function->GetNodeValue(i, node);
    result->AddRGBPoint((node[0] - s.lower) * s.scale, node[1], node[2], node[3], node[4], node[5]);
  }
  return result;
}

/// The scene with a volume, a property and a medium of its own, of values stretched like that.
std::unique_ptr<VolumeScene> copy_of(const VolumeScene& scene, const Stretch& s)
{
  auto copy = std::make_unique<VolumeScene>(scene);
  vtkNew<vtkVolumeProperty> property;
  property->DeepCopy(scene.volume->GetProperty());
  if (!scene.options.density())
  {
    property->SetScalarOpacity(stretched(scene.volume->GetProperty()->GetScalarOpacity(), s));
    if (property->GetColorChannels() == 1)
    {
      property->SetColor(stretched(scene.volume->GetProperty()->GetGrayTransferFunction(), s));
    }
    else
    {
      property->SetColor(stretched(scene.volume->GetProperty()->GetRGBTransferFunction(), s));
    }
    if (!scene.volume->GetProperty()->GetDisableGradientOpacity())
    {
      property->SetGradientOpacity(
        stretched(scene.volume->GetProperty()->GetGradientOpacity(), { 0.0, s.scale }));
    }
  }
  copy->volume = vtkSmartPointer<vtkVolume>::New();
  copy->volume->SetProperty(property);
  for (double& e : copy->options.extinction)
  {
    e /= s.scale;
  }
  copy->medium = make_medium(copy->options.medium, copy->options.extinction);
  return copy;
}

/// The scalars as integers over the whole of their type.
template <class Integer>
std::unique_ptr<VolumeScene> with_integers(const VolumeScene& scene, int vtk_type)
{
  vtkDataArray* scalars = scene.input.image->GetPointData()->GetScalars();
  double range[2];
  scalars->GetFiniteRange(range);
  Stretch s;
  s.lower = scene.options.density() ? 0.0 : range[0]; // 0 is no matter, and stays 0
  constexpr double most = std::numeric_limits<Integer>::max();
  s.scale = range[1] > s.lower ? most / (range[1] - s.lower) : 1.0;
  std::unique_ptr<VolumeScene> copy = copy_of(scene, s);
  auto stored = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(vtk_type));
  stored->SetName(scalars->GetName() ? scalars->GetName() : "values");
  stored->SetNumberOfTuples(scalars->GetNumberOfTuples());
  auto* to = static_cast<Integer*>(stored->GetVoidPointer(0));
  for (vtkIdType i = 0; i < scalars->GetNumberOfTuples(); ++i)
  {
    const double value = (scalars->GetComponent(i, 0) - s.lower) * s.scale;
    to[i] = static_cast<Integer>(std::lround(std::isfinite(value) ? std::clamp(value, 0.0, most) : 0.0));
  }
  copy->input.image = vtkSmartPointer<vtkImageData>::New();
  copy->input.image->ShallowCopy(scene.input.image);
  copy->input.image->GetPointData()->SetScalars(stored);
  return copy;
}

std::unique_ptr<VolumeScene> with_floats(const VolumeScene& scene)
{
  vtkDataArray* scalars = scene.input.image->GetPointData()->GetScalars();
  std::unique_ptr<VolumeScene> copy = copy_of(scene, {});
  auto stored = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(VTK_FLOAT));
  stored->DeepCopy(scalars);
  copy->input.image = vtkSmartPointer<vtkImageData>::New();
  copy->input.image->ShallowCopy(scene.input.image);
  copy->input.image->GetPointData()->SetScalars(stored);
  return copy;
}

/// A dense image as a sparse volume of half precision, with voxels where any of a brick is not 0.
std::unique_ptr<VolumeScene> with_halves(const VolumeScene& scene, std::string& reason)
{
  vtkImageData* image = scene.input.image;
  vtkDataArray* scalars = image->GetPointData()->GetScalars();
  int dims[3];
  image->GetDimensions(dims);
  const auto at = [&](int i, int j, int k)
  {
    return i < dims[0] && j < dims[1] && k < dims[2]
      ? scalars->GetComponent((static_cast<vtkIdType>(k) * dims[1] + j) * dims[0] + i, 0)
      : 0.0;
  };
  for (int axis = 0; axis < 3; ++axis)
  {
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    int place[3];
    for (const int end : { 0, dims[axis] - 1 })
    {
      place[axis] = end;
      for (place[u] = 0; place[u] < dims[u]; ++place[u])
      {
        for (place[v] = 0; place[v] < dims[v]; ++place[v])
        {
          if (at(place[0], place[1], place[2]) != 0.0)
          {
            reason = "half precision is for sparse volumes, and the outermost voxels of this one are not empty";
            return nullptr;
          }
        }
      }
    }
  }
  constexpr int edge = SparseVoxels::brick_edge;
  SparseTopology topology;
  for (int k = 0; k < dims[2]; k += edge)
  {
    for (int j = 0; j < dims[1]; j += edge)
    {
      for (int i = 0; i < dims[0]; i += edge)
      {
        bool any = false;
        for (int n = 0; n < edge * edge * edge && !any; ++n)
        {
          any = at(i + n % edge, j + n / edge % edge, k + n / (edge * edge)) != 0.0;
        }
        if (any)
        {
          topology.bricks.push_back({ { i / edge, j / edge, k / edge } });
        }
      }
    }
  }
  if (topology.bricks.empty())
  {
    reason = "there is nothing in the volume";
    return nullptr;
  }
  const auto fill = [&](std::size_t index, void* voxels)
  {
    const BrickPlace& brick = topology.bricks[index];
    auto* to = static_cast<std::uint16_t*>(voxels);
    for (int n = 0; n < edge * edge * edge; ++n)
    {
      to[n] = half_from_float(static_cast<float>(at(
        edge * brick[0] + n % edge, edge * brick[1] + n / edge % edge, edge * brick[2] + n / (edge * edge))));
    }
  };
  vtkNew<vtkMatrix4x4> place;
  for (int row = 0; row < 3; ++row)
  {
    for (int column = 0; column < 3; ++column)
    {
      place->SetElement(row, column,
        image->GetDirectionMatrix()->GetElement(row, column) * image->GetSpacing()[column]);
    }
  }
  int extent[6];
  double first[3];
  image->GetExtent(extent);
  image->TransformIndexToPhysicalPoint(extent[0], extent[2], extent[4], first);
  for (int row = 0; row < 3; ++row)
  {
    place->SetElement(row, 3, first[row]);
  }
  std::unique_ptr<VolumeScene> copy = copy_of(scene, {});
  auto sparse = vtkSmartPointer<vtkBrumeSparseVolume>::New();
  sparse->SetVoxels(std::make_shared<SparseVoxels>(
    VoxelType::Float16, 0.0, topology, fill, scene.options.threads));
  sparse->SetIndexToWorld(place);
  copy->input.image = nullptr;
  copy->input.sparse = sparse;
  return copy;
}

/// A sparse volume in half precision.
std::unique_ptr<VolumeScene> with_sparse_halves(const VolumeScene& scene)
{
  const SparseVoxels& from = *scene.input.sparse->GetVoxels();
  SparseTopology topology;
  topology.bricks = from.places();
  for (std::size_t i = 0; i < from.tiles().size(); ++i)
  {
    const auto& box = from.tiles()[i];
    const auto& first = box.first;
    topology.tiles.push_back({ box.first, box.last,
      from.value(first[0] * SparseVoxels::brick_edge, first[1] * SparseVoxels::brick_edge,
        first[2] * SparseVoxels::brick_edge) });
  }
  const auto fill = [&](std::size_t index, void* voxels)
  {
    auto* to = static_cast<std::uint16_t*>(voxels);
    for (int n = 0; n < SparseVoxels::brick_voxels; ++n)
    {
      to[n] = half_from_float(
        static_cast<float>(from.value_in_slot(1 + from.tile_slots() + index, n)));
    }
  };
  auto voxels = std::make_shared<SparseVoxels>(
    VoxelType::Float16, from.background(), topology, fill, scene.options.threads);
  // The matrix is of the source's voxels: those of the copy are counted from where `from` begins.
  vtkNew<vtkMatrix4x4> place;
  place->DeepCopy(scene.input.sparse->GetIndexToWorld());
  double offset[4] = { 0.0, 0.0, 0.0, 0.0 };
  for (int axis = 0; axis < 3; ++axis)
  {
    offset[axis] = from.origin()[axis];
  }
  double moved[4];
  place->MultiplyPoint(offset, moved);
  for (int row = 0; row < 3; ++row)
  {
    place->SetElement(row, 3, place->GetElement(row, 3) + moved[row]);
  }
  std::unique_ptr<VolumeScene> copy = copy_of(scene, {});
  auto sparse = vtkSmartPointer<vtkBrumeSparseVolume>::New();
  sparse->SetVoxels(voxels);
  sparse->SetIndexToWorld(place);
  sparse->SetName(scene.input.sparse->GetName());
  copy->input.sparse = sparse;
  return copy;
}

std::unique_ptr<VolumeScene> refused(std::string& reason, const std::string& why)
{
  reason = why;
  return nullptr;
}

}

const char* voxel_store_name(VoxelStore store)
{
  switch (store)
  {
    case VoxelStore::Half:
      return "half";
    case VoxelStore::UInt16:
      return "uint16";
    case VoxelStore::UInt8:
      return "uint8";
    default:
      return "float";
  }
}

std::unique_ptr<VolumeScene> with_voxels(
  const VolumeScene& scene, VoxelStore store, std::string& reason)
{
  if (scene.input.sparse)
  {
    const VoxelType type = scene.input.sparse->GetVoxels()->type();
    return store != VoxelStore::Half || type != VoxelType::Float32
      ? refused(reason, "of a sparse volume in single precision, half precision alone is tried")
      : with_sparse_halves(scene);
  }
  vtkDataArray* scalars = scene.input.image->GetPointData()->GetScalars();
  if (!scalars || scalars->GetNumberOfComponents() != 1)
  {
    return refused(reason, "voxels of one component at points are stored anew, no others");
  }
  const int type = scalars->GetDataType();
  const bool real = type == VTK_FLOAT || type == VTK_DOUBLE;
  const int bytes = scalars->GetDataTypeSize();
  switch (store)
  {
    case VoxelStore::Float:
      return type == VTK_FLOAT ? refused(reason, "the voxels are float already") : with_floats(scene);
    case VoxelStore::Half:
      return real ? with_halves(scene, reason)
                  : refused(reason, "the voxels are integers, which half precision would round");
    case VoxelStore::UInt16:
      return real || bytes > 2 ? with_integers<std::uint16_t>(scene, VTK_UNSIGNED_SHORT)
                               : refused(reason, "the voxels are integers of 16 bits or less already");
    default:
      return real || bytes > 1 ? with_integers<std::uint8_t>(scene, VTK_UNSIGNED_CHAR)
                               : refused(reason, "the voxels are integers of 8 bits already");
  }
}

}
