// Ranges of values, column by column, over many rows of voxels. Internal to Transport.
#pragma once

#include <cstddef>
#include <cstdint>

namespace brume
{

/// Lowers lower[i] to row[i] and raises upper[i] to it where it is beyond, for each of `count`
/// values. Of floats, those that are not finite change nothing. Returns whether all were finite.
bool widen_ranges(const std::uint8_t* row,
  std::size_t count,
  std::uint8_t* lower,
  std::uint8_t* upper);
bool widen_ranges(const std::int8_t* row,
  std::size_t count,
  std::int8_t* lower,
  std::int8_t* upper);
bool widen_ranges(const std::uint16_t* row,
  std::size_t count,
  std::uint16_t* lower,
  std::uint16_t* upper);
bool widen_ranges(const std::int16_t* row,
  std::size_t count,
  std::int16_t* lower,
  std::int16_t* upper);
bool widen_ranges(const float* row, std::size_t count, float* lower, float* upper);

}
