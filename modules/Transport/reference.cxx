#include "Transport/reference.h"

#include "Transport/ray.h"
#include "Transport/reference_medium.h"

#include <tbb/blocked_range.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <mutex>
#include <stdexcept>
#include <thread>

namespace brume
{

namespace
{

/// Further pieces of a stretch for each whole rise or fall of a transfer function in it, and their
/// bound.
constexpr double pieces_across = 8.0;
constexpr int most_factor = 63;

/// Below this transmittance nothing can be seen in a float picture.
constexpr double nothing_passes = 1e-9;

struct RayResult
{
  glm::dvec3 radiance{ 0.0 };
  double transmittance = 1.0;
  double half_way = std::numeric_limits<double>::infinity(); ///< in data units from the start
  std::uint64_t samples = 0;

  /// Passes a stretch of constant extinction and source.
  void pass(const Optical& optical, double length, double middle)
  {
    ++this->samples;
    if (optical.extinction <= 0.0)
    {
      return;
    }
    const double weight =
      this->transmittance * opacity_from_optical_depth(optical.extinction * length);
    this->radiance += optical.source * weight;
    this->transmittance -= weight;
    if (std::isinf(this->half_way) && this->transmittance < 0.5)
    {
      this->half_way = middle;
    }
  }

  double change_from(const RayResult& other) const
  {
    const glm::dvec3 d = glm::abs(this->radiance - other.radiance);
    return std::max({ d.x, d.y, d.z, std::abs(this->transmittance - other.transmittance) });
  }
};

/// Walks the stretches of a ray between cell borders, in parts of its length.
class CellWalk
{
public:
  CellWalk(const RaySegment& segment, bool linear)
    : Begin(segment.begin)
    , Delta(segment.end - segment.begin)
    , Offset(linear ? 0.0 : 0.5) // trilinear cells end at voxels, nearest ones half-way between
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      this->Next[axis] = 2.0;
      if (this->Delta[axis] == 0.0)
      {
        continue;
      }
      const double start = this->Begin[axis] - this->Offset;
      this->Border[axis] =
        this->Delta[axis] > 0.0 ? std::floor(start) + 1.0 : std::ceil(start) - 1.0;
      this->Next[axis] = this->crossing(axis);
    }
  }

  /// The next stretch [from, to]; false at the end of the ray. Always moves on: each call takes at
  /// least one border.
  bool next(double& from, double& to)
  {
    if (this->At >= 1.0)
    {
      return false;
    }
    from = this->At;
    to = std::min({ this->Next[0], this->Next[1], this->Next[2], 1.0 });
    for (int axis = 0; axis < 3; ++axis)
    {
      if (this->Next[axis] <= to)
      {
        this->Border[axis] += this->Delta[axis] > 0.0 ? 1.0 : -1.0;
        this->Next[axis] = this->crossing(axis);
      }
    }
    to = std::max(from, to);
    this->At = to;
    return true;
  }

private:
  double crossing(int axis) const
  {
    return (this->Border[axis] + this->Offset - this->Begin[axis]) / this->Delta[axis];
  }

  glm::dvec3 Begin;
  glm::dvec3 Delta;
  double Offset;
  double At = 0.0;
  double Next[3];
  double Border[3] = { 0, 0, 0 };
};

template <class T>
RayResult integrate_cells(
  const ReferenceMedium<T>& medium, const Grid& grid, const RaySegment& segment, int pieces)
{
  RayResult result;
  const glm::dvec3 along = segment.end - segment.begin;
  CellWalk walk(segment, grid.linear);
  double from, to;
  while (walk.next(from, to))
  {
    if (!(to > from) || !medium.visible(segment.begin + along * (0.5 * (from + to))))
    {
      continue;
    }
    // A stretch that crosses peaks or edges of the transfer functions gets more pieces, so that two
    // coarse results do not agree on having missed them.
    const double crossed = medium.variation(
      medium.value(segment.begin + along * from), medium.value(segment.begin + along * to));
    const int count =
      pieces * (1 + static_cast<int>(std::min(pieces_across * crossed, double(most_factor))));
    const double width = (to - from) / count;
    for (int piece = 0; piece < count; ++piece)
    {
      const double middle = from + width * (piece + 0.5);
      result.pass(medium.at(segment.begin + along * middle, along), width * segment.length,
        middle * segment.length);
    }
    if (result.transmittance < nothing_passes)
    {
      break;
    }
  }
  return result;
}

template <class T>
RayResult integrate_fixed(const ReferenceMedium<T>& medium, const RaySegment& segment, double step,
  SamplePlacement placement, double leave_below)
{
  RayResult result;
  const glm::dvec3 along = (segment.end - segment.begin) / segment.length;
  const double phase = placement == SamplePlacement::FromNearPlane
    ? std::ceil(segment.start_offset / step) * step - segment.start_offset
    : 0.0;
  const double count = placement == SamplePlacement::Middle
    ? std::max(1.0, std::ceil(segment.length / step - 1e-6))
    : std::floor((segment.length - phase) / step + 1e-9) + 1.0;
  for (double i = 0.0; i < count && result.transmittance >= leave_below; ++i)
  {
    double length = step;
    double at = phase + i * step;
    if (placement == SamplePlacement::Middle)
    {
      length = std::min(step, segment.length - at);
      at += 0.5 * length;
    }
    const glm::dvec3 place = segment.begin + along * at;
    if (medium.visible(place))
    {
      result.pass(medium.at(place, along), length, at);
    }
  }
  return result;
}

void store(Film& film, std::size_t pixel, const RaySegment& segment, const RayResult& result,
  double error)
{
  for (int c = 0; c < 3; ++c)
  {
    film.radiance[c][pixel] = static_cast<float>(result.radiance[c]);
    film.transmittance[c][pixel] = static_cast<float>(result.transmittance);
  }
  film.depth[pixel] =
    static_cast<float>((segment.start_offset + result.half_way) * segment.world_scale);
  film.error[pixel] = static_cast<float>(error);
}

/// Calls draw(x, y, segment) for every pixel whose ray meets the grid, rows shared by threads.
template <class Draw>
bool for_each_ray(
  const Scene& scene, Film& film, int threads, const Progress& progress, const Draw& draw)
{
  if (!scene.surface_depth.empty() && scene.surface_depth.size() != film.size())
  {
    throw std::invalid_argument("the surface depths are of another size than the picture");
  }
  film = Film(film.width, film.height);
  const RayMaker rays(scene, film.width, film.height);
  const std::thread::id caller = std::this_thread::get_id();
  std::atomic<int> done{ 0 };
  std::atomic<bool> aborted{ false };
  tbb::task_arena arena(threads > 0 ? threads : tbb::info::default_concurrency());
  arena.execute(
    [&]
    {
      tbb::parallel_for(
        tbb::blocked_range<int>(0, film.height, 1),
        [&](const tbb::blocked_range<int>& rows)
        {
          for (int y = rows.begin(); y != rows.end() && !aborted; ++y)
          {
            for (int x = 0; x < film.width; ++x)
            {
              const RaySegment segment = rays.segment(x, y);
              if (segment.length > 0.0)
              {
                draw(static_cast<std::size_t>(y) * film.width + x, segment);
              }
            }
            const int finished = ++done;
            if (progress && std::this_thread::get_id() == caller &&
              !progress(double(finished) / film.height))
            {
              aborted = true;
            }
          }
        },
        tbb::simple_partitioner());
    });
  return !aborted;
}

/// Calls work(medium) with the medium of the grid's voxel type.
template <class Work>
void with_medium(const Scene& scene, const Work& work)
{
  if (scene.volumes[0].grid.sparse)
  {
    return work(ReferenceMedium<SparseVoxels>(scene, scene.volumes[0]));
  }
  switch (scene.volumes[0].grid.type)
  {
    case VoxelType::UInt8:
      return work(ReferenceMedium<std::uint8_t>(scene, scene.volumes[0]));
    case VoxelType::Int8:
      return work(ReferenceMedium<std::int8_t>(scene, scene.volumes[0]));
    case VoxelType::UInt16:
      return work(ReferenceMedium<std::uint16_t>(scene, scene.volumes[0]));
    case VoxelType::Int16:
      return work(ReferenceMedium<std::int16_t>(scene, scene.volumes[0]));
    case VoxelType::Float32:
      return work(ReferenceMedium<float>(scene, scene.volumes[0]));
    case VoxelType::Float16: // refused by Grid::validate
      return;
  }
}

}

ReferenceStatistics render_reference(const Scene& scene, const ReferenceSettings& settings,
  Film& film, const Progress& progress)
{
  if (!(settings.tolerance > 0.0) || settings.most_pieces < 2)
  {
    throw std::invalid_argument(
      "the reference needs a positive tolerance and at least 2 pieces a cell");
  }
  scene.validate();
  ReferenceStatistics statistics;
  const auto start = std::chrono::steady_clock::now();
  std::mutex mutex;
  double total_change = 0.0;
  with_medium(scene,
    [&](const auto& medium)
    {
      statistics.completed = for_each_ray(scene, film, settings.threads, progress,
        [&](std::size_t pixel, const RaySegment& segment)
        {
          RayResult last = integrate_cells(medium, scene.volumes[0].grid, segment, 1);
          std::uint64_t samples = last.samples;
          double change = 0.0;
          int pieces = 2;
          for (;; pieces *= 2)
          {
            const RayResult finer = integrate_cells(medium, scene.volumes[0].grid, segment, pieces);
            samples += finer.samples;
            change = finer.change_from(last);
            last = finer;
            if (change <= settings.tolerance || 2 * pieces > settings.most_pieces)
            {
              break;
            }
          }
          store(film, pixel, segment, last, change);
          const std::lock_guard<std::mutex> lock(mutex);
          statistics.samples += samples;
          total_change += change;
          statistics.largest_change = std::max(statistics.largest_change, change);
          statistics.unsettled_rays += change > settings.tolerance;
        });
    });
  statistics.mean_change = total_change / static_cast<double>(film.size());
  statistics.seconds =
    std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return statistics;
}

bool render_fixed_step(const Scene& scene, double step, SamplePlacement placement,
  double leave_below, int threads, Film& film, const Progress& progress)
{
  if (!(step > 0.0) || !std::isfinite(step))
  {
    throw std::invalid_argument("the step must be a positive length");
  }
  scene.validate();
  bool completed = false;
  with_medium(scene,
    [&](const auto& medium)
    {
      completed = for_each_ray(scene, film, threads, progress,
        [&](std::size_t pixel, const RaySegment& segment)
        {
          store(film, pixel, segment,
            integrate_fixed(medium, segment, step, placement, leave_below), 0.0);
        });
    });
  return completed;
}

}
