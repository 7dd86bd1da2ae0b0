#include "Transport/step_control.h"

#include "Transport/zoom.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
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
constexpr double longest_lit = 1.0;
constexpr double shortest = 1.0 / 32.0;
/// Steps with which no voxel is stepped over: what longer ones find is held against theirs, too.
constexpr double surest = 1.0;
/// In lit scenes no other rule helps out where the midpoint rule is not enough: for the sharpest
/// tolerances its steps go on to be halved.
constexpr double shortest_lit = 1.0 / 128.0;
constexpr double sharpest_below = 1e-4;
/// Where a share of the pixels may be beyond the tolerance.
constexpr double shortest_of_share = 1.0 / 256.0;
/// The largest error of all pixels is larger than that of the rays that were looked at.
constexpr double unseen = 1.5;
/// The share of rays that settles the step of all, where the others can be refined.
constexpr double most_rays = 0.95;
/// What one sample of the rule costs, in samples of the midpoint rule, and how many samples the
/// crossing of a voxel takes cell by cell.
constexpr double cost_of_integrated = 1.6;
constexpr double samples_by_cells = 3.5;
/// Rays that have to meet something, of 64 × 64, and the longest step where fewer do, in voxel
/// edges.
constexpr int least_met = 32;
constexpr double step_of_specks = 0.25;
/// Shadows: rays along each side of the picture, for one light; how much larger the error of all
/// pixels is; the tolerances below which light volumes are of 32 bits, and are not made at all;
/// nodes of all light volumes that are swept in the time of a picture, and the most of one and of
/// all.
constexpr double shadow_probes = 20.0;
constexpr double unseen_shadows = 1.5;
constexpr double precise_below = 1e-3;
constexpr double least_of_volumes = 1e-4;
constexpr double nodes_of_a_picture = 4e6;
constexpr double nodes_at_most = 2e7;
constexpr double nodes_of_all_at_most = 1e8;
/// From here on rays through classified matter are not taken for what the best light volume misses
/// at its surfaces: a hundred times the time is more than so loose a tolerance is worth.
constexpr double rays_below = 9e-4;
constexpr double rounding_of_rays = 1e-5;
constexpr double shortest_of_shadows = 1.0 / 8.0; ///< voxel edges

bool is_lit(const Scene& scene)
{
  return scene.blend_mode == BlendMode::Composite &&
         std::any_of(scene.volumes.begin(),
           scene.volumes.end(),
           [](const Volume& v) { return v.medium.lit; });
}

/// A few rays of a scene, marched with one step after another.
class Probe
{
public:
  Probe(Marcher& marcher,
    const Scene& scene,
    double tolerance,
    int threads,
    const MarchSettings& base,
    int rays = probes)
    : TheMarcher(marcher)
    , TheScene(scene)
    , Edge(smallest_voxel_edge(scene))
    , Rays(rays)
    , Settings(base)
  {
    this->Settings.refinements = 0;
    this->Settings.jitter = false;
    this->TheScene.surface_depth.clear();
    this->TheScene.camera.clip_from_world = zoomed_to_matter(scene);
    this->Settings.threads = threads;
    // Rays end where what is behind cannot matter to the estimate.
    this->Settings.leave_error = std::min(0.01 * tolerance, 1e-4);
  }

  Film march(StepRule rule, double step)
  {
    Film film(this->Rays, this->Rays);
    this->Settings.rule = rule;
    this->Settings.step = step * this->Edge;
    this->TheMarcher.render(this->TheScene, this->Settings, film);
    if (this->White == 0.0)
    {
      this->White = is_lit(this->TheScene) ? std::max(brightest(film), 1.0) : 1.0;
    }
    return film;
  }

  MarchSettings& settings() { return this->Settings; }

  /// How many rays of a picture met something.
  static int met(const Film& film)
  {
    int count = 0;
    for (std::size_t pixel = 0; pixel < film.size(); ++pixel)
    {
      bool any = false;
      for (int c = 0; c < 3; ++c)
      {
        any = any || film.transmittance[c][pixel] < 1.0f || film.radiance[c][pixel] > 0.0f;
      }
      count += any;
    }
    return count;
  }

  /// For each pixel the largest change of a channel.
  std::vector<double> changes(const Film& a, const Film& b) const
  {
    std::vector<double> changes(a.size(), 0.0);
    for (std::size_t pixel = 0; pixel < a.size(); ++pixel)
    {
      for (int c = 0; c < 3; ++c)
      {
        changes[pixel] = std::max({ changes[pixel],
          std::abs(double(a.radiance[c][pixel]) - b.radiance[c][pixel]) / this->White,
          std::abs(double(a.transmittance[c][pixel]) - b.transmittance[c][pixel]) });
      }
    }
    return changes;
  }
  double change(const Film& a, const Film& b) const
  {
    const std::vector<double> all = this->changes(a, b);
    return *std::max_element(all.begin(), all.end());
  }

private:
  static double brightest(const Film& film)
  {
    float most = 0.0f;
    for (const std::vector<float>& channel : film.radiance)
    {
      most = std::max(most, *std::max_element(channel.begin(), channel.end()));
    }
    return most;
  }

  Marcher& TheMarcher;
  Scene TheScene;
  double Edge;
  int Rays;
  MarchSettings Settings;
  double White = 0.0;
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

/// Makes a step with the error `error` (at most the tolerance) as long as the tolerance allows,
/// where twice the step has the error `twice`.
void lengthen(double& step, double& error, double twice, double tolerance)
{
  const double power = std::max(std::log2(twice / std::max(error, 1e-12)), 1.0);
  const double room = tolerance / std::max(error, 0.125 * tolerance);
  const double factor = std::clamp(std::pow(room, 1.0 / power), 1.0, 1.999);
  step *= factor;
  error = std::min(error * std::pow(factor, power), tolerance);
}

}

ShadowChoice choose_shadows(Marcher& marcher, const Scene& scene, double tolerance, int threads)
{
  ShadowChoice choice;
  if (!is_lit(scene) || scene.lights.empty())
  {
    return choice;
  }
  const double edge = smallest_voxel_edge(scene);
  // Rays toward many lights are dear: fewer of them then.
  const double lights = static_cast<double>(scene.lights.size());
  const int rays = std::max(6, static_cast<int>(shadow_probes / std::sqrt(lights)));
  MarchSettings base;
  base.precise_shadows = tolerance < precise_below;
  Probe probe(marcher, scene, tolerance, threads, base, rays);
  const auto with = [&](ShadowMethod method, double step)
  {
    probe.settings().shadows = method;
    probe.settings().shadow_step = step;
    return probe.march(StepRule::Midpoint, 1.0);
  };
  // Cell by cell where rays can, else by steps half as long as those of light volumes.
  const bool exact = has_exact_shadow_rays(scene);
  const Film truth = with(ShadowMethod::Rays, exact ? 0.0 : 0.5 * edge);
  double nodes = 0.0;
  for (const Volume& volume : scene.volumes)
  {
    double cells = 1.0;
    for (int axis = 0; axis < 3; ++axis)
    {
      cells *= std::max(1.0, volume.grid.upper(axis) - volume.grid.lower(axis)) *
               glm::length(glm::dvec3(volume.data_from_index[axis])) / edge;
    }
    nodes += cells;
  }
  double spacing = std::cbrt(nodes * lights / nodes_of_a_picture);
  spacing = std::max(std::exp2(std::ceil(2.0 * std::log2(spacing)) / 2.0), 0.25);
  const bool volumes = tolerance >= least_of_volumes;
  const auto affordable = [&]
  {
    const double of_one = nodes / (spacing * spacing * spacing);
    return of_one < nodes_at_most && of_one * lights < nodes_of_all_at_most;
  };
  for (bool first = true; volumes && (first || affordable()); spacing *= 0.5, first = false)
  {
    const double error =
      unseen_shadows * probe.change(with(ShadowMethod::Volume, spacing * edge), truth);
    if (first || error < choice.estimated_error)
    {
      choice.method = ShadowMethod::Volume;
      choice.step = spacing * edge;
      choice.precise = base.precise_shadows;
      choice.estimated_error = error;
      choice.met = error <= tolerance;
    }
    if (choice.met)
    {
      return choice;
    }
    if (spacing <= 0.25)
    {
      break;
    }
  }
  if (!exact && tolerance >= rays_below)
  {
    return choice;
  }
  choice.method = ShadowMethod::Rays;
  choice.met = true;
  choice.precise = true; // the sky's light
  if (exact)
  {
    choice.step = 0.0;
    choice.estimated_error = rounding_of_rays;
    return choice;
  }
  Film longer = with(ShadowMethod::Rays, edge);
  for (choice.step = edge;; choice.step *= 0.5)
  {
    Film shorter = with(ShadowMethod::Rays, 0.5 * choice.step);
    choice.estimated_error = 4.0 / 3.0 * unseen_shadows * probe.change(longer, shorter);
    choice.met = choice.estimated_error <= tolerance;
    if (choice.met || choice.step <= shortest_of_shadows * edge)
    {
      return choice;
    }
    longer = std::move(shorter);
  }
}

int credible_count(int count, double share)
{
  constexpr double doubt = 0.1;
  double chance = std::pow(1.0 - share, count); // of exactly `k`
  double sum = chance;
  int k = 0;
  for (; k < count && sum <= doubt; ++k)
  {
    chance *= share / (1.0 - share) * (count - k) / (k + 1.0);
    sum += chance;
  }
  return k - 1;
}

StepChoice choose_step(Marcher& marcher,
  const Scene& scene,
  double tolerance,
  int threads,
  const MarchSettings& base,
  double beyond,
  int edge)
{
  // Shadow rays would be dear here, and what bends in a light volume bends for them.
  MarchSettings cheap = base;
  if (base.shadows == ShadowMethod::Rays)
  {
    cheap.shadows = ShadowMethod::Volume;
    cheap.shadow_step = 0.0;
    cheap.precise_shadows = true;
  }
  Probe probe(marcher, scene, tolerance, threads, cheap, edge);
  StepChoice choice;
  // In voxel edges. Light from one side bends where matter alone does not.
  const bool lit = is_lit(scene);
  const double least = beyond > 0.0                        ? shortest_of_share
                       : lit && tolerance < sharpest_below ? shortest_lit
                                                           : shortest;
  const int passed_over = std::max(beyond > 0.0 ? credible_count(edge * edge, beyond) : 0, 0);
  const double margin = beyond > 0.0 ? 1.0 : unseen;
  // The largest that counts.
  const auto counting = [passed_over](std::vector<double> errors)
  {
    std::nth_element(errors.begin(), errors.begin() + passed_over, errors.end(), std::greater<>());
    return errors[static_cast<std::size_t>(passed_over)];
  };
  Film control;
  const auto error_by_control = [&](const Film& film)
  {
    if (control.size() == 0)
    {
      control = probe.march(StepRule::Midpoint, surest);
    }
    return margin * counting(probe.changes(film, control));
  };
  double last_change = 0.0; // by the halving before
  double falls = 4.0;       // by which changes fall from one halving to the next
  double step = lit ? longest_lit : longest;
  Film longer = probe.march(StepRule::Midpoint, step);
  Film shorter;
  std::vector<Film> before;   // those with longer steps, the longest first
  double step_of_most = 0.0;  // with which most rays are within the tolerance
  double scale_of_most = 0.0; // of their estimates
  for (;;)
  {
    shorter = probe.march(StepRule::Midpoint, 0.5 * step);
    std::vector<double> errors = probe.changes(longer, shorter);
    const double change = counting(errors);
    if (beyond > 0.0 && last_change > 0.0 && change > 0.0)
    {
      falls = std::clamp(last_change / change, 1.5, 4.0);
    }
    const double rest = falls / (falls - 1.0); // all halvings to come, by this one
    last_change = change;
    for (double& error : errors)
    {
      error *= rest;
    }
    choice.estimated_error = margin * rest * change;
    if (step_of_most == 0.0 && quantile(errors, most_rays) <= tolerance)
    {
      step_of_most = step;
      scale_of_most = scale_of_estimates(longer, errors, tolerance);
    }
    choice.met = choice.estimated_error <= tolerance;
    if (choice.met && step > surest)
    {
      // Both may have missed the same voxel.
      const double error = error_by_control(longer);
      choice.estimated_error = std::max(choice.estimated_error, error);
      choice.met = error <= tolerance;
    }
    if (choice.met || step <= least)
    {
      break;
    }
    step *= 0.5;
    if (beyond > 0.0)
    {
      before.push_back(std::move(longer));
    }
    longer = std::move(shorter);
  }
  // Specks that hardly any ray met tell nothing of longer steps, and leave little to march through.
  const bool specks =
    step > step_of_specks && probe.met(shorter) < least_met * edge * edge / (probes * probes);
  if (specks)
  {
    step = step_of_specks;
    longer = probe.march(StepRule::Midpoint, step);
    for (;; step *= 0.5)
    {
      shorter = probe.march(StepRule::Midpoint, 0.5 * step);
      choice.estimated_error = margin * 4.0 / 3.0 * counting(probe.changes(longer, shorter));
      choice.met = choice.estimated_error <= tolerance;
      if (choice.met || step <= least)
      {
        break;
      }
      std::swap(longer, shorter);
    }
  }
  // Not even the shortest steps do for all rays of some lit scenes: those few are refined as far.
  if (!specks && (choice.met || lit) && scene.blend_mode == BlendMode::Composite &&
      step_of_most >= 4.0 * step && scale_of_most > 0.0)
  {
    choice.step = step_of_most * smallest_voxel_edge(scene);
    choice.refinements = static_cast<int>(std::lround(std::log2(step_of_most / step)));
    choice.refine_error = tolerance / scale_of_most;
    choice.estimated_error = std::max(tolerance, choice.met ? 0.0 : choice.estimated_error);
    return choice;
  }
  if (!specks && choice.met && beyond > 0.0)
  {
    // Longer ones again, by themselves against the finest picture at hand: what they miss is far
    // less than what a halving's change makes one expect across sharp surfaces.
    double all = falls; // by which errors fall from this step to the finest
    for (; !before.empty(); before.pop_back())
    {
      all *= falls;
      const double error =
        std::max(all / (all - 1.0) * counting(probe.changes(before.back(), shorter)),
          2.0 * step > surest ? error_by_control(before.back()) : 0.0);
      if (error > tolerance)
      {
        lengthen(step, choice.estimated_error, error, tolerance);
        break;
      }
      step *= 2.0;
      choice.estimated_error = error;
    }
  }
  else if (!specks && choice.met && step < (lit ? longest_lit : longest))
  {
    // Twice the step would be too long; some of it is not. Toward longer steps the error may grow
    // faster than with the square: the cube is on the safe side.
    double longest_step = step;
    double error = choice.estimated_error;
    lengthen(longest_step, error, 8.0 * error, tolerance);
    if (longest_step <= surest ||
        error_by_control(probe.march(StepRule::Midpoint, longest_step)) <= tolerance)
    {
      step = longest_step;
      choice.estimated_error = error;
    }
  }
  // `shorter` is the finest picture at hand: what another rule makes of a longer step is measured
  // against it.
  if (!specks && follows_rule(scene, StepRule::Integrated) && step < 0.5 * longest)
  {
    const auto error_of = [&](double length) {
      return margin * counting(probe.changes(probe.march(StepRule::Integrated, length), shorter));
    };
    double other = cost_of_integrated * step;
    double error = error_of(other);
    if (error < choice.estimated_error && (error <= tolerance || !choice.met))
    {
      while (beyond > 0.0 && 2.0 * other <= longest)
      {
        const double twice = error_of(2.0 * other);
        if (twice > tolerance)
        {
          lengthen(other, error, twice, tolerance);
          break;
        }
        other *= 2.0;
        error = twice;
      }
      choice.rule = StepRule::Integrated;
      choice.estimated_error = error;
      step = other;
    }
  }
  if (follows_rule(scene, StepRule::Cells) && (specks || step < 1.0 / samples_by_cells))
  {
    // Exact but where interpolation passes from below 0, which counts as 0, to above.
    const auto& ranges = scene.volumes[0].ranges;
    const bool bends = !ranges || ranges->lower < 0.0f;
    const double error =
      bends ? margin * counting(probe.changes(probe.march(StepRule::Cells, 1.0), shorter)) : 1e-5;
    if (!bends || error <= tolerance)
    {
      choice.rule = StepRule::Cells;
      choice.estimated_error = error;
      step = 1.0;
    }
  }
  choice.met = choice.estimated_error <= tolerance;
  choice.step = step * smallest_voxel_edge(scene);
  return choice;
}
}
