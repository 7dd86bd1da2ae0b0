// What matter sends at a place when lights, sky and its own glow are counted, in double precision.
// Theory: docs/theory/light.md. Internal to the reference.
#pragma once

#include "Transport/fog.h"
#include "Transport/lamp.h"
#include "Transport/phase.h"
#include "Transport/reference_grid.h"
#include "Transport/reference_medium.h"
#include "Transport/reference_ray.h"
#include "Transport/scene.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <memory>
#include <vector>

namespace brume
{

/// Whether a scene has to be drawn by ReferenceLighting: it has fog, a lit medium, or a density whose
/// extinction differs between R, G and B.
bool needs_lighting(const Scene& scene);

/// Of a place on a ray, for a way of 1 in s: optical depth, and radiance that is sent along the ray
/// toward its begin.
struct Sent
{
  glm::dvec3 extinction{ 0.0 };
  glm::dvec3 radiance{ 0.0 };
};

class ReferenceLighting
{
public:
  /// Keeps references to both; `media` are the scene's volumes, in order.
  ReferenceLighting(const Scene& scene, const std::vector<ReferenceMedium>& media);
  ~ReferenceLighting();

  /// The scene's fog; null for none.
  const FogModel* fog() const { return this->Fog.get(); }

  /// What the volumes of these numbers and the fog send together at s. `pieces`: how fine shadow
  /// rays are through classified matter; through densities they are exact. Adds the places looked at
  /// to `samples`.
  Sent sent(const PixelRay& ray,
    const int* volumes,
    std::size_t count,
    double s,
    int pieces,
    std::uint64_t& samples) const;

  /// Optical depth of all volumes between two places of the world: two Gauss–Legendre points in
  /// each voxel cell times `pieces`, and more of them where transfer functions go up and down in
  /// it.
  glm::dvec3 optical_depth(const glm::dvec3& from,
    const glm::dvec3& along,
    int pieces,
    std::uint64_t& samples) const;

private:
  struct Arriving; ///< light that arrives at a place
  struct Body;     ///< a volume

  Arriving arriving(const PixelRay& ray, double s, int pieces, std::uint64_t& samples) const;
  /// What the fog sends per unit of its extinction.
  glm::dvec3 sent_by_fog(const Arriving& light) const;

  const Scene& TheScene;
  const std::vector<ReferenceMedium>& Media;
  ReferenceRays Rays;
  std::vector<Lamp> Lamps;
  std::vector<Body> Bodies;
  std::unique_ptr<FogModel> Fog;
  PhaseModel FogPhase;
};

}
