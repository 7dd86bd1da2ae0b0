// Fog under one light, without volumes.
#pragma once

#include "fog_truth.h"

#include "Transport/scene.h"

namespace fog_scenes
{

using namespace brume;
using fog_truth::direction_of;
using glm::dvec3;

inline Scene scene_of(double falloff, const dvec3& extinction = dvec3(0.4))
{
  Scene scene;
  scene.volumes.clear();
  scene.lights.clear();
  scene.fog.enabled = true;
  scene.fog.extinction = extinction;
  scene.fog.albedo = dvec3(0.9, 0.8, 0.7);
  scene.fog.falloff = falloff;
  scene.fog.base_height = 2.0;
  PhaseLobe lobe;
  lobe.function = PhaseFunction::HenyeyGreenstein;
  lobe.anisotropy = 0.7;
  scene.fog.lobes = { lobe };
  return scene;
}

/// A sun that rises by `rise`.
inline Light sun_of(double rise)
{
  Light sun;
  sun.diffuse = dvec3(1.0, 0.8, 0.6);
  sun.direction = -direction_of(rise, 2.0);
  return sun;
}

inline Scene scene_under_sky(double falloff)
{
  Scene scene = scene_of(falloff, dvec3(0.4, 0.05, 0.005));
  scene.sky.radiance = dvec3(1.0, 2.0, 3.0);
  scene.sky.ground = dvec3(0.5, 0.25, 0.125);
  return scene;
}

inline const dvec3 lamp_attenuations[4] = { { 1, 0, 0 },
  { 0.2, 0.3, 0 },
  { 0, 0, 1 },
  { 1, 0, 1e3 } };

inline Light lamp_of(const dvec3& position,
  const dvec3& direction,
  const dvec3& attenuation,
  double cone)
{
  Light lamp;
  lamp.positional = true;
  lamp.position = position;
  lamp.direction = direction;
  lamp.attenuation = attenuation;
  lamp.cone_angle = cone;
  lamp.exponent = 3.0;
  return lamp;
}

}
