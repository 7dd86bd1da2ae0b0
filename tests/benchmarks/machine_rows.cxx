#include "fetch_loop.h"
#include "rows.h"

#include "vtkCamera.h"
#include "vtkLightCollection.h"
#include "vtkVolume.h"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <thread>

namespace benchmarks
{

namespace
{

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start)
{
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Arithmetic in registers alone.
void compute(std::size_t steps)
{
  double x[8] = { 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8 };
  for (std::size_t i = 0; i < steps; ++i)
  {
    for (double& v : x)
    {
      v = v * 0.999999 + 1e-7;
    }
  }
  volatile double sink = x[0] + x[1] + x[2] + x[3] + x[4] + x[5] + x[6] + x[7];
  static_cast<void>(sink);
}

/// How much sooner two threads end the same arithmetic than one.
double arithmetic_speed_up(bool quick)
{
  const std::size_t steps = quick ? 100000 : 60000000;
  const auto start = Clock::now();
  compute(steps);
  const double one = seconds_since(start);
  const auto again = Clock::now();
  std::thread other([&] { compute(steps / 2); });
  compute(steps / 2);
  other.join();
  return one / seconds_since(again);
}

struct Threads
{
  std::unique_ptr<Subject> one;
  std::unique_ptr<Subject> two;
  std::vector<double> ceilings;
};

struct Fetches
{
  std::unique_ptr<Subject> brume;
  FetchTrace trace;
};

}

void add_machine_rows(Scenes& scenes, std::vector<Row>& rows)
{
  const Options& options = scenes.options();

  Row row;
  row.number = 11;
  row.name = "second-thread";
  row.what = "ball, ½ voxel: one thread's time by two threads'";
  row.unit = "×";
  row.target = 1.9;
  row.repetitions = options.quick ? 1 : options.repetitions;
  auto threads = std::make_shared<Threads>();
  row.prepare = [threads, &scenes](Row& self)
  {
    if (std::thread::hardware_concurrency() < 2)
    {
      throw Skipped("this machine has one processor");
    }
    Scene& scene = scenes.ball(false);
    const double step = 0.5 * scene.volume().voxel_edge;
    threads->one = std::make_unique<Subject>(scene, step, 1);
    threads->two = std::make_unique<Subject>(scene, step, 2);
    threads->one->render();
    threads->two->render();
    self.other = "the same on one thread";
    for (int i = 0; i < (scenes.options().quick ? 1 : 5); ++i)
    {
      threads->ceilings.push_back(arithmetic_speed_up(scenes.options().quick));
    }
    char text[80];
    std::snprintf(text,
      sizeof(text),
      "arithmetic in registers alone gains %.3g× by a second thread",
      median(threads->ceilings));
    self.remark(text);
  };
  row.repeat = [threads]
  {
    Repetition one;
    one.seconds = threads->two->render();
    one.other = threads->one->render();
    one.figure = one.other / one.seconds;
    return one;
  };
  rows.push_back(row);

  Row fetch;
  fetch.number = 12;
  fetch.name = "fetches";
  fetch.what = "ball, ½ voxel, one thread: fetches a second, of a loop of nothing else";
  fetch.unit = "%";
  fetch.target = 60;
  fetch.repetitions = options.quick ? 1 : options.repetitions;
  auto fetches = std::make_shared<Fetches>();
  fetch.prepare = [fetches, &scenes](Row& self)
  {
    Scene& scene = scenes.ball(false);
    const brume::app::VolumeScene& volume = scene.volume();
    const double step = 0.5 * volume.voxel_edge;
    fetches->brume = std::make_unique<Subject>(scene, step, 1);
    fetches->brume->render();
    const brume::Scene* plain = fetches->brume->mapper()->UpdateScene(
      volume.volume, volume.camera, volume.lights, volume.width(), volume.height());
    fetches->trace = record_fetches(*plain, volume.width(), volume.height(), step);
    const double samples = fetches->brume->statistics()["samples"];
    const double seconds = run_fetches(fetches->trace);
    self.other = "4 pairs of voxels and up to 8 table entries a sample, by recorded addresses";
    char text[160];
    std::snprintf(text,
      sizeof(text),
      "%.3g M samples, the loop %.3g M; it makes %.3g M fetches of one lane a second",
      samples * 1e-6,
      fetches->trace.samples * 1e-6,
      12.0 * fetches->trace.samples * 1e-6 / seconds);
    self.remark(text);
  };
  fetch.repeat = [fetches]
  {
    Repetition one;
    one.seconds = fetches->brume->render();
    one.other = run_fetches(fetches->trace);
    const double samples = fetches->brume->statistics()["samples"];
    one.figure = 100.0 * (samples / one.seconds) / (fetches->trace.samples / one.other);
    return one;
  };
  rows.push_back(fetch);
}

}
