// Fields whose integral along any straight line is known in closed form: what pictures, optical
// depths and partial volumes are held against.
//
// All lie in a box and are 0 outside of it. Values are densities, without a unit; time changes
// nothing. Bytes are the same on every machine.
#pragma once

#include "data-generators/field.h"
#include "data-generators/sampling.h"

namespace brume
{

/// A field that carries its own optical depth.
class ExactField : public Field
{
public:
  Box bounds() const override { return m_box; }
  /// The density, rounded to single precision.
  float value(const glm::dvec3& place, double time) const override;

  /// The density at a place, 0 outside the box; on the box's faces, and on borders within, that of
  /// either side.
  double density(const glm::dvec3& place) const;

  /// The integral of the density along the line origin + s direction/|direction|, for s from `from`
  /// to `to` world units (not above `to`, else 0; both may be infinite): the optical depth of
  /// matter whose extinction is the density, per world unit. Relative error: some 1e-15, times
  /// 1/(the length within matter) in units of the distance from the origin. Throws
  /// std::invalid_argument for an origin or direction that is not finite, a direction of length 0,
  /// and ends that are NaN.
  double optical_depth(const glm::dvec3& origin,
    const glm::dvec3& direction,
    double from,
    double to) const;

  /// The mean of the density over a box that lies within the field's: of 64 places, a rank-1
  /// lattice that projects onto 64 different places along each axis; of one, where it is the same
  /// all over.
  virtual double mean_in(const Box& box) const;

  /// Whether the density jumps within the box, so that voxels can hold a part of each side.
  virtual bool has_edges() const = 0;

protected:
  /// Throws std::invalid_argument for a box that has no volume or is not finite.
  explicit ExactField(const Box& box);

  virtual double density_inside(const glm::dvec3& place) const = 0;
  /// The same integral over a piece that lies within the box, along a direction of length 1.
  virtual double integral_inside(const glm::dvec3& origin,
    const glm::dvec3& direction,
    double from,
    double to) const = 0;

  /// Place n of the 64 of mean_in(), in a box.
  static glm::dvec3 sample_place(const Box& box, int n);
  static constexpr int sample_places = 64;

  Box m_box;
};

/// The same density everywhere in the box.
class ConstantField : public ExactField
{
public:
  /// density: not below 0. Here and below std::invalid_argument is thrown for what is out of range.
  ConstantField(const Box& box, double density);
  bool has_edges() const override { return false; }
  FieldRange range_in(const Box& box, double time) const override;

protected:
  double density_inside(const glm::dvec3&) const override { return m_density; }
  double integral_inside(const glm::dvec3&,
    const glm::dvec3&,
    double from,
    double to) const override
  {
    return m_density * (to - from);
  }

private:
  double m_density;
};

/// A density that runs evenly: middle + slope . (p - middle of the box). Trilinear interpolation
/// reproduces it.
class RampField : public ExactField
{
public:
  /// The density must not be below 0 in any corner of the box.
  RampField(const Box& box, double middle, const glm::dvec3& slope);
  bool has_edges() const override { return false; }
  FieldRange range_in(const Box& box, double time) const override;

protected:
  double density_inside(const glm::dvec3& place) const override;
  double integral_inside(const glm::dvec3& origin,
    const glm::dvec3& direction,
    double from,
    double to) const override;

private:
  double m_middle;
  glm::dvec3 m_slope;
};

/// A ball around the box's middle, of radius R: the same density d in all of it, or
/// d (1 - r^2/R^2), which falls to 0 at the rim.
class BallField : public ExactField
{
public:
  enum class Profile
  {
    uniform,
    parabolic
  };
  /// density not below 0; radius above 0, and no larger than half the box's least side.
  BallField(const Box& box, double density, double radius, Profile profile);
  bool has_edges() const override { return m_profile == Profile::uniform; }
  FieldRange range_in(const Box& box, double time) const override;

protected:
  double density_inside(const glm::dvec3& place) const override;
  double integral_inside(const glm::dvec3& origin,
    const glm::dvec3& direction,
    double from,
    double to) const override;

private:
  glm::dvec3 m_centre;
  double m_density;
  double m_radius;
  Profile m_profile;
};

/// The same density between two planes: |n.p - offset| <= thickness/2, n the normal over its
/// length.
class SlabField : public ExactField
{
public:
  /// density not below 0, normal not of length 0, thickness above 0.
  SlabField(const Box& box,
    double density,
    const glm::dvec3& normal,
    double offset,
    double thickness);
  bool has_edges() const override { return true; }
  FieldRange range_in(const Box& box, double time) const override;

protected:
  double density_inside(const glm::dvec3& place) const override;
  double integral_inside(const glm::dvec3& origin,
    const glm::dvec3& direction,
    double from,
    double to) const override;

private:
  glm::dvec3 m_normal;
  double m_density;
  double m_offset;
  double m_half;
};

/// A chessboard in three dimensions: `cells` cubes or bricks along each axis of the box, the one at
/// its lower corner with the first density, its neighbours with the second.
class CheckerField : public ExactField
{
public:
  /// Densities not below 0; cells from 1 to 1000 along each axis.
  CheckerField(const Box& box, double first, double second, const glm::ivec3& cells);
  bool has_edges() const override { return true; }
  /// In closed form: the field is a mean plus a product of three square waves.
  double mean_in(const Box& box) const override;
  FieldRange range_in(const Box& box, double time) const override;

protected:
  double density_inside(const glm::dvec3& place) const override;
  double integral_inside(const glm::dvec3& origin,
    const glm::dvec3& direction,
    double from,
    double to) const override;

private:
  glm::ivec3 cell_of(const glm::dvec3& place) const;

  double m_first, m_second;
  glm::ivec3 m_cells;
};

/// Fills a block of a grid with the means of a field over cubes, `width` voxels wide, around the
/// voxels' centres (cut at the field's box): partial volume. The mean is that of 64 places, a
/// rank-1 lattice that projects onto 64 different places along each axis; of one, where the field
/// has no edges or is the same all over the cube. Width 0 gives the values at the centres. For the
/// rest as sample().
bool sample_means(const ExactField& field,
  double width,
  const Lattice& grid,
  const Extent& extent,
  float* values,
  const Progress& progress = {});

}
