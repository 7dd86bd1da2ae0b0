// Leaping over bricks that cannot be seen. Included once for each SIMD target.
#if defined(BRUME_LEAP_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BRUME_LEAP_INL_H
#undef BRUME_LEAP_INL_H
#else
#define BRUME_LEAP_INL_H
#endif

#include "Transport/bricks.h"
#include "Transport/field-inl.h"

#include <limits>

HWY_BEFORE_NAMESPACE();
namespace brume
{
namespace HWY_NAMESPACE
{

/// Samples that are taken between two looks at the visible bricks.
constexpr int samples_between_leaps = 4;

class Leaper
{
public:
  /// `bricks` may be null: way() then is 0 everywhere.
  HWY_INLINE Leaper(const VisibleBricks* bricks, const Line& line)
    : Bricks(bricks)
    , TheLine(line)
    , Inverse{ invert(line.delta.x), invert(line.delta.y), invert(line.delta.z) }
  {
  }

  HWY_INLINE bool leaps() const { return Bricks != nullptr; }

  /// For rays at a position in an invisible brick: steps to where its invisible surroundings end,
  /// cut by a thousandth, so that rounding never leaps over a visible place. 0 for the others.
  HWY_INLINE Real way(Real position) const
  {
    const Vec3<Real> place = TheLine.at(position);
    const Real* p[3] = { &place.x, &place.y, &place.z };
    Int brick[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      const Int cell = hn::ConvertTo(int_tag, hn::Max(*p[axis], hn::Zero(float_tag)));
      brick[axis] =
        hn::Min(hn::ShiftRightSame(cell, Bricks->shift), integer(Bricks->dims[axis] - 1));
    }
    const Int index =
      (brick[2] * integer(Bricks->dims[1]) + brick[1]) * integer(Bricks->dims[0]) + brick[0];
    const Int distance = hn::GatherIndex(int_tag, Bricks->distance.data(), index);
    const Mask leaps = hn::RebindMask(float_tag, distance > integer(0));
    if (hn::AllFalse(float_tag, leaps))
    {
      return hn::Zero(float_tag);
    }
    Real way = real(std::numeric_limits<float>::max());
    for (int axis = 0; axis < 3; ++axis)
    {
      const Real edge = real(static_cast<float>(1 << Bricks->shift));
      const Real high = hn::ConvertTo(float_tag, brick[axis] + distance) * edge;
      const Real low = hn::ConvertTo(float_tag, brick[axis] - distance + integer(1)) * edge;
      const Real face = select(Inverse[axis] > hn::Zero(float_tag), high, low);
      way = hn::Min(way, (face - *p[axis]) * Inverse[axis]);
    }
    return hn::IfThenElseZero(leaps, max(way - real(1e-3f), hn::Zero(float_tag)));
  }

private:
  static HWY_INLINE Real invert(Real delta)
  {
    // An axis along which the ray stands still never ends its way.
    const Mask still = hn::Abs(delta) < real(1e-30f);
    return hn::IfThenElse(still, real(1e30f), real(1.0f) / delta);
  }

  const VisibleBricks* Bricks;
  const Line& TheLine;
  Real Inverse[3];
};

}
}
HWY_AFTER_NAMESPACE();

#endif
