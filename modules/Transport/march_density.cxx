// Optical depths of one grid of densities, for every SIMD target.
#include "Transport/march_task.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "Transport/march_density.cxx"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "Transport/leap-inl.h"
#include "Transport/rays-inl.h"

HWY_BEFORE_NAMESPACE();
namespace brume
{
namespace HWY_NAMESPACE
{

class DensityIntegrator
{
public:
  explicit DensityIntegrator(const MarchTask& task)
    : Task(task)
    , Volume(task.volumes->front())
    , Functions(field_functions(Volume.field))
    , HalfDepth(static_cast<float>(std::log(2.0) / depth_scale()))
  {
  }

  /// Optical depth of a step of density 1.
  double depth_scale() const { return double(Volume.extinction) * Task.step; }

  std::uint64_t march(const Rays& rays, Gathered& gathered) const
  {
    return Task.rule == StepRule::Cells ? march_cells(rays, gathered) : march_steps(rays, gathered);
  }

private:
  std::uint64_t march_steps(const Rays& rays, Gathered& gathered) const
  {
    const Leaper leaper(Volume.bricks, rays.lines[0]);
    const Real one = real(1.0f);
    Real step = hn::Zero(float_tag);
    Real before = hn::Zero(float_tag);
    std::uint64_t samples = 0;
    for (;;)
    {
      Mask active = step < rays.end;
      if (hn::AllFalse(float_tag, active))
      {
        return samples;
      }
      if (leaper.leaps())
      {
        const Real way = leaper.way(middle(rays, step));
        const Mask leaping = hn::And(active, way > hn::Zero(float_tag));
        if (!hn::AllFalse(float_tag, leaping))
        {
          step = step + hn::IfThenElseZero(leaping, hn::Floor(way) + one);
          continue;
        }
      }
      Real positions[samples_between_leaps];
      Real values[samples_between_leaps];
      for (int i = 0; i < samples_between_leaps; ++i)
      {
        positions[i] = middle(rays, step + real(static_cast<float>(i)));
      }
      Functions.values(Volume.field, rays.lines[0], positions, samples_between_leaps, values);
      for (int i = 0; i < samples_between_leaps; ++i)
      {
        active = step < rays.end;
        samples += hn::CountTrue(float_tag, active);
        const Real length = hn::Min(step + one, rays.end) - max(step, rays.start);
        const Real density = clean(values[i]);
        add(rays, active, positions[i], density * length, gathered);
        // The midpoint rule's error, from the bend of the density.
        gathered.error = hn::MulAdd(hn::IfThenElseZero(active, hn::Abs(density - before)),
          real(static_cast<float>(depth_scale() / 24.0)),
          gathered.error);
        before = density;
        step = step + one;
      }
    }
  }

  /// Cell by cell: between the planes through the voxels (half-way between them, where the nearest
  /// voxel counts) the density is a cubic of the position, which two points integrate exactly.
  std::uint64_t march_cells(const Rays& rays, Gathered& gathered) const
  {
    const Line& line = rays.lines[0];
    const Leaper leaper(Volume.bricks, line);
    const Real zero = hn::Zero(float_tag);
    const Real shift = real(Volume.field.linear ? 0.0f : 0.5f);
    const Vec3<Real>& d = line.delta;
    const Real* delta[3] = { &d.x, &d.y, &d.z };
    Real inverse[3];
    Mask still[3]; // along these axes the ray meets no plane, in whichever it runs
    for (int axis = 0; axis < 3; ++axis)
    {
      still[axis] = hn::Abs(*delta[axis]) < real(1e-30f);
      inverse[axis] = hn::IfThenElse(still[axis], real(1e30f), real(1.0f) / *delta[axis]);
    }
    Real at = rays.start;
    std::uint64_t samples = 0;
    for (;;)
    {
      const Mask active = at < rays.end;
      if (hn::AllFalse(float_tag, active))
      {
        return samples;
      }
      if (leaper.leaps())
      {
        const Real way = leaper.way(at);
        const Mask leaping = hn::And(active, way > zero);
        if (!hn::AllFalse(float_tag, leaping))
        {
          // At least the next float, so that no ray stands still.
          const Real next = max(at + way, hn::MulAdd(at, real(2e-7f), at + real(1e-6f)));
          at = select(leaping, next, at);
          continue;
        }
      }
      // The next plane on each axis. A ray that stands on one takes the one beyond.
      const Vec3<Real> p = line.at(at);
      const Real* place[3] = { &p.x, &p.y, &p.z };
      Real next = rays.end;
      const Real least = hn::MulAdd(at, real(2e-7f), at + real(1e-6f));
      for (int axis = 0; axis < 3; ++axis)
      {
        const Real from = *place[axis] + shift;
        const Mask up = *delta[axis] > zero;
        const Real plane = select(up, hn::Floor(from) + real(1.0f), hn::Ceil(from) - real(1.0f));
        const Real ahead = hn::MulAdd(plane - from, inverse[axis], at);
        const Real further = ahead + hn::Abs(inverse[axis]);
        const Real border = select(ahead > least, ahead, further);
        next = hn::IfThenElse(still[axis], next, hn::Min(next, border));
      }
      next = hn::Min(max(next, least), rays.end);
      const Real half = (next - at) * real(0.5f);
      const Real middle = at + half;
      const Real offset = half * real(0.57735027f); // 1/√3
      const Real positions[2] = { middle - offset, middle + offset };
      Real values[2];
      Functions.values(Volume.field, line, positions, 2, values);
      samples += 2 * hn::CountTrue(float_tag, active);
      add(rays, active, middle, (clean(values[0]) + clean(values[1])) * half, gathered);
      at = select(active, next, at);
    }
  }

  static HWY_INLINE Real middle(const Rays& rays, Real step)
  {
    return (max(step, rays.start) + hn::Min(step + real(1.0f), rays.end)) * real(0.5f);
  }
  /// The largest floats would add up to infinity, and infinity less infinity is not a number.
  static HWY_INLINE Real clean(Real density)
  {
    return clamp(density, hn::Zero(float_tag), real(1e30f));
  }

  HWY_INLINE void add(const Rays& rays,
    Mask active,
    Real position,
    Real amount,
    Gathered& gathered) const
  {
    gathered.optical_depth.add(hn::IfThenElseZero(active, amount));
    gathered.note_half_way(
      hn::And(active, gathered.optical_depth.total > real(HalfDepth)), rays, position);
  }

  const MarchTask& Task;
  const VolumeTask& Volume;
  FieldFunctions Functions;
  float HalfDepth;
};

MarchCount march_density_target(const MarchTask& task)
{
  return march_tile<DensityIntegrator>(task);
}

}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace brume
{
HWY_EXPORT(march_density_target);
MarchCount march_density(const MarchTask& task)
{
  return HWY_DYNAMIC_DISPATCH(march_density_target)(task);
}
}
#endif
