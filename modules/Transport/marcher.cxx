#include "Transport/marcher.h"

#include "Transport/march_task.h"
#include "Transport/shading.h"

#include <hwy/targets.h>

#include <tbb/blocked_range.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <mutex>
#include <stdexcept>
#include <thread>

namespace brume
{

namespace
{

constexpr int tile_edge = 32;

double seconds_since(std::chrono::steady_clock::time_point start)
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

MarchCount march(const MarchTask& task)
{
  if (task.grid->colour == VoxelColour::RGB)
  {
    return march_rgba8(task);
  }
  switch (task.grid->type)
  {
    case VoxelType::UInt8:
      return march_uint8(task);
    case VoxelType::Int8:
      return march_int8(task);
    case VoxelType::UInt16:
      return march_uint16(task);
    case VoxelType::Int16:
      return march_int16(task);
    case VoxelType::Float32:
      return march_float32(task);
  }
  return {};
}

/// The longest way through the grid, in the data's units.
double diagonal(const Scene& scene)
{
  glm::dvec3 extent;
  for (int axis = 0; axis < 3; ++axis)
  {
    extent[axis] = scene.volumes[0].grid.upper(axis) - scene.volumes[0].grid.lower(axis);
  }
  const glm::dmat3 m(scene.volumes[0].data_from_index);
  double longest = 0.0;
  for (int corner = 0; corner < 4; ++corner)
  {
    glm::dvec3 d = extent;
    d.y *= corner & 1 ? -1.0 : 1.0;
    d.z *= corner & 2 ? -1.0 : 1.0;
    longest = std::max(longest, glm::length(m * d));
  }
  return longest;
}

}

struct Marcher::Cache
{
  std::uint64_t data_revision = 0;
  std::shared_ptr<const BrickRanges> ranges;

  bool have_visible = false;
  std::uint64_t medium_revision = 0;
  VisibleBricks visible;

  bool have_table = false;
  double table_step = 0.0;
  LookupTable table;

  void update_ranges(const Scene& scene, int threads)
  {
    if (!this->ranges || this->data_revision != scene.volumes[0].data_revision || scene.volumes[0].data_revision == 0)
    {
      this->ranges = scene.volumes[0].ranges
        ? scene.volumes[0].ranges
        : std::make_shared<BrickRanges>(measure_bricks(scene.volumes[0].grid, threads));
      this->data_revision = scene.volumes[0].data_revision;
      this->have_visible = false;
    }
  }

  void update(const Scene& scene, double step, int threads)
  {
    this->update_ranges(scene, threads);
    const bool classified = scene.volumes[0].meaning == ValueMeaning::Classified;
    const bool new_medium =
      this->medium_revision != scene.volumes[0].medium_revision || scene.volumes[0].medium_revision == 0;
    if (classified && (!this->have_table || new_medium || this->table_step != step))
    {
      this->table = make_lookup_table(scene.volumes[0].classification, step);
      this->table_step = step;
      this->have_table = true;
    }
    if (!this->have_visible || new_medium)
    {
      this->visible = find_visible_bricks(*this->ranges,
        [&](float lower, float upper)
        {
          return classified ? this->table.can_show(lower, upper)
                            : upper > 0.0f && scene.volumes[0].density.extinction > 0.0;
        },
        classified ? this->table.empty_value : 0.0f);
      this->have_visible = true;
    }
    this->medium_revision = scene.volumes[0].medium_revision;
  }
};

Marcher::Marcher()
  : Kept(std::make_unique<Cache>())
{
}

Marcher::~Marcher() = default;

MarchStatistics Marcher::render(
  const Scene& scene, const MarchSettings& settings, Film& film, const Progress& progress)
{
  scene.validate();
  if (!(settings.step > 0.0) || !std::isfinite(settings.step))
  {
    throw std::invalid_argument("the step must be a positive length");
  }
  if (!(settings.leave_error >= 0.0))
  {
    throw std::invalid_argument("the error allowed for leaving a ray must not be negative");
  }
  if (!scene.surface_depth.empty() && scene.surface_depth.size() != film.size())
  {
    throw std::invalid_argument("the surface depths are of another size than the picture");
  }
  if (film.width <= 0 || film.height <= 0)
  {
    throw std::invalid_argument("the film has no pixels");
  }

  MarchStatistics statistics;
  // Reset the film: rays that miss the grid do not write.
  film.clear();
  const int threads =
    settings.threads > 0 ? settings.threads : tbb::info::default_concurrency();
  tbb::task_arena arena(threads);
  const double step = std::max(settings.step, diagonal(scene) / double(1 << 16));

  const auto start_prepare = std::chrono::steady_clock::now();
  this->Kept->update(scene, step, threads);
  const Cache& kept = *this->Kept;
  const ShadeModel shade = prepare_shading(scene, scene.volumes[0]);
  const RayMaker rays(scene, film.width, film.height);

  MarchTask common;
  common.grid = &scene.volumes[0].grid;
  common.meaning = scene.volumes[0].meaning;
  common.rays = &rays;
  common.non_finite = kept.ranges->non_finite_voxels > 0;
  common.step = step;
  common.step_error = static_cast<float>(settings.step_error);
  common.film = &film;
  common.bricks = kept.visible.visible < kept.ranges->size() ? &kept.visible : nullptr;
  if (scene.volumes[0].meaning == ValueMeaning::Classified)
  {
    common.table = &kept.table;
    common.shade = &shade;
    // What is behind can change a pixel by no more than the transmittance left times the brightest
    // of the matter there and of a white background.
    // Highlights do not take the matter's colour: a dim one has them all the same.
    const double brightest =
      std::max(1.0, double(kept.table.brightest)) * std::max(1.0, shade.brightest);
    common.brightest = static_cast<float>(brightest);
    common.leave_below = static_cast<float>(settings.leave_error / brightest);
    for (int axis = 0; axis < 3; ++axis)
    {
      common.gradient_scale[axis] = static_cast<float>(
        kept.table.gradient_table_scale / scene.volumes[0].classification.gradient_scale[axis]);
    }
  }
  else
  {
    common.depth_per_value = scene.volumes[0].density.extinction * step;
    common.half_depth = static_cast<float>(std::log(2.0) / common.depth_per_value);
  }
  statistics.seconds_prepare = seconds_since(start_prepare);

  const auto start = std::chrono::steady_clock::now();
  const int tiles_x = (film.width + tile_edge - 1) / tile_edge;
  const int tiles_y = (film.height + tile_edge - 1) / tile_edge;
  const int tiles = tiles_x * tiles_y;
  std::atomic<std::uint64_t> samples{ 0 };
  std::atomic<std::uint64_t> ray_count{ 0 };
  std::atomic<int> done{ 0 };
  std::atomic<bool> aborted{ false };
  const std::thread::id caller = std::this_thread::get_id();
  if (kept.visible.visible > 0)
  {
    arena.execute(
      [&]
      {
        tbb::parallel_for(
          tbb::blocked_range<int>(0, tiles, 1),
          [&](const tbb::blocked_range<int>& range)
          {
            for (int tile = range.begin(); tile != range.end(); ++tile)
            {
              if (aborted)
              {
                return;
              }
              MarchTask task = common;
              task.x0 = tile % tiles_x * tile_edge;
              task.y0 = tile / tiles_x * tile_edge;
              task.x1 = std::min(task.x0 + tile_edge, film.width);
              task.y1 = std::min(task.y0 + tile_edge, film.height);
              const MarchCount count = march(task);
              samples += count.samples;
              ray_count += count.rays;
              const int finished = ++done;
              if (progress && std::this_thread::get_id() == caller)
              {
                if (!progress(double(finished) / tiles))
                {
                  aborted = true;
                }
              }
            }
          },
          tbb::simple_partitioner());
      });
  }
  if (progress && !aborted && !progress(1.0))
  {
    aborted = true;
  }

  statistics.seconds = seconds_since(start);
  statistics.step = step;
  statistics.samples = samples;
  statistics.rays = ray_count;
  statistics.threads = threads;
  statistics.non_finite_voxels = kept.ranges->non_finite_voxels;
  statistics.bricks = kept.ranges->size();
  statistics.visible_bricks = kept.visible.visible;
  statistics.completed = !aborted;
  const std::string targets = simd_targets();
  statistics.simd = targets.substr(0, targets.find(' '));
  return statistics;
}

std::string simd_targets()
{
  std::string names;
  for (std::int64_t target : hwy::SupportedAndGeneratedTargets())
  {
    if (!names.empty())
    {
      names += ' ';
    }
    names += hwy::TargetName(target);
  }
  return names;
}

bool force_simd_target(const std::string& name)
{
  const std::int64_t before = hwy::SupportedTargets();
  hwy::SetSupportedTargetsForTest(0);
  if (name.empty())
  {
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    return true;
  }
  for (std::int64_t target : hwy::SupportedAndGeneratedTargets())
  {
    if (name == hwy::TargetName(target))
    {
      hwy::SetSupportedTargetsForTest(target);
      hwy::GetChosenTarget().Update(target);
      return true;
    }
  }
  hwy::SetSupportedTargetsForTest(before);
  hwy::GetChosenTarget().Update(before);
  return false;
}

}
