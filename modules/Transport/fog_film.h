// Pictures of fog alone: no volumes, only what is behind it.
#pragma once

#include "Transport/film.h"
#include "Transport/fog.h"
#include "Transport/marcher.h"
#include "Transport/scene.h"

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

namespace brume
{

/// The rays of a picture as fog has them: fog has no near plane and no far plane. Perspective rays
/// begin in the eye, parallel ones on the near plane; all end at the surface that their pixel shows,
/// or nowhere.
class FogRays
{
public:
  FogRays(const Scene& scene, const FogModel& fog, int width, int height);

  /// The ray through the centre of pixel (x, y), y from the bottom.
  FogRay ray(int x, int y) const;
  /// Where the pixel's surface is (Scene::surface_depth), along its ray; +infinity where there is none
  /// (a depth of 1 or more, as a cleared depth buffer has it).
  double end(int x, int y, const FogRay& ray) const;
  /// Where the ray passes the near plane; 0 for parallel rays.
  double near_plane(int x, int y, const FogRay& ray) const;

private:
  glm::dvec4 unproject(int x, int y, double depth) const;

  const FogModel& Fog;
  const float* SurfaceDepth;
  int Width;
  int Height;
  glm::dmat4 WorldFromClip;
  bool Parallel;
  glm::dvec3 Eye{ 0.0 };
  double Spread = 0.0;
};

/// Fills the film with the scene's fog and nothing else: radiance, transmittance of each channel,
/// depth. Volumes are not looked at. Returns whether it was completed. Throws std::invalid_argument for
/// fog that cannot be drawn (see FogModel), or surface depths of another size than the film. The same
/// picture, bit for bit, for any number of threads (0: as many as the machine has processors).
bool render_fog(const Scene& scene, Film& film, int threads = 0, const Progress& progress = {});

}
