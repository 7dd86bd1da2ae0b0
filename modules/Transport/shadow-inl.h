// How deep places lie in matter as their lights see them: shadow rays, light volumes, functions of
// depth. Included once for each SIMD target.
#if defined(BRUME_SHADOW_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BRUME_SHADOW_INL_H
#undef BRUME_SHADOW_INL_H
#else
#define BRUME_SHADOW_INL_H
#endif

#include "Transport/cells-inl.h"
#include "Transport/leap-inl.h"
#include "Transport/lit_task.h"
#include "Transport/matter-inl.h"

#include <hwy/aligned_allocator.h>

#include <algorithm>

HWY_BEFORE_NAMESPACE();
namespace brume
{
namespace HWY_NAMESPACE
{

/// An array of packets whose length is known when it is made.
class PacketArray
{
public:
  explicit PacketArray(std::size_t count = 0)
    : Lanes(hwy::AllocateAligned<float>((count ? count : 1) * lane_count))
  {
  }
  HWY_INLINE Real get(std::size_t i) const
  {
    return hn::Load(float_tag, Lanes.get() + i * lane_count);
  }
  HWY_INLINE void set(std::size_t i, Real value)
  {
    hn::Store(value, float_tag, Lanes.get() + i * lane_count);
  }
  HWY_INLINE void set(std::size_t i, const Vec3<Real>& value)
  {
    set(i, value.x);
    set(i + 1, value.y);
    set(i + 2, value.z);
  }
  HWY_INLINE Vec3<Real> get3(std::size_t i) const { return { get(i), get(i + 1), get(i + 2) }; }

private:
  hwy::AlignedFreeUniquePtr<float[]> Lanes;
};

/// Optical depths along straight ways through all volumes.
class DepthRays
{
public:
  DepthRays(const std::vector<VolumeTask>& volumes, const LitTask& lit)
    : Lit(lit)
  {
    for (const VolumeTask& volume : volumes)
    {
      Volumes.emplace_back(volume, 1.0);
    }
    if (lit.by_cells)
    {
      Functions = field_functions(volumes[0].field);
    }
  }

  /// Straight ways from places on, as each volume has them. Positions along them are in units of the
  /// way that was given.
  struct Ways
  {
    Line lines[most_volumes];
    Real begin[most_volumes]; ///< where the volume draws something, in positions
    Real end[most_volumes];
    Real length[most_volumes]; ///< of a unit, in the volume's data
    Real first;                ///< where the first volume begins and the last ends
    Real last;
    Mask any;
  };

  /// From places of the first volume's index space along `way`, from `from` to `to` times of it.
  void find_ways(const Vec3<Real>& place,
    const Vec3<Real>& way,
    Real from,
    Real to,
    Mask active,
    Ways& ways) const
  {
    Real first = real(3e38f);
    Real last = real(-3e38f);
    const int count = static_cast<int>(Volumes.size());
    for (int k = 0; k < count; ++k)
    {
      const LitFrame& frame = Lit.frames[k];
      ways.lines[k] = frame.is_first
        ? Line{ place, way }
        : Line{ transform(frame.from_first, place), multiply(frame.from_first, 4, way) };
      const Vec3<Real> data = multiply(frame.data_from_index, 3, ways.lines[k].delta);
      ways.length[k] = hn::Sqrt(dot(data, data));
      ways.begin[k] = from;
      ways.end[k] = to;
      cut(frame, ways.lines[k], ways.begin[k], ways.end[k]);
      const Mask some = hn::And(active, ways.begin[k] < ways.end[k]);
      first = hn::IfThenElse(some, hn::Min(first, ways.begin[k]), first);
      last = hn::IfThenElse(some, max(last, ways.end[k]), last);
    }
    ways.any = first < last;
    ways.first = hn::IfThenElseZero(ways.any, first);
    ways.last = hn::IfThenElseZero(ways.any, last);
  }

  /// Adds the optical depth between two positions, looked up in the middle: one in x where there is
  /// one map, those of R, G and B where there are three. Returns the number of samples.
  HWY_INLINE std::uint64_t
  add(const Ways& ways, Real from, Real to, Mask active, Vec3<Real>& result) const
  {
    std::uint64_t samples = 0;
    const Real zero = hn::Zero(float_tag);
    Vec3<Real> sum{ zero, zero, zero };
    Vec3<Real> squares = sum;
    for (std::size_t k = 0; k < Volumes.size(); ++k)
    {
      const Real low = max(from, ways.begin[k]);
      const Real high = hn::Min(to, ways.end[k]);
      Mask here = hn::And(active, low < high);
      if (hn::AllFalse(float_tag, here))
      {
        continue;
      }
      const Real middle = (low + high) * real(0.5f);
      if (Lit.frames[k].cropped)
      {
        here = hn::And(here, is_drawn(Lit.frames[k], ways.lines[k].at(middle)));
      }
      Matter matter;
      Volumes[k].look(ways.lines[k], middle, (high - low) * ways.length[k], here, matter);
      samples += hn::CountTrue(float_tag, here);
      const Real depth = hn::IfThenElseZero(here, matter.depth);
      const Vec3<Real> part = Lit.maps == 1 ? Vec3<Real>{ depth, zero, zero }
                                            : broadcast3<Real>(Lit.volumes[k].channels) * depth;
      sum = sum + part;
      squares = squares + part * part;
    }
    if (Lit.components)
    {
      sum = { mixed(sum.x, squares.x), mixed(sum.y, squares.y), mixed(sum.z, squares.z) };
    }
    result = result + sum;
    return samples;
  }

  /// The optical depth of a whole way. Returns the number of samples.
  std::uint64_t depth(const Vec3<Real>& place,
    const Vec3<Real>& way,
    Real to,
    Mask active,
    Vec3<Real>& result) const
  {
    const Real zero = hn::Zero(float_tag);
    result = { zero, zero, zero };
    Ways ways;
    find_ways(place, way, zero, to, active, ways);
    if (hn::AllFalse(float_tag, ways.any))
    {
      return 0;
    }
    return Lit.by_cells ? by_cells(ways, result) : by_steps(ways, result);
  }

  /// Mixture::Components: of depths that add up to Σ the sum of squares over Σ is taken.
  static HWY_INLINE Real mixed(Real sum, Real squares)
  {
    const Mask some = sum > real(1e-18f); // squares of less are nothing
    return hn::IfThenElse(some, squares / hn::IfThenElse(some, sum, real(1.0f)), sum);
  }

private:
  /// Cuts [begin, end] to what a volume draws, but for its odder regions of cropping.
  static HWY_INLINE void cut(const LitFrame& frame, const Line& line, Real& begin, Real& end)
  {
    const Real* p[3] = { &line.begin.x, &line.begin.y, &line.begin.z };
    const Real* d[3] = { &line.delta.x, &line.delta.y, &line.delta.z };
    // Slopes below this are rounding: the way is along the face.
    const Real still = real(1e-6f) *
      max(hn::Abs(line.delta.x), max(hn::Abs(line.delta.y), hn::Abs(line.delta.z)));
    for (int axis = 0; axis < 3; ++axis)
    {
      const Real least = real(-frame.rounding[axis]);
      cut_half_space(*p[axis] - real(frame.lower[axis]), *d[axis], still, least, begin, end);
      cut_half_space(
        real(frame.upper[axis]) - *p[axis], hn::Neg(*d[axis]), still, least, begin, end);
    }
    for (const glm::vec4& plane : frame.planes) // their normals have the length 1
    {
      const float normal[3] = { plane.x, plane.y, plane.z };
      const Vec3<Real> n = broadcast3<Real>(normal);
      const Real least =
        real(-std::max({ frame.rounding[0], frame.rounding[1], frame.rounding[2] }));
      cut_half_space(
        dot(n, line.begin) + real(plane.w), dot(n, line.delta), still, least, begin, end);
    }
  }
  /// To where height + slope · t ≥ 0; of a way that keeps its height, all of it from `least` on.
  static HWY_INLINE void cut_half_space(
    Real height, Real slope, Real least_slope, Real least, Real& begin, Real& end)
  {
    const Real zero = hn::Zero(float_tag);
    const Mask still = hn::Abs(slope) <= least_slope;
    const Real at = hn::Neg(height) / hn::IfThenElse(still, real(1.0f), slope);
    begin = hn::IfThenElse(hn::AndNot(still, slope > zero), max(begin, at), begin);
    end = hn::IfThenElse(hn::AndNot(still, slope < zero), hn::Min(end, at), end);
    end = hn::IfThenElse(hn::And(still, height < least), begin, end);
  }

  std::uint64_t by_steps(const Ways& ways, Vec3<Real>& result) const
  {
    constexpr float most_steps = 65536.0f;
    const Real zero = hn::Zero(float_tag);
    const Real one = real(1.0f);
    const Real whole = (ways.last - ways.first) * ways.length[0];
    const Real steps = hn::IfThenElseZero(ways.any,
      clamp(hn::Ceil(whole * real(0.999999f / Lit.shadow_step)), one, real(most_steps)));
    const Real step = (ways.last - ways.first) / max(steps, one);
    // In steps, for leaping.
    const Line line{ ways.lines[0].at(ways.first), ways.lines[0].delta * step };
    const Leaper leaper(Volumes.size() == 1 ? Volumes[0].volume().bricks : nullptr, line);
    Real at = zero;
    Real stop = steps;
    std::uint64_t samples = 0;
    for (int i = 0;; ++i)
    {
      const Mask active = at < stop;
      if (hn::AllFalse(float_tag, active))
      {
        return samples;
      }
      if (leaper.leaps() && i % samples_between_leaps == 0)
      {
        const Real way = leaper.way(at + real(0.5f));
        const Mask leaping = hn::And(active, way > zero);
        if (!hn::AllFalse(float_tag, leaping))
        {
          at = at + hn::IfThenElseZero(leaping, hn::Floor(way) + one);
          i = -1;
          continue;
        }
      }
      samples += add(ways, hn::MulAdd(at, step, ways.first),
        hn::MulAdd(at + one, step, ways.first), active, result);
      at = at + one;
      stop = hn::IfThenZeroElse(shallowest(result) > real(Lit.deep_enough), stop);
    }
  }

  /// The least depth of the channels that anything dims.
  HWY_INLINE Real shallowest(const Vec3<Real>& depth) const
  {
    if (Lit.maps == 1)
    {
      return depth.x;
    }
    const Real far = real(3e38f);
    return hn::Min(Lit.has_channel[0] ? depth.x : far,
      hn::Min(Lit.has_channel[1] ? depth.y : far, Lit.has_channel[2] ? depth.z : far));
  }

  /// Whether the region of cropping that a place lies in is drawn.
  static HWY_INLINE Mask is_drawn(const LitFrame& frame, const Vec3<Real>& place)
  {
    const Real* p[3] = { &place.x, &place.y, &place.z };
    Int number = hn::Zero(int_tag);
    for (int axis = 2; axis >= 0; --axis)
    {
      const Mask beyond_low = *p[axis] >= real(frame.crop_lower[axis]);
      const Mask beyond_high = *p[axis] > real(frame.crop_upper[axis]);
      number = number * integer(3) +
        hn::IfThenElseZero(hn::RebindMask(int_tag, beyond_low), integer(1)) +
        hn::IfThenElseZero(hn::RebindMask(int_tag, beyond_high), integer(1));
    }
    const Int bits = integer(static_cast<std::int32_t>(frame.regions)) >> number;
    return hn::RebindMask(float_tag, hn::Eq(hn::And(bits, integer(1)), integer(1)));
  }

  /// Two Gauss–Legendre points in each cell are exact for a trilinear density.
  std::uint64_t by_cells(const Ways& ways, Vec3<Real>& result) const
  {
    constexpr int cells_at_once = 4;
    const Line& line = ways.lines[0];
    const Real last = ways.last;
    const VolumeTask& volume = Volumes[0].volume();
    const CellSteps cells(line, volume.field, false);
    const Leaper leaper(volume.bricks, line);
    const Real zero = hn::Zero(float_tag);
    const Real scale = real(volume.extinction) * ways.length[0];
    Real at = ways.first;
    Real stop = last;
    Sum sum;
    std::uint64_t samples = 0;
    for (;;)
    {
      const Mask active = at < stop;
      if (hn::AllFalse(float_tag, active))
      {
        result.x = sum.total - sum.lost;
        return samples;
      }
      if (leaper.leaps())
      {
        const Real way = leaper.way(at);
        const Mask leaping = hn::And(active, way > zero);
        if (!hn::AllFalse(float_tag, leaping))
        {
          at = hn::IfThenElse(leaping, cells.onward(at, way), at);
          continue;
        }
      }
      Real ends[cells_at_once + 1];
      cells.cells(at, last, cells_at_once, ends);
      Real positions[2 * cells_at_once];
      Real values[2 * cells_at_once];
      for (int i = 0; i < cells_at_once; ++i)
      {
        const Real half = (ends[i + 1] - ends[i]) * real(0.5f);
        const Real middle = ends[i] + half;
        const Real offset = half * real(0.57735027f); // 1/√3
        positions[2 * i] = middle - offset;
        positions[2 * i + 1] = middle + offset;
      }
      Functions.values(volume.field, line, positions, 2 * cells_at_once, values);
      for (int i = 0; i < cells_at_once; ++i)
      {
        const Real half = hn::IfThenElseZero(active, (ends[i + 1] - ends[i]) * real(0.5f));
        const Real both = clamp(values[2 * i], zero, real(1e30f)) +
          clamp(values[2 * i + 1], zero, real(1e30f));
        sum.add(both * half * scale);
      }
      samples += 2 * cells_at_once * hn::CountTrue(float_tag, active);
      at = hn::IfThenElse(active, ends[cells_at_once], at);
      stop = hn::IfThenZeroElse(sum.total > real(Lit.deep_enough), stop);
    }
  }

  const LitTask& Lit;
  std::vector<MatterVolume> Volumes;
  FieldFunctions Functions{};
};

/// Optical depths toward the lights at positions of a packet's view rays.
class LightDepths
{
public:
  explicit LightDepths(const MarchTask& task)
    : Lit(*task.lit)
    , Rays(*task.volumes, *task.lit)
    , Lines(Lit.lights.size() * Lit.maps * 6)
  {
    if (Lit.shadows == ShadowMethod::Volume || Lit.shadows == ShadowMethod::Functions)
    {
      for (const LitLight& light : Lit.lights)
      {
        Functions.push_back(field_functions(light.depth[0].field));
      }
    }
  }

  void begin(const Line& line)
  {
    ViewLine = line;
    for (std::size_t i = 0; i < Lit.lights.size() * Lit.maps; ++i)
    {
      const LitLight& light = Lit.lights[i / Lit.maps];
      const std::size_t map = i % Lit.maps;
      const float* node_from_index = light.functions[map].texels
        ? light.functions[map].node_from_index
        : light.depth[map].node_from_index;
      Lines.set(6 * i, transform(node_from_index, line.begin));
      Lines.set(6 * i + 3, multiply(node_from_index, 4, line.delta));
    }
  }

  /// Of light number `index`: result[i] at positions[i], one in x or three (LitTask::maps). Returns
  /// the number of samples.
  HWY_INLINE std::uint64_t
  get(int index, const Real* positions, int count, Mask active, Vec3<Real>* result) const
  {
    const LitLight& light = Lit.lights[index];
    const Real zero = hn::Zero(float_tag);
    std::uint64_t samples = 0;
    if (Lit.shadows == ShadowMethod::None)
    {
      for (int i = 0; i < count; ++i)
      {
        result[i] = { zero, zero, zero };
      }
      return 0;
    }
    if (Lit.shadows == ShadowMethod::Rays)
    {
      for (int i = 0; i < count; ++i)
      {
        const Vec3<Real> place = ViewLine.at(positions[i]);
        const bool far = !light.source.positional;
        const Vec3<Real> way =
          far ? broadcast3<Real>(light.toward) : broadcast3<Real>(light.place) - place;
        samples += Rays.depth(place, way, real(far ? 3e38f : 1.0f), active, result[i]);
      }
      return samples;
    }
    for (int map = 0; map < Lit.maps; ++map)
    {
      const std::size_t first = 6 * (static_cast<std::size_t>(index) * Lit.maps + map);
      const Line line{ Lines.get3(first), Lines.get3(first + 3) };
      Real values[most_at_once];
      if (light.functions[map].texels)
      {
        for (int i = 0; i < count; ++i)
        {
          values[i] = by_functions(light.functions[map], line.at(positions[i]));
        }
      }
      else
      {
        Functions[index].values(light.depth[map].field, line, positions, count, values);
      }
      const Real scale = real(light.functions[map].texels ? 1.0f : light.depth[map].scale);
      for (int i = 0; i < count; ++i)
      {
        Real* channel[3] = { &result[i].x, &result[i].y, &result[i].z };
        *channel[map] = values[i] * scale;
      }
      samples += count * hn::CountTrue(float_tag, active);
    }
    return samples;
  }

  static constexpr int most_at_once = 8;

private:
  /// The optical depth from the mean transmittance of the four texels around a place.
  static Real by_functions(const ShadowFunctions& map, const Vec3<Real>& node)
  {
    const Real zero = hn::Zero(float_tag);
    const Real one = real(1.0f);
    Int low[2];
    Real fraction[2];
    const Real* p[2] = { &node.x, &node.y };
    for (int axis = 0; axis < 2; ++axis)
    {
      const Real inside = clamp(*p[axis], zero, real(static_cast<float>(map.dims[axis] - 1)));
      low[axis] = hn::Min(
        hn::ConvertTo(int_tag, inside), integer(map.dims[axis] > 1 ? map.dims[axis] - 2 : 0));
      fraction[axis] = inside - hn::ConvertTo(float_tag, low[axis]);
    }
    const int plane = map.dims[0] * map.dims[1];
    Real passes[2][2];
    for (int y = 0; y < 2; ++y)
    {
      for (int x = 0; x < 2; ++x)
      {
        const Int row = hn::Min(low[1] + integer(y), integer(map.dims[1] - 1));
        const Int column = hn::Min(low[0] + integer(x), integer(map.dims[0] - 1));
        const Int texel = row * integer(map.dims[0]) + column;
        const auto read = [&](int which)
        { return hn::GatherIndex(float_tag, map.texels + std::ptrdiff_t{ plane } * which, texel); };
        const Real depth = clamp(
          (node.z - read(ShadowFunctions::Begin)) * read(ShadowFunctions::Scale), zero, one);
        // cos kπz by Chebyshev's recurrence.
        const Real cosine = hn::Cos(float_tag, depth * real(3.14159265f));
        Real before = one;
        Real here = cosine;
        Real sum = read(ShadowFunctions::FirstCoefficient);
        for (int k = 1; k < ShadowFunctions::coefficients; ++k)
        {
          sum = hn::MulAdd(read(ShadowFunctions::FirstCoefficient + k), here, sum);
          const Real next = hn::MulSub(here + here, cosine, before);
          before = here;
          here = next;
        }
        passes[y][x] = clamp(sum, zero, one); // a cut series overshoots
      }
    }
    const Real mean = lerp(lerp(passes[0][0], passes[0][1], fraction[0]),
      lerp(passes[1][0], passes[1][1], fraction[0]), fraction[1]);
    return hn::Neg(hn::Log(float_tag, max(mean, real(1e-7f)))); // as deep as sweeps look
  }

  const LitTask& Lit;
  DepthRays Rays;
  PacketArray Lines;
  std::vector<FieldFunctions> Functions;
  Line ViewLine;
};

}
}
HWY_AFTER_NAMESPACE();

#endif
