// Isosurfaces and the slice.
#include "Transport/cubic.h"
#include "Transport/reference_integrators.h"

#include <glm/geometric.hpp>

namespace brume
{

namespace
{

void pass_surface(const Tinted& tinted, double s, RayResult& result)
{
  result.radiance += tinted.colour * (result.transmittance * tinted.opacity);
  result.transmittance *= 1.0 - tinted.opacity;
  result.passed(s);
}

class IsosurfaceRay final : public RayIntegral
{
public:
  IsosurfaceRay(const ReferenceScene& scene, const PixelRay& ray)
    : Medium(scene.media.front())
    , TheRay(ray.volumes.front())
    , Values(scene.scene.isosurfaces)
  {
    std::sort(this->Values.begin(), this->Values.end());
    this->Values.erase(std::unique(this->Values.begin(), this->Values.end()), this->Values.end());
  }

  bool exact() const override { return true; }

  RayResult integrate(int) const override
  {
    RayResult result;
    if (this->Values.empty())
    {
      return result;
    }
    std::vector<char> above(this->Values.size());
    for (const RayPart& whole : this->TheRay.parts)
    {
      bool begins = true;
      CellWalk walk(whole);
      walk.add(this->TheRay, this->Medium.volume());
      RayPart part;
      while (walk.next(part) && result.passes() >= nothing_passes)
      {
        if (!(part.from < part.to))
        {
          continue;
        }
        const int label = this->Medium.label(this->TheRay.place(0.5 * (part.from + part.to)));
        if (label < 0)
        {
          begins = true;
          continue;
        }
        this->cross(part, label, begins, above, result);
        begins = false;
      }
    }
    return result;
  }

private:
  /// Draws the surfaces of one stretch between cell borders. `above` tells for each value on which
  /// side the ray is; one that only touches a value stays where it was.
  void cross(const RayPart& part,
    int label,
    bool begins,
    std::vector<char>& above,
    RayResult& result) const
  {
    const double width = part.to - part.from;
    const auto value = [&](double t)
    {
      const double inset = 1e-9; // the nearest voxel's value jumps at the ends
      return this->Medium.value(
        this->TheRay.place(part.from + width * std::clamp(t, inset, 1.0 - inset)));
    };
    if (!begins && this->nothing_changes(part, above))
    {
      return;
    }
    const Cubic cubic(value(0.0), value(1.0 / 3.0), value(2.0 / 3.0), value(1.0));
    result.samples += 4;
    double turns[4];
    const int count = cubic.turns(turns);
    struct Crossing
    {
      double t;
      double value;
    };
    std::vector<Crossing> crossings;
    for (std::size_t i = 0; i < this->Values.size(); ++i)
    {
      const double wanted = this->Values[i];
      if (begins)
      {
        above[i] = cubic.at(0.0) >= wanted;
      }
      for (int j = 0; j < count; ++j)
      {
        const double here = cubic.at(turns[j]);
        if (above[i] ? here >= wanted : here <= wanted)
        {
          continue;
        }
        above[i] = !above[i];
        crossings.push_back({ j == 0 ? 0.0 : cubic.root(wanted, turns[j - 1], turns[j]), wanted });
      }
    }
    std::sort(crossings.begin(),
      crossings.end(),
      [](const Crossing& a, const Crossing& b) { return a.t < b.t; });
    for (const Crossing& crossing : crossings)
    {
      const double s = part.from + width * crossing.t;
      pass_surface(
        this->Medium.surface(label, this->TheRay.place(s), this->TheRay.along, crossing.value),
        s,
        result);
    }
  }

  /// Whether the values of the brick are all on the side where the ray is.
  bool nothing_changes(const RayPart& part, const std::vector<char>& above) const
  {
    double lower, upper;
    this->Medium.range(this->TheRay.place(0.5 * (part.from + part.to)), lower, upper);
    for (std::size_t i = 0; i < this->Values.size(); ++i)
    {
      if (above[i] ? lower < this->Values[i] : upper > this->Values[i])
      {
        return false;
      }
    }
    return true;
  }

  const ReferenceMedium& Medium;
  const VolumeRay& TheRay;
  std::vector<double> Values;
};

class SliceRay final : public RayIntegral
{
public:
  SliceRay(const ReferenceScene& scene, const PixelRay& ray)
    : Medium(scene.media.front())
    , TheRay(ray.volumes.front())
  {
    const Volume& volume = scene.scene.volumes.front();
    const glm::dvec4 plane =
      glm::transpose(volume.world_from_data * volume.data_from_index) * scene.scene.slice;
    const double offset = glm::dot(plane, glm::dvec4(this->TheRay.begin, 1.0));
    const double slope = glm::dot(glm::dvec3(plane), this->TheRay.along);
    this->At = -offset / slope; // no number where the ray runs along the plane
  }

  bool exact() const override { return true; }

  RayResult integrate(int) const override
  {
    RayResult result;
    for (const RayPart& part : this->TheRay.parts)
    {
      if (!(this->At >= part.from && this->At <= part.to))
      {
        continue;
      }
      const glm::dvec3 place = this->TheRay.place(this->At);
      const int label = this->Medium.label(place);
      ++result.samples;
      if (label >= 0)
      {
        pass_surface(
          this->Medium.surface(label, place, this->TheRay.along, this->Medium.value(place)),
          this->At,
          result);
      }
      break;
    }
    return result;
  }

private:
  const ReferenceMedium& Medium;
  const VolumeRay& TheRay;
  double At;
};

}

std::unique_ptr<RayIntegral> make_isosurface(const ReferenceScene& scene, const PixelRay& ray)
{
  return std::make_unique<IsosurfaceRay>(scene, ray);
}

std::unique_ptr<RayIntegral> make_slice(const ReferenceScene& scene, const PixelRay& ray)
{
  return std::make_unique<SliceRay>(scene, ray);
}

}
