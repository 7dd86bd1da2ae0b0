// The head phantom of Shepp and Logan in three dimensions.
#pragma once

#include "data-generators/exact_field.h"

#include <vector>

namespace brume
{

/// Ten ellipsoids, each adding its value where it is, in the box [-1, 1]^3 world units; z is the
/// head's axis, y its front. Each ellipsoid is turned around z alone.
///
/// Geometry: Kak and Slaney, "Principles of Computerized Tomographic Imaging" (1988), table 3.2,
/// p. 102; the values there are densities relative to water: skull 2, brain 1.02, within it 1.00 to
/// 1.04. Raised contrast: Yu, Ye and Wang, "Katsevich-type algorithms for variable radius spiral
/// cone-beam CT", Proc. SPIE 5535 (2004): skull 1, brain 0.2, within it 0 to 0.4.
/// After Shepp and Logan, "The Fourier reconstruction of a head section" (1974).
class SheppLogan : public ExactField
{
public:
  enum class Contrast
  {
    kak_slaney,
    raised
  };
  explicit SheppLogan(Contrast contrast = Contrast::raised);

  bool has_edges() const override { return true; }
  /// Asks only those ellipsoids whose surface passes through the box.
  double mean_in(const Box& box) const override;
  FieldRange range_in(const Box& box, double time) const override;

protected:
  double density_inside(const glm::dvec3& place) const override;
  double integral_inside(const glm::dvec3& origin,
    const glm::dvec3& direction,
    double from,
    double to) const override;

private:
  struct Ellipsoid
  {
    glm::dvec3 centre, radii;
    double cosine, sine; ///< of the turn around z, counterclockwise
    double value;
    double least_radius;

    /// A vector in the ellipsoid's axes, in its radii.
    glm::dvec3 within(const glm::dvec3& v) const;
    /// 1: all of a box lies inside, -1: all outside, 0: perhaps some of both.
    int side(const Box& box) const;
  };
  std::vector<Ellipsoid> m_ellipsoids;
};

}
