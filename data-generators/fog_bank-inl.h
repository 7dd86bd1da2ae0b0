// The kernel of fog_bank.h. Included once for each target (lanes-inl.h).
#if defined(BRUME_FOG_BANK_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BRUME_FOG_BANK_INL_H
#undef BRUME_FOG_BANK_INL_H
#else
#define BRUME_FOG_BANK_INL_H
#endif

#include "data-generators/fog_bank.h"
#include "data-generators/heap_cloud-inl.h"
#include "data-generators/height_map-inl.h"

BRUME_LANES_BEGIN

BRUME_LANES_INLINE Real fog(const FogKernel& f, const Place& p, const glm::dvec3& drift)
{
  const FogOptions& o = f.options;
  const NoisePeriod never(0);
  const Real zero = real(0.0f), one = real(1.0f);
  const Real half_width = real(static_cast<float>(0.5 * o.width));
  const Real z = narrow(p.z - wide(f.box.lower.z));
  const Real ceiling = real(static_cast<float>(f.box.upper.z - f.box.lower.z));
  const Yes within =
    both(both(magnitude(narrow(p.x)) <= half_width, magnitude(narrow(p.y)) <= half_width),
      both(zero <= z, z <= ceiling));
  if (!any(within))
  {
    return zero;
  }
  if (o.kind == FogKind::Homogeneous)
  {
    return select(within, one, zero);
  }

  const Wide by_detail = wide(1.0 / o.detail_size), tall = wide(3.0), wider = wide(0.3);
  const Place at{ (p.x - wide(drift.x)) * by_detail,
    (p.y - wide(drift.y)) * by_detail,
    (p.z - wide(drift.z)) * by_detail * tall };
  const Real amount = real(static_cast<float>(o.noise));
  Real body;
  if (o.kind == FogKind::Valley)
  {
    // The fog ends where it meets the ground: that is known before any noise is.
    const Real depth_of_ground = narrow(p.z - wide(f.level)) - (ground_at(*f.ground, p.x, p.y) -
                                                                 real(static_cast<float>(f.level)));
    const Yes above = both(within, real(static_cast<float>(-o.sink)) < depth_of_ground);
    if (!any(above))
    {
      return zero;
    }
    const Real wave = sum_octaves<Octave::Perlin>(
      { at.x * wider, at.y * wider, wide(0.63) }, substream(o.seed, 31), { 3, 2.0, 0.5 }, never);
    const Real softness = real(static_cast<float>(o.softness));
    const Real depth = amount * softness * wave - narrow(p.z - wide(f.level));
    body = select(above, smooth(held(depth / softness)), zero);
  }
  else
  {
    const Real wave = sum_octaves<Octave::Perlin>(
      { at.x * wider, at.y * wider, wide(0.63) }, substream(o.seed, 31), { 3, 2.0, 0.5 }, never);
    const Real scale = real(static_cast<float>(o.scale_height));
    const Real height = most(z - amount * real(0.5f) * scale * wave, zero);
    body = decay(zero - height / scale);
  }
  if (!any(zero < body) || o.noise == 0.0)
  {
    return select(within, body, zero);
  }
  const Real noise = cloud_noise(at, o.seed, o.octaves);
  return select(within, body * (one - amount * (one - noise)), zero);
}

BRUME_LANES_END

#endif
