#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "optics_packets.cxx"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "optics_packets.h"

#include "Transport/lit-inl.h"

#include <cstring>

HWY_BEFORE_NAMESPACE();
namespace brume
{
namespace HWY_NAMESPACE
{

/// One formula over whole vectors; what is beyond the last whole packet is padded with ones.
void optics_target(optics_packets::Formula formula,
  const PhaseModel* model,
  const LitVolume* medium,
  const float* const* in,
  int inputs,
  std::size_t count,
  float* out)
{
  for (std::size_t i = 0; i < count; i += lane_count)
  {
    const std::size_t here = std::min<std::size_t>(lane_count, count - i);
    HWY_ALIGN float lanes[4][lane_count];
    Real v[4];
    for (int k = 0; k < 4; ++k)
    {
      for (std::size_t lane = 0; lane < static_cast<std::size_t>(lane_count); ++lane)
      {
        lanes[k][lane] = k < inputs && lane < here ? in[k][i + lane] : 1.0f;
      }
      v[k] = hn::Load(float_tag, lanes[k]);
    }
    Real result = hn::Zero(float_tag);
    switch (formula)
    {
      case optics_packets::Formula::Opacity:
        result = opacity_from_optical_depth(v[0]);
        break;
      case optics_packets::Formula::MeanTransmittance:
        result = mean_transmittance_of(v[0]);
        break;
      case optics_packets::Formula::Phase:
        result = phase<Real>(*model, v[0], v[1]);
        break;
      case optics_packets::Formula::ExponentialIntegral:
        result = second_exponential_integral(v[0]);
        break;
      case optics_packets::Formula::FogColumn:
        result = fog_column<Real>(v[0], v[1], v[2], v[3]);
        break;
      case optics_packets::Formula::PowderFactor:
        result = powder_of(*medium, v[0], v[1]);
        break;
      case optics_packets::Formula::BlackBodyRed:
        result = black_body_of(*medium, v[0]).x;
        break;
      case optics_packets::Formula::ReciprocalRoot:
        result = rsqrt_or_zero(v[0]);
        break;
    }
    HWY_ALIGN float results[lane_count];
    hn::Store(result, float_tag, results);
    std::memcpy(out + i, results, here * sizeof(float));
  }
}

}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace brume
{
HWY_EXPORT(optics_target);
}

namespace optics_packets
{

using namespace brume;
namespace
{
Numbers run(Formula formula,
  const std::vector<const Numbers*>& inputs,
  const PhaseModel* model = nullptr,
  const LitVolume* medium = nullptr)
{
  std::vector<const float*> in;
  for (const Numbers* each : inputs)
  {
    in.push_back(each->data());
  }
  Numbers out(inputs[0]->size());
  HWY_DYNAMIC_DISPATCH(optics_target)
  (formula, model, medium, in.data(), static_cast<int>(in.size()), out.size(), out.data());
  return out;
}
}

Numbers opacity(const Numbers& optical_depth)
{
  return run(Formula::Opacity, { &optical_depth });
}
Numbers mean_transmittance(const Numbers& x)
{
  return run(Formula::MeanTransmittance, { &x });
}
Numbers phase(const PhaseModel& model,
  const Numbers& one_minus_cosine,
  const Numbers& one_plus_cosine)
{
  return run(Formula::Phase, { &one_minus_cosine, &one_plus_cosine }, &model);
}
Numbers second_exponential_integral(const Numbers& x)
{
  return run(Formula::ExponentialIntegral, { &x });
}
Numbers fog_column(const Numbers& begin,
  const Numbers& end,
  const Numbers& fall,
  const Numbers& length)
{
  return run(Formula::FogColumn, { &begin, &end, &fall, &length });
}
Numbers powder(const Powder& powder, const Numbers& value, const Numbers& height)
{
  LitVolume medium;
  medium.powder = powder.enabled;
  medium.powder_form = powder.form;
  medium.powder_strength = static_cast<float>(powder.strength);
  medium.powder_scale = static_cast<float>(powder.scale);
  return run(Formula::PowderFactor, { &value, &height }, nullptr, &medium);
}
Numbers black_body(const BlackBodyTable& table, const Numbers& kelvin)
{
  LitVolume medium;
  medium.black_body = &table;
  return run(Formula::BlackBodyRed, { &kelvin }, nullptr, &medium);
}
Numbers reciprocal_square_root(const Numbers& x)
{
  return run(Formula::ReciprocalRoot, { &x });
}

}
#endif
