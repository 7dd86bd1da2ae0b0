// Packets of numbers: the vocabulary of the kernels, for the SIMD target at hand.
// Included once for each target (Highway's foreach_target).
#if defined(BRUME_PACKET_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BRUME_PACKET_INL_H
#undef BRUME_PACKET_INL_H
#else
#define BRUME_PACKET_INL_H
#endif

#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace brume
{
namespace HWY_NAMESPACE
{

namespace hn = hwy::HWY_NAMESPACE;

using FloatTag = hn::ScalableTag<float>;
using IntTag = hn::ScalableTag<std::int32_t>;
using Real = hn::Vec<FloatTag>;
using Int = hn::Vec<IntTag>;
using Mask = hn::Mask<FloatTag>;

constexpr FloatTag float_tag{};
constexpr IntTag int_tag{};
constexpr int lane_count = HWY_LANES(float);

HWY_INLINE Real real(float value)
{
  return hn::Set(float_tag, value);
}
HWY_INLINE Int integer(std::int32_t value)
{
  return hn::Set(int_tag, value);
}
HWY_INLINE Real max(Real a, Real b)
{
  return hn::Max(a, b);
}
HWY_INLINE Real clamp(Real value, Real lower, Real upper)
{
  return hn::Min(hn::Max(value, lower), upper);
}
HWY_INLINE Real select(Mask mask, Real yes, Real no)
{
  return hn::IfThenElse(mask, yes, no);
}
HWY_INLINE Real lerp(Real a, Real b, Real fraction)
{
  return hn::MulAdd(fraction, b - a, a);
}
/// 1/√x, and 0 where x is not positive. The processor's guess, twice refined after Newton: within
/// two units in the last place.
HWY_INLINE Real rsqrt_or_zero(Real x)
{
  // Outside of these bounds the guess may be infinite or 0.
  const Mask positive = x > real(1e-37f);
  const Real safe = hn::Min(hn::IfThenElse(positive, x, real(1.0f)), real(1e37f));
  const Real half = safe * real(0.5f);
  Real guess = hn::ApproximateReciprocalSqrt(safe);
  for (int i = 0; i < 2; ++i)
  {
    guess = guess * hn::NegMulAdd(half * guess, guess, real(1.5f));
  }
  return hn::IfThenElseZero(positive, guess);
}
/// x^exponent for x > 0.
HWY_INLINE Real pow(Real x, float exponent)
{
  const int whole = static_cast<int>(exponent >= 0.0f && exponent <= 128.0f ? exponent : 0.0f);
  if (static_cast<float>(whole) != exponent)
  {
    return hn::Exp(float_tag, real(exponent) * hn::Log(float_tag, x));
  }
  // By squares: the specular powers that people use are whole.
  Real result = real(1.0f);
  Real square = x;
  for (int bits = whole; bits > 0; bits >>= 1)
  {
    if (bits & 1)
    {
      result = result * square;
    }
    square = square * square;
  }
  return result;
}
/// 1 − exp(−x) for x ≥ 0, without cancellation (see opacity_from_optical_depth in optics.h).
HWY_INLINE Real opacity_from_optical_depth(Real x)
{
  // Below ½ the series x (1 − x/2! + x²/3! − …), cut where the next term is under 2⁻²⁴ of the sum.
  const Mask small = x < real(0.5f);
  Real sum = real(-1.0f / 40320.0f);
  sum = hn::MulAdd(sum, x, real(1.0f / 5040.0f));
  sum = hn::MulAdd(sum, x, real(-1.0f / 720.0f));
  sum = hn::MulAdd(sum, x, real(1.0f / 120.0f));
  sum = hn::MulAdd(sum, x, real(-1.0f / 24.0f));
  sum = hn::MulAdd(sum, x, real(1.0f / 6.0f));
  sum = hn::MulAdd(sum, x, real(-0.5f));
  sum = hn::MulAdd(sum, x, real(1.0f));
  const Real series = sum * x;
  if (HWY_LIKELY(hn::AllTrue(float_tag, small)))
  {
    return series;
  }
  return hn::IfThenElse(small, series, real(1.0f) - hn::Exp(float_tag, hn::Neg(x)));
}

/// (1 − exp(−x)) / x, the mean of exp(−x t) over t in [0, 1]; 1 at 0. By the same series for |x| < ½;
/// `exp_x` is exp(−x), needed elsewhere.
HWY_INLINE Real mean_transmittance(Real x, Real exp_x)
{
  const Mask small = hn::Abs(x) < real(0.5f);
  Real sum = real(-1.0f / 40320.0f);
  sum = hn::MulAdd(sum, x, real(1.0f / 5040.0f));
  sum = hn::MulAdd(sum, x, real(-1.0f / 720.0f));
  sum = hn::MulAdd(sum, x, real(1.0f / 120.0f));
  sum = hn::MulAdd(sum, x, real(-1.0f / 24.0f));
  sum = hn::MulAdd(sum, x, real(1.0f / 6.0f));
  sum = hn::MulAdd(sum, x, real(-0.5f));
  sum = hn::MulAdd(sum, x, real(1.0f));
  if (HWY_LIKELY(hn::AllTrue(float_tag, small)))
  {
    return sum;
  }
  const Real quotient = (real(1.0f) - exp_x) / hn::IfThenElse(small, real(1.0f), x);
  return hn::IfThenElse(small, sum, quotient);
}

template <class R>
struct Vec3
{
  R x, y, z;
};
template <class R>
HWY_INLINE Vec3<R> operator+(const Vec3<R>& a, const Vec3<R>& b)
{
  return { a.x + b.x, a.y + b.y, a.z + b.z };
}
template <class R>
HWY_INLINE Vec3<R> operator-(const Vec3<R>& a, const Vec3<R>& b)
{
  return { a.x - b.x, a.y - b.y, a.z - b.z };
}
template <class R>
HWY_INLINE Vec3<R> operator*(const Vec3<R>& a, const Vec3<R>& b)
{
  return { a.x * b.x, a.y * b.y, a.z * b.z };
}
template <class R>
HWY_INLINE Vec3<R> operator*(const Vec3<R>& a, R s)
{
  return { a.x * s, a.y * s, a.z * s };
}
template <class R>
HWY_INLINE Vec3<R> operator-(const Vec3<R>& a)
{
  return { hn::Neg(a.x), hn::Neg(a.y), hn::Neg(a.z) };
}
template <class R>
HWY_INLINE R dot(const Vec3<R>& a, const Vec3<R>& b)
{
  return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, a.z * b.z));
}
template <class R>
HWY_INLINE R broadcast(float value)
{
  return real(value);
}
template <class R>
HWY_INLINE R constant(double value)
{
  return real(static_cast<float>(value));
}
template <class R>
HWY_INLINE Vec3<R> broadcast3(const float* v)
{
  return { real(v[0]), real(v[1]), real(v[2]) };
}
/// The 3 × 3 part, row-major with `stride` columns, times v.
HWY_INLINE Vec3<Real> multiply(const float* m, int stride, const Vec3<Real>& v)
{
  return { dot(broadcast3<Real>(m), v), dot(broadcast3<Real>(m + stride), v),
    dot(broadcast3<Real>(m + 2 * stride), v) };
}

/// A row-major 3 × 4 matrix times the place v.
HWY_INLINE Vec3<Real> transform(const float* m, const Vec3<Real>& v)
{
  const Vec3<Real> turned = multiply(m, 4, v);
  return { turned.x + real(m[3]), turned.y + real(m[7]), turned.z + real(m[11]) };
}

/// A sum that keeps the digits a plain one would lose (Kahan, Further remarks on reducing
/// truncation errors, 1965). value() − lost() is right to about one unit in the last place.
struct Sum
{
  Real total;
  Real lost;

  // Constructors are written out: implicit ones would not be compiled for the SIMD target.
  HWY_INLINE Sum()
    : total(hn::Zero(float_tag))
    , lost(hn::Zero(float_tag))
  {
  }
  HWY_INLINE void add(Real term)
  {
    const Real corrected = term - lost;
    const Real next = total + corrected;
    lost = (next - total) - corrected;
    total = next;
  }
};

}
}
HWY_AFTER_NAMESPACE();

#endif
