// Isosurfaces and slices, for every SIMD target.
#include "Transport/march_task.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "Transport/march_surfaces.cxx"
#include <hwy/aligned_allocator.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "Transport/cells-inl.h"
#include "Transport/leap-inl.h"
#include "Transport/tint-inl.h"

HWY_BEFORE_NAMESPACE();
namespace brume
{
namespace HWY_NAMESPACE
{

HWY_INLINE Real infinite()
{
  return real(std::numeric_limits<float>::infinity());
}

/// Numbers of packets, as many as wanted. (An allocator of the library's would not align them.)
class PacketArray
{
public:
  explicit PacketArray(std::size_t count)
    : Numbers(hwy::AllocateAligned<float>((count + 1) * lane_count))
  {
    for (std::size_t i = 0; i < count; ++i)
    {
      set(static_cast<int>(i), hn::Zero(float_tag));
    }
  }
  HWY_INLINE Real operator[](int i) const
  {
    return hn::Load(float_tag, Numbers.get() + static_cast<std::size_t>(i) * lane_count);
  }
  HWY_INLINE void set(int i, Real value)
  {
    hn::Store(value, float_tag, Numbers.get() + static_cast<std::size_t>(i) * lane_count);
  }

private:
  hwy::AlignedFreeUniquePtr<float[]> Numbers;
};

/// Adds a surface to what the rays of a mask have gathered.
HWY_INLINE void
pass_surface(const Tint& tint, Mask met, const Rays& rays, Real position, Gathered& gathered)
{
  const Real opacity = hn::IfThenElseZero(met, hn::Min(tint.opacity, real(1.0f)));
  const Real weight = gathered.transmittance * opacity;
  gathered.radiance = gathered.radiance + tint.colour * weight;
  gathered.transmittance = gathered.transmittance - weight;
  // The film's transmittance comes from an optical depth; 200 lets nothing pass.
  const Real passes = real(1.0f) - opacity;
  const Mask opaque = passes <= hn::Zero(float_tag);
  const Real depth = select(opaque,
    real(200.0f),
    hn::Neg(hn::Log(float_tag, select(opaque, real(1.0f), passes))));
  gathered.optical_depth.add(hn::IfThenElseZero(opacity > hn::Zero(float_tag), depth));
  gathered.note_half_way(
    hn::And(met, gathered.transmittance < real(0.5f)), rays, position);
}

/// In each cell the value is a cubic: between its turns it rises or falls, and passes each
/// isovalue at most once.
class SurfacesIntegrator
{
public:
  explicit SurfacesIntegrator(const MarchTask& task)
    : Task(task)
    , Volume(task.volumes->front())
    , Reader(Volume)
    , Count(static_cast<int>(task.isosurfaces.size()))
    , Above(task.isosurfaces.size())
    , Crossings(3 * task.isosurfaces.size())
  {
  }

  double depth_scale() const { return 1.0; }

  std::uint64_t march(const Rays& rays, Gathered& gathered)
  {
    const Line& line = rays.lines[0];
    const CellSteps steps(line, Volume.field, Volume.masked);
    const Leaper leaper(Volume.bricks, line);
    Real position = rays.start;
    Real end = rays.end;
    // 1 where a part of the ray begins, on either side of each value.
    Real begins = real(1.0f);
    std::uint64_t samples = 0;
    for (;;)
    {
      const Mask active = position < end;
      if (hn::AllFalse(float_tag, active))
      {
        return samples;
      }
      if (leaper.leaps())
      {
        const Real way = leaper.way(position);
        // A very short way might not move the position at all.
        const Mask leaping = hn::And(active, way > real(0.01f));
        if (!hn::AllFalse(float_tag, leaping))
        {
          // Where a ray begins, the side that it is on must be known first.
          const Mask unknown = hn::And(leaping, begins > hn::Zero(float_tag));
          if (!hn::AllFalse(float_tag, unknown))
          {
            find_sides(line.at(hn::Min(position, rays.end)), unknown);
            begins = hn::IfThenZeroElse(unknown, begins);
          }
          position = position + hn::IfThenElseZero(leaping, way);
          // What is left of the way is less than a thousandth of a step: into the next cell.
          continue;
        }
      }
      Real ends[cells_at_once + 1];
      steps.cells(hn::Min(position, end), end, cells_at_once, ends);
      for (int i = 0; i < cells_at_once; ++i)
      {
        samples += hn::CountTrue(float_tag, ends[i] < end);
      }
      Curve curves[cells_at_once];
      Reader.functions().curves(Volume.field, line, ends, cells_at_once, curves);
      for (int i = 0; i < cells_at_once; ++i)
      {
        const Mask inside = ends[i] < end;
        if (hn::AllFalse(float_tag, inside))
        {
          break;
        }
        cross(rays, ends[i], ends[i + 1], inside, curves[i], begins, gathered);
        const Mask leave = hn::And(inside, gathered.transmittance < real(Task.leave_below));
        gathered.left = hn::Or(gathered.left, leave);
        end = hn::IfThenZeroElse(leave, end);
      }
      position = ends[cells_at_once];
    }
  }

private:
  static constexpr int cells_at_once = 4;

  HWY_INLINE Real wanted(int i) const { return real(Task.isosurfaces[i]); }

  void find_sides(const Vec3<Real>& place, Mask rays)
  {
    const Real value = Reader.value(place);
    for (int i = 0; i < Count; ++i)
    {
      Above.set(
        i, select(rays, hn::IfThenElseZero(value >= wanted(i), real(1.0f)), Above[i]));
    }
  }

  /// Draws what the rays of a mask meet in one cell.
  void cross(const Rays& rays,
    Real from,
    Real to,
    Mask inside,
    const Curve& curve,
    Real& begins,
    Gathered& gathered)
  {
    Int first = hn::Zero(int_tag);
    if (Volume.masked)
    {
      first = Reader.first_node(rays.lines[0].at((from + to) * real(0.5f)));
      const Mask hidden =
        hn::And(inside, hn::RebindMask(float_tag, hn::Lt(first, hn::Zero(int_tag))));
      begins = select(hidden, real(1.0f), begins);
      inside = hn::AndNot(hidden, inside);
    }
    const Mask beginning = hn::And(inside, begins > hn::Zero(float_tag));
    if (!hn::AllFalse(float_tag, beginning))
    {
      for (int i = 0; i < Count; ++i)
      {
        Above.set(i,
          select(beginning, hn::IfThenElseZero(curve.a0 >= wanted(i), real(1.0f)), Above[i]));
      }
      begins = hn::IfThenZeroElse(beginning, begins);
    }
    const Real upper = curve.upper();
    const Real lower = curve.lower();
    bool any = false;
    for (int i = 0; i < Count; ++i)
    {
      const Mask above = Above[i] > hn::Zero(float_tag);
      const Mask may = hn::And(inside,
        hn::Or(hn::And(above, lower < wanted(i)), hn::AndNot(above, upper > wanted(i))));
      if (hn::AllFalse(float_tag, may))
      {
        forget_crossings(i);
        continue;
      }
      any = find_crossings(curve, i, inside) || any;
    }
    if (!any)
    {
      return;
    }
    // One after the other, as they lie on each ray.
    for (;;)
    {
      Real next = infinite();
      Int which = hn::Zero(int_tag);
      for (int i = 0; i < 3 * Count; ++i)
      {
        const Mask nearer = Crossings[i] < next;
        next = select(nearer, Crossings[i], next);
        which = hn::IfThenElse(hn::RebindMask(int_tag, nearer), integer(i), which);
      }
      const Mask met = next < infinite();
      if (hn::AllFalse(float_tag, met))
      {
        return;
      }
      Real value = hn::Zero(float_tag);
      Int surface = hn::Zero(int_tag);
      for (int i = 0; i < 3 * Count; ++i)
      {
        const Mask here = hn::And(met, hn::RebindMask(float_tag, hn::Eq(which, integer(i))));
        value = select(here, wanted(i / 3), value);
        surface = hn::IfThenElse(hn::RebindMask(int_tag, here), integer(i / 3), surface);
        Crossings.set(i, select(here, infinite(), Crossings[i]));
      }
      const Real position = hn::MulAdd(hn::IfThenElseZero(met, next), to - from, from);
      // The label's surfaces follow those of the labels before.
      const Int label =
        hn::ConvertTo(int_tag, hn::ConvertTo(float_tag, hn::Max(first, hn::Zero(int_tag))) *
            real(1.0f / (Volume.table->intervals + 1)) + real(0.5f));
      const Tint tint = Reader.surface(value, rays.lines[0], position,
        hn::Max(first, hn::Zero(int_tag)), Volume.surfaces, label * integer(Count) + surface);
      pass_surface(tint, met, rays, position, gathered);
    }
  }

  void forget_crossings(int i)
  {
    for (int place = 0; place < 3; ++place)
    {
      Crossings.set(3 * i + place, infinite());
    }
  }

  /// Where a cell's curve passes value number i: up to 3 places, the others infinite.
  bool find_crossings(const Curve& curve, int i, Mask inside)
  {
    const Real zero = hn::Zero(float_tag);
    const Real one = real(1.0f);
    // Turns outside the cell are at its ends.
    const auto within = [&](Real t) { return select(hn::And(t > zero, t < one), t, zero); };
    const Real turns[2] = { within(curve.turn(1.0f)), within(curve.turn(-1.0f)) };
    const Real ends[4] = { zero, hn::Min(turns[0], turns[1]), max(turns[0], turns[1]), one };
    Real side = Above[i];
    bool any = false;
    forget_crossings(i);
    // The value at the beginning may lie beyond already: there the nearest voxel has changed. It is
    // constant then, so that no more than 3 places are ever needed.
    for (int j = 0; j < 4; ++j)
    {
      const Real value = j == 0 ? curve.a0 : j == 3 ? curve.last : curve.at(ends[j]);
      const Mask above = side > zero;
      const Mask passed = hn::And(inside,
        hn::Or(hn::And(above, value < wanted(i)), hn::AndNot(above, value > wanted(i))));
      if (hn::AllFalse(float_tag, passed))
      {
        continue;
      }
      any = true;
      const Real root = j == 0 ? zero : bisect(curve, wanted(i), ends[j - 1], ends[j]);
      Mask left = passed;
      for (int place = 0; place < 3; ++place)
      {
        const Real crossing = Crossings[3 * i + place];
        const Mask here = hn::And(left, crossing == infinite());
        Crossings.set(3 * i + place, select(here, root, crossing));
        left = hn::AndNot(here, left);
      }
      side = select(passed, one - side, side);
    }
    Above.set(i, side);
    return any;
  }

  /// The place between two turns where the curve has the value.
  static HWY_INLINE Real bisect(const Curve& curve, Real value, Real from, Real to)
  {
    const Mask rising = curve.at(to) > curve.at(from);
    for (int i = 0; i < 22; ++i)
    {
      const Real middle = (from + to) * real(0.5f);
      const Mask before = hn::Xor(hn::Not(rising), curve.at(middle) < value);
      from = select(before, middle, from);
      to = select(before, to, middle);
    }
    return (from + to) * real(0.5f);
  }

  const MarchTask& Task;
  const VolumeTask& Volume;
  TintReader Reader;
  int Count;
  PacketArray Above;     ///< 1 where a ray is above a value, else 0
  PacketArray Crossings; ///< in the cell, in [0, 1]; three for each value
};

class SliceIntegrator
{
public:
  explicit SliceIntegrator(const MarchTask& task)
    : Volume(task.volumes->front())
    , Reader(Volume)
  {
  }

  double depth_scale() const { return 1.0; }

  std::uint64_t march(const Rays& rays, Gathered& gathered) const
  {
    const Line& line = rays.lines[0];
    const Vec3<Real> normal = broadcast3<Real>(Volume.slice);
    const Real slope = dot(normal, line.delta);
    const Mask crosses = hn::Abs(slope) > hn::Zero(float_tag);
    const Real position = hn::Neg(dot(normal, line.begin) + real(Volume.slice[3])) /
      hn::IfThenElse(crosses, slope, real(1.0f));
    Mask met = hn::And(crosses, rays.end > hn::Zero(float_tag));
    met = hn::And(met, hn::And(position >= rays.start, position <= rays.end));
    if (hn::AllFalse(float_tag, met))
    {
      return 0;
    }
    const Real at = hn::IfThenElseZero(met, position);
    const Vec3<Real> place = line.at(at);
    const Int first = Reader.first_node(place);
    met = hn::And(met, hn::RebindMask(float_tag, first > integer(-1)));
    const Tint tint = Reader.surface(Reader.value(place), line, at,
      hn::Max(first, hn::Zero(int_tag)), nullptr, hn::Zero(int_tag));
    pass_surface(tint, met, rays, at, gathered);
    return hn::CountTrue(float_tag, met);
  }

private:
  const VolumeTask& Volume;
  TintReader Reader;
};

MarchCount march_surfaces_target(const MarchTask& task)
{
  return march_tile<SurfacesIntegrator>(task);
}
MarchCount march_slice_target(const MarchTask& task)
{
  return march_tile<SliceIntegrator>(task);
}

}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace brume
{
HWY_EXPORT(march_surfaces_target);
HWY_EXPORT(march_slice_target);
MarchCount march_surfaces(const MarchTask& task)
{
  return HWY_DYNAMIC_DISPATCH(march_surfaces_target)(task);
}
MarchCount march_slice(const MarchTask& task)
{
  return HWY_DYNAMIC_DISPATCH(march_slice_target)(task);
}
}
#endif
