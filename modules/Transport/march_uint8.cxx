// The march over grids of std::uint8_t, for every SIMD target.
#include "Transport/march_task.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "Transport/march_uint8.cxx"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "Transport/march-inl.h"

HWY_BEFORE_NAMESPACE();
namespace brume
{
namespace HWY_NAMESPACE
{
MarchCount march_uint8_target(const MarchTask& task)
{
  return march_grid<std::uint8_t, 1>(task);
}
}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace brume
{
HWY_EXPORT(march_uint8_target);
MarchCount march_uint8(const MarchTask& task)
{
  return HWY_DYNAMIC_DISPATCH(march_uint8_target)(task);
}
}
#endif
