// Noise, a packet at a time: the formulas of noise.h. Included once for each target (lanes-inl.h).
#if defined(BRUME_NOISE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BRUME_NOISE_INL_H
#undef BRUME_NOISE_INL_H
#else
#define BRUME_NOISE_INL_H
#endif

#include "data-generators/lanes-inl.h"
#include "data-generators/noise_field.h"
#include "data-generators/random.h"

BRUME_LANES_BEGIN

/// The largest values that gradient noise and simplex noise with these gradients can have; a test
/// searches for them.
constexpr float largest_perlin = 1.0363539f;
constexpr float largest_simplex = 0.0130072f;

constexpr std::uint32_t axis_factor[3] = { 0x8da6b343u, 0xd8163841u, 0xcb1ab31fu };

/// One coordinate of the places: the share of its lattice cell, and of those on either side, in the
/// hash (random.h, hash_lattice), and where in the cell it is.
struct CellAxis
{
  Bits before, at, after;
  Real fraction;
};

struct Cell
{
  CellAxis x, y, z;
  Yes valid; ///< finite, and not too far off to have a place within its cell
};

BRUME_LANES_INLINE CellAxis find_axis(Wide x, int axis, double period)
{
  const Wide whole = floor_of(x);
  CellAxis a;
  a.fraction = narrow(x - whole) + real(0.0f); // never -0
  const Bits factor = bits(axis_factor[axis]);
  if (period > 0.0)
  {
    const Bits cell = low_bits(whole - wide(period) * floor_of(whole / wide(period)));
    const std::uint32_t last = static_cast<std::uint32_t>(period) - 1u;
    a.at = times(cell, factor);
    a.before = select_equal(cell, bits(0), bits(last * axis_factor[axis]), a.at - factor);
    a.after = select_equal(cell, bits(last), bits(0), a.at + factor);
  }
  else
  {
    a.at = times(low_bits(whole), factor);
    a.before = a.at - factor;
    a.after = a.at + factor;
  }
  return a;
}

BRUME_LANES_INLINE Yes is_valid(const Place& p)
{
  const Real farthest = real(1e15f);
  return both(magnitude(narrow(p.x)) < farthest,
    both(magnitude(narrow(p.y)) < farthest, magnitude(narrow(p.z)) < farthest));
}

BRUME_LANES_INLINE Cell find_cell(const Place& p, const glm::dvec3& period)
{
  return { find_axis(p.x, 0, period.x),
    find_axis(p.y, 1, period.y),
    find_axis(p.z, 2, period.z),
    is_valid(p) };
}

BRUME_LANES_INLINE Bits mix_bits(Bits h)
{
  h = h ^ shift_right<16>(h);
  h = times(h, bits(0x7feb352du));
  h = h ^ shift_right<15>(h);
  h = times(h, bits(0x846ca68bu));
  return h ^ shift_right<16>(h);
}

BRUME_LANES_INLINE Real fade(Real t)
{
  return t * t * t * (t * (t * real(6.0f) - real(15.0f)) + real(10.0f));
}

/// The product of (x, y, z) with one of the 12 vectors to the middles of a cube's edges, by the
/// hash's upper four bits; four of them twice, as in Perlin's code: two of the coordinates, each
/// with a sign of its own.
BRUME_LANES_INLINE Real gradient(Bits hash, Real x, Real y, Real z)
{
  const Bits next = shift_left<1>(hash);
  const Real last = select_top(shift_left<2>(hash), z, x);
  const Real first = select_top(hash, select_top(next, last, y), x);
  const Real second = select_top(hash ^ next, z, y);
  return turn_sign(first, shift_left<3>(hash)) + turn_sign(second, shift_left<2>(hash));
}

BRUME_LANES_INLINE Real perlin_in(const Cell& c, std::uint32_t seed)
{
  const Bits key = bits(brume::mix_bits(seed ^ 0x5bd1e995u));
  const Real one = real(1.0f);
  const Real x = c.x.fraction, y = c.y.fraction, z = c.z.fraction;
  const Real u = fade(x), v = fade(y), w = fade(z);
  Real layer[2];
  for (int k = 0; k < 2; ++k)
  {
    const Real dz = k == 0 ? z : z - one;
    const Bits l = k == 0 ? c.z.at : c.z.after;
    const Bits near_row = c.y.at + l;
    const Bits far_row = c.y.after + l;
    const Real near = lerp(gradient(mix_bits((c.x.at + near_row) ^ key), x, y, dz),
      gradient(mix_bits((c.x.after + near_row) ^ key), x - one, y, dz),
      u);
    const Real far = lerp(gradient(mix_bits((c.x.at + far_row) ^ key), x, y - one, dz),
      gradient(mix_bits((c.x.after + far_row) ^ key), x - one, y - one, dz),
      u);
    layer[k] = lerp(near, far, v);
  }
  const Real value = lerp(layer[0], layer[1], w) / real(largest_perlin);
  const Real in_range = least(most(value, real(-1.0f)), one);
  return select(c.valid, in_range, real(0.0f));
}

BRUME_LANES_INLINE Real worley_in(const Cell& c, std::uint32_t seed)
{
  const Bits key = bits(brume::mix_bits(seed ^ 0x1b873593u));
  const CellAxis* axes[3] = { &c.x, &c.y, &c.z };
  // Squared distance from the place to the nearest plane of the cells on each side.
  Real gap[3][3];
  Bits share[3][3];
  for (int a = 0; a < 3; ++a)
  {
    const Real f = axes[a]->fraction;
    const Real rest = real(1.0f) - f;
    gap[a][0] = f * f;
    gap[a][1] = real(0.0f);
    gap[a][2] = rest * rest;
    share[a][0] = axes[a]->before;
    share[a][1] = axes[a]->at;
    share[a][2] = axes[a]->after;
  }
  Real nearest = real(1.0f);
  constexpr int order[3] = { 1, 0, 2 }; // the place's own cell first, so that most are skipped
  for (const int nk : order)
  {
    for (const int nj : order)
    {
      const Real plane = gap[2][nk] + gap[1][nj];
      if (!any(plane < nearest))
      {
        continue;
      }
      const Bits row = share[1][nj] + share[2][nk];
      for (const int ni : order)
      {
        const Yes reaches = plane + gap[0][ni] < nearest;
        if (!any(reaches))
        {
          continue;
        }
        const Bits h = mix_bits((share[0][ni] + row) ^ key);
        // Ten bits an axis, at the middle of each of 1024 steps.
        const auto offset = [](Bits ten, int n, Real fraction)
        {
          return real(static_cast<float>(n - 1)) +
                 (to_real(ten & bits(1023u)) + real(0.5f)) * real(1.0f / 1024.0f) - fraction;
        };
        const Real dx = offset(h, ni, c.x.fraction);
        const Real dy = offset(shift_right<10>(h), nj, c.y.fraction);
        const Real dz = offset(shift_right<20>(h), nk, c.z.fraction);
        const Real square = dx * dx + dy * dy + dz * dz;
        nearest = select(reaches, least(nearest, square), nearest);
      }
    }
  }
  return select(c.valid, root(nearest), real(0.0f));
}

BRUME_LANES_INLINE Real simplex(const Place& p, std::uint32_t seed)
{
  const Bits key = bits(brume::mix_bits(seed ^ 0x2c1b3c6du));
  // Skewed so that the simplices become cubes cut in six.
  const Wide skew = (p.x + p.y + p.z) * wide(1.0 / 3.0);
  const Wide i = floor_of(p.x + skew), j = floor_of(p.y + skew), k = floor_of(p.z + skew);
  const Wide back = (i + j + k) * wide(1.0 / 6.0);
  const Real x = narrow(p.x - (i - back)), y = narrow(p.y - (j - back)),
             z = narrow(p.z - (k - back));
  const Real one = real(1.0f), zero = real(0.0f);
  // Which of the six: the order of the coordinates. The second corner has the largest raised, the
  // third has all but the smallest.
  const Yes xy = y <= x, yz = z <= y, xz = z <= x;
  const Real x1 = select(both(xy, xz), one, zero);
  const Real y1 = select(xy, zero, select(yz, one, zero));
  const Real z1 = one - x1 - y1;
  const Real x2 = select(xy, one, select(xz, one, zero));
  const Real z2 = select(xz, select(yz, zero, one), one);
  const Real y2 = real(2.0f) - x2 - z2;
  const Bits a = times(low_bits(i), bits(axis_factor[0]));
  const Bits b = times(low_bits(j), bits(axis_factor[1]));
  const Bits c = times(low_bits(k), bits(axis_factor[2]));
  const auto corner = [&](Real u, Real v, Real w, float out)
  {
    const Real dx = x - u + real(out), dy = y - v + real(out), dz = z - w + real(out);
    Real t = most(real(0.5f) - (dx * dx + dy * dy + dz * dz), zero);
    t = t * t;
    const Bits h = mix_bits(
      (a + times(to_bits(u), bits(axis_factor[0])) + b + times(to_bits(v), bits(axis_factor[1])) +
        c + times(to_bits(w), bits(axis_factor[2]))) ^
      key);
    return t * t * gradient(h, dx, dy, dz);
  };
  const Real sum = corner(zero, zero, zero, 0.0f) + corner(x1, y1, z1, 1.0f / 6.0f) +
                   corner(x2, y2, z2, 1.0f / 3.0f) + corner(one, one, one, 0.5f);
  const Real value = least(most(sum * real(1.0f / largest_simplex), real(-1.0f)), one);
  return select(is_valid(p), value, zero);
}

/// The frequency of an octave along an axis, and its period in cells: where the noise is to tile,
/// the frequency is the nearest that has a whole number of cells in a period.
struct OctaveScale
{
  glm::dvec3 frequency, period;
};

inline OctaveScale scale_of(double frequency, const glm::ivec3& period)
{
  OctaveScale s{ glm::dvec3(frequency), glm::dvec3(0.0) };
  for (int axis = 0; axis < 3; ++axis)
  {
    if (period[axis] > 0)
    {
      const double cells = std::max(1.0, std::floor(period[axis] * frequency + 0.5));
      s.period[axis] = cells < 2147483648.0 ? cells : 0.0;
      s.frequency[axis] = cells / period[axis];
    }
  }
  return s;
}

BRUME_LANES_INLINE Place scaled(const Place& p, const glm::dvec3& f)
{
  return { p.x * wide(f.x), p.y * wide(f.y), p.z * wide(f.z) };
}

enum class Octave
{
  Perlin,
  Billow,
  Simplex
};

template <Octave kind>
BRUME_LANES_INLINE Real sum_octaves(const Place& p,
  std::uint32_t seed,
  const NoiseOctaves& octaves,
  const glm::ivec3& period)
{
  double frequency = 1.0, amplitude = 1.0, weight = 0.0;
  Wide sum = wide(0.0);
  const int count = std::min(octaves.count, 24);
  for (int octave = 0; octave < count; ++octave)
  {
    const std::uint32_t own = substream(seed, static_cast<std::uint32_t>(octave));
    Real value;
    if constexpr (kind == Octave::Simplex)
    {
      value = simplex(scaled(p, glm::dvec3(frequency)), own);
    }
    else
    {
      const OctaveScale s = scale_of(frequency, period);
      const Cell cell = find_cell(scaled(p, s.frequency), s.period);
      if constexpr (kind == Octave::Perlin)
      {
        value = perlin_in(cell, own);
      }
      else
      {
        value = select(cell.valid, real(1.0f) - worley_in(cell, own), real(0.0f));
      }
    }
    sum = sum + wide(amplitude) * widen(value);
    weight += amplitude;
    frequency *= octaves.lacunarity;
    amplitude *= octaves.gain;
  }
  return weight > 0.0 ? narrow(sum / wide(weight)) : real(0.0f);
}

BRUME_LANES_INLINE Real perlin_worley(const Place& p,
  std::uint32_t seed,
  const NoiseOctaves& octaves,
  const glm::ivec3& period)
{
  const Real gradients =
    real(0.5f) + real(0.5f) * sum_octaves<Octave::Perlin>(p, substream(seed, 0), octaves, period);
  const Real billows = sum_octaves<Octave::Billow>(p, substream(seed, 1), octaves, period);
  return billows + gradients * (real(1.0f) - billows);
}

/// The place moved by three noises of one cell.
BRUME_LANES_INLINE Place
warp(const Place& p, double scale, double amplitude, std::uint32_t seed, const glm::ivec3& period)
{
  if (!(scale > 0.0) || amplitude == 0.0)
  {
    return p;
  }
  Cell cell;
  if (period.x > 0 || period.y > 0 || period.z > 0)
  {
    const OctaveScale s = scale_of(1.0 / scale, period);
    cell = find_cell(scaled(p, s.frequency), s.period);
  }
  else
  {
    const Wide size = wide(scale);
    cell = find_cell({ p.x / size, p.y / size, p.z / size }, glm::dvec3(0.0));
  }
  const Wide reach = wide(amplitude);
  return { p.x + reach * widen(perlin_in(cell, substream(seed, 0))),
    p.y + reach * widen(perlin_in(cell, substream(seed, 1))),
    p.z + reach * widen(perlin_in(cell, substream(seed, 2))) };
}

/// What a NoiseField gives.
BRUME_LANES_INLINE Real noise_of(const NoiseOptions& o, Place p)
{
  const Wide size = wide(o.feature_size);
  p = { p.x / size, p.y / size, p.z / size };
  p = warp(p, o.warp_size, o.warp_amplitude, substream(o.seed, 77), o.period);
  switch (o.kind)
  {
    case NoiseKind::Perlin:
      return sum_octaves<Octave::Perlin>(p, o.seed, o.octaves, o.period);
    case NoiseKind::Worley:
      return sum_octaves<Octave::Billow>(p, o.seed, o.octaves, o.period);
    case NoiseKind::Simplex:
      return sum_octaves<Octave::Simplex>(p, o.seed, o.octaves, o.period);
    case NoiseKind::PerlinWorley:
      return perlin_worley(p, o.seed, o.octaves, o.period);
  }
  return real(0.0f);
}

BRUME_LANES_END

#endif
