// How matter scatters and emits light. Conventions and units: docs/dev/units.md; theory:
// docs/theory/light.md.
#pragma once

#include "Transport/grid.h"

#include <glm/vec3.hpp>

#include <vector>

namespace brume
{

enum class PhaseFunction
{
  Isotropic,        ///< 1 / 4π
  Rayleigh,         ///< 3 / 16π · (1 + cos²θ): particles much smaller than the wavelength
  HenyeyGreenstein, ///< (1 − g²) / 4π / (1 + g² − 2 g cos θ)^{3/2}
  Schlick, ///< (1 − k²) / 4π / (1 − k cos θ)²: cheaper; k such that g is the mean cosine
};

/// A part of a phase function. θ is the angle between the directions of travel before and after;
/// each integrates to 1 over the sphere (1/sr).
struct PhaseLobe
{
  PhaseFunction function = PhaseFunction::Isotropic;
  /// ≥ 0. The weights of a medium's lobes are divided by their sum.
  double weight = 1.0;
  /// g, the mean cosine, in (−1, 1): forward > 0, backward < 0. Cut to ±0.9999. Of Henyey and
  /// Greenstein's and of Schlick's; the others do not read it.
  double anisotropy = 0.0;
};

/// Multiple scattering as a sum of single scatterings in ever thinner matter (Wrenninge, Kulla and
/// Lundqvist, Oz: the great and volumetric, SIGGRAPH talks 2013). Octave m, from 0 on, sends
/// contributionᵐ of the light, dimmed on its way from the light by attenuationᵐ of the extinction,
/// by a phase function of anisotropyᵐ · g. An approximation without a bound; contribution >
/// attenuation would make light from nothing and is refused.
struct Octaves
{
  int count = 1;             ///< 1 to 16; 1 is single scattering
  double attenuation = 0.5;  ///< a, in [0, 1]
  double contribution = 0.5; ///< b, in [0, attenuation]
  double anisotropy = 0.5;   ///< c, in [0, 1]
};
constexpr int most_octaves = 16;

/// Brightens the rim of matter before a light. Not physical. Adds to the phase function
/// strength · ((1 − back) HG(1 − spread) + back · HG(spread − 1)).
struct SilverLining
{
  bool enabled = false;
  double strength = 1.0; ///< ≥ 0
  double spread = 0.2;   ///< in (0, 1]: 1 − g of the lobe; small is a thin bright rim
  double back = 0.0;     ///< in [0, 1]: the share of a lobe that shines back toward the light
};

/// Darkens thin matter, as multiple scattering would brighten what is inside. Not physical: a factor
/// on all scattered light.
struct Powder
{
  enum class Form
  {
    /// 1 − strength · e^{−2d}
    Exponential,
    /// 1 − sat(strength · d^{R(h; 0.3, 0.9 → 0.5, 1)}) · sat(R(h; 0, 0.3 → 0.8, 1))^{0.8}; R maps
    /// linearly and clamps. h is the height in the volume's box, from 0 to 1 (Schneider and Vos, The
    /// real-time volumetric cloudscapes of Horizon: Zero Dawn, SIGGRAPH 2015).
    Height,
  };
  bool enabled = false;
  double strength = 1.0; ///< in [0, 1]
  Form form = Form::Exponential;
  /// d = scale · density, cut to [0, 1]; of classified volumes d is the opacity over the unit
  /// distance times this. > 0.
  double scale = 1.0;
};

/// What matter does with light.
struct Medium
{
  /// On: the matter sends what it scatters of the scene's lights and sky, and what it emits by itself
  /// (below). Off: of this struct nothing is read; a classified volume sends its colour.
  bool lit = false;
  /// σs / σt, in [0, 1], R, G, B. Of classified volumes the colour is multiplied in.
  glm::dvec3 albedo{ 1.0 };
  /// Empty: isotropic.
  std::vector<PhaseLobe> lobes;
  Octaves octaves;

  /// Radiance sent per unit of length and of density, R, G, B, ≥ 0. Of classified volumes: per unit
  /// of optical depth, and times the colour, so that 1 adds VTK's emission and absorption.
  glm::dvec3 emission{ 0.0 };
  /// Radiance of a black body sent per unit of length and of density (of optical depth, for
  /// classified volumes), in units of what a body of `black_body_reference` kelvin sends (its
  /// luminance); ≥ 0. Needs `temperature`.
  double black_body = 0.0;
  double black_body_reference = 1500.0; ///< kelvin, 800 to 1e5; others are refused
  /// Temperatures on the volume's own lattice: dims, padding and linear are the volume's grid's.
  /// Dense grids only. Its voxels null: none.
  Grid temperature;
  double temperature_scale = 1.0; ///< kelvin in one unit of `temperature`, > 0

  SilverLining silver_lining;
  Powder powder;
};

/// Light from all around that is no light of its own.
struct Sky
{
  glm::dvec3 radiance{ 0.0 };      ///< of the upper half of the sphere, R, G, B
  glm::dvec3 ground{ 0.0 };        ///< of the lower half
  glm::dvec3 up{ 0.0, 0.0, 1.0 };  ///< unit vector of the world
};

/// A medium without bounds: σt = extinction · e^{−falloff · (height − base_height)}, the height along
/// Sky::up in the world. It is lit by the scene's lights and sky.
struct Fog
{
  bool enabled = false;
  glm::dvec3 extinction{ 0.0 }; ///< at base_height, per world unit, R, G, B, ≥ 0
  glm::dvec3 albedo{ 1.0 };     ///< in [0, 1]
  std::vector<PhaseLobe> lobes; ///< empty: isotropic
  double falloff = 0.0;         ///< per world unit; 0: homogeneous
  double base_height = 0.0;     ///< world units
};

}
