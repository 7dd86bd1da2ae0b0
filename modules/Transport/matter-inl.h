// What a volume holds at a place, before any light: optical depth, colour, gradient. Of any meaning,
// with masks, colours of its own and transfer functions of value and gradient. Included once for each
// SIMD target.
#if defined(BRUME_MATTER_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BRUME_MATTER_INL_H
#undef BRUME_MATTER_INL_H
#else
#define BRUME_MATTER_INL_H
#endif

#include "Transport/leap-inl.h"
#include "Transport/lookup-inl.h"
#include "Transport/surface-inl.h"

HWY_BEFORE_NAMESPACE();
namespace brume
{
namespace HWY_NAMESPACE
{

/// What was found at a position; filled by MatterVolume::look().
struct Matter
{
  /// Optical depth of the stretch that the position stands for, and its length times the density (of
  /// classified volumes: the optical depth again).
  Real depth;
  Real amount;

  // Where the rest is to be found.
  Lookup::Place place;
  Vec3<Real> classified; ///< colour by a function of value and gradient
  Vec3<Real> gradient;   ///< in index space, where it was looked up
  bool has_gradient;
};

class MatterVolume
{
public:
  /// `step`: the length of one unit of a line's positions, in the data's units.
  MatterVolume(const VolumeTask& volume, double step)
    : Volume(volume)
    , Functions(field_functions(volume.field))
    , Step(static_cast<float>(step))
    , Scale(volume.meaning == ValueMeaning::Density ? volume.extinction : volume.weight)
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

  const VolumeTask& volume() const { return Volume; }

  /// Looks at a position, which stands for a stretch of `length` positions.
  HWY_INLINE void look(const Line& line, Real position, Real length, Mask active, Matter& matter) const
  {
    const Real zero = hn::Zero(float_tag);
    matter.has_gradient = false;
    Real value;
    Functions.values(Volume.field, line, &position, 1, &value);
    const Real stretch = hn::IfThenElseZero(active, length * real(Step));
    if (Volume.meaning == ValueMeaning::Density)
    {
      matter.amount = hn::Min(clamp(value, zero, real(1e30f)) * stretch, real(1e30f));
      matter.depth = hn::Min(matter.amount * real(Scale), real(1e30f));
      return;
    }
    const Lookup table(*Volume.table);
    Int first = hn::Zero(int_tag);
    Mask shown = active;
    if (Volume.masked)
    {
      first = first_node(line, position);
      shown = hn::And(shown, hn::RebindMask(float_tag, first > integer(-1)));
      first = hn::Max(first, hn::Zero(int_tag));
    }
    Real extinction;
    if (Volume.table->columns > 0)
    {
      find_gradient(line, position, matter);
      const Classified both =
        table.at_value_and_gradient(value, gradient_magnitude(Volume, matter.gradient));
      extinction = both.extinction;
      matter.classified = both.colour;
    }
    else
    {
      matter.place = table.locate(table.position(value), first);
      extinction = table.extinction(matter.place);
    }
    Real depth = hn::IfThenElseZero(shown, extinction) * stretch * real(Scale);
    if (!Volume.table->gradient_factor.empty() && !hn::AllFalse(float_tag, depth > zero))
    {
      find_gradient(line, position, matter);
      depth = depth * table.gradient_factor(gradient_magnitude(Volume, matter.gradient), first);
    }
    matter.depth = matter.amount = depth;
  }

  /// The colour of a classified volume where look() found something.
  HWY_INLINE Vec3<Real> colour(const Line& line, Real position, const Matter& matter) const
  {
    const Lookup table(*Volume.table);
    return Volume.colour != VoxelColour::Value ? voxel_colour(table, line, position)
      : Volume.table->columns > 0              ? matter.classified
                                               : table.colour(matter.place);
  }

  /// Sees to it that matter.gradient is known.
  HWY_INLINE void find_gradient(const Line& line, Real position, Matter& matter) const
  {
    if (!matter.has_gradient)
    {
      Functions.gradient(Volume.field, line.at(position), matter.gradient);
      matter.has_gradient = true;
    }
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
  float Step;
  float Scale;
};

/// Steps through which no volume can be seen.
HWY_INLINE Real leap_all(const std::vector<VolumeTask>& volumes, const Rays& rays, Real position)
{
  Real way = real(std::numeric_limits<float>::max());
  for (std::size_t k = 0; k < volumes.size(); ++k)
  {
    const Leaper leaper(volumes[k].bricks, rays.lines[k]);
    const Real here = leaper.leaps() ? leaper.way(position) : hn::Zero(float_tag);
    way = hn::IfThenElse(rays.inside[k] > hn::Zero(float_tag), hn::Min(way, here), way);
  }
  return hn::Min(way, rays.end);
}

}
}
HWY_AFTER_NAMESPACE();

#endif
