// The rays of a camera, through volumes and fog, as paths begin on them. Internal to Transport.
#pragma once

#include "Transport/fog.h"
#include "Transport/fog_film.h"
#include "Transport/path_scene.h"
#include "Transport/reference_ray.h"

#include <optional>

namespace brume
{

class PathSights
{
public:
  /// Keeps a reference to the scene.
  PathSights(const Scene& scene, int width, int height);

  /// The ray through the centre of pixel (x, y), y from the bottom; false where there is nothing to
  /// be met.
  bool find(int x, int y, Sight& sight) const;

private:
  std::optional<ReferenceRays> Rays; ///< none without volumes
  std::optional<FogModel> Fog;
  std::optional<FogRays> FogWays;
};

}
