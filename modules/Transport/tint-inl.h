// Colour and opacity, of no length, of a value found at a place: what projections, isosurfaces and
// slices draw. Included once for each SIMD target.
#if defined(BRUME_TINT_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BRUME_TINT_INL_H
#undef BRUME_TINT_INL_H
#else
#define BRUME_TINT_INL_H
#endif

#include "Transport/lookup-inl.h"
#include "Transport/surface-inl.h"

HWY_BEFORE_NAMESPACE();
namespace brume
{
namespace HWY_NAMESPACE
{

struct Tint
{
  Vec3<Real> colour;
  Real opacity;
};

/// Reads one volume whose table holds opacities (LookupTable::hold_opacities).
class TintReader
{
public:
  explicit TintReader(const VolumeTask& volume)
    : Volume(volume)
    , Table(*volume.table)
    , Functions(field_functions(volume.field))
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

  const FieldFunctions& functions() const { return Functions; }

  HWY_INLINE Real value(const Vec3<Real>& place) const
  {
    return read(Functions, Volume.field, place);
  }
  /// What AverageIntensity and Additive add up.
  HWY_INLINE Real grey_value(const Vec3<Real>& place) const
  {
    return read(ColourFunctions[0], Volume.colours[0], place);
  }

  /// For each lane the first node of the classification at a place, or −1 for what the mask hides.
  HWY_INLINE Int first_node(const Vec3<Real>& place) const
  {
    if (!Volume.masked)
    {
      return hn::Zero(int_tag);
    }
    const Real label = read(LabelFunctions, Volume.labels, place);
    return hn::GatherIndex(int_tag, Volume.first_node.data(), hn::ConvertTo(int_tag, label));
  }

  /// Of the value, found at the place. Neither lit nor with the gradient's factor.
  HWY_INLINE Tint projected(Real value, const Vec3<Real>& place, Int first) const
  {
    Vec3<Real> gradient{ value, value, value };
    if (Volume.table->columns > 0)
    {
      Functions.gradient(Volume.field, place, gradient);
    }
    return tint(value, place, gradient, first);
  }

  /// The opacity alone.
  HWY_INLINE Real opacity(Real value, const Vec3<Real>& place, Int first) const
  {
    if (Volume.table->columns > 0)
    {
      return projected(value, place, first).opacity;
    }
    return Table.extinction(Table.locate(Table.position(value), first));
  }

  /// Of a surface through the place where the line is at `position`: lit, with the gradient's factor.
  /// `known` may have the classification's colours and opacities of values, and `which` of them each
  /// lane draws; null asks the table.
  HWY_INLINE Tint surface(Real value,
    const Line& line,
    Real position,
    Int first,
    const LookupNode* known,
    Int which) const
  {
    const Vec3<Real> place = line.at(position);
    Vec3<Real> gradient{ value, value, value };
    if (Volume.needs_gradient || Volume.table->columns > 0)
    {
      Functions.gradient(Volume.field, place, gradient);
    }
    Tint result = tint(value, place, gradient, first);
    if (known && Volume.table->columns == 0)
    {
      const float* nodes = &known->red;
      const Int offset = hn::ShiftLeft<2>(which);
      result.opacity = hn::GatherIndex(float_tag, nodes + 3, offset);
      if (Volume.colour == VoxelColour::Value)
      {
        result.colour = { hn::GatherIndex(float_tag, nodes, offset),
          hn::GatherIndex(float_tag, nodes + 1, offset),
          hn::GatherIndex(float_tag, nodes + 2, offset) };
      }
    }
    if (!Volume.table->gradient_factor.empty())
    {
      result.opacity = result.opacity * Table.gradient_factor(gradient_magnitude(Volume, gradient), first);
    }
    if (Volume.shade.enabled)
    {
      const Vec3<Real> viewer = toward_viewer(Volume.shade, line);
      result.colour = shaded(Volume.shade, line, viewer, position, gradient, result.colour);
    }
    return result;
  }

private:
  static HWY_INLINE Real read(
    const FieldFunctions& functions, const FieldView& view, const Vec3<Real>& place)
  {
    const Real zero = hn::Zero(float_tag);
    const Line line{ place, { zero, zero, zero } };
    Real value;
    functions.values(view, line, &zero, 1, &value);
    return value;
  }

  HWY_INLINE Tint tint(
    Real value, const Vec3<Real>& place, const Vec3<Real>& gradient, Int first) const
  {
    if (Volume.table->columns > 0)
    {
      const Classified matter =
        Table.at_value_and_gradient(value, gradient_magnitude(Volume, gradient));
      return { matter.colour,
        opacity_from_optical_depth(matter.extinction * real(Volume.table->unit_distance)) };
    }
    const Classified matter = Table.at(Table.locate(Table.position(value), first));
    if (Volume.colour == VoxelColour::First)
    {
      return { Table.colour(Table.locate(Table.position(grey_value(place)), first)), matter.extinction };
    }
    if (Volume.colour == VoxelColour::RGB)
    {
      Real component[3];
      for (int c = 0; c < 3; ++c)
      {
        component[c] =
          read(ColourFunctions[c], Volume.colours[c], place) * real(1.0f / 255.0f);
      }
      return { { component[0], component[1], component[2] }, matter.extinction };
    }
    return { matter.colour, matter.extinction };
  }

  const VolumeTask& Volume;
  Lookup Table;
  FieldFunctions Functions;
  FieldFunctions LabelFunctions{};
  FieldFunctions ColourFunctions[3]{};
};

}
}
HWY_AFTER_NAMESPACE();

#endif
