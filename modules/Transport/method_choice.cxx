#include "Transport/method_choice.h"

#include "Transport/step_control.h"
#include "Transport/timed_march.h"

#include <glm/vec3.hpp>

#include <tbb/info.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace brume
{

namespace
{

using Clock = std::chrono::steady_clock;

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

constexpr std::size_t fewest_rays = 64;
constexpr std::size_t most_rays = 1024;
constexpr int first_samples = PathSettings::fewest_samples;
constexpr int least_samples = 4; ///< whatever the time
/// Paths of a probed ray, at the most.
constexpr int most_samples = 1 << 16;
/// What a probe may take of the time of what it is made for.
constexpr double share_of_probe = 0.05;
/// What a march takes before it begins, at the least: shadows by voxel and light, and choices.
/// Paths that take no more than so many times as long are traced without a comparison.
constexpr double seconds_of_shadow_voxel = 30e-9; // of one thread
constexpr double seconds_of_choices = 0.1;
constexpr double times_of_march = 2.0;
/// A difference of so many standard errors is none by chance.
constexpr double sure = 4.0;
/// Of the root mean square, what 99.9 % of the errors are taken to be below: 3.3 were they normally
/// distributed, and some more as they are not.
constexpr double tail = 4.5;
constexpr double normal_tail = 3.3;
/// The part of the tolerance that the model of a march may use; steps, shadows and the like have
/// the rest.
constexpr double share_of_model = 0.7;
/// Chance to turn down a march that is good enough.
constexpr double doubt = 0.01;
constexpr int trial_octaves[] = { 0, 1, 8 };

double seconds_since(Clock::time_point start)
{
  return std::chrono::duration<double>(Clock::now() - start).count();
}

double largest(const glm::dvec3& v)
{
  return std::max({ v.x, v.y, v.z });
}

/// The chance of `least` or more of `count` draws, each of the chance `share`.
double chance_of(std::size_t least, std::size_t count, double share)
{
  double chance = std::pow(1.0 - share, static_cast<double>(count));
  double below = 0.0;
  for (std::size_t k = 0; k < least; ++k)
  {
    below += chance;
    chance *= share / (1.0 - share) * static_cast<double>(count - k) / static_cast<double>(k + 1);
  }
  return std::max(1.0 - below, 0.0);
}

template <class... Parts>
std::string words(const Parts&... parts)
{
  std::ostringstream text;
  text.precision(3);
  (text << ... << parts);
  return text.str();
}

std::string name_of_march(int octaves)
{
  return octaves == 0   ? "a ray march with the octaves of its media"
         : octaves == 1 ? "a ray march of single scattering"
                        : words("a ray march with ", octaves, " octaves");
}

}

const char* method_name(Method method)
{
  return method == Method::March ? "raymarch" : "pathtrace";
}

bool scatters(const Scene& scene)
{
  const bool light =
    !scene.lights.empty() || largest(scene.sky.radiance) > 0.0 || largest(scene.sky.ground) > 0.0;
  return scene.blend_mode == BlendMode::Composite && light &&
         (scene.fog.enabled ||
           std::any_of(scene.volumes.begin(),
             scene.volumes.end(),
             [](const Volume& v) { return v.medium.lit && largest(v.medium.albedo) > 0.0; }));
}

std::string why_no_paths(const Scene& scene)
{
  const auto any = [&scene](auto condition)
  { return std::any_of(scene.volumes.begin(), scene.volumes.end(), condition); };
  if (scene.blend_mode != BlendMode::Composite)
  {
    return "paths are traced in composite mode alone";
  }
  if (scene.volumes.empty())
  {
    return "there is no volume";
  }
  if (any([](const Volume& v) { return v.shading.enabled; }))
  {
    return "gradient shading is no transport, and paths do not draw it";
  }
  if (any([](const Volume& v) { return v.medium.lit && v.medium.silver_lining.enabled; }))
  {
    return "silver lining is no physics, and paths do not draw it";
  }
  if (any([](const Volume& v) { return v.medium.lit && v.medium.powder.enabled; }))
  {
    return "powder is no physics, and paths do not draw it";
  }
  return "";
}

double expected_beyond(std::size_t pixels)
{
  const double n = static_cast<double>(std::max<std::size_t>(pixels, 1));
  const auto allowed = static_cast<std::size_t>(0.001 * n);
  double low = 1e-9;
  double high = 0.001;
  while (high > 1.001 * low)
  {
    const double middle = std::sqrt(low * high);
    (chance_of(allowed + 1, pixels, middle) > 0.01 ? high : low) = middle;
  }
  return low;
}

double errors_within(double beyond)
{
  double low = 0.0;
  double high = 40.0;
  while (high - low > 1e-6)
  {
    const double middle = 0.5 * (low + high);
    (std::erfc(middle / std::sqrt(2.0)) > beyond ? low : high) = middle;
  }
  return high;
}

Scene with_octaves(const Scene& scene, int octaves)
{
  Scene other = scene;
  for (Volume& volume : other.volumes)
  {
    if (octaves > 0 && volume.medium.lit)
    {
      volume.medium.octaves.count = octaves;
    }
  }
  return other;
}

MethodProbe::MethodProbe(const Scene& scene,
  const Scene& traced,
  std::shared_ptr<const PlacedEnvironment> environment,
  int width,
  int height,
  std::uint32_t seed,
  int threads)
  : TheScene(scene)
  , Environment(std::move(environment))
  , Pixels(static_cast<std::size_t>(width) * height)
  , Seed(seed)
  , Threads(threads)
{
  const double rays = std::clamp<double>(static_cast<double>(this->Pixels) / pixels_of_ray,
    static_cast<double>(fewest_rays),
    static_cast<double>(most_rays));
  const double ratio = std::sqrt(rays / static_cast<double>(this->Pixels));
  const auto part = [ratio](int size)
  { return std::clamp(static_cast<int>(std::lround(size * ratio)), 1, size); };
  this->Truth = Film(part(width), part(height));
  this->Seen = for_size(scene, width, height, this->Truth.width, this->Truth.height);
  this->Traced = for_size(traced, width, height, this->Truth.width, this->Truth.height);
}

MethodProbe::~MethodProbe() = default;

bool MethodProbe::trace(int samples, double seconds, const Progress& progress)
{
  PathSettings settings;
  settings.samples_per_pixel = samples;
  settings.seconds = seconds;
  settings.resume = this->Samples > 0;
  settings.seed = this->Seed + 0x5eed; // other paths than the picture's
  settings.threads = this->Threads;
  settings.environment = this->Environment;
  const PathStatistics statistics =
    this->Tracer.render(this->Traced, settings, this->Truth, progress);
  this->Samples = statistics.samples_per_pixel;
  this->Followed += statistics.paths;
  this->Seconds += statistics.seconds;
  return statistics.completed;
}

double MethodProbe::seconds_of_path() const
{
  return this->Followed > 0 ? this->Seconds / static_cast<double>(this->Followed) : 0.0;
}

double MethodProbe::paths_for(double tolerance, double beyond) const
{
  const double cap = tolerance / errors_within(beyond);
  double sum = 0.0;
  for (const float three : this->Truth.error)
  {
    const double error = three / 3.0;
    if (error > 0.0)
    {
      sum += std::max<double>(first_samples, this->Samples * (error / cap) * (error / cap));
    }
  }
  return sum * static_cast<double>(this->Pixels) / static_cast<double>(this->Truth.size());
}

double MethodProbe::variance() const
{
  double sum = 0.0;
  for (const float three : this->Truth.error)
  {
    sum += this->Samples * (three / 3.0) * (three / 3.0);
  }
  return sum * static_cast<double>(this->Pixels) / static_cast<double>(this->Truth.size());
}

double MethodProbe::error_of(double paths, double beyond) const
{
  return errors_within(beyond) * std::sqrt(this->variance() / std::max(paths, 1.0));
}

MarchFit MethodProbe::fit(Marcher& marcher, int octaves, double tolerance)
{
  MarchFit fit;
  fit.octaves = octaves;
  const auto made = this->Marched.emplace(octaves, Film(this->Truth.width, this->Truth.height));
  Film& marched = made.first->second;
  if (made.second)
  {
    MarchSettings settings;
    settings.step = smallest_voxel_edge(this->TheScene);
    settings.leave_error = std::max(0.1 * tolerance, 1e-5);
    settings.threads = this->Threads;
    marcher.render(with_octaves(this->Seen, octaves), settings, marched);
  }
  double sum = 0.0;
  double squares = 0.0;
  for (std::size_t pixel = 0; pixel < marched.size(); ++pixel)
  {
    const double error = this->Truth.error[pixel] / 3.0;
    double difference = 0.0;
    for (int c = 0; c < 3; ++c)
    {
      difference = std::max(
        difference, std::abs(double(marched.radiance[c][pixel]) - this->Truth.radiance[c][pixel]));
    }
    if (!(difference > 0.0) && !(error > 0.0))
    {
      continue;
    }
    ++fit.rays;
    fit.outside += difference - sure * error > tolerance;
    const double square = difference * difference - error * error;
    sum += square;
    squares += square * square;
  }
  if (fit.rays == 0)
  {
    return fit;
  }
  const double n = static_cast<double>(fit.rays);
  const double mean = sum / n;
  const double spread = std::sqrt(std::max(squares / n - mean * mean, 0.0) / n);
  fit.rms = std::sqrt(std::max(mean, 0.0));
  fit.rms_above = std::sqrt(std::max(mean, 0.0) + 2.0 * spread);
  fit.error = tail * fit.rms;
  fit.error_above = tail * fit.rms_above;
  return fit;
}

namespace
{

/// One choice in the making.
class Chooser
{
public:
  Chooser(Marcher& marcher, const Scene& scene, const MethodWish& wish, const Progress& progress)
    : TheMarcher(marcher)
    , TheScene(scene)
    , Wish(wish)
    , TheProgress(progress)
    , Probe(scene,
        wish.traced ? *wish.traced : scene,
        wish.environment,
        wish.width,
        wish.height,
        wish.seed,
        wish.threads)
    , Pixels(static_cast<std::size_t>(wish.width) * wish.height)
  {
    this->Choice.compared = true;
    this->Choice.beyond = expected_beyond(this->Pixels);
  }

  MethodChoice choose()
  {
    const auto start = Clock::now();
    // A probe for a time may take a part of that.
    const double limit = this->Wish.seconds > 0.0 ? share_of_probe * this->Wish.seconds : 0.0;
    if (!this->trace(least_samples, 0.0) || !this->trace(first_samples, limit))
    {
      return this->Choice;
    }
    this->estimate_paths();
    const bool at_once =
      this->Wish.seconds <= 0.0 && this->Choice.seconds <= times_of_march * this->least_of_march();
    if (at_once)
    {
      this->take_paths(words("a picture of ",
        this->Choice.seconds,
        " s by paths is smaller work than to find out whether a ray march would do"));
    }
    else if (this->Wish.seconds > 0.0 && !(this->Wish.tolerance > 0.0 && this->paths_fit()))
    {
      this->choose_by_time();
    }
    else
    {
      this->choose_by_error();
    }
    this->Choice.variance = this->Probe.variance();
    this->Choice.probe_rays = this->Probe.rays();
    this->Choice.probe_paths = this->Probe.paths();
    this->Choice.probe_seconds_of_path = this->Probe.seconds_of_path();
    this->Choice.probe_seconds = seconds_since(start);
    return this->Choice;
  }

private:
  bool trace(int samples, double seconds)
  {
    const bool whole = this->Probe.trace(
      samples, seconds, [this](double) { return !this->TheProgress || this->TheProgress(0.0); });
    this->Choice.aborted |= !whole;
    return whole;
  }

  /// Seconds that a march takes before it begins.
  double least_of_march() const
  {
    double voxels = 0.0;
    for (const Volume& volume : this->TheScene.volumes)
    {
      voxels += volume.medium.lit ? static_cast<double>(volume.grid.dims[0]) * volume.grid.dims[1] *
                                      volume.grid.dims[2]
                                  : 0.0;
    }
    const int threads =
      this->Wish.threads > 0 ? this->Wish.threads : tbb::info::default_concurrency();
    return seconds_of_choices + seconds_of_shadow_voxel * voxels *
                                  static_cast<double>(this->TheScene.lights.size()) / threads;
  }
  double path_seconds(double paths) const { return paths * this->Probe.seconds_of_path(); }
  bool paths_fit() const { return this->Choice.seconds <= this->Wish.seconds; }

  void estimate_paths()
  {
    this->Choice.seconds =
      this->Wish.tolerance > 0.0
        ? this->path_seconds(this->Probe.paths_for(this->Wish.tolerance, this->Choice.beyond))
        : std::numeric_limits<double>::infinity();
    this->Choice.error = this->Wish.tolerance;
  }

  void add(Method method, int octaves, double seconds, double error, const std::string& verdict)
  {
    this->Choice.options.push_back({ method, octaves, seconds, error, verdict });
  }

  void take_paths(const std::string& reason)
  {
    this->Choice.method = Method::Paths;
    this->Choice.reason = reason;
    this->add(Method::Paths, 0, this->Choice.seconds, this->Choice.error, "chosen");
  }

  void take_march(const MarchFit& fit, const std::string& reason)
  {
    this->Choice.method = Method::March;
    this->Choice.octaves = fit.octaves;
    this->Choice.model_error =
      std::min(fit.error_above, fit.error > 0.0 ? 2.0 * fit.error : fit.error_above);
    this->Choice.error = this->Choice.model_error;
    this->Choice.reason = reason;
    this->Choice.seconds = unknown; // until its steps are chosen
    this->add(Method::March, fit.octaves, unknown, this->Choice.model_error, "chosen");
  }

  /// The marches that may be tried: not one twice.
  std::vector<int> trials() const
  {
    std::vector<int> list;
    for (const int octaves : trial_octaves)
    {
      const bool same =
        octaves > 0 && std::all_of(this->TheScene.volumes.begin(),
                         this->TheScene.volumes.end(),
                         [octaves](const Volume& v)
                         { return !v.medium.lit || v.medium.octaves.count == octaves; });
      if (!same)
      {
        list.push_back(octaves);
      }
    }
    return list;
  }

  void choose_by_error()
  {
    const double tolerance = this->Wish.tolerance;
    std::vector<int> left = this->trials();
    for (int samples = 2 * first_samples;; samples *= 2)
    {
      std::vector<int> open;
      for (const int octaves : left)
      {
        const MarchFit fit = this->Probe.fit(this->TheMarcher, octaves, tolerance);
        if (chance_of(fit.outside, fit.rays, 0.001) < doubt)
        {
          this->add(Method::March,
            octaves,
            unknown,
            fit.error,
            words(fit.outside, " of ", fit.rays, " probed rays are surely beyond the tolerance"));
          continue;
        }
        if (fit.outside == 0 && fit.error_above <= share_of_model * tolerance)
        {
          this->refuse_paths(words(name_of_march(octaves), " is within the tolerance"));
          this->take_march(fit,
            words(name_of_march(octaves),
              " differs from all scatterings by ",
              fit.rms,
              " of white (root mean square over ",
              fit.rays,
              " probed rays; at the most ",
              fit.rms_above,
              ")"));
          return;
        }
        open.push_back(octaves);
      }
      left = open;
      const bool enough =
        this->Probe.seconds() > share_of_probe * this->Choice.seconds || samples > most_samples;
      if (left.empty() || enough)
      {
        break;
      }
      if (!this->trace(samples, 0.0))
      {
        return;
      }
      this->estimate_paths();
    }
    for (const int octaves : left)
    {
      const MarchFit fit = this->Probe.fit(this->TheMarcher, octaves, tolerance);
      this->add(Method::March,
        octaves,
        unknown,
        fit.error,
        words("whether it is within the tolerance is not settled by a twentieth of the time of the "
              "paths"));
    }
    this->take_paths(left.empty()
                       ? "no ray march is within the tolerance of all scatterings"
                       : "no ray march is known to be within the tolerance of all scatterings");
  }

  void refuse_paths(const std::string& verdict)
  {
    this->add(Method::Paths, 0, this->Choice.seconds, this->Choice.error, verdict);
  }

  void choose_by_time()
  {
    const double seconds = (1.0 - share_of_probe) * this->Wish.seconds;
    const double paths = seconds / std::max(this->Probe.seconds_of_path(), 1e-12);
    // Below two paths a pixel there is no picture to speak of, nor an estimate of its error.
    this->Choice.seconds = seconds;
    this->Choice.error = this->Probe.error_of(paths, 0.001);
    MarchFit best;
    best.error = std::numeric_limits<double>::infinity();
    std::vector<MarchFit> fits;
    for (const int octaves : this->trials())
    {
      fits.push_back(this->Probe.fit(this->TheMarcher, octaves, this->Wish.tolerance));
      if (fits.back().error < best.error)
      {
        best = fits.back();
      }
    }
    best.error *= normal_tail / tail;
    const bool march = best.error < this->Choice.error;
    for (const MarchFit& fit : fits)
    {
      if (!march || fit.octaves != best.octaves)
      {
        this->add(
          Method::March, fit.octaves, unknown, fit.error, "the error that is expected is larger");
      }
    }
    const std::string by = words(name_of_march(best.octaves),
      " is expected to be off by ",
      best.error,
      " of white, paths in this time by ",
      this->Choice.error);
    if (march)
    {
      this->refuse_paths("the error that is expected is larger");
      this->take_march(best, by);
      this->Choice.error = this->Choice.model_error = best.error;
      this->Choice.options.back().error = best.error;
      return;
    }
    this->take_paths(by);
  }

  Marcher& TheMarcher;
  const Scene& TheScene;
  const MethodWish& Wish;
  const Progress& TheProgress;
  MethodProbe Probe;
  std::size_t Pixels;
  MethodChoice Choice;
};

}

MethodChoice choose_method(Marcher& marcher,
  const Scene& scene,
  const MethodWish& wish,
  const Progress& progress)
{
  MethodChoice choice;
  choice.seconds = unknown;
  choice.error = unknown;
  choice.beyond = expected_beyond(static_cast<std::size_t>(wish.width) * wish.height);
  if (!scatters(scene))
  {
    choice.reason =
      "no matter scatters light: the ray march solves the same integral as the truth, and its "
      "steps are its only error";
    return choice;
  }
  if (wish.forced)
  {
    choice.reason =
      "not compared with paths because effects are forced, and paths simulate what they do";
    return choice;
  }
  if (const std::string why = why_no_paths(scene); !why.empty())
  {
    choice.reason = "not compared with paths because " + why;
    return choice;
  }
  if (!(wish.tolerance > 0.0) && !(wish.seconds > 0.0))
  {
    choice.reason = "not compared with paths because no number of them meets a tolerance of 0";
    return choice;
  }
  try
  {
    return Chooser(marcher, scene, wish, progress).choose();
  }
  catch (const std::invalid_argument& error)
  {
    choice.reason = std::string("not compared with paths because of this: ") + error.what();
    return choice;
  }
}

}
