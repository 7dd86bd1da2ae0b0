// Fog without bounds as paths meet it. Theory: docs/theory/paths.md. Internal to Transport.
#pragma once

#include "Transport/fog.h"
#include "Transport/phase_sampler.h"
#include "Transport/random_stream.h"
#include "Transport/scene.h"

#include <glm/vec3.hpp>

#include <limits>

namespace brume
{

/// A scene's fog for paths: collisions are drawn and transmittances found in closed form.
///
/// Conservative fog with falloff thickens downward without end, and paths in it would collide
/// endlessly on average. Light that comes down to where nothing is any more returns: far enough
/// below everything, such fog is replaced by a white matt floor. In a conservative half-space light
/// becomes even with depth as e^(−τ (1 − g)), and the floor is 16 of these below, an error of 10⁻⁷.
class PathFog
{
public:
  /// Of a scene that has_fog(). Throws std::invalid_argument for fog that paths have no end in: one
  /// without falloff into which light shines from infinity, or of albedo 1, if any number of
  /// scatterings (most_scatterings 0, or for light from infinity more than 1) is to be followed.
  PathFog(const Scene& scene, int most_scatterings);

  FogRay ray(const glm::dvec3& begin, const glm::dvec3& along) const
  {
    return this->Model.ray(begin, along);
  }
  /// Where from s = 0 on a channel's optical depth reaches `depth`; +infinity where it never does.
  double place_of_depth(const FogRay& ray, double depth, int channel) const;
  double column(const FogRay& ray, double to) const { return this->Model.column(ray, 0.0, to); }
  glm::dvec3 transmittance(const FogRay& ray, double to) const
  {
    return this->Model.transmittance(ray, 0.0, to);
  }
  /// The same toward light at infinity, which reaches all of fog without falloff undimmed (fog.h).
  glm::dvec3 transmittance_to_infinity(const FogRay& ray) const;

  /// At a place of the world, per world unit.
  glm::dvec3 extinction(const glm::dvec3& place) const
  {
    return this->Model.optical_depth(this->Model.profile(place));
  }
  /// At Fog::base_height.
  const glm::dvec3& base_extinction() const { return this->Extinction; }
  const glm::dvec3& albedo() const { return this->Albedo; }
  const PhaseSampler& phase() const { return this->Phase; }
  bool scatters() const
  {
    return this->Albedo.x > 0.0 || this->Albedo.y > 0.0 || this->Albedo.z > 0.0;
  }
  bool is_layered() const { return this->Falloff > 0.0; }
  bool is_coloured() const
  {
    return this->Extinction.x != this->Extinction.y || this->Extinction.y != this->Extinction.z;
  }

  /// Height of the floor for paths that begin at a place, over Fog::base_height; −infinity: none.
  double floor(const glm::dvec3& begin) const;
  /// Where a ray meets a floor from above; +infinity where it does not.
  static double floor_place(const FogRay& ray, double floor);
  /// 1 for the channels that the floor is for, else 0.
  const glm::dvec3& conservative() const { return this->Conservative; }
  /// A direction in which the floor sends light on.
  glm::dvec3 from_floor(RandomStream& random) const;

private:
  FogModel Model;
  PhaseSampler Phase;
  glm::dvec3 Extinction;
  glm::dvec3 Albedo;
  glm::dvec3 Up;
  double Falloff;
  double BaseHeight;
  glm::dvec3 Conservative{ 0.0 };
  bool HasFloor = false;
  double Lowest = std::numeric_limits<double>::infinity(); ///< height of what is in the fog
  double Added = 0.0; ///< profile that the floor's has more than what is over it
};

/// What fog has let through on the way to a place of a ray.
class FogVeil
{
public:
  /// The ray of the fog begins `before` in front of what distances are measured from. With
  /// `undrawn`, no collisions with the fog were drawn on this ray.
  FogVeil(const PathFog& fog, const FogRay& ray, double before, bool undrawn)
    : Fog(&fog)
    , Ray(ray)
    , Before(before)
    , Undrawn(undrawn)
  {
  }

  /// The chances that each channel's light came as far, by that of the hero's, or, undrawn, the
  /// chances themselves.
  glm::dvec3 passed(double at, int hero) const;
  bool hero_counts() const { return this->Undrawn; }
  const FogRay& ray() const { return this->Ray; }

private:
  const PathFog* Fog;
  FogRay Ray;
  double Before;
  bool Undrawn;
};

}
