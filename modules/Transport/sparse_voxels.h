// A sparse grid of voxels: bricks where there is something, and nothing elsewhere.
#pragma once

#include "Transport/grid.h"
#include "Transport/sparse_table.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

namespace brume
{

/// A box of bricks of one value: what OpenVDB calls a tile. Both ends belong to it.
struct SparseTile
{
  BrickPlace first;
  BrickPlace last;
  double value = 0.0;
};

/// Where a sparse grid has voxels, in the coordinates of whoever made it (they may be negative):
/// brick (i, j, k) holds the voxels from 8·(i, j, k) to 8·(i, j, k) + 7. Bricks and tiles do not
/// overlap; their order does not matter.
struct SparseTopology
{
  std::vector<BrickPlace> bricks;
  std::vector<SparseTile> tiles;
};

/// Voxels of one component in bricks of 8³ without an apron, in their own type, each brick once,
/// and a table that finds them (SparseTable). Where there is no brick every voxel is the
/// background.
///
/// Memory: the bricks, and a table that grows with them and hardly with the box around them. Tiles
/// of one value share one brick.
///
/// Index space begins a brick before the first one, so that there is background around all that is
/// stored: voxel (0, 0, 0) is the source's voxel origin(). The grid reaches from first() (one voxel
/// of background) to dims() − 1 (one voxel of background), so that interpolation falls off to the
/// background at the border.
///
/// How a kernel reads voxel (x, y, z), 0 ≤ x < dims()[0] and so on:
///
///     slot  = table().slot(x >> 3, y >> 3, z >> 3)      (SparseTable says how, from its arrays)
///     voxel = pool()[slot·512 + (z & 7)·64 + (y & 7)·8 + (x & 7)]
///
/// Slot 0 is a brick of background, the next tile_slots() ones are tiles' values, then come the
/// bricks in Morton's order. The pool may be larger than 2 GiB; 4 bytes beyond it may be read.
class SparseVoxels
{
public:
  static constexpr int brick_shift = 3; ///< log2 of a brick's edge
  static constexpr int brick_edge = 1 << brick_shift;
  static constexpr int brick_voxels = 1 << 3 * brick_shift;
  /// The widest box along an axis, in bricks: a million voxels, of which single precision tells
  /// sixteenths.
  static constexpr std::int32_t most_bricks = 1 << 17;

  /// Fills the 512 voxels of the brick that `bricks[index]` of the topology names, x fastest.
  /// Called from many threads at once. What it throws, the constructor throws.
  using Fill = std::function<void(std::size_t index, void* voxels)>;

  /// Makes the table and calls `fill` for each brick, on so many threads (0: as many as the machine
  /// has processors). Values of tiles and the background are rounded to the type.
  /// Throws std::invalid_argument for a topology that is empty, overlaps itself or is wider than
  /// most_bricks, std::length_error for more than 2³¹ bricks or table entries, or for more than
  /// `most_bytes` of pool and table.
  SparseVoxels(VoxelType type,
    double background,
    const SparseTopology& topology,
    const Fill& fill,
    int threads = 0,
    std::size_t most_bytes = std::numeric_limits<std::size_t>::max());
  ~SparseVoxels();
  SparseVoxels(const SparseVoxels&) = delete;
  SparseVoxels& operator=(const SparseVoxels&) = delete;

  VoxelType type() const { return this->Type; }
  double background() const { return this->Background; }

  const std::array<std::int32_t, 3>& dims() const { return this->Dims; }   ///< voxels
  const std::array<std::int32_t, 3>& first() const { return this->First; } ///< voxels
  /// The source's coordinates of voxel (0, 0, 0); a multiple of 8.
  const std::array<std::int32_t, 3>& origin() const { return this->Origin; }

  const SparseTable& table() const { return this->Table; }
  const void* pool() const { return this->Pool.get(); }
  /// Bricks in the pool: the background's, tiles' and the others.
  std::size_t slot_count() const { return 1 + this->TileSlots + this->Places.size(); }
  std::size_t tile_slots() const { return this->TileSlots; }
  /// Where the bricks with voxels of their own are, in bricks from voxel (0, 0, 0); places()[i] has
  /// the slot 1 + tile_slots() + i.
  const std::vector<BrickPlace>& places() const { return this->Places; }
  /// Where the tiles are, in the same coordinates.
  const std::vector<BrickBox>& tiles() const { return this->Tiles; }

  /// A voxel; the background for coordinates beyond dims(). NaN and infinities as they are.
  double value(std::int32_t i, std::int32_t j, std::int32_t k) const;
  /// Voxel 0 to 511 of a slot.
  double value_in_slot(std::size_t slot, int voxel) const;

  /// All that it keeps: pool, table, places.
  std::size_t memory_bytes() const;

  /// A view of it, trilinear, points. This object must outlive the view.
  Grid grid() const;

private:
  struct Free
  {
    void operator()(void* memory) const;
  };

  void settle_box(const SparseTopology& topology);
  /// Gives each distinct value of a tile a slot, and returns the values in the order of slots.
  std::vector<double> settle_tiles(const SparseTopology& topology);
  void allocate();
  void fill_constant(std::size_t slot, double value);

  VoxelType Type;
  double Background;
  std::array<std::int32_t, 3> Dims{ { 0, 0, 0 } };
  std::array<std::int32_t, 3> First{ { 0, 0, 0 } };
  std::array<std::int32_t, 3> Origin{ { 0, 0, 0 } };
  std::vector<BrickPlace> Places;
  std::vector<BrickBox> Tiles;
  std::size_t TileSlots = 0;
  SparseTable Table;
  std::unique_ptr<void, Free> Pool;
  std::size_t PoolBytes = 0;
};

/// The least and the largest finite voxel, the background among them; {0, −1} where none is finite.
/// Reads every voxel once, on so many threads (0: as many as the machine has processors).
std::array<double, 2> value_range(const SparseVoxels& voxels, int threads = 0);

}
