#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "phase_packets.cxx"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "phase_packets.h"

#include "Transport/packet-inl.h"

HWY_BEFORE_NAMESPACE();
namespace brume
{
namespace HWY_NAMESPACE
{

#include "Transport/phase-inl.h"
#include "Transport/exponential_integral-inl.h"

void packet_e2_target(const float* x, std::size_t count, float* result)
{
  for (std::size_t i = 0; i < count; i += lane_count)
  {
    hn::StoreU(second_exponential_integral(hn::LoadU(float_tag, x + i)), float_tag, result + i);
  }
}

void packet_phase_target(const PhaseModel& model,
  const float* one_minus_cosine,
  const float* one_plus_cosine,
  std::size_t count,
  float* result)
{
  for (std::size_t i = 0; i < count; i += lane_count)
  {
    const Real value = phase<Real>(
      model, hn::LoadU(float_tag, one_minus_cosine + i), hn::LoadU(float_tag, one_plus_cosine + i));
    hn::StoreU(value, float_tag, result + i);
  }
}

}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace brume
{
HWY_EXPORT(packet_phase_target);
HWY_EXPORT(packet_e2_target);
}

void packet_phase(const brume::PhaseModel& model,
  const float* one_minus_cosine,
  const float* one_plus_cosine,
  std::size_t count,
  float* result)
{
  using namespace brume;
  HWY_DYNAMIC_DISPATCH(packet_phase_target)
  (model, one_minus_cosine, one_plus_cosine, count, result);
}

void packet_second_exponential_integral(const float* x, std::size_t count, float* result)
{
  using namespace brume;
  HWY_DYNAMIC_DISPATCH(packet_e2_target)(x, count, result);
}
#endif
