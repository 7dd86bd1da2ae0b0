// One grid of densities, lit: for every SIMD target.
#include "Transport/march_task.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "Transport/march_lit_density.cxx"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "Transport/lit-inl.h"

HWY_BEFORE_NAMESPACE();
namespace brume
{
namespace HWY_NAMESPACE
{

MarchCount march_lit_density_target(const MarchTask& task)
{
  return march_lit<true>(task);
}

}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace brume
{
HWY_EXPORT(march_lit_density_target);
MarchCount march_lit_density(const MarchTask& task)
{
  return HWY_DYNAMIC_DISPATCH(march_lit_density_target)(task);
}
}
#endif
