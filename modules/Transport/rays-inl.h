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
#include <memory>
#include <type_traits>

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

  /// The optical depth of a channel.
  HWY_INLINE const Sum& depth_of(int) const { return optical_depth; }

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
#if HWY_TARGET != HWY_SCALAR
    if (this->Task.rays->simple())
    {
      ++this->Next;
      hits = this->make_simple(rays);
      return true;
    }
#endif
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

  int pixel_x(int lane) const
  {
    return this->X + lane % packet_width;
  }
  int pixel_y(int lane) const
  {
    return this->Y + lane / packet_width;
  }
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

#if HWY_TARGET != HWY_SCALAR
  using DoubleTag = hn::Repartition<double, FloatTag>;
  using Double = hn::Vec<DoubleTag>;

  /// The only stretch of each ray: RayMaker::segment, for half a packet of doubles at a time.
  /// Returns the number of rays that meet the volume.
  int make_simple(Rays& rays) const
  {
    HWY_ALIGN double x[lane_count], y[lane_count], far[lane_count], skipped[lane_count];
    const float* surface = this->Task.rays->surface_depth();
    for (int lane = 0; lane < lane_count; ++lane)
    {
      const bool here = this->in_tile(lane);
      const int px = here ? this->pixel_x(lane) : this->Task.x1 - 1;
      const int py = here ? this->pixel_y(lane) : this->Task.y1 - 1;
      x[lane] = px;
      y[lane] = py;
      far[lane] = 1.0;
      if (surface)
      {
        const auto pixel = static_cast<std::size_t>(py) * this->Task.rays->width() + px;
        far[lane] = std::min(1.0, double(surface[pixel]));
      }
      far[lane] = here ? far[lane] : -1.0; // a ray of no length
      skipped[lane] = this->Task.jitter ? this->jitter(lane) : 0.0;
    }
    const DoubleTag d;
    HalfRays half[2];
    for (int i = 0; i < 2; ++i)
    {
      const int first = i * (lane_count / 2);
      half[i] = this->make_half(hn::Load(d, x + first),
        hn::Load(d, y + first),
        hn::Load(d, far + first),
        hn::Load(d, skipped + first));
    }
    rays.lines[0] = { { join(half, 0), join(half, 1), join(half, 2) },
      { join(half, 3), join(half, 4), join(half, 5) } };
    rays.start = join(half, 6);
    rays.end = join(half, 7);
    rays.offset = join(half, 8);
    rays.step_world = join(half, 9);
    rays.scale[0] = rays.inside[0] = real(1.0f);
    return static_cast<int>(hn::CountTrue(float_tag, rays.end > hn::Zero(float_tag)));
  }

  /// Begin, delta (x, y, z), start, end, offset, length of a step in world units.
  struct HalfRays
  {
    Double value[10];
  };

  static HWY_INLINE Real join(const HalfRays half[2], int i)
  {
    const hn::Rebind<float, DoubleTag> narrow;
    return hn::Combine(
      float_tag, hn::DemoteTo(narrow, half[1].value[i]), hn::DemoteTo(narrow, half[0].value[i]));
  }

  HWY_INLINE HalfRays make_half(Double x, Double y, Double far, Double skipped) const
  {
    const DoubleTag d;
    const auto set = [d](double value) { return hn::Set(d, value); };
    const Double zero = hn::Zero(d);
    const Double one = set(1.0);
    const RayMaker::Frame& frame = this->Task.rays->frame(0);
    const glm::dmat4& m = frame.index_from_clip;
    const Double ndc_x = hn::MulSub(x + x + one, set(1.0 / this->Task.rays->width()), one);
    const Double ndc_y = hn::MulSub(y + y + one, set(1.0 / this->Task.rays->height()), one);
    Double near_point[4];
    Double far_point[4];
    for (int i = 0; i < 4; ++i)
    {
      const Double middle =
        hn::MulAdd(set(m[0][i]), ndc_x, hn::MulAdd(set(m[1][i]), ndc_y, set(m[3][i])));
      near_point[i] = middle - set(m[2][i]);
      far_point[i] = hn::MulAdd(set(m[2][i]), far, middle);
    }
    const Double near_scale = one / near_point[3];
    const Double far_scale = one / far_point[3];
    Double from[3];
    Double way[3];
    Double begin = zero;
    Double end = one;
    auto hit = far > set(-1.0);
    for (int axis = 0; axis < 3; ++axis)
    {
      from[axis] = near_point[axis] * near_scale;
      way[axis] = hn::MulSub(far_point[axis], far_scale, from[axis]);
      const Double to_lower = set(frame.lower[axis]) - from[axis];
      const Double to_upper = set(frame.upper[axis]) - from[axis];
      const auto still = way[axis] == zero;
      const Double inverse = one / hn::IfThenElse(still, one, way[axis]);
      const Double a = to_lower * inverse;
      const Double b = to_upper * inverse;
      begin = hn::IfThenElse(still, begin, hn::Max(begin, hn::Min(a, b)));
      end = hn::IfThenElse(still, end, hn::Min(end, hn::Max(a, b)));
      const auto outside = hn::Or(to_lower > zero, to_upper < zero);
      hit = hn::AndNot(hn::And(still, outside), hit);
    }
    const auto length = [&](const glm::dmat3& to)
    {
      Double square = zero;
      for (int i = 0; i < 3; ++i)
      {
        const Double component = hn::MulAdd(
          set(to[0][i]), way[0], hn::MulAdd(set(to[1][i]), way[1], set(to[2][i]) * way[2]));
        square = hn::MulAdd(component, component, square);
      }
      return hn::Sqrt(square);
    };
    const Double whole = length(frame.data_from_index);
    const Double world = length(frame.world_from_index);
    hit = hn::And(hit, hn::And(begin < end, hn::And(whole > zero, whole < set(1e300))));
    const Double part = set(this->Task.step) / hn::IfThenElse(hit, whole, one); // a step
    HalfRays rays;
    for (int axis = 0; axis < 3; ++axis)
    {
      const Double delta = way[axis] * part;
      rays.value[axis] =
        hn::IfThenElseZero(hit, hn::MulAdd(way[axis], begin, from[axis]) - delta * skipped);
      rays.value[3 + axis] = hn::IfThenElseZero(hit, delta);
    }
    rays.value[6] = skipped;
    rays.value[7] =
      hn::IfThenElseZero(hit, hn::MulAdd(end - begin, whole * set(1.0 / this->Task.step), skipped));
    rays.value[8] = hn::IfThenElseZero(hit, world * (begin - skipped * part));
    rays.value[9] = hn::IfThenElseZero(hit, world * part);
    return rays;
  }

#endif

  /// The part of the first step that is left out, in [0, 1): even over the pixels of a
  /// neighbourhood.
  double jitter(int lane) const
  {
    return pixel_hash(this->pixel_x(lane), this->pixel_y(lane));
  }

  const MarchTask& Task;
  int Volumes;
  int X = 0;
  int Y = 0;
  std::size_t Next = 0;
  std::size_t Count = 0;
  std::vector<RayStretch> Stretches[lane_count];
};

/// Writes what a packet gathered to the film. `depth_scale` makes optical depths of the sums.
template <class Record>
void store(const MarchTask& task,
  const PacketRays& packet,
  Mask met,
  const Record& gathered,
  double depth_scale)
{
  constexpr int channels = std::is_same_v<Record, Gathered> ? 1 : 3;
  HWY_ALIGN float channel[3][lane_count];
  HWY_ALIGN float depth[channels][lane_count], lost[channels][lane_count];
  HWY_ALIGN float half_way[lane_count], hit[lane_count];
  HWY_ALIGN float left[lane_count], error[lane_count];
  hn::Store(gathered.radiance.x, float_tag, channel[0]);
  hn::Store(gathered.radiance.y, float_tag, channel[1]);
  hn::Store(gathered.radiance.z, float_tag, channel[2]);
  for (int c = 0; c < channels; ++c)
  {
    hn::Store(gathered.depth_of(c).total, float_tag, depth[c]);
    hn::Store(gathered.depth_of(c).lost, float_tag, lost[c]);
  }
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
    float transmittance = 1.0f;
    for (int c = 0; c < 3; ++c)
    {
      if (c < channels)
      {
        double optical_depth = (double(depth[c][lane]) - double(lost[c][lane])) * depth_scale;
        if (!std::isfinite(optical_depth))
        {
          // Densities near the end of float's range: their sum overflowed, and nothing passes.
          optical_depth = std::numeric_limits<double>::infinity();
        }
        transmittance = static_cast<float>(transmittance_from_optical_depth(optical_depth));
      }
      film.radiance[c][pixel] = channel[c][lane];
      film.transmittance[c][pixel] = transmittance;
    }
    film.depth[pixel] = half_way[lane];
    film.error[pixel] =
      task.step_error + error[lane] + (left[lane] > 0.0f ? left[lane] * task.brightest : 0.0f);
  }
}

/// Marches one packet. Returns its samples and rays. An integrator may have begin_packet and
/// end_packet, for what its rays meet outside of all volumes.
template <class Integrator, class Record>
MarchCount march_packet(
  Integrator& integrator, PacketRays& packet, int x, int y, Record& gathered, Mask& met)
{
  MarchCount count;
  Rays rays;
  int hits = 0;
  packet.begin(x, y);
  if constexpr (requires { integrator.begin_packet(packet); })
  {
    integrator.begin_packet(packet);
  }
  while (packet.next(rays, hits))
  {
    if (hits == 0)
    {
      continue;
    }
    count.rays = std::max(count.rays, static_cast<std::uint64_t>(hits));
    met = hn::Or(met, rays.end > hn::Zero(float_tag));
    rays.end = hn::IfThenZeroElse(gathered.left, rays.end);
    count.samples += integrator.march(rays, gathered);
  }
  if constexpr (requires { integrator.end_packet(gathered, met); })
  {
    integrator.end_packet(gathered, met);
  }
  return count;
}

/// What an integrator gathers.
template <class Integrator>
struct RecordOf
{
  using type = Gathered;
};

/// What marches with one length of step.
template <class Integrator>
struct Level
{
  MarchTask task;
  Integrator integrator;
  PacketRays packet;

  Level(const MarchTask& whole, double step)
    : task(with_step(whole, step))
    , integrator(task)
    , packet(task)
  {
  }
  static MarchTask with_step(MarchTask task, double step)
  {
    task.step = step;
    return task;
  }
};

/// Marches all packets of the task's tile; those whose error seems too large again with half the
/// step. An Integrator has march(rays, gathered), which returns the number of samples, and
/// depth_scale().
template <class Integrator>
MarchCount march_tile(const MarchTask& task)
{
  MarchCount count;
  std::unique_ptr<Level<Integrator>> levels[most_refinements + 1];
  for (int y = task.y0; y < task.y1; y += packet_height)
  {
    for (int x = task.x0; x < task.x1; x += packet_width)
    {
      for (int i = 0;; ++i)
      {
        if (!levels[i])
        {
          levels[i] =
            std::make_unique<Level<Integrator>>(task, task.step / static_cast<double>(1 << i));
        }
        Level<Integrator>& level = *levels[i];
        typename RecordOf<Integrator>::type gathered;
        Mask met = hn::FirstN(float_tag, 0);
        const MarchCount packet =
          march_packet(level.integrator, level.packet, x, y, gathered, met);
        count.samples += packet.samples;
        if (i < task.refinements && packet.rays > 0 &&
          !hn::AllFalse(float_tag, gathered.error > real(task.refine_error)))
        {
          continue;
        }
        count.rays += packet.rays;
        if (!hn::AllFalse(float_tag, met))
        {
          store(level.task, level.packet, met, gathered, level.integrator.depth_scale());
        }
        break;
      }
    }
  }
  return count;
}

}
}
HWY_AFTER_NAMESPACE();

#endif
