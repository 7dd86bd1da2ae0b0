#include "Transport/step_control.h"

#include "Transport/reference.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <vector>

namespace brume
{

double smallest_voxel_edge(const Scene& scene)
{
  double edge = glm::length(glm::dvec3(scene.data_from_index[0]));
  edge = std::min(edge, glm::length(glm::dvec3(scene.data_from_index[1])));
  return std::min(edge, glm::length(glm::dvec3(scene.data_from_index[2])));
}

StepChoice choose_step(const Scene& scene, int width, int height, double tolerance)
{
  // A coarse picture of the same view: its pixels' centres are spread evenly over the whole one.
  Scene probe = scene;
  probe.surface_depth.clear();
  const int probes_x = std::min(16, width);
  const int probes_y = std::min(16, height);

  // Rays end where what is behind cannot matter to the estimate.
  const double leave_below = std::min(0.01 * tolerance, 1e-4);
  StepChoice choice;
  choice.step = 2.0 * smallest_voxel_edge(scene);
  Film longer(probes_x, probes_y);
  Film shorter(probes_x, probes_y);
  render_fixed_step(probe, choice.step, SamplePlacement::Middle, leave_below, 0, longer);
  constexpr int halvings = 6;
  for (int i = 0;; ++i)
  {
    render_fixed_step(probe, 0.5 * choice.step, SamplePlacement::Middle, leave_below, 0, shorter);
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
