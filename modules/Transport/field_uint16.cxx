// Reading grids of std::uint16_t, for every SIMD target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "Transport/field_uint16.cxx"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "Transport/dense_field-inl.h"

HWY_BEFORE_NAMESPACE();
namespace brume
{
namespace HWY_NAMESPACE
{
FieldFunctions field_uint16(const FieldView& view)
{
  return view.stride[0] == 2 ? field_with_pairs<std::uint16_t, 16>()
                             : field_with_pairs<std::uint16_t, 0>();
}
}
}
HWY_AFTER_NAMESPACE();
