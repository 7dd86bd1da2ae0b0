#include "vtkBrumeSmartVolumeMapper.h"

#include "march_choices.h"
#include "march_report.h"
#include "path_report.h"

#include "Transport/film.h"
#include "Transport/method_choice.h"
#include "Transport/path_tracer.h"
#include "Transport/step_control.h"
#include "Transport/timed_march.h"

#include "vtkBrumeEffectPlan.h"
#include "vtkBrumeSky.h"
#include "vtkObjectFactory.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

namespace
{

using Clock = std::chrono::steady_clock;

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// Of the tolerance, what steps, shadows and leaving early have at the least beside a model's
/// error.
constexpr double least_of_march = 0.3;
/// Of a budget: where paths are to end, where a march is given up for the quicker one before.
constexpr double end_of_paths = 0.97;
constexpr double latest_end = 1.1;
/// Paths a pixel without which a picture is not worth its size, and the most.
constexpr double fewest_paths = 2.0;
constexpr int most_paths = std::numeric_limits<int>::max();

/// Steps that are long, in voxel edges: fewer rays may do with half of them.
constexpr double long_from = 2.0;

/// Rays along each side of the square that steps are chosen by: one for 64 pixels.
constexpr int fewest_of_step_edge = 16;
constexpr int most_of_step_edge = 64;

/// Null for what is not known, which JSON has in its place.
nlohmann::json number(double value)
{
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json(nullptr);
}

}

struct vtkBrumeSmartVolumeMapper::Internals
{
  brume::Marcher Marcher;
  brume::MarchChoices Choices;
  brume::PathTracer Tracer;
  brume::Scene Traced; ///< as paths see it: lit by the environment itself
  std::shared_ptr<const brume::PlacedEnvironment> Environment;
  brume::Scene Chosen; ///< the scene with the octaves that were chosen

  /// How far apart rays could be in the last picture that might have had fewer than pixels, and its
  /// steps, for the steps that were chosen.
  struct
  {
    double For = 0.0;
    int Distance = 0;
    double Step = 0.0;
  } Last;
};

/// One picture in the making.
struct vtkBrumeSmartVolumeMapper::Picture
{
  brume::Scene& Scene;
  brume::Film& Film;
  brume::MethodChoice Choice;
  Clock::time_point Start; ///< when the scene began to be brought up to date
  double Budget;           ///< 0: none
  bool Window = false;     ///< a final colour window
  nlohmann::json Statistics = nlohmann::json::object();
  double Predicted = unknown; ///< seconds of the render alone
  double Distance = 1.0;      ///< pixels between rays
  double Prepared = 0.0;      ///< seconds up to the render itself
  bool Best = false;          ///< no longer time would make it better
  bool Completed = false;

  double Passed() const
  {
    return std::chrono::duration<double>(Clock::now() - this->Start).count();
  }
};

vtkStandardNewMacro(vtkBrumeSmartVolumeMapper);

vtkBrumeSmartVolumeMapper::vtkBrumeSmartVolumeMapper()
  : Internal(std::make_unique<Internals>())
{
}

vtkBrumeSmartVolumeMapper::~vtkBrumeSmartVolumeMapper() = default;

void vtkBrumeSmartVolumeMapper::March(Picture& picture)
{
  brume::MarchChoices& choices = this->Internal->Choices;
  brume::ChoiceSettings wanted;
  wanted.tolerance =
    std::max(this->Tolerance - picture.Choice.model_error, least_of_march * this->Tolerance);
  wanted.beyond = picture.Choice.beyond;
  wanted.step_edge =
    std::clamp(static_cast<int>(std::sqrt(static_cast<double>(picture.Film.size())) / 8.0),
      fewest_of_step_edge,
      most_of_step_edge);
  wanted.forces = this->GetEffectPlan()->GetForces();
  wanted.threads = this->NumberOfThreads;
  choices.Update(this->Internal->Marcher, this->Internal->Chosen, wanted);
  this->GetEffectPlan()->SetPlan(choices.GetPlan());
  const brume::Scene& scene = choices.GetScene();
  brume::MarchSettings settings = choices.GetSettings();

  const double others =
    choices.GetEstimatedError() - choices.GetStepError() + picture.Choice.model_error;
  const double room = this->Tolerance - others;
  const brume::MarchForecast forecast = brume::forecast_march(this->Internal->Marcher,
    scene,
    settings,
    picture.Film.width,
    picture.Film.height,
    room,
    picture.Choice.beyond);
  double error = choices.GetStepError();
  double before = picture.Passed();
  brume::MarchStatistics march;
  const auto render = [&](brume::Film& film)
  {
    before = picture.Passed();
    march = this->Internal->Marcher.render(
      scene, settings, film, [this](double fraction) { return this->TellProgress(fraction); });
    return march.completed;
  };
  picture.Predicted = forecast.seconds;
  bool scaled = false;
  settings.step = forecast.step;
  // Where that is not within after all, with half the steps if they are long, then with more rays.
  bool shorten = settings.step >= long_from * brume::smallest_voxel_edge(scene);
  int distance = forecast.distance;
  auto& last = this->Internal->Last;
  if (last.For == choices.GetSettings().step && last.Distance <= distance)
  {
    distance = last.Distance; // what was too much for the last picture is not tried again
    settings.step = last.Step;
    shorten = false;
  }
  while (distance > 1 && !scaled)
  {
    const auto part = [distance](int size) { return (size + distance - 1) / distance; };
    brume::Film small(part(picture.Film.width), part(picture.Film.height));
    if (!render(small))
    {
      return;
    }
    error = brume::error_of_scaled(
      this->Internal->Marcher, scene, settings, small, picture.Choice.beyond);
    scaled = error <= room;
    if (scaled)
    {
      picture.Film = brume::scaled(small, picture.Film.width, picture.Film.height);
      picture.Distance = distance;
      picture.Predicted /= distance * distance;
    }
    else if (shorten)
    {
      settings.step *= 0.5;
      shorten = false;
    }
    else
    {
      distance /= 2;
    }
  }
  if (!scaled) // or the strips missed something
  {
    settings.step = choices.GetSettings().step;
    error = choices.GetStepError();
    render(picture.Film);
  }
  if (forecast.distance > 1)
  {
    last = { choices.GetSettings().step, distance, settings.step };
  }
  picture.Prepared = before + march.seconds_prepare;
  if (march.rays == 0)
  {
    choices.Forget(); // nothing was measured
  }
  picture.Statistics =
    brume::statistics_of(scene, settings, march, choices.GetPlan(), picture.Window);
  picture.Statistics["step_chosen_by"] = "tolerance";
  picture.Statistics["estimated_error"] = others + error;
  picture.Statistics["tolerance_met"] =
    choices.IsToleranceMet() && picture.Choice.model_error <= this->Tolerance;
  if (brume::is_lit(scene))
  {
    picture.Statistics["shadows_chosen_by"] = choices.HasChosenShadows() ? "tolerance" : "caller";
  }
  this->SecondsRender = march.seconds;
  picture.Completed = march.completed;
}

void vtkBrumeSmartVolumeMapper::MarchWithin(Picture& picture)
{
  brume::MarchChoices& choices = this->Internal->Choices;
  brume::ChoiceSettings wanted;
  wanted.tolerance = 0.0; // all effects; leaving early, by what the picture can show
  wanted.forces = this->GetEffectPlan()->GetForces();
  wanted.choose_shadows = false;
  wanted.choose_step = false;
  wanted.threads = this->NumberOfThreads;
  choices.Update(this->Internal->Marcher, this->Internal->Chosen, wanted);
  this->GetEffectPlan()->SetPlan(choices.GetPlan());
  const brume::Scene& scene = choices.GetScene();
  brume::MarchSettings settings = choices.GetSettings();
  settings.leave_error = 1e-4;

  const double passed = picture.Passed();
  const brume::TimedMarch timed = brume::march_within(this->Internal->Marcher,
    scene,
    settings,
    std::max(picture.Budget - passed, 1e-3),
    std::max(latest_end * picture.Budget - passed, 1e-3),
    this->Tolerance,
    picture.Film,
    [this](double fraction) { return this->TellProgress(fraction); });
  picture.Prepared = picture.Passed() - timed.march.seconds;
  picture.Predicted = timed.predicted;
  picture.Distance = timed.distance;
  picture.Best = timed.finest;
  picture.Statistics =
    brume::statistics_of(scene, settings, timed.march, choices.GetPlan(), picture.Window);
  picture.Statistics["step_chosen_by"] = "time budget";
  const double error = timed.estimated_error + settings.leave_error + picture.Choice.model_error;
  picture.Statistics["estimated_error"] = number(error);
  picture.Statistics["tolerance_met"] = error <= this->Tolerance;
  this->SecondsRender = timed.march.seconds;
  picture.Completed = timed.completed;
}

void vtkBrumeSmartVolumeMapper::Trace(Picture& picture)
{
  brume::PathSettings settings;
  settings.samples_per_pixel = most_paths;
  settings.tolerance = this->Tolerance;
  settings.beyond = picture.Choice.beyond;
  settings.adaptive = true;
  settings.seed = this->Seed;
  settings.threads = this->NumberOfThreads;
  brume::Film* film = &picture.Film;
  brume::Film small;
  brume::Scene smaller;
  settings.environment = this->Internal->Environment;
  const brume::Scene* scene = &this->Internal->Traced;
  const double before = picture.Passed();
  if (picture.Budget > 0.0)
  {
    settings.seconds = std::max(end_of_paths * picture.Budget - before, 1e-3);
    settings.seconds_of_all = true;
    const double seconds_of_path =
      picture.Choice.probe_seconds_of_path * fewest_paths * static_cast<double>(film->size());
    if (seconds_of_path > settings.seconds)
    {
      picture.Distance = std::sqrt(seconds_of_path / settings.seconds);
      const auto part = [&picture](int size)
      { return std::max(1, static_cast<int>(size / picture.Distance)); };
      small = brume::Film(part(film->width), part(film->height));
      smaller = brume::for_size(*scene, film->width, film->height, small.width, small.height);
      scene = &smaller;
      film = &small;
    }
  }
  picture.Predicted = picture.Choice.seconds;
  const brume::PathStatistics paths = this->Internal->Tracer.render(
    *scene, settings, *film, [this](double fraction) { return this->TellProgress(fraction); });
  picture.Prepared = before + paths.seconds_prepare;
  if (film == &small)
  {
    picture.Film = brume::scaled(small, picture.Film.width, picture.Film.height);
  }
  const brume::EffectPlan plan =
    brume::plan_of_paths(this->Internal->Traced, 0, settings.environment != nullptr);
  this->GetEffectPlan()->SetPlan(plan);
  picture.Statistics = brume::statistics_of(picture.Scene, settings, paths, plan, picture.Window);
  picture.Statistics["tolerance_met"] =
    paths.estimated_error <= this->Tolerance && picture.Distance <= 1.0;
  if (picture.Distance > 1.0)
  {
    picture.Statistics["estimated_error"] = nullptr; // what is between the rays is not known
  }
  else if (!std::isfinite(paths.estimated_error))
  {
    // Too few paths a pixel for its own noise: by that of the probe.
    picture.Statistics["estimated_error"] =
      brume::errors_within(0.001) *
      std::sqrt(picture.Choice.variance / std::max<double>(static_cast<double>(paths.paths), 1.0));
  }
  this->SecondsRender = paths.seconds;
  picture.Completed = paths.completed;
}

bool vtkBrumeSmartVolumeMapper::RenderScene(brume::Scene& scene, brume::Film& film)
{
  const bool window = this->FinalColorWindow != 1.0f || this->FinalColorLevel != 0.5f;
  const auto spent =
    std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(this->SecondsScene));
  Picture picture{ scene, film, {}, Clock::now() - spent, this->TimeBudget, window };
  const brume::Progress tell = [this](double fraction) { return this->TellProgress(fraction); };
  // Choices are made by many small renders.
  this->Internal->Marcher.set_watch([this] { return this->TellProgress(0.0); });

  brume::MethodWish wish;
  wish.tolerance = this->Tolerance;
  wish.seconds = this->TimeBudget > 0.0 ? std::max(this->TimeBudget - picture.Passed(), 1e-3) : 0.0;
  wish.width = film.width;
  wish.height = film.height;
  wish.threads = this->NumberOfThreads;
  wish.seed = this->Seed;
  this->Internal->Traced = scene;
  this->Internal->Environment = nullptr;
  if (vtkBrumeSky* sky = this->GetSkyInUse())
  {
    this->Internal->Environment = sky->TakeEnvironment(this->Internal->Traced.lights);
  }
  wish.traced = &this->Internal->Traced;
  wish.environment = this->Internal->Environment;
  wish.forced = !this->GetEffectPlan()->GetForces().empty();
  picture.Choice = brume::choose_method(this->Internal->Marcher, scene, wish, tell);
  if (picture.Choice.aborted)
  {
    return false;
  }
  const brume::MethodChoice& choice = picture.Choice;
  const bool timed = this->TimeBudget > 0.0;
  if (choice.method == brume::Method::Paths)
  {
    this->Trace(picture);
  }
  else
  {
    this->Internal->Chosen = brume::with_octaves(scene, choice.octaves);
    timed ? this->MarchWithin(picture) : this->March(picture);
  }

  nlohmann::json& statistics = picture.Statistics;
  const double seconds = picture.Passed();
  nlohmann::json options = nlohmann::json::array();
  for (const brume::MethodOption& option : choice.options)
  {
    nlohmann::json entry{ { "method", brume::method_name(option.method) },
      { "seconds", number(option.seconds) },
      { "error", number(option.error) },
      { "verdict", option.verdict } };
    if (option.method == brume::Method::March)
    {
      entry["octaves"] = option.octaves;
    }
    options.push_back(entry);
  }
  const double shares[] = { 0.8, 1.2 };
  statistics["mapper"] = "smart";
  statistics["method"] = { { "chosen", brume::method_name(choice.method) },
    { "octaves", choice.octaves },
    { "reason", choice.reason },
    { "compared", choice.compared },
    { "predicted_seconds", number(picture.Predicted) },
    { "predicted_error", number(choice.error) },
    { "model_error", choice.model_error },
    { "seconds", seconds },
    { "expected_beyond", choice.beyond },
    { "probe",
      { { "rays", choice.probe_rays },
        { "paths", choice.probe_paths },
        { "seconds", choice.probe_seconds } } },
    { "options", options } };
  statistics["seconds_prepare"] = picture.Prepared;
  statistics["image_sample_distance"] = this->ImageSampleDistanceInUse * picture.Distance;
  statistics["tolerance"] = this->Tolerance;
  if (timed)
  {
    statistics["time_budget"] = this->TimeBudget;
    const bool early = seconds < shares[0] * this->TimeBudget;
    statistics["time_budget_met"] = seconds <= shares[1] * this->TimeBudget;
    statistics["ended_early"] = !early ? nlohmann::json(nullptr)
                                : statistics["tolerance_met"].get<bool>()
                                  ? nlohmann::json("the tolerance was met sooner")
                                  : nlohmann::json("the best setting took less");
  }
  statistics["ignored_settings"] = this->IgnoredSettings;
  this->Statistics = statistics.dump(2);
  return picture.Completed;
}

void vtkBrumeSmartVolumeMapper::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "TimeBudget: " << this->TimeBudget << "\n";
  os << indent << "Seed: " << this->Seed << "\n";
}
