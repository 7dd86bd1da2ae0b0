// By how much leaving out an effect of fog can change a pixel. Internal to Transport. Derivations:
// docs/theory/plan.md.
#pragma once

#include "Transport/effects.h"
#include "Transport/scene.h"

#include <glm/vec3.hpp>

namespace brume
{

/// Largest figures of a scene's fog, of 1024 rays of the camera as it is, through fog alone, as far
/// as surfaces let them go; volumes only dim it. All 0 where there is no fog.
struct FogFigures
{
  bool any = false;
  glm::dvec3 opacity{ 0.0 }; ///< 1 − transmittance
  glm::dvec3 radiance{ 0.0 };
  glm::dvec3 lit{ 0.0 };       ///< of this, light of lamps
  glm::dvec3 ambient{ 0.0 };   ///< of sky and ground
  glm::dvec3 deviation{ 0.0 }; ///< by phase functions other than the isotropic one
  glm::dvec3 grey_change{
    0.0
  }; ///< of radiance and transmittance, by an extinction of equal channels
  glm::dvec3 grey_dims{ 0.0 }; ///< of the transmittance alone
  /// How much of a volume's light fog may take, on the way to it and to the eye.
  glm::dvec3 takes{ 0.0 };
};

FogFigures look_at_fog(const Scene& scene);

/// What leaving out an effect changes in the fog of a picture that simulates it and those of the
/// others that `on` has. Absorption is that of volumes.
glm::dvec3 change_in_fog(Effect effect, const FogFigures& fog, const EffectSet& on);

}
