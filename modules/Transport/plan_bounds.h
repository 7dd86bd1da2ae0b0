// By how much leaving out one effect can change a pixel, in closed form. Internal to Transport.
// Derivations: docs/theory/plan.md.
#pragma once

#include "Transport/effects.h"
#include "Transport/plan_fog.h"
#include "Transport/plan_light.h"
#include "Transport/plan_probe.h"
#include "Transport/scene.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <vector>

namespace brume
{

class EffectBounds
{
public:
  /// `figures` are those of the scene. Both must stay as long as this.
  EffectBounds(const Scene& scene, const PlanFigures& figures);

  /// How much a pixel (radiance + transmittance · 1) changes at the most when `effect` is left out
  /// of a picture that simulates it and those of the others that `on` has. Not negative; may be +∞.
  double of(Effect effect, const EffectSet& on) const;

private:
  void find_channel_changes();
  ChannelRanges::Range channel(int c, const EffectSet& on) const;
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
  /// The light that may come from behind a volume: of the white background, and of fog.
  glm::dvec3 behind(const EffectSet& on) const;

  const Scene& TheScene;
  const PlanFigures& Figures;
  double Gain = 1.0; ///< light of components adds up faster than they dim
  ChannelRanges Channels;
  PlanLight Light;
  FogFigures FogSeen;
  std::vector<glm::dvec3> Emission;     ///< of each volume, by unit of its optical depth
  glm::dvec3 Clear{ 0.0 };              ///< emission of matter without extinction, along any ray
  double ShadowChange[3] = { 0, 0, 0 }; ///< by equal channels: of the transmittance toward lights
  double SkyChange[3] = { 0, 0, 0 };    ///< of E₂
  bool SurfacesBefore = false;          ///< some surface may be in or before matter
};

}
