// Clouds at one place: the kernels with packets of one lane.
#define BRUME_ONE_LANE
#include "data-generators/heap_cloud-inl.h"
#include "data-generators/layer_cloud-inl.h"

namespace brume
{

float heap_cloud_value(const HeapCloud& cloud, const glm::dvec3& place, double time)
{
  return one_lane::heap_cloud(
    cloud, { place.x, place.y, place.z }, one_lane::drift_of(cloud.wind, time));
}

float layer_cloud_value(const LayerCloud& cloud, const glm::dvec3& place, double time)
{
  return one_lane::layer_cloud(
    cloud, { place.x, place.y, place.z }, one_lane::drift_of(cloud.options.wind, time));
}

FieldRange HeapCloud::range_in(const Box& box) const
{
  constexpr FieldRange empty{ 0.0f, 0.0f };
  const Box unit{ box.lower / width, box.upper / width };
  const double lowest = std::max(empty_border, base - below_base);
  if (unit.upper.x < empty_border - 0.5 || unit.lower.x > 0.5 - empty_border ||
      unit.upper.y < empty_border - 0.5 || unit.lower.y > 0.5 - empty_border ||
      unit.upper.z < lowest || unit.lower.z > height - empty_border)
  {
    return empty;
  }
  return heap->most_in(unit) <= needed() ? empty : FieldRange{ 0.0f, 1.0f };
}

}
