// Marching a packet of rays through a grid, front to back. Included once for each SIMD target.
#if defined(BRUME_MARCH_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BRUME_MARCH_INL_H
#undef BRUME_MARCH_INL_H
#else
#define BRUME_MARCH_INL_H
#endif

#include "Transport/field-inl.h"
#include "Transport/march_task.h"
#include "Transport/optics.h"

#include <algorithm>
#include <cmath>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace brume
{
namespace HWY_NAMESPACE
{

#include "Transport/shading-inl.h"

/// Pixels of a packet: as square as the lanes allow.
constexpr int packet_width = lane_count >= 8 ? 4 : lane_count >= 2 ? 2 : 1;
constexpr int packet_height = lane_count / packet_width;

/// Samples that are taken between two looks at the visible bricks.
constexpr int samples_between_leaps = 4;

/// The rays of a packet. Step number s ends at begin + delta · (s + 1); the last one is shorter.
struct Rays
{
  Vec3<Real> begin;  ///< index space
  Vec3<Real> delta;  ///< index space, one step
  Real steps;        ///< count, the partial last one included; 0 for a ray that misses
  Real last_step;    ///< length of the last one, in steps; (0, 1]
  HWY_ALIGN float start_offset[lane_count]; ///< data units from the near plane
  HWY_ALIGN float world_scale[lane_count];  ///< world units in one of the data's, along the ray
};

inline int make_rays(const MarchTask& task, int x, int y, Rays& rays)
{
  HWY_ALIGN float begin[3][lane_count] = {};
  HWY_ALIGN float delta[3][lane_count] = {};
  HWY_ALIGN float steps[lane_count] = {};
  HWY_ALIGN float last[lane_count] = {};
  int hits = 0;
  for (int lane = 0; lane < lane_count; ++lane)
  {
    const int px = x + lane % packet_width;
    const int py = y + lane / packet_width;
    rays.start_offset[lane] = 0.0f;
    rays.world_scale[lane] = 1.0f;
    if (px >= task.x1 || py >= task.y1)
    {
      continue;
    }
    const RaySegment segment = task.rays->segment(px, py);
    if (!(segment.length > 0.0))
    {
      continue;
    }
    ++hits;
    const double count = segment.length / task.step;
    const double whole = std::max(1.0, std::ceil(count - 1e-6));
    steps[lane] = static_cast<float>(whole);
    last[lane] = static_cast<float>(count - (whole - 1.0));
    rays.start_offset[lane] = static_cast<float>(segment.start_offset);
    rays.world_scale[lane] = static_cast<float>(segment.world_scale);
    const glm::dvec3 step = (segment.end - segment.begin) / count;
    for (int axis = 0; axis < 3; ++axis)
    {
      begin[axis][lane] = static_cast<float>(segment.begin[axis]);
      delta[axis][lane] = static_cast<float>(step[axis]);
    }
  }
  rays.begin = { hn::Load(float_tag, begin[0]), hn::Load(float_tag, begin[1]),
    hn::Load(float_tag, begin[2]) };
  rays.delta = { hn::Load(float_tag, delta[0]), hn::Load(float_tag, delta[1]),
    hn::Load(float_tag, delta[2]) };
  rays.steps = hn::Load(float_tag, steps);
  rays.last_step = hn::Load(float_tag, last);
  return hits;
}

/// Leaps over bricks that cannot be seen.
class Leaper
{
public:
  /// `bricks` may be null; leap() must not be called then.
  HWY_INLINE Leaper(const VisibleBricks* bricks, const Rays& rays)
    : Distance(bricks ? bricks->distance.data() : nullptr)
    , Dims(bricks ? bricks->dims : nullptr)
    , Shift(bricks ? bricks->shift : 0)
    , inverse{ invert(rays.delta.x), invert(rays.delta.y), invert(rays.delta.z) }
  {
  }

  /// For lanes in `active` whose place is in an invisible brick: the steps to the first place
  /// outside the invisible surroundings, at least 1. 0 for the other lanes.
  HWY_INLINE Real leap(const Vec3<Real>& place, Mask active) const
  {
    const Real* p[3] = { &place.x, &place.y, &place.z };
    Int brick[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      const Int cell = hn::ConvertTo(int_tag, hn::Max(*p[axis], hn::Zero(float_tag)));
      brick[axis] = hn::Min(hn::ShiftRightSame(cell, Shift), integer(Dims[axis] - 1));
    }
    const Int index = (brick[2] * integer(Dims[1]) + brick[1]) * integer(Dims[0]) + brick[0];
    const Int distance = hn::GatherIndex(int_tag, Distance, index);
    const Mask leaps = hn::And(active, hn::RebindMask(float_tag, distance > integer(0)));
    if (hn::AllFalse(float_tag, leaps))
    {
      return hn::Zero(float_tag);
    }
    Real way = real(std::numeric_limits<float>::max());
    for (int axis = 0; axis < 3; ++axis)
    {
      const Real edge = real(static_cast<float>(1 << Shift));
      const Real high = hn::ConvertTo(float_tag, brick[axis] + distance) * edge;
      const Real low = hn::ConvertTo(float_tag, brick[axis] - distance + integer(1)) * edge;
      const Real face = select(inverse[axis] > hn::Zero(float_tag), high, low);
      way = hn::Min(way, (face - *p[axis]) * inverse[axis]);
    }
    // A thousandth of a step short, so that rounding never leaps over a visible place.
    const Real steps = hn::Floor(max(way - real(1e-3f), hn::Zero(float_tag))) + real(1.0f);
    return hn::IfThenElseZero(leaps, steps);
  }

private:
  static HWY_INLINE Real invert(Real delta)
  {
    // An axis along which the ray stands still never ends its way.
    const Mask still = hn::Abs(delta) < real(1e-30f);
    return hn::IfThenElse(still, real(1e30f), real(1.0f) / delta);
  }

  const std::int32_t* Distance;
  const int* Dims;
  int Shift;
  Real inverse[3];
};

/// What a packet has gathered on its way.
struct Gathered
{
  Vec3<Real> radiance;
  Real transmittance;
  Sum optical_depth; ///< classified grids: optical depth. Density grids: density, in steps.
  Real half_way;     ///< where half is absorbed, in steps; infinity before that
  Mask left;         ///< rays that were left before their end

  HWY_INLINE Gathered()
    : radiance{ hn::Zero(float_tag), hn::Zero(float_tag), hn::Zero(float_tag) }
    , transmittance(real(1.0f))
    , half_way(real(std::numeric_limits<float>::infinity()))
    , left(hn::FirstN(float_tag, 0))
  {
  }
};

/// Colour and optical depth of a packet of values, interpolated between nodes.
struct Lookup
{
  HWY_INLINE explicit Lookup(const LookupTable* table)
    : Nodes(table ? &table->nodes[0].red : nullptr)
    , Last(table ? table->intervals : 0)
    , Lower(table ? table->lower : 0.0f)
    , Scale(table ? table->scale : 0.0f)
    , offset(hn::Zero(int_tag))
    , fraction(hn::Zero(float_tag))
  {
  }

  HWY_INLINE void locate(Real value)
  {
    const Real position = clamp((value - real(Lower)) * real(Scale), hn::Zero(float_tag),
      real(static_cast<float>(Last)));
    const Int index = hn::Min(hn::ConvertTo(int_tag, position), integer(Last - 1));
    fraction = position - hn::ConvertTo(float_tag, index);
    offset = hn::ShiftLeft<2>(index);
  }
  template <int Channel>
  HWY_INLINE Real channel() const
  {
    return lerp(hn::GatherIndex(float_tag, Nodes + Channel, offset),
      hn::GatherIndex(float_tag, Nodes + Channel + 4, offset), fraction);
  }
  HWY_INLINE Real optical_depth() const { return channel<3>(); }
  HWY_INLINE Vec3<Real> colour() const { return { channel<0>(), channel<1>(), channel<2>() }; }

  const float* Nodes;
  int Last;
  float Lower;
  float Scale;
  Int offset;
  Real fraction;
};

HWY_INLINE Real gradient_factor(const MarchTask& task, const Vec3<Real>& gradient)
{
  const Vec3<Real> scaled = gradient *
    Vec3<Real>{ real(task.gradient_scale[0]), real(task.gradient_scale[1]),
      real(task.gradient_scale[2]) };
  constexpr int last = LookupTable::gradient_intervals;
  const Real magnitude = hn::Sqrt(dot(scaled, scaled));
  const Real position =
    hn::Min(magnitude, real(static_cast<float>(last)));
  const Int index = hn::Min(hn::ConvertTo(int_tag, position), integer(last - 1));
  const float* factor = task.table->gradient_factor.data();
  return lerp(hn::GatherIndex(float_tag, factor, index),
    hn::GatherIndex(float_tag, factor + 1, index), position - hn::ConvertTo(float_tag, index));
}

/// How a kernel treats the grid's values.
enum class Kind
{
  Density,
  Classified,
  ClassifiedWithGradient,
};

template <class T, int Components, bool Linear, Kind kind>
class Marcher
{
public:
  explicit Marcher(const MarchTask& task)
    : Task(task)
    , Values(*task.grid, task.non_finite,
        kind == Kind::Density ? 0.0f : task.table->empty_value)
    , Table(task.table)
  {
  }

  std::uint64_t march(const Rays& rays, Gathered& gathered)
  {
    const Real half = real(0.5f);
    const Real one = real(1.0f);
    Real step = hn::Zero(float_tag);
    Real end = rays.steps;
    std::uint64_t samples = 0;
    const Leaper leaper(this->Task.bricks, rays);
    for (;;)
    {
      Mask active = step < end;
      if (hn::AllFalse(float_tag, active))
      {
        return samples;
      }
      if (this->Task.bricks)
      {
        const Real length = select(step + one < rays.steps, one, rays.last_step);
        const Vec3<Real> place = rays.begin + rays.delta * hn::MulAdd(half, length, step);
        const Real leap = leaper.leap(place, active);
        if (!hn::AllFalse(float_tag, leap > hn::Zero(float_tag)))
        {
          step = step + leap;
          continue;
        }
      }
      for (int i = 0; i < samples_between_leaps; ++i)
      {
        active = step < end;
        if (hn::AllFalse(float_tag, active))
        {
          return samples;
        }
        const Real length = select(step + one < rays.steps, one, rays.last_step);
        const Real middle = hn::MulAdd(half, length, step);
        const Vec3<Real> place = rays.begin + rays.delta * middle;
        samples += hn::CountTrue(float_tag, active);
        this->sample(rays, place, middle, length, active, gathered);
        if constexpr (kind != Kind::Density)
        {
          const Mask leave =
            hn::And(active, gathered.transmittance < real(this->Task.leave_below));
          gathered.left = hn::Or(gathered.left, leave);
          end = hn::IfThenElse(leave, hn::Zero(float_tag), end);
        }
        step = step + one;
      }
    }
  }

private:
  HWY_INLINE void sample(const Rays& rays, const Vec3<Real>& place, Real middle, Real length,
    Mask active, Gathered& gathered)
  {
    const auto cell = this->Values.template locate<Linear>(place);
    if constexpr (kind == Kind::Density)
    {
      // The largest floats would add up to infinity, and infinity less infinity is not a number.
      const Real density =
        clamp(this->Values.value(cell), hn::Zero(float_tag), real(1e30f));
      gathered.optical_depth.add(hn::IfThenElseZero(active, density * length));
      const Mask crossed = hn::And(gathered.optical_depth.total > real(this->Task.half_depth),
        middle < gathered.half_way);
      gathered.half_way = select(hn::And(active, crossed), middle, gathered.half_way);
      return;
    }
    else
    {
      Vec3<Real> gradient;
      Real value;
      value = this->Values.value(cell);
      this->Table.locate(value);
      Real depth = hn::IfThenElseZero(active, this->Table.optical_depth() * length);
      if (hn::AllFalse(float_tag, depth > hn::Zero(float_tag)))
      {
        return;
      }
      if constexpr (kind == Kind::ClassifiedWithGradient)
      {
        this->Values.value_and_gradient(cell, gradient);
        if (!this->Task.table->gradient_factor.empty())
        {
          depth = depth * gradient_factor(this->Task, gradient);
        }
      }
      Vec3<Real> colour;
      if constexpr (Components == 4)
      {
        colour = this->Values.colour(cell);
      }
      else
      {
        colour = this->Table.colour();
      }
      if constexpr (kind == Kind::ClassifiedWithGradient)
      {
        if (this->Task.shade->enabled)
        {
          colour = this->shaded(rays, place, gradient, colour);
        }
      }
      // A stretch of constant source and extinction: S (1 − e^(−τ)), seen through what is in front.
      const Real weight = gathered.transmittance * opacity_from_optical_depth(depth);
      gathered.radiance = gathered.radiance + colour * weight;
      gathered.optical_depth.add(depth);
      gathered.transmittance = gathered.transmittance - weight;
      const Mask crossed =
        hn::And(gathered.transmittance < real(0.5f), middle < gathered.half_way);
      gathered.half_way = select(hn::And(active, crossed), middle, gathered.half_way);
    }
  }

  HWY_INLINE Vec3<Real> shaded(const Rays& rays, const Vec3<Real>& place,
    const Vec3<Real>& gradient, const Vec3<Real>& colour) const
  {
    const ShadeModel& model = *this->Task.shade;
    // Between values near the ends of float's range the differences overflow: no direction then.
    Vec3<Real> slope = multiply(model.world_from_gradient, 3, gradient);
    const Mask finite = hn::IsFinite(dot(slope, slope));
    slope = { hn::IfThenElseZero(finite, slope.x), hn::IfThenElseZero(finite, slope.y),
      hn::IfThenElseZero(finite, slope.z) };
    Vec3<Real> along = multiply(model.world_from_index, 4, rays.delta);
    along = along * rsqrt_or_zero(dot(along, along));
    Vec3<Real> world = place;
    if (model.needs_place)
    {
      world = multiply(model.world_from_index, 4, place);
      world.x = world.x + real(model.world_from_index[3]);
      world.y = world.y + real(model.world_from_index[7]);
      world.z = world.z + real(model.world_from_index[11]);
    }
    return shade<Real>(model, slope, -along, world, colour);
  }

  const MarchTask& Task;
  Field<T, Components> Values;
  Lookup Table;
};

/// Writes what a packet gathered to the film.
inline void store(const MarchTask& task, int x, int y, const Rays& rays, const Gathered& gathered)
{
  HWY_ALIGN float channel[3][lane_count];
  HWY_ALIGN float depth[lane_count], lost[lane_count], half_way[lane_count], steps[lane_count];
  HWY_ALIGN float left[lane_count];
  hn::Store(gathered.radiance.x, float_tag, channel[0]);
  hn::Store(gathered.radiance.y, float_tag, channel[1]);
  hn::Store(gathered.radiance.z, float_tag, channel[2]);
  hn::Store(gathered.optical_depth.total, float_tag, depth);
  hn::Store(gathered.optical_depth.lost, float_tag, lost);
  hn::Store(gathered.half_way, float_tag, half_way);
  hn::Store(rays.steps, float_tag, steps);
  hn::Store(hn::IfThenElseZero(gathered.left, gathered.transmittance), float_tag, left);
  const double scale = task.meaning == ValueMeaning::Density ? task.depth_per_value : 1.0;
  for (int lane = 0; lane < lane_count; ++lane)
  {
    if (!(steps[lane] > 0.0f))
    {
      continue;
    }
    const std::size_t pixel = static_cast<std::size_t>(y + lane / packet_width) *
        task.film->width + (x + lane % packet_width);
    double optical_depth = (double(depth[lane]) - double(lost[lane])) * scale;
    if (!std::isfinite(optical_depth))
    {
      // Densities near the end of float's range: their sum overflowed, and nothing passes.
      optical_depth = std::numeric_limits<double>::infinity();
    }
    const float transmittance = static_cast<float>(transmittance_from_optical_depth(optical_depth));
    for (int c = 0; c < 3; ++c)
    {
      task.film->radiance[c][pixel] = channel[c][lane];
      task.film->transmittance[c][pixel] = transmittance;
    }
    task.film->depth[pixel] =
      (rays.start_offset[lane] + half_way[lane] * static_cast<float>(task.step)) *
      rays.world_scale[lane];
    task.film->error[pixel] = task.step_error + left[lane] * task.brightest;
  }
}

template <class T, int Components, bool Linear, Kind kind>
MarchCount march_kind(const MarchTask& task)
{
  MarchCount count;
  Marcher<T, Components, Linear, kind> marcher(task);
  for (int y = task.y0; y < task.y1; y += packet_height)
  {
    for (int x = task.x0; x < task.x1; x += packet_width)
    {
      Rays rays;
      const int hits = make_rays(task, x, y, rays);
      if (hits == 0)
      {
        continue;
      }
      Gathered gathered;
      count.samples += marcher.march(rays, gathered);
      count.rays += hits;
      store(task, x, y, rays, gathered);
    }
  }
  return count;
}

template <class T, int Components, bool Linear>
MarchCount march_interpolation(const MarchTask& task)
{
  if constexpr (Components == 1)
  {
    if (task.meaning == ValueMeaning::Density)
    {
      return march_kind<T, Components, Linear, Kind::Density>(task);
    }
  }
  if (task.shade->enabled || !task.table->gradient_factor.empty())
  {
    return march_kind<T, Components, Linear, Kind::ClassifiedWithGradient>(task);
  }
  return march_kind<T, Components, Linear, Kind::Classified>(task);
}

template <class T, int Components>
MarchCount march_grid(const MarchTask& task)
{
  return task.grid->linear ? march_interpolation<T, Components, true>(task)
                           : march_interpolation<T, Components, false>(task);
}

}
}
HWY_AFTER_NAMESPACE();

#endif
