// Any number of overlapping volumes, with masks, colours of their own and transfer functions of
// value and gradient: extinctions add up, each volume sends its own light. For every SIMD target.
#include "Transport/march_task.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "Transport/march_mixture.cxx"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "Transport/leap-inl.h"
#include "Transport/lookup-inl.h"
#include "Transport/surface-inl.h"

HWY_BEFORE_NAMESPACE();
namespace brume
{
namespace HWY_NAMESPACE
{

/// One volume of a mixture at one position.
class MixtureVolume
{
public:
  MixtureVolume(const VolumeTask& volume, double step)
    : Volume(volume)
    , Functions(field_functions(volume.field))
    , DepthScale(static_cast<float>(step) *
                 (volume.meaning == ValueMeaning::Density ? volume.extinction : volume.weight))
  {
    if (volume.masked)
    {
      LabelFunctions = field_functions(volume.labels);
    }
    for (int c = 0; c < 3 && volume.colour != VoxelColour::Value; ++c)
    {
      ColourFunctions[c] = field_functions(volume.colours[c]);
    }
  }

  const VisibleBricks* bricks() const { return Volume.bricks; }

  /// Optical depth of a stretch of `length` steps around a position, and its source.
  HWY_INLINE Real
  depth(const Line& line, Real position, Real length, Mask active, Vec3<Real>& colour) const
  {
    const Real zero = hn::Zero(float_tag);
    Real value;
    Functions.values(Volume.field, line, &position, 1, &value);
    colour = { zero, zero, zero };
    const Real scale = hn::IfThenElseZero(active, length * real(DepthScale));
    if (Volume.meaning == ValueMeaning::Density)
    {
      return hn::Min(clamp(value, zero, real(1e30f)) * scale, real(1e30f));
    }
    const Lookup table(*Volume.table);
    Vec3<Real> gradient{ zero, zero, zero };
    Classified matter;
    Lookup::Place place;
    Int first = hn::Zero(int_tag);
    Mask shown = active;
    if (Volume.masked)
    {
      first = first_node(line, position);
      shown = hn::And(shown, hn::RebindMask(float_tag, first > integer(-1)));
      first = hn::Max(first, hn::Zero(int_tag));
    }
    if (Volume.table->columns > 0)
    {
      Functions.gradient(Volume.field, line.at(position), gradient);
      matter = table.at_value_and_gradient(value, gradient_magnitude(Volume, gradient));
    }
    else
    {
      place = table.locate(table.position(value), first);
      matter.extinction = table.extinction(place);
    }
    matter.extinction = hn::IfThenElseZero(shown, matter.extinction);
    Real depth = matter.extinction * scale;
    if (hn::AllFalse(float_tag, depth > zero))
    {
      return depth;
    }
    colour = Volume.colour != VoxelColour::Value ? voxel_colour(table, line, position)
      : Volume.table->columns > 0                ? matter.colour
                                                 : table.colour(place);
    if (Volume.needs_gradient)
    {
      if (Volume.table->columns == 0)
      {
        Functions.gradient(Volume.field, line.at(position), gradient);
      }
      if (!Volume.table->gradient_factor.empty())
      {
        depth = depth * table.gradient_factor(gradient_magnitude(Volume, gradient), first);
      }
      if (Volume.shade.enabled)
      {
        const Vec3<Real> viewer = toward_viewer(Volume.shade, line);
        colour = shaded(Volume.shade, line, viewer, position, gradient, colour);
      }
    }
    return depth;
  }

private:
  /// For each lane the first node of its label's classification, or −1.
  HWY_INLINE Int first_node(const Line& line, Real position) const
  {
    Real label;
    LabelFunctions.values(Volume.labels, line, &position, 1, &label);
    return hn::GatherIndex(int_tag, Volume.first_node.data(), hn::ConvertTo(int_tag, label));
  }

  HWY_INLINE Vec3<Real> voxel_colour(const Lookup& table, const Line& line, Real position) const
  {
    Real component[3];
    const int count = Volume.colour == VoxelColour::RGB ? 3 : 1;
    for (int c = 0; c < count; ++c)
    {
      ColourFunctions[c].values(Volume.colours[c], line, &position, 1, &component[c]);
    }
    if (Volume.colour == VoxelColour::First)
    {
      return table.colour(table.locate(table.position(component[0])));
    }
    const Real scale = real(1.0f / 255.0f);
    return { component[0] * scale, component[1] * scale, component[2] * scale };
  }

  const VolumeTask& Volume;
  FieldFunctions Functions;
  FieldFunctions LabelFunctions{};
  FieldFunctions ColourFunctions[3]{};
  float DepthScale;
};

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
        const Real way = leap(rays, middle);
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
        const Real part =
          Volumes[k].depth(rays.lines[k], middle, (finish - begin) * rays.scale[k], inside, colour);
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
  /// Steps through which no volume can be seen.
  HWY_INLINE Real leap(const Rays& rays, Real position) const
  {
    Real way = real(std::numeric_limits<float>::max());
    for (std::size_t k = 0; k < Volumes.size(); ++k)
    {
      const Leaper leaper(Volumes[k].bricks(), rays.lines[k]);
      const Real here = leaper.leaps() ? leaper.way(position) : hn::Zero(float_tag);
      way = hn::IfThenElse(rays.inside[k] > hn::Zero(float_tag), hn::Min(way, here), way);
    }
    return hn::Min(way, rays.end);
  }

  const MarchTask& Task;
  std::vector<MixtureVolume> Volumes;
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
