// Reading a sparse grid at the places of a packet: the same values and gradients as of the same
// voxels dense. Included once for each SIMD target.
#if defined(BRUME_SPARSE_FIELD_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BRUME_SPARSE_FIELD_INL_H
#undef BRUME_SPARSE_FIELD_INL_H
#else
#define BRUME_SPARSE_FIELD_INL_H
#endif

#include "Transport/cell-inl.h"
#include "Transport/sparse_voxels.h"

#include <type_traits>

HWY_BEFORE_NAMESPACE();
namespace brume
{
namespace HWY_NAMESPACE
{

/// A voxel in half precision.
struct Half
{
  std::uint16_t bits;
};

/// Single precision from the low 16 bits of each lane; the others must be 0.
HWY_INLINE Real real_from_half(Int bits)
{
  // The exponent moves by 127 − 15, by a multiplication that also brings denormals into place.
  const Real shifted = hn::BitCast(float_tag, hn::ShiftLeft<13>(hn::And(bits, integer(0x7fff))));
  const Int magnitude = hn::BitCast(int_tag, shifted * real(0x1p112f));
  const Int special =
    hn::IfThenElseZero(hn::And(bits, integer(0x7c00)) == integer(0x7c00), integer(0x7f800000));
  const Int sign = hn::ShiftLeft<16>(hn::And(bits, integer(0x8000)));
  return hn::BitCast(float_tag, hn::Or(hn::Or(magnitude, special), sign));
}

template <class T>
class SparseField
{
public:
  HWY_INLINE explicit SparseField(const FieldView& view)
    : View(view)
    , Table(*view.table)
    , Stride{ 1, Table.top[0], Table.top[0] * Table.top[1] }
  {
  }

  static void values(const FieldView& view,
    const Line& line,
    const Real* positions,
    int count,
    Real* values)
  {
    const SparseField field(view);
    for (int i = 0; i < count; ++i)
    {
      values[i] = field.value(locate_cell(view, line.at(positions[i])));
    }
  }

  static void gradient(const FieldView& view, const Vec3<Real>& place, Vec3<Real>& gradient)
  {
    const SparseField field(view);
    const Cell cell = locate_cell(view, place);
    gradient = field.slope(cell, field.find_taps(cell));
  }

  /// The voxels of a cell.
  HWY_INLINE void read(const Cell& cell, Pair rows[4]) const
  {
    // Along each axis the cell's second voxel is in the first one's brick, but for rays at its end.
    Terms low[3];
    Terms high[3];
    bool crosses[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      low[axis] = terms(axis, cell.index[axis]);
      const auto at_end = hn::And(cell.index[axis], integer(7)) == integer(7);
      crosses[axis] = !hn::AllFalse(int_tag, at_end);
      if (crosses[axis])
      {
        high[axis] = terms(axis, cell.index[axis] + integer(1));
      }
      else
      {
        high[axis] = low[axis];
        high[axis].voxel = low[axis].voxel + integer(1 << axis * SparseVoxels::brick_shift);
      }
    }
    // The slots of the four rows' first voxels, then of their second ones.
    Int first[4];
    first[0] = slot(low[0], low[1], low[2]);
    if (!crosses[0] && !crosses[1] && !crosses[2] &&
        hn::AllTrue(int_tag, first[0] == hn::Zero(int_tag)))
    {
      for (int row = 0; row < 4; ++row)
      {
        rows[row] = { background(), background() };
      }
      return;
    }
    find_slots(low[0], low, high, crosses, first);
    Int second[4] = { first[0], first[1], first[2], first[3] };
    if (crosses[0])
    {
      second[0] = slot(high[0], low[1], low[2]);
      find_slots(high[0], low, high, crosses, second);
    }
    for (int row = 0; row < 4; ++row)
    {
      const Int yz =
        (row & 1 ? high[1].voxel : low[1].voxel) + (row >> 1 ? high[2].voxel : low[2].voxel);
      if (sizeof(T) <= 2 && !crosses[0])
      {
        const Int bits = word(first[row], low[0].voxel + yz);
        rows[row] = { unpack<0>(bits), unpack<8 * sizeof(T) % 32>(bits) };
      }
      else
      {
        rows[row] = { unpack<0>(word(first[row], low[0].voxel + yz)),
          unpack<0>(word(second[row], high[0].voxel + yz)) };
      }
    }
  }

private:
  /// What one coordinate of a voxel adds to the places in the table and in the brick.
  struct Terms
  {
    Int cube;  ///< in the directory, where there is one
    Int page;  ///< in the pages
    Int slot;  ///< in a page's block of slots
    Int voxel; ///< in a brick
  };

  HWY_INLINE Terms terms(int axis, Int coordinate) const
  {
    const int k = Table.page_shift;
    const int d = Table.directory_shift;
    const Int brick = hn::ShiftRight<SparseVoxels::brick_shift>(coordinate);
    const Int page = hn::ShiftRightSame(brick, k);
    Terms result;
    result.cube = hn::Zero(int_tag);
    if (HWY_UNLIKELY(d > 0))
    {
      result.cube = hn::ShiftRightSame(page, d) * integer(Stride[axis]);
      result.page = hn::ShiftLeftSame(hn::And(page, integer((1 << d) - 1)), axis * d);
    }
    else
    {
      result.page = page * integer(Stride[axis]);
    }
    result.slot = hn::ShiftLeftSame(hn::And(brick, integer((1 << k) - 1)), axis * k);
    result.voxel = hn::ShiftLeftSame(
      hn::And(coordinate, integer(SparseVoxels::brick_edge - 1)), axis * SparseVoxels::brick_shift);
    return result;
  }

  HWY_INLINE Int slot(const Terms& x, const Terms& y, const Terms& z) const
  {
    Int page = x.page + y.page + z.page;
    if (HWY_UNLIKELY(Table.directory_shift > 0))
    {
      page = page + hn::GatherIndex(int_tag, Table.directory.data(), x.cube + y.cube + z.cube);
    }
    const Int base = hn::GatherIndex(int_tag, Table.pages.data(), page);
    return hn::GatherIndex(int_tag, Table.slots.data(), base + x.slot + y.slot + z.slot);
  }

  HWY_INLINE Real value(const Cell& cell) const
  {
    Pair rows[4];
    read(cell, rows);
    return blend(rows, cell.fraction[0], cell.fraction[1], cell.fraction[2]);
  }

  /// Of the four rows of a cell, given the first's slot.
  HWY_INLINE void find_slots(const Terms& x,
    const Terms (&low)[3],
    const Terms (&high)[3],
    const bool (&crosses)[3],
    Int (&slots)[4]) const
  {
    slots[1] = crosses[1] ? slot(x, high[1], low[2]) : slots[0];
    slots[2] = crosses[2] ? slot(x, low[1], high[2]) : slots[0];
    slots[3] = crosses[1] && crosses[2] ? slot(x, high[1], high[2])
               : crosses[1]             ? slots[1]
                                        : slots[2];
  }

  /// The voxels −1, 0, 1, 2 of a cell along each axis. They lie in at most two bricks: that of the
  /// first one, and that of the last.
  struct Taps
  {
    Int voxel[3][4];                ///< Terms::voxel of each
    hn::Mask<IntTag> in_last[3][4]; ///< lanes in which it lies in the last one's brick
    bool crosses[3];                ///< whether any lane has two bricks along the axis
    /// By brick: bit 0 for the last one's along x, bit 1 along y, bit 2 along z. 0 where that axis
    /// is not crossed.
    Int slots[8];
  };

  HWY_INLINE Taps find_taps(const Cell& cell) const
  {
    Taps taps;
    Terms ends[3][2];
    for (int axis = 0; axis < 3; ++axis)
    {
      Int at[4];
      for (int tap = 0; tap < 4; ++tap)
      {
        at[tap] = hn::Min(
          hn::Max(cell.index[axis] + integer(tap - 1), integer(0)), integer(View.last[axis]));
      }
      ends[axis][0] = terms(axis, at[0]);
      ends[axis][1] = terms(axis, at[3]);
      const Int last = hn::ShiftRight<SparseVoxels::brick_shift>(at[3]);
      for (int tap = 0; tap < 4; ++tap)
      {
        taps.in_last[axis][tap] = hn::ShiftRight<SparseVoxels::brick_shift>(at[tap]) == last;
        taps.voxel[axis][tap] =
          hn::ShiftLeftSame(hn::And(at[tap], integer(SparseVoxels::brick_edge - 1)),
            axis * SparseVoxels::brick_shift);
      }
      taps.crosses[axis] = !hn::AllTrue(int_tag, taps.in_last[axis][0]);
    }
    for (int brick = 0; brick < 8; ++brick)
    {
      const bool asked = (taps.crosses[0] || !(brick & 1)) && (taps.crosses[1] || !(brick & 2)) &&
                         (taps.crosses[2] || !(brick & 4));
      taps.slots[brick] = asked
                            ? slot(ends[0][brick & 1], ends[1][brick >> 1 & 1], ends[2][brick >> 2])
                            : hn::Zero(int_tag);
    }
    return taps;
  }

  /// The slot of a tap, of the two by which it may differ along an axis that is crossed.
  static HWY_INLINE Int either(const Taps& taps, int axis, int tap, Int first, Int last)
  {
    return taps.crosses[axis] ? hn::IfThenElse(taps.in_last[axis][tap], last, first) : first;
  }

  HWY_INLINE Real tap(const Taps& taps, int x, int y, int z) const
  {
    const Int* s = taps.slots;
    Int at = either(taps, 0, x, s[0], s[1]);
    if (taps.crosses[1])
    {
      at = either(taps, 1, y, at, either(taps, 0, x, s[2], s[3]));
    }
    if (taps.crosses[2])
    {
      Int beyond = either(taps, 0, x, s[4], s[5]);
      if (taps.crosses[1])
      {
        beyond = either(taps, 1, y, beyond, either(taps, 0, x, s[6], s[7]));
      }
      at = either(taps, 2, z, at, beyond);
    }
    return unpack<0>(word(at, taps.voxel[0][x] + taps.voxel[1][y] + taps.voxel[2][z]));
  }

  HWY_INLINE Real edge(const Cell& cell, const Taps& taps, int y, int z) const
  {
    return lerp(tap(taps, 1, y, z), tap(taps, 2, y, z), cell.fraction[0]);
  }

  /// Trilinear interpolation commutes with differences: this is the interpolated gradient.
  HWY_INLINE Vec3<Real> slope(const Cell& cell, const Taps& taps) const
  {
    Real middle[2][2];
    Real slope_x[2];
    for (int z = 0; z < 2; ++z)
    {
      Real slope[2];
      for (int y = 0; y < 2; ++y)
      {
        const Real first = tap(taps, 1, 1 + y, 1 + z);
        const Real second = tap(taps, 2, 1 + y, 1 + z);
        const Real before = tap(taps, 0, 1 + y, 1 + z);
        const Real after = tap(taps, 3, 1 + y, 1 + z);
        middle[z][y] = lerp(first, second, cell.fraction[0]);
        slope[y] = lerp(second - before, after - first, cell.fraction[0]);
      }
      slope_x[z] = lerp(slope[0], slope[1], cell.fraction[1]);
    }
    Real slope_y[2];
    Real slope_z[2];
    for (int side = 0; side < 2; ++side)
    {
      const Real y_before = edge(cell, taps, 0, 1 + side);
      const Real y_after = edge(cell, taps, 3, 1 + side);
      slope_y[side] = lerp(middle[side][1] - y_before, y_after - middle[side][0], cell.fraction[1]);
      const Real z_before = edge(cell, taps, 1 + side, 0);
      const Real z_after = edge(cell, taps, 1 + side, 3);
      slope_z[side] = lerp(middle[1][side] - z_before, z_after - middle[0][side], cell.fraction[2]);
    }
    const Real half = real(0.5f);
    return { lerp(slope_x[0], slope_x[1], cell.fraction[2]) * half,
      lerp(slope_y[0], slope_y[1], cell.fraction[2]) * half,
      lerp(slope_z[0], slope_z[1], cell.fraction[1]) * half };
  }

  /// The first voxel of the pool: slot 0 is the background's.
  HWY_INLINE Real background() const
  {
    return unpack<0>(word(hn::Zero(int_tag), hn::Zero(int_tag)));
  }

  /// 32 bits from a voxel of a slot on.
  HWY_INLINE Int word(Int slot, Int voxel) const
  {
    if (HWY_UNLIKELY(View.far))
    {
      return far_word(slot, voxel);
    }
    const Int index = hn::ShiftLeft<3 * SparseVoxels::brick_shift>(slot) + voxel;
    const auto* words = reinterpret_cast<const std::int32_t*>(View.base);
    if constexpr (sizeof(T) == 4)
    {
      return hn::GatherIndex(int_tag, words, index);
    }
    else
    {
      return hn::GatherOffset(int_tag, words, hn::ShiftLeft<sizeof(T) / 2>(index));
    }
  }

  /// The same where the pool is too large for a gather's offsets, a lane at a time.
  HWY_NOINLINE Int far_word(Int slot, Int voxel) const
  {
    HWY_ALIGN std::int32_t slots[lane_count], voxels[lane_count], result[lane_count];
    hn::Store(slot, int_tag, slots);
    hn::Store(voxel, int_tag, voxels);
    for (int lane = 0; lane < lane_count; ++lane)
    {
      const std::size_t index =
        static_cast<std::size_t>(slots[lane]) * SparseVoxels::brick_voxels + voxels[lane];
      hwy::CopyBytes<4>(View.base + index * sizeof(T), &result[lane]);
    }
    return hn::Load(int_tag, result);
  }

  /// The voxel that begins at a bit of a word.
  template <int FirstBit>
  HWY_INLINE Real unpack(Int bits) const
  {
    constexpr int width = 8 * sizeof(T);
    if constexpr (std::is_same_v<T, float>)
    {
      return sanitize(hn::BitCast(float_tag, bits));
    }
    else if constexpr (std::is_signed_v<T>)
    {
      const Int top = hn::ShiftLeft<32 - width - FirstBit>(bits);
      return hn::ConvertTo(float_tag, hn::ShiftRight<32 - width>(top));
    }
    else
    {
      const Int low = hn::And(hn::ShiftRight<FirstBit>(bits), integer((1 << width) - 1));
      if constexpr (std::is_same_v<T, Half>)
      {
        return sanitize(real_from_half(low));
      }
      else
      {
        return hn::ConvertTo(float_tag, low);
      }
    }
  }

  HWY_INLINE Real sanitize(Real value) const
  {
    if (HWY_UNLIKELY(View.non_finite))
    {
      return hn::IfThenElse(hn::IsFinite(value), value, real(View.empty_value));
    }
    return value;
  }

  const FieldView& View;
  const SparseTable& Table;
  std::int32_t Stride[3]; ///< of the table's dense level
};

template <class T>
HWY_INLINE FieldFunctions sparse_functions()
{
  using Reader = SparseField<T>;
  return { &Reader::values, &Reader::gradient, &read_curves<Reader>, &read_extremes<Reader> };
}

}
}
HWY_AFTER_NAMESPACE();

#endif
