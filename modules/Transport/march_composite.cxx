// Emission and absorption of one classified grid, for every SIMD target.
#include "Transport/march_task.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "Transport/march_composite.cxx"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "Transport/leap-inl.h"
#include "Transport/lookup-inl.h"
#include "Transport/surface-inl.h"

HWY_BEFORE_NAMESPACE();
namespace brume
{
namespace HWY_NAMESPACE
{

template <StepRule rule, bool Gradient>
class CompositeIntegrator
{
public:
  explicit CompositeIntegrator(const MarchTask& task)
    : Task(task)
    , Volume(task.volumes->front())
    , Functions(field_functions(Volume.field))
    , Table(*Volume.table)
    , DepthScale(static_cast<float>(task.step) * Volume.weight)
  {
  }

  double depth_scale() const { return 1.0; }

  std::uint64_t march(const Rays& rays, Gathered& gathered) const
  {
    const Leaper leaper(Volume.bricks, rays.lines[0]);
    State state;
    state.end = rays.end;
    if constexpr (Gradient)
    {
      state.viewer = toward_viewer(Volume.shade, rays.lines[0]);
    }
    std::uint64_t samples = 0;
    bool fresh = true; // the values before this step are not known
    bool empty = true; // nothing was met in the last steps: look for bricks to leap over
    for (;;)
    {
      Mask active = state.step < state.end;
      if (hn::AllFalse(float_tag, active))
      {
        return samples;
      }
      if (empty && leaper.leaps())
      {
        const Real leap = leap_from(leaper, rays, state.step);
        const Mask leaping = hn::And(active, leap > hn::Zero(float_tag));
        if (!hn::AllFalse(float_tag, leaping))
        {
          state.step = state.step + hn::IfThenElseZero(leaping, leap);
          fresh = true;
          continue;
        }
      }
      if (fresh)
      {
        samples += begin(rays, state, active);
        fresh = false;
      }
      empty = true;
      Real positions[samples_between_leaps];
      Real values[samples_between_leaps];
      for (int i = 0; i < samples_between_leaps; ++i)
      {
        positions[i] = place_of_value(rays, state.step + real(static_cast<float>(i)));
      }
      Functions.values(Volume.field, rays.lines[0], positions, samples_between_leaps, values);
      for (int i = 0; i < samples_between_leaps; ++i)
      {
        active = state.step < state.end;
        if (hn::AllFalse(float_tag, active))
        {
          return samples;
        }
        samples += hn::CountTrue(float_tag, active);
        empty &= !pass(rays, active, Table.position(values[i]), state, gathered);
        const Mask leave = hn::And(active, gathered.transmittance < real(Task.leave_below));
        gathered.left = hn::Or(gathered.left, leave);
        state.end = hn::IfThenZeroElse(leave, state.end);
        state.step = state.step + real(1.0f);
      }
    }
  }

private:
  /// Where a packet is, and what it knows of the step before. Values are places in the table.
  struct State
  {
    Real step;
    Real end;
    Real value;        ///< Integrated: at the step's beginning. Midpoint: not used
    Real value_before; ///< Integrated: one step earlier
    Real depth;        ///< of the step before
    Real depth_before; ///< Midpoint: of the one before that
    Int stretch;       ///< Integrated: the table's stretch of `value`
    Vec3<Real> viewer; ///< Gradient: unit vectors of the world toward the viewer

    HWY_INLINE State()
      : step(hn::Zero(float_tag))
      , end(hn::Zero(float_tag))
      , value(hn::Zero(float_tag))
      , value_before(hn::Zero(float_tag))
      , depth(hn::Zero(float_tag))
      , depth_before(hn::Zero(float_tag))
      , stretch(hn::Zero(int_tag))
    {
    }
  };

  static HWY_INLINE Real step_begin(const Rays& rays, Real step) { return max(step, rays.start); }
  static HWY_INLINE Real step_end(const Rays& rays, Real step)
  {
    return hn::Min(step + real(1.0f), rays.end);
  }
  /// Where the value is read that a step needs anew.
  static HWY_INLINE Real place_of_value(const Rays& rays, Real step)
  {
    return rule == StepRule::Integrated
             ? step_end(rays, step)
             : (step_begin(rays, step) + step_end(rays, step)) * real(0.5f);
  }

  /// Whole steps that may be left out; 0 for none.
  static HWY_INLINE Real leap_from(const Leaper& leaper, const Rays& rays, Real step)
  {
    if constexpr (rule == StepRule::Integrated)
    {
      // Steps that lie in invisible bricks altogether.
      return hn::Floor(leaper.way(step_begin(rays, step)));
    }
    else
    {
      // Steps whose middle does.
      const Real way = leaper.way(place_of_value(rays, step));
      return hn::IfThenElseZero(way > hn::Zero(float_tag), hn::Floor(way) + real(1.0f));
    }
  }

  /// Reads the value that the first step after a leap begins with. Returns the number of samples.
  HWY_INLINE std::uint64_t begin(const Rays& rays, State& state, Mask active) const
  {
    state.depth = state.depth_before = hn::Zero(float_tag);
    if constexpr (rule == StepRule::Integrated)
    {
      const Real position = hn::Min(step_begin(rays, state.step), rays.end);
      Real value;
      Functions.values(Volume.field, rays.lines[0], &position, 1, &value);
      state.value = state.value_before = Table.position(value);
      state.stretch = Table.stretch(state.value);
      return hn::CountTrue(float_tag, active);
    }
    return 0;
  }

  /// What a step holds.
  struct Step
  {
    Real extinction;     ///< the mean
    Real centre;         ///< where most of it is, as a fraction of the step
    Lookup::Place entry; ///< where the table has the colour, but for
    Mask crossing;       ///< lanes that have it
    Vec3<Real> mean;     ///< here
  };

  HWY_INLINE Step midpoint(Real value) const
  {
    Step step;
    step.entry = Table.locate(value);
    step.extinction = Table.extinction(step.entry);
    step.centre = real(0.5f);
    return step;
  }

  HWY_INLINE Step integrated(Real to, Mask active, State& state) const
  {
    const Real from = state.value;
    const Real difference = to - from;
    Step result = midpoint((from + to) * real(0.5f));
    const Int stretch = Table.stretch(to);
    // Within one stretch the entry half-way is the mean; so it is, nearly, over a small difference,
    // where that of the integrals would have lost its digits.
    result.crossing = hn::And(hn::And(active, hn::Abs(difference) > real(2.0f)),
      hn::RebindMask(float_tag, hn::Ne(stretch, state.stretch)));
    const Mask crossing = result.crossing;
    if (!hn::AllFalse(float_tag, crossing))
    {
      const Classified mean = Lookup::mean(
        Table.integral(from), Table.integral(to), hn::IfThenElse(crossing, difference, real(1.0f)));
      result.extinction = select(crossing, mean.extinction, result.extinction);
      result.mean = mean.colour;
      if constexpr (Gradient)
      {
        // The centre of an extinction that runs evenly between the ends'.
        const Real a = Table.extinction(Table.locate(from));
        const Real b = Table.extinction(Table.locate(to));
        const Real sum = a + b;
        const Mask some = sum > hn::Zero(float_tag);
        const Real centre = (a + b + b) / hn::IfThenElse(some, sum * real(3.0f), real(1.0f));
        result.centre = select(hn::And(crossing, some), centre, result.centre);
      }
    }
    state.stretch = stretch;
    return result;
  }

  /// Takes a step. Returns whether there was anything in it.
  HWY_INLINE bool pass(const Rays& rays,
    Mask active,
    Real value,
    State& state,
    Gathered& gathered) const
  {
    const Real begin = step_begin(rays, state.step);
    const Real length = step_end(rays, state.step) - begin;
    const Step step =
      rule == StepRule::Integrated ? integrated(value, active, state) : midpoint(value);
    Real depth = hn::IfThenElseZero(active, step.extinction * length * real(DepthScale));
    estimate_error(value, depth, state, gathered);
    if (hn::AllFalse(float_tag, depth > hn::Zero(float_tag)))
    {
      return false;
    }
    const Real centre = hn::MulAdd(step.centre, length, begin);
    Vec3<Real> colour = Table.colour(step.entry);
    if constexpr (rule == StepRule::Integrated)
    {
      colour.x = select(step.crossing, step.mean.x, colour.x);
      colour.y = select(step.crossing, step.mean.y, colour.y);
      colour.z = select(step.crossing, step.mean.z, colour.z);
    }
    if constexpr (Gradient)
    {
      Vec3<Real> gradient;
      Functions.gradient(Volume.field, rays.lines[0].at(centre), gradient);
      if (!Volume.table->gradient_factor.empty())
      {
        depth = depth * Table.gradient_factor(gradient_magnitude(Volume, gradient));
      }
      if (Volume.shade.enabled)
      {
        colour = shaded(Volume.shade, rays.lines[0], state.viewer, centre, gradient, colour);
      }
    }
    // A stretch of constant source and extinction: S (1 − e^(−τ)), seen through what is in front.
    const Real weight = gathered.transmittance * opacity_from_optical_depth(depth);
    gathered.radiance = gathered.radiance + colour * weight;
    gathered.optical_depth.add(depth);
    gathered.transmittance = gathered.transmittance - weight;
    gathered.note_half_way(hn::And(active, gathered.transmittance < real(0.5f)), rays, centre);
    return true;
  }

  /// Adds an estimate of how much the step's optical depth is off, as it dims the pixel: a bend of
  /// what the rule takes to be straight, over 12 between ends and over 24 around a middle; there twice
  /// that, for the colour, which bends too.
  HWY_INLINE void estimate_error(Real value, Real depth, State& state, Gathered& gathered) const
  {
    Real off;
    if constexpr (rule == StepRule::Integrated)
    {
      const Real bend = hn::Abs(value - state.value - state.value + state.value_before);
      const Real run = hn::Abs(value - state.value_before) * real(0.5f);
      const Real rise = hn::Abs(depth - state.depth);
      // How many times the run between two steps' middles the bend is: at most all of the rise.
      const Real share = hn::Min(bend / max(run, real(1e-3f)), real(12.0f));
      off = rise * share * real(1.0f / 12.0f);
      state.value_before = state.value;
      state.value = value;
    }
    else
    {
      off = hn::Abs(depth - state.depth - state.depth + state.depth_before) * real(1.0f / 12.0f);
      state.depth_before = state.depth;
    }
    state.depth = depth;
    gathered.error = hn::MulAdd(gathered.transmittance, hn::Min(off, real(1.0f)), gathered.error);
  }

  const MarchTask& Task;
  const VolumeTask& Volume;
  FieldFunctions Functions;
  Lookup Table;
  float DepthScale;
};

MarchCount march_composite_target(const MarchTask& task)
{
  const bool gradient = task.volumes->front().needs_gradient;
  if (task.rule == StepRule::Integrated)
  {
    return gradient ? march_tile<CompositeIntegrator<StepRule::Integrated, true>>(task)
                    : march_tile<CompositeIntegrator<StepRule::Integrated, false>>(task);
  }
  return gradient ? march_tile<CompositeIntegrator<StepRule::Midpoint, true>>(task)
                  : march_tile<CompositeIntegrator<StepRule::Midpoint, false>>(task);
}

}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace brume
{
HWY_EXPORT(march_composite_target);
MarchCount march_composite(const MarchTask& task)
{
  return HWY_DYNAMIC_DISPATCH(march_composite_target)(task);
}
}
#endif
