#include "Transport/marcher.h"

#include "Transport/fog_film.h"
#include "Transport/lit_tables.h"
#include "Transport/march_task.h"
#include "Transport/mode_tables.h"
#include "Transport/shading.h"
#include "Transport/thread_arena.h"

#include <hwy/targets.h>

#include <tbb/blocked_range.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <limits>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <thread>

namespace brume
{

namespace
{

constexpr int tile_edge = 32;
/// Tiles are marched in parts, so that whoever waits is soon asked whether to go on, and no thread is left
/// with a long tile at the end: no smaller than the largest packet, so that the same rays stay together.
constexpr int part_edge = 4;

double seconds_since(std::chrono::steady_clock::time_point start)
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

using Integrator = MarchCount (*)(const MarchTask&);

/// Whether the volume is read by one grid of values alone.
bool is_plain(const Volume& volume)
{
  return !volume.mask.labels && volume.grid.colour == VoxelColour::Value &&
         volume.classification.value_gradient.empty();
}

/// Only the kernels of lit media can let all light through.
bool takes_lit_kernels(const Scene& scene, bool absorption)
{
  return needs_lit_kernels(scene) ||
         (scene.blend_mode == BlendMode::Composite && !absorption);
}

Integrator find_integrator(const Scene& scene, bool absorption)
{
  switch (scene.blend_mode)
  {
    case BlendMode::Composite:
      break;
    case BlendMode::MaximumIntensity:
    case BlendMode::MinimumIntensity:
      return march_extreme;
    case BlendMode::AverageIntensity:
      return march_mean;
    case BlendMode::Additive:
      return march_sum;
    case BlendMode::Isosurface:
      return march_surfaces;
    case BlendMode::Slice:
      return march_slice;
  }
  const bool plain = scene.volumes.size() == 1 && is_plain(scene.volumes[0]);
  if (has_fog(scene))
  {
    return march_fog;
  }
  if (takes_lit_kernels(scene, absorption))
  {
    return plain && scene.volumes[0].meaning == ValueMeaning::Density ? march_lit_density
                                                                      : march_lit_mixture;
  }
  if (!plain)
  {
    return march_mixture;
  }
  return scene.volumes[0].meaning == ValueMeaning::Density ? march_density : march_composite;
}

/// The longest way through the grid, in the data's units.
double diagonal(const Volume& volume)
{
  glm::dvec3 extent;
  for (int axis = 0; axis < 3; ++axis)
  {
    extent[axis] = volume.grid.upper(axis) - volume.grid.lower(axis);
  }
  const glm::dmat3 m(volume.data_from_index);
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

/// A ray takes no more steps than this: beyond, rounding would cost more than they gain.
constexpr double most_steps = 1 << 16;

/// The step that the longest of the picture's rays takes most_steps of. 0, and no ray is looked at,
/// where no ray through the grids could take more of `wanted`.
double shortest_step(const Scene& scene, const RayMaker& rays, double wanted)
{
  double longest = 0.0;
  for (const Volume& volume : scene.volumes)
  {
    longest = std::max(longest, diagonal(volume));
  }
  if (longest <= most_steps * wanted)
  {
    return 0.0;
  }
  longest = 0.0;
  std::vector<RayStretch> stretches;
  for (int y = 0; y < rays.height(); ++y)
  {
    for (int x = 0; x < rays.width(); ++x)
    {
      rays.stretches(x, y, stretches);
      for (std::size_t k = 0; !stretches.empty() && k < scene.volumes.size(); ++k)
      {
        double part = 0.0;
        for (const RayStretch& stretch : stretches)
        {
          part += stretch.volumes >> k & 1u ? stretch.end - stretch.begin : 0.0;
        }
        const double length = part * rays.way(x, y, k).length;
        longest = std::max(longest, std::isfinite(length) ? length : 0.0);
      }
    }
  }
  return longest / most_steps;
}

/// Of all volumes, in their data's units.
double smallest_voxel_edge(const std::vector<Volume>& volumes)
{
  double edge = std::numeric_limits<double>::max();
  for (const Volume& volume : volumes)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      edge = std::min(edge, glm::length(glm::dvec3(volume.data_from_index[axis])));
    }
  }
  return edge;
}

}

bool follows_rule(const Scene& scene, StepRule rule)
{
  if (scene.volumes.empty())
  {
    return rule == StepRule::Midpoint;
  }
  const Volume& volume = scene.volumes[0];
  const bool plain = scene.volumes.size() == 1 && is_plain(volume) &&
    scene.blend_mode == BlendMode::Composite && !needs_lit_kernels(scene);
  switch (rule)
  {
    case StepRule::Midpoint:
      return true;
    case StepRule::Integrated:
      return plain && volume.meaning == ValueMeaning::Classified;
    case StepRule::Cells:
      return plain && volume.meaning == ValueMeaning::Density;
  }
  return false;
}

/// Whether matter sends light by itself, whatever its extinction.
bool emits(const Volume& volume)
{
  return volume.medium.lit &&
    (volume.medium.emission != glm::dvec3(0.0) || volume.medium.black_body > 0.0);
}

/// What is kept of one volume.
class VolumeCache
{
public:
  void update(const Scene& scene, const Volume& volume, int threads)
  {
    if (!this->Ranges || this->DataRevision != volume.data_revision || volume.data_revision == 0)
    {
      this->Ranges = volume.ranges
                       ? volume.ranges
                       : std::make_shared<BrickRanges>(measure_bricks(volume.grid, threads));
      this->DataRevision = volume.data_revision;
      this->HaveMedium = false;
    }
    if (this->HaveMedium && this->MediumRevision == volume.medium_revision &&
        volume.medium_revision != 0 && this->Emits == emits(volume) && this->Mode.serve(scene))
    {
      return;
    }
    this->HaveMedium = false; // until all is done: memory may run out on the way
    const bool classified = volume.meaning == ValueMeaning::Classified;
    if (classified)
    {
      this->Table = make_lookup_table(volume.classification, volume.label_classifications);
    }
    this->Mode.update(scene, volume, *this->Ranges, this->Table);
    const bool any = volume.weight > 0.0 && (volume.density.extinction > 0.0 || emits(volume));
    this->Visible = find_visible_bricks(
      *this->Ranges,
      [&](float lower, float upper)
      {
        return classified ? this->Mode.can_show(scene, volume, this->Table, lower, upper)
                          : any && upper > 0.0f;
      },
      this->empty_value(volume));
    this->MediumRevision = volume.medium_revision;
    this->Emits = emits(volume);
    this->HaveMedium = true;
  }

  /// What kernels need of the volume, which must be the one of the last update.
  VolumeTask task(const Scene& scene, const Volume& volume) const
  {
    VolumeTask task;
    const bool non_finite = this->Ranges->non_finite_voxels > 0;
    task.meaning = volume.meaning;
    task.field =
      view_field(volume.grid, volume.grid.component, non_finite, this->empty_value(volume));
    task.visible = this->Visible.visible < this->Ranges->size() ? &this->Visible : nullptr;
    task.bricks = task.visible;
    task.weight = static_cast<float>(volume.weight);
    if (volume.meaning == ValueMeaning::Density)
    {
      task.extinction = static_cast<float>(volume.density.extinction * volume.weight);
      task.largest = std::max(0.0f, this->Ranges->upper);
      return task;
    }
    task.table = &this->Table;
    task.shade = prepare_shading(scene, volume);
    task.needs_gradient = volume.shading.enabled || !this->Table.gradient_factor.empty();
    for (int axis = 0; axis < 3; ++axis)
    {
      task.gradient_scale[axis] = static_cast<float>(
        this->Table.gradient_table_scale / volume.classification.gradient_scale[axis]);
    }
    task.colour = volume.grid.colour;
    for (int c = 0; c < 3; ++c)
    {
      const int component = task.colour == VoxelColour::RGB ? c : 0;
      task.colours[c] = view_field(volume.grid, component, non_finite, 0.0f);
    }
    if (volume.mask.labels)
    {
      add_mask(volume, task);
    }
    this->Mode.fill(scene, volume, task);
    return task;
  }

  const BrickRanges& ranges() const { return *this->Ranges; }
  const VisibleBricks& visible() const { return this->Visible; }
  /// The brightest light that the volume's matter can send.
  double brightest(const VolumeTask& task) const
  {
    // Highlights do not take the matter's colour: a dim one has them all the same.
    return task.table
             ? std::max(1.0, double(this->Table.brightest)) * std::max(1.0, task.shade.brightest)
             : 1.0;
  }

private:
  float empty_value(const Volume& volume) const
  {
    return volume.meaning == ValueMeaning::Classified ? this->Mode.empty_value(this->Table) : 0.0f;
  }

  void add_mask(const Volume& volume, VolumeTask& task) const
  {
    Grid labels = volume.grid;
    labels.voxels = volume.mask.labels;
    labels.type = VoxelType::UInt8;
    labels.components = 1;
    labels.component = 0;
    labels.linear = false;
    task.masked = true;
    task.labels = view_field(labels, 0, false, 0.0f);
    for (int label = 0; label < 256; ++label)
    {
      const int n = volume.mask.classification_of_label[label];
      task.first_node[label] = n == Mask::hidden ? -1 : n * (this->Table.intervals + 1);
    }
  }

  std::uint64_t DataRevision = 0;
  std::shared_ptr<const BrickRanges> Ranges;
  bool HaveMedium = false;
  std::uint64_t MediumRevision = 0;
  bool Emits = false;
  LookupTable Table;
  ModeTables Mode;
  VisibleBricks Visible;
};

struct Marcher::Cache
{
  std::vector<VolumeCache> volumes;
  LitTables lit;

  void update(const Scene& scene, int threads)
  {
    this->volumes.resize(scene.volumes.size());
    for (std::size_t k = 0; k < scene.volumes.size(); ++k)
    {
      this->volumes[k].update(scene, scene.volumes[k], threads);
    }
  }
};

namespace
{

MarchStatistics render_fog_alone(
  const Scene& scene, const MarchSettings& settings, Film& film, const Progress& progress)
{
  MarchStatistics statistics;
  const auto start = std::chrono::steady_clock::now();
  statistics.completed = render_fog(scene, film, settings.threads, progress);
  statistics.seconds = seconds_since(start);
  statistics.step = settings.step;
  statistics.threads =
    settings.threads > 0 ? settings.threads : tbb::info::default_concurrency();
  const std::string targets = simd_targets();
  statistics.simd = targets.substr(0, targets.find(' '));
  return statistics;
}

}

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

  if (scene.volumes.empty())
  {
    return render_fog_alone(scene, settings, film, progress);
  }

  const bool surfaces =
    scene.blend_mode == BlendMode::Isosurface || scene.blend_mode == BlendMode::Slice;
  if (surfaces && scene.volumes.size() > 1)
  {
    Scene first = scene;
    first.volumes.resize(1);
    return this->render(first, settings, film, progress);
  }

  // Who is asked whether to go on.
  const Progress ask = progress ? progress
    : this->Watch               ? Progress([this](double) { return this->Watch(); })
                                : Progress();
  MarchStatistics statistics;
  // Reset the film: rays that miss the grid do not write.
  film.clear();
  const int threads =
    settings.threads > 0 ? settings.threads : tbb::info::default_concurrency();
  ThreadArena arena(threads);
  double step = settings.step;
  const bool by_cells = surfaces || scene.blend_mode == BlendMode::MaximumIntensity ||
                        scene.blend_mode == BlendMode::MinimumIntensity;
  if (by_cells)
  {
    step = smallest_voxel_edge(scene.volumes);
  }

  const auto start_prepare = std::chrono::steady_clock::now();
  const Integrator integrator = find_integrator(scene, settings.absorption);
  this->Kept->update(scene, threads);
  const RayMaker rays(scene, film.width, film.height);
  const double shortest = shortest_step(
    scene, rays, step / (1 << std::clamp(settings.refinements, 0, most_refinements)));
  step = std::max(step, shortest);
  std::vector<VolumeTask> volumes;
  double brightest = 1.0;
  std::size_t visible_bricks = 0;
  for (std::size_t k = 0; k < scene.volumes.size(); ++k)
  {
    const VolumeCache& kept = this->Kept->volumes[k];
    volumes.push_back(kept.task(scene, scene.volumes[k]));
    if (!settings.leaping)
    {
      volumes.back().bricks = nullptr;
    }
    brightest = std::max(brightest, kept.brightest(volumes.back()));
    statistics.non_finite_voxels += kept.ranges().non_finite_voxels;
    statistics.bricks += kept.ranges().size();
    visible_bricks += kept.visible().visible;
  }
  MarchTask common;
  const bool lit_kernels = takes_lit_kernels(scene, settings.absorption);
  if (lit_kernels)
  {
    const auto start_light = std::chrono::steady_clock::now();
    LitTables& lit = this->Kept->lit;
    std::function<bool()> go;
    if (ask)
    {
      go = [&ask] { return ask(0.0); };
    }
    try
    {
      lit.update(scene, settings, volumes, threads, go);
    }
    catch (const Interrupted&)
    {
      if (progress)
      {
        return statistics;
      }
      throw;
    }
    statistics.seconds_light = seconds_since(start_light);
    statistics.shadows = lit.task().shadows;
    statistics.shadow_step = lit.shadow_step();
    statistics.light_bytes = lit.bytes();
    brightest = std::max(brightest, lit.brightest());
    common.lit = &lit.task();
    common.fog = lit.fog();
  }
  std::optional<FogRays> fog_rays;
  if (common.fog)
  {
    fog_rays.emplace(scene, *common.fog, film.width, film.height);
    common.fog_rays = &*fog_rays;
  }
  common.volumes = &volumes;
  common.rays = &rays;
  common.rule =
    !lit_kernels && follows_rule(scene, settings.rule) ? settings.rule : StepRule::Midpoint;
  common.mixture = scene.mixture;
  common.step = step;
  common.jitter = settings.jitter && !by_cells;
  common.refinements = by_cells ? 0 : std::clamp(settings.refinements, 0, most_refinements);
  while (common.refinements > 0 && step / (1 << common.refinements) < shortest)
  {
    --common.refinements;
  }
  common.refine_error = static_cast<float>(settings.refine_error);
  common.step_error = static_cast<float>(settings.step_error);
  common.film = &film;
  if (scene.mixture == Mixture::Components)
  {
    brightest *= static_cast<double>(scene.volumes.size()); // their light adds up faster than they dim
  }
  // What is behind can change a pixel by no more than the transmittance left times the brightest of
  // the matter there and of a white background.
  common.brightest = static_cast<float>(brightest);
  common.leave_below = static_cast<float>(settings.leave_error / brightest);
  for (int i = 0; i < 2; ++i)
  {
    constexpr double most = 3e38;
    common.average_range[i] = static_cast<float>(std::clamp(scene.average_range[i], -most, most));
  }
  common.isosurfaces = sorted_isosurfaces(scene);
  statistics.seconds_prepare = seconds_since(start_prepare);

  const auto start = std::chrono::steady_clock::now();
  const int tiles_x = (film.width + tile_edge - 1) / tile_edge;
  const int tiles_y = (film.height + tile_edge - 1) / tile_edge;
  const int parts_x = tile_edge / part_edge; // of a tile
  const int parts = parts_x * parts_x;
  const double pixels = double(film.width) * film.height;
  std::atomic<std::uint64_t> samples{ 0 };
  std::atomic<std::uint64_t> ray_count{ 0 };
  std::atomic<std::int64_t> done{ 0 }; // pixels
  std::atomic<bool> aborted{ false };
  const std::thread::id caller = std::this_thread::get_id();
  const auto march_part = [&](int tile, int part)
  {
    MarchTask task = common;
    task.x0 = tile % tiles_x * tile_edge + part % parts_x * part_edge;
    task.y0 = tile / tiles_x * tile_edge + part / parts_x * part_edge;
    if (task.x0 >= film.width || task.y0 >= film.height)
    {
      return;
    }
    task.x1 = std::min(task.x0 + part_edge, film.width);
    task.y1 = std::min(task.y0 + part_edge, film.height);
    const MarchCount count = integrator(task);
    samples += count.samples;
    ray_count += count.rays;
    const std::int64_t finished =
      done += std::int64_t(task.x1 - task.x0) * (task.y1 - task.y0);
    if (ask && std::this_thread::get_id() == caller && !ask(double(finished) / pixels))
    {
      aborted = true;
    }
  };
  if (visible_bricks > 0 || common.fog || scene.blend_mode == BlendMode::Additive)
  {
    arena.execute(
      [&]
      {
        tbb::parallel_for(
          tbb::blocked_range<int>(0, tiles_x * tiles_y * parts, 1),
          [&](const tbb::blocked_range<int>& range)
          {
            for (int i = range.begin(); i != range.end() && !aborted; ++i)
            {
              march_part(i / parts, i % parts);
            }
          },
          tbb::simple_partitioner());
      });
  }
  if (progress && !aborted && !progress(1.0))
  {
    aborted = true;
  }
  if (aborted && !progress)
  {
    throw Interrupted();
  }

  statistics.seconds = seconds_since(start);
  statistics.step = step;
  statistics.samples = samples;
  statistics.rays = ray_count;
  statistics.threads = threads;
  statistics.rule = common.rule;
  statistics.visible_bricks = visible_bricks;
  statistics.completed = !aborted;
  const std::string targets = simd_targets();
  statistics.simd = targets.substr(0, targets.find(' '));
  return statistics;
}

const char* shadow_method_name(ShadowMethod method)
{
  switch (method)
  {
    case ShadowMethod::None:
      return "none";
    case ShadowMethod::Rays:
      return "rays";
    case ShadowMethod::Volume:
      return "volume";
    case ShadowMethod::Functions:
      return "functions";
  }
  return "";
}

const char* step_rule_name(StepRule rule)
{
  switch (rule)
  {
    case StepRule::Midpoint:
      return "midpoint";
    case StepRule::Integrated:
      return "integrated";
    case StepRule::Cells:
      return "cells";
  }
  return "";
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
