// Cells of voxels as fields of every type read them: where a place is in its cell, trilinear values,
// and the cubics that they are along a line. Included once for each SIMD target.
#if defined(BRUME_CELL_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BRUME_CELL_INL_H
#undef BRUME_CELL_INL_H
#else
#define BRUME_CELL_INL_H
#endif

#include "Transport/field-inl.h"

HWY_BEFORE_NAMESPACE();
namespace brume
{
namespace HWY_NAMESPACE
{

/// The eight voxels around a place, as one cell and the place in it.
struct Cell
{
  Int index[3];
  Real fraction[3];
};

/// The cell that holds the place, or the one nearest to it. Trilinear interpolation in it also gives
/// the nearest voxel: the fractions are 0 or 1 then.
HWY_INLINE Cell locate_cell(const FieldView& view, const Vec3<Real>& place)
{
  const Real* coordinate[3] = { &place.x, &place.y, &place.z };
  Cell cell;
  for (int axis = 0; axis < 3; ++axis)
  {
    Real p =
      clamp(*coordinate[axis], hn::Zero(float_tag), real(static_cast<float>(view.last[axis])));
    if (!view.linear)
    {
      p = hn::Floor(p + real(0.5f));
    }
    cell.index[axis] = hn::Min(hn::ConvertTo(int_tag, p), integer(view.last_cell[axis]));
    cell.fraction[axis] = p - hn::ConvertTo(float_tag, cell.index[axis]);
  }
  return cell;
}

/// Two neighbours along x.
struct Pair
{
  Real first, second;
};
/// Trilinear between the four rows of a cell, (y, z) = (0, 0), (1, 0), (0, 1), (1, 1).
HWY_INLINE Real blend(const Pair rows[4], Real x, Real y, Real z)
{
  const Real low =
    lerp(lerp(rows[0].first, rows[0].second, x), lerp(rows[1].first, rows[1].second, x), y);
  const Real high =
    lerp(lerp(rows[2].first, rows[2].second, x), lerp(rows[3].first, rows[3].second, x), y);
  return lerp(low, high, z);
}

/// The values of a cell along the line, times `factor`.
HWY_INLINE Curve cell_curve(const FieldView& view,
  const Cell& cell, const Pair rows[4], const Line& line, Real from, Real to, Real factor)
{
  Real begin[3];
  Real way[3];
  const Vec3<Real> first = line.at(from);
  const Vec3<Real> last = line.at(to);
  const Real* ends[2][3] = { { &first.x, &first.y, &first.z }, { &last.x, &last.y, &last.z } };
  for (int axis = 0; axis < 3; ++axis)
  {
    const Real index = hn::ConvertTo(float_tag, cell.index[axis]);
    const Real one = real(view.last[axis] > 0 ? 1.0f : 0.0f);
    const auto fraction = [&](Real place)
    {
      return view.linear ? clamp(place - index, hn::Zero(float_tag), one) : cell.fraction[axis];
    };
    begin[axis] = fraction(*ends[0][axis]);
    way[axis] = fraction(*ends[1][axis]) - begin[axis];
  }
  // Along x each row is linear in t, along y each face is quadratic, along z all is cubic.
  Real p[4];
  Real q[4];
  for (int row = 0; row < 4; ++row)
  {
    const Real difference = (rows[row].second - rows[row].first) * factor;
    p[row] = hn::MulAdd(difference, begin[0], rows[row].first * factor);
    q[row] = difference * way[0];
  }
  Real face[2][3];
  for (int z = 0; z < 2; ++z)
  {
    const Real dp = p[2 * z + 1] - p[2 * z];
    const Real dq = q[2 * z + 1] - q[2 * z];
    face[z][0] = hn::MulAdd(begin[1], dp, p[2 * z]);
    face[z][1] = hn::MulAdd(begin[1], dq, hn::MulAdd(way[1], dp, q[2 * z]));
    face[z][2] = way[1] * dq;
  }
  const Real d0 = face[1][0] - face[0][0];
  const Real d1 = face[1][1] - face[0][1];
  const Real d2 = face[1][2] - face[0][2];
  Curve curve;
  curve.a0 = hn::MulAdd(begin[2], d0, face[0][0]);
  curve.a1 = hn::MulAdd(begin[2], d1, hn::MulAdd(way[2], d0, face[0][1]));
  curve.a2 = hn::MulAdd(begin[2], d2, hn::MulAdd(way[2], d1, face[0][2]));
  curve.a3 = way[2] * d2;
  curve.last = curve.a0 + (curve.a1 + (curve.a2 + curve.a3));
  return curve;
}

/// FieldFunctions::curves of a Reader: a type made from a FieldView that has read(cell, rows).
template <class Reader>
void read_curves(
  const FieldView& view, const Line& line, const Real* ends, int count, Curve* curves)
{
  const Reader reader(view);
  for (int i = 0; i < count; ++i)
  {
    Pair rows[4];
    const Cell cell = locate_cell(view, line.at((ends[i] + ends[i + 1]) * real(0.5f)));
    reader.read(cell, rows);
    curves[i] = cell_curve(view, cell, rows, line, ends[i], ends[i + 1], real(1.0f));
  }
}

HWY_INLINE void raise(Extreme& best, Real value, Real position)
{
  const Mask higher = value > best.value;
  best.value = select(higher, value, best.value);
  best.position = select(higher, position, best.position);
}

/// FieldFunctions::extremes of a Reader.
template <class Reader>
void read_extremes(const FieldView& view, const Line& line, const Real* ends, int count, float sign,
  Extreme& best)
{
  const Reader reader(view);
  const Real signs = real(sign);
  for (int i = 0; i < count; ++i)
  {
    Pair rows[4];
    const Cell cell = locate_cell(view, line.at((ends[i] + ends[i + 1]) * real(0.5f)));
    reader.read(cell, rows);
    // Most cells have no voxel as large.
    Real most = rows[0].first * signs;
    for (int row = 0; row < 4; ++row)
    {
      most = max(most, max(rows[row].first * signs, rows[row].second * signs));
    }
    if (hn::AllFalse(float_tag, most > best.value))
    {
      continue;
    }
    const Curve curve = cell_curve(view, cell, rows, line, ends[i], ends[i + 1], signs);
    if (hn::AllFalse(float_tag, curve.upper() > best.value))
    {
      continue;
    }
    const Real length = ends[i + 1] - ends[i];
    raise(best, curve.a0, ends[i]);
    const Real t = curve.turn(1.0f);
    const Mask inside =
      hn::And(t > hn::Zero(float_tag), t < real(1.0f)); // a NaN is in no interval
    const Real turn = hn::IfThenElseZero(inside, t);
    raise(best, hn::Min(curve.at(turn), most), hn::MulAdd(turn, length, ends[i]));
    raise(best, curve.last, ends[i + 1]);
  }
}

}
}
HWY_AFTER_NAMESPACE();

#endif
