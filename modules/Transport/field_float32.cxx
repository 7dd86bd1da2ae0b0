// Reading grids of float, for every SIMD target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "Transport/field_float32.cxx"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "Transport/dense_field-inl.h"

HWY_BEFORE_NAMESPACE();
namespace brume
{
namespace HWY_NAMESPACE
{
FieldFunctions field_float32(const FieldView&)
{
  return field_with_pairs<float, 0>();
}
}
}
HWY_AFTER_NAMESPACE();
