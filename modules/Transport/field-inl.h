// Reading a grid at the places of a packet: trilinear or nearest, in the voxels' own type.
#if defined(BRUME_FIELD_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BRUME_FIELD_INL_H
#undef BRUME_FIELD_INL_H
#else
#define BRUME_FIELD_INL_H
#endif

#include "Transport/packet-inl.h"

#include <limits>
#include <type_traits>

HWY_BEFORE_NAMESPACE();
namespace brume
{
namespace HWY_NAMESPACE
{

/// One of the voxels' components, the last (of 4: opacity's scalar), at any place of the grid.
///
/// Voxels of 8 and 16 bits are fetched with one 32-bit gather for two neighbours along x.
template <class T, int Components>
class Field
{
public:
  Field(const Grid& grid, bool non_finite, float empty_value)
    : Base(static_cast<const std::uint8_t*>(grid.voxels))
    , NonFinite(non_finite)
    , EmptyValue(empty_value)
  {
    constexpr std::size_t voxel = sizeof(T) * Components;
    for (int axis = 0; axis < 3; ++axis)
    {
      Last[axis] = grid.dims[axis] - 1;
      LastCell[axis] = grid.dims[axis] > 1 ? grid.dims[axis] - 2 : 0;
    }
    Stride[0] = voxel;
    Stride[1] = voxel * grid.dims[0];
    Stride[2] = voxel * grid.dims[0] * grid.dims[1];
    LastWord = grid.bytes() - sizeof(std::int32_t);
    // Offsets of gathers are 32 bits wide.
    Far = grid.bytes() > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max());
  }

  /// The eight voxels around a place, as one cell and the place in it.
  struct Cell
  {
    Int index[3];
    Real fraction[3];
  };

  template <bool Linear>
  HWY_INLINE Cell locate(const Vec3<Real>& place) const
  {
    const Real* coordinate[3] = { &place.x, &place.y, &place.z };
    Cell cell;
    for (int axis = 0; axis < 3; ++axis)
    {
      Real p = clamp(*coordinate[axis], hn::Zero(float_tag), real(static_cast<float>(Last[axis])));
      if (!Linear)
      {
        p = hn::Floor(p + real(0.5f));
      }
      cell.index[axis] = hn::Min(hn::ConvertTo(int_tag, p), integer(LastCell[axis]));
      cell.fraction[axis] = p - hn::ConvertTo(float_tag, cell.index[axis]);
    }
    return cell;
  }

  /// The value at the place. Trilinear also serves the nearest voxel: its fractions are 0 or 1.
  HWY_INLINE Real value(const Cell& cell) const
  {
    Real face[2];
    for (int z = 0; z < 2; ++z)
    {
      Real edge[2];
      for (int y = 0; y < 2; ++y)
      {
        Real a, b;
        fetch_pair(cell.index[0], row(cell, 1, y), row(cell, 2, z), a, b);
        edge[y] = lerp(a, b, cell.fraction[0]);
      }
      face[z] = lerp(edge[0], edge[1], cell.fraction[1]);
    }
    return lerp(face[0], face[1], cell.fraction[2]);
  }

  /// The value, and the gradient by central differences of one voxel, in values per voxel.
  /// Trilinear interpolation commutes with differences: this is the interpolated gradient.
  HWY_INLINE Real value_and_gradient(const Cell& cell, Vec3<Real>& gradient) const
  {
    const Int before_x = hn::Max(cell.index[0] - integer(1), integer(0));
    const Int after_x = hn::Min(cell.index[0] + integer(2), integer(Last[0]));
    // Rows −1, 0, 1, 2 along y and z: the middle four carry the value and the slope along x.
    Real middle[2][2];
    Real slope_x[2];
    for (int z = 0; z < 2; ++z)
    {
      Real slope[2];
      for (int y = 0; y < 2; ++y)
      {
        const Int j = row(cell, 1, y);
        const Int k = row(cell, 2, z);
        Real a, b;
        fetch_pair(cell.index[0], j, k, a, b);
        const Real before = fetch(before_x, j, k);
        const Real after = fetch(after_x, j, k);
        middle[z][y] = lerp(a, b, cell.fraction[0]);
        slope[y] = lerp(b - before, after - a, cell.fraction[0]);
      }
      slope_x[z] = lerp(slope[0], slope[1], cell.fraction[1]);
    }
    gradient.x = lerp(slope_x[0], slope_x[1], cell.fraction[2]) * real(0.5f);

    Real slope_y[2];
    Real slope_z[2];
    for (int side = 0; side < 2; ++side)
    {
      const Int k = row(cell, 2, side);
      const Real y_before = edge(cell, row(cell, 1, -1), k);
      const Real y_after = edge(cell, row(cell, 1, 2), k);
      slope_y[side] =
        lerp(middle[side][1] - y_before, y_after - middle[side][0], cell.fraction[1]);
      const Int j = row(cell, 1, side);
      const Real z_before = edge(cell, j, row(cell, 2, -1));
      const Real z_after = edge(cell, j, row(cell, 2, 2));
      slope_z[side] =
        lerp(middle[1][side] - z_before, z_after - middle[0][side], cell.fraction[2]);
    }
    gradient.y = lerp(slope_y[0], slope_y[1], cell.fraction[2]) * real(0.5f);
    gradient.z = lerp(slope_z[0], slope_z[1], cell.fraction[1]) * real(0.5f);

    const Real low = lerp(middle[0][0], middle[0][1], cell.fraction[1]);
    const Real high = lerp(middle[1][0], middle[1][1], cell.fraction[1]);
    return lerp(low, high, cell.fraction[2]);
  }

  /// Red, green and blue of a grid of 4 components, in [0, 1].
  HWY_INLINE Vec3<Real> colour(const Cell& cell) const
  {
    Real channel[3];
    for (int c = 0; c < 3; ++c)
    {
      Real face[2];
      for (int z = 0; z < 2; ++z)
      {
        Real line[2];
        for (int y = 0; y < 2; ++y)
        {
          const Int j = row(cell, 1, y);
          const Int k = row(cell, 2, z);
          line[y] = lerp(component(cell.index[0], j, k, c),
            component(cell.index[0] + integer(1), j, k, c), cell.fraction[0]);
        }
        face[z] = lerp(line[0], line[1], cell.fraction[1]);
      }
      channel[c] = lerp(face[0], face[1], cell.fraction[2]) * real(1.0f / 255.0f);
    }
    return { channel[0], channel[1], channel[2] };
  }

private:
  /// The cell's row `offset` along an axis, kept within the grid.
  HWY_INLINE Int row(const Cell& cell, int axis, int offset) const
  {
    return hn::Min(
      hn::Max(cell.index[axis] + integer(offset), integer(0)), integer(Last[axis]));
  }

  HWY_INLINE Real edge(const Cell& cell, Int j, Int k) const
  {
    Real a, b;
    fetch_pair(cell.index[0], j, k, a, b);
    return lerp(a, b, cell.fraction[0]);
  }

  /// 32 bits from the byte offset of voxel (i, j, k) on.
  HWY_INLINE Int word(Int i, Int j, Int k) const
  {
    if (HWY_UNLIKELY(Far))
    {
      return far_word(i, j, k);
    }
    Int offset = i * integer(static_cast<int>(Stride[0])) +
      j * integer(static_cast<int>(Stride[1])) + k * integer(static_cast<int>(Stride[2]));
    const auto* base = reinterpret_cast<const std::int32_t*>(Base);
    if constexpr (sizeof(T) * Components >= 4)
    {
      return hn::GatherOffset(int_tag, base, offset);
    }
    else
    {
      // The word of the last voxels would reach beyond the memory: read the last whole word there
      // and shift its bits down.
      const Int safe = hn::Min(offset, integer(static_cast<int>(LastWord)));
      const Int bits = hn::ShiftLeft<3>(offset - safe);
      return hn::GatherOffset(int_tag, base, safe) >> bits;
    }
  }

  /// The same for grids of 2 GiB and more, a lane at a time.
  HWY_NOINLINE Int far_word(Int i, Int j, Int k) const
  {
    HWY_ALIGN std::int32_t x[lane_count], y[lane_count], z[lane_count], result[lane_count];
    hn::Store(i, int_tag, x);
    hn::Store(j, int_tag, y);
    hn::Store(k, int_tag, z);
    for (int lane = 0; lane < lane_count; ++lane)
    {
      const std::size_t offset = x[lane] * Stride[0] + y[lane] * Stride[1] + z[lane] * Stride[2];
      const std::size_t safe = offset < LastWord ? offset : LastWord;
      std::uint32_t bits;
      hwy::CopyBytes<4>(Base + safe, &bits);
      result[lane] = static_cast<std::int32_t>(bits >> (8 * (offset - safe)));
    }
    return hn::Load(int_tag, result);
  }

  /// The component in the low bits of a word, sign and all.
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
    else
    {
      const Int low = hn::And(hn::ShiftRight<FirstBit>(bits), integer((1 << width) - 1));
      return hn::ConvertTo(float_tag, low);
    }
  }

  HWY_INLINE Real sanitize(Real value) const
  {
    if (HWY_UNLIKELY(NonFinite))
    {
      return hn::IfThenElse(hn::IsFinite(value), value, real(EmptyValue));
    }
    return value;
  }

  HWY_INLINE Real fetch(Int i, Int j, Int k) const
  {
    return unpack<8 * sizeof(T) * (Components - 1)>(word(i, j, k));
  }

  /// Voxels i and i + 1 of row (j, k).
  HWY_INLINE void fetch_pair(Int i, Int j, Int k, Real& a, Real& b) const
  {
    if constexpr (sizeof(T) * Components <= 2)
    {
      const Int bits = word(i, j, k);
      a = unpack<0>(bits);
      b = unpack<8 * sizeof(T)>(bits);
    }
    else
    {
      a = fetch(i, j, k);
      b = fetch(i + integer(1), j, k);
    }
  }

  HWY_INLINE Real component(Int i, Int j, Int k, int c) const
  {
    const Int bits = word(i, j, k);
    const Int shifted = hn::ShiftRightSame(bits, 8 * c);
    return hn::ConvertTo(float_tag, hn::And(shifted, integer(255)));
  }

  const std::uint8_t* Base;
  std::size_t Stride[3];
  std::size_t LastWord;
  int Last[3];
  int LastCell[3];
  bool Far;
  bool NonFinite;
  float EmptyValue;
};

}
}
HWY_AFTER_NAMESPACE();

#endif
