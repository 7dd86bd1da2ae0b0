#include "scene_march.h"

#include "command.h"
#include "interruption.h"

#include "vtkBrumeFog.h"
#include "vtkBrumeMedium.h"
#include "vtkBrumeRayMarchMapper.h"
#include "vtkBrumeSky.h"
#include "vtkBrumeSparseVolume.h"

#include "vtkCallbackCommand.h"
#include "vtkCamera.h"
#include "vtkCommand.h"
#include "vtkImageData.h"
#include "vtkLightCollection.h"
#include "vtkVolume.h"

namespace brume::app
{

void observe(vtkAlgorithm* mapper, const Watch& watch)
{
  vtkNew<vtkCallbackCommand> observer;
  observer->SetClientData(const_cast<Watch*>(&watch));
  observer->SetCallback(
    [](vtkObject* caller, unsigned long, void* data, void*)
    {
      auto* algorithm = static_cast<vtkAlgorithm*>(caller);
      const Watch& w = *static_cast<const Watch*>(data);
      if (w && !w(algorithm->GetProgress()))
      {
        algorithm->AbortExecuteOn();
      }
    });
  mapper->AddObserver(vtkCommand::ProgressEvent, observer);
}

Film draw_watched(const VolumeScene& scene,
  vtkBrumeVolumeMapper* mapper,
  Watch& whole,
  const Watch& watch,
  const char* command)
{
  scene.volume->SetMapper(mapper);
  whole = [&](double done) { return !InterruptionWatch::requested() && (!watch || watch(done)); };
  Film film(scene.width(), scene.height());
  const bool completed = mapper->RenderFilm(scene.volume, scene.camera, scene.lights, film);
  whole = {};
  if (!completed)
  {
    InterruptionWatch::check(command);
    if (mapper->GetAbortExecute())
    {
      throw SceneMarch::Stopped();
    }
    throw Failure(scene.options.input, "it cannot be drawn", "see brume info");
  }
  return film;
}

SceneMarch::SceneMarch(const VolumeScene& scene, const char* command)
  : Scene(scene)
  , Command(command)
{
  set_up(scene, this->Mapper);
  this->Surfaces = draw_meshes(scene);
  this->Mapper->SetSurfaceDepth(this->Surfaces.depth);
  this->Whole = [this](double done)
  { return !InterruptionWatch::requested() && (!this->Watching || this->Watching(done)); };
  observe(this->Mapper, this->Whole);
}

SceneMarch::~SceneMarch()
{
  if (this->Scene.volume->GetMapper() == this->Mapper.Get())
  {
    this->Scene.volume->SetMapper(nullptr);
  }
}

void SceneMarch::take_volume()
{
  this->Scene.volume->SetMapper(this->Mapper);
}

Film SceneMarch::draw()
{
  this->Mapper->SetSurfaceDepth(this->Surfaces.depth);
  return this->draw(this->Scene.width(), this->Scene.height());
}

Film SceneMarch::draw(int width, int height)
{
  if (width != this->Scene.width() || height != this->Scene.height())
  {
    this->Mapper->SetSurfaceDepth({});
  }
  Film film(width, height);
  this->Mapper->SetAbortExecute(0);
  if (!this->Mapper->RenderFilm(this->Scene.volume, this->Scene.camera, this->Scene.lights, film))
  {
    InterruptionWatch::check(this->Command);
    if (this->Mapper->GetAbortExecute())
    {
      throw Stopped();
    }
    throw Failure(this->Scene.options.input, "it cannot be drawn", "see brume info");
  }
  return film;
}

Picture SceneMarch::over(const Film& film) const
{
  return { film.width, film.height, over_scene(film, this->Scene, this->Surfaces) };
}

}
