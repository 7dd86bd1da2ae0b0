// Fog without bounds, in closed form: along any stretch of a ray its optical depth, what passes, and
// the light that it sends. Double precision. Theory: docs/theory/fog.md.
#pragma once

#include "Transport/phase.h"
#include "Transport/scene.h"

#include <glm/vec3.hpp>

#include <cmath>
#include <cstddef>
#include <vector>

namespace brume
{

namespace scalar
{

inline double transmittance_of(double optical_depth)
{
  return std::exp(-optical_depth);
}
/// (1 − e^(−x)) / x for x ≥ 0; 1 at 0.
inline double mean_transmittance_of(double x)
{
  return x > 0.0 ? -std::expm1(-x) / x : 1.0;
}

#include "Transport/fog-inl.h"

}

/// A ray as fog sees it; made by FogModel::ray. Places on it are distances s from its origin, in world
/// units; a stretch may end at infinity.
struct FogRay
{
  glm::dvec3 origin{ 0.0 };
  glm::dvec3 direction{ 0.0, 0.0, -1.0 }; ///< a unit vector
  double height = 0.0;                    ///< of the origin over Fog::base_height
  double slope = 0.0;                     ///< rise of the height in a unit of s
  /// Lights at a place count as passed by at no less than this times their distance. A ray that
  /// stands for a pixel takes half of the pixel's half width, in radians: what light falls off with
  /// the square of the distance then shows with its mean over the pixel where the ray meets the
  /// light, and not as infinite. Not so lights whose attenuation bounds what is near them within that
  /// distance: they are what they are on the ray. 0: a ray without width.
  double spread = 0.0;
};

/// Whether a scene has fog that is drawn: some that dims, in composite mode.
bool has_fog(const Scene& scene);

/// A scene's fog, prepared: its extinction is Fog::extinction · f, f = e^(−falloff · (height − base
/// height)). All functions are finite or +infinity for any ray and any stretch from ≤ to, level, steep
/// or so deep that f overflows; transmittance is then 0. An optical depth may be +infinity.
///
/// What light reaches a place, and what does not:
/// - Directional lights are dimmed by the layers over the place. A light at or under the horizon of
///   Sky::up sends nothing into fog with falloff. Fog without falloff has no upper end: a light at
///   infinity arrives there as it is given, undimmed, from above and from below.
/// - The sky (Sky::radiance) is dimmed likewise: half of it times E₂ of the optical depth straight up.
///   Light from the ground (Sky::ground) would come through endlessly many, ever denser layers:
///   none arrives. Without falloff both arrive undimmed. Light from all around is scattered as though
///   by the isotropic phase function; of fog as bright above as below that is exact.
/// - Positional lights are dimmed by the fog between light and place.
/// - What fog scatters is not scattered again, and Octaves do not apply. Volumes throw no shadow here.
class FogModel
{
public:
  /// Fog that is not enabled is fog without extinction. Throws std::invalid_argument for numbers that
  /// Fog does not allow.
  explicit FogModel(const Scene& scene);

  /// Whether there is anything that dims or sends.
  bool visible() const { return this->Largest > 0.0; }

  FogRay ray(const glm::dvec3& origin, const glm::dvec3& direction, double spread = 0.0) const;

  /// f at a place of the world, at a place of a ray; +infinity far below the base height.
  double profile(const glm::dvec3& place) const;
  double profile(const FogRay& ray, double s) const;

  /// ∫ f ds, in world units.
  double column(const FogRay& ray, double from, double to) const;
  /// Where from `from` on the column reaches `amount`; +infinity where it never does.
  double place_of_column(const FogRay& ray, double from, double amount) const;

  /// σt · column, R, G, B.
  glm::dvec3 optical_depth(double column) const;
  glm::dvec3 optical_depth(const FogRay& ray, double from, double to) const
  {
    return this->optical_depth(this->column(ray, from, to));
  }
  glm::dvec3 transmittance(const FogRay& ray, double from, double to) const;

  /// Radiance that the stretch sends toward the ray's origin, as it leaves the stretch at `from`.
  ///@{
  /// Of all lights and the sky.
  glm::dvec3 radiance(const FogRay& ray, double from, double to) const;
  /// Of the scene's light of this number: in closed form for a light at infinity; for one at a place
  /// by quadrature, to a relative error of 1e-5.
  glm::dvec3 lit_by(std::size_t light, const FogRay& ray, double from, double to) const;
  /// Of the sky and the ground: by quadrature, to a relative error of 1e-6.
  glm::dvec3 ambient(const FogRay& ray, double from, double to) const;
  ///@}

  /// What of the light of this number the fog lets through to a place: R, G, B, in [0, 1]. Its cone
  /// and its fall-off with distance are not the fog's, and not counted.
  glm::dvec3 light_transmittance(std::size_t light, const glm::dvec3& place) const;
  /// The mean of what of the upper half of the sphere's light is let through, E₂ of the depth upward.
  glm::dvec3 sky_transmittance(const glm::dvec3& place) const;
  /// What a place sends along `direction`, by unit of optical depth of the fog there.
  glm::dvec3 source(const glm::dvec3& place, const glm::dvec3& direction) const;

  /// The column behind which no channel has more than half of the light left, where `through` is left
  /// before it; +infinity where there is none.
  double half_column(const glm::dvec3& through = glm::dvec3(1.0)) const;

private:
  struct Lamp
  {
    glm::dvec3 irradiance; ///< π · Light::diffuse
    glm::dvec3 direction;
    glm::dvec3 position;
    double rise = 0.0;    ///< of the height on the way to a light at infinity
    double profile = 1.0; ///< f at the position
    bool positional = false;
    ShadeLight shape{}; ///< cone and attenuation, at the origin
  };

  glm::dvec3 lit_by_sun(const Lamp& lamp, const FogRay& ray, double from, double to) const;
  glm::dvec3 lit_by_lamp(const Lamp& lamp, const FogRay& ray, double from, double to) const;
  /// Of a stretch between two places of these profiles; the falloff along it is ±`fall`.
  static double column_between(double begin, double end, double fall, double length);
  double lamp_column(const Lamp& lamp, double profile, const glm::dvec3& offset) const;
  friend class FogLampIntegral;

  glm::dvec3 Extinction{ 0.0 };
  glm::dvec3 Albedo{ 1.0 };
  glm::dvec3 Up{ 0.0, 0.0, 1.0 };
  glm::dvec3 SkyRadiance{ 0.0 };
  glm::dvec3 Ground{ 0.0 };
  double Falloff = 0.0;
  double BaseHeight = 0.0;
  double Largest = 0.0; ///< of the channels' extinctions
  PhaseModel Phase;
  std::vector<Lamp> Lamps;
};

/// E₂ (exponential_integral.h) to a relative error of 1e-9, from polynomials: for many places.
double quick_exponential_integral_2(double x);

}
