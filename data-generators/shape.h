// Shapes by signed distance, put together from simple ones.
//
// A shape is a function f of place, in the place's own unit: below 0 inside, above 0 outside, 0 on
// the surface. With d the distance to the nearest place of the surface, every shape here holds
//   |f(a) - f(b)| <= L |a - b|,  so that  |f| <= L d,
// where L is its Lipschitz constant, stated by lipschitz(): f/L is a step that never passes through
// the surface (Hart, "Sphere tracing", 1996). L is 1 unless the shape is twisted or displaced.
// Where f is d itself, exact_outside() and exact_inside() say so; elsewhere it is smaller.
//
//                          L                      exact outside            exact inside
//   primitives             1                      yes                      yes
//   unite                  largest of its parts   if all parts are         if all are, and their
//                                                                          boxes do not touch
//   intersect              largest of its parts   no                       if all parts are
//   subtract a, b          larger of the two      no                       if a is, and b outside
//   complement             as the part            as the part inside       as the part outside
//   smooth_…               larger of the two      no                       no
//   moved, rotated, scaled as the part            as the part              as the part
//   repeated               as the part (>= 1)     as the part              if the part is, and its
//                                                                          copies do not touch
//   twisted                times s(k R), see there   no                    no
//   displaced by waves     plus 2 pi a / w        no                       no
//   displaced by noise     plus 4 a / w           no                       no
//   grown                  as the part            if the part is (r >= 0)  no
//   shell                  as the part            if the part is both      no
//
// Formulas of the primitives: Quilez, "Distance functions" (iquilezles.org/articles/distfunctions),
// and for the ellipsoid see there. Same bytes on every machine: no libm, no contraction.
#pragma once

#include "data-generators/field.h"

#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <memory>
#include <vector>

namespace brume
{

struct ShapeNode;

/// A shape: cheap to copy, never changes, any number of threads may ask it at once. There is none
/// that is empty: shapes are made by the functions of brume::shapes, or from text (shape_text.h).
class Shape
{
public:
  /// For the functions that make shapes; `node` is not null.
  explicit Shape(std::shared_ptr<const ShapeNode> node);

  /// f at a place. A place that is not finite gives NaN.
  double distance(const glm::dvec3& place) const;

  /// The slope of f, by central differences over 2e-5 times `scale` (above 0: about the size of the
  /// shape's details); of length 1 where f is exact and smooth, at most L everywhere. At edges it
  /// is the mean of the slopes beside them.
  glm::dvec3 gradient(const glm::dvec3& place, double scale = 1.0) const;

  /// L above; at least 1.
  double lipschitz() const;
  bool exact_outside() const;
  bool exact_inside() const;

  /// A box that holds all of the inside. Faces may be at infinity; lower > upper for a shape that
  /// is known to be empty.
  Box bounds() const;

  const ShapeNode& node() const { return *m_node; }

private:
  std::shared_ptr<const ShapeNode> m_node;
};

/// Where a ray meets a shape.
struct ShapeHit
{
  bool hit = false;
  double distance = 0.0; ///< along the ray, world units; where the search ended if nothing was hit
  int steps = 0;         ///< times that the shape was asked
};

/// The first place of a ray, between `from` and `to` world units from its origin, at which
/// |f| <= tolerance (above 0), found by steps of |f|/L. From within a shape
/// it finds the way out. `direction` need not be of length 1, but not 0. No step passes
/// through a surface. After `most_steps` it gives up where it is.
ShapeHit sphere_trace(const Shape& shape,
  const glm::dvec3& origin,
  const glm::dvec3& direction,
  double from,
  double to,
  double tolerance,
  int most_steps = 10000);

/// What makes shapes. All lengths are in world units, and all of these throw std::invalid_argument
/// for numbers that are not finite or out of the range given.
namespace shapes
{

/// A ball around the origin; radius above 0.
Shape sphere(double radius);
/// A box around the origin with faces along the axes: half its sides, each above 0, and the radius
/// of its rounded edges, from 0 to the least half side.
Shape box(const glm::dvec3& half, double rounding = 0.0);
/// A ring in the plane z = 0: radii of its middle line and of its tube, both above 0, the
/// tube's not larger than the ring's.
Shape torus(double ring_radius, double tube_radius);
/// All within a radius (above 0) of the line from a to b, which may be one place.
Shape capsule(const glm::dvec3& a, const glm::dvec3& b, double radius);
/// A cylinder around the z axis, from -half_height to half_height; both above 0.
Shape cylinder(double radius, double half_height);
/// A cone cut off, around the z axis: radius `bottom` at -half_height and `top` at half_height.
/// Neither below 0, one above 0; half_height above 0.
Shape cone(double bottom, double top, double half_height);
/// An ellipsoid with axes along x, y, z; radii above 0. The true distance, not the usual
/// approximation: the nearest place of the surface is x_i = r_i^2 p_i / (t + r_i^2) for the largest
/// t with sum (x_i/r_i)^2 = 1 (Eberly, "Distance from a point to an ellipse, an ellipsoid, or a
/// hyperellipsoid", 2013), found by Newton's method on 1/sqrt(sum), which climbs to the root from
/// below without overshooting.
Shape ellipsoid(const glm::dvec3& radii);
/// All on the side of a plane against its normal: n.p <= offset, n of length 1 (the normal given
/// need not be, but not 0).
Shape plane(const glm::dvec3& normal, double offset);

/// Joined: the smallest of the distances. At least one part; the same for those below.
Shape unite(const std::vector<Shape>& parts);
/// What all have in common: the largest of the distances.
Shape intersect(const std::vector<Shape>& parts);
/// a without b.
Shape subtract(const Shape& a, const Shape& b);
/// What is outside the part: -f.
Shape complement(const Shape& part);

/// With a fillet: the polynomial smooth minimum (signed_distance.h), which differs from min(a, b)
/// only where |a - b| < width, by at most width/4. Its slope is a weighted mean of the parts'.
/// Width above 0.
Shape smooth_unite(const Shape& a, const Shape& b, double width);
Shape smooth_intersect(const Shape& a, const Shape& b, double width);
Shape smooth_subtract(const Shape& a, const Shape& b, double width);

/// The part moved.
Shape moved(const Shape& part, const glm::dvec3& by);
/// The part turned around an axis through the origin (not of length 0), counterclockwise as seen
/// from its tip.
Shape rotated(const Shape& part, const glm::dvec3& axis, double degrees);
/// The part made larger by a factor above 0. The distance grows with it: factor f(p/factor).
Shape scaled(const Shape& part, double factor);

/// Copies of the part at all multiples of the spacing along each axis, or at so many of them
/// (counts above 0, around the origin: for 3 at -1, 0, 1, for 2 at 0 and 1). A spacing of 0: no
/// copies along this axis; not below 0.
///
/// f is the least over the copies that can be the nearest one, also those of neighbouring cells, so
/// that it is right at the borders of cells and when the part is wider than a cell. The part must
/// be bounded along the axes that are repeated; and not so wide that more than 1000 copies could be
/// the nearest one. Where the part is not exact outside, f is at most the distance that lies
/// between a place and the copies it need not ask.
Shape repeated(const Shape& part, const glm::dvec3& spacing);
Shape repeated(const Shape& part, const glm::dvec3& spacing, const glm::ivec3& counts);

/// The part wound around the z axis, by `degrees` a world unit along z. With k the same in radians
/// and R the radius of the cylinder around the z axis that holds the part, L is that of the part
/// times s(k R), the largest stretch of a shear by k R: s(g) = (g + sqrt(g^2 + 4))/2. Farther from
/// the axis than R the place is first moved to that cylinder, else no L would do. The part must be
/// bounded in x and y.
Shape twisted(const Shape& part, double degrees);

/// f plus amplitude sin(w x) sin(w y) sin(w z), w = 2 pi/wavelength. The slope of the product of
/// sines is at most w (its square over w^2 is AB + BC + CA - 3ABC, with A, B, C the squared sines:
/// linear in each, so largest at a corner of the cube, where it is 1). Wavelength above 0.
Shape displaced_by_waves(const Shape& part, double amplitude, double wavelength);

/// f plus amplitude times Perlin noise with features of a size (above 0); the noise's slope is
/// below 4 (noise.h). It comes in single precision: a sphere_trace with a tolerance
/// finer than 1e-7 of the amplitude may miss the surface.
Shape displaced_by_noise(const Shape& part, double amplitude, double size, std::uint32_t seed);

/// All within a radius of the part (f - radius); a radius below 0 wears it away.
Shape grown(const Shape& part, double radius);
/// A wall of a thickness (above 0) around the surface, half of it to each side: |f| - thickness/2.
Shape shell(const Shape& part, double thickness);

}

/// A shape as something to be sampled; time changes nothing.
class ShapeField : public Field
{
public:
  enum class Quantity
  {
    distance, ///< f, world units
    density   ///< 1 inside, 0 outside, along 3 t^2 - 2 t^3 for f from width/2 to -width/2
  };

  /// `box` is what bounds() gives; `width` (not below 0; 0: a step) matters for the density alone,
  /// `band` (above 0, world units) for the distance alone: beyond it distances are held to it,
  /// negative inside.
  ShapeField(const Shape& shape,
    const Box& box,
    Quantity quantity,
    double width,
    double band = std::numeric_limits<double>::infinity());

  Box bounds() const override { return m_box; }
  float value(const glm::dvec3& place, double time) const override;
  /// By the value in the middle and the Lipschitz constant.
  FieldRange range_in(const Box& box, double time) const override;

private:
  float of_distance(double f) const;

  Shape m_shape;
  Box m_box;
  Quantity m_quantity;
  double m_width;
  double m_band;
};

}
