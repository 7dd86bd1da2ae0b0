#include "Transport/fog_film.h"

#include "Transport/thread_arena.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>

#include <tbb/blocked_range.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <thread>

namespace brume
{

namespace
{

constexpr int tile_rows = 8;

}

FogRays::FogRays(const Scene& scene, const FogModel& fog, int width, int height)
  : Fog(fog)
  , SurfaceDepth(scene.surface_depth.empty() ? nullptr : scene.surface_depth.data())
  , Width(width)
  , Height(height)
  , WorldFromClip(glm::inverse(scene.camera.clip_from_world))
{
  // Of a parallel view w is the same everywhere, by a row of true zeros.
  const glm::dmat4& m = scene.camera.clip_from_world;
  this->Parallel = m[0][3] == 0.0 && m[1][3] == 0.0 && m[2][3] == 0.0;
  if (!this->Parallel)
  {
    // The point whose clip coordinates x, y and w are 0.
    const glm::dvec4& eye = this->WorldFromClip[2];
    this->Eye = glm::dvec3(eye) / eye.w;
    const glm::dvec3 across =
      this->ray(width / 2 + 1, height / 2).direction - this->ray(width / 2, height / 2).direction;
    this->Spread = 0.25 * glm::length(across);
  }
}

glm::dvec4 FogRays::unproject(int x, int y, double depth) const
{
  const double ndc_x = (2.0 * x + 1.0) / this->Width - 1.0;
  const double ndc_y = (2.0 * y + 1.0) / this->Height - 1.0;
  const glm::dmat4& m = this->WorldFromClip;
  return m[0] * ndc_x + m[1] * ndc_y + m[3] + m[2] * depth;
}

FogRay FogRays::ray(int x, int y) const
{
  const glm::dvec4 near_point = this->unproject(x, y, -1.0);
  const glm::dvec4 far_point = this->unproject(x, y, 1.0);
  // From the near to the far plane, which may be at infinity (w = 0).
  glm::dvec3 way = glm::dvec3(far_point) * near_point.w - glm::dvec3(near_point) * far_point.w;
  way = far_point.w * near_point.w < 0.0 ? -way : way;
  return this->Fog.ray(this->Parallel ? glm::dvec3(near_point) / near_point.w : this->Eye,
    glm::normalize(way), this->Spread);
}

double FogRays::end(int x, int y, const FogRay& ray) const
{
  const double depth = this->SurfaceDepth
                         ? this->SurfaceDepth[static_cast<std::size_t>(y) * this->Width + x]
                         : 1.0;
  if (!(depth < 1.0))
  {
    return std::numeric_limits<double>::infinity();
  }
  const glm::dvec4 point = this->unproject(x, y, depth);
  return std::max(0.0, glm::dot(glm::dvec3(point) / point.w - ray.origin, ray.direction));
}

double FogRays::near_plane(int x, int y, const FogRay& ray) const
{
  const glm::dvec4 point = this->unproject(x, y, -1.0);
  return std::max(0.0, glm::dot(glm::dvec3(point) / point.w - ray.origin, ray.direction));
}

bool render_fog(const Scene& scene, Film& film, int threads, const Progress& progress)
{
  if (!scene.surface_depth.empty() && scene.surface_depth.size() != film.size())
  {
    throw std::invalid_argument("the surface depths are of another size than the picture");
  }
  film.clear();
  const FogModel fog(scene);
  if (!fog.visible())
  {
    return !progress || progress(1.0);
  }
  const FogRays rays(scene, fog, film.width, film.height);
  const auto draw = [&](int x, int y)
  {
    const std::size_t pixel = static_cast<std::size_t>(y) * film.width + x;
    const FogRay ray = rays.ray(x, y);
    const double end = rays.end(x, y, ray);
    const glm::dvec3 radiance = fog.radiance(ray, 0.0, end);
    const glm::dvec3 transmittance = fog.transmittance(ray, 0.0, end);
    for (int c = 0; c < 3; ++c)
    {
      film.radiance[c][pixel] = static_cast<float>(radiance[c]);
      film.transmittance[c][pixel] = static_cast<float>(transmittance[c]);
    }
    const double half = fog.place_of_column(ray, 0.0, fog.half_column());
    if (half < end)
    {
      film.depth[pixel] = static_cast<float>(std::max(0.0, half - rays.near_plane(x, y, ray)));
    }
  };

  const int workers = threads > 0 ? threads : tbb::info::default_concurrency();
  ThreadArena arena(workers);
  const int tiles = (film.height + tile_rows - 1) / tile_rows;
  std::atomic<int> done{ 0 };
  std::atomic<bool> aborted{ false };
  const std::thread::id caller = std::this_thread::get_id();
  arena.execute(
    [&]
    {
      tbb::parallel_for(
        tbb::blocked_range<int>(0, tiles, 1),
        [&](const tbb::blocked_range<int>& range)
        {
          for (int tile = range.begin(); tile != range.end() && !aborted; ++tile)
          {
            // Before the tile: the others may have drawn all the rest when it is drawn, and who wants
            // it ended must be heard before all is done.
            if (progress && std::this_thread::get_id() == caller && !progress(double(done) / tiles))
            {
              aborted = true;
              break;
            }
            const int last = std::min((tile + 1) * tile_rows, film.height);
            for (int y = tile * tile_rows; y < last; ++y)
            {
              for (int x = 0; x < film.width; ++x)
              {
                draw(x, y);
              }
            }
            ++done;
          }
        },
        tbb::simple_partitioner());
    });
  return !aborted && (!progress || progress(1.0));
}

}
