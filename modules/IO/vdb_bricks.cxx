#include "vdb_bricks.h"

#include "memory_limit.h"

#include "Transport/half.h"
#include "Transport/sparse_voxels.h"

#include <openvdb/tree/LeafManager.h>

#include <tbb/parallel_for.h>

#include <atomic>
#include <cmath>
#include <stdexcept>
#include <thread>
#include <type_traits>

namespace brume::io
{

namespace
{

BrickPlace brick_of(const openvdb::Coord& voxel)
{
  return { { voxel.x() >> 3, voxel.y() >> 3, voxel.z() >> 3 } };
}

/// OpenVDB's leaves run z fastest, bricks x fastest.
template <class In, class Out, class Convert>
void transpose(const In* leaf, Out* brick, const Convert& convert)
{
  for (int z = 0; z < 8; ++z)
  {
    for (int y = 0; y < 8; ++y)
    {
      for (int x = 0; x < 8; ++x)
      {
        *brick++ = convert(leaf[x << 6 | y << 3 | z]);
      }
    }
  }
}

template <class Tree>
std::shared_ptr<const SparseVoxels> take(Tree& tree,
  bool half,
  const std::string& path,
  std::uint64_t limit,
  const Progress& progress)
{
  using Leaf = typename Tree::LeafNodeType;
  using Value = typename Tree::ValueType;
  static_assert(Leaf::LOG2DIM == SparseVoxels::brick_shift, "a leaf is a brick");

  const Value background = std::isfinite(tree.background()) ? tree.background() : Value(0);
  const auto is_background = [background](Value v) { return v == background; };

  // Leaves that neither are active anywhere nor differ from the background hold nothing.
  std::vector<Leaf*> leaves;
  tree.getNodes(leaves);
  // Voxels, and 64 bytes of places and tables for a brick; the tree itself is there already.
  const double brick = SparseVoxels::brick_voxels * (half ? 2.0 : 4.0) + 64;
  check_memory(path, static_cast<double>(leaves.size()) * brick, limit);
  std::vector<std::uint8_t> empty(leaves.size(), 0);
  tbb::parallel_for(std::size_t(0),
    leaves.size(),
    [&](std::size_t i)
    {
      if (leaves[i]->isEmpty())
      {
        const Value* values = leaves[i]->buffer().data();
        empty[i] = std::all_of(values, values + Leaf::SIZE, is_background);
      }
    });
  SparseTopology topology;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < leaves.size(); ++i)
  {
    if (!empty[i])
    {
      topology.bricks.push_back(brick_of(leaves[i]->origin()));
      leaves[kept++] = leaves[i];
    }
  }
  leaves.resize(kept);
  auto tile = tree.cbeginValueAll();
  tile.setMaxDepth(Tree::ValueAllCIter::LEAF_DEPTH - 1);
  for (; tile; ++tile)
  {
    if (!is_background(*tile) && !(std::isnan(*tile) && std::isnan(tree.background())))
    {
      openvdb::CoordBBox box;
      tile.getBoundingBox(box);
      topology.tiles.push_back(
        { brick_of(box.min()), brick_of(box.max()), static_cast<double>(*tile) });
    }
  }
  if (topology.bricks.empty() && topology.tiles.empty())
  {
    return nullptr;
  }

  const std::thread::id caller = std::this_thread::get_id();
  std::atomic<std::size_t> done{ 0 };
  const auto fill = [&](std::size_t index, void* voxels)
  {
    Leaf& leaf = *leaves[index];
    const Value* values = leaf.buffer().data(); // read from the file here and now
    if (half)
    {
      transpose(values,
        static_cast<std::uint16_t*>(voxels),
        [](Value v) { return half_from_float(static_cast<float>(v)); });
    }
    else
    {
      transpose(values, static_cast<float*>(voxels), [](Value v) { return static_cast<float>(v); });
    }
    typename Leaf::Buffer nothing(openvdb::PartialCreate(), Value(0));
    leaf.swap(nothing); // its memory goes with `nothing`
    const std::size_t count = ++done;
    if (count % 1024 == 0 && std::this_thread::get_id() == caller && progress &&
        !progress(static_cast<double>(count) / static_cast<double>(leaves.size())))
    {
      throw std::runtime_error("interrupted");
    }
  };
  return std::make_shared<SparseVoxels>(half ? VoxelType::Float16 : VoxelType::Float32,
    static_cast<double>(background),
    topology,
    fill,
    0,
    static_cast<std::size_t>(memory_limit(limit)));
}

}

std::shared_ptr<const SparseVoxels> take_voxels(openvdb::FloatTree& tree,
  bool half,
  const std::string& path,
  std::uint64_t limit,
  const Progress& progress)
{
  return take(tree, half, path, limit, progress);
}

std::shared_ptr<const SparseVoxels> take_voxels(openvdb::DoubleTree& tree,
  bool half,
  const std::string& path,
  std::uint64_t limit,
  const Progress& progress)
{
  return take(tree, half, path, limit, progress);
}

}
