#include "vtkBrumeVolumeMapper.h"

#include "scene_from_vtk.h"
#include "vtkBrumeFilmBlender.h"

#include "Transport/film.h"

#include "vtkCamera.h"
#include "vtkCommand.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkLightCollection.h"
#include "vtkNew.h"
#include "vtkPlaneCollection.h"
#include "vtkPointData.h"
#include "vtkPropCollection.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"

#include <chrono>
#include <cmath>
#include <new>
#include <set>
#include <stdexcept>

struct vtkBrumeVolumeMapper::Internals
{
  brume::SceneFromVTK Builder;
  vtkNew<vtkBrumeFilmBlender> Blender;
  brume::Film Film;
  vtkRenderWindow* Window = nullptr; ///< the window being drawn into, for its abort check
  std::set<std::string> Warned;      ///< settings that were warned of
};

vtkBrumeVolumeMapper::vtkBrumeVolumeMapper()
  : Statistics("{}")
  , Internal(std::make_unique<Internals>())
{
}

vtkBrumeVolumeMapper::~vtkBrumeVolumeMapper() = default;

bool vtkBrumeVolumeMapper::ReportProgress(double fraction)
{
  this->UpdateProgress(fraction);
  if (this->Internal->Window && this->Internal->Window->CheckAbortStatus())
  {
    return false;
  }
  return !this->GetAbortExecute();
}

const brume::Scene* vtkBrumeVolumeMapper::UpdateScene(
  vtkVolume* volume, vtkCamera* camera, vtkLightCollection* lights, int width, int height)
{
  return this->UpdateScene(
    volume, camera, lights, width, height, this->TwoSidedLighting != 0);
}

const brume::Scene* vtkBrumeVolumeMapper::UpdateScene(vtkVolume* volume, vtkCamera* camera,
  vtkLightCollection* lights, int width, int height, bool twoSidedLighting)
{
  if (!volume || !camera || width <= 0 || height <= 0)
  {
    vtkErrorMacro("A render needs a volume, a camera and a size of at least 1 x 1 pixels.");
    return nullptr;
  }
  const auto start = std::chrono::steady_clock::now();
  if (this->GetNumberOfInputConnections(0) > 0)
  {
    this->GetInputAlgorithm()->Update();
  }
  this->WarnOfIgnoredSettings(volume);
  std::string wrong;
  try
  {
    wrong = this->Internal->Builder.Update(
      this, volume, camera, lights, width, height, twoSidedLighting, this->NumberOfThreads);
  }
  catch (const std::bad_alloc&)
  {
    wrong = "out of memory: take a smaller volume";
  }
  catch (const std::invalid_argument& error)
  {
    wrong = error.what();
  }
  if (!wrong.empty())
  {
    vtkErrorMacro(<< wrong);
    return nullptr;
  }
  brume::Scene& scene = this->Internal->Builder.GetScene();
  scene.surface_depth.clear();
  this->SecondsScene =
    std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return &scene;
}

bool vtkBrumeVolumeMapper::RenderUpdated(brume::Scene& scene, brume::Film& film)
{
  this->SetAbortExecute(0);
  this->Statistics = "{}";
  this->InvokeEvent(vtkCommand::StartEvent);
  bool completed = false;
  try
  {
    completed = this->RenderScene(scene, film);
  }
  catch (const std::invalid_argument& error)
  {
    vtkErrorMacro(<< error.what());
  }
  catch (const std::bad_alloc&)
  {
    vtkErrorMacro("out of memory: take a smaller volume or picture");
  }
  this->InvokeEvent(vtkCommand::EndEvent);
  return completed;
}

bool vtkBrumeVolumeMapper::RenderFilm(
  vtkVolume* volume, vtkCamera* camera, vtkLightCollection* lights, brume::Film& film)
{
  if (!this->UpdateScene(volume, camera, lights, film.width, film.height))
  {
    return false;
  }
  this->Internal->Window = nullptr;
  return this->RenderUpdated(this->Internal->Builder.GetScene(), film);
}

bool vtkBrumeVolumeMapper::RenderImage(vtkVolume* volume, vtkCamera* camera,
  vtkLightCollection* lights, int width, int height, const double background[3],
  vtkImageData* image)
{
  if (!image || width <= 0 || height <= 0)
  {
    vtkErrorMacro("RenderImage needs an image and a size of at least 1 x 1 pixels.");
    return false;
  }
  brume::Film film(width, height);
  if (!this->RenderFilm(volume, camera, lights, film))
  {
    return false;
  }
  const std::vector<float> picture = brume::over_background(film, background);
  vtkNew<vtkFloatArray> rgb;
  rgb->SetName("rgb");
  rgb->SetNumberOfComponents(3);
  rgb->SetNumberOfTuples(static_cast<vtkIdType>(width) * height);
  std::copy(picture.begin(), picture.end(), rgb->GetPointer(0));
  image->Initialize();
  image->SetDimensions(width, height, 1);
  image->GetPointData()->SetScalars(rgb);
  return true;
}

void vtkBrumeVolumeMapper::ResetClippingRange(vtkVolume* volume, vtkCamera* camera)
{
  const double* bounds = volume->GetBounds();
  if (!bounds)
  {
    return;
  }
  double position[3];
  double direction[3];
  camera->GetPosition(position);
  camera->GetDirectionOfProjection(direction);
  double nearest = VTK_DOUBLE_MAX;
  double farthest = -VTK_DOUBLE_MAX;
  for (int corner = 0; corner < 8; ++corner)
  {
    double distance = 0.0;
    for (int axis = 0; axis < 3; ++axis)
    {
      const double at = bounds[2 * axis + ((corner >> axis) & 1)];
      distance += (at - position[axis]) * direction[axis];
    }
    nearest = std::min(nearest, distance);
    farthest = std::max(farthest, distance);
  }
  // A little room on both sides. Parallel views may begin behind the camera's place; perspective
  // ones in front of it, at a thousandth of the far distance at the least.
  const double margin = 0.01 * (farthest - nearest);
  nearest -= margin;
  farthest += margin;
  if (!camera->GetParallelProjection())
  {
    farthest = std::max(farthest, 1e-30);
    nearest = std::max(nearest, 1e-3 * farthest);
  }
  camera->SetClippingRange(nearest, farthest);
}

void vtkBrumeVolumeMapper::WarnOfIgnoredSettings(vtkVolume* volume)
{
  this->IgnoredSettings.clear();
  const auto ignored = [this](bool is, const char* setting)
  {
    if (is)
    {
      this->IgnoredSettings.emplace_back(setting);
    }
  };
  vtkVolumeProperty* property = volume->GetProperty();
  ignored(this->GetBlendMode() != vtkVolumeMapper::COMPOSITE_BLEND,
    "BlendMode other than COMPOSITE_BLEND");
  ignored(this->GetCropping() != 0, "Cropping");
  ignored(this->GetClippingPlanes() && this->GetClippingPlanes()->GetNumberOfItems() > 0,
    "ClippingPlanes");
  ignored(property->GetTransferFunctionMode() == vtkVolumeProperty::TF_2D,
    "TransferFunctionMode TF_2D");
  for (const std::string& setting : this->IgnoredSettings)
  {
    if (this->Internal->Warned.insert(setting).second)
    {
      vtkWarningMacro(<< setting << " is not supported and is ignored.");
    }
  }
}

void vtkBrumeVolumeMapper::ReadSurfaceDepth(vtkRenderer* renderer, brume::Scene& scene,
  const brume::Film& film, int left, int bottom) const
{
  // Only where something else is shown that may have written depth.
  vtkPropCollection* props = renderer->GetViewProps();
  vtkCollectionSimpleIterator it;
  bool others = renderer->GetPreserveDepthBuffer() || renderer->GetLayer() > 0;
  props->InitTraversal(it);
  while (vtkProp* prop = props->GetNextProp(it))
  {
    others = others || (prop->GetVisibility() && !vtkVolume::SafeDownCast(prop));
  }
  if (!others)
  {
    return;
  }
  scene.surface_depth.resize(film.size());
  renderer->GetRenderWindow()->GetZbufferData(left, bottom, left + film.width - 1,
    bottom + film.height - 1, scene.surface_depth.data());
  for (float& depth : scene.surface_depth)
  {
    depth = 2.0f * depth - 1.0f; // the depth buffer's [0, 1] to the clip cube's [-1, 1]
  }
}

void vtkBrumeVolumeMapper::Render(vtkRenderer* renderer, vtkVolume* volume)
{
  const auto start = std::chrono::steady_clock::now();
  int width = 0;
  int height = 0;
  int left = 0;
  int bottom = 0;
  renderer->GetTiledSizeAndOrigin(&width, &height, &left, &bottom);
  if (width <= 0 || height <= 0)
  {
    return;
  }
  if (!this->UpdateScene(volume, renderer->GetActiveCamera(), renderer->GetLights(), width, height,
        renderer->GetTwoSidedLighting() != 0))
  {
    return;
  }
  brume::Film& film = this->Internal->Film;
  if (film.width != width || film.height != height)
  {
    film = brume::Film(width, height);
  }
  brume::Scene& scene = this->Internal->Builder.GetScene();
  this->ReadSurfaceDepth(renderer, scene, film, left, bottom);
  this->Internal->Window = renderer->GetRenderWindow();
  const bool completed = this->RenderUpdated(scene, film);
  this->Internal->Window = nullptr;
  if (completed && !this->Internal->Blender->Blend(film, renderer))
  {
    vtkErrorMacro("The picture was not shown: the render window is not an OpenGL window.");
  }
  this->TimeToDraw =
    std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void vtkBrumeVolumeMapper::ReleaseGraphicsResources(vtkWindow* window)
{
  this->Internal->Blender->ReleaseGraphicsResources(window);
}

void vtkBrumeVolumeMapper::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Tolerance: " << this->Tolerance << "\n";
  os << indent << "NumberOfThreads: " << this->NumberOfThreads << "\n";
  os << indent << "TwoSidedLighting: " << (this->TwoSidedLighting ? "On" : "Off") << "\n";
  os << indent << "Statistics: " << this->Statistics << "\n";
}
