#include "Transport/path_tracer.h"

#include "Transport/path_error.h"
#include "Transport/path_noise.h"
#include "Transport/path_pixels.h"
#include "Transport/path_scene.h"
#include "Transport/path_sights.h"
#include "Transport/step_control.h"
#include "Transport/thread_arena.h"

#include <tbb/blocked_range.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <thread>
#include <vector>

namespace brume
{

namespace
{

using Clock = std::chrono::steady_clock;

/// From so many paths a pixel on, standard errors are estimated.
constexpr int fewest_samples = PathSettings::fewest_samples;

/// Paths a pixel of one pass, at the most: a pass is what is waited for when time is short.
constexpr int most_of_pass = 64;

/// Paths that are handed out together, about: many enough that packets of them are full, and few enough that
/// no thread is waited for long.
constexpr int paths_at_once = 2048;
/// Pixels of a row that one thread does where their numbers of paths differ.
constexpr int own_stretch = 64;

/// How many times the seconds there are the first path of each pixel may take.
constexpr double patience = 4.0;

double seconds_since(Clock::time_point start)
{
  return std::chrono::duration<double>(Clock::now() - start).count();
}

void check(const PathSettings& settings, const Film& film)
{
  if (settings.samples_per_pixel < 1 || !(settings.tolerance >= 0.0) ||
      !(settings.seconds >= 0.0) || settings.most_scatterings < 0 || !(settings.step >= 0.0) ||
      !(settings.beyond > 0.0 && settings.beyond < 1.0))
  {
    throw std::invalid_argument("path tracing needs at least one sample a pixel, a tolerance, "
                                "a time, scatterings and a step that are not negative, and a share "
                                "of pixels between 0 and 1");
  }
  if (film.width < 1 || film.height < 1)
  {
    throw std::invalid_argument("the film has no pixels");
  }
}

/// The scene as what is behind it sees it: it dims, and nothing else.
Scene without_light(const Scene& scene)
{
  Scene dark = scene;
  dark.lights.clear();
  dark.sky.radiance = dark.sky.ground = glm::dvec3(0.0);
  for (Volume& volume : dark.volumes)
  {
    volume.medium = Medium();
    volume.shading.enabled = false;
  }
  return dark;
}

}

struct PathTracer::Kept
{
  Marcher Absorption;
  int Width = 0;
  int Height = 0;
  PathSums Paths;
  Film Behind; ///< transmittance and depth

  /// False where `go` ended it.
  bool begin(const Film& film, const std::function<bool()>& go)
  {
    this->Width = 0; // until there is something to go on from
    this->Height = 0;
    if (!this->Paths.clear(film.size(), go))
    {
      return false;
    }
    this->Behind = Film(film.width, film.height);
    return go();
  }
  bool fits(const Film& film) const
  {
    return this->Width == film.width && this->Height == film.height;
  }
  int fewest() const
  {
    return *std::min_element(this->Paths.samples.begin(), this->Paths.samples.end());
  }
  double mean_samples() const
  {
    double sum = 0.0;
    for (const int n : this->Paths.samples)
    {
      sum += n;
    }
    return sum / static_cast<double>(this->Paths.samples.size());
  }
};

PathTracer::PathTracer()
  : Internal(std::make_unique<Kept>())
{
}

PathTracer::~PathTracer() = default;

PathStatistics PathTracer::render(const Scene& scene,
  const PathSettings& settings,
  Film& film,
  const Progress& progress)
{
  check(settings, film);
  Kept& kept = *this->Internal;
  PathStatistics statistics;
  const auto begin = Clock::now();
  const PathScene paths(scene, settings.most_scatterings, settings.environment);
  statistics.threads = settings.threads > 0 ? settings.threads : tbb::info::default_concurrency();
  statistics.non_finite_voxels = paths.non_finite_voxels();
  if (paths.packets())
  {
    const std::string targets = simd_targets();
    statistics.simd = targets.substr(0, targets.find(' '));
  }
  if (!settings.resume || !kept.fits(film))
  {
    const auto go = [&] { return !progress || progress(0.0); };
    if (!go() || !kept.begin(film, go))
    {
      return statistics;
    }
    MarchSettings march;
    march.leave_error = 1e-5;
    march.threads = settings.threads;
    const Scene dark = without_light(scene);
    const double step = settings.step > 0.0      ? settings.step
                        : scene.volumes.empty() ? 1.0
                                                : 0.125 * smallest_voxel_edge(scene);
    const bool exact = follows_rule(dark, StepRule::Cells) && !paths.has_kinks();
    march.rule = exact ? StepRule::Cells : StepRule::Midpoint;
    march.step = march.rule == StepRule::Cells ? smallest_voxel_edge(scene) : step;
    const bool whole =
      kept.Absorption
        .render(dark, march, kept.Behind, [&](double) { return go(); })
        .completed;
    if (!whole)
    {
      return statistics;
    }
    kept.Width = film.width;
    kept.Height = film.height;
  }
  statistics.seconds_prepare = seconds_since(begin);

  const auto start = Clock::now();
  // Of the paths alone.
  const double seconds = std::max(
    settings.seconds - (settings.seconds_of_all ? statistics.seconds_prepare : 0.0), 0.0);
  const PathSights sights(scene, film.width, film.height);
  const std::thread::id caller = std::this_thread::get_id();
  std::atomic<bool> aborted{ false };
  std::atomic<std::uint64_t> collisions{ 0 };
  std::atomic<std::uint64_t> scatterings{ 0 };
  std::atomic<std::uint64_t> shadow_rays{ 0 };
  std::atomic<std::uint64_t> traced{ 0 };
  const int already = kept.fewest();
  std::atomic<bool> late{ false };
  double told = 0.0; // of the progress
  const auto tell = [&](double fraction)
  {
    told = fraction;
    return !progress || progress(fraction);
  };
  std::optional<PathNoise> noise; // of the paths there are
  const auto find_noise = [&]() -> const PathNoise&
  {
    if (!noise)
    {
      noise.emplace(kept.Paths, kept.Behind, statistics.threads, [&] { return tell(told); });
    }
    return *noise;
  };

  /// Brings every pixel to its target; `from` and `part` are of the progress.
  const auto pass = [&](const PathTargets& targets, double from, double part, bool may_be_late)
  {
    noise.reset();
    // Stretches of rows that one thread does; where pixels have their own numbers, nobody knows how many
    // paths are in one.
    const int each = std::max(targets.all - kept.fewest(), 1);
    const int stretch =
      std::clamp(targets.each ? own_stretch : paths_at_once / each, 1, film.width);
    const int stretches = (film.width + stretch - 1) / stretch;
    const int count = stretches * film.height;
    std::atomic<int> finished{ 0 };
    const auto done = [&] { return std::min(from + part * finished / count, 1.0); };
    ThreadArena arena(statistics.threads);
    arena.execute(
      [&]
      {
        tbb::parallel_for(
          tbb::blocked_range<int>(0, count, 1),
          [&](const tbb::blocked_range<int>& range)
          {
            for (int i = range.begin(); i != range.end(); ++i)
            {
              const int y = i / stretches;
              const int last = std::min((i % stretches + 1) * stretch, film.width);
              PathCounts counts;
              counts.look_up = [&]
              {
                // After the first pass, which the picture is nothing without, time is time.
                if (settings.seconds > 0.0 &&
                    seconds_since(start) > (may_be_late ? 1.0 : patience) * seconds)
                {
                  late = true;
                }
                if (std::this_thread::get_id() == caller && !tell(done()))
                {
                  aborted = true;
                }
                if (aborted || late)
                {
                  throw PathsStopped();
                }
              };
              int x = i % stretches * stretch;
              while (x < last && !aborted && !late)
              {
                // So many pixels at once that packets of paths are full, and no wait is long.
                int end = x;
                int many = 0;
                PathTargets some = targets;
                while (end < last && many < paths_at_once)
                {
                  const std::size_t pixel = static_cast<std::size_t>(y) * film.width + end;
                  const int first = kept.Paths.samples[pixel];
                  const int paths_more = targets.of(pixel) - first;
                  if (paths_more > paths_at_once)
                  {
                    // By itself, a part at a time.
                    some.all = end == x ? first + paths_at_once : targets.all;
                    end += end == x;
                    break;
                  }
                  many += std::max(paths_more, 0);
                  ++end;
                }
                try
                {
                  traced += trace_pixels(paths, sights, film.width, y, x, end, some, settings.seed,
                    kept.Paths, counts);
                }
                catch (const PathsStopped&)
                {
                  break; // without the paths in hand
                }
                const bool whole = some.all == targets.all;
                x = whole ? end : x;
                if (may_be_late && seconds_since(start) > seconds)
                {
                  late = true;
                }
                if (std::this_thread::get_id() == caller && !tell(done()))
                {
                  aborted = true;
                }
              }
              collisions += counts.collisions;
              scatterings += counts.scatterings;
              shadow_rays += counts.shadow_rays;
              ++finished;
            }
          },
          tbb::simple_partitioner());
      });
  };

  std::vector<int> targets;
  int target = already;
  while (paths.can_send() && target < settings.samples_per_pixel && !aborted && !late)
  {
    const bool timed = settings.seconds > 0.0;
    const bool estimated = kept.fewest() >= fewest_samples;
    PathError error;
    if (estimated && (settings.tolerance > 0.0 || settings.adaptive))
    {
      error = find_noise().error();
      if (noise->ended())
      {
        aborted = true;
        break;
      }
      if (settings.tolerance > 0.0 && error.quantile(settings.beyond) <= settings.tolerance)
      {
        break;
      }
    }
    const double done = static_cast<double>(traced);
    const double passed = seconds_since(start);
    // Paths that there is time for, of those that are to be traced.
    const double affordable =
      timed && done > 0.0 ? done * std::max(seconds - passed, 0.0) / std::max(passed, 1e-9) : 1e300;
    if (estimated && settings.adaptive)
    {
      // A little lower, so that the last pass is the last.
      double cap = settings.tolerance > 0.0
                     ? 0.99 * error.cap(settings.tolerance, settings.beyond)
                     : 0.0;
      double more = cap > 0.0 ? error.paths_to(cap) : 1e300;
      const bool short_of_time = more > affordable;
      if (short_of_time)
      {
        more = affordable;
        cap = error.cap_of(more);
      }
      find_noise().find_targets(cap, settings.samples_per_pixel, !short_of_time, targets);
      double in_pass = 0.0;
      for (std::size_t pixel = 0; pixel < targets.size(); ++pixel)
      {
        in_pass += targets[pixel] - kept.Paths.samples[pixel];
      }
      if (in_pass < 1.0 || (timed && affordable < 0.01 * done))
      {
        break;
      }
      more = std::max(more, in_pass);
      pass({ settings.samples_per_pixel, targets.data() },
        done / (done + more),
        in_pass / (done + more),
        timed);
      continue;
    }
    // Passes double at first, so that what is asked between them costs little.
    const int so_far = target - already;
    double more = std::clamp(so_far, 1, most_of_pass);
    if (settings.adaptive)
    {
      more = std::min<double>(more, std::max(fewest_samples - target, 1));
    }
    if (so_far > 0)
    {
      more = std::min(more, std::floor(affordable / std::max(done, 1.0) * so_far));
      if (more < 1.0)
      {
        // What is left of the time is for a part of a pass, where pixels need not be alike.
        if (!settings.adaptive || affordable < 0.02 * done)
        {
          break;
        }
        more = 1.0;
      }
    }
    const double all = std::max(settings.samples_per_pixel - already, 1);
    more = std::min<double>(more, settings.samples_per_pixel - target);
    target += static_cast<int>(more);
    pass({ target }, so_far / all, more / all, timed && so_far > 0);
  }
  if (!paths.can_send())
  {
    std::fill(kept.Paths.samples.begin(), kept.Paths.samples.end(), settings.samples_per_pixel);
  }
  if (!aborted)
  {
    find_noise().show(film);
    aborted = noise->ended();
  }
  if (aborted)
  {
    PathNoise(kept.Paths, kept.Behind, statistics.threads, {}).show(film);
  }
  statistics.samples_per_pixel = kept.fewest();
  statistics.mean_samples = kept.mean_samples();
  if (!aborted && (statistics.samples_per_pixel >= fewest_samples || !paths.can_send()))
  {
    const PathError error = find_noise().error();
    statistics.estimated_error = error.quantile();
    statistics.rms_error = error.rms();
  }
  aborted = aborted || (noise && noise->ended()) || !tell(1.0);
  statistics.seconds = seconds_since(start);
  statistics.paths = traced;
  statistics.collisions = collisions;
  statistics.scatterings = scatterings;
  statistics.shadow_rays = shadow_rays;
  statistics.completed = !aborted;
  return statistics;
}

}
