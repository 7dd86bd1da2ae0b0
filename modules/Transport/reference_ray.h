// From a pixel to the parts of its ray that each volume draws, in double precision. Internal to
// Transport. Places on a ray have numbers s: 0 on the near plane, 1 on the far plane or the nearest
// opaque surface, the same for all volumes.
#pragma once

#include "Transport/fog_film.h"
#include "Transport/scene.h"

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <memory>
#include <vector>

namespace brume
{

/// A stretch [from, to] of a ray, from < to.
struct RayPart
{
  double from;
  double to;
};

/// A ray as one volume has it.
struct VolumeRay
{
  glm::dvec3 begin{ 0.0 };    ///< index space, s = 0
  glm::dvec3 along{ 0.0 };    ///< index space, from s = 0 to s = 1
  double length = 0.0;        ///< from s = 0 to s = 1, in the data's units
  std::vector<RayPart> parts; ///< what the volume draws, in order, apart from one another

  glm::dvec3 place(double s) const { return begin + along * s; }
};

/// A stretch of a ray in which the same volumes are drawn.
struct RayInterval
{
  double from;
  double to;
  std::vector<int> volumes;
};

struct PixelRay
{
  std::vector<VolumeRay> volumes; ///< as many as the scene's
  double world_length = 0.0;      ///< from s = 0 to s = 1
  glm::dvec3 world_begin{ 0.0 };
  glm::dvec3 world_along{ 0.0 };
  /// The same ray as the scene's fog has it, and where s = 0 and the fog's end are on it.
  FogRay fog;
  double fog_near_plane = 0.0;
  double fog_end = 0.0;

  glm::dvec3 world_place(double s) const { return world_begin + world_along * s; }
  bool empty() const;
  /// Cut wherever a volume begins or ends; in order, without the stretches in which nothing is
  /// drawn.
  std::vector<RayInterval> intervals() const;
};

/// A volume's place, as rays need it.
struct RayFrame
{
  RayFrame(const Volume& volume, const glm::dmat4& clip_from_world);
  /// Fills in ray.parts: the volume's box, its clipping planes, its cropping.
  void find_parts(VolumeRay& ray) const;

  const Volume& volume;
  glm::dmat4 index_from_clip;
  glm::dmat4 index_from_world;
  glm::dmat3 data_from_index;
  glm::dmat4 world_from_index;
  std::vector<glm::dvec4> planes; ///< clipping planes in index space
};

/// Rays of a camera, and rays from anywhere to anywhere.
class ReferenceRays
{
public:
  /// For rays of no camera.
  explicit ReferenceRays(const Scene& scene);
  ReferenceRays(const Scene& scene, int width, int height);
  /// The ray through the centre of pixel (x, y), y from the bottom.
  PixelRay ray(int x, int y) const;
  /// The ray of the world from `begin` (s = 0) to `begin` + `along` (s = 1).
  PixelRay between(const glm::dvec3& begin, const glm::dvec3& along) const;
  /// The smallest sphere around the middle of the volumes' boxes that holds them all.
  const glm::dvec3& centre() const { return this->Centre; }
  double radius() const { return this->Radius; }

private:
  const Scene& TheScene;
  int Width;
  int Height;
  std::vector<RayFrame> Frames;
  glm::dvec3 Centre{ 0.0 };
  double Radius = 0.0;
  std::unique_ptr<FogModel> Fog; ///< null where there is none
  std::unique_ptr<FogRays> FogWays;
};

/// The places where a ray passes from one voxel cell to the next: cuts [from, to] into stretches in
/// which values are polynomials, and labels one.
class CellWalk
{
public:
  explicit CellWalk(const RayPart& part);
  void add(const VolumeRay& ray, const Volume& volume);
  /// The next stretch; false at the end. Always moves on.
  bool next(RayPart& stretch);

private:
  struct Cut
  {
    double begin;
    double along;
    double offset;
    double border;
    double next;
  };

  RayPart Part;
  double At;
  std::vector<Cut> Cuts;
};

}
