// The march over grids of std::uint16_t, for every SIMD target.
#include "Transport/march_task.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "Transport/march_uint16.cxx"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "Transport/march-inl.h"

HWY_BEFORE_NAMESPACE();
namespace brume
{
namespace HWY_NAMESPACE
{
MarchCount march_uint16_target(const MarchTask& task)
{
  return march_grid<std::uint16_t, 1>(task);
}
}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace brume
{
HWY_EXPORT(march_uint16_target);
MarchCount march_uint16(const MarchTask& task)
{
  return HWY_DYNAMIC_DISPATCH(march_uint16_target)(task);
}
}
#endif
