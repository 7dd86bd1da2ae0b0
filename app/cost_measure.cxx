#include "cost_measure.h"

#include "command.h"
#include "interruption.h"
#include "render_timing.h"
#include "scene_truth.h"

#include "vtkBrumeFog.h"
#include "vtkBrumeMedium.h"
#include "vtkBrumeSky.h"
#include "vtkBrumeSparseVolume.h"

#include "vtkCamera.h"
#include "vtkImageData.h"
#include "vtkLightCollection.h"
#include "vtkPolyData.h"
#include "vtkVolume.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace brume::app
{

namespace
{

/// Of the study's time, what paths of a truth may take, and what is left for the settings at the least.
constexpr double share_of_truth = 0.4;
constexpr double share_of_settings = 0.5;
/// Of these, what is kept for several knobs at once.
constexpr double share_of_combined = 0.1;
/// A setting is drawn once at least, and again while all its renders take less than this multiple of an
/// even share of the time that is left.
constexpr double generosity = 2.0;
/// Renders quicker than this are always repeated as often as is asked.
constexpr double quick = 0.02;

}

/// A setting on its way.
struct CostMeasure::Job
{
  CostSetting setting;
  std::size_t knob = 0;
  bool has_finest = false;
  bool done = false;
  double first = 0.0; ///< seconds of the first render, preparation and measuring among them
};

CostMeasure::CostMeasure(
  CostScene& scene, const CostRequest& request, StudyClock& clock, Study& study)
  : Scene(scene)
  , Request(request)
  , Clock(clock)
  , Result(study)
{
}

bool CostMeasure::wants(const std::string& knob) const
{
  return this->Request.knobs.empty() ||
    std::find(this->Request.knobs.begin(), this->Request.knobs.end(), knob) != this->Request.knobs.end();
}

void CostMeasure::measure_truth()
{
  const VolumeScene& scene = this->Scene.scene();
  StudyTruth& truth = this->Result.truth;
  Film film;
  this->Clock.tell("the truth", this->Request.seconds);
  const Watch watch = [this](double) { return this->Clock.tick(); };
  SceneMarch& march = this->Scene.march().march();
  march.take_volume();
  // What light passes is the march's, in any case: paths leave it to that, too.
  if (is_truth_by_paths(scene))
  {
    this->Scene.TruthByPaths = true;
    truth = this->Scene.paths().truth(share_of_truth * this->Request.seconds, this->Clock, film);
  }
  else
  {
    SceneTruth found = only_absorbs(scene)
      ? truth_by_quadrature(march, watch)
      : truth_by_march(march, this->Scene.march().standard().step * scene.voxel_edge, watch);
    truth.kind = only_absorbs(scene) ? "quadrature" : "march";
    truth.truth = std::move(found.truth);
    film = std::move(found.film);
    truth.noise.mean = truth.noise.rms = truth.truth.remaining_mean;
    truth.noise.percentile_999 = truth.noise.largest = truth.truth.remaining_largest;
  }
  this->Result.depths = classes_by_depth(film.transmittance, truth.truth.picture);
  this->Result.outlines = classes_by_outline(film.transmittance, truth.truth.picture);
  this->Clock.allow_at_least(share_of_settings * this->Request.seconds);
}

double CostMeasure::expected(const std::vector<Job>& jobs, const Job& job) const
{
  double seconds = -1.0;
  double effort = 0.0;
  for (const Job& other : jobs)
  {
    // By the nearest effort below.
    if (other.done && other.setting.point.skipped.empty() && other.knob == job.knob &&
      other.setting.point.mapper == job.setting.point.mapper &&
      (other.setting.point.asked_seconds > 0.0) == (job.setting.point.asked_seconds > 0.0) && other.setting.effort > effort &&
      other.setting.effort <= job.setting.effort)
    {
      effort = other.setting.effort;
      // What comes before a render and after it does not grow with the effort.
      const double render = other.setting.point.timing.median;
      seconds = std::max(0.0, other.first - render) + render * job.setting.effort / effort;
    }
  }
  return seconds;
}

void CostMeasure::draw(Job& job, double share, double reserve)
{
  StudyPoint& point = job.setting.point;
  const double start = this->Clock.elapsed();
  const Watch watch = [&](double) { return this->Clock.tick() && this->Clock.left() > reserve; };
  try
  {
    CostRender render = job.setting.draw(watch);
    point.timing.prepare = render.prepare;
    point.timing.warm_up = render.seconds;
    job.first = this->Clock.elapsed() - start;
    std::vector<double> seconds;
    for (int i = 0; i < this->Request.repetitions; ++i)
    {
      InterruptionWatch::check("cost");
      const double next = this->Clock.elapsed() - start + render.seconds;
      if (i > 0 && render.seconds > quick && next > generosity * share)
      {
        break;
      }
      // A render that is slow does not gain by a warm-up: the first one counts.
      if (i == 0 && render.seconds > 0.5 * share)
      {
        seconds.push_back(render.seconds);
        continue;
      }
      const double prepare = point.timing.prepare;
      render = job.setting.draw(watch);
      point.timing.prepare = std::max(prepare, render.prepare);
      seconds.push_back(render.seconds);
    }
    summarise(seconds, point.timing);
    point.picture = std::move(render.picture);
    point.statistics = std::move(render.statistics);
    measure_point(point, this->Result);
  }
  catch (const SceneMarch::Stopped&)
  {
    InterruptionWatch::check("cost");
    point.skipped = "the study's time was over while it was drawn";
  }
  job.done = true;
}

void CostMeasure::run(std::vector<CostKnob> knobs, double reserve)
{
  std::vector<Job> jobs;
  for (std::size_t k = 0; k < knobs.size(); ++k)
  {
    this->Result.knobs.push_back(knobs[k].knob);
    for (CostSetting& setting : knobs[k].settings)
    {
      Job job;
      job.knob = k;
      job.has_finest = knobs[k].has_finest;
      job.done = !setting.point.skipped.empty();
      job.setting = std::move(setting);
      jobs.push_back(std::move(job));
    }
  }
  for (;;)
  {
    Job* next = nullptr;
    double shortest = 0.0;
    double all = 0.0;
    int left = 0;
    for (Job& job : jobs)
    {
      if (job.done)
      {
        continue;
      }
      ++left;
      const double seconds = this->expected(jobs, job);
      all += std::max(0.0, seconds) * 2.0;
      if (!next || seconds < shortest)
      {
        next = &job;
        shortest = seconds;
      }
    }
    if (!next)
    {
      break;
    }
    const double time = this->Clock.left() - reserve;
    if (time <= 0.0 || shortest > time)
    {
      next->setting.point.skipped = "there was no time left for it in this study";
      next->done = true;
      continue;
    }
    const auto done = std::count_if(jobs.begin(), jobs.end(), [](const Job& j) { return j.done; });
    this->Clock.tell("setting " + std::to_string(done + 1) + " of " + std::to_string(jobs.size()),
      std::min(time, std::max(all, 1.0)));
    this->draw(*next, time / left, reserve);
  }
  for (std::size_t k = 0; k < knobs.size(); ++k)
  {
    Job* finest = nullptr;
    for (Job& job : jobs)
    {
      const bool drawn = job.knob == k && job.setting.point.skipped.empty();
      if (drawn && (!finest || job.setting.effort >= finest->setting.effort))
      {
        finest = &job;
      }
    }
    if (finest && finest->has_finest)
    {
      finest->setting.point.finest = true;
    }
  }
  for (Job& job : jobs)
  {
    this->Result.points.push_back(std::move(job.setting.point));
  }
}

int CostMeasure::best_octaves() const
{
  const StudyPoint* best = nullptr;
  for (const StudyPoint& point : this->Result.points)
  {
    if (point.knob == "octaves" && point.skipped.empty() &&
      (!best || point.errors.measured.rms < best->errors.measured.rms))
    {
      best = &point;
    }
  }
  return best ? nlohmann::json::parse(best->settings)["octaves"].get<int>()
              : this->Scene.march().standard().octaves;
}

StepRule CostMeasure::best_rule() const
{
  const StudyPoint* best = nullptr;
  for (const StudyPoint& point : this->Result.points)
  {
    const bool longest = point.knob == "step" && point.setting.find(" 4 voxels") != std::string::npos;
    if (longest && point.skipped.empty() &&
      (!best || point.errors.measured.rms < best->errors.measured.rms))
    {
      best = &point;
    }
  }
  for (const StepRule rule : { StepRule::Integrated, StepRule::Cells })
  {
    if (best && best->setting.rfind(step_rule_name(rule), 0) == 0)
    {
      return rule;
    }
  }
  return StepRule::Midpoint;
}

void CostMeasure::measure_settings()
{
  std::vector<CostKnob> knobs;
  for (const std::string& name : knob_names())
  {
    if (this->wants(name) && name != "combined")
    {
      knobs.push_back(make_knob(name, this->Scene));
    }
  }
  const double reserve = this->wants("combined") ? share_of_combined * this->Clock.left() : 0.0;
  this->run(std::move(knobs), reserve);
  if (this->wants("combined"))
  {
    this->run({ make_combined_knob(this->Scene, this->best_rule(), this->best_octaves()) }, 0.0);
  }
  finish(this->Result);
  this->Clock.clear();
}

}
