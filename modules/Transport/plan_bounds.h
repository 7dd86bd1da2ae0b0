// By how much leaving out one effect can change a pixel, in closed form. Internal to Transport.
// Derivations: docs/theory/plan.md.
#pragma once

#include "Transport/effects.h"
#include "Transport/plan_probe.h"
#include "Transport/scene.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <vector>

namespace brume
{

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
  };
  Sum lobes[2];
  Sum even[2]; ///< by the isotropic phase function
  Sum lining;
  glm::dvec3 deviation[2]{ glm::dvec3(0.0), glm::dvec3(0.0) }; ///< by |lobes − isotropic|
};

/// Light that surface-like shading makes something of: Σ colour · strength.
struct RayShading
{
  RaySource::Sum diffuse;
  RaySource::Sum specular;
};

class EffectBounds
{
public:
  /// `figures` are those of the scene. Both must stay as long as this.
  EffectBounds(const Scene& scene, const PlanFigures& figures);

  /// How much a pixel (radiance + transmittance · 1) changes at the most when `effect` is left out
  /// of a picture that simulates it and those of the others that `on` has. Not negative; may be +∞.
  double of(Effect effect, const EffectSet& on) const;

  /// How far optical depths of the channels are from those of a channel of 1, at the most.
  double thickest_channel() const;

private:
  struct Range
  {
    double lower = 1.0;
    double upper = 1.0;
  };
  struct LightOnRay
  {
    double least_cosine = -1.0;
    double largest_cosine = 1.0;
    double strength = 0.0;
  };

  void find_channels();
  void find_rays();
  LightOnRay light_on_ray(const Light& light, std::size_t ray) const;
  bool inside(std::size_t ray, double& from, double& to) const;

  Range channel(int c, const EffectSet& on) const;
  /// ∫ T σt ds (or ∫ σt ds, without absorption) of a channel, at the most.
  double weight(std::size_t ray, int c, const EffectSet& on) const;
  glm::dvec3 lights(const Volume& volume, const RaySource& sums, const EffectSet& on) const;
  glm::dvec3 shaded(const Volume& volume, std::size_t ray, bool dimmed) const;
  glm::dvec3 scattered(std::size_t k, std::size_t ray, const EffectSet& on) const;
  glm::dvec3 emitted(std::size_t ray, const EffectSet& on) const;
  glm::dvec3 radiance(std::size_t ray, const EffectSet& on) const;
  glm::dvec3 tint(std::size_t k) const;
  glm::dvec3 change(Effect effect, std::size_t ray, const EffectSet& on) const;
  glm::dvec3 change_by_powder(std::size_t ray, const EffectSet& on) const;
  glm::dvec3 change_by_shading(std::size_t ray, const EffectSet& on) const;
  glm::dvec3 change_by_channels(std::size_t ray, const EffectSet& on) const;
  glm::dvec3 ambient() const;

  const Scene& TheScene;
  const PlanFigures& Figures;
  double Gain = 1.0; ///< light of components adds up faster than they dim
  Range Channels[3];
  Range Mean;
  std::vector<std::vector<RaySource>> Sources; ///< of each lit volume, of each ray
  std::vector<RayShading> Shadings;            ///< of each ray, where something is shaded
  std::vector<glm::dvec3> Emission;            ///< of each volume, by unit of its optical depth
  glm::dvec3 Clear{ 0.0 };              ///< emission of matter without extinction, along any ray
  double ShadowChange[3] = { 0, 0, 0 }; ///< by equal channels: of the transmittance toward lights
  double SkyChange[3] = { 0, 0, 0 };    ///< of E₂
  bool Lamps = false;
  bool SurfacesBefore = false; ///< some surface may be in or before matter
};

}
