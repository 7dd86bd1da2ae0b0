// Emission and absorption.
#include "Transport/optics.h"
#include "Transport/reference_integrators.h"

namespace brume
{

void pass_sample(const ReferenceScene& scene,
  const PixelRay& ray,
  const int* volumes,
  std::size_t count,
  double s,
  double width,
  RayResult& result)
{
  if (scene.lighting)
  {
    const Sent sent = scene.lighting->sent(ray, volumes, count, s, 1, result.samples);
    for (int c = 0; c < 3; ++c)
    {
      const double depth = sent.extinction[c] * width;
      const double opacity = opacity_from_optical_depth(depth);
      result.radiance[c] += result.transmittance[c] * sent.radiance[c] * width *
                            (depth > 0.0 ? opacity / depth : 1.0);
      result.transmittance[c] -= result.transmittance[c] * opacity;
    }
    result.passed(s);
    return;
  }
  double sum = 0.0; // optical depths for a way of 1 in s
  double squares = 0.0;
  glm::dvec3 light(0.0);
  for (std::size_t i = 0; i < count; ++i)
  {
    const int v = volumes[i];
    const VolumeRay& own = ray.volumes[v];
    const Optical optical = scene.media[v].at(own.place(s), own.along);
    const double depth = optical.extinction * scene.scene.volumes[v].weight * own.length;
    ++result.samples;
    if (depth > 0.0)
    {
      sum += depth;
      squares += depth * depth;
      light += depth * optical.source;
    }
  }
  if (!(sum > 0.0))
  {
    return;
  }
  const double depth = scene.scene.mixture == Mixture::Sum ? sum : squares / sum;
  const double weight = result.transmittance.x * opacity_from_optical_depth(depth * width);
  result.radiance += light * (weight / depth);
  result.transmittance -= weight;
  result.passed(s);
}

namespace
{

class CompositeRay final : public RayIntegral
{
public:
  CompositeRay(const ReferenceScene& scene, const PixelRay& ray)
    : TheScene(scene)
    , TheRay(ray)
  {
    for (const RayInterval& interval : ray.intervals())
    {
      CellWalk walk({ interval.from, interval.to });
      for (int v : interval.volumes)
      {
        walk.add(ray.volumes[v], scene.scene.volumes[v]);
      }
      RayPart part;
      while (walk.next(part))
      {
        this->add(interval, part);
      }
    }
  }

  RayResult integrate(int pieces) const override
  {
    RayResult result;
    for (const Stretch& stretch : this->Stretches)
    {
      const int count = pieces * stretch.factor;
      const double width = (stretch.part.to - stretch.part.from) / count;
      for (int piece = 0; piece < count; ++piece)
      {
        pass_sample(this->TheScene,
          this->TheRay,
          this->Volumes.data() + stretch.first_volume,
          stretch.volume_count,
          stretch.part.from + width * (piece + 0.5),
          width,
          result);
      }
      if (result.passes() < nothing_passes)
      {
        break;
      }
    }
    return result;
  }

private:
  struct Stretch
  {
    RayPart part;
    int factor;
    std::size_t first_volume;
    std::size_t volume_count;
  };

  void add(const RayInterval& interval, const RayPart& part)
  {
    if (!(part.from < part.to))
    {
      return;
    }
    const double middle = 0.5 * (part.from + part.to);
    Stretch stretch{ part, 1, this->Volumes.size(), 0 };
    for (int v : interval.volumes)
    {
      const ReferenceMedium& medium = this->TheScene.media[v];
      const VolumeRay& ray = this->TheRay.volumes[v];
      if (!medium.visible(ray.place(middle)))
      {
        continue;
      }
      this->Volumes.push_back(v);
      ++stretch.volume_count;
      const double variation = medium.variation(medium.label(ray.place(middle)),
        medium.value(ray.place(part.from)),
        medium.value(ray.place(part.to)));
      stretch.factor = std::max(stretch.factor, extra_pieces(variation));
    }
    if (stretch.volume_count > 0)
    {
      this->Stretches.push_back(stretch);
    }
  }

  const ReferenceScene& TheScene;
  const PixelRay& TheRay;
  std::vector<int> Volumes;
  std::vector<Stretch> Stretches;
};

}

std::unique_ptr<RayIntegral> make_composite(const ReferenceScene& scene, const PixelRay& ray)
{
  return std::make_unique<CompositeRay>(scene, ray);
}

}
