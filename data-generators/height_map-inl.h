// The height of the ground at places. Included once for each target (lanes-inl.h).
#if defined(BRUME_HEIGHT_MAP_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BRUME_HEIGHT_MAP_INL_H
#undef BRUME_HEIGHT_MAP_INL_H
#else
#define BRUME_HEIGHT_MAP_INL_H
#endif

#include "data-generators/height_map.h"
#include "data-generators/lanes-inl.h"

BRUME_LANES_BEGIN

/// HeightMap::at().
BRUME_LANES_INLINE Real ground_at(const HeightMap& map, Wide x, Wide y)
{
  const auto along = [](Wide p, double origin, double spacing, int count)
  {
    return least(
      most(narrow((p - wide(origin)) * wide(1.0 / spacing)), real(0.0f)), real(count - 1.0f));
  };
  const Real u = along(x, map.origin.x, map.spacing.x, map.dimensions.x);
  const Real v = along(y, map.origin.y, map.spacing.y, map.dimensions.y);
  const Real i = least(floor_of(u), real(map.dimensions.x - 2.0f));
  const Real j = least(floor_of(v), real(map.dimensions.y - 2.0f));
  const Bits row = bits(static_cast<std::uint32_t>(map.dimensions.x));
  const Bits corner = times(to_bits(j), row) + to_bits(i);
  const float* h = map.heights.data();
  const Real near = lerp(gather(h, corner), gather(h, corner + bits(1u)), u - i);
  const Real far = lerp(gather(h, corner + row), gather(h, corner + row + bits(1u)), u - i);
  return lerp(near, far, v - j);
}

BRUME_LANES_END

#endif
