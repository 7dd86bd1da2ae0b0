#include "Transport/zoom.h"

#include "Transport/lookup_table.h"

#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

namespace brume
{

namespace
{

/// A box of a volume's index space.
struct IndexBox
{
  glm::dvec3 lower;
  glm::dvec3 upper;
};

IndexBox whole_box(const Volume& volume)
{
  IndexBox box;
  for (int axis = 0; axis < 3; ++axis)
  {
    box.lower[axis] = volume.grid.lower(axis);
    box.upper[axis] = volume.grid.upper(axis);
  }
  return box;
}

void add_corners(const Volume& volume, const IndexBox& box, std::vector<glm::dvec3>& corners)
{
  const glm::dmat4 world_from_index = volume.world_from_data * volume.data_from_index;
  for (int corner = 0; corner < 8; ++corner)
  {
    glm::dvec4 place(0.0, 0.0, 0.0, 1.0);
    for (int axis = 0; axis < 3; ++axis)
    {
      place[axis] = (corner >> axis) & 1 ? box.upper[axis] : box.lower[axis];
    }
    corners.push_back(glm::dvec3(world_from_index * place));
  }
}

/// The box around the bricks that can be seen; the whole one where that is not known, or where there
/// are none.
IndexBox visible_box(const Volume& volume)
{
  const IndexBox whole = whole_box(volume);
  const Classification& c = volume.classification;
  const bool density = volume.meaning == ValueMeaning::Density;
  if (!volume.ranges || volume.mask.labels || (!density && c.opacity.size() < 2))
  {
    return whole;
  }
  std::vector<bool> shows(2, true);
  double lower = 0.0;
  double upper = 1.0;
  if (!density)
  {
    lower = c.lower;
    upper = c.upper;
    shows.resize(c.opacity.size());
    for (std::size_t i = 0; i < shows.size(); ++i)
    {
      shows[i] = c.opacity[i] > 0.0;
    }
  }
  const VisibleValues values(lower, upper, shows);
  const BrickRanges& ranges = *volume.ranges;
  const double edge = ranges.edge();
  IndexBox box{ glm::dvec3(1e300), glm::dvec3(-1e300) };
  std::size_t index = 0;
  for (int z = 0; z < ranges.dims[2]; ++z)
  {
    for (int y = 0; y < ranges.dims[1]; ++y)
    {
      for (int x = 0; x < ranges.dims[0]; ++x, ++index)
      {
        const float least = ranges.minimum[index];
        const float most = ranges.maximum[index];
        if (density ? most > 0.0f : least <= most && values.any(least, most))
        {
          box.lower = glm::min(box.lower, glm::dvec3(x, y, z) * edge);
          box.upper = glm::max(box.upper, glm::dvec3(x + 1, y + 1, z + 1) * edge);
        }
      }
    }
  }
  if (box.lower.x > box.upper.x)
  {
    return whole;
  }
  return { glm::max(box.lower, whole.lower), glm::min(box.upper, whole.upper) };
}

glm::dmat4 zoomed_to(const Scene& scene, const std::vector<glm::dvec3>& corners);

}

std::vector<glm::dvec3> corners_of_volumes(const Scene& scene, std::size_t volumes)
{
  std::vector<glm::dvec3> corners;
  for (std::size_t k = 0; k < volumes; ++k)
  {
    add_corners(scene.volumes[k], whole_box(scene.volumes[k]), corners);
  }
  return corners;
}

glm::dmat4 zoomed_to_volumes(const Scene& scene, std::size_t volumes)
{
  return zoomed_to(scene, corners_of_volumes(scene, volumes));
}

glm::dmat4 zoomed_to_matter(const Scene& scene)
{
  std::vector<glm::dvec3> corners;
  for (const Volume& volume : scene.volumes)
  {
    add_corners(volume, visible_box(volume), corners);
  }
  return zoomed_to(scene, corners);
}

namespace
{

glm::dmat4 zoomed_to(const Scene& scene, const std::vector<glm::dvec3>& corners)
{
  glm::dvec2 lower(1e300);
  glm::dvec2 upper(-1e300);
  for (const glm::dvec3& corner : corners)
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

}
