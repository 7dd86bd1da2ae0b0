// The projections: largest and smallest value, mean and sum. Each volume by itself, then their sum.
#include "Transport/cubic.h"
#include "Transport/reference_integrators.h"

#include <functional>

namespace brume
{

namespace
{

/// A number along a stretch between cell borders, exactly.
Cubic cubic_along(const RayPart& part, const std::function<double(double)>& at)
{
  const double width = part.to - part.from;
  // The nearest voxel's value jumps at the ends of the stretch: read just inside.
  const double inset = 1e-9;
  const auto value = [&](double t)
  { return at(part.from + width * std::clamp(t, inset, 1.0 - inset)); };
  return Cubic(value(0.0), value(1.0 / 3.0), value(2.0 / 3.0), value(1.0));
}

class ExtremeRay final : public RayIntegral
{
public:
  ExtremeRay(const ReferenceScene& scene, const PixelRay& ray)
    : TheScene(scene)
    , TheRay(ray)
    , Sign(scene.scene.blend_mode == BlendMode::MaximumIntensity ? 1.0 : -1.0)
  {
  }

  bool exact() const override { return true; }

  RayResult integrate(int) const override
  {
    RayResult result;
    double opacity = 0.0;
    double most = 0.0;
    for (std::size_t v = 0; v < this->TheScene.media.size(); ++v)
    {
      const Found found = this->find(v, result.samples);
      if (found.label < 0)
      {
        continue;
      }
      const Tinted tinted = this->TheScene.media[v].projected(
        found.label, this->TheRay.volumes[v].place(found.s), this->Sign * found.value);
      const double weight = this->TheScene.scene.volumes[v].weight * tinted.opacity;
      result.radiance += tinted.colour * weight;
      opacity += weight;
      if (weight > most)
      {
        most = weight;
        result.half_way = found.s;
      }
    }
    result.transmittance = glm::dvec3(std::max(0.0, 1.0 - opacity));
    if (!(result.passes() < 0.5))
    {
      result.half_way = std::numeric_limits<double>::infinity();
    }
    return result;
  }

private:
  struct Found
  {
    double value = -std::numeric_limits<double>::infinity(); ///< times Sign
    double s = 0.0;
    int label = -1;
  };

  Found find(std::size_t v, std::uint64_t& samples) const
  {
    const ReferenceMedium& medium = this->TheScene.media[v];
    const VolumeRay& ray = this->TheRay.volumes[v];
    Found best;
    for (const RayPart& whole : ray.parts)
    {
      CellWalk walk(whole);
      walk.add(ray, medium.volume());
      RayPart part;
      while (walk.next(part))
      {
        if (!(part.from < part.to))
        {
          continue;
        }
        const glm::dvec3 middle = ray.place(0.5 * (part.from + part.to));
        const int label = medium.label(middle);
        double lower, upper;
        medium.range(middle, lower, upper);
        if (label < 0 || std::max(this->Sign * lower, this->Sign * upper) <= best.value)
        {
          continue;
        }
        const Cubic cubic =
          cubic_along(part, [&](double s) { return this->Sign * medium.value(ray.place(s)); });
        samples += 4;
        double turns[4];
        const int count = cubic.turns(turns);
        for (int i = 0; i < count; ++i)
        {
          const double value = cubic.at(turns[i]);
          if (value > best.value)
          {
            best = { value, part.from + (part.to - part.from) * turns[i], label };
          }
        }
      }
    }
    return best;
  }

  const ReferenceScene& TheScene;
  const PixelRay& TheRay;
  double Sign; ///< the largest of Sign · value is looked for
};

class GreyRay final : public RayIntegral
{
public:
  GreyRay(const ReferenceScene& scene, const PixelRay& ray)
    : TheScene(scene)
    , TheRay(ray)
    , Mean(scene.scene.blend_mode == BlendMode::AverageIntensity)
    , Stretches(scene.media.size())
  {
    for (std::size_t v = 0; v < scene.media.size(); ++v)
    {
      for (const RayPart& whole : ray.volumes[v].parts)
      {
        CellWalk walk(whole);
        walk.add(ray.volumes[v], scene.media[v].volume());
        RayPart part;
        while (walk.next(part))
        {
          this->add(v, part);
        }
      }
    }
  }

  RayResult integrate(int pieces) const override
  {
    RayResult result;
    double grey = 0.0;
    bool any = false;
    for (std::size_t v = 0; v < this->TheScene.media.size(); ++v)
    {
      const Volume& volume = this->TheScene.scene.volumes[v];
      double length = 0.0;
      const double sum = this->add_up(v, pieces, length, result.samples);
      if (length > 0.0)
      {
        any = true;
        grey += volume.weight * (this->Mean ? sum / length
                                            : sum * this->TheRay.volumes[v].length /
                                                volume.classification.unit_distance);
      }
    }
    if (any)
    {
      result.radiance = glm::dvec3(std::clamp(grey, 0.0, 1.0));
      result.transmittance = glm::dvec3(0.0);
    }
    return result;
  }

private:
  struct Stretch
  {
    RayPart part;
    int label;
    int factor;
  };

  void add(std::size_t v, const RayPart& part)
  {
    const ReferenceMedium& medium = this->TheScene.media[v];
    const VolumeRay& ray = this->TheRay.volumes[v];
    const double middle = 0.5 * (part.from + part.to);
    const int label = medium.label(ray.place(middle));
    if (!(part.from < part.to) || label < 0)
    {
      return;
    }
    const int factor = extra_pieces(medium.variation(
      label, medium.value(ray.place(part.from)), medium.value(ray.place(part.to))));
    if (!this->Mean)
    {
      this->Stretches[v].push_back({ part, label, factor });
      return;
    }
    // Where the value enters or leaves the range that counts the stretch is cut.
    const Cubic cubic =
      cubic_along(part, [&](double s) { return medium.grey_value(ray.place(s)); });
    double turns[4];
    const int count = cubic.turns(turns);
    std::vector<double> cuts(turns, turns + count);
    const double* range = this->TheScene.scene.average_range;
    for (int i = 1; i < count; ++i)
    {
      for (double end : { range[0], range[1] })
      {
        if ((cubic.at(turns[i - 1]) < end) != (cubic.at(turns[i]) < end))
        {
          cuts.push_back(cubic.root(end, turns[i - 1], turns[i]));
        }
      }
    }
    std::sort(cuts.begin(), cuts.end());
    const double width = part.to - part.from;
    for (std::size_t i = 1; i < cuts.size(); ++i)
    {
      const double value = cubic.at(0.5 * (cuts[i - 1] + cuts[i]));
      if (cuts[i - 1] < cuts[i] && value >= range[0] && value <= range[1])
      {
        this->Stretches[v].push_back(
          { { part.from + width * cuts[i - 1], part.from + width * cuts[i] }, label, factor });
      }
    }
  }

  /// ∫ opacity · grey ds and ∫ ds.
  double add_up(std::size_t v, int pieces, double& length, std::uint64_t& samples) const
  {
    const ReferenceMedium& medium = this->TheScene.media[v];
    const VolumeRay& ray = this->TheRay.volumes[v];
    const double* black_white = medium.volume().grey_range;
    const double span = black_white[1] - black_white[0];
    double sum = 0.0;
    for (const Stretch& stretch : this->Stretches[v])
    {
      const int count = pieces * stretch.factor;
      const double width = (stretch.part.to - stretch.part.from) / count;
      length += stretch.part.to - stretch.part.from;
      for (int piece = 0; piece < count && span > 0.0; ++piece)
      {
        const glm::dvec3 place = ray.place(stretch.part.from + width * (piece + 0.5));
        const double opacity = medium.projected_opacity(stretch.label, place);
        ++samples;
        if (opacity > 0.0)
        {
          sum += opacity * (medium.grey_value(place) - black_white[0]) / span * width;
        }
      }
    }
    return sum;
  }

  const ReferenceScene& TheScene;
  const PixelRay& TheRay;
  bool Mean;
  std::vector<std::vector<Stretch>> Stretches; ///< of each volume
};

}

std::unique_ptr<RayIntegral> make_extreme(const ReferenceScene& scene, const PixelRay& ray)
{
  return std::make_unique<ExtremeRay>(scene, ray);
}

std::unique_ptr<RayIntegral> make_grey(const ReferenceScene& scene, const PixelRay& ray)
{
  return std::make_unique<GreyRay>(scene, ray);
}

}
