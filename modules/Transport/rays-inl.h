// Packets of rays: made from pixels, and what they gather written back to the film. Included once
// for each SIMD target.
#if defined(BRUME_RAYS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BRUME_RAYS_INL_H
#undef BRUME_RAYS_INL_H
#else
#define BRUME_RAYS_INL_H
#endif

#include "Transport/field-inl.h"
#include "Transport/march_task.h"
#include "Transport/optics.h"
#include "Transport/pixel_hash.h"

#include <algorithm>
#include <cmath>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace brume
{
namespace HWY_NAMESPACE
{

/// Pixels of a packet: as square as the lanes allow.
constexpr int packet_width = lane_count >= 8 ? 4 : lane_count >= 2 ? 2 : 1;
constexpr int packet_height = lane_count / packet_width;

constexpr int most_volumes = 32;

/// One stretch of each ray of a packet. Step number i covers the positions from max(i, start) to
/// min(i + 1, end): only the first and the last may be shorter than 1.
struct Rays
{
  Real start;                ///< in [0, 1)
  Real end;                  ///< 0 for a ray that misses
  Real offset;               ///< world units from the near plane to position 0
  Real step_world;           ///< world units in a step
  Line lines[most_volumes];  ///< in each volume's index space
  Real scale[most_volumes];  ///< of Task.step, the length of a step in each volume's data
  Real inside[most_volumes]; ///< 1 where the stretch lies in the volume, else 0
};

/// What a packet has gathered on its way.
struct Gathered
{
  Vec3<Real> radiance;
  Real transmittance;
  Sum optical_depth; ///< times a factor that the integrator knows
  Real half_way;     ///< where half is absorbed, world units from the near plane
  Real error;        ///< estimate of what the steps did to the pixel
  Mask left;         ///< rays that were left before their end

  HWY_INLINE Gathered()
    : radiance{ hn::Zero(float_tag), hn::Zero(float_tag), hn::Zero(float_tag) }
    , transmittance(real(1.0f))
    , half_way(real(std::numeric_limits<float>::infinity()))
    , error(hn::Zero(float_tag))
    , left(hn::FirstN(float_tag, 0))
  {
  }

  /// To be called at each position with what passes there.
  HWY_INLINE void note_half_way(Mask crossed, const Rays& rays, Real position)
  {
    const Real place = hn::MulAdd(position, rays.step_world, rays.offset);
    half_way = select(hn::And(crossed, place < half_way), place, half_way);
  }
};

/// The rays of one packet of pixels, stretch by stretch.
class PacketRays
{
public:
  explicit PacketRays(const MarchTask& task)
    : Task(task)
    , Volumes(static_cast<int>(task.volumes->size()))
  {
  }

  /// Begins with the packet whose lowest pixel is (x, y).
  void begin(int x, int y)
  {
    this->X = x;
    this->Y = y;
    this->Next = 0;
    this->Count = 1;
    if (this->Task.rays->simple())
    {
      return;
    }
    this->Count = 0;
    for (int lane = 0; lane < lane_count; ++lane)
    {
      this->Stretches[lane].clear();
      if (this->in_tile(lane))
      {
        this->Task.rays->stretches(this->pixel_x(lane), this->pixel_y(lane), this->Stretches[lane]);
        this->Count = std::max(this->Count, this->Stretches[lane].size());
      }
    }
  }

  /// The next stretch of each ray; false after the last. `hits` counts the rays that have one.
  bool next(Rays& rays, int& hits)
  {
    if (this->Next == this->Count)
    {
      return false;
    }
    HWY_ALIGN float start[lane_count] = {};
    HWY_ALIGN float end[lane_count] = {};
    HWY_ALIGN float offset[lane_count] = {};
    HWY_ALIGN float world[lane_count] = {};
    hits = 0;
    for (int k = 0; k < this->Volumes; ++k)
    {
      HWY_ALIGN float line[6][lane_count] = {};
      HWY_ALIGN float scale[lane_count] = {};
      HWY_ALIGN float inside[lane_count] = {};
      for (int lane = 0; lane < lane_count; ++lane)
      {
        RaySegment segment;
        double step = this->Task.step;
        if (!this->find(lane, k, segment, step, inside[lane]))
        {
          continue;
        }
        // `step` is what a step is here, in this volume's data: as long as Task.step in the volume
        // where it is longest.
        const double count = segment.length / step;
        const double skipped = this->Task.jitter ? this->jitter(lane) : 0.0;
        const glm::dvec3 delta = (segment.end - segment.begin) / count;
        const glm::dvec3 begin = segment.begin - delta * skipped;
        for (int axis = 0; axis < 3; ++axis)
        {
          line[axis][lane] = static_cast<float>(begin[axis]);
          line[3 + axis][lane] = static_cast<float>(delta[axis]);
        }
        scale[lane] = static_cast<float>(step / this->Task.step);
        if (k == 0)
        {
          ++hits;
          start[lane] = static_cast<float>(skipped);
          end[lane] = static_cast<float>(count + skipped);
          world[lane] = static_cast<float>(step * segment.world_scale);
          offset[lane] =
            static_cast<float>((segment.start_offset - skipped * step) * segment.world_scale);
        }
      }
      rays.lines[k] = {
        { hn::Load(float_tag, line[0]),
          hn::Load(float_tag, line[1]),
          hn::Load(float_tag, line[2]) },
        { hn::Load(float_tag, line[3]), hn::Load(float_tag, line[4]), hn::Load(float_tag, line[5]) }
      };
      rays.scale[k] = hn::Load(float_tag, scale);
      rays.inside[k] = hn::Load(float_tag, inside);
    }
    rays.start = hn::Load(float_tag, start);
    rays.end = hn::Load(float_tag, end);
    rays.offset = hn::Load(float_tag, offset);
    rays.step_world = hn::Load(float_tag, world);
    ++this->Next;
    return true;
  }

  int pixel_x(int lane) const { return this->X + lane % packet_width; }
  int pixel_y(int lane) const { return this->Y + lane / packet_width; }
  bool in_tile(int lane) const
  {
    return this->pixel_x(lane) < this->Task.x1 && this->pixel_y(lane) < this->Task.y1;
  }

private:
  /// A lane's stretch in volume k, and the length of a step there; false where it has none.
  bool find(int lane, int k, RaySegment& segment, double& step, float& inside) const
  {
    const RayMaker& rays = *this->Task.rays;
    if (!this->in_tile(lane))
    {
      return false;
    }
    const int x = this->pixel_x(lane);
    const int y = this->pixel_y(lane);
    if (rays.simple())
    {
      segment = rays.segment(x, y);
      inside = 1.0f;
      return segment.length > 0.0;
    }
    if (this->Next >= this->Stretches[lane].size())
    {
      return false;
    }
    const RayStretch& stretch = this->Stretches[lane][this->Next];
    const RayWay way = rays.way(x, y, k);
    double longest = way.length;
    for (int other = 0; other < this->Volumes; ++other)
    {
      longest = other == k ? longest : std::max(longest, rays.way(x, y, other).length);
    }
    segment = way.part(stretch.begin, stretch.end);
    step *= way.length / longest;
    inside = static_cast<float>(stretch.volumes >> k & 1);
    return segment.length > 0.0;
  }

  /// The part of the first step that is left out, in [0, 1): even over the pixels of a
  /// neighbourhood.
  double jitter(int lane) const { return pixel_hash(this->pixel_x(lane), this->pixel_y(lane)); }

  const MarchTask& Task;
  int Volumes;
  int X = 0;
  int Y = 0;
  std::size_t Next = 0;
  std::size_t Count = 0;
  std::vector<RayStretch> Stretches[lane_count];
};

/// Writes what a packet gathered to the film. `depth_scale` makes optical depths of the sums.
inline void store(const MarchTask& task,
  const PacketRays& packet,
  Mask met,
  const Gathered& gathered,
  double depth_scale)
{
  HWY_ALIGN float channel[3][lane_count];
  HWY_ALIGN float depth[lane_count], lost[lane_count], half_way[lane_count], hit[lane_count];
  HWY_ALIGN float left[lane_count], error[lane_count];
  hn::Store(gathered.radiance.x, float_tag, channel[0]);
  hn::Store(gathered.radiance.y, float_tag, channel[1]);
  hn::Store(gathered.radiance.z, float_tag, channel[2]);
  hn::Store(gathered.optical_depth.total, float_tag, depth);
  hn::Store(gathered.optical_depth.lost, float_tag, lost);
  hn::Store(gathered.half_way, float_tag, half_way);
  hn::Store(gathered.error, float_tag, error);
  hn::Store(hn::IfThenElseZero(met, real(1.0f)), float_tag, hit);
  hn::Store(hn::IfThenElseZero(gathered.left, gathered.transmittance), float_tag, left);
  Film& film = *task.film;
  for (int lane = 0; lane < lane_count; ++lane)
  {
    if (!(hit[lane] > 0.0f))
    {
      continue;
    }
    const std::size_t pixel =
      static_cast<std::size_t>(packet.pixel_y(lane)) * film.width + packet.pixel_x(lane);
    double optical_depth = (double(depth[lane]) - double(lost[lane])) * depth_scale;
    if (!std::isfinite(optical_depth))
    {
      // Densities near the end of float's range: their sum overflowed, and nothing passes.
      optical_depth = std::numeric_limits<double>::infinity();
    }
    const float transmittance = static_cast<float>(transmittance_from_optical_depth(optical_depth));
    for (int c = 0; c < 3; ++c)
    {
      film.radiance[c][pixel] = channel[c][lane];
      film.transmittance[c][pixel] = transmittance;
    }
    film.depth[pixel] = half_way[lane];
    film.error[pixel] = task.step_error + error[lane] + left[lane] * task.brightest;
  }
}

/// Marches all packets of the task's tile. An Integrator has march(rays, gathered), which returns
/// the number of samples, and depth_scale().
template <class Integrator>
MarchCount march_tile(const MarchTask& task)
{
  MarchCount count;
  Integrator integrator(task);
  PacketRays packet(task);
  for (int y = task.y0; y < task.y1; y += packet_height)
  {
    for (int x = task.x0; x < task.x1; x += packet_width)
    {
      Gathered gathered;
      Rays rays;
      Mask met = hn::FirstN(float_tag, 0);
      int hits = 0;
      int most_hits = 0;
      packet.begin(x, y);
      while (packet.next(rays, hits))
      {
        if (hits == 0)
        {
          continue;
        }
        most_hits = std::max(most_hits, hits);
        met = hn::Or(met, rays.end > hn::Zero(float_tag));
        rays.end = hn::IfThenZeroElse(gathered.left, rays.end);
        count.samples += integrator.march(rays, gathered);
      }
      count.rays += most_hits;
      if (most_hits > 0)
      {
        store(task, packet, met, gathered, integrator.depth_scale());
      }
    }
  }
  return count;
}

}
}
HWY_AFTER_NAMESPACE();

#endif
