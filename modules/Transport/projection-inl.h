// The tiles of a projection: every volume by itself, then their sum in the film. Included once for
// each SIMD target.
#if defined(BRUME_PROJECTION_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BRUME_PROJECTION_INL_H
#undef BRUME_PROJECTION_INL_H
#else
#define BRUME_PROJECTION_INL_H
#endif

#include "Transport/tint-inl.h"

HWY_BEFORE_NAMESPACE();
namespace brume
{
namespace HWY_NAMESPACE
{

/// The pixels of a packet.
struct Projected
{
  Vec3<Real> radiance;
  Real opacity;
  Real depth; ///< world units from the near plane; infinity for none
  Real error;

  HWY_INLINE Projected()
    : radiance{ hn::Zero(float_tag), hn::Zero(float_tag), hn::Zero(float_tag) }
    , opacity(hn::Zero(float_tag))
    , depth(real(std::numeric_limits<float>::infinity()))
    , error(hn::Zero(float_tag))
  {
  }
};

inline void store(const MarchTask& task, const PacketRays& packet, Mask met, const Projected& pixel)
{
  HWY_ALIGN float channel[3][lane_count];
  HWY_ALIGN float passes[lane_count], depth[lane_count], error[lane_count], hit[lane_count];
  hn::Store(pixel.radiance.x, float_tag, channel[0]);
  hn::Store(pixel.radiance.y, float_tag, channel[1]);
  hn::Store(pixel.radiance.z, float_tag, channel[2]);
  hn::Store(max(real(1.0f) - pixel.opacity, hn::Zero(float_tag)), float_tag, passes);
  hn::Store(pixel.depth, float_tag, depth);
  hn::Store(pixel.error, float_tag, error);
  hn::Store(hn::IfThenElseZero(met, real(1.0f)), float_tag, hit);
  Film& film = *task.film;
  for (int lane = 0; lane < lane_count; ++lane)
  {
    if (!(hit[lane] > 0.0f))
    {
      continue;
    }
    const std::size_t place =
      static_cast<std::size_t>(packet.pixel_y(lane)) * film.width + packet.pixel_x(lane);
    for (int c = 0; c < 3; ++c)
    {
      film.radiance[c][place] = channel[c][lane];
      film.transmittance[c][place] = passes[lane];
    }
    film.depth[place] = depth[lane];
    film.error[place] = task.step_error + error[lane];
  }
}

/// A Projector has begin(), march(k, rays, mask of rays), which returns the number of samples, and
/// finish(pixels).
template <class Projector>
MarchCount project_tile(const MarchTask& task)
{
  MarchCount count;
  Projector projector(task);
  PacketRays packet(task);
  const int volumes = static_cast<int>(task.volumes->size());
  for (int y = task.y0; y < task.y1; y += packet_height)
  {
    for (int x = task.x0; x < task.x1; x += packet_width)
    {
      Rays rays;
      Mask met = hn::FirstN(float_tag, 0);
      int hits = 0;
      packet.begin(x, y);
      projector.begin();
      while (packet.next(rays, hits))
      {
        if (hits == 0)
        {
          continue;
        }
        const Mask hit = rays.end > hn::Zero(float_tag);
        met = hn::Or(met, hit);
        for (int k = 0; k < volumes; ++k)
        {
          const Mask active = hn::And(hit, rays.inside[k] > hn::Zero(float_tag));
          if (!hn::AllFalse(float_tag, active))
          {
            count.samples += projector.march(k, rays, active);
          }
        }
      }
      if (!hn::AllFalse(float_tag, met))
      {
        count.rays += hn::CountTrue(float_tag, met);
        Projected pixel;
        projector.finish(pixel);
        store(task, packet, met, pixel);
      }
    }
  }
  return count;
}

}
}
HWY_AFTER_NAMESPACE();

#endif
