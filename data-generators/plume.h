// A plume of hot smoke as a function of place and time.
#pragma once

#include "data-generators/field.h"

#include <cstdint>
#include <memory>
#include <utility>

namespace brume
{

/// What plume it is.
struct PlumeOptions
{
  std::uint32_t seed = 1;

  /// Width of the box, metres; above 0. The box is twice as high as wide, and everything grows with
  /// it.
  double width = 4.0;

  /// Metres a second with which the turbulence rises. Any finite value.
  double rise = 1.2;

  /// Temperature of the air and of the source, kelvin; 0 < air <= source.
  double air_temperature = 300.0;
  double source_temperature = 1900.0;
};

/// A plume that rises from a source on the ground and mixes with the air.
///
/// In widths of the box, z the height: the axis meanders by noise, the more the higher; around it
/// the plume has the radius r(z) = 0.05 + 0.13 z, as plumes widen in proportion to the height
/// (Morton, Taylor and Turner, Turbulent gravitational convection, 1956). With d the distance from
/// the axis, f = 1 − d²/r² and n in [0, 1] a noise of billows and gradients (cumulus.h), warped
/// more the higher,
///   density     = q sat(5 (f (0.8 n + 0.12) − 0.2)),     q = r(0) / r(z)
///   temperature = air + (source − air) sat(1.7 q) sat(2 f) (0.4 + 0.6 n)
/// where q stands for the smoke's thinning by mixing, and 1.7 for its burning a little above the
/// source. Density is in [0, 1] without a unit: multiply by an extinction (4 to 20 per metre for
/// the default width).
///
/// Density is exactly 0 within 0.02 width of the box's faces, and outside the box; temperature
/// there is that of the air.
///
/// Throws std::invalid_argument from the constructor for options out of their range.
class Plume : public Field
{
public:
  explicit Plume(const PlumeOptions& options = {});

  struct State
  {
    float density;     ///< in [0, 1]
    float temperature; ///< kelvin
  };
  /// Time in seconds; a time that is not finite counts as 0.
  State at(const glm::dvec3& place, double time) const;

  Box bounds() const override;
  /// The density.
  float value(const glm::dvec3& place, double time) const override;
  /// 0 beyond the farthest that the meandering plume reaches.
  FieldRange range_in(const Box& box, double time) const override;

  const PlumeOptions& options() const { return m_options; }

private:
  PlumeOptions m_options;
};

/// The temperature of a plume, kelvin.
class PlumeTemperature : public Field
{
public:
  explicit PlumeTemperature(std::shared_ptr<const Plume> plume)
    : m_plume(std::move(plume))
  {
  }
  Box bounds() const override { return m_plume->bounds(); }
  float value(const glm::dvec3& place, double time) const override
  {
    return m_plume->at(place, time).temperature;
  }
  /// That of the air where the plume does not reach.
  FieldRange range_in(const Box& box, double time) const override;

private:
  std::shared_ptr<const Plume> m_plume;
};

}
