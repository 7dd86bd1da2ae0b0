#include "cost_smart.h"

#include "command.h"
#include "interruption.h"

#include "vtkBrumeFog.h"
#include "vtkBrumeMedium.h"
#include "vtkBrumeSky.h"
#include "vtkBrumeSmartVolumeMapper.h"
#include "vtkBrumeSparseVolume.h"

#include "vtkCamera.h"
#include "vtkImageData.h"
#include "vtkLightCollection.h"
#include "vtkPolyData.h"
#include "vtkVolume.h"

#include <nlohmann/json.hpp>

#include <chrono>

namespace brume::app
{

namespace
{

/// A truth and its paths use the seeds from the user's on: other random numbers than theirs.
constexpr unsigned int seed_beyond_truth = 0x5eed0000u;

}

CostSmart::CostSmart(const VolumeScene& scene, const SurfacePicture& surfaces)
  : Scene(scene)
  , Surfaces(surfaces)
{
  set_up(scene, this->Mapper);
  this->Mapper->SetSeed(scene.options.paths.seed.value_or(1) + seed_beyond_truth);
  this->Mapper->SetSurfaceDepth(surfaces.depth);
  observe(this->Mapper, this->Whole);
}

CostSmart::~CostSmart()
{
  if (this->Scene.volume->GetMapper() == this->Mapper.Get())
  {
    this->Scene.volume->SetMapper(nullptr);
  }
}

CostRender CostSmart::draw(const Watch& watch)
{
  const Film film = draw_watched(this->Scene, this->Mapper, this->Whole, watch, "cost");
  const std::string& text = this->Mapper->GetStatistics();
  const nlohmann::json statistics = nlohmann::json::parse(text);
  return { { film.width, film.height, over_scene(film, this->Scene, this->Surfaces) },
    statistics["seconds"], statistics["seconds_prepare"], text };
}

CostRender CostSmart::within(double tolerance, const Watch& watch)
{
  this->Mapper->SetTolerance(tolerance);
  this->Mapper->SetTimeBudget(0.0);
  return this->draw(watch);
}

CostRender CostSmart::of_time(double seconds, const Watch& watch)
{
  this->Mapper->SetTolerance(0.0);
  this->Mapper->SetTimeBudget(seconds);
  const auto start = std::chrono::steady_clock::now();
  CostRender render = this->draw(watch);
  render.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return render;
}

}
