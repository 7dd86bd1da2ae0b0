// The vocabulary of the generators' kernels: a packet of numbers, of as many lanes as the SIMD
// target at hand has, or of one lane of plain C++ where BRUME_ONE_LANE is defined. A kernel is
// written once, in these words, and compiled for each target and for one lane: every operation here
// is rounded as IEEE 754 says and none is contracted with another, so all of them give the same
// bits.
//
// Included once for each target (Highway's foreach_target). A kernel's text stands between
// BRUME_LANES_BEGIN and BRUME_LANES_END.
#if defined(BRUME_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BRUME_LANES_INL_H
#undef BRUME_LANES_INL_H
#else
#define BRUME_LANES_INL_H
#endif

#include "data-generators/field.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

#ifdef BRUME_ONE_LANE
#define BRUME_LANES_INLINE inline
#define BRUME_LANES_BEGIN                                                                          \
  namespace brume                                                                                  \
  {                                                                                                \
  namespace one_lane                                                                               \
  {
#define BRUME_LANES_END                                                                            \
  }                                                                                                \
  }
#else
#include <hwy/highway.h>
#define BRUME_LANES_INLINE HWY_INLINE
#undef BRUME_LANES_BEGIN
#undef BRUME_LANES_END
#define BRUME_LANES_BEGIN                                                                          \
  HWY_BEFORE_NAMESPACE();                                                                          \
  namespace brume                                                                                  \
  {                                                                                                \
  namespace HWY_NAMESPACE                                                                          \
  {
#define BRUME_LANES_END                                                                            \
  }                                                                                                \
  }                                                                                                \
  HWY_AFTER_NAMESPACE();
#endif

BRUME_LANES_BEGIN

#undef BRUME_LANES_PLAIN
#ifdef BRUME_ONE_LANE
#define BRUME_LANES_PLAIN 1
#elif HWY_TARGET == HWY_SCALAR // the target of processors without SIMD is one lane, too
#define BRUME_LANES_PLAIN 1
#else
#define BRUME_LANES_PLAIN 0
#endif

#if BRUME_LANES_PLAIN

using Real = float;
using Wide = double; ///< as many lanes, in double precision
using Bits = std::uint32_t;
using Yes = bool;
constexpr int lane_count = 1;

inline Real real(float x)
{
  return x;
}
inline Wide wide(double x)
{
  return x;
}
inline Bits bits(std::uint32_t x)
{
  return x;
}

inline Real least(Real a, Real b)
{
  return a < b ? a : b;
}
inline Real most(Real a, Real b)
{
  return a > b ? a : b;
}
inline Real root(Real a)
{
  return std::sqrt(a);
}
inline Real magnitude(Real a)
{
  return std::fabs(a);
}
inline Real select(Yes yes, Real a, Real b)
{
  return yes ? a : b;
}
inline Yes both(Yes a, Yes b)
{
  return a && b;
}
inline bool any(Yes a)
{
  return a;
}
/// The largest whole number not above x, |x| < 2^31.
inline Real floor_of(Real x)
{
  const Real whole = static_cast<Real>(static_cast<std::int32_t>(x));
  return whole - (x < whole ? 1.0f : 0.0f);
}

inline Wide floor_of(Wide x)
{
  if (!(std::fabs(x) < 4503599627370496.0))
  {
    return x;
  }
  const Wide whole = static_cast<Wide>(static_cast<std::int64_t>(x));
  return whole - (x < whole ? 1.0 : 0.0);
}
inline Real narrow(Wide x)
{
  return static_cast<Real>(x);
}
inline Wide widen(Real x)
{
  return static_cast<Wide>(x);
}
/// A whole number, |x| < 2^51, modulo 2^32.
inline Bits low_bits(Wide whole)
{
  const Wide shifted = whole + 6755399441055744.0;
  std::uint64_t all;
  std::memcpy(&all, &shifted, sizeof all);
  return static_cast<Bits>(all);
}

inline Bits times(Bits a, Bits b)
{
  return a * b;
}
template <int n>
inline Bits shift_right(Bits a)
{
  return a >> n;
}
template <int n>
inline Bits shift_left(Bits a)
{
  return a << n;
}
inline Bits select_equal(Bits a, Bits b, Bits yes, Bits no)
{
  return a == b ? yes : no;
}
inline Yes is_equal(Bits a, Bits b)
{
  return a == b;
}
/// The sign of each number turned where bit 31 is set.
inline Real turn_sign(Real x, Bits sign)
{
  std::uint32_t raw;
  std::memcpy(&raw, &x, sizeof raw);
  raw ^= sign & 0x80000000u;
  std::memcpy(&x, &raw, sizeof x);
  return x;
}
/// a where bit 31 is set, else b.
inline Real select_top(Bits top, Real a, Real b)
{
  return top >> 31 ? a : b;
}
/// Bits below 2^31 as numbers, and back (towards zero).
inline Real to_real(Bits a)
{
  return static_cast<Real>(static_cast<std::int32_t>(a));
}
inline Bits to_bits(Real a)
{
  return static_cast<Bits>(static_cast<std::int32_t>(a));
}

/// The number whose IEEE bits these are.
inline Real from_raw(Bits raw)
{
  Real x;
  std::memcpy(&x, &raw, sizeof x);
  return x;
}

inline Wide load_wide(const double* from)
{
  return *from;
}
inline Real load_real(const float* from)
{
  return *from;
}
inline void store(Bits a, std::uint32_t* to)
{
  *to = a;
}
inline void store(Real a, float* to)
{
  *to = a;
}
inline Real gather(const float* table, Bits index)
{
  return table[index];
}

#else

namespace hn = hwy::HWY_NAMESPACE;

using RealTag = hn::ScalableTag<float>;
using BitsTag = hn::RebindToUnsigned<RealTag>;
using WholeTag = hn::RebindToSigned<RealTag>;
using WideTag = hn::ScalableTag<double>;
using WideBitsTag = hn::RebindToUnsigned<WideTag>;
using HalfTag = hn::Rebind<float, WideTag>;
using HalfBitsTag = hn::Rebind<std::uint32_t, WideTag>;
using Real = hn::Vec<RealTag>;
using Bits = hn::Vec<BitsTag>;
using Yes = hn::Mask<RealTag>;

constexpr int lane_count = HWY_LANES(float);
static_assert(HWY_LANES(double) * 2 == lane_count, "a packet of floats is two of doubles");

struct Wide
{
  hn::Vec<WideTag> lower, upper;
};

HWY_INLINE Real real(float x)
{
  return hn::Set(RealTag(), x);
}
HWY_INLINE Wide wide(double x)
{
  const auto all = hn::Set(WideTag(), x);
  return { all, all };
}
HWY_INLINE Bits bits(std::uint32_t x)
{
  return hn::Set(BitsTag(), x);
}

HWY_INLINE Real least(Real a, Real b)
{
  return hn::Min(a, b);
}
HWY_INLINE Real most(Real a, Real b)
{
  return hn::Max(a, b);
}
HWY_INLINE Real root(Real a)
{
  return hn::Sqrt(a);
}
HWY_INLINE Real magnitude(Real a)
{
  return hn::Abs(a);
}
HWY_INLINE Real select(Yes yes, Real a, Real b)
{
  return hn::IfThenElse(yes, a, b);
}
HWY_INLINE Yes both(Yes a, Yes b)
{
  return hn::And(a, b);
}
HWY_INLINE bool any(Yes a)
{
  return !hn::AllFalse(RealTag(), a);
}
HWY_INLINE Real floor_of(Real x)
{
  return hn::Floor(x);
}

HWY_INLINE Wide operator+(Wide a, Wide b)
{
  return { hn::Add(a.lower, b.lower), hn::Add(a.upper, b.upper) };
}
HWY_INLINE Wide operator-(Wide a, Wide b)
{
  return { hn::Sub(a.lower, b.lower), hn::Sub(a.upper, b.upper) };
}
HWY_INLINE Wide operator*(Wide a, Wide b)
{
  return { hn::Mul(a.lower, b.lower), hn::Mul(a.upper, b.upper) };
}
HWY_INLINE Wide operator/(Wide a, Wide b)
{
  return { hn::Div(a.lower, b.lower), hn::Div(a.upper, b.upper) };
}
HWY_INLINE Wide floor_of(Wide x)
{
  return { hn::Floor(x.lower), hn::Floor(x.upper) };
}
HWY_INLINE Real narrow(Wide x)
{
  return hn::Combine(RealTag(), hn::DemoteTo(HalfTag(), x.upper), hn::DemoteTo(HalfTag(), x.lower));
}
HWY_INLINE Wide widen(Real x)
{
  return { hn::PromoteTo(WideTag(), hn::LowerHalf(HalfTag(), x)),
    hn::PromoteTo(WideTag(), hn::UpperHalf(HalfTag(), x)) };
}
HWY_INLINE Bits low_bits(Wide whole)
{
  const Wide shifted = whole + wide(6755399441055744.0);
  return hn::Combine(BitsTag(),
    hn::TruncateTo(HalfBitsTag(), hn::BitCast(WideBitsTag(), shifted.upper)),
    hn::TruncateTo(HalfBitsTag(), hn::BitCast(WideBitsTag(), shifted.lower)));
}

HWY_INLINE Bits times(Bits a, Bits b)
{
  return hn::Mul(a, b);
}
template <int n>
HWY_INLINE Bits shift_right(Bits a)
{
  return hn::ShiftRight<n>(a);
}
template <int n>
HWY_INLINE Bits shift_left(Bits a)
{
  return hn::ShiftLeft<n>(a);
}
HWY_INLINE Bits select_equal(Bits a, Bits b, Bits yes, Bits no)
{
  return hn::IfThenElse(hn::Eq(a, b), yes, no);
}
HWY_INLINE Yes is_equal(Bits a, Bits b)
{
  return hn::RebindMask(RealTag(), hn::Eq(a, b));
}
HWY_INLINE Real turn_sign(Real x, Bits sign)
{
  return hn::BitCast(
    RealTag(), hn::Xor(hn::BitCast(BitsTag(), x), hn::And(sign, hn::Set(BitsTag(), 0x80000000u))));
}
HWY_INLINE Real select_top(Bits top, Real a, Real b)
{
#if HWY_TARGET == HWY_SSSE3 // has no blend by the sign alone, which Highway 1.0 forgets
  return hn::IfThenElse(
    hn::MaskFromVec(hn::BitCast(RealTag(), hn::BroadcastSignBit(hn::BitCast(WholeTag(), top)))),
    a,
    b);
#else
  return hn::IfNegativeThenElse(hn::BitCast(RealTag(), top), a, b);
#endif
}
HWY_INLINE Real to_real(Bits a)
{
  return hn::ConvertTo(RealTag(), hn::BitCast(WholeTag(), a));
}
HWY_INLINE Bits to_bits(Real a)
{
  return hn::BitCast(BitsTag(), hn::ConvertTo(WholeTag(), a));
}

HWY_INLINE Real from_raw(Bits raw)
{
  return hn::BitCast(RealTag(), raw);
}

HWY_INLINE Wide load_wide(const double* from)
{
  return { hn::LoadU(WideTag(), from), hn::LoadU(WideTag(), from + lane_count / 2) };
}
HWY_INLINE Real load_real(const float* from)
{
  return hn::LoadU(RealTag(), from);
}
HWY_INLINE void store(Bits a, std::uint32_t* to)
{
  hn::StoreU(a, BitsTag(), to);
}
HWY_INLINE void store(Real a, float* to)
{
  hn::StoreU(a, RealTag(), to);
}
HWY_INLINE Real gather(const float* table, Bits index)
{
  return hn::GatherIndex(RealTag(), table, hn::BitCast(WholeTag(), index));
}

#endif

/// A packet's places.
struct Place
{
  Wide x, y, z;
};

BRUME_LANES_INLINE Real lerp(Real a, Real b, Real t)
{
  return a + t * (b - a);
}
/// x held to [0, 1].
BRUME_LANES_INLINE Real held(Real x)
{
  return least(most(x, real(0.0f)), real(1.0f));
}
/// 0 at `from` and before, 1 at `from + 1 / slope` and beyond, straight between.
BRUME_LANES_INLINE Real straight(Real x, float from, float slope)
{
  return held((x - real(from)) * real(slope));
}
/// 3 t^2 - 2 t^3 for t in [0, 1].
BRUME_LANES_INLINE Real smooth(Real t)
{
  return t * t * (real(3.0f) - real(2.0f) * t);
}

/// e^x for x in [-80, 0], within 3e-7 of it; lower x counts as -80, higher as 0. x = (n + f) ln 2
/// with f in [0, 1), and the series of e^(f ln 2).
BRUME_LANES_INLINE Real decay(Real x)
{
  const Real t = least(most(x, real(-80.0f)), real(0.0f)) * real(1.44269504f);
  const Real whole = floor_of(t);
  const Real f = (t - whole) * real(0.693147181f);
  Real sum = real(1.0f / 5040.0f);
  sum = sum * f + real(1.0f / 720.0f);
  sum = sum * f + real(1.0f / 120.0f);
  sum = sum * f + real(1.0f / 24.0f);
  sum = sum * f + real(1.0f / 6.0f);
  sum = sum * f + real(0.5f);
  sum = sum * f + real(1.0f);
  sum = sum * f + real(1.0f);
  return sum * from_raw(shift_left<23>(to_bits(whole + real(127.0f))));
}

/// Calls `kernel(place, box)`, which gives a Real, for all places of a block, a packet at a time,
/// and writes what it gives. `box` holds the packet's places. The lanes of the last packet that are
/// left over repeat a place.
template <class Kernel>
BRUME_LANES_INLINE void for_each_packet(const PlaceBlock& places, float* out, const Kernel& kernel)
{
  const std::size_t total = places.size();
  constexpr int stack_room = 64;
  double room[stack_room];
  std::vector<double> more;
  double* xs = room;
  if (places.count.x > stack_room)
  {
    more.resize(places.count.x);
    xs = more.data();
  }
  for (int i = 0; i < places.count.x; ++i)
  {
    xs[i] = places.origin.x + (places.first.x + i) * places.spacing.x;
  }
  int i = 0, j = 0, k = 0;
  double y = 0.0, z = 0.0;
  const auto enter_row = [&]
  {
    y = places.origin.y + (places.first.y + j) * places.spacing.y;
    z = places.origin.z + (places.first.z + k) * places.spacing.z;
  };
  const auto next_row = [&]
  {
    i = 0;
    if (++j == places.count.y)
    {
      j = 0;
      ++k;
    }
    enter_row();
  };
  enter_row();
  for (std::size_t done = 0; done < total; done += lane_count)
  {
    if (i + lane_count <= places.count.x) // all of them in one row
    {
      const double a = xs[i], b = xs[i + lane_count - 1];
      const Box box{ { std::min(a, b), y, z }, { std::max(a, b), y, z } };
      store(kernel(Place{ load_wide(xs + i), wide(y), wide(z) }, box), out + done);
      i += lane_count;
      if (i == places.count.x)
      {
        next_row();
      }
      continue;
    }
    const int used = static_cast<int>(std::min<std::size_t>(lane_count, total - done));
    double px[lane_count], py[lane_count], pz[lane_count];
    Box box{ { xs[i], y, z }, { xs[i], y, z } };
    for (int lane = 0; lane < lane_count; ++lane)
    {
      if (lane >= used)
      {
        px[lane] = px[lane - 1];
        py[lane] = py[lane - 1];
        pz[lane] = pz[lane - 1];
        continue;
      }
      px[lane] = xs[i];
      py[lane] = y;
      pz[lane] = z;
      box.lower = {
        std::min(box.lower.x, xs[i]), std::min(box.lower.y, y), std::min(box.lower.z, z)
      };
      box.upper = {
        std::max(box.upper.x, xs[i]), std::max(box.upper.y, y), std::max(box.upper.z, z)
      };
      if (++i == places.count.x)
      {
        next_row();
      }
    }
    const Real values = kernel(Place{ load_wide(px), load_wide(py), load_wide(pz) }, box);
    float last[lane_count];
    store(values, last);
    std::copy(last, last + used, out + done);
  }
}

BRUME_LANES_END

#endif
