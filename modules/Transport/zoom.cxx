#include "Transport/zoom.h"

#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

namespace brume
{

std::vector<glm::dvec3> corners_of_volumes(const Scene& scene, std::size_t volumes)
{
  std::vector<glm::dvec3> corners;
  for (std::size_t k = 0; k < volumes; ++k)
  {
    const Volume& volume = scene.volumes[k];
    const glm::dmat4 world_from_index = volume.world_from_data * volume.data_from_index;
    for (int corner = 0; corner < 8; ++corner)
    {
      glm::dvec4 place(0.0, 0.0, 0.0, 1.0);
      for (int axis = 0; axis < 3; ++axis)
      {
        place[axis] = (corner >> axis) & 1 ? volume.grid.upper(axis) : volume.grid.lower(axis);
      }
      corners.push_back(glm::dvec3(world_from_index * place));
    }
  }
  return corners;
}

glm::dmat4 zoomed_to_volumes(const Scene& scene, std::size_t volumes)
{
  glm::dvec2 lower(1e300);
  glm::dvec2 upper(-1e300);
  for (const glm::dvec3& corner : corners_of_volumes(scene, volumes))
  {
    const glm::dvec4 clip = scene.camera.clip_from_world * glm::dvec4(corner, 1.0);
    if (!(clip.w > 0.0))
    {
      return scene.camera.clip_from_world;
    }
    lower = glm::min(lower, glm::dvec2(clip) / clip.w);
    upper = glm::max(upper, glm::dvec2(clip) / clip.w);
  }
  if (!(lower.x < upper.x && lower.y < upper.y))
  {
    return scene.camera.clip_from_world;
  }
  const glm::dvec2 scale = 2.0 / (upper - lower);
  glm::dmat4 zoom(1.0);
  zoom[0][0] = scale.x;
  zoom[1][1] = scale.y;
  zoom[3][0] = -0.5 * (lower.x + upper.x) * scale.x;
  zoom[3][1] = -0.5 * (lower.y + upper.y) * scale.y;
  return zoom * scene.camera.clip_from_world;
}

}
