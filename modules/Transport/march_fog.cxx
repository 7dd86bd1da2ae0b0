// Any volumes in fog: for every SIMD target.
#include "Transport/march_task.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "Transport/march_fog.cxx"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "Transport/lit-inl.h"

HWY_BEFORE_NAMESPACE();
namespace brume
{
namespace HWY_NAMESPACE
{

MarchCount march_fog_target(const MarchTask& task)
{
  return task.lit->chromatic ? march_tile<LitIntegrator<false, true, true, true>>(task)
                             : march_tile<LitIntegrator<false, false, true, true>>(task);
}

}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace brume
{
HWY_EXPORT(march_fog_target);
MarchCount march_fog(const MarchTask& task)
{
  return HWY_DYNAMIC_DISPATCH(march_fog_target)(task);
}
}
#endif
