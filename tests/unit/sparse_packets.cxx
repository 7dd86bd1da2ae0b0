#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sparse_packets.cxx"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sparse_packets.h"

#include "Transport/field-inl.h"

HWY_BEFORE_NAMESPACE();
namespace brume
{
namespace HWY_NAMESPACE
{

/// Coordinates one axis after the other, `count` of each, a multiple of 16.
void packet_values_target(const FieldView& view,
  const float* places,
  std::size_t count,
  float* result)
{
  const FieldFunctions field = field_functions(view);
  for (std::size_t i = 0; i < count; i += lane_count)
  {
    Line line;
    line.begin = { hn::LoadU(float_tag, places + i),
      hn::LoadU(float_tag, places + count + i),
      hn::LoadU(float_tag, places + 2 * count + i) };
    line.delta = { hn::Zero(float_tag), hn::Zero(float_tag), hn::Zero(float_tag) };
    const Real position = hn::Zero(float_tag);
    Real value;
    field.values(view, line, &position, 1, &value);
    hn::StoreU(value, float_tag, result + i);
  }
}

}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace brume
{
HWY_EXPORT(packet_values_target);
}

std::vector<float> packet_values(const brume::SparseVoxels& voxels,
  const std::vector<glm::vec3>& places)
{
  using namespace brume;
  const std::size_t count = (places.size() + 15) / 16 * 16;
  std::vector<float> coordinates(3 * count, 1.0f);
  for (std::size_t i = 0; i < places.size(); ++i)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      coordinates[axis * count + i] = places[i][axis];
    }
  }
  std::vector<float> result(count);
  const FieldView view = view_field(voxels.grid(), 0, false, 0.0f);
  HWY_DYNAMIC_DISPATCH(packet_values_target)(view, coordinates.data(), count, result.data());
  result.resize(places.size());
  return result;
}
#endif
