#include "Transport/step_control.h"

#include "Transport/zoom.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace brume
{

double smallest_voxel_edge(const Scene& scene)
{
  double edge = std::numeric_limits<double>::infinity();
  for (const Volume& volume : scene.volumes)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      edge = std::min(edge, glm::length(glm::dvec3(volume.data_from_index[axis])));
    }
  }
  return edge;
}

namespace
{

constexpr int probes = 64; ///< along each side of the picture
constexpr double longest = 4.0;
constexpr double shortest = 1.0 / 32.0;
/// The largest error of all pixels is larger than that of the rays that were looked at.
constexpr double unseen = 1.5;
/// The share of rays that settles the step of all, where the others can be refined.
constexpr double most_rays = 0.95;
/// What one sample of the rule costs, in samples of the midpoint rule, and how many samples the
/// crossing of a voxel takes cell by cell.
constexpr double cost_of_integrated = 1.6;
constexpr double samples_by_cells = 3.5;

/// A few rays of a scene, marched with one step after another.
class Probe
{
public:
  Probe(Marcher& marcher, const Scene& scene, double tolerance, int threads)
    : TheMarcher(marcher)
    , TheScene(scene)
    , Edge(smallest_voxel_edge(scene))
  {
    this->TheScene.surface_depth.clear();
    this->TheScene.camera.clip_from_world = zoomed_to_volumes(scene, 1);
    this->Settings.threads = threads;
    // Rays end where what is behind cannot matter to the estimate.
    this->Settings.leave_error = std::min(0.01 * tolerance, 1e-4);
  }

  Film march(StepRule rule, double step)
  {
    Film film(probes, probes);
    this->Settings.rule = rule;
    this->Settings.step = step * this->Edge;
    this->TheMarcher.render(this->TheScene, this->Settings, film);
    return film;
  }

  /// For each pixel the largest change of a channel.
  static std::vector<double> changes(const Film& a, const Film& b)
  {
    std::vector<double> changes(a.size(), 0.0);
    for (std::size_t pixel = 0; pixel < a.size(); ++pixel)
    {
      for (int c = 0; c < 3; ++c)
      {
        changes[pixel] = std::max({ changes[pixel],
          std::abs(double(a.radiance[c][pixel]) - b.radiance[c][pixel]),
          std::abs(double(a.transmittance[c][pixel]) - b.transmittance[c][pixel]) });
      }
    }
    return changes;
  }
  static double change(const Film& a, const Film& b)
  {
    const std::vector<double> all = changes(a, b);
    return *std::max_element(all.begin(), all.end());
  }

private:
  Marcher& TheMarcher;
  Scene TheScene;
  double Edge;
  MarchSettings Settings;
};

}

namespace
{

/// The value below which `share` of those that are not 0 lie.
double quantile(std::vector<double> values, double share)
{
  values.erase(std::remove(values.begin(), values.end(), 0.0), values.end());
  if (values.empty())
  {
    return 0.0;
  }
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * (values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// How many times its estimate the error of a pixel is, for nearly all pixels whose error matters.
double scale_of_estimates(const Film& film, const std::vector<double>& errors, double tolerance)
{
  std::vector<double> ratios;
  for (std::size_t pixel = 0; pixel < film.size(); ++pixel)
  {
    if (errors[pixel] > 0.25 * tolerance)
    {
      ratios.push_back(errors[pixel] / std::max(double(film.error[pixel]), 1e-6));
    }
  }
  return quantile(ratios, 0.95);
}

}

StepChoice choose_step(Marcher& marcher, const Scene& scene, double tolerance, int threads)
{
  Probe probe(marcher, scene, tolerance, threads);
  StepChoice choice;
  double step = longest; // in voxel edges
  Film longer = probe.march(StepRule::Midpoint, step);
  Film shorter;
  double step_of_most = 0.0;  // with which most rays are within the tolerance
  double scale_of_most = 0.0; // of their estimates
  for (;;)
  {
    shorter = probe.march(StepRule::Midpoint, 0.5 * step);
    std::vector<double> errors = Probe::changes(longer, shorter);
    for (double& error : errors)
    {
      error *= 4.0 / 3.0;
    }
    choice.estimated_error = unseen * *std::max_element(errors.begin(), errors.end());
    if (step_of_most == 0.0 && quantile(errors, most_rays) <= tolerance)
    {
      step_of_most = step;
      scale_of_most = scale_of_estimates(longer, errors, tolerance);
    }
    choice.met = choice.estimated_error <= tolerance;
    if (choice.met || step <= shortest)
    {
      break;
    }
    step *= 0.5;
    std::swap(longer, shorter);
  }
  if (choice.met && scene.blend_mode == BlendMode::Composite && step_of_most >= 4.0 * step &&
    scale_of_most > 0.0)
  {
    choice.step = step_of_most * smallest_voxel_edge(scene);
    choice.refinements = static_cast<int>(std::lround(std::log2(step_of_most / step)));
    choice.refine_error = tolerance / scale_of_most;
    choice.estimated_error = tolerance;
    return choice;
  }
  if (choice.met && step < longest)
  {
    // Twice the step would be too long; some of it is not. Toward longer steps the error may grow
    // faster than with the square: the cube is on the safe side.
    const double room = tolerance / std::max(choice.estimated_error, 0.125 * tolerance);
    const double factor = std::min(std::cbrt(room), 1.999);
    step *= factor;
    choice.estimated_error =
      std::min(choice.estimated_error * factor * factor * factor, tolerance);
  }
  // `shorter` is the finest picture at hand: what another rule makes of a longer step is measured
  // against it.
  if (follows_rule(scene, StepRule::Integrated) && step < 0.5 * longest)
  {
    const double other = cost_of_integrated * step;
    const double error =
      unseen * Probe::change(probe.march(StepRule::Integrated, other), shorter);
    if (error < choice.estimated_error && (error <= tolerance || !choice.met))
    {
      choice.rule = StepRule::Integrated;
      choice.estimated_error = error;
      step = other;
    }
  }
  if (follows_rule(scene, StepRule::Cells) && step < 1.0 / samples_by_cells)
  {
    choice.rule = StepRule::Cells;
    choice.estimated_error = 1e-5; // rounding
    step = 1.0;
  }
  choice.met = choice.estimated_error <= tolerance;
  choice.step = step * smallest_voxel_edge(scene);
  return choice;
}

}
