// The light that reaches matter, looked at along the rays of a plan. Internal to Transport.
// Derivations: docs/theory/plan.md.
#pragma once

#include "Transport/plan_probe.h"
#include "Transport/scene.h"

#include <glm/vec3.hpp>

#include <vector>

namespace brume
{

/// Extinctions of R, G and B as shares of the volumes' own, and their means: least and largest of
/// all volumes.
struct ChannelRanges
{
  struct Range
  {
    double lower = 1.0;
    double upper = 1.0;
  };
  Range of[3];
  Range mean;
};
ChannelRanges channel_ranges(const Scene& scene);

/// Bounds of the light that matter sends on along one ray, as sums over the lights of irradiance
/// and phase function, R, G, B. Index 0: the first octave; 1: the others, their contributions
/// multiplied in. `dimmed`: times what matter can take from the light on its way, at the most.
struct RaySource
{
  struct Sum
  {
    glm::dvec3 all{ 0.0 };
    glm::dvec3 dimmed{ 0.0 };
    void add(const glm::dvec3& light, const glm::dvec3& share_dimmed)
    {
      this->all += light;
      this->dimmed += light * share_dimmed;
    }
    void add(const Sum& other)
    {
      this->all += other.all;
      this->dimmed += other.dimmed;
    }
  };
  Sum lobes[2];
  Sum even[2]; ///< by the isotropic phase function
  Sum lining;
  glm::dvec3 deviation[2]{ glm::dvec3(0.0), glm::dvec3(0.0) }; ///< by |lobes − isotropic|

  void add(const RaySource& other)
  {
    for (int part = 0; part < 2; ++part)
    {
      this->lobes[part].add(other.lobes[part]);
      this->even[part].add(other.even[part]);
      this->deviation[part] += other.deviation[part];
    }
    this->lining.add(other.lining);
  }
};

/// Light that surface-like shading makes something of: Σ colour · strength.
struct RayShading
{
  RaySource::Sum diffuse;
  RaySource::Sum specular;
};

struct PlanLight
{
  std::vector<std::vector<RaySource>>
    sources;                        ///< of each volume (none if it is not lit), of each ray
  std::vector<RayShading> shadings; ///< of each ray, where something is shaded
  bool lamps = false;               ///< whether a light is not at infinity
};
PlanLight find_light(const Scene& scene, const PlanFigures& figures, const ChannelRanges& channels);

}
