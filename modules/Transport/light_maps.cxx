#include "Transport/light_maps.h"

#include "Transport/marcher.h"
#include "Transport/thread_arena.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <thread>

namespace brume
{

namespace
{

/// More nodes than these in one lattice are not made: the distance between them grows instead.
constexpr double most_nodes = 1 << 26;
/// Optical depths of 16 bits end here (divided by the thinnest octave's attenuation): e⁻²⁰ = 2e-9.
constexpr double deepest_word = 20.0;
/// Where a step of 16 bits would be larger than this, 32 are taken.
constexpr double widest_word = 80.0 / 65535.0;

void store(const glm::dmat4& m, float out[12])
{
  for (int row = 0; row < 3; ++row)
  {
    for (int column = 0; column < 4; ++column)
    {
      out[4 * row + column] = static_cast<float>(m[column][row]);
    }
  }
}

/// A view of a lattice's values, as kernels read fields.
FieldView view(const LightLattice& lattice, int which, bool floats)
{
  Grid grid;
  grid.voxels = floats ? static_cast<const void*>(lattice.floats[which].data())
                       : static_cast<const void*>(lattice.words[which].data());
  grid.type = floats ? VoxelType::Float32 : VoxelType::UInt16;
  std::copy(lattice.dims, lattice.dims + 3, grid.dims);
  return view_field(grid, 0, false, 0.0f);
}

void* reserve(LightLattice& lattice, int which, std::size_t count, bool floats)
{
  lattice.floats[which].resize(floats ? count : 0);
  lattice.words[which].resize(floats ? 0 : count);
  return floats ? static_cast<void*>(lattice.floats[which].data())
                : static_cast<void*>(lattice.words[which].data());
}

void append(std::vector<double>& key, const glm::dvec3& v)
{
  key.insert(key.end(), { v.x, v.y, v.z });
}

}

std::size_t LightLattice::bytes() const
{
  std::size_t sum = 0;
  for (int i = 0; i < 6; ++i)
  {
    sum += this->words[i].size() * sizeof(std::uint16_t) + this->floats[i].size() * sizeof(float);
  }
  return sum;
}

/// Where the nodes of a lattice are: the world's place of node (0, 0, 0) and the ways to the next.
struct LightMaps::Frame
{
  glm::dvec3 origin{ 0.0 };
  glm::dvec3 axes[3];
  int dims[3];

  glm::dmat4 world_from_node() const
  {
    return { glm::dvec4(this->axes[0], 0.0), glm::dvec4(this->axes[1], 0.0),
      glm::dvec4(this->axes[2], 0.0), glm::dvec4(this->origin, 1.0) };
  }
  double nodes() const { return double(this->dims[0]) * this->dims[1] * this->dims[2]; }
};

namespace
{

/// A box along unit vectors around all corners, its nodes at most `spacing` apart.
template <class Frame>
Frame enclose(
  const std::vector<glm::dvec3>& corners, const glm::dvec3 directions[3], double spacing)
{
  Frame frame;
  for (;;)
  {
    glm::dvec3 origin(0.0);
    for (int axis = 0; axis < 3; ++axis)
    {
      double lower = std::numeric_limits<double>::max();
      double upper = -lower;
      for (const glm::dvec3& corner : corners)
      {
        const double at = glm::dot(corner, directions[axis]);
        lower = std::min(lower, at);
        upper = std::max(upper, at);
      }
      const double extent = std::max(upper - lower, 1e-6 * spacing);
      int count = static_cast<int>(std::min(std::ceil(extent / spacing - 1e-6), 1e6)) + 1;
      count = std::max(count, 2);
      // From end to end, so that faces across the axis are planes of nodes.
      frame.axes[axis] = directions[axis] * (extent / (count - 1));
      frame.dims[axis] = axis == 0 ? (count + most_lanes - 1) / most_lanes * most_lanes : count;
      origin += directions[axis] * lower;
    }
    frame.origin = origin;
    if (frame.nodes() <= most_nodes)
    {
      return frame;
    }
    spacing *= std::max(1.05, std::cbrt(frame.nodes() / most_nodes));
  }
}

}

LightMaps::Frame LightMaps::frame_along(const glm::dvec3& axis, double spacing) const
{
  // Of the grid's axes the one most across the light gives the lattice its first direction.
  glm::dvec3 across(0.0);
  double longest = -1.0;
  for (int i = 0; i < 3; ++i)
  {
    const glm::dvec3 edge = glm::normalize(glm::dvec3(this->WorldFromIndex[i]));
    const glm::dvec3 rest = edge - axis * glm::dot(edge, axis);
    if (glm::length(rest) > longest + 1e-9)
    {
      longest = glm::length(rest);
      across = rest;
    }
  }
  const glm::dvec3 first = glm::normalize(across);
  const glm::dvec3 directions[3] = { first, glm::cross(axis, first), axis };
  return enclose<Frame>(this->Corners, directions, spacing);
}

LightMaps::Frame LightMaps::frame_of_box(double spacing) const
{
  const glm::dvec3 first = glm::normalize(glm::dvec3(this->WorldFromIndex[0]));
  glm::dvec3 second(this->WorldFromIndex[1]);
  second = glm::normalize(second - first * glm::dot(first, second));
  const glm::dvec3 directions[3] = { first, second, glm::cross(first, second) };
  return enclose<Frame>(this->Corners, directions, spacing);
}

void LightMaps::find_corners(const Scene& scene,
  const std::vector<VolumeTask>& volumes,
  const LitTask& lit,
  bool whole)
{
  this->Corners.clear();
  for (std::size_t k = 0; k < volumes.size(); ++k)
  {
    const Volume& volume = scene.volumes[k];
    const LitFrame& frame = lit.frames[k];
    const glm::dmat4 world_from_index = volume.world_from_data * volume.data_from_index;
    glm::dvec3 lower(1e300);
    glm::dvec3 upper(-1e300);
    const VisibleBricks* bricks = whole ? nullptr : volumes[k].visible;
    if (bricks)
    {
      const double edge = 1 << bricks->shift;
      std::size_t index = 0;
      for (int z = 0; z < bricks->dims[2]; ++z)
      {
        for (int y = 0; y < bricks->dims[1]; ++y)
        {
          for (int x = 0; x < bricks->dims[0]; ++x, ++index)
          {
            if (bricks->distance[index] == 0)
            {
              lower = glm::min(lower, glm::dvec3(x, y, z) * edge);
              upper = glm::max(upper, glm::dvec3(x + 1, y + 1, z + 1) * edge);
            }
          }
        }
      }
      if (lower.x > upper.x)
      {
        continue;
      }
    }
    for (int axis = 0; axis < 3; ++axis)
    {
      const double low = volume.grid.lower(axis);
      const double high = volume.grid.upper(axis);
      // The first and last bricks reach beyond the grid's cells.
      lower[axis] = bricks && lower[axis] > 0.0 ? std::max(lower[axis], low) : low;
      upper[axis] = bricks && upper[axis] < (bricks->dims[axis] << bricks->shift)
        ? std::min(upper[axis], high)
        : high;
      if (!whole) // up to where a box of cropping ends
      {
        lower[axis] = std::min(std::max(lower[axis], double(frame.lower[axis])), high);
        upper[axis] = std::max(std::min(upper[axis], double(frame.upper[axis])), lower[axis]);
      }
    }
    for (int corner = 0; corner < 8; ++corner)
    {
      const glm::dvec4 place(corner & 1 ? upper.x : lower.x, corner & 2 ? upper.y : lower.y,
        corner & 4 ? upper.z : lower.z, 1.0);
      this->Corners.push_back(glm::dvec3(world_from_index * place));
    }
  }
  if (this->Corners.empty())
  {
    this->Corners.emplace_back(0.0);
  }
}

double LightMaps::deepest(const Scene& scene, const std::vector<VolumeTask>& volumes) const
{
  double sum = 0.0;
  for (std::size_t k = 0; k < volumes.size(); ++k)
  {
    const Volume& volume = scene.volumes[k];
    glm::dvec3 extent;
    double length = 0.0;
    for (int axis = 0; axis < 3; ++axis)
    {
      extent[axis] = volume.grid.upper(axis) - volume.grid.lower(axis);
      length += glm::length(glm::dvec3(volume.data_from_index[axis])) * extent[axis];
    }
    double most = 0.0;
    if (volumes[k].table)
    {
      for (const LookupNode& node : volumes[k].table->nodes)
      {
        most = std::max(most, double(node.extinction));
      }
      if (volumes[k].table->columns > 0)
      {
        return std::numeric_limits<double>::infinity();
      }
      most *= volumes[k].weight;
    }
    else
    {
      most = std::max(0.0, double(volumes[k].largest)) * volumes[k].extinction;
    }
    sum += most * length;
  }
  return sum;
}

void LightMaps::run(SweepTask& task, int threads, const std::function<bool()>& go) const
{
  const int rows = task.dims[1] * (task.positional ? task.dims[2] : 1);
  const std::thread::id caller = std::this_thread::get_id();
  std::atomic<bool> ended{ false };
  ThreadArena arena(threads);
  arena.execute(
    [&]
    {
      tbb::parallel_for(
        tbb::blocked_range<int>(0, rows, 4),
        [&](const tbb::blocked_range<int>& range)
        {
          if (ended)
          {
            return;
          }
          sweep(task, range.begin(), range.end());
          if (go && std::this_thread::get_id() == caller && !go())
          {
            ended = true;
          }
        },
        tbb::simple_partitioner());
    });
  if (ended)
  {
    throw Marcher::Interrupted();
  }
}

void LightMaps::update(const Scene& scene,
  const std::vector<VolumeTask>& volumes,
  const std::vector<double>& matter,
  double spacing,
  double voxel,
  bool floats,
  int threads,
  LitTask& lit,
  bool ambient,
  const std::function<bool()>& go)
{
  const Volume& first = scene.volumes[0];
  this->WorldFromIndex = first.world_from_data * first.data_from_index;
  const glm::dmat4 index_from_world = glm::inverse(this->WorldFromIndex);
  bool corners = false;
  const auto settle = [&]
  {
    if (!corners)
    {
      this->find_corners(scene, volumes, lit, lit.fog.enabled);
      corners = true;
    }
  };
  const double thinnest = 30.0 / lit.deep_enough;
  double most_depth = -1.0; // of what light volumes hold
  const auto settle_depth = [&]
  {
    if (most_depth < 0.0)
    {
      most_depth = std::clamp(this->deepest(scene, volumes), 1e-6, deepest_word / thinnest);
    }
  };
  std::vector<double> common = matter;
  common.insert(common.end(),
    { spacing, voxel, double(floats), double(lit.maps), thinnest, double(lit.components),
      double(lit.fog.enabled) });

  const auto prepare = [&](const Frame& frame, LightLattice& lattice)
  {
    std::copy(frame.dims, frame.dims + 3, lattice.dims);
    lattice.node_from_world = glm::inverse(frame.world_from_node());
    SweepTask task;
    task.volumes = &volumes;
    task.lit = &lit;
    std::copy(frame.dims, frame.dims + 3, task.dims);
    store(index_from_world * frame.world_from_node(), task.index_from_node);
    task.pieces = std::clamp(
      static_cast<int>(std::ceil(glm::length(frame.axes[2]) / voxel - 1e-3)), 1, 64);
    return task;
  };

  const bool maps = lit.shadows == ShadowMethod::Volume || lit.shadows == ShadowMethod::Functions;
  this->Lights.resize(maps ? lit.lights.size() : 0);
  for (std::size_t i = 0; i < this->Lights.size(); ++i)
  {
    const Light& light = scene.lights[i];
    LightLattice& lattice = this->Lights[i];
    // Functions of depth need parallel light.
    const bool functions = lit.shadows == ShadowMethod::Functions && !light.positional;
    std::vector<double> key = common;
    key.push_back(light.positional);
    key.push_back(static_cast<double>(lit.shadows));
    append(key, light.positional ? light.position : light.direction);
    settle_depth();
    const bool wide = floats || functions || most_depth > widest_word * 65535.0;
    if (key != lattice.key)
    {
      lattice.key.clear();
      settle();
      const Frame frame = light.positional
        ? this->frame_of_box(spacing)
        : this->frame_along(glm::normalize(light.direction), spacing);
      SweepTask task = prepare(frame, lattice);
      task.positional = light.positional;
      std::copy(lit.lights[i].place, lit.lights[i].place + 3, task.place);
      task.floats = wide;
      task.result = functions ? SweepTask::Result::Functions : SweepTask::Result::Depth;
      lattice.scale = static_cast<float>(most_depth / 65535.0);
      task.scale = lattice.scale;
      const std::size_t count = functions
        ? static_cast<std::size_t>(frame.dims[0]) * frame.dims[1] * ShadowFunctions::planes
        : static_cast<std::size_t>(frame.nodes());
      for (int map = 0; map < 3; ++map)
      {
        void* out = reserve(lattice, map, map < lit.maps ? count : 0, wide);
        task.out[map] = map < lit.maps ? out : nullptr;
      }
      this->run(task, threads, go);
      lattice.key = std::move(key);
    }
    float node_from_index[12];
    store(lattice.node_from_world * this->WorldFromIndex, node_from_index);
    for (int map = 0; map < lit.maps; ++map)
    {
      LitLight& target = lit.lights[i];
      if (functions)
      {
        ShadowFunctions& f = target.functions[map];
        f.texels = lattice.floats[map].data();
        std::copy(lattice.dims, lattice.dims + 2, f.dims);
        std::copy(node_from_index, node_from_index + 12, f.node_from_index);
        continue;
      }
      LightGrid& grid = target.depth[map];
      grid.field = view(lattice, map, wide);
      grid.scale = wide ? 1.0f : lattice.scale;
      std::copy(node_from_index, node_from_index + 12, grid.node_from_index);
    }
  }

  lit.ambient.clear();
  const glm::dvec3 radiances[2] = { scene.sky.radiance, scene.sky.ground };
  if (!ambient)
  {
    this->Ambient = LightLattice();
    return;
  }
  std::vector<double> key = common;
  append(key, scene.sky.up);
  key.push_back(radiances[0] != glm::dvec3(0.0));
  key.push_back(radiances[1] != glm::dvec3(0.0));
  settle_depth();
  const bool wide = floats || most_depth > widest_word * 65535.0;
  // From below no light comes through layers without end.
  const bool layers = lit.fog.enabled && scene.fog.falloff > 0.0;
  if (key != this->Ambient.key)
  {
    this->Ambient.key.clear();
    settle();
    const Frame frame = this->frame_along(-glm::normalize(scene.sky.up), spacing);
    SweepTask task = prepare(frame, this->Ambient);
    task.result = SweepTask::Result::BothWays;
    task.floats = wide;
    this->Ambient.scale = static_cast<float>(most_depth / 65535.0);
    task.scale = this->Ambient.scale;
    const std::size_t count = static_cast<std::size_t>(task.dims[0]) * task.dims[1] * task.dims[2];
    for (int side = 0; side < 2; ++side)
    {
      for (int map = 0; map < 3; ++map)
      {
        const bool wanted = radiances[side] != glm::dvec3(0.0) && map < lit.maps;
        void* out = reserve(this->Ambient, 3 * side + map, wanted ? count : 0, wide);
        task.out[3 * side + map] = wanted ? out : nullptr;
      }
    }
    this->run(task, threads, go);
    this->Ambient.key = std::move(key);
  }
  for (int side = 0; side < 2; ++side)
  {
    if (radiances[side] == glm::dvec3(0.0) || (side == 1 && layers))
    {
      continue;
    }
    AmbientLight light;
    light.from_above = side == 0;
    for (int c = 0; c < 3; ++c)
    {
      light.radiance[c] = static_cast<float>(radiances[side][c]);
    }
    for (int map = 0; map < lit.maps; ++map)
    {
      LightGrid& grid = light.depth[map];
      grid.field = view(this->Ambient, 3 * side + map, wide);
      grid.scale = wide ? 1.0f : this->Ambient.scale;
      store(this->Ambient.node_from_world * this->WorldFromIndex, grid.node_from_index);
    }
    lit.ambient.push_back(light);
  }
}

std::size_t LightMaps::bytes() const
{
  std::size_t sum = this->Ambient.bytes();
  for (const LightLattice& lattice : this->Lights)
  {
    sum += lattice.bytes();
  }
  return sum;
}

void LightMaps::clear()
{
  this->Lights.clear();
  this->Ambient = LightLattice();
}

}
