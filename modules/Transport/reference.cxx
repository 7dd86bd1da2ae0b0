#include "Transport/reference.h"

#include "Transport/reference_film.h"
#include "Transport/reference_integrators.h"
#include "Transport/thread_arena.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <chrono>
#include <mutex>
#include <stdexcept>
#include <thread>

namespace brume
{

bool for_each_ray(const Scene& scene,
  Film& film,
  int threads,
  const Progress& progress,
  const std::function<void(std::size_t, const PixelRay&)>& draw)
{
  if (!scene.surface_depth.empty() && scene.surface_depth.size() != film.size())
  {
    throw std::invalid_argument("the surface depths are of another size than the picture");
  }
  film = Film(film.width, film.height);
  const ReferenceRays rays(scene, film.width, film.height);
  const std::thread::id caller = std::this_thread::get_id();
  std::atomic<int> done{ 0 };
  std::atomic<bool> aborted{ false };
  ThreadArena arena(threads);
  arena.execute(
    [&]
    {
      tbb::parallel_for(
        tbb::blocked_range<int>(0, film.height, 1),
        [&](const tbb::blocked_range<int>& rows)
        {
          for (int y = rows.begin(); y != rows.end() && !aborted; ++y)
          {
            // Before the row: who wants it ended is heard before all is done.
            if (progress && std::this_thread::get_id() == caller &&
              !progress(double(done) / film.height))
            {
              aborted = true;
              break;
            }
            for (int x = 0; x < film.width; ++x)
            {
              const PixelRay ray = rays.ray(x, y);
              if (!ray.empty() || has_fog(scene))
              {
                draw(static_cast<std::size_t>(y) * film.width + x, ray);
              }
            }
            ++done;
          }
        },
        tbb::simple_partitioner());
    });
  return !aborted && (!progress || progress(1.0));
}

void store(Film& film,
  std::size_t pixel,
  const PixelRay& ray,
  const RayResult& result,
  double error)
{
  for (int c = 0; c < 3; ++c)
  {
    film.radiance[c][pixel] = static_cast<float>(result.radiance[c]);
    film.transmittance[c][pixel] = static_cast<float>(result.transmittance[c]);
  }
  film.depth[pixel] = static_cast<float>(result.half_way * ray.world_length);
  film.error[pixel] = static_cast<float>(error);
}

std::unique_ptr<RayIntegral> make_ray_integral(const ReferenceScene& scene, const PixelRay& ray)
{
  switch (scene.scene.blend_mode)
  {
    case BlendMode::Composite:
      break;
    case BlendMode::MaximumIntensity:
    case BlendMode::MinimumIntensity:
      return make_extreme(scene, ray);
    case BlendMode::AverageIntensity:
    case BlendMode::Additive:
      return make_grey(scene, ray);
    case BlendMode::Isosurface:
      return make_isosurface(scene, ray);
    case BlendMode::Slice:
      return make_slice(scene, ray);
  }
  return scene.lighting ? make_lit(scene, ray) : make_composite(scene, ray);
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
  if (scene.volumes.empty()) // fog alone, in closed form
  {
    statistics.completed = render_fog(scene, film, settings.threads, progress);
    statistics.seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return statistics;
  }
  // Across sharp surfaces two pictures that are both wrong agree by chance now and then, three hardly.
  constexpr int calm_doublings = 2;
  const ReferenceScene prepared(scene);
  std::mutex mutex;
  double total_change = 0.0;
  statistics.completed = for_each_ray(scene,
    film,
    settings.threads,
    progress,
    [&](std::size_t pixel, const PixelRay& ray)
    {
      const std::unique_ptr<RayIntegral> integral = make_ray_integral(prepared, ray);
      RayResult last = integral->integrate(1);
      std::uint64_t samples = last.samples;
      double change = 0.0;
      int calm = 0; // doublings in a row that changed little
      for (int pieces = 2; !integral->exact(); pieces *= 2)
      {
        const RayResult finer = integral->integrate(pieces);
        samples += finer.samples;
        change = finer.change_from(last);
        last = finer;
        calm = change <= settings.tolerance ? calm + 1 : 0;
        if (calm == calm_doublings || 2 * pieces > settings.most_pieces)
        {
          break;
        }
      }
      store(film, pixel, ray, last, change);
      const std::lock_guard<std::mutex> lock(mutex);
      statistics.samples += samples;
      total_change += change;
      statistics.largest_change = std::max(statistics.largest_change, change);
      statistics.unsettled_rays += change > settings.tolerance;
    });
  statistics.mean_change = total_change / static_cast<double>(film.size());
  statistics.seconds =
    std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return statistics;
}
}
