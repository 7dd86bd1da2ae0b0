#include "allocations.h"
#include "rows.h"

#include "../support/bumpy_ball.h"

#include "Transport/bricks.h"
#include "Transport/scene.h"
#include "Transport/sparse_voxels.h"

#include "vtkCamera.h"
#include "vtkLightCollection.h"
#include "vtkVolume.h"

#include <tbb/parallel_for.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <thread>
#include <vector>

namespace benchmarks
{

namespace
{

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start)
{
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Bytes a second that two threads copy from one large buffer to another; each byte counts once.
double copy_bandwidth(bool quick)
{
  const std::size_t bytes = std::size_t(quick ? 16 : 1024) << 20;
  std::unique_ptr<char[]> from(new char[bytes]);
  std::unique_ptr<char[]> to(new char[bytes]);
  std::memset(from.get(), 1, bytes);
  std::memset(to.get(), 2, bytes);
  std::vector<double> rates;
  for (int i = 0; i < (quick ? 1 : 5); ++i)
  {
    const auto start = Clock::now();
    std::thread other([&] { std::memcpy(to.get(), from.get(), bytes / 2); });
    std::memcpy(to.get() + bytes / 2, from.get() + bytes / 2, bytes / 2);
    other.join();
    rates.push_back(bytes / seconds_since(start));
  }
  return median(rates);
}

/// The same balls in a large and a small volume.
struct Sparse
{
  std::unique_ptr<Scene> large_scene;
  std::unique_ptr<Scene> small_scene;
  std::unique_ptr<Subject> large;
  std::unique_ptr<Subject> small;
  double copied = 0.0; ///< bytes a second
};

template <class T>
void prepare_sparse(Sparse& sparse, const Scenes& scenes, int vtk_type, double largest, bool small)
{
  const bool quick = scenes.options().quick;
  const double edge = 255.0;
  const std::vector<bumpy_ball::Ball> balls = bumpy_ball::scattered(0.05);
  const auto make = [&](int n, const char* name)
  {
    return scenes.of_balls(
      bumpy_ball::image<T>(n, vtk_type, edge, balls, largest), largest, edge, name);
  };
  sparse.large_scene = make(quick ? 64 : 1024, "27 balls, large");
  if (small)
  {
    sparse.small_scene = make(quick ? 16 : 256, "27 balls, small");
  }
}

/// Half a voxel of the small volume, two voxels of the large one.
double common_step(const Sparse& sparse)
{
  return 2.0 * sparse.large_scene->volume().voxel_edge;
}

template <class T>
void add_sparse_rows(Scenes& scenes,
  std::vector<Row>& rows,
  const char* type,
  int vtk_type,
  double largest)
{
  const Options& options = scenes.options();
  Row render;
  render.number = 13;
  render.name = std::string("sparse-render-") + type;
  render.what = std::string("27 balls, 5 % of 1024³ ") + type + ": time by that of 256³";
  render.unit = "×";
  render.target = 3;
  render.at_least = false;
  render.repetitions = options.quick ? 1 : options.repetitions;
  auto sparse = std::make_shared<Sparse>();
  render.prepare = [=, &scenes](Row& self)
  {
    prepare_sparse<T>(*sparse, scenes, vtk_type, largest, true);
    const int threads = scenes.options().threads;
    sparse->large = std::make_unique<Subject>(*sparse->large_scene, 0.0, threads);
    sparse->small = std::make_unique<Subject>(*sparse->small_scene, 0.0, threads);
    sparse->large->render();
    sparse->small->render();
    const double coarse = sparse->small_scene->volume().voxel_edge;
    const auto own_step = [&](const Subject& subject)
    { return subject.statistics()["step"].get<double>() / coarse; };
    self.other =
      "256³, the same balls sampled four times as coarsely, so that both show one picture";
    char text[200];
    std::snprintf(text,
      sizeof(text),
      "each at its own steps by the default tolerance: %.3g and %.3g of a 256³ voxel",
      own_step(*sparse->large),
      own_step(*sparse->small));
    self.remark(text);
    Subject large(*sparse->large_scene, common_step(*sparse), threads);
    Subject small(*sparse->small_scene, common_step(*sparse), threads);
    std::vector<double> ratios;
    for (int i = 0; i < (scenes.options().quick ? 1 : 4); ++i)
    {
      const double seconds = large.render();
      ratios.push_back(seconds / small.render());
    }
    std::snprintf(
      text, sizeof(text), "with the same step, half a voxel of 256³: %.3g×", median(ratios));
    self.remark(text);
    self.remark("the two pictures at that step differ by " +
                in_words(brume::measure(large.picture(), small.picture())));
  };
  render.repeat = [sparse]
  {
    Repetition one;
    one.seconds = sparse->large->render();
    one.other = sparse->small->render();
    one.figure = one.seconds / one.other;
    return one;
  };
  rows.push_back(render);

  Row prepare;
  prepare.number = 13;
  prepare.name = std::string("sparse-prepare-") + type;
  prepare.what =
    std::string("1024³ ") + type + ": bytes prepared a second, of those that are copied";
  prepare.unit = "%";
  prepare.target = 50;
  prepare.repetitions = options.quick ? 1 : options.repetitions;
  auto copied = std::make_shared<Sparse>();
  prepare.prepare = [=, &scenes](Row& self)
  {
    copied->copied = copy_bandwidth(scenes.options().quick);
    prepare_sparse<T>(*copied, scenes, vtk_type, largest, false);
    copied->large = std::make_unique<Subject>(
      *copied->large_scene, common_step(*copied), scenes.options().threads);
    copied->large->render();
    self.other =
      "copying as many bytes from memory to memory with two threads, each byte counted once";
    const brume::app::VolumeScene& volume = copied->large_scene->volume();
    const brume::Scene* plain = copied->large->mapper()->UpdateScene(
      volume.volume, volume.camera, volume.lights, volume.width(), volume.height());
    const auto start = Clock::now();
    brume::measure_bricks(plain->volumes[0].grid, scenes.options().threads);
    char text[160];
    std::snprintf(text,
      sizeof(text),
      "copied: %.3g GB a second; the ranges of bricks alone take %.3g s of the preparation",
      copied->copied * 1e-9,
      seconds_since(start));
    self.remark(text);
  };
  prepare.repeat = [copied]
  {
    vtkImageData* image = copied->large_scene->volume().input.image;
    image->Modified(); // so that all is prepared again
    copied->large->render();
    Repetition one;
    one.seconds = copied->large->prepare_seconds();
    one.other = double(image->GetNumberOfPoints()) * sizeof(T) / copied->copied;
    one.figure = 100.0 * one.other / one.seconds;
    return one;
  };
  rows.push_back(prepare);
}

template <class T>
void add_beside_row(Scenes& scenes,
  std::vector<Row>& rows,
  const char* type,
  int vtk_type,
  double largest)
{
  Row row;
  row.number = 14;
  row.name = std::string("memory-dense-") + type;
  row.what = std::string("256³ ") + type + ": memory beside the voxels";
  row.unit = "%";
  row.target = 30;
  row.at_least = false;
  row.prepare = [=, &scenes](Row& self)
  {
    const int n = scenes.options().quick ? 48 : 256;
    auto scene =
      scenes.of_balls(bumpy_ball::image<T>(n, vtk_type, n - 1.0, { bumpy_ball::Ball() }, largest),
        largest,
        n - 1.0,
        "ball");
    scene->volume().volume->GetProperty()->ShadeOn();
    const double voxels = double(n) * n * n * sizeof(T);
    // One picture before, elsewhere, so that what the threads keep for themselves is there already.
    Subject(*scene, 0.5, scenes.options().threads).render();
    Subject subject(*scene, 0.5, scenes.options().threads);
    const std::size_t before = live_bytes();
    reset_peak();
    subject.render();
    const double kept = double(live_bytes()) - double(before);
    const double peak = double(peak_bytes()) - double(before);
    char text[240];
    std::snprintf(text,
      sizeof(text),
      "most at any time %.3g MB, kept between pictures %.3g MB, the voxels %.3g MB",
      peak * 1e-6,
      kept * 1e-6,
      voxels * 1e-6);
    self.remark(text);
    self.remark("operator new's bytes, shaded, the film itself not counted");
    self.measured.push_back({ 0.0, 0.0, 100.0 * peak / voxels });
  };
  rows.push_back(row);
}

/// Bytes that a sparse float grid takes for each voxel above 0, for balls in a box of n³.
double sparse_bytes(int n, const std::vector<bumpy_ball::Ball>& balls, std::size_t& active)
{
  const double scale = 2.0 / (n - 1);
  const auto value = [&](int i, int j, int k)
  {
    double most = 0.0;
    for (const bumpy_ball::Ball& ball : balls)
    {
      const double x = (i * scale - 1.0 - ball.x) / ball.radius;
      const double y = (j * scale - 1.0 - ball.y) / ball.radius;
      const double z = (k * scale - 1.0 - ball.z) / ball.radius;
      if (x * x + y * y + z * z < 1.21)
      {
        most = std::max(most, bumpy_ball::density(x, y, z));
      }
    }
    return most;
  };
  const int bricks = n / brume::SparseVoxels::brick_edge;
  std::vector<std::vector<brume::BrickPlace>> found(bricks);
  std::atomic<std::size_t> voxels{ 0 };
  const auto each_voxel = [](const brume::BrickPlace& place, const auto& visit)
  {
    for (int k = 0; k < 8; ++k)
      for (int j = 0; j < 8; ++j)
        for (int i = 0; i < 8; ++i)
          visit(8 * place[0] + i, 8 * place[1] + j, 8 * place[2] + k);
  };
  tbb::parallel_for(0,
    bricks,
    [&](int z)
    {
      for (int y = 0; y < bricks; ++y)
        for (int x = 0; x < bricks; ++x)
        {
          const brume::BrickPlace place{ x, y, z };
          std::size_t seen = 0;
          each_voxel(place, [&](int i, int j, int k) { seen += value(i, j, k) > 0.0; });
          if (seen > 0)
          {
            found[z].push_back(place);
            voxels += seen;
          }
        }
    });
  brume::SparseTopology topology;
  for (const auto& layer : found)
  {
    topology.bricks.insert(topology.bricks.end(), layer.begin(), layer.end());
  }
  const brume::SparseVoxels sparse(brume::VoxelType::Float32,
    0.0,
    topology,
    [&](std::size_t index, void* to)
    {
      float* out = static_cast<float*>(to);
      each_voxel(topology.bricks[index],
        [&](int i, int j, int k) { *out++ = static_cast<float>(value(i, j, k)); });
    });
  active = voxels;
  return double(sparse.memory_bytes()) / double(active);
}

}

void add_memory_rows(Scenes& scenes, std::vector<Row>& rows)
{
  add_sparse_rows<std::uint8_t>(scenes, rows, "uint8", VTK_UNSIGNED_CHAR, 250.0);
  add_sparse_rows<std::uint16_t>(scenes, rows, "uint16", VTK_UNSIGNED_SHORT, 65530.0);
  add_beside_row<std::uint8_t>(scenes, rows, "uint8", VTK_UNSIGNED_CHAR, 250.0);
  add_beside_row<std::uint16_t>(scenes, rows, "uint16", VTK_UNSIGNED_SHORT, 65530.0);

  Row sparse;
  sparse.number = 15;
  sparse.name = "memory-sparse-float";
  sparse.what = "sparse float volume: bytes an active voxel";
  sparse.unit = "bytes";
  sparse.target = 5;
  sparse.at_least = false;
  sparse.prepare = [&scenes](Row& self)
  {
    const int n = scenes.options().quick ? 64 : 512;
    std::size_t active = 0;
    std::size_t scattered_active = 0;
    // As large as the 27 balls together.
    const double radius = 3.0 * bumpy_ball::scattered(0.05).front().radius;
    const double bytes = sparse_bytes(n, { { 0.0, 0.0, 0.0, radius } }, active);
    const double scattered = sparse_bytes(n, bumpy_ball::scattered(0.05), scattered_active);
    char text[200];
    std::snprintf(text,
      sizeof(text),
      "one ball of %.3g M voxels above 0 in a box of %d³; for 27 balls of as much in all %.3g "
      "bytes",
      active * 1e-6,
      n,
      scattered);
    self.remark(text);
    self.measured.push_back({ 0.0, 0.0, bytes });
  };
  rows.push_back(sparse);
}

}
