// Whether --tolerance and --time-budget keep their promise: vtkBrumeSmartVolumeMapper on the sample
// scenes, against the truth, and against the cheapest setting that meets it. With --quick a test:
// small pictures, fewer scenes, and a promise that is not kept is a failure.
#include "command.h"
#include "scene_options.h"
#include "volume_scene.h"

#include "Transport/film.h"
#include "Transport/method_choice.h"
#include "Transport/path_tracer.h"
#include "Transport/reference.h"
#include "Transport/scene.h"
#include "Transport/timed_march.h"

#include "vtkBrumeMedium.h"
#include "vtkBrumePathTraceMapper.h"
#include "vtkBrumeRayMarchMapper.h"
#include "vtkBrumeSmartVolumeMapper.h"

#include "vtkCamera.h"
#include "vtkLightCollection.h"
#include "vtkNew.h"
#include "vtkVolume.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <ctime>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <iomanip>
#include <iostream>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

namespace
{

using namespace brume;
using app::VolumeScene;

struct Settings
{
  bool quick = false;
  std::string only;
  double truth_seconds = 60.0; ///< for a truth by paths
};

struct Case
{
  std::string name;
  std::string options;
  int edge;                       ///< pixels along each side
  std::vector<double> tolerances; ///< of these the last is the least
  bool quick;                     ///< part of the test
};

const char* const light = " --sun-direction 1,-0.3,0.6 --sky-radiance 0.15,0.25,0.45";

std::vector<Case> cases(bool quick)
{
  const std::string lit = light;
  const std::vector<double> all{ 0.05, 0.01, 0.002 };
  if (quick)
  {
    return {
      { "smoke", "sample:smoke", 128, { 0.05, 0.002 }, true },
      { "fog", "sample:fog", 128, { 0.01 }, true },
      { "smoke, lit",
        "sample:smoke --extinction 9 --albedo 0.55,0.5,0.45 --anisotropy 0.3" + lit,
        40,
        { 0.05, 0.02 },
        true },
      { "fog, thin, lit",
        "sample:fog --extinction 0.00003 --anisotropy 0.6" + lit,
        40,
        { 0.05 },
        true },
    };
  }
  return {
    { "cloud", "sample:cloud", 512, all, false },
    { "fog", "sample:fog", 512, all, false },
    { "head CT", "sample:head-ct", 256, all, false },
    { "smoke", "sample:smoke", 512, all, false },
    { "cloud, absorbing", "sample:cloud --extinction 0.005", 512, all, false },
    // A tolerance of 0.002 would take an hour.
    { "cloud, lit",
      "sample:cloud --extinction 0.05 --anisotropy 0.6" + lit,
      32,
      { 0.05, 0.01 },
      false },
    { "cloud, thin, lit",
      "sample:cloud --extinction 0.002 --anisotropy 0.6" + lit,
      64,
      all,
      false },
    { "fog, lit", "sample:fog --extinction 0.005 --anisotropy 0.6" + lit, 64, all, false },
    { "fog, thin, lit",
      "sample:fog --extinction 0.0002 --anisotropy 0.6" + lit,
      512,
      { 0.05, 0.01 },
      false },
    { "smoke, lit",
      "sample:smoke --extinction 9 --albedo 0.55,0.5,0.45 --anisotropy 0.3" + lit,
      64,
      all,
      false },
    { "head CT, lit",
      "sample:head-ct --preset ct-bone --shade off --anisotropy 0.3" + lit,
      32,
      { 0.05, 0.01 },
      false },
  };
}

/// Processor seconds of the process: what others do on the machine hardly changes them.
double processor_seconds()
{
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

VolumeScene make_scene(const Case& one)
{
  CLI::App program;
  app::SceneOptions options;
  app::add_scene_options(program, options, "preset");
  const std::string edge = std::to_string(one.edge);
  program.parse(one.options + " --quiet --resolution " + edge + "," + edge, false);
  return app::make_volume_scene(options);
}

struct Truth
{
  Film film;
  std::vector<double> error;    ///< standard error of each pixel; 0 by quadrature
  std::vector<double> variance; ///< of one path
  double seconds_of_path = 0.0; ///< processor's
  bool paths = false;
};

Truth find_truth(const VolumeScene& scene, double tolerance, const Settings& settings)
{
  Truth truth;
  vtkNew<vtkBrumeRayMarchMapper> mapper;
  app::set_up(scene, mapper.Get());
  const Scene* drawn =
    mapper->UpdateScene(scene.volume, scene.camera, scene.lights, scene.width(), scene.height());
  truth.film = Film(scene.width(), scene.height());
  truth.error.assign(truth.film.size(), 0.0);
  truth.variance.assign(truth.film.size(), 0.0);
  if (!scatters(*drawn))
  {
    ReferenceSettings reference;
    reference.tolerance = settings.quick ? 5e-4 : 1e-4;
    reference.most_pieces = settings.quick ? 64 : 1024; // sharp surfaces settle slowly
    const ReferenceStatistics settled = render_reference(*drawn, reference, truth.film);
    std::cerr << settled.seconds << " s, " << settled.unsettled_rays
              << " unsettled, largest change " << settled.largest_change << '\n';
    return truth;
  }
  truth.paths = true;
  PathTracer tracer;
  PathSettings paths;
  paths.seed = 4711;
  // What a path takes, and how much it varies, by many of all pixels.
  paths.samples_per_pixel = 64;
  const double before = processor_seconds();
  const PathStatistics even = tracer.render(*drawn, paths, truth.film);
  truth.seconds_of_path = (processor_seconds() - before) /
                          (static_cast<double>(paths.samples_per_pixel) * truth.film.size());
  for (std::size_t i = 0; i < truth.film.size(); ++i)
  {
    truth.variance[i] = even.samples_per_pixel * truth.film.error[i] * truth.film.error[i] / 9.0;
  }
  paths.resume = true;
  paths.adaptive = true;
  paths.samples_per_pixel = std::numeric_limits<int>::max();
  paths.tolerance = 0.2 * tolerance;
  paths.seconds = settings.truth_seconds;
  tracer.render(*drawn, paths, truth.film);
  for (std::size_t i = 0; i < truth.film.size(); ++i)
  {
    truth.error[i] = truth.film.error[i] / 3.0;
  }
  return truth;
}

struct Within
{
  double share = 0.0;    ///< of pixels
  double allowing = 0.0; ///< with three of the truth's standard errors allowed for
  double error = 0.0;    ///< of 99.9 %
};

Within compare(const Film& film, const Truth& truth, double tolerance)
{
  std::vector<double> errors(film.size(), 0.0);
  std::size_t within = 0;
  std::size_t allowing = 0;
  for (std::size_t i = 0; i < film.size(); ++i)
  {
    for (int c = 0; c < 3; ++c)
    {
      errors[i] = std::max({ errors[i],
        std::abs(double(film.radiance[c][i]) - truth.film.radiance[c][i]),
        std::abs(double(film.transmittance[c][i]) - truth.film.transmittance[c][i]) });
    }
    within += errors[i] <= tolerance;
    allowing += errors[i] <= tolerance + 3.0 * truth.error[i];
  }
  const double count = static_cast<double>(film.size());
  const auto at =
    errors.begin() + static_cast<std::ptrdiff_t>(errors.size() - 1 - errors.size() / 1000);
  std::nth_element(errors.begin(), at, errors.end());
  return { within / count, allowing / count, *at };
}

/// The cheapest setting of all that meets a tolerance.
struct Cheapest
{
  std::string name = "none";
  double seconds = std::numeric_limits<double>::infinity();
};

/// Of which the quickest counts, where a picture takes less than a second.
constexpr int repetitions = 3;

struct Point
{
  std::string name;
  double seconds;
  double error; ///< of 99.9 %
};

/// The picture of a march with these steps and octaves (0: as the scene has them), of one ray for
/// distance² pixels, and the processor's seconds that it took.
Film march(const VolumeScene& scene,
  bool lit,
  double step,
  int octaves,
  int distance,
  double& seconds)
{
  VolumeScene own = scene;
  if (scene.medium && octaves > 0)
  {
    own.options.medium.octaves = octaves;
    own.medium = app::make_medium(own.options.medium, own.options.extinction);
  }
  vtkNew<vtkBrumeRayMarchMapper> mapper;
  app::set_up(own, mapper.Get());
  mapper->SetTolerance(0.002);
  mapper->AutoAdjustSampleDistancesOff();
  mapper->SetSampleDistance(step * scene.voxel_edge);
  if (lit)
  {
    mapper->SetShadowMethod(vtkBrumeRayMarchMapper::VolumeShadows);
  }
  Film film(scene.width() / distance, scene.height() / distance);
  const double before = processor_seconds();
  mapper->RenderFilm(own.volume, own.camera, own.lights, film);
  Film whole = distance > 1 ? scaled(film, scene.width(), scene.height()) : std::move(film);
  seconds = processor_seconds() - before;
  return whole;
}

/// Steps, octaves, rays farther apart: what is made once, whatever the tolerance.
std::vector<Point> march_points(const VolumeScene& scene, const Truth& truth)
{
  std::vector<Point> points;
  const int octave_trials[] = { 0, 1, 8 };
  const int distances[] = { 1, 2, 4 };
  for (const int octaves : octave_trials)
  {
    if (!truth.paths && octaves > 0)
    {
      break;
    }
    for (double step = truth.paths ? 1.0 : 4.0; step > (truth.paths ? 0.4 : 0.014);
         step *= std::sqrt(0.5))
    {
      for (const int distance : distances)
      {
        std::ostringstream name;
        name << std::setprecision(2) << "steps of " << step << " voxels";
        if (octaves > 0)
        {
          name << ", " << octaves << " octaves";
        }
        if (distance > 1)
        {
          name << ", 1/" << distance << " size";
        }
        double seconds = std::numeric_limits<double>::infinity();
        Film film;
        for (int again = 0; again == 0 || (again < repetitions && seconds < 1.0); ++again)
        {
          double now = 0.0;
          film = march(scene, truth.paths, step, octaves, distance, now);
          seconds = std::min(seconds, now);
        }
        points.push_back({ name.str(), seconds, compare(film, truth, 1.0).error });
      }
    }
  }
  return points;
}

/// As many paths for every pixel as put 99.9 % of them within the tolerance.
double even_paths(const Truth& truth, double tolerance)
{
  double low = 1.0;
  double high = 1e12;
  while (high > 1.01 * low)
  {
    const double n = std::sqrt(low * high);
    double beyond = 0.0;
    for (const double v : truth.variance)
    {
      beyond += v > 0.0 ? std::erfc(tolerance / std::sqrt(2.0 * v / n)) : 0.0;
    }
    (beyond > 0.001 * static_cast<double>(truth.variance.size()) ? low : high) = n;
  }
  return high;
}

/// The processor's seconds of so many paths for every pixel, the quickest of a few.
double seconds_of_paths(const VolumeScene& scene, int samples)
{
  double seconds = std::numeric_limits<double>::infinity();
  for (int again = 0; again == 0 || (again < repetitions && seconds < 1.0); ++again)
  {
    vtkNew<vtkBrumePathTraceMapper> mapper;
    app::set_up(scene, mapper.Get());
    mapper->SetTolerance(0.0);
    mapper->SetSamplesPerPixel(samples);
    Film film(scene.width(), scene.height());
    const double before = processor_seconds();
    mapper->RenderFilm(scene.volume, scene.camera, scene.lights, film);
    seconds = std::min(seconds, processor_seconds() - before);
  }
  return seconds;
}

/// Even paths that are expected to take longer are not run.
constexpr double longest_run = 10.0;

int failures = 0;

void expect(bool kept, const std::string& what)
{
  if (!kept)
  {
    ++failures;
    std::cerr << "broken: " << what << '\n';
  }
}

nlohmann::json draw(const VolumeScene& scene,
  double tolerance,
  double budget,
  Film& film,
  double& seconds)
{
  vtkNew<vtkBrumeSmartVolumeMapper> mapper;
  app::set_up(scene, mapper.Get());
  mapper->SetTolerance(tolerance);
  mapper->SetTimeBudget(budget);
  const double before = processor_seconds();
  expect(mapper->RenderFilm(scene.volume, scene.camera, scene.lights, film), "a picture is drawn");
  seconds = processor_seconds() - before;
  return nlohmann::json::parse(mapper->GetStatistics());
}

void check_tolerances(const Case& one, const VolumeScene& scene, const Settings& settings)
{
  const Truth truth = find_truth(scene, one.tolerances.back(), settings);
  const std::vector<Point> points =
    settings.quick ? std::vector<Point>() : march_points(scene, truth);
  for (const double tolerance : one.tolerances)
  {
    Film film(scene.width(), scene.height());
    double seconds = 0.0;
    nlohmann::json statistics = draw(scene, tolerance, 0.0, film, seconds);
    for (int again = 1; !settings.quick && again < repetitions && seconds < 1.0; ++again)
    {
      double now = 0.0;
      statistics = draw(scene, tolerance, 0.0, film, now);
      seconds = std::min(seconds, now);
    }
    const Within within = compare(film, truth, tolerance);
    const nlohmann::json& method = statistics["method"];
    if (settings.quick)
    {
      const std::string where = one.name + " at " + std::to_string(tolerance);
      expect(within.allowing >= 0.999,
        where + ": " + std::to_string(100.0 * within.allowing) +
          " % of the pixels are within the tolerance, not 99.9");
      expect(statistics["tolerance_met"] == true && statistics["estimated_error"] <= tolerance,
        where + ": the statistics say that the tolerance is met");
      expect(!method["reason"].get<std::string>().empty() && method["seconds"] > 0.0,
        where + ": the statistics tell the method and why");
      expect(method["compared"] == truth.paths, where + ": what scatters is compared with paths");
      std::cout << where << ": " << method["chosen"] << ", " << seconds << " s, "
                << 100.0 * within.share << " % within\n";
      continue;
    }
    Cheapest cheapest;
    for (const Point& point : points)
    {
      if (point.error <= tolerance && point.seconds < cheapest.seconds)
      {
        cheapest = { point.name, point.seconds };
      }
    }
    if (truth.paths)
    {
      const double n = std::max(even_paths(truth, tolerance), 1.0);
      double by_paths = n * static_cast<double>(truth.film.size()) * truth.seconds_of_path;
      if (by_paths < longest_run)
      {
        by_paths = seconds_of_paths(scene, static_cast<int>(std::ceil(n)));
      }
      if (by_paths < cheapest.seconds)
      {
        std::ostringstream name;
        name << std::setprecision(3) << n << " paths a pixel";
        cheapest = { name.str(), by_paths };
      }
    }
    std::ostringstream took;
    if (method["chosen"] == "pathtrace")
    {
      took << std::setprecision(3) << statistics["mean_samples_per_pixel"].get<double>()
           << " paths a pixel, by noise";
    }
    else
    {
      took << std::setprecision(2) << "steps of " << statistics["step_in_voxels"].get<double>()
           << " voxels";
      const double distance = statistics["image_sample_distance"];
      took << (distance > 1.0 ? ", 1/" + std::to_string(std::lround(distance)) + " size" : "");
    }
    std::cout << "| " << one.name << ", " << one.edge << "² | " << tolerance << " | "
              << std::setprecision(5) << 100.0 * within.share;
    if (within.allowing != within.share)
    {
      std::cout << " (" << 100.0 * within.allowing << ")";
    }
    std::cout << " | " << std::setprecision(2) << within.error << " | "
              << statistics["estimated_error"].get<double>() << " | " << took.str() << " | "
              << std::setprecision(3) << seconds << " | " << cheapest.name << " | "
              << cheapest.seconds << " | " << std::setprecision(2) << seconds / cheapest.seconds
              << "× |" << std::endl;
  }
}

void check_budgets(const Case& one, const VolumeScene& scene, const Settings& settings)
{
  const std::vector<double> budgets =
    settings.quick ? std::vector<double>{ 1.5 } : std::vector<double>{ 1.0, 3.0, 10.0 };
  for (const double budget : budgets)
  {
    // Others may be busy on the machine: what counts is whether it can be met.
    const int most = settings.quick ? 4 : 1;
    for (int attempt = 1; attempt <= most; ++attempt)
    {
      Film film(scene.width(), scene.height());
      double processor = 0.0;
      const auto start = std::chrono::steady_clock::now();
      const nlohmann::json statistics = draw(scene, 0.0, budget, film, processor);
      const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      const bool early = statistics["ended_early"].is_string();
      const bool kept = seconds <= 1.2 * budget && (early || seconds >= 0.8 * budget);
      if (!settings.quick)
      {
        std::cout << "| " << one.name << ", " << one.edge << "² | " << budget << " | "
                  << std::setprecision(3) << seconds << " | "
                  << statistics["method"]["chosen"].get<std::string>()
                  << (early ? ", " + statistics["ended_early"].get<std::string>() : "") << " | "
                  << statistics["estimated_error"] << " |" << std::endl;
      }
      else if (kept || attempt == most)
      {
        expect(kept,
          one.name + ": a budget of " + std::to_string(budget) + " s took " +
            std::to_string(seconds));
        break;
      }
    }
  }
}

}

int main(int argc, char** argv)
{
  Settings settings;
  CLI::App program{ "Whether --tolerance and --time-budget keep their promise" };
  program.add_flag(
    "--quick", settings.quick, "A test: small pictures, and a failure where it is not kept");
  program.add_option(
    "--only", settings.only, "The scene of this name, else all whose name has this in it");
  program.add_option("--truth-seconds", settings.truth_seconds, "Time of each truth by paths [60]");
  CLI11_PARSE(program, argc, argv);
  try
  {
    std::vector<std::function<void()>> later;
    if (!settings.quick)
    {
      std::cout
        << "| scene | tolerance | % within | error of 99.9 % | estimated | chosen | processor s | "
           "cheapest that meets it | s | ratio |\n|---|---|---|---|---|---|---|---|---|---|\n";
    }
    std::vector<Case> all = cases(settings.quick);
    const bool exact = std::any_of(
      all.begin(), all.end(), [&settings](const Case& one) { return one.name == settings.only; });
    for (const Case& one : all)
    {
      if (exact ? one.name != settings.only : one.name.find(settings.only) == std::string::npos)
      {
        continue;
      }
      const VolumeScene scene = make_scene(one);
      check_tolerances(one, scene, settings);
      later.emplace_back([one, scene, settings] { check_budgets(one, scene, settings); });
    }
    if (!settings.quick)
    {
      std::cout
        << "\n| scene | budget, s | took, s | chosen | estimated error |\n|---|---|---|---|---|\n";
    }
    for (const auto& check : later)
    {
      check();
    }
  }
  catch (const std::exception& error)
  {
    std::cerr << error.what() << '\n';
    return 1;
  }
  return failures > 0 ? 1 : 0;
}
