// Noise at many places, for every SIMD target.
#include "data-generators/noise_packets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "data-generators/noise_packets.cxx"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "data-generators/noise-inl.h"

BRUME_LANES_BEGIN

void noise_packets_target(const NoiseOptions& options, const PlaceBlock& places, float* out)
{
  for_each_packet(places,
    out,
    [&options](const Place& p, const Box&)
    { return select(is_valid(p), noise_of(options, p), real(0.0f)); });
}

BRUME_LANES_END

#if HWY_ONCE
namespace brume
{
HWY_EXPORT(noise_packets_target);
void noise_packets(const NoiseOptions& options, const PlaceBlock& places, float* out)
{
  HWY_DYNAMIC_DISPATCH(noise_packets_target)(options, places, out);
}
}
#endif
