// The mean and the sum of opacity times value along a ray, for every SIMD target.
#include "Transport/march_task.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "Transport/march_grey.cxx"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "Transport/leap-inl.h"
#include "Transport/projection-inl.h"

HWY_BEFORE_NAMESPACE();
namespace brume
{
namespace HWY_NAMESPACE
{

/// Reads the value at both ends of each step and takes it to run evenly between; what of the run is
/// in the range counts, with the function integrated by two points, exactly up to its cube.
template <bool Mean>
class GreyProjector
{
public:
  explicit GreyProjector(const MarchTask& task)
    : Task(task)
  {
    for (const VolumeTask& volume : *task.volumes)
    {
      Readers.emplace_back(volume);
    }
  }

  void begin()
  {
    for (std::size_t k = 0; k < Readers.size(); ++k)
    {
      Sums[k] = Added();
    }
  }

  std::uint64_t march(int k, const Rays& rays, Mask active)
  {
    const Real zero = hn::Zero(float_tag);
    const Real one = real(1.0f);
    const VolumeTask& volume = (*Task.volumes)[k];
    const Line& line = rays.lines[k];
    const Leaper leaper(volume.bricks, line);
    Real step = zero;
    const Real end = hn::IfThenElseZero(active, rays.end);
    std::uint64_t samples = 0;
    Values before = {};
    Real earlier = zero; // the contribution of the step before
    bool fresh = true;
    if (!volume.masked)
    {
      Sums[k].drawn = select(active, one, Sums[k].drawn);
    }
    for (int look = 0;; ++look)
    {
      const Mask going = step < end;
      if (hn::AllFalse(float_tag, going))
      {
        return samples;
      }
      const Real from = max(step, rays.start);
      const Real to = hn::Min(step + one, rays.end);
      if (leaper.leaps() && (fresh || look % samples_between_leaps == 0))
      {
        const Real way = hn::Floor(leaper.way(hn::Min(from, rays.end)));
        const Mask leaping = hn::And(going, way > zero);
        if (!hn::AllFalse(float_tag, leaping))
        {
          step = step + hn::IfThenElseZero(leaping, way);
          fresh = true;
          continue;
        }
      }
      if (fresh)
      {
        before = read(k, line.at(hn::Min(from, rays.end)));
        samples += hn::CountTrue(float_tag, going);
        earlier = zero;
        fresh = false;
      }
      const Vec3<Real> middle = line.at((from + to) * real(0.5f));
      const Values here = read(k, volume.field.linear ? line.at(to) : middle);
      samples += hn::CountTrue(float_tag, going);
      if (!volume.field.linear)
      {
        before = here; // the nearest voxel's value does not run from one to the next
      }
      Real length = hn::IfThenElseZero(going, to - from);
      const Int first = Readers[k].first_node(middle);
      length = hn::IfThenElseZero(hn::RebindMask(float_tag, first > integer(-1)), length);
      earlier = add(k, before, here, middle, hn::Max(first, hn::Zero(int_tag)),
        length * rays.scale[k], earlier);
      before = here;
      step = step + one;
    }
  }

  void finish(Projected& pixel) const
  {
    const Real zero = hn::Zero(float_tag);
    const Real one = real(1.0f);
    Real grey = zero;
    for (std::size_t k = 0; k < Readers.size(); ++k)
    {
      const VolumeTask& volume = (*Task.volumes)[k];
      const Real length = Sums[k].length.total - Sums[k].length.lost;
      const Mask some = hn::Or(length > zero, Sums[k].drawn > (Mean ? one : zero));
      const Real per_length =
        Mean ? real(volume.weight) / hn::IfThenElse(some, length, real(1.0f))
             : real(volume.weight * volume.per_unit * static_cast<float>(Task.step));
      const Real share = hn::IfThenElseZero(some, per_length);
      grey = hn::MulAdd(Sums[k].grey.total - Sums[k].grey.lost, share, grey);
      pixel.error = hn::MulAdd(Sums[k].error, share, pixel.error);
      pixel.opacity = select(some, real(1.0f), pixel.opacity);
    }
    grey = clamp(grey, zero, real(1.0f));
    pixel.radiance = { grey, grey, grey };
  }

private:
  /// Of one volume; lengths are in steps.
  struct Added
  {
    Sum grey;
    Sum length;
    Real error;
    Real drawn; ///< 1 where a sum has a part, if only one of no opacity, that was leapt over

    HWY_INLINE Added()
      : error(hn::Zero(float_tag))
      , drawn(hn::Zero(float_tag))
    {
    }
  };

  /// What is read at one place.
  struct Values
  {
    Real value; ///< what is classified
    Real grey;  ///< what is added up
  };

  HWY_INLINE Values read(int k, const Vec3<Real>& place) const
  {
    const Real value = Readers[k].value(place);
    return { value,
      (*Task.volumes)[k].colour == VoxelColour::Value ? value : Readers[k].grey_value(place) };
  }

  /// Adds a step between two places. Returns its contribution, for the estimate of its error.
  HWY_INLINE Real add(int k,
    const Values& a,
    const Values& b,
    const Vec3<Real>& middle,
    Int first,
    Real length,
    Real earlier)
  {
    const Real zero = hn::Zero(float_tag);
    const Real one = real(1.0f);
    const VolumeTask& volume = (*Task.volumes)[k];
    Real begin = zero; // the part of the run that counts
    Real finish = one;
    if constexpr (Mean)
    {
      const Real run = b.grey - a.grey;
      const Mask still = hn::Abs(run) < real(1e-30f);
      const Real inverse = one / hn::IfThenElse(still, one, run);
      const Real low = (real(Task.average_range[0]) - a.grey) * inverse;
      const Real high = (real(Task.average_range[1]) - a.grey) * inverse;
      const Mask within = hn::And(
        a.grey >= real(Task.average_range[0]), a.grey <= real(Task.average_range[1]));
      begin = select(still, zero, clamp(hn::Min(low, high), zero, one));
      finish = select(
        still, hn::IfThenElseZero(within, one), clamp(max(low, high), zero, one));
    }
    const Real share = max(finish - begin, zero);
    Real sum = zero;
    for (float side : { -0.57735027f, 0.57735027f }) // Gauss and Legendre
    {
      const Real t = hn::MulAdd(share, real(0.5f + 0.5f * side), begin);
      const Real opacity = Readers[k].opacity(lerp(a.value, b.value, t), middle, first);
      const Real grey = (lerp(a.grey, b.grey, t) - real(volume.black)) * real(volume.whiten);
      sum = hn::MulAdd(opacity * grey, real(0.5f), sum);
    }
    const Real part = length * share;
    const Real contribution = hn::IfThenElseZero(part > zero, sum * part);
    Sums[k].length.add(part);
    Sums[k].grey.add(contribution);
    // A twelfth of the bend is what a trapezium misses; of the bend a step's change is a bound.
    Sums[k].error =
      Sums[k].error + hn::Abs(contribution - earlier) * real(1.0f / 24.0f);
    return contribution;
  }

  const MarchTask& Task;
  std::vector<TintReader> Readers;
  Added Sums[most_volumes];
};

MarchCount march_mean_target(const MarchTask& task)
{
  return project_tile<GreyProjector<true>>(task);
}
MarchCount march_sum_target(const MarchTask& task)
{
  return project_tile<GreyProjector<false>>(task);
}

}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace brume
{
HWY_EXPORT(march_mean_target);
HWY_EXPORT(march_sum_target);
MarchCount march_mean(const MarchTask& task)
{
  return HWY_DYNAMIC_DISPATCH(march_mean_target)(task);
}
MarchCount march_sum(const MarchTask& task)
{
  return HWY_DYNAMIC_DISPATCH(march_sum_target)(task);
}
}
#endif
