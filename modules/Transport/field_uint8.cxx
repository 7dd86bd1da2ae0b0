// Reading grids of std::uint8_t, for every SIMD target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "Transport/field_uint8.cxx"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "Transport/dense_field-inl.h"

HWY_BEFORE_NAMESPACE();
namespace brume
{
namespace HWY_NAMESPACE
{
FieldFunctions field_uint8(const FieldView& view)
{
  switch (view.stride[0])
  {
    case 1:
      return field_with_pairs<std::uint8_t, 8>();
    case 2:
      return field_with_pairs<std::uint8_t, 16>();
    case 3:
      return field_with_pairs<std::uint8_t, 24>();
    default:
      return field_with_pairs<std::uint8_t, 0>();
  }
}
}
}
HWY_AFTER_NAMESPACE();
