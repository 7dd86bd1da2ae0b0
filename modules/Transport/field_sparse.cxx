// Reading sparse grids of every type, for every SIMD target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "Transport/field_sparse.cxx"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "Transport/sparse_field-inl.h"

HWY_BEFORE_NAMESPACE();
namespace brume
{
namespace HWY_NAMESPACE
{
FieldFunctions field_sparse(const FieldView& view)
{
  switch (view.type)
  {
    case VoxelType::UInt8:
      return sparse_functions<std::uint8_t>();
    case VoxelType::Int8:
      return sparse_functions<std::int8_t>();
    case VoxelType::UInt16:
      return sparse_functions<std::uint16_t>();
    case VoxelType::Int16:
      return sparse_functions<std::int16_t>();
    case VoxelType::Float32:
      return sparse_functions<float>();
    case VoxelType::Float16:
      return sparse_functions<Half>();
  }
  return {};
}
}
}
HWY_AFTER_NAMESPACE();
