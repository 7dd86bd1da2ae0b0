#include "vtkBrumeFog.h"

#include "fog_from_vtk.h"
#include "fog_internals.h"
#include "surface_depth.h"
#include "volume_group.h"
#include "vtkBrumeFilmBlender.h"
#include "vtkBrumeVolumeMapper.h"

#include "checked_values.h"
#include "phase_lobes.h"
#include "vtkBrumeSky.h"

#include "Transport/film.h"
#include "Transport/fog_film.h"

#include "vtkCamera.h"
#include "vtkLightCollection.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkSmartPointer.h"
#include "vtkVolume.h"

#include <algorithm>
#include <new>
#include <stdexcept>

vtkStandardNewMacro(vtkBrumeFog);

vtkBrumeFog::vtkBrumeFog()
  : Internal(std::make_unique<Internals>())
{
}

vtkBrumeFog::~vtkBrumeFog() = default;

void vtkBrumeFog::SetExtinction(double red, double green, double blue)
{
  brume::set_values(
    this, "Extinction", this->Extinction, { red, green, blue }, 0.0, VTK_DOUBLE_MAX);
}

void vtkBrumeFog::SetAlbedo(double red, double green, double blue)
{
  brume::set_values(this, "Albedo", this->Albedo, { red, green, blue }, 0.0, 1.0);
}

void vtkBrumeFog::SetFalloff(double falloff)
{
  brume::set_value(this, "Falloff", this->Falloff, falloff, 0.0, VTK_DOUBLE_MAX);
}

void vtkBrumeFog::SetBaseHeight(double height)
{
  brume::set_value(
    this, "BaseHeight", this->BaseHeight, height, -VTK_DOUBLE_MAX, VTK_DOUBLE_MAX);
}

void vtkBrumeFog::AddLobe(int function, double weight, double anisotropy)
{
  const std::string wrong = brume::add_lobe(
    this->Internal->Lobes, static_cast<brume::PhaseFunction>(function), weight, anisotropy);
  if (!wrong.empty())
  {
    vtkWarningMacro(<< wrong << "; no lobe is added for weight " << weight << " and anisotropy "
                    << anisotropy << '.');
    return;
  }
  this->Modified();
}

void vtkBrumeFog::AddIsotropicLobe(double weight)
{
  this->AddLobe(static_cast<int>(brume::PhaseFunction::Isotropic), weight, 0.0);
}

void vtkBrumeFog::AddRayleighLobe(double weight)
{
  this->AddLobe(static_cast<int>(brume::PhaseFunction::Rayleigh), weight, 0.0);
}

void vtkBrumeFog::AddHenyeyGreensteinLobe(double weight, double anisotropy)
{
  this->AddLobe(static_cast<int>(brume::PhaseFunction::HenyeyGreenstein), weight, anisotropy);
}

void vtkBrumeFog::AddSchlickLobe(double weight, double anisotropy)
{
  this->AddLobe(static_cast<int>(brume::PhaseFunction::Schlick), weight, anisotropy);
}

void vtkBrumeFog::RemoveAllLobes()
{
  if (!this->Internal->Lobes.empty())
  {
    this->Internal->Lobes.clear();
    this->Modified();
  }
}

int vtkBrumeFog::GetNumberOfLobes() const
{
  return static_cast<int>(this->Internal->Lobes.size());
}

void vtkBrumeFog::SetAnisotropy(double anisotropy)
{
  std::vector<brume::PhaseLobe> lobes;
  const std::string wrong =
    anisotropy == 0.0
      ? std::string()
      : brume::add_lobe(lobes, brume::PhaseFunction::HenyeyGreenstein, 1.0, anisotropy);
  if (!wrong.empty())
  {
    vtkWarningMacro(<< wrong << ", not " << anisotropy << "; the old phase function is kept.");
    return;
  }
  this->Internal->Lobes = lobes;
  this->Modified();
}

double vtkBrumeFog::GetAnisotropy() const
{
  return brume::mean_anisotropy(this->Internal->Lobes);
}

void vtkBrumeFog::SetSky(vtkBrumeSky* sky)
{
  if (this->Internal->Sky != sky)
  {
    this->Internal->Sky = sky;
    this->Modified();
  }
}

vtkBrumeSky* vtkBrumeFog::GetSky()
{
  return this->Internal->Sky;
}

void vtkBrumeFog::FillFog(brume::Fog& fog) const
{
  fog = brume::Fog();
  for (int c = 0; c < 3; ++c)
  {
    fog.extinction[c] = this->Extinction[c];
    fog.albedo[c] = this->Albedo[c];
    fog.enabled = fog.enabled || this->Extinction[c] > 0.0;
  }
  fog.lobes = this->Internal->Lobes;
  fog.falloff = this->Falloff;
  fog.base_height = this->BaseHeight;
}

bool vtkBrumeFog::RenderFilm(vtkCamera* camera,
  vtkLightCollection* lights,
  brume::Film& film,
  const std::vector<float>& surface_depth,
  const std::function<bool(double)>& progress)
{
  if (!camera || film.width <= 0 || film.height <= 0)
  {
    vtkErrorMacro("A render needs a camera and a size of at least 1 x 1 pixels.");
    return false;
  }
  try
  {
    brume::Scene scene;
    const std::string wrong =
      brume::scene_of_fog(this, { camera, lights, film.width, film.height }, scene);
    if (!wrong.empty())
    {
      vtkErrorMacro(<< wrong);
      return false;
    }
    if (!surface_depth.empty() && surface_depth.size() != film.size())
    {
      vtkErrorMacro("The surfaces' depth has " << surface_depth.size()
                                               << " pixels, and the picture " << film.size() << ".");
      return false;
    }
    scene.surface_depth = surface_depth;
    return brume::render_fog(scene, film, this->NumberOfThreads, progress);
  }
  catch (const std::invalid_argument& error)
  {
    vtkErrorMacro(<< error.what());
  }
  catch (const std::bad_alloc&)
  {
    vtkErrorMacro("out of memory: take a smaller picture");
  }
  return false;
}

int vtkBrumeFog::RenderVolumetricGeometry(vtkViewport* viewport)
{
  auto* renderer = vtkRenderer::SafeDownCast(viewport);
  // Colours of a selection are names of props, which a film would paint over.
  if (!renderer || renderer->GetSelector() || this->Internal->Drawn.Includes(renderer, this))
  {
    return 0;
  }
  if (brume::find_fog(renderer) == this && vtkBrumeVolumeMapper::RenderWithFog(renderer, this))
  {
    return 1;
  }
  this->DrawAlone(renderer);
  return 1;
}

void vtkBrumeFog::DrawAlone(vtkRenderer* renderer)
{
  int width = 0;
  int height = 0;
  int left = 0;
  int bottom = 0;
  renderer->GetTiledSizeAndOrigin(&width, &height, &left, &bottom);
  if (width <= 0 || height <= 0)
  {
    return;
  }
  try
  {
    brume::Scene scene;
    const std::string wrong = brume::scene_of_fog(
      this, { renderer->GetActiveCamera(), renderer->GetLights(), width, height }, scene);
    if (!wrong.empty())
    {
      vtkErrorMacro(<< wrong);
      return;
    }
    brume::Film& film = this->Internal->Film;
    if (film.width != width || film.height != height)
    {
      film = brume::Film(width, height);
    }
    scene.surface_depth = brume::read_surface_depth(renderer, left, bottom, width, height);
    vtkRenderWindow* window = renderer->GetRenderWindow();
    if (!brume::render_fog(scene, film, this->NumberOfThreads,
          [window](double) { return !window->CheckAbortStatus(); }))
    {
      return;
    }
    if (!this->Internal->Blender->Blend(film, renderer))
    {
      vtkErrorMacro("The fog was not shown: the render window is not an OpenGL window.");
    }
  }
  catch (const std::invalid_argument& error)
  {
    vtkErrorMacro(<< error.what());
  }
  catch (const std::bad_alloc&)
  {
    vtkErrorMacro("out of memory: take a smaller picture");
  }
}

vtkMTimeType vtkBrumeFog::GetRedrawMTime()
{
  const vtkMTimeType own = this->Superclass::GetRedrawMTime();
  return this->Internal->Sky ? std::max(own, this->Internal->Sky->GetMTime()) : own;
}

void vtkBrumeFog::ReleaseGraphicsResources(vtkWindow* window)
{
  this->Internal->Blender->ReleaseGraphicsResources(window);
}

void vtkBrumeFog::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Extinction: " << this->Extinction[0] << " " << this->Extinction[1] << " "
     << this->Extinction[2] << "\n";
  os << indent << "Albedo: " << this->Albedo[0] << " " << this->Albedo[1] << " "
     << this->Albedo[2] << "\n";
  for (const brume::PhaseLobe& lobe : this->Internal->Lobes)
  {
    os << indent << "Lobe: " << brume::phase_function_name(lobe.function) << " " << lobe.weight
       << " " << lobe.anisotropy << "\n";
  }
  os << indent << "Falloff: " << this->Falloff << "\n";
  os << indent << "BaseHeight: " << this->BaseHeight << "\n";
  os << indent << "Sky: " << this->Internal->Sky << "\n";
  os << indent << "NumberOfThreads: " << this->NumberOfThreads << "\n";
}
