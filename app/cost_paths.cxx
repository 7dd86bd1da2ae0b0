#include "cost_paths.h"

#include "command.h"
#include "interruption.h"
#include "study_clock.h"

#include "vtkBrumeFog.h"
#include "vtkBrumeMedium.h"
#include "vtkBrumePathTraceMapper.h"
#include "vtkBrumeSky.h"
#include "vtkBrumeSparseVolume.h"

#include "vtkCamera.h"
#include "vtkImageData.h"
#include "vtkLightCollection.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <limits>

namespace brume::app
{

std::string not_drawn_by_paths(const VolumeScene& scene)
{
  return not_drawn_by(scene.options.modes, MapperKind::PathTrace);
}

bool is_truth_by_paths(const VolumeScene& scene)
{
  const MediumOptions& medium = scene.options.medium;
  const Triple none{ 0.0, 0.0, 0.0 };
  const bool scatters = (scene.medium && medium.albedo != none) || (scene.fog && medium.fog_albedo != none);
  return scatters && !medium.silver_lining && !medium.powder && !scene.volume->GetProperty()->GetShade() && not_drawn_by_paths(scene).empty();
}

CostPaths::CostPaths(const VolumeScene& scene, const SurfacePicture& surfaces)
  : Scene(scene)
  , Surfaces(surfaces)
  , FirstSeed(scene.options.paths.seed.value_or(1))
{
  set_up(scene, this->Mapper);
  this->Mapper->SetTolerance(0.0); // so many paths, and no fewer
  this->Mapper->SetSurfaceDepth(surfaces.depth);
  observe(this->Mapper, this->Whole);
}

CostPaths::~CostPaths()
{
  if (this->Scene.volume->GetMapper() == this->Mapper.Get())
  {
    this->Scene.volume->SetMapper(nullptr);
  }
}

Film CostPaths::trace(std::uint32_t seed, const Watch& watch, std::string& statistics)
{
  this->Mapper->SetSeed(seed);
  Film film = draw_watched(this->Scene, this->Mapper, this->Whole, watch, "cost");
  statistics = this->Mapper->GetStatistics();
  return film;
}

StudyTruth CostPaths::truth(double seconds, StudyClock& clock, Film& film)
{
  const auto start = std::chrono::steady_clock::now();
  constexpr int any_number = std::numeric_limits<int>::max();
  const int most = this->Scene.options.paths.samples_per_pixel.value_or(any_number);
  this->Mapper->SetSamplesPerPixel(most == any_number ? most : std::max(1, (most + 1) / 2));
  this->Mapper->SetTimeBudget(0.5 * seconds);
  StudyTruth result;
  result.kind = "paths";
  for (Picture* half : { &result.halves.a, &result.halves.b })
  {
    std::string text;
    const Film drawn =
      this->trace(this->FirstSeed + this->Drawn++, [&](double) { return clock.tick(); }, text);
    const nlohmann::json statistics = nlohmann::json::parse(text);
    result.samples_per_pixel += statistics["samples_per_pixel"].get<int>();
    *half = { drawn.width, drawn.height, over_scene(drawn, this->Scene, this->Surfaces) };
    film = drawn;
  }
  const int scatterings = this->Mapper->GetMaximumScatterings();
  result.truth.picture = mean_of(result.halves);
  result.noise = noise_of(result.halves);
  result.truth.method = "Brume's path tracer, without bias: " +
    std::string(scatterings > 0 ? "up to " + std::to_string(scatterings) + " scatterings"
                                : "any number of scatterings") +
    ", " + std::to_string(result.samples_per_pixel) +
    " paths through each pixel, in two halves of different random numbers. Half their difference tells "
    "the noise of their mean, and RMS errors are freed of it.";
  result.truth.remaining_mean = result.noise.mean;
  result.truth.remaining_largest = result.noise.largest;
  result.truth.seconds =
    std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  this->Mapper->SetTimeBudget(0.0);
  return result;
}

CostRender CostPaths::draw(int samples_per_pixel, const Watch& watch)
{
  this->Mapper->SetSamplesPerPixel(samples_per_pixel);
  std::string text;
  const Film film = this->trace(this->FirstSeed + this->Drawn++, watch, text);
  const nlohmann::json statistics = nlohmann::json::parse(text);
  return { { film.width, film.height, over_scene(film, this->Scene, this->Surfaces) },
    statistics["seconds"], statistics["seconds_prepare"], text };
}

}
