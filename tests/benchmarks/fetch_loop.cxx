#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fetch_loop.cxx"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "fetch_loop.h"

HWY_BEFORE_NAMESPACE();
namespace benchmarks
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

int lanes_target()
{
  return static_cast<int>(hn::Lanes(hn::ScalableTag<float>()));
}

/// The sum of all that was fetched, so that none of it can be left out.
float fetch_target(const FetchTrace& trace)
{
  const hn::ScalableTag<std::int32_t> ints;
  const hn::ScalableTag<float> floats;
  const std::size_t lanes = hn::Lanes(floats);
  const auto row = hn::Set(ints, trace.row);
  const auto slice = hn::Set(ints, trace.slice);
  const auto* voxels = reinterpret_cast<const std::int32_t*>(trace.voxels);
  const float* table = trace.table.data();
  auto words = hn::Zero(ints);
  auto colours = hn::Zero(floats);
  for (std::size_t i = 0; i < trace.cells.size(); i += lanes)
  {
    const auto cell = hn::LoadU(ints, trace.cells.data() + i);
    const auto behind = hn::Add(cell, slice);
    words = hn::Add(words, hn::GatherOffset(ints, voxels, cell));
    words = hn::Add(words, hn::GatherOffset(ints, voxels, hn::Add(cell, row)));
    words = hn::Add(words, hn::GatherOffset(ints, voxels, behind));
    words = hn::Add(words, hn::GatherOffset(ints, voxels, hn::Add(behind, row)));
    const auto node = hn::LoadU(ints, trace.nodes.data() + i);
    const auto depth =
      hn::Add(hn::GatherIndex(floats, table + 3, node), hn::GatherIndex(floats, table + 7, node));
    if (!hn::AllFalse(floats, hn::Gt(depth, hn::Zero(floats))))
    {
      for (int channel = 0; channel < 3; ++channel)
      {
        colours = hn::Add(colours, hn::GatherIndex(floats, table + channel, node));
        colours = hn::Add(colours, hn::GatherIndex(floats, table + channel + 4, node));
      }
    }
  }
  const auto all = hn::Add(colours, hn::ConvertTo(floats, words));
  return hn::GetLane(hn::SumOfLanes(floats, all));
}

}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

#include "Transport/bricks.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>

namespace benchmarks
{

HWY_EXPORT(lanes_target);
HWY_EXPORT(fetch_target);

namespace
{

constexpr int tile_edge = 32;
constexpr int samples_between_leaps = 4;
constexpr int intervals = 4096;

/// A ray in index space, its steps counted from where it enters the grid.
struct Ray
{
  glm::vec3 begin{ 0.0f };
  glm::vec3 delta{ 0.0f };
  float steps = 0.0f;
  float at = 0.0f;
};

Ray make_ray(const glm::dmat4& index_from_clip,
  const brume::Volume& volume,
  double step,
  double ndc_x,
  double ndc_y)
{
  const auto place = [&](double z)
  {
    const glm::dvec4 p = index_from_clip * glm::dvec4(ndc_x, ndc_y, z, 1.0);
    return glm::dvec3(p) / p.w;
  };
  const glm::dvec3 from = place(-1.0);
  const glm::dvec3 way = place(1.0) - from;
  double enter = 0.0;
  double leave = 1.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double a = (volume.grid.lower(axis) - from[axis]) / way[axis];
    const double b = (volume.grid.upper(axis) - from[axis]) / way[axis];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  Ray ray;
  if (enter < leave)
  {
    const double count =
      glm::length(glm::dmat3(volume.data_from_index) * way) * (leave - enter) / step;
    ray.begin = glm::vec3(from + way * enter);
    ray.delta = glm::vec3(way * ((leave - enter) / count));
    ray.steps = static_cast<float>(std::max(1.0, std::ceil(count - 1e-6)));
  }
  return ray;
}

struct Recorder
{
  const brume::Volume& Volume;
  const brume::VisibleBricks Bricks;
  const std::uint16_t* Voxels;
  double Scale;
  FetchTrace Trace;

  /// Steps to the first place outside the invisible surroundings; 0 in a visible brick.
  float leap(const glm::vec3& place, const glm::vec3& delta) const
  {
    const int edge = 1 << Bricks.shift;
    int brick[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      brick[axis] = std::min(int(std::max(place[axis], 0.0f)) / edge, Bricks.dims[axis] - 1);
    }
    const int distance = static_cast<int>(
      Bricks
        .distance[(std::size_t(brick[2]) * Bricks.dims[1] + brick[1]) * Bricks.dims[0] + brick[0]]);
    if (distance == 0)
    {
      return 0.0f;
    }
    float way = 1e30f;
    for (int axis = 0; axis < 3; ++axis)
    {
      const float face =
        float(edge * (delta[axis] > 0.0f ? brick[axis] + distance : brick[axis] - distance + 1));
      if (delta[axis] != 0.0f)
      {
        way = std::min(way, (face - place[axis]) / delta[axis]);
      }
    }
    return std::floor(std::max(way - 1e-3f, 0.0f)) + 1.0f;
  }

  void sample(const glm::vec3& place)
  {
    const brume::Grid& grid = Volume.grid;
    int cell[3];
    float f[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      const float p = std::clamp(place[axis], 0.0f, float(grid.dims[axis] - 1));
      cell[axis] = std::min(int(p), grid.dims[axis] - 2);
      f[axis] = p - cell[axis];
    }
    const std::size_t row = grid.dims[0];
    const std::size_t slice = row * grid.dims[1];
    const std::size_t first = cell[2] * slice + cell[1] * row + cell[0];
    double value = 0.0;
    for (int corner = 0; corner < 8; ++corner)
    {
      const int x = corner & 1, y = corner >> 1 & 1, z = corner >> 2;
      value += Voxels[first + x + y * row + z * slice] * (x ? f[0] : 1 - f[0]) *
               (y ? f[1] : 1 - f[1]) * (z ? f[2] : 1 - f[2]);
    }
    const double position = (value - Volume.classification.lower) * Scale;
    Trace.cells.push_back(static_cast<std::int32_t>(2 * first));
    Trace.nodes.push_back(4 * std::clamp(int(position), 0, intervals - 1));
  }

  void march(std::vector<Ray>& rays)
  {
    const auto active = [](const Ray& ray) { return ray.at < ray.steps; };
    while (std::any_of(rays.begin(), rays.end(), active))
    {
      bool leapt = false;
      for (Ray& ray : rays)
      {
        const float steps =
          active(ray) ? this->leap(ray.begin + ray.delta * (ray.at + 0.5f), ray.delta) : 0.0f;
        leapt = leapt || steps > 0.0f;
        ray.at += steps;
      }
      for (int i = 0; !leapt && i < samples_between_leaps; ++i)
      {
        if (std::none_of(rays.begin(), rays.end(), active))
        {
          return;
        }
        for (Ray& ray : rays)
        {
          Trace.samples += active(ray);
          this->sample(ray.begin + ray.delta * (ray.at + 0.5f));
          ray.at += 1.0f;
        }
      }
    }
  }
};

}

FetchTrace record_fetches(const brume::Scene& scene, int width, int height, double step)
{
  const brume::Volume& volume = scene.volumes[0];
  if (volume.grid.type != brume::VoxelType::UInt16 || volume.grid.components != 1)
  {
    throw std::invalid_argument("fetches are recorded for one 16-bit component");
  }
  const brume::Classification& c = volume.classification;
  std::vector<float> table;
  const std::size_t last = c.opacity.size() - 1;
  for (int i = 0; i <= intervals; ++i)
  {
    const std::size_t node = last * i / intervals;
    for (int channel = 0; channel < 3; ++channel)
    {
      table.push_back(static_cast<float>(c.rgb[3 * node + channel]));
    }
    table.push_back(static_cast<float>(c.opacity[node]));
  }
  const double scale = intervals / (c.upper - c.lower);
  const auto position = [&](float value)
  { return std::clamp((value - c.lower) * scale, 0.0, double(intervals)); };
  Recorder recorder{ volume,
    brume::find_visible_bricks(
      brume::measure_bricks(volume.grid),
      [&](float lower, float upper)
      {
        const int end = static_cast<int>(std::ceil(position(upper)));
        for (int node = static_cast<int>(position(lower)); node <= end; ++node)
        {
          if (table[4 * node + 3] > 0.0f)
          {
            return true;
          }
        }
        return false;
      },
      0.0f),
    static_cast<const std::uint16_t*>(volume.grid.voxels),
    scale,
    {} };
  recorder.Trace.voxels = static_cast<const std::uint8_t*>(volume.grid.voxels);
  recorder.Trace.row = 2 * volume.grid.dims[0];
  recorder.Trace.slice = recorder.Trace.row * volume.grid.dims[1];
  recorder.Trace.table = table;

  const glm::dmat4 index_from_clip =
    glm::inverse(scene.camera.clip_from_world * volume.world_from_data * volume.data_from_index);
  const int lanes = HWY_DYNAMIC_DISPATCH(lanes_target)();
  const int packet_width = lanes >= 8 ? 4 : lanes >= 2 ? 2 : 1;
  const int packet_height = lanes / packet_width;
  std::vector<Ray> rays(lanes);
  for (int tile_y = 0; tile_y < height; tile_y += tile_edge)
    for (int tile_x = 0; tile_x < width; tile_x += tile_edge)
      for (int y = tile_y; y < std::min(tile_y + tile_edge, height); y += packet_height)
        for (int x = tile_x; x < std::min(tile_x + tile_edge, width); x += packet_width)
        {
          for (int lane = 0; lane < lanes; ++lane)
          {
            const int px = x + lane % packet_width;
            const int py = y + lane / packet_width;
            rays[lane] = px < width && py < height ? make_ray(index_from_clip,
                                                       volume,
                                                       step,
                                                       (2.0 * px + 1.0) / width - 1.0,
                                                       (2.0 * py + 1.0) / height - 1.0)
                                                   : Ray();
          }
          recorder.march(rays);
        }
  return std::move(recorder.Trace);
}

double run_fetches(const FetchTrace& trace)
{
  const auto start = std::chrono::steady_clock::now();
  volatile float sum = HWY_DYNAMIC_DISPATCH(fetch_target)(trace);
  static_cast<void>(sum);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}

#endif
