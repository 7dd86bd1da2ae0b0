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

  /// The ends of the cells that a ray passes from `position` on, up to `end`: ends[0] is the
  /// position, ends[i + 1] the end of the cell that begins at ends[i].
  HWY_INLINE void cells(Real position, Real end, int count, Real* ends) const
  {
    const Real probe = position + Least;
    const Vec3<Real> place = TheLine.at(probe);
    const Real* p[3] = { &place.x, &place.y, &place.z };
    // Where the next border of each axis is, and how far it is from one to the next. Both kinds of
    // border together are half a voxel apart.
    const bool both = Linear && Labels;
    const Real spacing = real(both ? 0.5f : 1.0f);
    const Real offset = real(Linear ? 0.0f : 0.5f);
    Real next[3];
    Real apart[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      const Real scaled = (*p[axis] - offset) * (both ? real(2.0f) : real(1.0f));
      const Real into = (scaled - hn::Floor(scaled)) * spacing;
      const Mask up = Inverse[axis] > hn::Zero(float_tag);
      const Real distance = select(up, spacing - into, hn::Neg(into));
      next[axis] = hn::MulAdd(distance, Inverse[axis], probe);
      apart[axis] = hn::Abs(Inverse[axis]) * spacing;
    }
    ends[0] = position;
    for (int i = 0; i < count; ++i)
    {
      const Real border = hn::Min(next[0], hn::Min(next[1], next[2]));
      for (int axis = 0; axis < 3; ++axis)
      {
        const Mask here = next[axis] <= border + Least;
        next[axis] = next[axis] + hn::IfThenElseZero(here, apart[axis]);
      }
      ends[i + 1] = max(hn::Min(border, end), ends[i]);
    }
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

  /// A way further than `position`, and further than rounding would let it stand still.
  HWY_INLINE Real onward(Real position, Real way) const
  {
    return max(position + way, position + Least);
  }

private:
  static HWY_INLINE Real invert(Real delta)
  {
    // An axis along which the ray stands still never ends its way.
    const Mask still = hn::Abs(delta) < real(1e-30f);
    return hn::IfThenElse(still, real(1e30f), real(1.0f) / delta);
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
