// Fog at many places, for every SIMD target.
#include "data-generators/fog_bank.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "data-generators/fog_packets.cxx"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "data-generators/fog_bank-inl.h"

BRUME_LANES_BEGIN

void fog_target(const FogKernel& kernel, const PlaceBlock& places, double time, float* out)
{
  const glm::dvec3 drift = drift_of(kernel.options.wind, time);
  for_each_packet(places, out, [&](const Place& p, const Box&) { return fog(kernel, p, drift); });
}

BRUME_LANES_END

#if HWY_ONCE
namespace brume
{
HWY_EXPORT(fog_target);
void fog_packets(const FogKernel& kernel, const PlaceBlock& places, double time, float* out)
{
  HWY_DYNAMIC_DISPATCH(fog_target)(kernel, places, time, out);
}
}
#endif
