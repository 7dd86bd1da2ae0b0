// A path on its way, and what it meets. Internal to Transport: of PathScene's own files alone.
#pragma once

#include "Transport/path_fog.h"
#include "Transport/path_scene.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cstddef>
#include <limits>

namespace brume
{

namespace path_state
{

/// Lamps that are looked at where light is scattered.
constexpr std::size_t most_candidates = 16;

inline double largest(const glm::dvec3& v)
{
  return std::max({ v.x, v.y, v.z });
}

inline double mean(const glm::dvec3& v)
{
  return (v.x + v.y + v.z) / 3.0;
}

}

/// A path so far. Its events were drawn by the extinctions of one channel, the hero, which was
/// drawn itself; chances[c] is the density of these events had it been channel c, by that of the
/// hero. By the balance heuristic over the three each estimate counts by `chances` over their mean
/// (B. Miller, I. Georgiev, W. Jarosz, A null-scattering path integral formulation of light
/// transport, SIGGRAPH 2019; the hero: A. Wilkie et al., Hero wavelength spectral sampling, EGSR
/// 2014).
struct PathScene::Path
{
  RandomStream& random;
  PathCounts& counts;
  int hero = 0;
  glm::dvec3 chances{ 1.0 };
  glm::dvec3 kept{ 1.0 }; ///< the albedos on the way, by the chances of having gone on
  /// The fog that a ray goes through while matter is looked for on it; null where there is none.
  const FogVeil* veil = nullptr;

  glm::dvec3 weight() const { return this->kept * this->chances / path_state::mean(this->chances); }
  /// The same at a place of the ray that is being looked along.
  glm::dvec3 weight(double at) const
  {
    if (!this->veil)
    {
      return this->weight();
    }
    const glm::dvec3 passed = this->veil->passed(at, this->hero);
    if (this->veil->hero_counts())
    {
      return this->weight() * passed;
    }
    const glm::dvec3 now = this->chances * passed;
    return this->kept * now / path_state::mean(now);
  }
};

struct PathScene::Collision
{
  double at = std::numeric_limits<double>::infinity();
  const PathMatter* matter = nullptr; ///< null: fog
  glm::dvec3 place{ 0.0 };            ///< index space
  glm::dvec3 emitted{ 0.0 };
  bool floor = false; ///< no collision: the floor of the fog
};

}
