#include "compare_paths.h"

#include "command.h"
#include "interruption.h"
#include "progress.h"

#include "vtkBrumeFog.h"
#include "vtkBrumeMedium.h"
#include "vtkBrumePathTraceMapper.h"
#include "vtkBrumeSky.h"
#include "vtkBrumeSparseVolume.h"

#include "vtkCallbackCommand.h"
#include "vtkCamera.h"
#include "vtkCommand.h"
#include "vtkImageData.h"
#include "vtkLightCollection.h"
#include "vtkVolume.h"

#include <algorithm>

namespace brume::app
{

namespace
{

/// Paths of the truth for one of a picture: a quarter of its noise.
constexpr int paths_of_truth = 16;

/// The random numbers of the truth are none of the pictures'.
constexpr std::uint32_t seed_of_truth = 0x54727574u;

}

ComparePaths::ComparePaths(const VolumeScene& scene, const SurfacePicture& surfaces)
  : Scene(scene)
{
  set_up(scene, this->Mapper);
  this->Mapper->SetSurfaceDepth(surfaces.depth);
}

ComparePaths::~ComparePaths()
{
  if (this->Scene.volume->GetMapper() == this->Mapper.Get())
  {
    this->Scene.volume->SetMapper(nullptr);
  }
}

Film ComparePaths::trace(std::uint32_t seed, const std::string& task, std::string& statistics)
{
  this->Scene.volume->SetMapper(this->Mapper);
  this->Mapper->SetSeed(seed);
  struct Watch
  {
    ProgressBar bar;
    std::string error;
  } watch{ ProgressBar(task, !this->Scene.options.quiet), {} };
  vtkNew<vtkCallbackCommand> observer;
  observer->SetClientData(&watch);
  observer->SetCallback(
    [](vtkObject* caller, unsigned long event, void* data, void* text)
    {
      auto& w = *static_cast<Watch*>(data);
      auto* mapper = static_cast<vtkBrumePathTraceMapper*>(caller);
      if (event == vtkCommand::ErrorEvent)
      {
        w.error = static_cast<const char*>(text);
        return;
      }
      w.bar.update(mapper->GetProgress());
      if (InterruptionWatch::requested())
      {
        mapper->AbortExecuteOn();
      }
    });
  const unsigned long progress = this->Mapper->AddObserver(vtkCommand::ProgressEvent, observer);
  const unsigned long error = this->Mapper->AddObserver(vtkCommand::ErrorEvent, observer);
  Film film(this->Scene.width(), this->Scene.height());
  const bool completed =
    this->Mapper->RenderFilm(this->Scene.volume, this->Scene.camera, this->Scene.lights, film);
  this->Mapper->RemoveObserver(progress);
  this->Mapper->RemoveObserver(error);
  watch.bar.clear();
  InterruptionWatch::check("compare");
  if (!completed)
  {
    throw Failure(this->Scene.options.input, "paths cannot draw it", words_of_vtk(watch.error));
  }
  statistics = this->Mapper->GetStatistics();
  return film;
}

Film ComparePaths::draw(std::uint32_t draw, std::string& statistics)
{
  const std::uint32_t seed = this->Scene.options.paths.seed.value_or(1);
  return this->trace(seed + draw, "tracing paths", statistics);
}

Film ComparePaths::truth(std::string& statistics)
{
  const int samples = this->Mapper->GetSamplesPerPixel();
  const double tolerance = this->Mapper->GetTolerance();
  const double budget = this->Mapper->GetTimeBudget();
  this->Mapper->SetSamplesPerPixel(
    static_cast<int>(std::min<double>(double(paths_of_truth) * samples, VTK_INT_MAX)));
  this->Mapper->SetTolerance(0.0);
  this->Mapper->SetTimeBudget(0.0);
  const std::uint32_t seed = this->Scene.options.paths.seed.value_or(1);
  Film film = this->trace(seed ^ seed_of_truth, "computing the truth: paths", statistics);
  this->Mapper->SetSamplesPerPixel(samples);
  this->Mapper->SetTolerance(tolerance);
  this->Mapper->SetTimeBudget(budget);
  return film;
}

}
