// A ball of density in the sun that shadows itself.
#pragma once

#include "../support/lit_scenes.h"

#include <algorithm>

/// Of `edge`³ voxels, densest in the middle.
struct SunlitBall
{
  lit_scenes::Voxels<float> voxels;
  brume::Scene scene;

  explicit SunlitBall(int edge)
    : voxels{ edge,
      edge,
      edge,
      [edge](int i, int j, int k)
      {
        const glm::dvec3 p = glm::dvec3(i, j, k) / (0.5 * (edge - 1)) - 1.0;
        return static_cast<float>(std::max(0.0, 1.0 - glm::dot(p, p)));
      } }
  {
    brume::Volume& volume = this->scene.volumes[0];
    volume.grid = this->voxels.grid();
    volume.meaning = brume::ValueMeaning::Density;
    volume.density.extinction = 0.4;
    volume.medium.lit = true;
    volume.data_revision = volume.medium_revision = 1;
    brume::Light sun;
    sun.diffuse = glm::dvec3(1.0);
    sun.direction = glm::normalize(glm::dvec3(-1.0, -1.0, 0.5));
    this->scene.lights.push_back(sun);
    this->scene.camera =
      lit_scenes::view_of(this->scene, glm::dvec3(0.3, -0.4, -1.0), false).camera(1.0);
  }
};
