// Clouds at many places, for every SIMD target.
#include "data-generators/heap_cloud.h"
#include "data-generators/layer_cloud.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "data-generators/cloud_packets.cxx"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "data-generators/heap_cloud-inl.h"
#include "data-generators/layer_cloud-inl.h"

BRUME_LANES_BEGIN

void heap_cloud_target(const HeapCloud& cloud, const PlaceBlock& places, double time, float* out)
{
  const glm::dvec3 drift = drift_of(cloud.wind, time);
  for_each_packet(
    places, out, [&](const Place& p, const Box&) { return heap_cloud(cloud, p, drift); });
}

void layer_cloud_target(const LayerCloud& cloud, const PlaceBlock& places, double time, float* out)
{
  const glm::dvec3 drift = drift_of(cloud.options.wind, time);
  for_each_packet(
    places, out, [&](const Place& p, const Box&) { return layer_cloud(cloud, p, drift); });
}

BRUME_LANES_END

#if HWY_ONCE
namespace brume
{
HWY_EXPORT(heap_cloud_target);
void heap_cloud_packets(const HeapCloud& cloud, const PlaceBlock& places, double time, float* out)
{
  HWY_DYNAMIC_DISPATCH(heap_cloud_target)(cloud, places, time, out);
}
HWY_EXPORT(layer_cloud_target);
void layer_cloud_packets(const LayerCloud& cloud, const PlaceBlock& places, double time, float* out)
{
  HWY_DYNAMIC_DISPATCH(layer_cloud_target)(cloud, places, time, out);
}
}
#endif
