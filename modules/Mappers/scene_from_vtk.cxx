#include "scene_from_vtk.h"

#include "classification_from_vtk.h"
#include "lights_from_vtk.h"
#include "regions_from_vtk.h"
#include "vtk_to_glm.h"

#include "vtkBrumeMedium.h"
#include "vtkBrumeSky.h"
#include "vtkContourValues.h"
#include "vtkImageData.h"
#include "vtkPlane.h"
#include "vtkVolume.h"
#include "vtkVolumeMapper.h"
#include "vtkVolumeProperty.h"

#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace brume
{

namespace
{

/// Nodes of a label's tables, of which there may be 255.
constexpr int label_table_nodes = 4097;

BlendMode blend_mode_from_vtk(int mode)
{
  switch (mode)
  {
    case vtkVolumeMapper::MAXIMUM_INTENSITY_BLEND:
      return BlendMode::MaximumIntensity;
    case vtkVolumeMapper::MINIMUM_INTENSITY_BLEND:
      return BlendMode::MinimumIntensity;
    case vtkVolumeMapper::AVERAGE_INTENSITY_BLEND:
      return BlendMode::AverageIntensity;
    case vtkVolumeMapper::ADDITIVE_BLEND:
      return BlendMode::Additive;
    case vtkVolumeMapper::ISOSURFACE_BLEND:
      return BlendMode::Isosurface;
    case vtkVolumeMapper::SLICE_BLEND:
      return BlendMode::Slice;
    default:
      return BlendMode::Composite;
  }
}

/// What the values are where they are a density; an extinction of 0 where they are classified.
Density density_of(const MatterSettings& matter)
{
  Density density;
  density.extinction = matter.extinction;
  const glm::dvec3 own =
    matter.medium ? to_glm(matter.medium->GetExtinction()) : glm::dvec3(0.0);
  const double largest = std::max({ own.x, own.y, own.z });
  if (largest > 0.0)
  {
    density.extinction = largest;
    density.channels = own / largest;
  }
  return density;
}
}

bool follows_medium(int blend_mode)
{
  return blend_mode_from_vtk(blend_mode) == BlendMode::Composite;
}

std::string SceneFromVTK::Update(vtkVolumeMapper* mapper,
  vtkVolume* volume,
  const MaskSettings& mask,
  const MatterSettings& settings,
  const ViewFromVTK& view)
{
  MatterSettings matter = settings;
  if (!follows_medium(mapper->GetBlendMode()))
  {
    matter.medium = nullptr;
  }
  // Volumes are kept by component; surfaces want the heaviest first.
  std::sort(this->TheScene.volumes.begin(), this->TheScene.volumes.end(),
    [](const Volume& a, const Volume& b) { return a.grid.component < b.grid.component; });
  vtkVolumeProperty* property = volume->GetProperty(); // made if there is none
  const char* array = matter.medium ? matter.medium->GetDensityArrayName() : nullptr;
  std::string wrong = this->Source.Update(mapper, property, array ? array : "", view.threads);
  if (wrong.empty() && mask.image && this->Source.GetGrid(0).sparse)
  {
    wrong = "a sparse volume cannot have a mask: call SetMaskInput(nullptr)";
  }
  if (wrong.empty())
  {
    wrong = this->Labels.Update(mask.image, this->Source.GetGrid(0));
  }
  if (matter.medium && matter.medium->GetBlackBody() > 0.0)
  {
    const char* temperatures = matter.medium->GetTemperatureArrayName();
    wrong = !wrong.empty() ? wrong
                           : this->Temperature.Update(mapper->GetDataObjectInput(),
                               temperatures ? temperatures : "",
                               this->Source.GetGrid(0));
  }
  else
  {
    this->Temperature.Clear();
  }
  if (wrong.empty())
  {
    wrong = this->UpdateMedia(property, mask, density_of(matter));
  }
  if (!wrong.empty())
  {
    return wrong;
  }

  Scene& scene = this->TheScene;
  vtkMatrix4x4* matrix = volume->GetMatrix();
  const glm::dmat4 world_from_data = matrix ? to_glm(matrix) : glm::dmat4(1.0);
  if (std::abs(glm::determinant(glm::dmat3(world_from_data))) == 0.0)
  {
    return "the volume's matrix flattens it: give the prop a scale that is not 0";
  }
  glm::dvec3 ambient;
  scene.lights = lights_from_vtk(view.lights, view.camera, ambient);
  const Cropping cropping = cropping_from_vtk(mapper, this->Source);
  const std::vector<glm::dvec4> planes = clipping_planes_from_vtk(mapper);
  for (int i = 0; i < this->Source.GetNumberOfVolumes(); ++i)
  {
    Volume& v = scene.volumes[i];
    v.data_from_index = this->Source.DataFromIndex;
    v.world_from_data = world_from_data;
    v.grid.linear = this->Source.GetGrid(i).linear;
    v.shading = shading_from_vtk(property, i, ambient, view.two_sided_lighting);
    v.shading.enabled = v.shading.enabled && v.meaning == ValueMeaning::Classified;
    v.cropping = cropping;
    v.clipping_planes = planes;
  }
  wrong = this->UpdateLight(matter.medium, matter.sky);
  if (!wrong.empty())
  {
    return wrong;
  }
  scene.mixture = Mixture::Components; // of one volume it means nothing
  scene.blend_mode = blend_mode_from_vtk(mapper->GetBlendMode());
  const double* average = mapper->GetAverageIPScalarRange();
  scene.average_range[0] = std::min(average[0], average[1]);
  scene.average_range[1] = std::max(average[0], average[1]);
  vtkContourValues* values = property->GetIsoSurfaceValues();
  scene.isosurfaces.assign(
    values->GetValues(), values->GetValues() + values->GetNumberOfContours());
  std::sort(scene.isosurfaces.begin(), scene.isosurfaces.end());
  if (scene.blend_mode == BlendMode::Slice)
  {
    auto* plane = vtkPlane::SafeDownCast(property->GetSliceFunction());
    if (!plane)
    {
      return "there is no plane to slice with: set one with vtkVolumeProperty::SetSliceFunction";
    }
    scene.slice = plane_from_vtk(plane);
  }
  if (scene.blend_mode == BlendMode::Isosurface || scene.blend_mode == BlendMode::Slice)
  {
    const auto lighter = [](const Volume& a, const Volume& b) { return a.weight < b.weight; };
    std::iter_swap(scene.volumes.begin(),
      std::max_element(scene.volumes.begin(), scene.volumes.end(), lighter));
  }
  scene.camera = camera_from_vtk(view.camera, static_cast<double>(view.width) / view.height);
  scene.surface_depth.clear();
  return {};
}

std::string SceneFromVTK::UpdateLight(vtkBrumeMedium* medium, vtkBrumeSky* sky)
{
  Scene& scene = this->TheScene;
  Medium matter;
  if (medium)
  {
    medium->FillMedium(matter);
    matter.temperature = this->Temperature.GetGrid();
  }
  for (Volume& volume : scene.volumes)
  {
    volume.medium = matter;
  }
  scene.sky = Sky();
  if (!medium || !sky)
  {
    return {};
  }
  sky->FillSky(scene.sky);
  return sky->AppendEnvironmentLights(scene.lights);
}

std::string SceneFromVTK::UpdateMedia(
  vtkVolumeProperty* property, const MaskSettings& mask, const Density& density)
{
  const int count = this->Source.GetNumberOfVolumes();
  // Asked first: where there is no function yet the property makes one, which modifies it.
  for (int i = 0; i < count; ++i)
  {
    property->GetScalarOpacity(i);
    property->GetColorChannels(i) == 1 ? static_cast<void>(property->GetGrayTransferFunction(i))
                                       : static_cast<void>(property->GetRGBTransferFunction(i));
  }
  std::vector<Volume>& volumes = this->TheScene.volumes;
  const bool voxels = this->Source.GetRevision() != this->LastVoxels || this->Labels.IsNew();
  if (voxels)
  {
    this->LastVoxels = 0; // until all is done
    volumes.assign(count, Volume());
    for (int i = 0; i < count; ++i)
    {
      volumes[i].grid = this->Source.GetGrid(i);
      volumes[i].ranges = this->Source.GetRanges(i);
      volumes[i].mask.labels = this->Labels.GetLabels();
      const bool first = volumes[i].grid.colour != VoxelColour::Value;
      std::copy_n(
        this->Source.GetRange(first ? 0 : volumes[i].grid.component), 2, volumes[i].grey_range);
      volumes[i].data_revision = next_revision();
    }
  }
  const MediumKey key{ property,
    static_cast<unsigned long>(property->GetMTime()),
    mask.image ? label_functions_time(property) : 0ul,
    this->Source.GetRevision(),
    mask.label_map,
    mask.image ? mask.blend_factor : 1.0,
    { density.extinction, density.channels.x, density.channels.y, density.channels.z },
    this->Temperature.GetRevision() };
  if (!voxels && key == this->LastMedium)
  {
    return {};
  }
  this->LastMedium = MediumKey{};
  const bool labels = this->DrawsLabels(property, mask);
  for (int i = 0; i < count; ++i)
  {
    const bool dense = density.extinction > 0.0;
    volumes[i].meaning = dense ? ValueMeaning::Density : ValueMeaning::Classified;
    volumes[i].density = density;
    volumes[i].classification = Classification();
    std::string wrong = dense
      ? std::string()
      : classification_from_vtk(property, this->Source, i, labels, volumes[i].classification);
    if (!wrong.empty())
    {
      return wrong;
    }
    // As in VTK, what there is one of has no weight.
    volumes[i].weight = count > 1 ? property->GetComponentWeight(i) : 1.0;
    volumes[i].medium_revision = next_revision();
  }
  this->UpdateLabels(property, mask);
  this->LastVoxels = this->Source.GetRevision();
  this->LastMedium = key;
  return {};
}

bool SceneFromVTK::DrawsLabels(vtkVolumeProperty* property, const MaskSettings& mask) const
{
  // Labels have one set of 1D functions: none for each of several independent components, and none
  // beside a 2D function.
  return this->Labels.GetLabels() && mask.label_map && mask.blend_factor > 0.0 &&
         this->Source.GetNumberOfVolumes() == 1 &&
         (property->GetTransferFunctionMode() == vtkVolumeProperty::TF_1D ||
           this->Source.GetMeaning() != GridFromVTK::Meaning::Independent);
}

void SceneFromVTK::UpdateLabels(vtkVolumeProperty* property, const MaskSettings& mask)
{
  for (Volume& volume : this->TheScene.volumes)
  {
    volume.label_classifications.clear();
    volume.mask.classification_of_label.fill(0);
    if (!mask.label_map)
    {
      volume.mask.classification_of_label[0] = Mask::hidden;
    }
  }
  if (!this->DrawsLabels(property, mask))
  {
    return;
  }
  Volume& volume = this->TheScene.volumes[0];
  const std::set<int> labels = property->GetLabelMapLabels();
  const bool own_gradients = property->HasLabelGradientOpacity();
  std::uint8_t others = 0;
  for (int label = 1; label < 256; ++label)
  {
    if (!this->Labels.GetPresent()[label])
    {
      continue;
    }
    std::uint8_t& classification = volume.mask.classification_of_label[label];
    const bool has = labels.count(label) > 0;
    if (!has && others)
    {
      classification = others;
      continue;
    }
    // Labels without any function share one: the volume's own functions, but for the gradient's,
    // which VTK keeps for label 0.
    if (!has && volume.classification.gradient_opacity.empty() && !own_gradients)
    {
      continue;
    }
    if (volume.label_classifications.size() == Mask::hidden - 1u)
    {
      break; // 254 sets of functions are all that a mask can tell apart
    }
    volume.label_classifications.push_back(label_classification_from_vtk(
      property, this->Source, label, mask.blend_factor, label_table_nodes));
    classification = static_cast<std::uint8_t>(volume.label_classifications.size());
    others = has ? others : classification;
  }
}

}
