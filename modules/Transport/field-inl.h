// What integrators ask of a grid: values, gradients and curves along a packet of rays, whatever the
// type of its voxels and whether it is dense or sparse. The types themselves are read in
// dense_field-inl.h and sparse_field-inl.h, compiled in field_<type>.cxx. Included once for each SIMD
// target.
#if defined(BRUME_FIELD_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BRUME_FIELD_INL_H
#undef BRUME_FIELD_INL_H
#else
#define BRUME_FIELD_INL_H
#endif

#include "Transport/field_view.h"
#include "Transport/packet-inl.h"

HWY_BEFORE_NAMESPACE();
namespace brume
{
namespace HWY_NAMESPACE
{

/// A packet of rays in a grid's index space. Positions along it are in steps.
struct Line
{
  Vec3<Real> begin;
  Vec3<Real> delta; ///< one step

  HWY_INLINE Vec3<Real> at(Real position) const { return begin + delta * position; }
};

/// A cubic over t in [0, 1].
struct Curve
{
  Real a0, a1, a2, a3; ///< a0 + a1 t + a2 t² + a3 t³
  Real last;           ///< at 1

  HWY_INLINE Real at(Real t) const
  {
    return hn::MulAdd(hn::MulAdd(hn::MulAdd(a3, t, a2), t, a1), t, a0);
  }
  /// Bounds of its values: it lies in the hull of Bernstein's coefficients.
  HWY_INLINE Real upper() const
  {
    return max(max(a0, last), max(inner(1.0f), inner(2.0f)));
  }
  HWY_INLINE Real lower() const
  {
    return hn::Min(hn::Min(a0, last), hn::Min(inner(1.0f), inner(2.0f)));
  }
  /// Where its slope passes 0 from above to below (side 1) or from below to above (side −1); outside
  /// [0, 1] or not a number where it does not. The root's form that does not cancel.
  HWY_INLINE Real turn(float side) const
  {
    const Real a = a3 * real(3.0f);
    const Real b = a2;
    const Real discriminant = hn::MulSub(b, b, a * a1);
    const Real root = hn::Sqrt(max(discriminant, hn::Zero(float_tag))) * real(side);
    const Mask far = b * real(side) >= hn::Zero(float_tag);
    const Real t = select(far, (b + root) / hn::Neg(a), a1 / (root - b));
    return select(discriminant > hn::Zero(float_tag), t, real(-1.0f));
  }

private:
  HWY_INLINE Real inner(float which) const
  {
    const Real third = real(1.0f / 3.0f);
    const Real first = hn::MulAdd(a1, third, a0);
    return which == 1.0f ? first : hn::MulAdd(a1 + a2, third, first);
  }
};

/// The largest of sign · value that a packet has met, and where.
struct Extreme
{
  Real value;
  Real position;
};

/// What integrators ask of a field.
struct FieldFunctions
{
  /// values[i] at positions[i] of the line, for i < count.
  void (*values)(const FieldView&, const Line&, const Real* positions, int count, Real* values);
  /// Gradient at a place of index space by central differences of one voxel, interpolated, in
  /// values per voxel.
  void (*gradient)(const FieldView&, const Vec3<Real>& place, Vec3<Real>& gradient);
  /// Of cells that the line passes one after the other: cell i lies between the positions ends[i]
  /// and ends[i + 1], and the value in it is a cubic of the position. curves[i] is that cubic.
  void (*curves)(const FieldView&, const Line&, const Real* ends, int count, Curve* curves);
  /// Where sign · value rises above best.value in such cells, `best` is raised to the first of its
  /// largest values.
  void (*extremes)(
    const FieldView&, const Line&, const Real* ends, int count, float sign, Extreme& best);
};

FieldFunctions field_uint8(const FieldView& view);
FieldFunctions field_int8(const FieldView& view);
FieldFunctions field_uint16(const FieldView& view);
FieldFunctions field_int16(const FieldView& view);
FieldFunctions field_float32(const FieldView& view);
FieldFunctions field_sparse(const FieldView& view); ///< of any type

HWY_INLINE FieldFunctions field_functions(const FieldView& view)
{
  if (view.table)
  {
    return field_sparse(view);
  }
  switch (view.type)
  {
    case VoxelType::UInt8:
      return field_uint8(view);
    case VoxelType::Int8:
      return field_int8(view);
    case VoxelType::UInt16:
      return field_uint16(view);
    case VoxelType::Int16:
      return field_int16(view);
    case VoxelType::Float32:
      return field_float32(view);
    case VoxelType::Float16: // refused by Grid::validate
      break;
  }
  return {};
}

}
}
HWY_AFTER_NAMESPACE();

#endif
