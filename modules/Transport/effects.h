// The effects that a picture may simulate, by name. What a scene calls for: effect_plan.h.
#pragma once

#include <array>
#include <cstdint>

namespace brume
{

enum class Effect
{
  Absorption,         ///< the medium dims what is behind
  Emission,           ///< light that matter sends by itself
  Scattering,         ///< light of lamps and sky that matter sends on
  PhaseAnisotropy,    ///< phase functions other than the isotropic one
  ColouredExtinction, ///< extinction that differs between R, G and B
  Shadows,            ///< matter dims the light that reaches matter behind it
  Ambient,            ///< light of sky and ground
  Octaves,            ///< multiple scattering, approximated
  GradientShading,    ///< surface-like shading by the gradient
  SilverLining,
  Powder,
  Fog,
  Surfaces,    ///< opaque geometry ends rays
  SpaceLeaping ///< rays leap over bricks that hold nothing; changes no picture
};
constexpr int effect_count = 14;

/// "absorption", "phase anisotropy", "space leaping", …
const char* effect_name(Effect effect);

/// What simulating an effect adds to the time of a picture: as a share of the time of emission and
/// absorption with the same steps, ≥ 0. Measured on a cloud of 256³ densities under one sun
/// (docs/dev/performance.md); of octaves for four, of shadows for a light volume that is kept, one
/// light each. More lights and octaves cost as many times. Surfaces and leaping over empty bricks save
/// time, how much depends on the scene: 0.
double effect_cost(Effect effect);

/// A set of effects; all, at first.
class EffectSet
{
public:
  bool has(Effect effect) const { return this->Bits >> static_cast<int>(effect) & 1u; }
  void set(Effect effect, bool on)
  {
    const std::uint32_t bit = 1u << static_cast<int>(effect);
    this->Bits = on ? this->Bits | bit : this->Bits & ~bit;
  }
  bool operator==(const EffectSet& other) const { return this->Bits == other.Bits; }
  bool operator!=(const EffectSet& other) const { return this->Bits != other.Bits; }

private:
  std::uint32_t Bits = (1u << effect_count) - 1;
};

}
