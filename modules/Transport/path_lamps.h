// Lamps in matter, close to which light grows as 1/d². Theory: docs/theory/paths.md. Internal to
// Transport.
#pragma once

#include "Transport/lamp.h"
#include "Transport/phase_sampler.h"
#include "Transport/random_stream.h"

#include <glm/vec3.hpp>

namespace brume
{

/// Where light of a lamp is to be scattered last, and by how much that counts.
struct LampPlace
{
  glm::dvec3 place{ 0.0 };
  glm::dvec3 along{ 0.0 }; ///< unit vector from the last place to this one
  double way = 0.0;        ///< between them
  /// By the density of this place: of a ray 1, of a place the phase function there over way²; 0
  /// where there is nothing to find.
  double weight = 0.0;
};

/// A lamp, and the sphere around it in which light that it sends is not looked for at collisions:
/// these are too seldom where it is brightest, and their variance is infinite. In the sphere the
/// last scattering is drawn together with the way to it instead, so that the lamp's 1/d² and that
/// of the way both cancel (C. Kulla, M. Fajardo, Importance sampling techniques for path tracing in
/// participating media, EGSR 2012, along rays of the camera; I. Georgiev et al., Joint importance
/// sampling of low-order volumetric scattering, SIGGRAPH Asia 2013, of two scatterings).
struct NearLamp
{
  const Lamp* lamp = nullptr;
  double radius = 0.0;

  const glm::dvec3& centre() const { return this->lamp->light().position; }
  /// The square of the distance within which the light is even rather than as 1/d²: its attenuation is
  /// that of 1 / (core + d²), but for what is linear in d.
  double core() const;

  /// On a ray from `begin` along a unit vector, evenly by the angle at the lamp, or, of a lamp whose
  /// light c₀ of its attenuation bounds, at a point so far beside it that this is even in its light.
  LampPlace on_ray(const glm::dvec3& begin,
    const glm::dvec3& along,
    double length,
    RandomStream& random) const;

  /// From a place that light reaches along `from`: near the lamp by 1/r² or near the place by phase
  /// function and 1/way², each with a density that has the distance R of both for its scale (the lamp's core added), and
  /// weighted by the balance heuristic. The weight times 1/r² is then below a constant over R.
  LampPlace from_place(const glm::dvec3& begin,
    const glm::dvec3& from,
    const PhaseSampler& phase,
    RandomStream& random) const;
};

}
