// Reading a dense grid, in the voxels' own type. Included once for each SIMD target.
#if defined(BRUME_DENSE_FIELD_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BRUME_DENSE_FIELD_INL_H
#undef BRUME_DENSE_FIELD_INL_H
#else
#define BRUME_DENSE_FIELD_INL_H
#endif

#include "Transport/cell-inl.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <type_traits>

HWY_BEFORE_NAMESPACE();
namespace brume
{
namespace HWY_NAMESPACE
{

/// A component of type T. Where the next voxel along x lies in the same 32 bits, SecondBit is where
/// it begins there, and one gather fetches both; 0 where it does not.
template <class T, int SecondBit>
class Field
{
public:
  HWY_INLINE explicit Field(const FieldView& view)
    : View(view)
    , LastWord(integer(static_cast<int>(view.far ? 0 : view.last_word)))
  {
  }

  static void values(const FieldView& view,
    const Line& line,
    const Real* positions,
    int count,
    Real* values)
  {
    const Field field(view);
    for (int i = 0; i < count; ++i)
    {
      values[i] = field.value(locate_cell(view, line.at(positions[i])));
    }
  }

  static void gradient(const FieldView& view, const Vec3<Real>& place, Vec3<Real>& gradient)
  {
    const Field field(view);
    gradient = field.gradient(locate_cell(view, place));
  }

  /// The voxels of a cell.
  HWY_INLINE void read(const Cell& cell, Pair rows[4]) const
  {
    const std::ptrdiff_t y = View.row[1];
    const std::ptrdiff_t z = View.row[2];
    // The lanes' offsets are counted from here, the last of them that may be read by whole words.
    const std::uint8_t* base = View.base;
    std::int64_t reach = static_cast<std::int64_t>(View.last_word) - y - z -
                         (SecondBit ? 0 : static_cast<std::int64_t>(View.stride[0]));
    Int slice = cell.index[2];
    if (HWY_UNLIKELY(View.far))
    {
      // From the lanes' first slice on, the others are near enough but for very large slices.
      const std::int64_t lowest = hn::GetLane(hn::MinOfLanes(int_tag, slice));
      const std::int64_t highest = hn::GetLane(hn::MaxOfLanes(int_tag, slice));
      const auto size = static_cast<std::int64_t>(View.stride[2]);
      constexpr std::int64_t most = std::numeric_limits<std::int32_t>::max();
      if ((highest - lowest + 1) * size > most || reach - lowest * size < 0)
      {
        return read_far(cell, rows);
      }
      base += lowest * size;
      reach = std::min(reach - lowest * size, most);
      slice = slice - integer(static_cast<int>(lowest));
    }
    const Int index[3] = { cell.index[0], cell.index[1], slice };
    const Int offset = offset_of(index);
    // Words near the end of the memory are read further down: seldom, and for all or none.
    if (HWY_LIKELY(reach >= 0) &&
        HWY_LIKELY(hn::AllFalse(int_tag, offset > integer(static_cast<int>(reach)))))
    {
      rows[0] = pair<false>(base, offset, 0);
      rows[1] = pair<false>(base, offset, y);
      rows[2] = pair<false>(base, offset, z);
      rows[3] = pair<false>(base, offset, y + z);
    }
    else if (View.far)
    {
      read_far(cell, rows);
    }
    else
    {
      rows[0] = pair<true>(base, offset, 0);
      rows[1] = pair<true>(base, offset, y);
      rows[2] = pair<true>(base, offset, z);
      rows[3] = pair<true>(base, offset, y + z);
    }
  }

private:
  HWY_NOINLINE void read_far(const Cell& cell, Pair rows[4]) const
  {
    for (int row = 0; row < 4; ++row)
    {
      rows[row] = far_pair(cell.index[0],
        hn::Min(cell.index[1] + integer(row & 1), last(1)),
        hn::Min(cell.index[2] + integer(row >> 1), last(2)));
    }
  }

  struct Four
  {
    Real before, first, second, after;
  };

  /// Trilinear also serves the nearest voxel: its fractions are 0 or 1.
  HWY_INLINE Real value(const Cell& cell) const
  {
    Pair rows[4];
    read(cell, rows);
    return blend(rows, cell.fraction[0], cell.fraction[1], cell.fraction[2]);
  }

  /// Trilinear interpolation commutes with differences: this is the interpolated gradient.
  HWY_INLINE Vec3<Real> gradient(const Cell& cell) const
  {
    // The cell's own rows, from the voxel before to the one after it along x.
    Four rows[2][2];
    // For each side of the cell the rows before and after it along y, and along z.
    Pair beside_y[2][2];
    Pair beside_z[2][2];
    if (HWY_LIKELY(is_inside(cell)))
    {
      const Int offset = offset_of(cell.index);
      const std::ptrdiff_t y = View.row[1];
      const std::ptrdiff_t z = View.row[2];
      for (int side = 0; side < 2; ++side)
      {
        rows[side][0] = four(offset, side * z);
        rows[side][1] = four(offset, side * z + y);
        beside_y[side][0] = pair<false>(View.base, offset, side * z - y);
        beside_y[side][1] = pair<false>(View.base, offset, side * z + 2 * y);
        beside_z[side][0] = pair<false>(View.base, offset, side * y - z);
        beside_z[side][1] = pair<false>(View.base, offset, side * y + 2 * z);
      }
    }
    else
    {
      const Int before_x = hn::Max(cell.index[0] - integer(1), integer(0));
      const Int after_x = hn::Min(cell.index[0] + integer(2), last(0));
      for (int side = 0; side < 2; ++side)
      {
        for (int y = 0; y < 2; ++y)
        {
          const Int j = row(cell, 1, y);
          const Int k = row(cell, 2, side);
          const Pair here = safe_pair(cell.index[0], j, k);
          rows[side][y] = { single(before_x, j, k), here.first, here.second,
            single(after_x, j, k) };
        }
        for (int after = 0; after < 2; ++after)
        {
          const int beyond = after ? 2 : -1;
          beside_y[side][after] =
            safe_pair(cell.index[0], row(cell, 1, beyond), row(cell, 2, side));
          beside_z[side][after] =
            safe_pair(cell.index[0], row(cell, 1, side), row(cell, 2, beyond));
        }
      }
    }

    const Real* fraction = cell.fraction;
    Real middle[2][2];
    Real slope_x[2];
    for (int z = 0; z < 2; ++z)
    {
      Real slope[2];
      for (int y = 0; y < 2; ++y)
      {
        const Four& r = rows[z][y];
        middle[z][y] = lerp(r.first, r.second, fraction[0]);
        slope[y] = lerp(r.second - r.before, r.after - r.first, fraction[0]);
      }
      slope_x[z] = lerp(slope[0], slope[1], fraction[1]);
    }
    Real slope_y[2];
    Real slope_z[2];
    const auto along_x = [&](const Pair& p) { return lerp(p.first, p.second, fraction[0]); };
    for (int side = 0; side < 2; ++side)
    {
      slope_y[side] = lerp(middle[side][1] - along_x(beside_y[side][0]),
        along_x(beside_y[side][1]) - middle[side][0], fraction[1]);
      slope_z[side] = lerp(middle[1][side] - along_x(beside_z[side][0]),
        along_x(beside_z[side][1]) - middle[0][side], fraction[2]);
    }
    const Real half = real(0.5f);
    return { lerp(slope_x[0], slope_x[1], cell.fraction[2]) * half,
      lerp(slope_y[0], slope_y[1], cell.fraction[2]) * half,
      lerp(slope_z[0], slope_z[1], cell.fraction[1]) * half };
  }

  HWY_INLINE Int last(int axis) const { return integer(View.last[axis]); }

  /// The cell's row `offset` along an axis, kept within the grid.
  HWY_INLINE Int row(const Cell& cell, int axis, int offset) const
  {
    return hn::Min(hn::Max(cell.index[axis] + integer(offset), integer(0)), last(axis));
  }

  /// Whether all that gradients read lies within the grid, for all lanes.
  HWY_INLINE bool is_inside(const Cell& cell) const
  {
    if (HWY_UNLIKELY(View.far))
    {
      return false;
    }
    auto beyond = cell.index[0] > integer(View.last[0] - 2);
    for (int axis = 0; axis < 3; ++axis)
    {
      beyond = hn::Or(beyond, cell.index[axis] < integer(1));
      beyond = hn::Or(beyond, cell.index[axis] > integer(View.last[axis] - 2));
    }
    return hn::AllFalse(int_tag, beyond);
  }

  HWY_INLINE Int offset_of(const Int index[3]) const
  {
    return index[0] * integer(static_cast<int>(View.stride[0])) +
           index[1] * integer(static_cast<int>(View.stride[1])) +
           index[2] * integer(static_cast<int>(View.stride[2]));
  }

  HWY_INLINE Pair safe_pair(Int i, Int j, Int k) const
  {
    if (HWY_UNLIKELY(View.far))
    {
      return far_pair(i, j, k);
    }
    const Int index[3] = { i, j, k };
    return pair<true>(View.base, offset_of(index), 0);
  }

  HWY_INLINE Real single(Int i, Int j, Int k) const
  {
    if (HWY_UNLIKELY(View.far))
    {
      return unpack<0>(far_word(i, j, k));
    }
    const Int index[3] = { i, j, k };
    return unpack<0>(word<true>(View.base, offset_of(index), 0));
  }

  /// The voxel at a byte offset and its neighbour along x. Checked: the words may reach beyond the
  /// end of the memory.
  template <bool Checked>
  HWY_INLINE Pair pair(const std::uint8_t* base, Int offset, std::ptrdiff_t further) const
  {
    const Int bits = word<Checked>(base, offset, further);
    if constexpr (SecondBit > 0)
    {
      return { unpack<0>(bits), unpack<SecondBit>(bits) };
    }
    else
    {
      const auto next = further + static_cast<std::ptrdiff_t>(View.stride[0]);
      return { unpack<0>(bits), unpack<0>(word<Checked>(base, offset, next)) };
    }
  }

  /// The voxel before a place along x, the pair there, and the one after. All must be within the
  /// grid: words that reach beyond a row's end still are.
  HWY_INLINE Four four(Int offset, std::ptrdiff_t further) const
  {
    const auto stride = static_cast<std::ptrdiff_t>(View.stride[0]);
    if constexpr (SecondBit == 8)
    {
      const Int bits = word<false>(View.base, offset, further - stride);
      return { unpack<0>(bits), unpack<8>(bits), unpack<16>(bits), unpack<24>(bits) };
    }
    else
    {
      const Pair low = pair<false>(View.base, offset, further - stride);
      const Pair high = pair<false>(View.base, offset, further + stride);
      return { low.first, low.second, high.first, high.second };
    }
  }

  HWY_INLINE Pair far_pair(Int i, Int j, Int k) const
  {
    const Int bits = far_word(i, j, k);
    if constexpr (SecondBit > 0)
    {
      return { unpack<0>(bits), unpack<SecondBit>(bits) };
    }
    else
    {
      return { unpack<0>(bits), unpack<0>(far_word(i + integer(1), j, k)) };
    }
  }

  /// 32 bits from the byte offset on.
  template <bool Checked>
  HWY_INLINE Int word(const std::uint8_t* base, Int offset, std::ptrdiff_t further) const
  {
    if constexpr (!Checked || sizeof(T) == 4)
    {
      return hn::GatherOffset(
        int_tag, reinterpret_cast<const std::int32_t*>(base + further), offset);
    }
    else
    {
      // Beyond the last whole word: read that, and shift its bits down.
      const Int at = offset + integer(static_cast<int>(further));
      const Int safe = hn::Min(at, LastWord);
      const Int bits = hn::ShiftLeft<3>(at - safe);
      return hn::GatherOffset(int_tag, reinterpret_cast<const std::int32_t*>(base), safe) >>
             bits;
    }
  }

  /// The word of a voxel of a grid of 2 GiB and more, a lane at a time.
  HWY_NOINLINE Int far_word(Int i, Int j, Int k) const
  {
    HWY_ALIGN std::int32_t x[lane_count], y[lane_count], z[lane_count], result[lane_count];
    hn::Store(i, int_tag, x);
    hn::Store(j, int_tag, y);
    hn::Store(k, int_tag, z);
    for (int lane = 0; lane < lane_count; ++lane)
    {
      const std::size_t offset =
        x[lane] * View.stride[0] + y[lane] * View.stride[1] + z[lane] * View.stride[2];
      const std::size_t safe = offset < View.last_word ? offset : View.last_word;
      std::uint32_t bits;
      hwy::CopyBytes<4>(View.base + safe, &bits);
      result[lane] = static_cast<std::int32_t>(bits >> (8 * (offset - safe)));
    }
    return hn::Load(int_tag, result);
  }

  /// The voxel that begins at a bit of a word, sign and all.
  template <int FirstBit>
  HWY_INLINE Real unpack(Int bits) const
  {
    constexpr int width = 8 * sizeof(T);
    if constexpr (std::is_floating_point_v<T>)
    {
      return sanitize(hn::BitCast(float_tag, bits));
    }
    else if constexpr (std::is_signed_v<T>)
    {
      const Int top = hn::ShiftLeft<32 - width - FirstBit>(bits);
      return hn::ConvertTo(float_tag, hn::ShiftRight<32 - width>(top));
    }
    else if constexpr (FirstBit + width == 32)
    {
      const auto unsigned_bits = hn::BitCast(hn::RebindToUnsigned<IntTag>(), bits);
      return hn::ConvertTo(
        float_tag, hn::BitCast(int_tag, hn::ShiftRight<FirstBit>(unsigned_bits)));
    }
    else
    {
      const Int low = hn::And(hn::ShiftRight<FirstBit>(bits), integer((1 << width) - 1));
      return hn::ConvertTo(float_tag, low);
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
  Int LastWord;
};

template <class T, int SecondBit>
HWY_INLINE FieldFunctions field_with_pairs()
{
  using Reader = Field<T, SecondBit>;
  return { &Reader::values, &Reader::gradient, &read_curves<Reader>, &read_extremes<Reader> };
}
}
}
HWY_AFTER_NAMESPACE();

#endif
