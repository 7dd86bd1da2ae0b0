#include "vtkBrumeVolumeMapper.h"

#include "fog_from_vtk.h"
#include "fog_internals.h"
#include "ignored_settings.h"
#include "image_sampling.h"
#include "scene_from_vtk.h"
#include "surface_depth.h"
#include "volume_group.h"
#include "vtkBrumeFilmBlender.h"

#include "Transport/marcher.h"
#include "Transport/film.h"

#include "vtkBrumeEffectPlan.h"
#include "vtkBrumeMedium.h"
#include "vtkBrumeSky.h"
#include "vtkBrumeSparseVolume.h"

#include "vtkCamera.h"
#include "vtkCommand.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkLightCollection.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPropCollection.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkSmartPointer.h"
#include "vtkVolume.h"
#include "vtkVolumeCollection.h"
#include "vtkVolumeProperty.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <new>
#include <set>
#include <stdexcept>
#include <utility>

struct vtkBrumeVolumeMapper::Internals
{
  brume::SceneFromVTK Builder;
  brume::Scene Together; ///< this mapper's scene and others', where volumes are drawn as one
  brume::DrawnWithOthers Drawn;
  vtkNew<vtkBrumeFilmBlender> Blender;
  brume::Film Film;
  vtkSmartPointer<vtkImageData> Mask;
  std::vector<float> SurfaceDepth; ///< of renders without a window
  vtkSmartPointer<vtkBrumeMedium> Medium;
  vtkSmartPointer<vtkBrumeSky> Sky;
  vtkSmartPointer<vtkBrumeFog> Fog;
  vtkNew<vtkBrumeEffectPlan> Plan;
  vtkRenderWindow* Window = nullptr; ///< the window being drawn into, for its abort check
  std::set<std::string> Warned;      ///< settings that were warned of
  std::map<std::pair<vtkRenderer*, vtkVolume*>, double> Seconds; ///< of pictures, by keys alone
};

vtkBrumeVolumeMapper::vtkBrumeVolumeMapper()
  : Statistics("{}")
  , Internal(std::make_unique<Internals>())
{
}

vtkBrumeVolumeMapper::~vtkBrumeVolumeMapper() = default;

void vtkBrumeVolumeMapper::SetMaskInput(vtkImageData* mask)
{
  if (this->Internal->Mask != mask)
  {
    this->Internal->Mask = mask;
    this->Modified();
  }
}

void vtkBrumeVolumeMapper::SetMedium(vtkBrumeMedium* medium)
{
  if (this->Internal->Medium != medium)
  {
    this->Internal->Medium = medium;
    this->Modified();
  }
}

vtkBrumeMedium* vtkBrumeVolumeMapper::GetMedium()
{
  return this->Internal->Medium;
}

void vtkBrumeVolumeMapper::SetSky(vtkBrumeSky* sky)
{
  if (this->Internal->Sky != sky)
  {
    this->Internal->Sky = sky;
    this->Modified();
  }
}

vtkBrumeSky* vtkBrumeVolumeMapper::GetSky()
{
  return this->Internal->Sky;
}

void vtkBrumeVolumeMapper::SetFog(vtkBrumeFog* fog)
{
  if (this->Internal->Fog != fog)
  {
    this->Internal->Fog = fog;
    this->Modified();
  }
}

vtkBrumeFog* vtkBrumeVolumeMapper::GetFog()
{
  return this->Internal->Fog;
}

vtkBrumeEffectPlan* vtkBrumeVolumeMapper::GetEffectPlan()
{
  return this->Internal->Plan;
}

vtkMTimeType vtkBrumeVolumeMapper::GetMTime()
{
  vtkMTimeType time = std::max(this->Superclass::GetMTime(), this->Internal->Plan->GetMTime());
  if (this->Internal->Medium)
  {
    time = std::max(time, this->Internal->Medium->GetMTime());
  }
  if (this->Internal->Sky)
  {
    time = std::max(time, this->Internal->Sky->GetMTime());
  }
  if (this->Internal->Fog)
  {
    time = std::max(time, this->Internal->Fog->GetRedrawMTime());
  }
  return time;
}

int vtkBrumeVolumeMapper::FillInputPortInformation(int port, vtkInformation* info)
{
  if (!this->Superclass::FillInputPortInformation(port, info))
  {
    return 0;
  }
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkBrumeSparseVolume");
  return 1;
}

double* vtkBrumeVolumeMapper::GetBounds()
{
  if (!vtkBrumeSparseVolume::SafeDownCast(this->GetDataObjectInput()))
  {
    return this->Superclass::GetBounds();
  }
  this->Update();
  vtkBrumeSparseVolume::SafeDownCast(this->GetDataObjectInput())->GetBounds(this->Bounds);
  return this->Bounds;
}

vtkImageData* vtkBrumeVolumeMapper::GetMaskInput()
{
  return this->Internal->Mask;
}

void vtkBrumeVolumeMapper::SetFinalColorWindow(float window)
{
  if (window == 0.0f || !std::isfinite(window))
  {
    vtkWarningMacro(
      "FinalColorWindow must not be " << window << "; kept: " << this->FinalColorWindow);
    return;
  }
  if (window != this->FinalColorWindow)
  {
    this->FinalColorWindow = window;
    this->Modified();
  }
}

bool vtkBrumeVolumeMapper::TellProgress(double fraction)
{
  if (this->ReportProgress)
  {
    this->UpdateProgress(fraction);
  }
  if (this->Internal->Window && this->Internal->Window->CheckAbortStatus())
  {
    return false;
  }
  return !this->GetAbortExecute();
}

double vtkBrumeVolumeMapper::ChooseImageSampleDistance(vtkRenderer*, vtkVolume*, double)
{
  return 1.0;
}

double vtkBrumeVolumeMapper::GetSecondsOfPicture(vtkRenderer* renderer, vtkVolume* volume) const
{
  for (const auto& known : this->Internal->Seconds)
  {
    if (known.first.first == renderer && (!volume || known.first.second == volume))
    {
      return known.second;
    }
  }
  return 0.0;
}

const brume::Scene* vtkBrumeVolumeMapper::UpdateScene(
  vtkVolume* volume, vtkCamera* camera, vtkLightCollection* lights, int width, int height)
{
  return this->WithSurfaceDepth(
    this->UpdateScene(
      volume, {}, this->Internal->Fog, { camera, lights, width, height, this->TwoSidedLighting != 0 }), width,
    height);
}

void vtkBrumeVolumeMapper::SetSurfaceDepth(std::vector<float> depth)
{
  if (depth != this->Internal->SurfaceDepth)
  {
    this->Internal->SurfaceDepth = std::move(depth);
    this->Modified();
  }
}

brume::Scene* vtkBrumeVolumeMapper::WithSurfaceDepth(brume::Scene* scene, int width, int height)
{
  const std::vector<float>& depth = this->Internal->SurfaceDepth;
  if (!scene || depth.empty())
  {
    return scene;
  }
  if (depth.size() != static_cast<std::size_t>(width) * height)
  {
    vtkErrorMacro("The surfaces' depth has " << depth.size() << " pixels, and the picture "
                                             << static_cast<std::size_t>(width) * height << ".");
    return nullptr;
  }
  scene->surface_depth = depth;
  return scene;
}

brume::Scene* vtkBrumeVolumeMapper::UpdateScene(vtkVolume* volume, const brume::ViewFromVTK& view)
{
  if (!volume || !view.camera || view.width <= 0 || view.height <= 0)
  {
    vtkErrorMacro("A render needs a volume, a camera and a size of at least 1 x 1 pixels.");
    return nullptr;
  }
  const auto start = std::chrono::steady_clock::now();
  if (this->GetNumberOfInputConnections(0) > 0)
  {
    this->GetInputAlgorithm()->Update();
  }
  this->SkyInUse = this->Internal->Medium ? this->Internal->Sky.Get() : nullptr;
  std::string wrong;
  try
  {
    brume::ViewFromVTK own = view;
    own.threads = this->NumberOfThreads;
    wrong = this->Internal->Builder.Update(this,
      volume,
      { this->Internal->Mask, this->MaskType == LabelMapMaskType, this->MaskBlendFactor },
      { this->Extinction, this->Internal->Medium, this->Internal->Sky },
      own);
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
  this->WarnOfIgnoredSettings(volume, scene.volumes[0].grid.components);
  this->SecondsScene =
    std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return &scene;
}

brume::Scene* vtkBrumeVolumeMapper::UpdateScene(vtkVolume* first,
  const std::vector<vtkVolume*>& others,
  vtkBrumeFog* fog,
  const brume::ViewFromVTK& view)
{
  brume::Scene* scene = this->UpdateScene(first, view);
  if (scene && !others.empty())
  {
    scene = this->JoinScenes(*scene, others, view);
  }
  if (!scene)
  {
    return nullptr;
  }
  const std::string wrong = brume::add_fog(
    scene->blend_mode == brume::BlendMode::Composite ? fog : nullptr, view, *scene);
  if (!wrong.empty())
  {
    vtkErrorMacro(<< wrong);
    return nullptr;
  }
  if (fog && scene->blend_mode == brume::BlendMode::Composite && fog->GetSky())
  {
    this->SkyInUse = fog->GetSky();
  }
  return scene;
}

brume::Scene* vtkBrumeVolumeMapper::JoinScenes(const brume::Scene& scene,
  const std::vector<vtkVolume*>& others,
  const brume::ViewFromVTK& view)
{
  brume::Scene& together = this->Internal->Together;
  together = scene;
  together.mixture = brume::Mixture::Sum;
  bool sky = this->Internal->Medium && this->Internal->Sky;
  for (vtkVolume* volume : others)
  {
    auto* mapper = vtkBrumeVolumeMapper::SafeDownCast(volume->GetMapper());
    if (brume::Scene* other = mapper->UpdateScene(volume, view))
    {
      if (!sky && mapper->Internal->Medium && mapper->Internal->Sky)
      {
        together.sky = other->sky;
        together.lights = other->lights; // the environment's among them
        this->SkyInUse = mapper->Internal->Sky;
        sky = true;
      }
      together.volumes.insert(together.volumes.end(), other->volumes.begin(), other->volumes.end());
      this->SecondsScene += mapper->SecondsScene;
    }
  }
  return &together;
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
    if (this->FinalColorWindow != 1.0f || this->FinalColorLevel != 0.5f)
    {
      brume::apply_window_level(film, this->FinalColorWindow, this->FinalColorLevel);
    }
  }
  catch (const brume::Marcher::Interrupted&)
  {
    // Before the picture was begun: what was prepared is kept, and made whole by the next render.
    this->Statistics = R"({"completed": false})";
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
  brume::Scene* scene = this->WithSurfaceDepth(
    this->UpdateScene(
      volume, {}, this->Internal->Fog,
      { camera, lights, film.width, film.height, this->TwoSidedLighting != 0 }),
    film.width, film.height);
  if (!scene)
  {
    return false;
  }
  this->Internal->Window = nullptr;
  this->ImageSampleDistanceInUse = 1.0;
  return this->RenderUpdated(*scene, film);
}

bool vtkBrumeVolumeMapper::RenderFilm(vtkVolumeCollection* volumes,
  vtkCamera* camera,
  vtkLightCollection* lights,
  brume::Film& film)
{
  std::vector<vtkVolume*> others;
  std::set<vtkAbstractVolumeMapper*> mappers;
  vtkVolume* first = nullptr;
  vtkCollectionSimpleIterator it;
  if (volumes)
  {
    volumes->InitTraversal(it);
    while (vtkVolume* volume = volumes->GetNextVolume(it))
    {
      const bool fits = first ? MayJoin(first, volume) : volume->GetMapper() == this;
      if (!fits || !mappers.insert(volume->GetMapper()).second)
      {
        vtkErrorMacro("Volumes are drawn as one where each has a mapper of its own of the same "
                      "class, with CombineVolumes on, in composite mode, and the first has this.");
        return false;
      }
      first ? others.push_back(volume) : static_cast<void>(first = volume);
    }
  }
  brume::Scene* scene = this->WithSurfaceDepth(
    this->UpdateScene(
      first, others, this->Internal->Fog,
      { camera, lights, film.width, film.height, this->TwoSidedLighting != 0 }),
    film.width, film.height);
  if (!scene)
  {
    return false;
  }
  this->Internal->Window = nullptr;
  this->ImageSampleDistanceInUse = 1.0;
  return this->RenderUpdated(*scene, film);
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

void vtkBrumeVolumeMapper::WarnOfIgnoredSettings(vtkVolume* volume, int components)
{
  this->IgnoredSettings = brume::ignored_settings(volume,
    { this->Internal->Mask, this->MaskType == LabelMapMaskType, this->MaskBlendFactor },
    components);
  if (this->Internal->Medium && !brume::follows_medium(this->BlendMode))
  {
    this->IgnoredSettings.emplace_back("Medium in a blend mode other than composite");
  }
  if (this->Internal->Sky && !this->Internal->Medium)
  {
    this->IgnoredSettings.emplace_back("Sky without a Medium");
  }
  this->AppendIgnoredSettings(volume, this->IgnoredSettings);
  for (const std::string& setting : this->IgnoredSettings)
  {
    if (this->Internal->Warned.insert(setting).second)
    {
      vtkWarningMacro(<< setting << " is not supported and is ignored.");
    }
  }
}

bool vtkBrumeVolumeMapper::MayJoin(vtkVolume* first, vtkVolume* other)
{
  auto* a = vtkBrumeVolumeMapper::SafeDownCast(first->GetMapper());
  auto* b = vtkBrumeVolumeMapper::SafeDownCast(other->GetMapper());
  return a && a->Combines() && b && b->Combines() && a != b &&
         std::string(a->GetClassName()) == b->GetClassName() && b->GetDataObjectInput();
}

bool vtkBrumeVolumeMapper::Combines() const
{
  return this->CombineVolumes && this->BlendMode == COMPOSITE_BLEND;
}

bool vtkBrumeVolumeMapper::RenderWithFog(vtkRenderer* renderer, vtkBrumeFog* fog)
{
  vtkPropCollection* props = renderer->GetViewProps();
  vtkCollectionSimpleIterator it;
  props->InitTraversal(it);
  while (vtkProp* prop = props->GetNextProp(it))
  {
    auto* volume = vtkVolume::SafeDownCast(prop);
    auto* mapper =
      volume ? vtkBrumeVolumeMapper::SafeDownCast(volume->GetMapper()) : nullptr;
    if (!mapper || !volume->GetVisibility() || !mapper->Combines() ||
      !mapper->GetDataObjectInput())
    {
      continue;
    }
    // Unless it had its turn before the fog, and could not be drawn.
    if (!mapper->Internal->Drawn.Includes(renderer, volume))
    {
      mapper->Render(renderer, volume);
    }
    return fog->Internal->Drawn.Includes(renderer, fog);
  }
  return false;
}

void vtkBrumeVolumeMapper::Render(vtkRenderer* renderer, vtkVolume* volume)
{
  this->TimeToDraw = 0.0;
  const auto start = std::chrono::steady_clock::now();
  int width = 0;
  int height = 0;
  int left = 0;
  int bottom = 0;
  renderer->GetTiledSizeAndOrigin(&width, &height, &left, &bottom);
  if (width <= 0 || height <= 0 || this->Internal->Drawn.Includes(renderer, volume))
  {
    return;
  }
  if (renderer->GetSelector())
  {
    return; // colours there are names of props, which a film would paint over
  }
  std::vector<vtkVolume*> others;
  double allocated = volume->GetAllocatedRenderTime();
  vtkBrumeFog* fog = nullptr;
  if (this->Combines())
  {
    fog = brume::find_fog(renderer);
    if (fog && fog->Internal->Drawn.Includes(renderer, fog))
    {
      fog = nullptr; // with other volumes
    }
    std::set<vtkAbstractVolumeMapper*> mappers;
    for (vtkVolume* other :
      brume::volumes_to_join(renderer, volume, &MayJoin, fog != nullptr))
    {
      // A mapper that serves several volumes can hold the scene of one at a time.
      if (mappers.insert(other->GetMapper()).second)
      {
        others.push_back(other);
        allocated += other->GetAllocatedRenderTime();
      }
    }
  }
  brume::Scene* scene = this->UpdateScene(volume,
    others,
    fog,
    { renderer->GetActiveCamera(),
      renderer->GetLights(),
      width,
      height,
      renderer->GetTwoSidedLighting() != 0 });
  for (vtkVolume* other : others)
  {
    vtkBrumeVolumeMapper::SafeDownCast(other->GetMapper())
      ->Internal->Drawn.Remember(renderer, other);
  }
  if (fog)
  {
    this->Internal->Drawn.Remember(renderer, volume); // the fog has its own turn, too
  }
  if (!scene)
  {
    return;
  }
  if (fog)
  {
    fog->Internal->Drawn.Remember(renderer, fog);
  }
  const brume::ImageSampling rays(
    width, height, this->ChooseImageSampleDistance(renderer, volume, allocated));
  brume::Film& film = this->Internal->Film;
  if (film.width != rays.width || film.height != rays.height)
  {
    film = brume::Film(rays.width, rays.height);
  }
  if (this->IntermixIntersectingGeometry)
  {
    scene->surface_depth = brume::read_surface_depth(renderer, left, bottom, width, height);
  }
  if (!scene->surface_depth.empty() && (rays.width != width || rays.height != height))
  {
    scene->surface_depth = brume::at_rays(scene->surface_depth, width, height, rays);
  }
  this->ImageSampleDistanceInUse = rays.distance;
  this->Internal->Window = renderer->GetRenderWindow();
  const bool completed = this->RenderUpdated(*scene, film);
  this->Internal->Window = nullptr;
  for (vtkVolume* other : others)
  {
    auto* mapper = vtkBrumeVolumeMapper::SafeDownCast(other->GetMapper());
    mapper->Statistics = this->Statistics;
    mapper->Internal->Plan->SetPlan(this->Internal->Plan->GetPlan());
  }
  if (!completed)
  {
    return;
  }
  this->Internal->Seconds[{ renderer, volume }] = this->SecondsRender *
                                                  (static_cast<double>(width) * height) /
                                                  (static_cast<double>(rays.width) * rays.height);
  const bool shown = rays.per_pixel > 1 ? this->Internal->Blender->Blend(
                                            brume::averaged(film, rays.per_pixel), renderer)
                                        : this->Internal->Blender->Blend(film, renderer);
  if (!shown)
  {
    vtkErrorMacro("The picture was not shown: the render window is not an OpenGL window.");
  }
  this->TimeToDraw =
    std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void vtkBrumeVolumeMapper::ReleaseGraphicsResources(vtkWindow* window)
{
  this->Internal->Blender->ReleaseGraphicsResources(window);
  this->Internal->Seconds.clear();
}

void vtkBrumeVolumeMapper::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Extinction: " << this->Extinction << "\n";
  os << indent << "Tolerance: " << this->Tolerance << "\n";
  os << indent << "NumberOfThreads: " << this->NumberOfThreads << "\n";
  os << indent << "TwoSidedLighting: " << (this->TwoSidedLighting ? "On" : "Off") << "\n";
  os << indent << "CombineVolumes: " << (this->CombineVolumes ? "On" : "Off") << "\n";
  os << indent
     << "IntermixIntersectingGeometry: " << (this->IntermixIntersectingGeometry ? "On" : "Off")
     << "\n";
  os << indent << "Medium: " << this->Internal->Medium << "\n";
  os << indent << "Sky: " << this->Internal->Sky << "\n";
  os << indent << "Fog: " << this->Internal->Fog << "\n";
  os << indent << "EffectPlan:\n";
  this->Internal->Plan->PrintSelf(os, indent.GetNextIndent());
  os << indent << "MaskInput: " << this->Internal->Mask << "\n";
  os << indent << "MaskType: " << this->MaskType << "\n";
  os << indent << "MaskBlendFactor: " << this->MaskBlendFactor << "\n";
  os << indent << "FinalColorWindow: " << this->FinalColorWindow << "\n";
  os << indent << "FinalColorLevel: " << this->FinalColorLevel << "\n";
  os << indent << "ReportProgress: " << (this->ReportProgress ? "On" : "Off") << "\n";
  os << indent << "Statistics: " << this->Statistics << "\n";
}
