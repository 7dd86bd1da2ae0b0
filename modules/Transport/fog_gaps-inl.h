// The fog along packets of rays where they are in no volume, in closed form. Included once for each SIMD
// target.
#if defined(BRUME_FOG_GAPS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BRUME_FOG_GAPS_INL_H
#undef BRUME_FOG_GAPS_INL_H
#else
#define BRUME_FOG_GAPS_INL_H
#endif

#include "Transport/fog_film.h"
#include "Transport/rays-inl.h"

HWY_BEFORE_NAMESPACE();
namespace brume
{
namespace HWY_NAMESPACE
{

/// What a packet meets in a gap.
struct FogGap
{
  HWY_ALIGN float depth[3][lane_count] = {};
  HWY_ALIGN float radiance[3][lane_count] = {};
  HWY_ALIGN float half_way[lane_count] = {}; ///< from the near plane, or +infinity
  HWY_ALIGN float here[lane_count] = {};     ///< 1 where a ray has a gap
};

/// Where the rays of a packet are in the fog: distances from their origins, in double precision.
class FogGaps
{
public:
  FogGaps(const FogModel& fog, const FogRays& rays)
    : Fog(fog)
    , Rays(rays)
  {
  }

  void begin(const PacketRays& packet)
  {
    for (int lane = 0; lane < lane_count; ++lane)
    {
      this->InTile[lane] = packet.in_tile(lane);
      if (this->InTile[lane])
      {
        const int x = packet.pixel_x(lane);
        const int y = packet.pixel_y(lane);
        this->Ray[lane] = this->Rays.ray(x, y);
        this->NearPlane[lane] = this->Rays.near_plane(x, y, this->Ray[lane]);
        this->End[lane] = this->Rays.end(x, y, this->Ray[lane]);
        this->At[lane] = 0.0;
      }
    }
  }

  /// The gap before a stretch. `through`: what passes so far, channel by channel.
  void before(const brume::HWY_NAMESPACE::Rays& rays, const float (*through)[lane_count], FogGap& gap)
  {
    HWY_ALIGN float start[lane_count], end[lane_count], offset[lane_count], step[lane_count];
    hn::Store(rays.start, float_tag, start);
    hn::Store(rays.end, float_tag, end);
    hn::Store(rays.offset, float_tag, offset);
    hn::Store(rays.step_world, float_tag, step);
    for (int lane = 0; lane < lane_count; ++lane)
    {
      if (!this->InTile[lane] || !(end[lane] > 0.0f))
      {
        continue;
      }
      const double zero = this->NearPlane[lane] + offset[lane];
      this->add(lane, zero + double(start[lane]) * step[lane], through, gap);
      this->At[lane] = zero + double(end[lane]) * step[lane];
    }
  }

  /// The gap behind the last stretch, to the surface or without end.
  void after(const float* left, const float (*through)[lane_count], FogGap& gap)
  {
    for (int lane = 0; lane < lane_count; ++lane)
    {
      if (this->InTile[lane] && !(left[lane] > 0.0f))
      {
        this->add(lane, this->End[lane], through, gap);
      }
    }
  }

  bool in_tile(int lane) const { return this->InTile[lane]; }

private:
  void add(int lane, double to, const float (*through)[lane_count], FogGap& gap)
  {
    const double from = this->At[lane];
    if (!(to > from))
    {
      return;
    }
    const FogRay& ray = this->Ray[lane];
    const double column = this->Fog.column(ray, from, to);
    const glm::dvec3 depth = this->Fog.optical_depth(column);
    const glm::dvec3 radiance = this->Fog.radiance(ray, from, to);
    gap.here[lane] = 1.0f;
    for (int c = 0; c < 3; ++c)
    {
      gap.depth[c][lane] = static_cast<float>(std::min(depth[c], 1e30));
      gap.radiance[c][lane] = static_cast<float>(radiance[c]);
    }
    const double half = this->Fog.half_column({ through[0][lane], through[1][lane], through[2][lane] });
    gap.half_way[lane] = std::numeric_limits<float>::infinity();
    if (half > 0.0 && half < column)
    {
      const double way = this->Fog.place_of_column(ray, from, half) - this->NearPlane[lane];
      gap.half_way[lane] = static_cast<float>(std::max(0.0, way));
    }
  }

  const FogModel& Fog;
  const FogRays& Rays;
  FogRay Ray[lane_count];
  bool InTile[lane_count] = {};
  double NearPlane[lane_count] = {};
  double End[lane_count] = {};
  double At[lane_count] = {};
};

}
}
HWY_AFTER_NAMESPACE();

#endif
