// Gradients as the kernels use them: for gradient opacity and for shading. Included once for each
// SIMD target.
#if defined(BRUME_SURFACE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BRUME_SURFACE_INL_H
#undef BRUME_SURFACE_INL_H
#else
#define BRUME_SURFACE_INL_H
#endif

#include "Transport/march_task.h"
#include "Transport/rays-inl.h"

HWY_BEFORE_NAMESPACE();
namespace brume
{
namespace HWY_NAMESPACE
{

#include "Transport/shading-inl.h"

/// The magnitude of an index-space gradient, as a place in the tables that ask for it.
HWY_INLINE Real gradient_magnitude(const VolumeTask& volume, const Vec3<Real>& gradient)
{
  const Vec3<Real> scaled = gradient * broadcast3<Real>(volume.gradient_scale);
  return hn::Sqrt(dot(scaled, scaled));
}

/// The unit vectors of the world from places on a line toward its viewer.
HWY_INLINE Vec3<Real> toward_viewer(const ShadeModel& model, const Line& line)
{
  const Vec3<Real> along = multiply(model.world_from_index, 4, line.delta);
  return -(along * rsqrt_or_zero(dot(along, along)));
}

/// A gradient of index space in the world.
HWY_INLINE Vec3<Real> world_gradient(const ShadeModel& model, const Vec3<Real>& gradient)
{
  // Between values near the ends of float's range the differences overflow: no direction then.
  const Vec3<Real> slope = multiply(model.world_from_gradient, 3, gradient);
  const Mask finite = hn::IsFinite(dot(slope, slope));
  return { hn::IfThenElseZero(finite, slope.x),
    hn::IfThenElseZero(finite, slope.y),
    hn::IfThenElseZero(finite, slope.z) };
}

/// The light that matter of a colour sends to the viewer from a place of a line.
HWY_INLINE Vec3<Real> shaded(const ShadeModel& model,
  const Line& line,
  const Vec3<Real>& viewer,
  Real position,
  const Vec3<Real>& gradient,
  const Vec3<Real>& colour)
{
  Vec3<Real> world = line.delta;
  if (model.needs_place)
  {
    world = transform(model.world_from_index, line.at(position));
  }
  return shade<Real>(model, world_gradient(model, gradient), viewer, world, colour);
}

}
}
HWY_AFTER_NAMESPACE();

#endif
