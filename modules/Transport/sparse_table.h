// Which brick lies where: from the coordinates of a brick to its slot, in memory that grows with
// what is there and not with the box around it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace brume
{

/// Coordinates of a brick, in bricks.
using BrickPlace = std::array<std::int32_t, 3>;

/// A box of bricks that all have the same slot. Both ends belong to it.
struct BrickBox
{
  BrickPlace first;
  BrickPlace last;
  std::int32_t slot = 0;

  std::size_t size() const
  {
    std::size_t bricks = 1;
    for (int axis = 0; axis < 3; ++axis)
    {
      bricks *= static_cast<std::size_t>(last[axis] - first[axis] + 1);
    }
    return bricks;
  }
};

/// Bits of a place interleaved, x lowest (Morton's order): bricks near one another get numbers near
/// one another, and a number shifted right by 3k is that of the cube of (2^k)³ bricks around.
/// Coordinates from 0 to 2²¹ − 1.
std::uint64_t morton(const BrickPlace& place);
BrickPlace from_morton(std::uint64_t number);

/// From brick coordinates to slots. Kernels read its arrays:
///
///     page = pages[((bz >> k)·ny + (by >> k))·nx + (bx >> k)]
///     slot = slots[page + (((bz & m) << k | by & m) << k | bx & m)]      k = page_shift, m = 2^k −
///     1
///
/// with nx, ny = top[0], top[1]. `pages` is dense over the box, and holds the place in `slots`
/// where the page's block of (2^k)³ slots begins. Pages without a brick share the block at 0, pages
/// wholly within boxes of the same slot share one too. k, 0 to 6, is what takes the least memory.
///
/// Where the box is so wide that even its pages are many, there is a level more: `directory` is not
/// empty, dense over the box in cubes of (2^d)³ pages, d = directory_shift, and holds the place in
/// `pages` where the cube's block of (2^d)³ pages begins (0: a cube without bricks):
///
///     cube = directory[((bz >> (k + d))·ny + (by >> (k + d)))·nx + (bx >> (k + d))]
///     page = pages[cube + (((bz >> k & n) << d | by >> k & n) << d | bx >> k & n)]        n = 2^d
///     − 1
struct SparseTable
{
  int page_shift = 0;
  int directory_shift = 0;
  std::array<std::int32_t, 3> top{ { 0, 0, 0 } }; ///< entries of the dense level along x, y and z
  std::vector<std::int32_t> directory;
  std::vector<std::int32_t> pages;
  std::vector<std::int32_t> slots;

  SparseTable() = default;
  /// A table of dims[0] × dims[1] × dims[2] bricks, each dims from 1 to 2²¹, in which
  /// places[i] has the slot first_slot + i, each box its own slot (> 0), and all else slot 0.
  /// `places` rise in Morton's order. `pool_bytes` is what the bricks themselves take: a directory,
  /// which kernels pay with a read more, is made only where it saves 1/32 of that.
  /// Throws std::invalid_argument where two bricks or boxes overlap, std::length_error where the
  /// table would need more than 2³¹ entries, or take more than `most_bytes`.
  SparseTable(const std::array<std::int32_t, 3>& dims,
    const std::vector<BrickPlace>& places,
    std::int32_t first_slot,
    const std::vector<BrickBox>& boxes,
    std::size_t pool_bytes,
    std::size_t most_bytes = std::numeric_limits<std::size_t>::max());

  /// The slot at coordinates from 0 to dims − 1.
  std::int32_t slot(std::int32_t x, std::int32_t y, std::int32_t z) const;

  std::size_t memory_bytes() const
  {
    return sizeof(std::int32_t) * (directory.size() + pages.size() + slots.size());
  }
};

}
