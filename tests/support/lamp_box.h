// A box of even matter, and lamps in, at and beside it.
#pragma once

#include "lit_scenes.h"

#include <algorithm>

namespace lamp_box
{

using namespace lit_scenes;

constexpr int edge = 6; ///< pixels

inline const glm::dvec3 half(4.0, 3.0, 2.5);
inline const glm::dvec3 sigma(0.2, 0.1, 0.4);

struct Box
{
  Voxels<float> voxels{ 9, 7, 6, [](int, int, int) { return 1.0f; } };
  Scene scene;
  View view;

  Box()
  {
    Volume& volume = scene.volumes[0];
    volume.grid = voxels.grid();
    volume.data_from_index = placed(glm::dvec3(1.0), -half);
    volume.meaning = ValueMeaning::Density;
    volume.density.extinction = 0.4;
    volume.density.channels = sigma / 0.4;
    volume.medium.lit = true;
    volume.medium.albedo = { 0.8, 1.0, 0.9 };
    volume.medium.lobes = { { PhaseFunction::HenyeyGreenstein, 1.0, 0.4 } };
    view = view_of(scene, glm::dvec3(0.4, 0.3, -1.0), false);
    scene.camera = view.camera(1.0);
  }

  /// Elsewhere in the world, with its lamp.
  void move(const glm::dvec3& way)
  {
    scene.volumes[0].world_from_data = glm::translate(glm::dmat4(1.0), way);
    scene.lights[0].position += way;
    view.centre += way;
    scene.camera = view.camera(1.0);
  }
};

/// The stretch of a line p + t d inside the box.
inline void inside(const glm::dvec3& p, const glm::dvec3& d, double& from, double& to)
{
  from = -1e30;
  to = 1e30;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double a = (-half[axis] - p[axis]) / d[axis];
    const double b = (half[axis] - p[axis]) / d[axis];
    from = std::max(from, std::min(a, b));
    to = std::min(to, std::max(a, b));
  }
}

/// A place in the box on the ray of a pixel of a picture of edge² pixels.
inline glm::dvec3 place_on_a_ray(const Box& box)
{
  const WorldRay ray = world_ray(box.view, 2, 3, edge, edge);
  double from, to;
  inside(ray.begin, ray.direction, from, to);
  return ray.begin + (0.3 * from + 0.7 * to) * ray.direction;
}

/// A unit vector across that ray.
inline glm::dvec3 across_a_ray(const Box& box)
{
  const WorldRay ray = world_ray(box.view, 2, 3, edge, edge);
  return glm::normalize(glm::cross(ray.direction, glm::dvec3(0.3, 0.9, 0.1)));
}

inline Light lamp(const glm::dvec3& position, const glm::dvec3& attenuation)
{
  Light light;
  light.diffuse = { 1.0, 0.5, 2.0 };
  light.positional = true;
  light.position = position;
  light.attenuation = attenuation;
  return light;
}

inline Light spot(const glm::dvec3& position)
{
  Light light = lamp(position, { 0.0, 0.0, 1.0 });
  light.direction = glm::normalize(glm::dvec3(-0.2, 0.1, -1.0));
  light.cone_angle = 20.0;
  light.exponent = 4.0;
  return light;
}

inline const glm::dvec3 lamp_inside(0.31, -0.52, 0.73);
inline const glm::dvec3 lamp_outside(6.0, 5.0, 3.0);
inline const glm::dvec3 lamp_beside(-4.2, 0.3, 0.1);
inline const glm::dvec3 spots[2] = { { 0.3, -0.5, 2.0 }, { 1.0, 0.0, 7.0 } };
inline const glm::dvec3 attenuations[3] = { { 1.0, 0.0, 0.0 },
  { 0.0, 1.0, 0.0 },
  { 0.0, 0.0, 1.0 } };

}
