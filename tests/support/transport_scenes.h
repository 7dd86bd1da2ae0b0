// Small scenes for the tests of Transport: grids that own their voxels, and cameras whose rays can be
// written down without the code under test.
#pragma once

#include "Transport/film.h"
#include "Transport/marcher.h"
#include "Transport/scene.h"

#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

namespace transport_scenes
{

using namespace brume;

template <class T>
constexpr VoxelType voxel_type()
{
  if constexpr (std::is_same_v<T, std::uint8_t>)
    return VoxelType::UInt8;
  else if constexpr (std::is_same_v<T, std::int8_t>)
    return VoxelType::Int8;
  else if constexpr (std::is_same_v<T, std::uint16_t>)
    return VoxelType::UInt16;
  else if constexpr (std::is_same_v<T, std::int16_t>)
    return VoxelType::Int16;
  else
    return VoxelType::Float32;
}

/// Voxels of any type: value(i, j, k), and for four components value(i, j, k, c).
template <class T>
struct Voxels
{
  int dims[3];
  int components = 1;
  std::vector<T> values;

  template <class Value>
  Voxels(int nx, int ny, int nz, Value value)
    : dims{ nx, ny, nz }
  {
    for (int k = 0; k < nz; ++k)
      for (int j = 0; j < ny; ++j)
        for (int i = 0; i < nx; ++i)
        {
          if constexpr (std::is_invocable_v<Value, int, int, int, int>)
          {
            components = 4;
            for (int c = 0; c < 4; ++c)
              values.push_back(static_cast<T>(value(i, j, k, c)));
          }
          else
          {
            values.push_back(static_cast<T>(value(i, j, k)));
          }
        }
  }

  Grid grid() const
  {
    Grid g;
    g.voxels = values.data();
    g.type = voxel_type<T>();
    g.components = components;
    g.component = components - 1;
    g.colour = components == 4 ? VoxelColour::RGB : VoxelColour::Value;
    std::copy(dims, dims + 3, g.dims);
    return g;
  }
};

/// A camera as its numbers. Rays are made from them directly: see ray().
struct View
{
  glm::dvec3 centre{ 0.0 }; ///< what it looks at
  glm::dvec3 forward{ 0.0, 0.0, -1.0 };
  glm::dvec3 up{ 0.0, 1.0, 0.0 };
  double distance = 1.0;    ///< from the eye to the centre
  double half_height = 1.0; ///< at the centre
  bool parallel = false;
  double near_plane = 0.1;
  double far_plane = 10.0;

  glm::dvec3 right() const { return glm::normalize(glm::cross(forward, up)); }
  glm::dvec3 true_up() const { return glm::cross(right(), glm::normalize(forward)); }

  Camera camera(double aspect) const
  {
    const glm::dvec3 f = glm::normalize(forward);
    const glm::dmat4 view = glm::lookAt(centre - f * distance, centre, up);
    const double h = half_height;
    const double n = near_plane;
    const glm::dmat4 projection = parallel
      ? glm::ortho(-h * aspect, h * aspect, -h, h, near_plane, far_plane)
      : glm::frustum(-h * aspect * n / distance, h * aspect * n / distance, -h * n / distance,
          h * n / distance, near_plane, far_plane);
    Camera c;
    c.clip_from_world = projection * view;
    c.direction = f;
    return c;
  }

  /// A pixel's ray, relative to `centre`, in long double: begin on the near plane, end on the far.
  void ray(int x, int y, int width, int height, long double begin[3], long double end[3]) const
  {
    const long double sx = ((2.0L * x + 1.0L) / width - 1.0L) * half_height * width / height;
    const long double sy = ((2.0L * y + 1.0L) / height - 1.0L) * half_height;
    const glm::dvec3 f = glm::normalize(forward);
    const glm::dvec3 r = right();
    const glm::dvec3 u = true_up();
    for (int axis = 0; axis < 3; ++axis)
    {
      const long double side = sx * r[axis] + sy * u[axis];
      const auto at = [&](long double depth)
      { return f[axis] * (depth - distance) + side * (parallel ? 1.0L : depth / distance); };
      begin[axis] = at(near_plane);
      end[axis] = at(far_plane);
    }
  }
};

/// Looks along `forward` at the grid of a scene whose data_from_index is a scale and a shift, from
/// outside it; fits the picture and the clipping planes to it.
inline View view_of(const Scene& scene, const glm::dvec3& forward, bool parallel)
{
  glm::dvec3 lower, upper;
  for (int axis = 0; axis < 3; ++axis)
  {
    lower[axis] = scene.volumes[0].grid.lower(axis);
    upper[axis] = scene.volumes[0].grid.upper(axis);
  }
  const glm::dmat4 world_from_index =
    scene.volumes[0].world_from_data * scene.volumes[0].data_from_index;
  View view;
  view.centre = glm::dvec3(world_from_index * glm::dvec4(0.5 * (lower + upper), 1.0));
  view.forward = glm::normalize(forward);
  if (std::abs(view.forward.y) > 0.9)
  {
    view.up = glm::dvec3(0.0, 0.0, 1.0);
  }
  const double radius =
    0.5 * glm::length(glm::dmat3(world_from_index) * (upper - lower));
  view.parallel = parallel;
  view.distance = 3.0 * radius;
  view.half_height = 0.8 * radius;
  view.near_plane = 1.5 * radius;
  view.far_plane = 4.5 * radius;
  return view;
}

inline glm::dmat4 placed(const glm::dvec3& spacing, const glm::dvec3& origin)
{
  return glm::scale(glm::translate(glm::dmat4(1.0), origin), spacing);
}

/// A table of `nodes` nodes over [lower, upper]: opacity(v) and colour(v)[3].
template <class Opacity, class Colour>
Classification classify(
  double lower, double upper, Opacity opacity, Colour colour, int nodes = 65537)
{
  Classification c;
  c.lower = lower;
  c.upper = upper;
  for (int i = 0; i < nodes; ++i)
  {
    const double v = lower + (upper - lower) * i / (nodes - 1);
    c.opacity.push_back(opacity(v));
    const glm::dvec3 rgb = colour(v);
    c.rgb.insert(c.rgb.end(), { rgb.x, rgb.y, rgb.z });
  }
  return c;
}

/// One picture of a fresh marcher.
inline Film march(const Scene& scene, int width, int height, double step, double leave_error = 0.0,
  int threads = 0, MarchStatistics* statistics = nullptr)
{
  Film film(width, height);
  Marcher marcher;
  MarchSettings settings;
  settings.step = step;
  settings.leave_error = leave_error;
  settings.threads = threads;
  const MarchStatistics s = marcher.render(scene, settings, film);
  if (statistics)
  {
    *statistics = s;
  }
  return film;
}

/// The largest difference of radiance and transmittance between two films.
inline double difference(const Film& a, const Film& b)
{
  double most = 0.0;
  for (int c = 0; c < 3; ++c)
  {
    for (std::size_t i = 0; i < a.size(); ++i)
    {
      const double d = std::max(std::abs(double(a.radiance[c][i]) - b.radiance[c][i]),
        std::abs(double(a.transmittance[c][i]) - b.transmittance[c][i]));
      most = d <= most ? most : d; // a NaN wins
    }
  }
  return most;
}

inline bool same_bits(const Film& a, const Film& b)
{
  const auto same = [](const std::vector<float>& x, const std::vector<float>& y)
  {
    return x.size() == y.size() &&
      std::equal(reinterpret_cast<const char*>(x.data()),
        reinterpret_cast<const char*>(x.data() + x.size()),
        reinterpret_cast<const char*>(y.data()));
  };
  bool all = same(a.depth, b.depth) && same(a.error, b.error);
  for (int c = 0; c < 3; ++c)
  {
    all = all && same(a.radiance[c], b.radiance[c]) && same(a.transmittance[c], b.transmittance[c]);
  }
  return all;
}

inline bool all_finite(const Film& film)
{
  for (int c = 0; c < 3; ++c)
  {
    for (std::size_t i = 0; i < film.size(); ++i)
    {
      if (!std::isfinite(film.radiance[c][i]) || !std::isfinite(film.transmittance[c][i]))
      {
        return false;
      }
    }
  }
  return true;
}

/// The SIMD targets of this machine, best first.
inline std::vector<std::string> targets()
{
  std::vector<std::string> names;
  std::string name;
  for (char c : simd_targets() + ' ')
  {
    if (c == ' ')
    {
      names.push_back(name);
      name.clear();
    }
    else
    {
      name += c;
    }
  }
  return names;
}

}
