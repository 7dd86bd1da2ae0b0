#include "refinement.h"

#include <glm/gtc/type_ptr.hpp>

#include <utility>

namespace brume
{

namespace
{

void add(std::vector<double>& numbers, const glm::dmat4& m)
{
  numbers.insert(numbers.end(), glm::value_ptr(m), glm::value_ptr(m) + 16);
}

std::vector<double> rest_of(const Scene& scene,
  const PathSettings& settings,
  int width,
  int height,
  vtkMTimeType modified)
{
  std::vector<double> rest{ static_cast<double>(width),
    static_cast<double>(height),
    static_cast<double>(modified),
    static_cast<double>(settings.most_scatterings),
    static_cast<double>(settings.seed),
    settings.step,
    static_cast<double>(scene.mixture),
    static_cast<double>(scene.volumes.size()),
    static_cast<double>(scene.lights.size()) };
  add(rest, scene.camera.clip_from_world);
  for (const Light& light : scene.lights)
  {
    rest.insert(rest.end(),
      { light.direction.x,
        light.direction.y,
        light.direction.z,
        light.position.x,
        light.position.y,
        light.position.z });
  }
  for (const Volume& volume : scene.volumes)
  {
    add(rest, volume.data_from_index);
    add(rest, volume.world_from_data);
    rest.push_back(volume.grid.linear);
    const Cropping& cropping = volume.cropping;
    rest.push_back(cropping.enabled);
    rest.push_back(cropping.regions);
    rest.insert(rest.end(), cropping.lower, cropping.lower + 3);
    rest.insert(rest.end(), cropping.upper, cropping.upper + 3);
    for (const glm::dvec4& plane : volume.clipping_planes)
    {
      rest.insert(rest.end(), { plane.x, plane.y, plane.z, plane.w });
    }
  }
  return rest;
}

}

bool Refinement::goes_on(const Scene& scene,
  const PathSettings& settings,
  int width,
  int height,
  vtkMTimeType modified)
{
  std::vector<double> rest = rest_of(scene, settings, width, height, modified);
  const bool same = this->Taken && this->Key.Holds(scene, {}) && this->Rest == rest &&
                    this->SurfaceDepth == scene.surface_depth &&
                    this->Environment == settings.environment;
  this->Taken = true;
  this->Key.Take(scene, {});
  this->Rest = std::move(rest);
  this->SurfaceDepth = scene.surface_depth;
  this->Environment = settings.environment;
  return same;
}

}
