// Any number of overlapping volumes, with masks, colours of their own and transfer functions of
// value and gradient: extinctions add up, each volume sends its own light. For every SIMD target.
#include "Transport/march_task.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "Transport/march_mixture.cxx"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "Transport/leap-inl.h"
#include "Transport/matter-inl.h"

HWY_BEFORE_NAMESPACE();
namespace brume
{
namespace HWY_NAMESPACE
{

/// The optical depth of a volume's stretch around a position, and its source.
HWY_INLINE Real source(const MatterVolume& volume,
  const Line& line,
  Real position,
  Real length,
  Mask active,
  Vec3<Real>& colour)
{
  const Real zero = hn::Zero(float_tag);
  const VolumeTask& task = volume.volume();
  colour = { zero, zero, zero };
  Matter matter;
  volume.look(line, position, length, active, matter);
  if (task.meaning == ValueMeaning::Density || hn::AllFalse(float_tag, matter.depth > zero))
  {
    return matter.depth;
  }
  colour = volume.colour(line, position, matter);
  if (task.shade.enabled)
  {
    volume.find_gradient(line, position, matter);
    const Vec3<Real> viewer = toward_viewer(task.shade, line);
    colour = shaded(task.shade, line, viewer, position, matter.gradient, colour);
  }
  return matter.depth;
}

class MixtureIntegrator
{
public:
  explicit MixtureIntegrator(const MarchTask& task)
    : Task(task)
  {
    for (const VolumeTask& volume : *task.volumes)
    {
      Volumes.emplace_back(volume, task.step);
      CanLeap = CanLeap || volume.bricks;
    }
  }

  double depth_scale() const { return 1.0; }

  std::uint64_t march(const Rays& rays, Gathered& gathered) const
  {
    const Real zero = hn::Zero(float_tag);
    const Real one = real(1.0f);
    const int count = static_cast<int>(Volumes.size());
    Real end = rays.end;
    Real step = zero;
    Real depth_before = zero;
    Real depth_earlier = zero;
    std::uint64_t samples = 0;
    for (int look = 0;; ++look)
    {
      const Mask active = step < end;
      if (hn::AllFalse(float_tag, active))
      {
        return samples;
      }
      const Real begin = max(step, rays.start);
      const Real finish = hn::Min(step + one, rays.end);
      const Real middle = (begin + finish) * real(0.5f);
      if (CanLeap && look % samples_between_leaps == 0)
      {
        const Real way = leap_all(*Task.volumes, rays, middle);
        const Mask leaping = hn::And(active, way > zero);
        if (!hn::AllFalse(float_tag, leaping))
        {
          step = step + hn::IfThenElseZero(leaping, hn::Floor(way) + one);
          look = -1;
          continue;
        }
      }
      Real depth = zero;
      Real squares = zero;
      Vec3<Real> light{ zero, zero, zero };
      for (int k = 0; k < count; ++k)
      {
        const Mask inside = hn::And(active, rays.inside[k] > zero);
        if (hn::AllFalse(float_tag, inside))
        {
          continue;
        }
        samples += hn::CountTrue(float_tag, inside);
        Vec3<Real> colour;
        const Real length = (finish - begin) * rays.scale[k];
        const Real part = source(Volumes[k], rays.lines[k], middle, length, inside, colour);
        depth = depth + part;
        squares = hn::MulAdd(part, part, squares);
        light = light + colour * part;
      }
      if (Task.mixture == Mixture::Components)
      {
        const Mask some = depth > real(1e-18f); // squares of less are nothing
        depth = select(some, squares / hn::IfThenElse(some, depth, one), depth);
      }
      const Real off =
        hn::Abs(depth - depth_before - depth_before + depth_earlier) * real(1.0f / 24.0f);
      gathered.error = hn::MulAdd(gathered.transmittance, hn::Min(off, one), gathered.error);
      depth_earlier = depth_before;
      depth_before = depth;
      // The source is the volumes' own, each by its share of the extinction (or, of components, by
      // more than that).
      const Mask some = depth > zero;
      if (!hn::AllFalse(float_tag, some))
      {
        const Real weight = gathered.transmittance * opacity_from_optical_depth(depth);
        const Real share = hn::IfThenElseZero(some, weight / hn::IfThenElse(some, depth, one));
        gathered.radiance = gathered.radiance + light * share;
        gathered.optical_depth.add(depth);
        gathered.transmittance = gathered.transmittance - weight;
        gathered.note_half_way(hn::And(active, gathered.transmittance < real(0.5f)), rays, middle);
        const Mask leave = hn::And(active, gathered.transmittance < real(Task.leave_below));
        gathered.left = hn::Or(gathered.left, leave);
        end = hn::IfThenZeroElse(leave, end);
      }
      step = step + one;
    }
  }

private:
  const MarchTask& Task;
  std::vector<MatterVolume> Volumes;
  bool CanLeap = false;
};

MarchCount march_mixture_target(const MarchTask& task)
{
  return march_tile<MixtureIntegrator>(task);
}

}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace brume
{
HWY_EXPORT(march_mixture_target);
MarchCount march_mixture(const MarchTask& task)
{
  return HWY_DYNAMIC_DISPATCH(march_mixture_target)(task);
}
}
#endif
