// Every row of a grid goes through here once or twice: the widest instructions keep up with memory.
#include "Transport/row_ranges.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "Transport/row_ranges.cxx"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <limits>
#include <type_traits>

HWY_BEFORE_NAMESPACE();
namespace brume
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

template <class T>
HWY_INLINE bool widen(const T* row, std::size_t count, T* lower, T* upper)
{
  const hn::ScalableTag<T> tag;
  const std::size_t lanes = hn::Lanes(tag);
  std::size_t i = 0;
  if constexpr (std::is_floating_point_v<T>)
  {
    const auto largest = hn::Set(tag, std::numeric_limits<T>::max());
    bool all_finite = true;
    auto finite = hn::Eq(largest, largest);
    for (; i + lanes <= count; i += lanes)
    {
      const auto value = hn::LoadU(tag, row + i);
      const auto low = hn::LoadU(tag, lower + i);
      const auto high = hn::LoadU(tag, upper + i);
      // A NaN fails the comparison, too.
      const auto good = hn::Le(hn::Abs(value), largest);
      finite = hn::And(finite, good);
      hn::StoreU(hn::Min(low, hn::IfThenElse(good, value, low)), tag, lower + i);
      hn::StoreU(hn::Max(high, hn::IfThenElse(good, value, high)), tag, upper + i);
    }
    all_finite = hn::AllTrue(tag, finite);
    for (; i < count; ++i)
    {
      const T value = row[i];
      const T size = value < 0 ? -value : value;
      const bool good = size <= std::numeric_limits<T>::max();
      all_finite = all_finite && good;
      lower[i] = good && value < lower[i] ? value : lower[i];
      upper[i] = good && value > upper[i] ? value : upper[i];
    }
    return all_finite;
  }
  else
  {
    for (; i + lanes <= count; i += lanes)
    {
      const auto value = hn::LoadU(tag, row + i);
      hn::StoreU(hn::Min(hn::LoadU(tag, lower + i), value), tag, lower + i);
      hn::StoreU(hn::Max(hn::LoadU(tag, upper + i), value), tag, upper + i);
    }
    for (; i < count; ++i)
    {
      lower[i] = row[i] < lower[i] ? row[i] : lower[i];
      upper[i] = row[i] > upper[i] ? row[i] : upper[i];
    }
    return true;
  }
}

bool widen_uint8(const std::uint8_t* row, std::size_t n, std::uint8_t* lower, std::uint8_t* upper)
{
  return widen(row, n, lower, upper);
}
bool widen_int8(const std::int8_t* row, std::size_t n, std::int8_t* lower, std::int8_t* upper)
{
  return widen(row, n, lower, upper);
}
bool widen_uint16(const std::uint16_t* row,
  std::size_t n,
  std::uint16_t* lower,
  std::uint16_t* upper)
{
  return widen(row, n, lower, upper);
}
bool widen_int16(const std::int16_t* row, std::size_t n, std::int16_t* lower, std::int16_t* upper)
{
  return widen(row, n, lower, upper);
}
bool widen_float32(const float* row, std::size_t n, float* lower, float* upper)
{
  return widen(row, n, lower, upper);
}

}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace brume
{

HWY_EXPORT(widen_uint8);
HWY_EXPORT(widen_int8);
HWY_EXPORT(widen_uint16);
HWY_EXPORT(widen_int16);
HWY_EXPORT(widen_float32);

bool widen_ranges(const std::uint8_t* row, std::size_t n, std::uint8_t* lower, std::uint8_t* upper)
{
  return HWY_DYNAMIC_DISPATCH(widen_uint8)(row, n, lower, upper);
}
bool widen_ranges(const std::int8_t* row, std::size_t n, std::int8_t* lower, std::int8_t* upper)
{
  return HWY_DYNAMIC_DISPATCH(widen_int8)(row, n, lower, upper);
}
bool widen_ranges(const std::uint16_t* row,
  std::size_t n,
  std::uint16_t* lower,
  std::uint16_t* upper)
{
  return HWY_DYNAMIC_DISPATCH(widen_uint16)(row, n, lower, upper);
}
bool widen_ranges(const std::int16_t* row, std::size_t n, std::int16_t* lower, std::int16_t* upper)
{
  return HWY_DYNAMIC_DISPATCH(widen_int16)(row, n, lower, upper);
}
bool widen_ranges(const float* row, std::size_t n, float* lower, float* upper)
{
  return HWY_DYNAMIC_DISPATCH(widen_float32)(row, n, lower, upper);
}

}
#endif
