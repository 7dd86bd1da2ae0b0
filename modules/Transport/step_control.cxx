#include "Transport/step_control.h"

#include "Transport/reference.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <vector>

namespace brume
{

double smallest_voxel_edge(const Scene& scene)
{
  double edge = glm::length(glm::dvec3(scene.volumes[0].data_from_index[0]));
  edge = std::min(edge, glm::length(glm::dvec3(scene.volumes[0].data_from_index[1])));
  return std::min(edge, glm::length(glm::dvec3(scene.volumes[0].data_from_index[2])));
}

namespace
{

/// The same view, cut to the rectangle that the grid's box fills. The box of a camera inside it has
/// none: the whole view then.
glm::dmat4 zoomed_to_grid(const Scene& scene)
{
  const glm::dmat4 clip_from_index = scene.camera.clip_from_world *
                                     scene.volumes[0].world_from_data *
                                     scene.volumes[0].data_from_index;
  glm::dvec2 lower(1e300);
  glm::dvec2 upper(-1e300);
  for (int corner = 0; corner < 8; ++corner)
  {
    glm::dvec4 place(0.0, 0.0, 0.0, 1.0);
    for (int axis = 0; axis < 3; ++axis)
    {
      place[axis] = (corner >> axis) & 1 ? scene.volumes[0].grid.upper(axis)
                                         : scene.volumes[0].grid.lower(axis);
    }
    const glm::dvec4 clip = clip_from_index * place;
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

StepChoice choose_step(const Scene& scene, double tolerance, int threads)
{
  Scene probe = scene;
  probe.surface_depth.clear();
  probe.camera.clip_from_world = zoomed_to_grid(scene);
  constexpr int probes_x = 16;
  constexpr int probes_y = 16;

  // Rays end where what is behind cannot matter to the estimate.
  const double leave_below = std::min(0.01 * tolerance, 1e-4);
  StepChoice choice;
  choice.step = 2.0 * smallest_voxel_edge(scene);
  Film longer(probes_x, probes_y);
  Film shorter(probes_x, probes_y);
  render_fixed_step(probe, choice.step, SamplePlacement::Middle, leave_below, threads, longer);
  constexpr int halvings = 6;
  for (int i = 0;; ++i)
  {
    render_fixed_step(probe, 0.5 * choice.step, SamplePlacement::Middle, leave_below, threads, shorter);
    double change = 0.0;
    for (std::size_t pixel = 0; pixel < longer.size(); ++pixel)
    {
      for (int c = 0; c < 3; ++c)
      {
        change = std::max({ change,
          std::abs(double(longer.radiance[c][pixel]) - shorter.radiance[c][pixel]),
          std::abs(double(longer.transmittance[c][pixel]) - shorter.transmittance[c][pixel]) });
      }
    }
    choice.estimated_error = 4.0 / 3.0 * change;
    choice.met = choice.estimated_error <= tolerance;
    if (choice.met || i == halvings)
    {
      return choice;
    }
    choice.step *= 0.5;
    std::swap(longer, shorter);
  }
}

}
