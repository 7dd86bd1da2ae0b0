#include "vdb_writer.h"

#include "atomic_file.h"

#include "Transport/half.h"
#include "Transport/sparse_voxels.h"

#include <openvdb/io/Archive.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Prune.h>

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <fstream>
#include <ostream>
#include <stdexcept>
#include <thread>

namespace brume::io
{

namespace
{

using Tree = openvdb::FloatTree;
using Leaf = Tree::LeafNodeType;
using Mask = Leaf::NodeMaskType;

/// Which voxels are active.
struct Activity
{
  float background;
  bool level_set;

  bool operator()(float value) const
  {
    return level_set ? std::abs(value) < background : value != background;
  }
};

/// A leaf from the values of its voxels, x fastest. OpenVDB's leaves run z fastest.
std::unique_ptr<Leaf> leaf_of(const openvdb::Coord& corner,
  const float* values,
  const Activity& active)
{
  auto leaf = std::make_unique<Leaf>(corner, active.background, false);
  float* out = leaf->buffer().data();
  Mask mask;
  for (unsigned z = 0; z < 8; ++z)
  {
    for (unsigned y = 0; y < 8; ++y)
    {
      for (unsigned x = 0; x < 8; ++x)
      {
        const float value = *values++;
        const unsigned at = x << 6 | y << 3 | z;
        out[at] = value;
        if (active(value))
        {
          mask.setOn(at);
        }
      }
    }
  }
  leaf->setValueMask(mask);
  return leaf;
}

/// Runs work(i) on all processors; progress from the thread that asked for it.
template <class Work>
void for_all(std::size_t count, const Progress& progress, double from, double to, const Work& work)
{
  const std::thread::id caller = std::this_thread::get_id();
  std::atomic<std::size_t> done{ 0 };
  tbb::parallel_for(std::size_t(0),
    count,
    [&](std::size_t i)
    {
      work(i);
      const std::size_t n = ++done;
      if (n % 256 == 0 && progress && std::this_thread::get_id() == caller &&
          !progress(from + (to - from) * static_cast<double>(n) / static_cast<double>(count)))
      {
        throw std::runtime_error("interrupted");
      }
    });
}

void describe(openvdb::FloatGrid& grid, const VdbDescription& d)
{
  openvdb::Mat4R matrix;
  for (int row = 0; row < 4; ++row)
  {
    for (int column = 0; column < 4; ++column)
    {
      matrix(column, row) = d.world_from_index[4 * row + column]; // OpenVDB's are rows
    }
  }
  try
  {
    grid.setTransform(openvdb::math::Transform::createLinearTransform(matrix));
  }
  catch (const openvdb::Exception& error)
  {
    throw std::invalid_argument(std::string("OpenVDB refuses its transform: ") + error.what());
  }
  grid.setName(d.name);
  grid.setSaveFloatAsHalf(d.half);
  grid.setGridClass(d.kind == VdbClass::LevelSet    ? openvdb::GRID_LEVEL_SET
                    : d.kind == VdbClass::FogVolume ? openvdb::GRID_FOG_VOLUME
                                                    : openvdb::GRID_UNKNOWN);
  const auto tell = [&grid](const char* name, const std::string& text)
  {
    if (!text.empty())
    {
      grid.insertMeta(name, openvdb::StringMetadata(text));
    }
  };
  tell("length_unit", d.length_unit);
  tell("value_unit", d.value_unit);
  tell("axes", d.patient ? "RAS" : "");
}

/// Bytes of a file that tell of themselves, and that may be stopped.
class WatchedFile : public std::filebuf
{
public:
  WatchedFile(double expected, const Progress& progress)
    : expected_(expected)
    , progress_(progress)
  {
  }

protected:
  std::streamsize xsputn(const char* bytes, std::streamsize count) override
  {
    written_ += static_cast<double>(count);
    if (progress_ && written_ > told_ + (1 << 18))
    {
      told_ = written_;
      if (!progress_(std::min(1.0, written_ / expected_)))
      {
        throw std::runtime_error("interrupted");
      }
    }
    return std::filebuf::xsputn(bytes, count);
  }

private:
  double expected_;
  double written_ = 0;
  double told_ = 0;
  const Progress& progress_;
};

/// OpenVDB's own writer, onto a stream of ours: its File opens one itself and tells nothing.
class Output : public openvdb::io::Archive
{
public:
  void put(std::ostream& out, const openvdb::GridPtrVec& grids)
  {
    openvdb::GridCPtrVec constant(grids.begin(), grids.end());
    this->write(out, constant, /*seekable=*/true);
  }
};

}

struct VdbWriter::Grids
{
  openvdb::GridPtrVec list;
};

VdbWriter::VdbWriter()
  : grids_(std::make_unique<Grids>())
{
  openvdb::initialize();
}

VdbWriter::~VdbWriter() = default;

void VdbWriter::add(const SparseVoxels& voxels, const VdbDescription& d, const Progress& progress)
{
  const auto grid = openvdb::FloatGrid::create(static_cast<float>(voxels.background()));
  describe(*grid, d);
  Tree& tree = grid->tree();
  const Activity active{ static_cast<float>(voxels.background()), d.kind == VdbClass::LevelSet };
  const openvdb::Coord origin(voxels.origin()[0], voxels.origin()[1], voxels.origin()[2]);
  const auto corner = [&origin](const BrickPlace& brick)
  { return origin + openvdb::Coord(8 * brick[0], 8 * brick[1], 8 * brick[2]); };
  for (const BrickBox& tile : voxels.tiles())
  {
    const auto value =
      static_cast<float>(voxels.value_in_slot(static_cast<std::size_t>(tile.slot), 0));
    const openvdb::CoordBBox box(corner(tile.first), corner(tile.last).offsetBy(7));
    tree.sparseFill(box, value, active(value));
  }
  const std::vector<BrickPlace>& places = voxels.places();
  const std::size_t first_slot = 1 + voxels.tile_slots();
  std::vector<std::unique_ptr<Leaf>> leaves(places.size());
  for_all(places.size(),
    progress,
    0.0,
    1.0,
    [&](std::size_t i)
    {
      float values[SparseVoxels::brick_voxels];
      const std::size_t slot = first_slot + i;
      if (voxels.type() == VoxelType::Float32)
      {
        const float* from =
          static_cast<const float*>(voxels.pool()) + slot * SparseVoxels::brick_voxels;
        std::copy(from, from + SparseVoxels::brick_voxels, values);
      }
      else
      {
        for (int v = 0; v < SparseVoxels::brick_voxels; ++v)
        {
          values[v] = static_cast<float>(voxels.value_in_slot(slot, v));
        }
      }
      leaves[i] = leaf_of(corner(places[i]), values, active);
    });
  for (std::unique_ptr<Leaf>& leaf : leaves)
  {
    tree.addLeaf(leaf.release());
  }
  grids_->list.push_back(grid);
}

namespace
{

template <class T>
std::uint64_t fill(Tree& tree,
  const DenseVoxels& dense,
  double tolerance,
  const Activity& active,
  const Progress& progress)
{
  const auto* voxels = static_cast<const T*>(dense.voxels);
  std::array<int, 3> lower;
  std::array<std::size_t, 3> bricks;
  for (int a = 0; a < 3; ++a)
  {
    lower[a] = dense.first[a] >> 3;
    bricks[a] =
      static_cast<std::size_t>(((dense.first[a] + dense.dimensions[a] - 1) >> 3) - lower[a] + 1);
  }
  const float background = active.background;
  const double band = static_cast<double>(background);
  std::vector<std::unique_ptr<Leaf>> leaves(bricks[0] * bricks[1] * bricks[2]);
  for_all(leaves.size(),
    progress,
    0.0,
    1.0,
    [&](std::size_t i)
    {
      const std::size_t place[3] = {
        i % bricks[0], i / bricks[0] % bricks[1], i / bricks[0] / bricks[1]
      };
      int from[3];
      for (int a = 0; a < 3; ++a)
      {
        from[a] = 8 * (lower[a] + static_cast<int>(place[a])) - dense.first[a];
      }
      float values[512];
      std::fill(values, values + 512, background);
      bool any = false;
      for (int z = std::max(0, -from[2]); z < std::min(8, dense.dimensions[2] - from[2]); ++z)
      {
        for (int y = std::max(0, -from[1]); y < std::min(8, dense.dimensions[1] - from[1]); ++y)
        {
          const std::size_t row =
            (static_cast<std::size_t>(from[2] + z) * static_cast<std::size_t>(dense.dimensions[1]) +
              static_cast<std::size_t>(from[1] + y)) *
            static_cast<std::size_t>(dense.dimensions[0]);
          for (int x = std::max(0, -from[0]); x < std::min(8, dense.dimensions[0] - from[0]); ++x)
          {
            const double value =
              static_cast<double>(voxels[row + static_cast<std::size_t>(from[0] + x)]);
            float& out = values[z << 6 | y << 3 | x];
            if (active.level_set)
            {
              out = static_cast<float>(std::clamp(value, -band, band));
            }
            else if (!(std::abs(value - band) <= tolerance)) // what is not a number stays, too
            {
              out = static_cast<float>(value);
            }
            any = any || !(out == background);
          }
        }
      }
      if (any)
      {
        leaves[i] =
          leaf_of({ from[0] + dense.first[0], from[1] + dense.first[1], from[2] + dense.first[2] },
            values,
            active);
      }
    });
  for (std::unique_ptr<Leaf>& leaf : leaves)
  {
    if (leaf)
    {
      tree.addLeaf(leaf.release());
    }
  }
  openvdb::tools::prune(tree);
  return tree.activeVoxelCount();
}

}

std::uint64_t VdbWriter::add(const DenseVoxels& dense,
  double background,
  double tolerance,
  const VdbDescription& d,
  const Progress& progress)
{
  const auto grid = openvdb::FloatGrid::create(static_cast<float>(background));
  describe(*grid, d);
  const Activity active{ static_cast<float>(background), d.kind == VdbClass::LevelSet };
  Tree& tree = grid->tree();
  std::uint64_t count = 0;
  const auto put = [&](auto zero)
  { count = fill<decltype(zero)>(tree, dense, tolerance, active, progress); };
  switch (dense.scalar)
  {
    case Scalar::Int8:
      put(std::int8_t());
      break;
    case Scalar::UInt8:
      put(std::uint8_t());
      break;
    case Scalar::Int16:
      put(std::int16_t());
      break;
    case Scalar::UInt16:
      put(std::uint16_t());
      break;
    case Scalar::Int32:
      put(std::int32_t());
      break;
    case Scalar::UInt32:
      put(std::uint32_t());
      break;
    case Scalar::Int64:
      put(std::int64_t());
      break;
    case Scalar::UInt64:
      put(std::uint64_t());
      break;
    case Scalar::Float32:
      put(float());
      break;
    case Scalar::Float64:
      put(double());
      break;
  }
  grids_->list.push_back(grid);
  return count;
}

void VdbWriter::write(const std::string& path, const Progress& progress)
{
  AtomicFile file(path);
  double expected = 1;
  for (const openvdb::GridBase::Ptr& grid : grids_->list)
  {
    expected += static_cast<double>(grid->memUsage()) / (grid->saveFloatAsHalf() ? 2 : 1);
  }
  WatchedFile buffer(expected, progress);
  // The temporary file exists; "in" keeps a seekable stream from replacing it.
  if (!buffer.open(
        file.temporary_path(), std::ios::in | std::ios::out | std::ios::binary | std::ios::trunc))
  {
    fail(path, "cannot be written", "choose another place");
  }
  std::ostream out(&buffer);
  try
  {
    out.exceptions(std::ios::failbit | std::ios::badbit);
    Output().put(out, grids_->list);
    out.flush();
  }
  catch (const std::ios_base::failure&)
  {
    fail(path, "writing failed", "free some space, or write to another disk");
  }
  catch (const openvdb::Exception& error)
  {
    fail(
      path, std::string("OpenVDB cannot write it (") + error.what() + ")", "write another format");
  }
  if (!buffer.close())
  {
    fail(path, "writing failed", "free some space, or write to another disk");
  }
  file.commit();
}

}
