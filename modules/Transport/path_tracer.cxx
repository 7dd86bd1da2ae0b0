#include "Transport/path_tracer.h"

#include "Transport/path_error.h"
#include "Transport/path_pixels.h"
#include "Transport/path_scene.h"
#include "Transport/path_sights.h"
#include "Transport/step_control.h"

#include <tbb/blocked_range.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <thread>
#include <vector>

namespace brume
{

namespace
{

using Clock = std::chrono::steady_clock;

/// From so many paths a pixel on, standard errors are estimated.
constexpr int fewest_samples = 16;

/// Paths a pixel of one pass, at the most: a pass is what is waited for when time is short.
constexpr int most_of_pass = 64;

/// Paths that are handed out together, about.
constexpr int paths_at_once = 4096;

double seconds_since(Clock::time_point start)
{
  return std::chrono::duration<double>(Clock::now() - start).count();
}

void check(const PathSettings& settings, const Film& film)
{
  if (settings.samples_per_pixel < 1 || !(settings.tolerance >= 0.0) ||
      !(settings.seconds >= 0.0) || settings.most_scatterings < 0 || !(settings.step >= 0.0))
  {
    throw std::invalid_argument("path tracing needs at least one sample a pixel, and a tolerance, "
                                "a time, scatterings and a step that are not negative");
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

  void begin(const Film& film)
  {
    this->Width = 0; // until there is something to go on from
    this->Height = 0;
    this->Paths = PathSums(film.size());
    this->Behind = Film(film.width, film.height);
  }
  bool fits(const Film& film) const
  {
    return this->Width == film.width && this->Height == film.height;
  }
  int fewest() const
  {
    return *std::min_element(this->Paths.samples.begin(), this->Paths.samples.end());
  }
  int fewest_of_row(int y) const
  {
    const auto row = this->Paths.samples.begin() + static_cast<std::ptrdiff_t>(y) * this->Width;
    return *std::min_element(row, row + this->Width);
  }

  /// The variance of the mean of a pixel's paths.
  double variance(std::size_t pixel, int channel) const
  {
    const int n = this->Paths.samples[pixel];
    const double sum = this->Paths.sums[3 * pixel + channel];
    const double mean = sum / n;
    return n < 2 ? 0.0
                 : std::max(this->Paths.squares[3 * pixel + channel] - sum * mean, 0.0) /
                     (static_cast<double>(n) * (n - 1));
  }
  PathError error() const
  {
    PathError error;
    for (int y = 0; y < this->Height; ++y)
    {
      for (int x = 0; x < this->Width; ++x)
      {
        double v[3];
        for (int c = 0; c < 3; ++c)
        {
          double around = 0.0;
          int count = 0;
          for (int j = std::max(y - 1, 0); j <= std::min(y + 1, this->Height - 1); ++j)
          {
            for (int i = std::max(x - 1, 0); i <= std::min(x + 1, this->Width - 1); ++i, ++count)
            {
              around += this->variance(static_cast<std::size_t>(j) * this->Width + i, c);
            }
          }
          const double own = this->variance(static_cast<std::size_t>(y) * this->Width + x, c);
          v[c] = std::isnan(own) ? own : std::max(own, around / count);
        }
        error.add(v);
      }
    }
    return error;
  }
  void show(Film& film) const
  {
    film.transmittance[0] = this->Behind.transmittance[0];
    film.transmittance[1] = this->Behind.transmittance[1];
    film.transmittance[2] = this->Behind.transmittance[2];
    film.depth = this->Behind.depth;
    for (std::size_t pixel = 0; pixel < film.size(); ++pixel)
    {
      const int n = std::max(this->Paths.samples[pixel], 1);
      double largest = 0.0;
      for (int c = 0; c < 3; ++c)
      {
        film.radiance[c][pixel] = static_cast<float>(this->Paths.sums[3 * pixel + c] / n);
        largest = std::max(largest, this->variance(pixel, c));
      }
      film.error[pixel] = static_cast<float>(3.0 * std::sqrt(largest));
    }
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
  if (!settings.resume || !kept.fits(film))
  {
    kept.begin(film);
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
        .render(dark, march, kept.Behind, [&](double) { return !progress || progress(0.0); })
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
  const PathSights sights(scene, film.width, film.height);
  const std::thread::id caller = std::this_thread::get_id();
  std::atomic<bool> aborted{ false };
  std::atomic<std::uint64_t> collisions{ 0 };
  std::atomic<std::uint64_t> scatterings{ 0 };
  std::atomic<std::uint64_t> shadow_rays{ 0 };
  std::atomic<std::uint64_t> traced{ 0 };
  const int already = kept.fewest();

  /// Brings every pixel to `target` paths.
  const auto pass = [&](int target)
  {
    std::atomic<int> rows{ 0 };
    const double all = std::max(settings.samples_per_pixel - already, 1);
    const double before = (kept.fewest() - already) / all;
    const double part = (target - kept.fewest()) / all;
    tbb::task_arena arena(statistics.threads);
    arena.execute(
      [&]
      {
        tbb::parallel_for(
          tbb::blocked_range<int>(0, film.height, 1),
          [&](const tbb::blocked_range<int>& range)
          {
            for (int y = range.begin(); y != range.end(); ++y)
            {
              PathCounts counts;
              // So many pixels at once that packets of paths are full, and no wait is long.
              const int more = std::max(target - kept.fewest_of_row(y), 1);
              const int together = std::max(paths_at_once / more, 1);
              for (int x = 0; x < film.width && !aborted; x += together)
              {
                traced += trace_pixels(paths,
                  sights,
                  film.width,
                  y,
                  x,
                  std::min(x + together, film.width),
                  target,
                  settings.seed,
                  kept.Paths,
                  counts);
                if (progress && std::this_thread::get_id() == caller &&
                    !progress(before + part * rows / film.height))
                {
                  aborted = true;
                }
              }
              collisions += counts.collisions;
              scatterings += counts.scatterings;
              shadow_rays += counts.shadow_rays;
              ++rows;
            }
          },
          tbb::simple_partitioner());
      });
  };

  int target = already;
  while (paths.can_send() && target < settings.samples_per_pixel && !aborted)
  {
    if (settings.tolerance > 0.0 && target >= fewest_samples &&
        kept.error().quantile() <= settings.tolerance)
    {
      break;
    }
    // Passes double at first, so that what is asked between them costs little.
    const int done = target - already;
    double more = std::clamp(done, 1, most_of_pass);
    if (settings.seconds > 0.0 && done > 0)
    {
      const double passed = seconds_since(start);
      more =
        std::min(more, std::floor(done * (settings.seconds - passed) / std::max(passed, 1e-9)));
      if (more < 1.0)
      {
        break;
      }
    }
    target += static_cast<int>(std::min<double>(more, settings.samples_per_pixel - target));
    pass(target);
  }
  if (!paths.can_send())
  {
    std::fill(kept.Paths.samples.begin(), kept.Paths.samples.end(), settings.samples_per_pixel);
  }
  kept.show(film);
  statistics.samples_per_pixel = kept.fewest();
  if (statistics.samples_per_pixel >= fewest_samples || !paths.can_send())
  {
    const PathError error = kept.error();
    statistics.estimated_error = error.quantile();
    statistics.rms_error = error.rms();
  }
  if (progress && !aborted && !progress(1.0))
  {
    aborted = true;
  }
  statistics.seconds = seconds_since(start);
  statistics.paths = traced;
  statistics.collisions = collisions;
  statistics.scatterings = scatterings;
  statistics.shadow_rays = shadow_rays;
  statistics.completed = !aborted;
  return statistics;
}

}
