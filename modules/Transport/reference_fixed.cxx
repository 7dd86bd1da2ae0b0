// A fixed step's picture in double precision.
#include "Transport/reference.h"
#include "Transport/reference_film.h"
#include "Transport/reference_integrators.h"

#include <stdexcept>

namespace brume
{

namespace
{

/// A sample at s that stands for a stretch of `width`.
struct Sample
{
  double s;
  double width;
};

/// Calls take(part's index, sample) along parts in order, until it returns false.
template <class Part, class Take>
void for_each_sample(const std::vector<Part>& parts,
  double step,
  SamplePlacement placement,
  const Take& take)
{
  if (parts.empty())
  {
    return;
  }
  if (placement == SamplePlacement::Middle)
  {
    for (std::size_t p = 0; p < parts.size(); ++p)
    {
      const double length = parts[p].to - parts[p].from;
      const double count = std::max(1.0, std::ceil(length / step - 1e-6));
      for (double i = 0.0; i < count; ++i)
      {
        const double width = std::min(step, length - i * step);
        if (!take(p, Sample{ parts[p].from + i * step + 0.5 * width, width }))
        {
          return;
        }
      }
    }
    return;
  }
  const double first = parts.front().from;
  const double start =
    placement == SamplePlacement::FromNearPlane ? std::ceil(first / step) * step : first;
  const double near_enough = 1e-9 * step;
  std::size_t p = 0;
  for (double i = 0.0;; ++i)
  {
    const double s = start + i * step;
    while (p < parts.size() && s > parts[p].to + near_enough)
    {
      ++p;
    }
    if (p == parts.size())
    {
      return;
    }
    if (s >= parts[p].from - near_enough && !take(p, Sample{ s, step }))
    {
      return;
    }
  }
}

RayResult composite_fixed(const ReferenceScene& scene,
  const PixelRay& ray,
  double step,
  SamplePlacement placement,
  double leave_below)
{
  RayResult result;
  const std::vector<RayInterval> intervals = ray.intervals();
  std::vector<int> visible;
  for_each_sample(intervals,
    step,
    placement,
    [&](std::size_t interval, const Sample& sample)
    {
      visible.clear();
      for (int v : intervals[interval].volumes)
      {
        if (scene.media[v].visible(ray.volumes[v].place(sample.s)))
        {
          visible.push_back(v);
        }
      }
      pass_sample(scene, ray, visible.data(), visible.size(), sample.s, sample.width, result);
      return result.passes() >= leave_below;
    });
  return result;
}

/// What one volume makes of a projection: a colour and an opacity.
Tinted project_fixed(const ReferenceScene& scene,
  std::size_t v,
  const VolumeRay& ray,
  double step,
  SamplePlacement placement,
  RayResult& result)
{
  const ReferenceMedium& medium = scene.media[v];
  const Volume& volume = scene.scene.volumes[v];
  const BlendMode mode = scene.scene.blend_mode;
  const double sign = mode == BlendMode::MinimumIntensity ? -1.0 : 1.0;
  const double* black_white = volume.grey_range;
  const double span = black_white[1] - black_white[0];
  double best = -std::numeric_limits<double>::infinity();
  double best_s = 0.0;
  int best_label = -1;
  double sum = 0.0;
  double length = 0.0;
  for_each_sample(ray.parts,
    step,
    placement,
    [&](std::size_t, const Sample& sample)
    {
      const glm::dvec3 place = ray.place(sample.s);
      const int label = medium.label(place);
      if (label < 0)
      {
        return true;
      }
      ++result.samples;
      if (mode == BlendMode::MaximumIntensity || mode == BlendMode::MinimumIntensity)
      {
        const double value = sign * medium.value(place);
        if (value > best)
        {
          best = value;
          best_s = sample.s;
          best_label = label;
        }
        return true;
      }
      const double value = medium.grey_value(place);
      const double* range = scene.scene.average_range;
      if (mode == BlendMode::Additive || (value >= range[0] && value <= range[1]))
      {
        length += sample.width;
        sum += span > 0.0 ? medium.projected_opacity(label, place) * (value - black_white[0]) /
                              span * sample.width
                          : 0.0;
      }
      return true;
    });
  if (best_label >= 0)
  {
    return medium.projected(best_label, ray.place(best_s), sign * best);
  }
  if (!(length > 0.0))
  {
    return {};
  }
  return { 1.0,
    glm::dvec3(mode == BlendMode::AverageIntensity
                 ? sum / length
                 : sum * ray.length / volume.classification.unit_distance) };
}

RayResult fixed(const ReferenceScene& scene,
  const PixelRay& ray,
  double step,
  SamplePlacement placement,
  double leave_below)
{
  switch (scene.scene.blend_mode)
  {
    case BlendMode::Composite:
      return composite_fixed(scene, ray, step, placement, leave_below);
    case BlendMode::Isosurface:
    case BlendMode::Slice:
      return make_ray_integral(scene, ray)->integrate(1);
    default:
      break;
  }
  RayResult result;
  double opacity = 0.0;
  for (std::size_t v = 0; v < scene.media.size(); ++v)
  {
    const double weight = scene.scene.volumes[v].weight;
    const Tinted tinted = project_fixed(scene, v, ray.volumes[v], step, placement, result);
    result.radiance += tinted.colour * (tinted.opacity * weight);
    opacity += tinted.opacity * weight;
  }
  const bool grey = scene.scene.blend_mode == BlendMode::AverageIntensity ||
                    scene.scene.blend_mode == BlendMode::Additive;
  if (grey)
  {
    result.radiance = glm::clamp(result.radiance, 0.0, 1.0);
    opacity = opacity > 0.0 ? 1.0 : 0.0;
  }
  result.transmittance = glm::dvec3(std::max(0.0, 1.0 - opacity));
  return result;
}

}

bool render_fixed_step(const Scene& scene,
  double step,
  SamplePlacement placement,
  double leave_below,
  int threads,
  Film& film,
  const Progress& progress)
{
  if (!(step > 0.0) || !std::isfinite(step))
  {
    throw std::invalid_argument("the step must be a positive length");
  }
  scene.validate();
  const ReferenceScene prepared(scene);
  return for_each_ray(scene,
    film,
    threads,
    progress,
    [&](std::size_t pixel, const PixelRay& ray)
    {
      // The step is a length of the first volume's data.
      const double part = step / ray.volumes.front().length;
      store(film, pixel, ray, fixed(prepared, ray, part, placement, leave_below), 0.0);
    });
}

}
