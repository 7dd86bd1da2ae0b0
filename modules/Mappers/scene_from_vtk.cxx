#include "scene_from_vtk.h"

#include "Transport/bricks.h"

#include "vtkCamera.h"
#include "vtkColorTransferFunction.h"
#include "vtkDataArray.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkLight.h"
#include "vtkLightCollection.h"
#include "vtkMatrix3x3.h"
#include "vtkMatrix4x4.h"
#include "vtkPiecewiseFunction.h"
#include "vtkVolume.h"
#include "vtkVolumeMapper.h"
#include "vtkVolumeProperty.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace brume
{

namespace
{

/// Nodes of the transfer functions' tables: fine enough to be the truth's.
constexpr int table_nodes = 65537;

glm::dmat4 to_glm(vtkMatrix4x4* m)
{
  glm::dmat4 result;
  for (int row = 0; row < 4; ++row)
  {
    for (int column = 0; column < 4; ++column)
    {
      result[column][row] = m->GetElement(row, column);
    }
  }
  return result;
}

glm::dvec3 to_glm(const double v[3])
{
  return { v[0], v[1], v[2] };
}

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

/// Where a light shines from and to in the world, headlights and camera lights included.
void light_in_world(vtkLight* light, vtkCamera* camera, glm::dvec3& position, glm::dvec3& focal)
{
  if (light->LightTypeIsHeadlight())
  {
    position = to_glm(camera->GetPosition());
    focal = to_glm(camera->GetFocalPoint());
    return;
  }
  position = to_glm(light->GetPosition());
  focal = to_glm(light->GetFocalPoint());
  vtkMatrix4x4* transform = light->LightTypeIsCameraLight()
    ? camera->GetCameraLightTransformMatrix()
    : light->GetTransformMatrix();
  if (transform)
  {
    const glm::dmat4 m = to_glm(transform);
    position = glm::dvec3(m * glm::dvec4(position, 1.0));
    focal = glm::dvec3(m * glm::dvec4(focal, 1.0));
  }
}

Light headlight(vtkCamera* camera)
{
  Light light;
  light.direction = to_glm(camera->GetDirectionOfProjection());
  return light;
}

}

std::string SceneFromVTK::Update(vtkVolumeMapper* mapper, vtkVolume* volume, vtkCamera* camera,
  vtkLightCollection* lights, int width, int height, bool twoSidedLighting, int threads)
{
  this->NumberOfThreads = threads;
  vtkVolumeProperty* property = volume->GetProperty(); // made if there is none
  std::string wrong = this->UpdateGrid(mapper, property);
  if (wrong.empty())
  {
    wrong = this->UpdateClassification(property);
  }
  if (!wrong.empty())
  {
    return wrong;
  }
  vtkMatrix4x4* matrix = volume->GetMatrix();
  this->TheScene.volumes[0].world_from_data = matrix ? to_glm(matrix) : glm::dmat4(1.0);
  if (std::abs(glm::determinant(glm::dmat3(this->TheScene.volumes[0].world_from_data))) == 0.0)
  {
    return "the volume's matrix flattens it: give the prop a scale that is not 0";
  }
  this->UpdateShading(property, lights, camera, twoSidedLighting);
  this->UpdateCamera(camera, static_cast<double>(width) / height);
  return {};
}

std::string SceneFromVTK::UpdateGrid(vtkVolumeMapper* mapper, vtkVolumeProperty* property)
{
  auto* image = vtkImageData::SafeDownCast(mapper->GetDataSetInput());
  if (!image)
  {
    return "there is no image data to draw: connect a vtkImageData to the mapper";
  }
  int cellFlag = 0;
  vtkDataArray* scalars = vtkAbstractMapper::GetScalars(image, mapper->GetScalarMode(),
    mapper->GetArrayAccessMode(), mapper->GetArrayId(), mapper->GetArrayName(), cellFlag);
  if (!scalars || scalars->GetNumberOfTuples() == 0)
  {
    return "the input has no scalars: name an array with SelectScalarArray and SetScalarMode";
  }
  const int components = scalars->GetNumberOfComponents();
  const bool rgba = components == 4 && !property->GetIndependentComponents() &&
    scalars->GetDataType() == VTK_UNSIGNED_CHAR;
  if (components != 1 && !rgba)
  {
    return "scalars of " + std::to_string(components) +
      " components are not drawn: take one component (vtkImageExtractComponents), or 4 of "
      "unsigned char with IndependentComponentsOff";
  }

  int extent[6];
  image->GetExtent(extent);
  const bool cells = cellFlag == 1;
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

  // Place: cheap, so always made anew.
  image->GetSpacing(this->Spacing);
  glm::dmat4 shift(1.0);
  for (int axis = 0; axis < 3; ++axis)
  {
    this->Spacing[axis] = std::abs(this->Spacing[axis]);
    if (!(this->Spacing[axis] > 0.0) || !std::isfinite(this->Spacing[axis]))
    {
      return "the input's spacing must not be 0: set it with vtkImageData::SetSpacing";
    }
    shift[3][axis] = extent[2 * axis] + (cells ? 0.5 : 0.0);
  }
  this->TheScene.volumes[0].data_from_index = to_glm(image->GetIndexToPhysicalMatrix()) * shift;

  Grid& grid = this->TheScene.volumes[0].grid;
  grid.linear = property->GetInterpolationType() != VTK_NEAREST_INTERPOLATION;
  const DataKey key{ scalars, static_cast<unsigned long>(scalars->GetMTime()),
    static_cast<unsigned long>(image->GetMTime()), dims[0], dims[1], dims[2], cells };
  if (key == this->LastData)
  {
    return {};
  }

  this->LastData = DataKey{}; // until all is done: memory may run out on the way
  bool converts = false;
  grid.type = voxel_type(scalars->GetDataType(), converts);
  grid.components = components;
  grid.component = components - 1;
  grid.colour = rgba ? VoxelColour::RGB : VoxelColour::Value;
  grid.cell_centred = cells;
  grid.padding_x = dims[0] == 1 ? 1 : 0;
  std::copy(dims, dims + 3, grid.dims);
  grid.dims[0] += grid.padding_x;
  this->Converted.clear();
  if (!scalars->HasStandardMemoryLayout() || grid.bytes() < 4)
  {
    // Kernels read 4 bytes at a time: the smallest grids are read as floats.
    converts = converts || components == 1;
    grid.type = converts ? VoxelType::Float32 : grid.type;
  }
  const std::size_t voxelBytes = size_of(grid.type) * components;
  if (converts || grid.padding_x || !scalars->HasStandardMemoryLayout())
  {
    // One voxel along x becomes two alike, so that pairs can be read.
    const int copies = 1 + grid.padding_x;
    this->Converted.resize(voxels * copies * voxelBytes);
    unsigned char* out = this->Converted.data();
    const auto* in = converts
      ? nullptr
      : static_cast<const unsigned char*>(scalars->GetVoidPointer(0));
    for (vtkIdType i = 0; i < voxels; ++i)
    {
      for (int copy = 0; copy < copies; ++copy, out += voxelBytes)
      {
        if (in)
        {
          std::memcpy(out, in + i * voxelBytes, voxelBytes);
          continue;
        }
        const float value = static_cast<float>(scalars->GetComponent(i, 0));
        std::memcpy(out, &value, sizeof(value));
      }
    }
    grid.voxels = this->Converted.data();
  }
  else
  {
    grid.voxels = scalars->GetVoidPointer(0);
  }
  this->LastData = key;
  ++this->TheScene.volumes[0].data_revision;
  this->MeasureRange();
  return {};
}

void SceneFromVTK::MeasureRange()
{
  auto ranges = std::make_shared<const BrickRanges>(
    measure_bricks(this->TheScene.volumes[0].grid, this->NumberOfThreads));
  const bool some = ranges->lower <= ranges->upper; // else not one finite voxel
  this->Range[0] = some ? ranges->lower : 0.0;
  this->Range[1] = some ? ranges->upper : 0.0;
  this->TheScene.volumes[0].ranges = std::move(ranges);
}

std::string SceneFromVTK::UpdateClassification(vtkVolumeProperty* property)
{
  // Asked first: where there is no function yet the property makes one, which modifies it.
  vtkPiecewiseFunction* opacity = property->GetScalarOpacity(0);
  const bool gray = property->GetColorChannels(0) == 1;
  vtkPiecewiseFunction* grayFunction = gray ? property->GetGrayTransferFunction(0) : nullptr;
  vtkColorTransferFunction* rgbFunction = gray ? nullptr : property->GetRGBTransferFunction(0);
  const MediumKey key{ property, static_cast<unsigned long>(property->GetMTime()),
    this->TheScene.volumes[0].data_revision };
  if (key == this->LastMedium)
  {
    return {};
  }
  Classification c;
  c.unit_distance = property->GetScalarOpacityUnitDistance(0);
  if (!(c.unit_distance > 0.0))
  {
    return "the scalar opacity unit distance must be positive: set it with "
           "vtkVolumeProperty::SetScalarOpacityUnitDistance";
  }
  c.lower = this->Range[0];
  c.upper = this->Range[1];
  // Where the functions are constant beyond their end nodes, the table need not go there: its nodes
  // are better spent between.
  double ends[2];
  double colourEnds[2];
  opacity->GetRange(ends);
  gray ? grayFunction->GetRange(colourEnds) : rgbFunction->GetRange(colourEnds);
  const bool clamped = opacity->GetClamping() &&
    (gray ? grayFunction->GetClamping() : rgbFunction->GetClamping());
  const bool coloured = this->TheScene.volumes[0].grid.components == 1;
  if (clamped && opacity->GetSize() > 0)
  {
    const double low = coloured ? std::min(ends[0], colourEnds[0]) : ends[0];
    const double high = coloured ? std::max(ends[1], colourEnds[1]) : ends[1];
    const double lower = std::max(c.lower, low);
    const double upper = std::min(c.upper, high);
    if (lower < upper)
    {
      c.lower = lower;
      c.upper = upper;
    }
  }
  if (!(c.lower < c.upper))
  {
    // A constant volume: any range around the value will do.
    const double margin = std::max(1.0, std::abs(c.lower)) * 1e-3;
    c.lower -= margin;
    c.upper += margin;
  }
  c.opacity.resize(table_nodes);
  opacity->GetTable(c.lower, c.upper, table_nodes, c.opacity.data());
  if (coloured)
  {
    c.rgb.resize(3 * table_nodes);
    if (gray)
    {
      std::vector<double> values(table_nodes);
      grayFunction->GetTable(c.lower, c.upper, table_nodes, values.data());
      for (int i = 0; i < 3 * table_nodes; ++i)
      {
        c.rgb[i] = values[i / 3];
      }
    }
    else
    {
      rgbFunction->GetTable(c.lower, c.upper, table_nodes, c.rgb.data());
      if (rgbFunction->GetSize() == 1 && rgbFunction->GetClamping())
      {
        // VTK's table is black where it hits the place of a single point.
        double node[6];
        rgbFunction->GetNodeValue(0, node);
        for (int i = 0; i < 3 * table_nodes; ++i)
        {
          c.rgb[i] = node[1 + i % 3];
        }
      }
    }
  }
  if (!property->GetDisableGradientOpacity(0) && property->HasGradientOpacity(0))
  {
    // A central difference is at most half the range of values along each axis.
    const double steepest = 0.5 * (this->Range[1] - this->Range[0]) * std::sqrt(3.0);
    const double mean = (this->Spacing[0] + this->Spacing[1] + this->Spacing[2]) / 3.0;
    const double finest = *std::min_element(this->Spacing, this->Spacing + 3);
    c.gradient_upper = std::max(steepest * mean / finest, 1e-30);
    c.gradient_scale = to_glm(this->Spacing) / mean;
    c.gradient_opacity.resize(table_nodes);
    property->GetGradientOpacity(0)->GetTable(
      0.0, c.gradient_upper, table_nodes, c.gradient_opacity.data());
    // VTK's default function is 1 everywhere: no gradient opacity at all.
    if (std::all_of(c.gradient_opacity.begin(), c.gradient_opacity.end(),
          [](double factor) { return factor >= 1.0; }))
    {
      c.gradient_opacity.clear();
    }
  }
  this->TheScene.volumes[0].meaning = ValueMeaning::Classified;
  this->TheScene.volumes[0].classification = std::move(c);
  this->LastMedium = key;
  ++this->TheScene.volumes[0].medium_revision;
  return {};
}

void SceneFromVTK::UpdateShading(vtkVolumeProperty* property, vtkLightCollection* lights,
  vtkCamera* camera, bool twoSidedLighting)
{
  Shading& shading = this->TheScene.volumes[0].shading;
  shading.enabled = property->GetShade(0) != 0;
  shading.ambient = property->GetAmbient(0);
  shading.diffuse = property->GetDiffuse(0);
  shading.specular = property->GetSpecular(0);
  shading.specular_power = property->GetSpecularPower(0);
  shading.two_sided = twoSidedLighting;
  shading.ambient_light = glm::dvec3(0.0);
  std::vector<Light>& list = this->TheScene.lights;
  list.clear();
  if (!lights || lights->GetNumberOfItems() == 0)
  {
    list.push_back(headlight(camera));
  }
  else
  {
    vtkCollectionSimpleIterator it;
    lights->InitTraversal(it);
    while (vtkLight* light = lights->GetNextLight(it))
    {
      if (!light->GetSwitch())
      {
        continue;
      }
      Light l;
      const double intensity = light->GetIntensity();
      l.diffuse = to_glm(light->GetDiffuseColor()) * intensity;
      l.specular = to_glm(light->GetSpecularColor()) * intensity;
      glm::dvec3 focal;
      light_in_world(light, camera, l.position, focal);
      const glm::dvec3 way = focal - l.position;
      l.direction = glm::length(way) > 0.0 ? glm::normalize(way)
                                           : to_glm(camera->GetDirectionOfProjection());
      l.positional = light->GetPositional() != 0;
      l.attenuation = to_glm(light->GetAttenuationValues());
      l.cone_angle = light->GetConeAngle();
      l.exponent = light->GetExponent();
      shading.ambient_light += to_glm(light->GetAmbientColor()) * intensity;
      list.push_back(l);
    }
  }
  if (shading.ambient_light == glm::dvec3(0.0))
  {
    // VTK's lights give no ambient light by themselves; its GPU mapper then takes white.
    shading.ambient_light = glm::dvec3(1.0);
  }
}

void SceneFromVTK::UpdateCamera(vtkCamera* camera, double aspect)
{
  this->TheScene.camera.clip_from_world =
    to_glm(camera->GetCompositeProjectionTransformMatrix(aspect, -1.0, 1.0));
  this->TheScene.camera.direction = to_glm(camera->GetDirectionOfProjection());
}

}
