// Transfer functions for packets. Included once for each SIMD target.
#if defined(BRUME_LOOKUP_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BRUME_LOOKUP_INL_H
#undef BRUME_LOOKUP_INL_H
#else
#define BRUME_LOOKUP_INL_H
#endif

#include "Transport/lookup_table.h"
#include "Transport/packet-inl.h"

HWY_BEFORE_NAMESPACE();
namespace brume
{
namespace HWY_NAMESPACE
{

/// Colour and extinction (per unit of length).
struct Classified
{
  Vec3<Real> colour;
  Real extinction;
};

/// Reads a table between its nodes.
class Lookup
{
public:
  HWY_INLINE explicit Lookup(const LookupTable& table)
    : Table(table)
    , Last(static_cast<float>(table.intervals))
  {
  }

  /// The place of a value in the table, in intervals; not clamped.
  HWY_INLINE Real position(Real value) const
  {
    return (value - real(Table.lower)) * real(Table.scale);
  }

  /// Where a position is, between two nodes.
  struct Place
  {
    Int offset; ///< of the lower node, in floats
    Real fraction;
  };

  /// `first` is the first node of the classification, for each lane.
  HWY_INLINE Place locate(Real position, Int first) const
  {
    const Real inside = clamp(position, hn::Zero(float_tag), real(Last));
    const Int index = hn::Min(hn::ConvertTo(int_tag, inside), integer(Table.intervals - 1));
    return { hn::ShiftLeft<2>(index + first), inside - hn::ConvertTo(float_tag, index) };
  }
  HWY_INLINE Place locate(Real position) const { return locate(position, hn::Zero(int_tag)); }

  HWY_INLINE Real extinction(const Place& place) const
  {
    return channel<3>(&Table.nodes[0].red, place);
  }
  HWY_INLINE Vec3<Real> colour(const Place& place) const
  {
    const float* nodes = &Table.nodes[0].red;
    return { channel<0>(nodes, place), channel<1>(nodes, place), channel<2>(nodes, place) };
  }

  HWY_INLINE Classified at(const Place& place) const
  {
    return { colour(place), extinction(place) };
  }

  /// The number of the stretch of even slopes that a position lies in.
  HWY_INLINE Int stretch(Real position) const
  {
    const Real inside = clamp(position, hn::Zero(float_tag), real(Last));
    const Int index = hn::Min(hn::ConvertTo(int_tag, inside), integer(Table.intervals - 1));
    Int number = hn::GatherIndex(int_tag, Table.stretch.data(), index);
    // Below and above the table the functions are constant: stretches of their own.
    number =
      hn::IfThenElse(hn::RebindMask(int_tag, position < hn::Zero(float_tag)), integer(-1), number);
    return hn::IfThenElse(
      hn::RebindMask(int_tag, position > real(Last)), integer(Table.intervals), number);
  }

  /// Extinction and extinction · colour, summed from the table's lower end; beyond the ends the
  /// functions go on as constants.
  HWY_INLINE Classified integral(Real position) const
  {
    const Place place = locate(position);
    const float* sums = &Table.integrals[0].red;
    const Real below = hn::Min(position, hn::Zero(float_tag));
    const Real above = max(position - real(Last), hn::Zero(float_tag));
    const LookupNode& first = Table.nodes[0];
    const LookupNode& last = Table.nodes[Table.intervals];
    const Real low = below * real(first.extinction);
    const Real high = above * real(last.extinction);
    const auto beyond = [&](float a, float b) { return hn::MulAdd(low, real(a), high * real(b)); };
    return { { channel<0>(sums, place) + beyond(first.red, last.red),
               channel<1>(sums, place) + beyond(first.green, last.green),
               channel<2>(sums, place) + beyond(first.blue, last.blue) },
      channel<3>(sums, place) + low + high };
  }

  /// The mean over values that run evenly from one position to another, at least one interval
  /// apart, from their integrals.
  static HWY_INLINE Classified mean(const Classified& from, const Classified& to, Real difference)
  {
    const Real inverse = real(1.0f) / difference;
    const Real extinction = max((to.extinction - from.extinction) * inverse, hn::Zero(float_tag));
    const Mask some = extinction > hn::Zero(float_tag);
    const Real share =
      hn::IfThenElseZero(some, inverse / hn::IfThenElse(some, extinction, real(1.0f)));
    const auto colour = [&](Real a, Real b) { return max((b - a) * share, hn::Zero(float_tag)); };
    return { { colour(from.colour.x, to.colour.x),
               colour(from.colour.y, to.colour.y),
               colour(from.colour.z, to.colour.z) },
      extinction };
  }

  /// Classified by value and by gradient magnitude, in rows.
  HWY_INLINE Classified at_value_and_gradient(Real value, Real magnitude) const
  {
    const Real column = clamp(position(value), hn::Zero(float_tag), real(Last));
    const Real row =
      clamp(magnitude, hn::Zero(float_tag), real(static_cast<float>(Table.rows - 1)));
    const Int i = hn::Min(hn::ConvertTo(int_tag, column), integer(Table.columns - 2));
    const Int j = hn::Min(hn::ConvertTo(int_tag, row), integer(Table.rows - 2));
    const Real x = column - hn::ConvertTo(float_tag, i);
    const Real y = row - hn::ConvertTo(float_tag, j);
    const Int low = hn::ShiftLeft<2>(j * integer(Table.columns) + i);
    const Int high = low + integer(4 * Table.columns);
    Real node[4];
    for (int c = 0; c < 4; ++c)
    {
      const float* base = Table.value_gradient.data() + c;
      node[c] = lerp(
        lerp(hn::GatherIndex(float_tag, base, low), hn::GatherIndex(float_tag, base + 4, low), x),
        lerp(hn::GatherIndex(float_tag, base, high), hn::GatherIndex(float_tag, base + 4, high), x),
        y);
    }
    const Real passes = max(real(1.0f) - node[3], real(1e-16f)); // smallest_unit_transmittance
    const Real depth = hn::Neg(hn::Log(float_tag, hn::Min(passes, real(1.0f))));
    return { { node[0], node[1], node[2] }, depth * real(1.0f / Table.unit_distance) };
  }

  /// The factor of gradient opacity at a gradient's place in its table. `first` is the first node of
  /// the classification, for each lane.
  HWY_INLINE Real gradient_factor(Real magnitude, Int first) const
  {
    constexpr float factors = LookupTable::gradient_intervals + 1;
    const Real classification =
      hn::Round(hn::ConvertTo(float_tag, first) * real(1.0f / (Last + 1.0f)));
    return gradient_factor_from(magnitude, hn::ConvertTo(int_tag, classification * real(factors)));
  }
  HWY_INLINE Real gradient_factor(Real magnitude) const
  {
    return gradient_factor_from(magnitude, hn::Zero(int_tag));
  }

private:
  HWY_INLINE Real gradient_factor_from(Real magnitude, Int first) const
  {
    constexpr int last = LookupTable::gradient_intervals;
    const Real position = hn::Min(magnitude, real(static_cast<float>(last)));
    const Int index = hn::Min(hn::ConvertTo(int_tag, position), integer(last - 1));
    const float* factor = Table.gradient_factor.data();
    return lerp(hn::GatherIndex(float_tag, factor, index + first),
      hn::GatherIndex(float_tag, factor + 1, index + first),
      position - hn::ConvertTo(float_tag, index));
  }

  template <int Channel>
  static HWY_INLINE Real channel(const float* nodes, const Place& place)
  {
    return lerp(hn::GatherIndex(float_tag, nodes + Channel, place.offset),
      hn::GatherIndex(float_tag, nodes + Channel + 4, place.offset),
      place.fraction);
  }

  const LookupTable& Table;
  float Last;
};

}
}
HWY_AFTER_NAMESPACE();

#endif
