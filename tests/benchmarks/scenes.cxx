#include "scenes.h"

#include "../support/bumpy_ball.h"

#include "Transport/reference.h"

#include "vtkCamera.h"
#include "vtkLight.h"
#include "vtkLightCollection.h"
#include "vtkVolume.h"

#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace benchmarks
{

const brume::Picture& Scene::truth()
{
  if (this->Truth.rgb.empty())
  {
    const brume::app::VolumeScene& scene = this->Volume;
    vtkNew<vtkBrumeRayMarchMapper> mapper;
    mapper->SetInputData(scene.input.image);
    const brume::Scene* plain =
      mapper->UpdateScene(scene.volume, scene.camera, scene.lights, scene.width(), scene.height());
    if (!plain)
    {
      throw std::runtime_error(scene.options.input + ": it cannot be drawn");
    }
    brume::Film film(scene.width(), scene.height());
    brume::ReferenceSettings settings;
    settings.threads = scene.options.threads;
    const brume::ReferenceStatistics done = brume::render_reference(*plain, settings, film);
    this->TruthSeconds = done.seconds;
    this->Truth = {
      film.width, film.height, brume::over_background(film, scene.options.background.data())
    };
  }
  return this->Truth;
}

Subject::Subject(const Scene& scene, double step, int threads)
  : TheScene(scene)
  , Film(scene.volume().width(), scene.volume().height())
{
  this->Mapper->SetInputData(scene.volume().input.image);
  this->Mapper->SetNumberOfThreads(threads);
  if (step > 0.0)
  {
    this->Mapper->AutoAdjustSampleDistancesOff();
    this->Mapper->SetSampleDistance(step);
  }
}

double Subject::render()
{
  const brume::app::VolumeScene& scene = this->TheScene.volume();
  if (!this->Mapper->RenderFilm(scene.volume, scene.camera, scene.lights, this->Film))
  {
    throw std::runtime_error(scene.options.input + ": Brume could not draw it");
  }
  this->Statistics = nlohmann::json::parse(this->Mapper->GetStatistics());
  return this->Statistics["seconds"];
}

brume::Picture Subject::picture() const
{
  return { this->Film.width,
    this->Film.height,
    brume::over_background(this->Film, this->TheScene.volume().options.background.data()) };
}

namespace
{

vtkSmartPointer<vtkLightCollection> headlight()
{
  vtkNew<vtkLight> light;
  light->SetLightTypeToHeadlight();
  light->SetAmbientColor(1.0, 1.0, 1.0); // VTK's CPU mapper takes none otherwise
  auto lights = vtkSmartPointer<vtkLightCollection>::New();
  lights->AddItem(light);
  return lights;
}

}

std::unique_ptr<Scene> Scenes::of_balls(vtkImageData* image,
  double largest,
  double edge,
  const char* name) const
{
  brume::app::VolumeScene scene;
  scene.options.input = name;
  scene.options.resolution = { this->Settings.resolution, this->Settings.resolution };
  scene.options.threads = this->Settings.threads;
  scene.options.quiet = true;
  scene.input.image = image;
  scene.input.name = name;
  scene.volume = vtkSmartPointer<vtkVolume>::New();
  scene.volume->SetProperty(bumpy_ball::property(largest, edge));
  scene.lights = headlight();
  // Along no axis of the grid; the cube's inscribed ball just fills the picture.
  scene.camera = vtkSmartPointer<vtkCamera>::New();
  const double half = 0.5 * edge;
  const double distance = half / std::sin(0.5 * 30.0 * 3.14159265358979 / 180.0);
  const double length = std::sqrt(0.45 * 0.45 + 0.35 * 0.35 + 0.82 * 0.82);
  scene.camera->SetViewAngle(30.0);
  scene.camera->SetFocalPoint(half, half, half);
  scene.camera->SetPosition(half + 0.45 / length * distance,
    half - 0.35 / length * distance,
    half + 0.82 / length * distance);
  scene.camera->SetViewUp(0.0, 1.0, 0.0);
  scene.voxel_edge = image->GetSpacing()[0];
  scene.opacity_unit_distance = scene.volume->GetProperty()->GetScalarOpacityUnitDistance();
  vtkNew<vtkBrumeRayMarchMapper> mapper; // gives the volume its bounds
  mapper->SetInputData(image);
  scene.volume->SetMapper(mapper);
  vtkBrumeVolumeMapper::ResetClippingRange(scene.volume, scene.camera);
  scene.volume->SetMapper(nullptr);
  return std::make_unique<Scene>(std::move(scene));
}

Scene& Scenes::ball(bool shaded)
{
  std::unique_ptr<Scene>& plain = this->Kept["ball"];
  const int n = this->Settings.quick ? 48 : 256;
  if (!plain)
  {
    plain = this->of_balls(
      bumpy_ball::image<std::uint16_t>(n, VTK_UNSIGNED_SHORT, n - 1.0), 65530.0, n - 1.0, "ball");
  }
  if (!shaded)
  {
    return *plain;
  }
  std::unique_ptr<Scene>& lit = this->Kept["ball shaded"];
  if (!lit)
  {
    lit = this->of_balls(plain->volume().input.image, 65530.0, n - 1.0, "ball");
    lit->volume().volume->GetProperty()->ShadeOn();
  }
  return *lit;
}

Scene& Scenes::input(const std::string& spec, bool shaded)
{
  std::unique_ptr<Scene>& kept = this->Kept[spec + (shaded ? " shaded" : "")];
  if (!kept)
  {
    brume::app::SceneOptions options;
    options.input = spec;
    options.resolution = { this->Settings.resolution, this->Settings.resolution };
    options.threads = this->Settings.threads;
    options.shade = shaded ? "on" : "off";
    options.quiet = true;
    brume::app::VolumeScene scene = brume::app::make_volume_scene(options);
    vtkNew<vtkBrumeRayMarchMapper> mapper;
    mapper->SetInputData(scene.input.image);
    scene.volume->SetMapper(mapper);
    vtkBrumeVolumeMapper::ResetClippingRange(scene.volume, scene.camera);
    scene.volume->SetMapper(nullptr);
    kept = std::make_unique<Scene>(std::move(scene));
  }
  return *kept;
}

std::string in_words(const brume::ImageErrors& errors)
{
  char text[120];
  std::snprintf(text,
    sizeof(text),
    "mean %.3g, 99.9 %% %.3g, largest %.3g",
    255.0 * errors.mean_absolute,
    255.0 * errors.percentile_999,
    255.0 * errors.largest);
  return text;
}

bool no_larger(const brume::ImageErrors& a, const brume::ImageErrors& b)
{
  return a.mean_absolute <= b.mean_absolute && a.percentile_999 <= b.percentile_999 &&
         a.largest <= b.largest;
}

}
