// The kernel of layer_cloud.h. Included once for each target (lanes-inl.h).
#if defined(BRUME_LAYER_CLOUD_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BRUME_LAYER_CLOUD_INL_H
#undef BRUME_LAYER_CLOUD_INL_H
#else
#define BRUME_LAYER_CLOUD_INL_H
#endif

#include "data-generators/heap_cloud-inl.h"
#include "data-generators/layer_cloud.h"

BRUME_LANES_BEGIN

/// Where there is cloud: larger inside. x and y are metres along the wind and across it.
BRUME_LANES_INLINE Real cover_noise(const LayerCloud& c, Wide x, Wide y)
{
  const NoisePeriod never(0);
  const std::uint32_t seed = substream(c.options.seed, 10);
  const Wide by_size = wide(1.0 / c.cover_size);
  const Wide u = x * by_size, v = y * by_size;
  const Wide level = wide(0.37);
  if (c.options.kind == CloudKind::Stratocumulus)
  {
    // Cells that bulge, of two sizes, grouped by a wider noise.
    const Real cells = sum_octaves<Octave::Billow>({ u, v, level }, seed, { 2, 2.1, 0.4 }, never);
    const Wide wider = wide(0.3);
    const Real groups = sum_octaves<Octave::Perlin>(
      { u * wider, v * wider, level }, substream(seed, 1), { 3, 2.0, 0.5 }, never);
    return cells + real(0.45f) * groups;
  }
  if (c.options.kind == CloudKind::Cirrus)
  {
    return sum_octaves<Octave::Perlin>({ u * wide(0.35), v, level }, seed, { 3, 2.0, 0.5 }, never);
  }
  return sum_octaves<Octave::Perlin>({ u, v, level }, seed, { 4, 2.0, 0.5 }, never);
}

BRUME_LANES_INLINE Real layer_cloud(const LayerCloud& c, const Place& p, const glm::dvec3& drift)
{
  const CloudOptions& o = c.options;
  const NoisePeriod never(0);
  const Real zero = real(0.0f), one = real(1.0f), half = real(0.5f);

  // Height in the layer, 0 at the base, 1 at the top; distance from the sides, in half widths.
  const Real h = narrow((p.z - wide(o.base)) * wide(1.0 / c.height));
  const Wide by_half = wide(2.0 / o.width);
  const Real side = one - most(magnitude(narrow(p.x * by_half)), magnitude(narrow(p.y * by_half)));
  const Yes within = both(real(static_cast<float>(c.empty_border)) < side,
    both(real(static_cast<float>(-0.5 * LayerCloud::empty_above)) < h,
      both(h < real(static_cast<float>(1.0 + 0.5 * LayerCloud::empty_above)), is_valid(p))));
  if (!any(within))
  {
    return zero;
  }

  const Place still{ p.x - wide(drift.x), p.y - wide(drift.y), p.z - wide(drift.z) };
  const Place moved = warp(still, o.warp_size, o.warp_amplitude, substream(o.seed, 1), never);
  const Wide ax = wide(c.along_x), ay = wide(c.along_y);
  Wide u = moved.x * ax + moved.y * ay;
  const Wide v = moved.y * ax - moved.x * ay;
  if (o.kind == CloudKind::Cirrus)
  {
    // Ice that falls out of the faster wind above lags behind.
    const Wide fallen = widen(held(one - h));
    u = u + fallen * fallen * wide(2.5 * c.height);
  }

  // Toward the box's sides the clouds get fewer and thinner.
  const Real fade = smooth(straight(side,
    static_cast<float>(c.empty_border),
    static_cast<float>(1.0 / (c.border_fade - c.empty_border))));
  const Real cover =
    cover_noise(c, u, v) - real(static_cast<float>(c.cover_threshold)) - real(0.6f) * (one - fade);
  const Yes covered = both(within, zero < cover);
  if (!any(covered))
  {
    return zero;
  }

  const Wide by_detail = wide(1.0 / o.detail_size);
  const Real offset = real(static_cast<float>(o.offset));
  const Real crispness = real(static_cast<float>(o.crispness));
  Real density;
  if (o.kind == CloudKind::Cirrus)
  {
    const Place at{ u * by_detail * wide(0.11), v * by_detail, moved.z * by_detail * wide(0.4) };
    const Real g =
      sum_octaves<Octave::Perlin>(at, substream(o.seed, 12), { o.octaves, 2.0, 0.6 }, never);
    const Real ridge = held(one - real(2.6f) * magnitude(g));
    // Dense heads above, thin tails below.
    const Real body = smooth(held((one - h) * real(5.0f))) * smooth(held(h * real(1.6f)));
    const Real f = held(cover * real(3.0f)) * body * ridge * ridge;
    density = held(crispness * (f * (real(0.8f) * half + offset) - real(0.05f)));
  }
  else
  {
    const Real noise = cloud_noise(
      { moved.x * by_detail, moved.y * by_detail, moved.z * by_detail }, o.seed, o.octaves);
    Real f;
    if (o.kind == CloudKind::Stratocumulus)
    {
      // Each cell is a low dome on a flat base.
      const Real top = real(0.45f) + real(0.55f) * held(cover * real(2.4f));
      const Real q = h / top;
      f = held(cover * real(6.0f)) * smooth(held(h * real(8.0f) + real(0.5f) * noise)) *
          held(one - q * q * q * q);
    }
    else
    {
      // A sheet with a ragged base and a top in long waves.
      const Place waves{ u * wide(0.4 / c.cover_size), v * wide(1.0 / c.cover_size), wide(0.71) };
      const Real wave = half + half * sum_octaves<Octave::Perlin>(
                                        waves, substream(o.seed, 13), { 3, 2.0, 0.5 }, never);
      const Real top = real(0.7f) + real(0.3f) * wave;
      const Real base = real(0.25f) * (one - wave) * noise;
      f = held(cover * real(2.5f)) * smooth(held((h - base) * real(4.0f))) *
          smooth(held((top - h) * real(3.0f)));
    }
    density = held(crispness * (f * (real(0.8f) * noise + offset) -
                                 real(static_cast<float>(HeapCloud::threshold))));
  }
  const Real ends =
    held((one + real(static_cast<float>(0.5 * LayerCloud::empty_above)) - h) * real(20.0f)) *
    held((h + real(static_cast<float>(0.5 * LayerCloud::empty_above))) * real(20.0f));
  return select(covered, density * ends, zero);
}

BRUME_LANES_END

#endif
