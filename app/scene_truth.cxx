#include "scene_truth.h"

#include "command.h"
#include "interruption.h"
#include "progress.h"

#include "vtkBrumeEffectPlan.h"
#include "vtkBrumeFog.h"
#include "vtkBrumeMedium.h"
#include "vtkBrumeRayMarchMapper.h"
#include "vtkBrumeSky.h"
#include "vtkBrumeSparseVolume.h"

#include "vtkCamera.h"
#include "vtkImageData.h"
#include "vtkLightCollection.h"
#include "vtkVolume.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <iomanip>
#include <sstream>

namespace brume::app
{

namespace
{

/// The truth of lit media: steps are halved until the picture changes by no more than this (largest and
/// mean of a third of the change), at most so often, and no shorter than a part of a voxel's edge.
constexpr double settled_largest = 1e-3;
constexpr double settled_mean = 5e-5;
constexpr int most_halvings = 5;
constexpr double shortest_step = 1.0 / 16.0;
constexpr int check_pixels = 8; ///< along each side
constexpr double check_tolerance = 1e-3;

std::string two_digits(double value)
{
  std::ostringstream out;
  out << std::setprecision(2) << value;
  return out.str();
}

/// How far march and double precision are apart at check_pixels × check_pixels pixels.
ImageErrors check_march(SceneMarch& march, const Watch& watch)
{
  const VolumeScene& scene = march.scene();
  const Film film = march.draw(check_pixels, check_pixels);
  const brume::Scene* plain = march.mapper()->UpdateScene(
    scene.volume, scene.camera, scene.lights, check_pixels, check_pixels);
  ReferenceSettings settings;
  settings.threads = scene.options.threads;
  settings.tolerance = check_tolerance;
  Film reference(check_pixels, check_pixels);
  ProgressBar bar("checking the truth", !scene.options.quiet && !watch);
  render_reference(*plain, settings, reference,
    [&](double done)
    {
      bar.update(done);
      return !InterruptionWatch::requested() && (!watch || watch(done));
    });
  bar.clear();
  InterruptionWatch::check(march.command());
  const double black[3] = { 0.0, 0.0, 0.0 };
  const auto picture = [&](const Film& light)
  { return Picture{ check_pixels, check_pixels, over_background(light, black) }; };
  return brume::measure(picture(film), picture(reference));
}

/// Sets the mapper to simulate all of the scene, with shadows by rays of these steps.
void simulate_all(vtkBrumeRayMarchMapper* mapper, double step, double shadow_step)
{
  mapper->SetTolerance(0.0);
  mapper->GetEffectPlan()->ForceNothing();
  mapper->SetShadowMethod(vtkBrumeRayMarchMapper::RayShadows);
  mapper->SetShadowSampleDistance(shadow_step);
  mapper->AutoAdjustSampleDistancesOff();
  mapper->SetSampleDistance(step);
}

}

bool only_absorbs(const VolumeScene& scene)
{
  return !scene.medium && !scene.fog;
}

void simulate_as_asked(SceneMarch& march, double step)
{
  vtkBrumeRayMarchMapper* mapper = march.mapper();
  mapper->SetTolerance(march.scene().options.tolerance);
  apply(march.scene().options.medium, mapper);
  mapper->AutoAdjustSampleDistancesOff();
  mapper->SetSampleDistance(step);
}

QuadratureFilm quadrature(const VolumeScene& scene,
  vtkBrumeVolumeMapper* mapper,
  vtkVolume* volume,
  const std::string& task,
  const char* command,
  const Watch& watch)
{
  const brume::Scene* plain =
    mapper->UpdateScene(volume, scene.camera, scene.lights, scene.width(), scene.height());
  if (!plain)
  {
    throw Failure(scene.options.input, "it cannot be drawn", "see brume info");
  }
  ReferenceSettings settings;
  settings.threads = scene.options.threads;
  QuadratureFilm truth{ Film(scene.width(), scene.height()), {}, settings.tolerance };
  for (int pieces = 1; pieces < settings.most_pieces; pieces *= 2)
  {
    ++truth.refinement_levels;
  }
  ProgressBar bar(task, !scene.options.quiet && !watch);
  truth.statistics = render_reference(*plain, settings, truth.film,
    [&](double done)
    {
      bar.update(done);
      return !InterruptionWatch::requested() && (!watch || watch(done));
    });
  bar.clear();
  InterruptionWatch::check(command);
  return truth;
}

SceneTruth truth_by_quadrature(SceneMarch& march, const Watch& watch)
{
  const VolumeScene& scene = march.scene();
  QuadratureFilm found = quadrature(
    scene, march.mapper(), scene.volume, "computing the truth", march.command(), watch);
  SceneTruth result;
  Truth& truth = result.truth;
  truth.method =
    "Brume's integrator in double precision: each stretch of a ray inside one voxel cell is cut into "
    "1, 2, 4, … pieces until the pixel changes by no more than " +
    nlohmann::json(found.tolerance).dump() +
    " of white. About a third of the last change remains as its error.";
  truth.refinement_levels = found.refinement_levels;
  truth.remaining_mean = found.statistics.mean_change / 3.0;
  truth.remaining_largest = found.statistics.largest_change / 3.0;
  truth.seconds = found.statistics.seconds;
  truth.picture = march.over(found.film);
  result.film = std::move(found.film);
  return result;
}

SceneTruth truth_by_march(SceneMarch& march, double step, const Watch& watch)
{
  const auto start = std::chrono::steady_clock::now();
  const VolumeScene& scene = march.scene();
  const double asked = step;
  // Through one density rays go cell by cell; else their steps get as short as the others.
  const bool by_cells = scene.options.density() && !scene.input.sparse;
  SceneTruth result;
  Truth& truth = result.truth;
  const auto march_with = [&](int level)
  {
    ProgressBar bar("computing the truth, steps halved " + std::to_string(level) + " times",
      !scene.options.quiet && !watch);
    march.watch(
      [&](double done)
      {
        bar.update(done);
        return !watch || watch(done);
      });
    simulate_all(march.mapper(), step, by_cells ? 0.0 : step);
    result.film = march.draw();
    march.watch({});
    return march.over(result.film);
  };
  truth.picture = march_with(0);
  bool settled = false;
  for (;;)
  {
    step *= 0.5;
    const Picture finer = march_with(++truth.refinement_levels);
    const ImageErrors change = brume::measure(truth.picture, finer);
    truth.picture = finer;
    truth.remaining_mean = change.mean_absolute / 3.0;
    truth.remaining_largest = change.largest / 3.0;
    settled =
      truth.remaining_largest <= settled_largest && truth.remaining_mean <= settled_mean;
    if (settled || truth.refinement_levels >= most_halvings ||
      step <= shortest_step * scene.voxel_edge)
    {
      break;
    }
  }
  const ImageErrors check = check_march(march, watch);
  truth.method =
    "Single scattering of every light: Brume's ray march with shadows by rays, its steps halved " +
    std::to_string(truth.refinement_levels) + " times, until the picture " +
    (settled ? "changed by no more than " + nlohmann::json(3.0 * settled_largest).dump() + " of white"
             : std::string("was as fine as is tried, and still changed")) +
    "; about a third of the last change remains as its error. "
    "Brume's integrator in double precision, which shares no arithmetic with it, was run for " +
    std::to_string(check_pixels * check_pixels) + " pixels spread over the view: they differ by " +
    two_digits(check.mean_absolute) + " of white in the mean and by " + two_digits(check.largest) +
    " at most.";
  truth.remaining_mean = std::max(truth.remaining_mean, check.mean_absolute);
  truth.remaining_largest = std::max(truth.remaining_largest, check.largest);
  truth.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  simulate_as_asked(march, asked);
  return result;
}

}
