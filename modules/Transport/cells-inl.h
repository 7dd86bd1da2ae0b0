// From one voxel cell to the next along the rays of a packet. Included once for each SIMD target.
#if defined(BRUME_CELLS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BRUME_CELLS_INL_H
#undef BRUME_CELLS_INL_H
#else
#define BRUME_CELLS_INL_H
#endif

#include "Transport/bricks.h"
#include "Transport/field-inl.h"

#include <algorithm>

HWY_BEFORE_NAMESPACE();
namespace brume
{
namespace HWY_NAMESPACE
{

/// Finds where rays leave cells and bricks. Positions are a line's.
class CellSteps
{
public:
  /// `labels`: cells also end half-way between voxels, where the nearest label changes.
  HWY_INLINE CellSteps(const Line& line, const FieldView& field, bool labels)
    : TheLine(line)
    , Linear(field.linear)
    , Labels(labels)
    , Inverse{ invert(line.delta.x), invert(line.delta.y), invert(line.delta.z) }
  {
    // More than places are rounded by, so that a cell is always left.
    const int longest = std::max({ field.last[0], field.last[1], field.last[2], 16 });
    const Real fastest =
      hn::Min(hn::Abs(Inverse[0]), hn::Min(hn::Abs(Inverse[1]), hn::Abs(Inverse[2])));
    Least = fastest * real(static_cast<float>(longest) * 5e-7f);
  }

  /// The end of the cell that a ray is in just behind `position`.
  HWY_INLINE Real next(Real position) const
  {
    const Real probe = position + Least;
    const Vec3<Real> place = TheLine.at(probe);
    Real way = real(1e30f);
    if (Linear)
    {
      way = to_border(place, 0.0f);
    }
    if (!Linear || Labels)
    {
      way = hn::Min(way, to_border(place, 0.5f));
    }
    return probe + max(way, hn::Zero(float_tag));
  }

  /// The number of the brick that a ray is in just behind `position`, and where it leaves it.
  HWY_INLINE Int brick(const int dims[3], int shift, Real position, Real& exit) const
  {
    const Real probe = position + Least;
    const Vec3<Real> place = TheLine.at(probe);
    const Real* p[3] = { &place.x, &place.y, &place.z };
    Real way = real(1e30f);
    Int index = hn::Zero(int_tag);
    for (int axis = 2; axis >= 0; --axis)
    {
      const Int last = integer(dims[axis] - 1);
      const Int cell = hn::ConvertTo(int_tag, hn::Max(*p[axis], hn::Zero(float_tag)));
      const Int brick = hn::Min(hn::ShiftRightSame(cell, shift), last);
      index = index * integer(dims[axis]) + brick;
      // The first and the last brick reach beyond the grid.
      const Int one = integer(1);
      const Int low = hn::IfThenElse(hn::Eq(brick, hn::Zero(int_tag)), integer(-1), brick);
      const Int high = hn::IfThenElse(hn::Eq(brick, last), last + one + one, brick + one);
      const Mask up = Inverse[axis] > hn::Zero(float_tag);
      const Real face = hn::ConvertTo(float_tag, hn::IfThenElse(hn::RebindMask(int_tag, up), high, low)) *
        real(static_cast<float>(1 << shift));
      way = hn::Min(way, (face - *p[axis]) * Inverse[axis]);
    }
    exit = probe + max(way, hn::Zero(float_tag));
    return index;
  }

private:
  static HWY_INLINE Real invert(Real delta)
  {
    // An axis along which the ray stands still never ends its way.
    const Mask still = hn::Abs(delta) < real(1e-30f);
    return hn::IfThenElse(still, real(1e30f), real(1.0f) / delta);
  }

  HWY_INLINE Real to_border(const Vec3<Real>& place, float offset) const
  {
    const Real* p[3] = { &place.x, &place.y, &place.z };
    Real way = real(1e30f);
    for (int axis = 0; axis < 3; ++axis)
    {
      const Real shifted = *p[axis] - real(offset);
      const Real into = shifted - hn::Floor(shifted);
      const Mask up = Inverse[axis] > hn::Zero(float_tag);
      const Real distance = select(up, real(1.0f) - into, hn::Neg(into));
      way = hn::Min(way, distance * Inverse[axis]);
    }
    return way;
  }

  const Line& TheLine;
  bool Linear;
  bool Labels;
  Real Inverse[3];
  Real Least; ///< positions
};

}
}
HWY_AFTER_NAMESPACE();

#endif
