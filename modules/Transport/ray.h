// From pixels to stretches of rays inside volumes, in double precision.
#pragma once

#include "Transport/scene.h"

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstdint>
#include <vector>

namespace brume
{

/// The part of a pixel's ray that lies inside a grid.
struct RaySegment
{
  glm::dvec3 begin{ 0.0 };   ///< index space
  glm::dvec3 end{ 0.0 };     ///< index space
  double length = 0.0;       ///< from begin to end, in the data's units; 0 for a miss
  double start_offset = 0.0; ///< from the near plane to begin, in the data's units
  double world_scale = 1.0;  ///< world units in one of the data's, along the ray
};

/// A stretch of a ray along which the same volumes are met, as fractions of the way from the near
/// plane (0) to the far plane or the surface that ends the ray (1).
struct RayStretch
{
  double begin = 0.0;
  double end = 0.0;
  std::uint32_t volumes =
    0; ///< bit k: inside Scene::volumes[k], what is cropped and clipped off it
};

/// The way of a pixel's ray in the index space of one volume.
struct RayWay
{
  glm::dvec3 begin{ 0.0 };
  glm::dvec3 way{ 0.0 };    ///< from the near plane to the end
  double length = 0.0;      ///< of the way, in the data's units
  double world_scale = 1.0; ///< world units in one of the data's, along the ray

  RaySegment part(double from, double to) const
  {
    return {
      begin + way * from, begin + way * to, length * (to - from), length * from, world_scale
    };
  }
};

/// Makes the rays of one scene and one picture size.
class RayMaker
{
public:
  /// Of no more than 32 volumes: throws std::invalid_argument.
  RayMaker(const Scene& scene, int width, int height);

  /// The way of the ray through the centre of pixel (x, y), y from the bottom, in a volume's index
  /// space.
  RayWay way(int x, int y, std::size_t volume = 0) const;

  /// The stretches of the ray that lie in volumes, front to back; none for a miss. `stretches` is
  /// emptied first.
  void stretches(int x, int y, std::vector<RayStretch>& stretches) const;

  /// The ray's part in the box of the first volume, whatever is cropped and clipped off it.
  RaySegment segment(int x, int y) const;

  /// Whether a ray has at most one stretch, which segment() gives.
  bool simple() const { return this->Simple; }

  /// What the rays of one volume are made from: for kernels that make many at once, as segment()
  /// does.
  struct Frame
  {
    const Volume* volume = nullptr;
    glm::dmat3 data_from_index;
    glm::dmat3 world_from_index;
    glm::dmat4 index_from_clip;
    double lower[3];
    double upper[3];
    std::vector<glm::dvec4> planes; ///< clipping planes in index space
  };
  const Frame& frame(std::size_t volume) const { return this->Frames[volume]; }
  int width() const { return this->Width; }
  int height() const { return this->Height; }
  /// Device depth of the nearest surface of each pixel; null for none.
  const float* surface_depth() const { return this->SurfaceDepth; }

private:
  /// Cuts [begin, end] to the box. Returns false for a miss.
  static bool clip_to_box(const Frame& frame, const RayWay& way, double& begin, double& end);
  static bool clip_to_planes(const Frame& frame, const RayWay& way, double& begin, double& end);
  /// Adds the parts of [begin, end] whose cropping region is drawn.
  static void add_regions(const Frame& frame,
    const RayWay& way,
    RayStretch whole,
    std::vector<RayStretch>& parts);

  int Width;
  int Height;
  bool Simple;
  std::vector<Frame> Frames;
  const float* SurfaceDepth = nullptr;
};

}
