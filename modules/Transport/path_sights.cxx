#include "Transport/path_sights.h"

namespace brume
{

PathSights::PathSights(const Scene& scene, int width, int height)
{
  if (!scene.volumes.empty())
  {
    this->Rays.emplace(scene, width, height);
  }
  if (has_fog(scene))
  {
    this->Fog.emplace(scene);
    this->FogWays.emplace(scene, *this->Fog, width, height);
  }
}

bool PathSights::find(int x, int y, Sight& sight) const
{
  bool meets = false;
  sight = Sight();
  sight.length = 0.0;
  if (this->Rays)
  {
    const PixelRay ray = this->Rays->ray(x, y);
    if (ray.world_length > 0.0)
    {
      meets = !ray.empty();
      sight.begin = ray.world_begin;
      sight.along = ray.world_along / ray.world_length;
      sight.length = meets ? ray.world_length : 0.0;
    }
  }
  if (this->FogWays)
  {
    const FogRay ray = this->FogWays->ray(x, y);
    const double near_plane = this->FogWays->near_plane(x, y, ray);
    sight.along = ray.direction;
    sight.begin = ray.origin + near_plane * ray.direction;
    sight.fog_before = near_plane;
    sight.fog_length = this->FogWays->end(x, y, ray) - near_plane;
    meets |= sight.fog_length > -near_plane;
  }
  return meets;
}

}
