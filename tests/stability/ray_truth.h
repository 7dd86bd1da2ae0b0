// Single rays through matter whose optical depth has a closed form, however awkwardly they lie.
#pragma once

#include "../support/transport_scenes.h"

#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>

#include <cmath>
#include <memory>
#include <string>

namespace stability
{

using namespace transport_scenes;

constexpr double pi = 3.14159265358979323846;

/// A world whose clip cube's middle line runs from one place to another, for pictures of one pixel.
inline Camera camera_along(const glm::dvec3& from, const glm::dvec3& to)
{
  const glm::dvec3 along = to - from;
  const double length = glm::length(along);
  const glm::dvec3 forward = along / length;
  const glm::dvec3 helper =
    std::abs(forward.x) < 0.6 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 1.0, 0.0);
  const glm::dvec3 right = glm::normalize(glm::cross(forward, helper));
  const glm::dvec3 up = glm::cross(right, forward);
  glm::dmat4 world_from_clip(1.0);
  world_from_clip[0] = glm::dvec4(right * (0.5 * length), 0.0);
  world_from_clip[1] = glm::dvec4(up * (0.5 * length), 0.0);
  world_from_clip[2] = glm::dvec4(along * 0.5, 0.0);
  world_from_clip[3] = glm::dvec4(0.5 * (from + to), 1.0);
  Camera camera;
  camera.clip_from_world = glm::inverse(world_from_clip);
  camera.direction = forward;
  return camera;
}

/// Matter whose density runs evenly through index space, and one ray through it. Trilinear
/// interpolation keeps such a density, so that the optical depth of any chord is known.
struct RampRay
{
  glm::ivec3 dims{ 9, 7, 11 };
  bool cells = false; ///< voxels are cells; take a slope of 0 then, as the outer halves keep values
  double density = 1.0;      ///< at voxel (0, 0, 0)
  glm::dvec3 slope{ 0.0 };   ///< per voxel
  double extinction = 0.125; ///< per unit of the data's length and of density
  glm::dmat4 data_from_index{ 1.0 };
  glm::dmat4 world_from_data{ 1.0 };
  glm::dvec3 from{ 0.0 }; ///< index space: on the near plane
  glm::dvec3 to{ 0.0 };   ///< on the far plane
  /// The optical depth that shadow rays may count beside their own: where the light comes along a
  /// face, in single precision it may run in it. And light volumes, whose nodes are some way apart.
  double shade = 0.0;
  double shade_of_nodes = 0.0;
  double blur_of_nodes = 0.02; ///< of white: what their distance costs, a quarter of a voxel
  std::string name;            ///< of the variant, for messages

  double at(const glm::dvec3& place) const { return density + glm::dot(slope, place); }

  double lower() const { return cells ? -0.5 : 0.0; }
  double upper(int axis) const { return dims[axis] - (cells ? 0.5 : 1.0); }

  /// The part of the ray in the box, as fractions of its way; false for a miss.
  bool chord(double& begin, double& end) const
  {
    long double s0 = 0.0L;
    long double s1 = 1.0L;
    for (int axis = 0; axis < 3; ++axis)
    {
      const long double p = from[axis];
      const long double d = static_cast<long double>(to[axis]) - p;
      const long double l = lower() - p;
      const long double u = upper(axis) - p;
      if (d == 0.0L)
      {
        if (l > 0.0L || u < 0.0L)
        {
          return false;
        }
        continue;
      }
      s0 = std::max(s0, std::min(l / d, u / d));
      s1 = std::min(s1, std::max(l / d, u / d));
    }
    begin = static_cast<double>(s0);
    end = static_cast<double>(s1);
    return s0 < s1;
  }

  double optical_depth() const
  {
    double begin = 0.0;
    double end = 0.0;
    if (!chord(begin, end))
    {
      return 0.0;
    }
    const glm::dvec3 way = to - from;
    const double length = glm::length(glm::dmat3(data_from_index) * way) * (end - begin);
    return extinction * length * 0.5 * (at(from + way * begin) + at(from + way * end));
  }

  /// The largest density on the way.
  double largest() const
  {
    double begin = 0.0;
    double end = 0.0;
    chord(begin, end);
    const glm::dvec3 way = to - from;
    return std::max(at(from + way * begin), at(from + way * end));
  }

  /// Cells between voxel planes that the way passes, at the most.
  double crossings() const
  {
    double begin = 0.0;
    double end = 0.0;
    if (!chord(begin, end))
    {
      return 0.0;
    }
    const glm::dvec3 way = glm::abs((to - from) * (end - begin));
    return way.x + way.y + way.z + 4.0;
  }
};

/// The scene of a ramp; owns its voxels.
struct RampScene
{
  std::shared_ptr<Voxels<float>> voxels;
  Scene scene;

  explicit RampScene(const RampRay& ray)
  {
    const int padding = ray.dims.x < 2 ? 1 : 0;
    this->voxels = std::make_shared<Voxels<float>>(ray.dims.x + padding,
      ray.dims.y,
      ray.dims.z,
      [&](int i, int j, int k) { return ray.at(glm::dvec3(std::min(i, ray.dims.x - 1), j, k)); });
    Volume& volume = this->scene.volumes[0];
    volume.grid = this->voxels->grid();
    volume.grid.padding_x = padding;
    volume.grid.cell_centred = ray.cells;
    volume.data_from_index = ray.data_from_index;
    volume.world_from_data = ray.world_from_data;
    volume.meaning = ValueMeaning::Density;
    volume.density.extinction = ray.extinction;
    const glm::dmat4 world_from_index = ray.world_from_data * ray.data_from_index;
    this->scene.camera = camera_along(glm::dvec3(world_from_index * glm::dvec4(ray.from, 1.0)),
      glm::dvec3(world_from_index * glm::dvec4(ray.to, 1.0)));
  }
};

}
