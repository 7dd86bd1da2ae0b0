// The largest or smallest value on a ray, for every SIMD target.
#include "Transport/march_task.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "Transport/march_extreme.cxx"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "Transport/cells-inl.h"
#include "Transport/projection-inl.h"

HWY_BEFORE_NAMESPACE();
namespace brume
{
namespace HWY_NAMESPACE
{

/// Cells that are walked between two looks at the bricks.
constexpr int cells_between_looks = 4;

/// Every cell of every ray is looked at, or lies in a brick none of whose voxels is above what the
/// ray has met already; within a cell the value is a cubic, whose largest value is known.
class ExtremeProjector
{
public:
  explicit ExtremeProjector(const MarchTask& task)
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
      Found[k] = Best();
    }
  }

  std::uint64_t march(int k, const Rays& rays, Mask active)
  {
    const VolumeTask& volume = (*Task.volumes)[k];
    const Line& line = rays.lines[k];
    const CellSteps steps(line, volume.field, volume.masked);
    Best& found = Found[k];
    Extreme best{ found.value, real(-1.0f) };
    Int first = found.first;
    Real position = hn::IfThenElseZero(active, rays.start);
    Real end = hn::IfThenElseZero(active, rays.end);
    std::uint64_t samples = 0;
    if (!volume.masked)
    {
      samples += seed(k, line, steps, position, end, best);
    }
    for (;;)
    {
      // A volume that has been met at its largest value is done.
      const Mask going = hn::And(position < end, best.value < real(volume.top));
      if (hn::AllFalse(float_tag, going))
      {
        break;
      }
      Real exit;
      const Int brick = steps.brick(volume.brick_dims, volume.brick_shift, position, exit);
      const Real bound = hn::GatherIndex(float_tag, volume.bounds, brick);
      const Mask skips = hn::And(going, bound <= best.value);
      if (!hn::AllFalse(float_tag, skips))
      {
        position = select(skips, exit, position);
        continue;
      }
      if (volume.masked)
      {
        walk_labels(k, line, steps, end, going, position, best, first);
        samples += hn::CountTrue(float_tag, going);
        continue;
      }
      Real ends[cells_between_looks + 1];
      steps.cells(select(going, position, end), end, cells_between_looks, ends);
      for (int i = 0; i < cells_between_looks; ++i)
      {
        samples += hn::CountTrue(float_tag, ends[i] < end);
      }
      // Rays that are done take no part.
      Extreme here{ select(going, best.value, infinite()), best.position };
      Readers[k].functions().extremes(
        volume.field, line, ends, cells_between_looks, volume.sign, here);
      best.value = select(going, here.value, best.value);
      best.position = select(going, here.position, best.position);
      position = ends[cells_between_looks];
    }
    const Mask higher = hn::And(active, best.value > found.value);
    const Vec3<Real> place = line.at(best.position);
    found.value = select(higher, best.value, found.value);
    found.place.x = select(higher, place.x, found.place.x);
    found.place.y = select(higher, place.y, found.place.y);
    found.place.z = select(higher, place.z, found.place.z);
    found.depth =
      select(higher, hn::MulAdd(best.position, rays.step_world, rays.offset), found.depth);
    found.first = hn::IfThenElse(hn::RebindMask(int_tag, higher), first, found.first);
    return samples;
  }

  void finish(Projected& pixel) const
  {
    Real most = hn::Zero(float_tag);
    for (std::size_t k = 0; k < Readers.size(); ++k)
    {
      const VolumeTask& volume = (*Task.volumes)[k];
      const Best& found = Found[k];
      const Mask some = found.value > hn::Neg(infinite());
      if (hn::AllFalse(float_tag, some))
      {
        continue;
      }
      const Tint tint = Readers[k].projected(
        hn::IfThenElseZero(some, found.value) * real(volume.sign), found.place, found.first);
      const Real weight = hn::IfThenElseZero(some, tint.opacity * real(volume.weight));
      pixel.radiance = pixel.radiance + tint.colour * weight;
      pixel.opacity = pixel.opacity + weight;
      pixel.depth = select(weight > most, found.depth, pixel.depth);
      most = max(most, weight);
    }
    pixel.depth = select(pixel.opacity > real(0.5f), pixel.depth, infinite());
  }

private:
  struct Best
  {
    Real value; ///< times the sign
    Vec3<Real> place;
    Real depth;
    Int first;

    HWY_INLINE Best()
      : value(hn::Neg(infinite()))
      , place{ hn::Zero(float_tag), hn::Zero(float_tag), hn::Zero(float_tag) }
      , depth(infinite())
      , first(hn::Zero(int_tag))
    {
    }
  };

  static HWY_INLINE Real infinite() { return real(std::numeric_limits<float>::infinity()); }

  /// A first guess: the value in the middle of each brick's part of the ray that may be larger than
  /// the guess before. A good one spares most cells. It is put a little below what was read, so
  /// that the cell that holds it is found for its own sake.
  HWY_INLINE std::uint64_t seed(int k,
    const Line& line,
    const CellSteps& steps,
    Real position,
    Real end,
    Extreme& best) const
  {
    const VolumeTask& volume = (*Task.volumes)[k];
    const Real sign = real(volume.sign);
    const Real below = real(volume.rounding);
    std::uint64_t samples = 0;
    for (;;)
    {
      const Mask going = hn::And(position < end, best.value < real(volume.top));
      if (hn::AllFalse(float_tag, going))
      {
        return samples;
      }
      Real exit;
      const Int brick = steps.brick(volume.brick_dims, volume.brick_shift, position, exit);
      const Real bound = hn::GatherIndex(float_tag, volume.bounds, brick);
      exit = hn::Min(exit, end);
      const Mask wanted = hn::And(going, bound > best.value);
      if (!hn::AllFalse(float_tag, wanted))
      {
        const Real middle =
          hn::IfThenElseZero(going, (position + exit) * real(0.5f));
        Real value;
        Readers[k].functions().values(volume.field, line, &middle, 1, &value);
        samples += hn::CountTrue(float_tag, wanted);
        value = value * sign - below;
        const Mask higher = hn::And(wanted, value > best.value);
        best.value = select(higher, value, best.value);
        best.position = select(higher, middle, best.position);
      }
      position = select(going, exit, position);
    }
  }

  /// One cell, or the part of it that is nearest to one label.
  HWY_INLINE void walk_labels(int k,
    const Line& line,
    const CellSteps& steps,
    Real end,
    Mask going,
    Real& position,
    Extreme& best,
    Int& first) const
  {
    const VolumeTask& volume = (*Task.volumes)[k];
    Real ends[2];
    steps.cells(position, select(going, end, position), 1, ends);
    const Int label = Readers[k].first_node(line.at((ends[0] + ends[1]) * real(0.5f)));
    const Mask shown = hn::And(going, hn::RebindMask(float_tag, label > integer(-1)));
    if (!hn::AllFalse(float_tag, shown))
    {
      Extreme here{ select(shown, best.value, infinite()), best.position };
      Readers[k].functions().extremes(volume.field, line, ends, 1, volume.sign, here);
      const Mask higher = hn::And(shown, here.value > best.value);
      best.value = select(higher, here.value, best.value);
      best.position = select(higher, here.position, best.position);
      first = hn::IfThenElse(hn::RebindMask(int_tag, higher), label, first);
    }
    position = ends[1];
  }

  const MarchTask& Task;
  std::vector<TintReader> Readers;
  Best Found[most_volumes];
};

MarchCount march_extreme_target(const MarchTask& task)
{
  return project_tile<ExtremeProjector>(task);
}

}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace brume
{
HWY_EXPORT(march_extreme_target);
MarchCount march_extreme(const MarchTask& task)
{
  return HWY_DYNAMIC_DISPATCH(march_extreme_target)(task);
}
}
#endif
