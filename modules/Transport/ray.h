// From pixels to stretches of rays inside a grid, in double precision.
#pragma once

#include "Transport/scene.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace brume
{

/// The part of a pixel's ray that lies inside the grid.
struct RaySegment
{
  glm::dvec3 begin{ 0.0 };   ///< index space
  glm::dvec3 end{ 0.0 };     ///< index space
  double length = 0.0;       ///< from begin to end, in the data's units; 0 for a miss
  double start_offset = 0.0; ///< from the near plane to begin, in the data's units
  double world_scale = 1.0;  ///< world units in one of the data's, along the ray
};

/// Makes the rays of one scene and one picture size.
class RayMaker
{
public:
  RayMaker(const Scene& scene, int width, int height)
    : Width(width)
    , Height(height)
    , DataFromIndex(scene.volumes[0].data_from_index)
    , WorldFromIndex(scene.volumes[0].world_from_data * scene.volumes[0].data_from_index)
  {
    // One matrix from index space to the clip cube: far origins cancel here, in double precision,
    // rather than in every ray.
    const glm::dmat4 clip_from_index =
      scene.camera.clip_from_world * scene.volumes[0].world_from_data * scene.volumes[0].data_from_index;
    this->IndexFromClip = glm::inverse(clip_from_index);
    for (int axis = 0; axis < 3; ++axis)
    {
      this->Lower[axis] = scene.volumes[0].grid.lower(axis);
      this->Upper[axis] = scene.volumes[0].grid.upper(axis);
    }
    this->SurfaceDepth = scene.surface_depth.empty() ? nullptr : scene.surface_depth.data();
  }

  /// The stretch of the ray through the centre of pixel (x, y), y from the bottom.
  RaySegment segment(int x, int y) const
  {
    const double ndc_x = (2.0 * x + 1.0) / this->Width - 1.0;
    const double ndc_y = (2.0 * y + 1.0) / this->Height - 1.0;
    double ndc_far = 1.0;
    if (this->SurfaceDepth)
    {
      ndc_far = std::min(
        ndc_far, double(this->SurfaceDepth[static_cast<std::size_t>(y) * this->Width + x]));
    }
    const glm::dvec4 middle = this->IndexFromClip[0] * ndc_x + this->IndexFromClip[1] * ndc_y +
      this->IndexFromClip[3];
    const glm::dvec4 h_near = middle - this->IndexFromClip[2];
    const glm::dvec4 h_far = middle + this->IndexFromClip[2] * ndc_far;
    const glm::dvec3 from = glm::dvec3(h_near) / h_near.w;
    const glm::dvec3 to = glm::dvec3(h_far) / h_far.w;
    return this->clip(from, to);
  }

private:
  /// Cuts the stretch to the grid's box by slabs. A ray in or along a face counts as inside; no
  /// 0/0: an axis along which the ray does not move only asks whether it is within.
  RaySegment clip(const glm::dvec3& from, const glm::dvec3& to) const
  {
    RaySegment result;
    const glm::dvec3 d = to - from;
    double s0 = 0.0;
    double s1 = 1.0;
    for (int axis = 0; axis < 3; ++axis)
    {
      const double to_lower = this->Lower[axis] - from[axis];
      const double to_upper = this->Upper[axis] - from[axis];
      if (d[axis] == 0.0)
      {
        if (to_lower > 0.0 || to_upper < 0.0)
        {
          return result;
        }
        continue;
      }
      const double a = to_lower / d[axis];
      const double b = to_upper / d[axis];
      s0 = std::max(s0, std::min(a, b));
      s1 = std::min(s1, std::max(a, b));
    }
    if (!(s0 < s1))
    {
      return result;
    }
    result.begin = from + d * s0;
    result.end = from + d * s1;
    const double whole = glm::length(this->DataFromIndex * d);
    result.length = whole * (s1 - s0);
    result.start_offset = whole * s0;
    result.world_scale = glm::length(this->WorldFromIndex * d) / whole;
    if (!std::isfinite(result.length))
    {
      return RaySegment();
    }
    return result;
  }

  int Width;
  int Height;
  glm::dmat3 DataFromIndex;
  glm::dmat3 WorldFromIndex;
  glm::dmat4 IndexFromClip{ 1.0 };
  double Lower[3];
  double Upper[3];
  const float* SurfaceDepth = nullptr;
};

}
