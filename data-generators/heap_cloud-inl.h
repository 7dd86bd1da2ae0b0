// The kernel of heap_cloud.h. Included once for each target (lanes-inl.h).
#if defined(BRUME_HEAP_CLOUD_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BRUME_HEAP_CLOUD_INL_H
#undef BRUME_HEAP_CLOUD_INL_H
#else
#define BRUME_HEAP_CLOUD_INL_H
#endif

#include "data-generators/heap_cloud.h"
#include "data-generators/noise-inl.h"

BRUME_LANES_BEGIN

/// The heap at places that were moved after their cells were found.
class HeapAt
{
public:
  /// Finds the cells, of places in widths.
  BRUME_LANES_INLINE HeapAt(const PuffHeap& heap, Real x, Real y, Real z)
    : m_heap(heap)
  {
    const Real place[3] = { x, y, z };
    const glm::ivec3& cells = heap.cells();
    Real cell[3];
    for (int a = 0; a < 3; ++a)
    {
      cell[a] = floor_of(least(most((place[a] - real(static_cast<float>(heap.lower()[a]))) *
                                      real(static_cast<float>(heap.cells_by_length()[a])),
                                 real(0.0f)),
        real(static_cast<float>(cells[a] - 1))));
    }
    const Real row = real(static_cast<float>(cells.x)), layer = real(static_cast<float>(cells.y));
    m_cells = to_bits((cell[2] * layer + cell[1]) * row + cell[0]); // below 2^24: exact
    std::uint32_t all[lane_count];
    store(m_cells, all);
    for (int lane = 0; lane < lane_count; ++lane)
    {
      if (heap.begin()[all[lane]] != heap.begin()[all[lane] + 1] &&
          std::find(m_distinct, m_distinct + m_count, all[lane]) == m_distinct + m_count)
      {
        m_distinct[m_count++] = all[lane];
      }
    }
  }

  BRUME_LANES_INLINE bool empty() const { return m_count == 0; }

  BRUME_LANES_INLINE Real at(Real x, Real y, Real z) const
  {
    const Real one = real(1.0f), zero = real(0.0f);
    Real result = zero;
    for (int c = 0; c < m_count; ++c)
    {
      const std::uint32_t* at = m_heap.lists() + m_heap.begin()[m_distinct[c]];
      const std::uint32_t* end = m_heap.lists() + m_heap.begin()[m_distinct[c] + 1];
      Real rest = one;
      for (; at != end; ++at)
      {
        const float* p = m_heap.puffs() + *at;
        const Real dx = (x - real(p[0])) * real(p[3]);
        const Real dy = (y - real(p[1])) * real(p[4]);
        const Real dz = (z - real(p[2])) * real(p[5]);
        const Real f = most(one - (dx * dx + dy * dy + dz * dz), zero);
        rest = rest * (one - f * f);
      }
      result = select(is_equal(m_cells, bits(m_distinct[c])), one - rest, result);
    }
    return result;
  }

private:
  const PuffHeap& m_heap;
  Bits m_cells;
  std::uint32_t m_distinct[lane_count];
  int m_count = 0;
};

/// Half gradient fBm, half billows (four octaves at most), its middle stretched over [0, 1]:
/// billow_fbm() and fbm() with the lattice cells of each octave found once.
BRUME_LANES_INLINE Real cloud_noise(const Place& at, std::uint32_t seed, int octaves)
{
  const std::uint32_t billow_seed = substream(seed, 2), gradient_seed = substream(seed, 3);
  Wide billows = wide(0.0), gradients = wide(0.0);
  double frequency = 1.0, amplitude = 1.0, billow_weight = 0.0, gradient_weight = 0.0;
  for (int octave = 0; octave < octaves; ++octave)
  {
    const auto stream = static_cast<std::uint32_t>(octave);
    const Cell cell = find_cell(scaled(at, glm::dvec3(frequency)), glm::dvec3(0.0));
    if (octave < 4)
    {
      const Real billow = select(
        cell.valid, real(1.0f) - worley_in(cell, substream(billow_seed, stream)), real(0.0f));
      billows = billows + wide(amplitude) * widen(billow);
      billow_weight += amplitude;
    }
    gradients =
      gradients + wide(amplitude) * widen(perlin_in(cell, substream(gradient_seed, stream)));
    gradient_weight += amplitude;
    frequency *= 2.0;
    amplitude *= 0.5;
  }
  const Real sum =
    real(0.5f) * (narrow(billows / wide(billow_weight)) +
                   (real(0.5f) + real(0.5f) * narrow(gradients / wide(gradient_weight))));
  return straight(sum, 0.33f, 1.0f / 0.3f);
}

BRUME_LANES_INLINE Real heap_cloud(const HeapCloud& c, const Place& p, const glm::dvec3& drift)
{
  const Real zero = real(0.0f), half = real(0.5f);
  const Wide by_width = wide(1.0 / c.width);
  const Real x = narrow(p.x * by_width), y = narrow(p.y * by_width), z = narrow(p.z * by_width);

  // Distance to the nearest face, and the height over the base: nothing outside, nothing below.
  const Real sx = half - magnitude(x), sy = half - magnitude(y);
  const Real sz = least(z, real(static_cast<float>(c.height)) - z);
  const Real border = real(static_cast<float>(c.empty_border));
  const float lowest = static_cast<float>(c.base - c.below_base);
  const Yes within = both(both(border < sx, border < sy), both(border < sz, real(lowest) < z));
  if (!any(within))
  {
    return zero;
  }
  const HeapAt heap(*c.heap, x, y, z);
  if (heap.empty())
  {
    return zero;
  }

  const Place still{ p.x - wide(drift.x), p.y - wide(drift.y), p.z - wide(drift.z) };
  const Place moved =
    warp(still, c.warp_size, c.warp_amplitude, substream(c.seed, 1), NoisePeriod(0));
  const Real h = heap.at(narrow((moved.x + wide(drift.x)) * by_width),
    narrow((moved.y + wide(drift.y)) * by_width),
    narrow((moved.z + wide(drift.z)) * by_width));
  const Yes filled = both(within, real(static_cast<float>(c.needed())) < h);
  if (!any(filled))
  {
    return zero;
  }

  const Wide by_detail = wide(1.0 / c.detail_size);
  const Place at{ moved.x * by_detail, moved.y * by_detail, moved.z * by_detail };
  Real noise = cloud_noise(at, c.seed, c.octaves);
  Real crispness = real(static_cast<float>(c.crispness));
  if (c.ice < c.height)
  {
    // Ice: the noise of long fibres, and an edge that fades.
    const Real ice = smooth(straight(z, static_cast<float>(c.ice), 12.0f));
    if (any(zero < ice))
    {
      const Place fibres{ at.x * wide(0.3), at.y * wide(0.75), at.z * wide(0.9) };
      const Real soft =
        half + half * sum_octaves<Octave::Perlin>(
                        fibres, substream(c.seed, 4), { c.octaves, 2.0, 0.5 }, NoisePeriod(0));
      noise = lerp(noise, straight(soft, 0.33f, 3.0f), ice);
      crispness = crispness * (real(1.0f) - real(0.6f) * ice);
    }
  }
  const Real body =
    held(crispness * (h * (real(0.8f) * noise + real(static_cast<float>(c.offset))) -
                       real(static_cast<float>(HeapCloud::threshold))));
  const Real base =
    smooth(held((z - real(lowest) - real(static_cast<float>(c.below_base)) * noise) *
                real(static_cast<float>(1.0 / (1.5 * c.below_base)))));
  const Real inside = least(least(sx, sy), sz);
  const Real fade = smooth(straight(inside,
    static_cast<float>(c.empty_border),
    static_cast<float>(1.0 / (c.border_fade - c.empty_border))));
  return select(filled, body * base * fade, zero);
}

/// How far the wind has carried the noise; a time that is not finite counts as 0.
inline glm::dvec3 drift_of(const glm::dvec3& wind, double time)
{
  return std::isfinite(time) ? wind * time : glm::dvec3(0.0);
}

BRUME_LANES_END

#endif
