#include "vdb_file.h"

#include "file_access.h"
#include "guarded_process.h"
#include "header_text.h"
#include "memory_limit.h"
#include "scan_header.h"
#include "vdb_bricks.h"

#include "Transport/sparse_voxels.h"

#include <openvdb/io/Archive.h>
#include <openvdb/io/File.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/tools/LevelSetUtil.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <functional>
#include <iostream>
#include <sstream>
#include <new>

namespace brume::io
{

namespace
{

const char Magic[] = { ' ', 'B', 'D', 'V', 0, 0, 0, 0 };

/// Reads the list of grids without OpenVDB's File, which believes what a file says.
class Listing : public openvdb::io::Archive
{
public:
  /// The grids' descriptors in the order of the file; none for a file without offsets (a stream
  /// that was saved), which has to be read whole.
  std::vector<openvdb::io::GridDescriptor> read(std::istream& in)
  {
    this->readHeader(in);
    this->setFormatVersion(in);
    this->setLibraryVersion(in);
    openvdb::MetaMap metadata;
    metadata.readMeta(in);
    std::vector<openvdb::io::GridDescriptor> grids;
    if (!this->inputHasGridOffsets())
    {
      return grids;
    }
    for (std::int32_t left = readGridCount(in); left > 0; --left)
    {
      openvdb::io::GridDescriptor grid;
      grid.read(in);
      grids.push_back(grid);
      grid.seekToEnd(in);
    }
    return grids;
  }
};

[[noreturn]] void fail_openvdb(const std::string& path, const std::exception& error)
{
  fail(path,
    "OpenVDB cannot read it (" + shortened(std::string(error.what()).substr(0, 200)) + ")",
    "it may be damaged: write or copy it again");
}

std::string type_of(const openvdb::GridBase& grid)
{
  return grid.saveFloatAsHalf() && grid.valueType() == "float" ? "half" : grid.valueType();
}

std::string kind_of(const openvdb::GridBase& grid)
{
  return openvdb::GridBase::gridClassToString(grid.getGridClass());
}

std::string refusal_of(const openvdb::GridBase& grid)
{
  if (!grid.isType<openvdb::FloatGrid>() && !grid.isType<openvdb::DoubleGrid>())
  {
    return "holds " + grid.valueType() + ": name a grid of floats";
  }
  if (!grid.transform().isLinear())
  {
    return "has a perspective (frustum) transform: resample it to a linear one";
  }
  return {};
}

/// "density", of "density" + separator + "1" as the file has it "density[1]".
std::string spoken_name(const openvdb::io::GridDescriptor& grid)
{
  return openvdb::io::GridDescriptor::nameAsString(grid.uniqueName());
}

/// Whether this is a process of rehearse(). Threads do not come along into it, so that nothing may ask
/// TBB for work there, as OpenVDB's trees do when they are destroyed: what is made there stays.
bool rehearsing = false;

template <class Pointer>
void keep_in_rehearsal(const Pointer& pointer)
{
  if (rehearsing)
  {
    new Pointer(pointer); // until the process ends
  }
}

/// The file, open, with its header checked. Delayed loading: leaves are read when they are asked
/// for.
std::shared_ptr<openvdb::io::File> open_file(const std::string& path)
{
  openvdb::initialize();
  auto file = std::make_shared<openvdb::io::File>(path);
  keep_in_rehearsal(file);
  file->setCopyMaxBytes(0); // no private copy of it in a temporary folder
  file->open();
  return file;
}

/// Keeps from the standard error stream, while it lives, what OpenVDB says to it of files that it doubts.
class Hush
{
public:
  Hush()
    : before_(std::cerr.rdbuf(&heard_))
  {
  }
  ~Hush() { std::cerr.rdbuf(before_); }
  Hush(const Hush&) = delete;
  Hush& operator=(const Hush&) = delete;

private:
  std::stringbuf heard_;
  std::streambuf* before_;
};

/// Calls work() and puts what OpenVDB throws into words.
template <class Work>
auto guarded(const std::string& path, const Work& work)
{
  const Hush hush;
  try
  {
    return work();
  }
  catch (const openvdb::Exception& error)
  {
    fail_openvdb(path, error);
  }
  catch (const std::ios_base::failure&)
  {
    fail(path, "the file is cut short", "copy or download it again");
  }
  catch (const std::length_error& error)
  {
    fail_openvdb(path, error);
  }
}

/// Does `work` in a process of its own first: OpenVDB believes the counts and lengths in a file, which a
/// damaged one turns into endless loops, memory without bounds and crashes. Throws what `work` throws
/// there, and fail() where the process does not end by itself.
void rehearse(const std::string& path,
  const std::function<void()>& work,
  double seconds,
  double bytes,
  const Progress& progress = {})
{
  constexpr std::size_t Room = 4096;
  const SharedMemory page(Room);
  char* words = static_cast<char*>(page.data());
  const GuardResult result = run_guarded(
    [&]() -> int
    {
      rehearsing = true;
      try
      {
        work();
        return 0;
      }
      catch (const std::bad_alloc&)
      {
        return 2;
      }
      catch (const std::exception& error)
      {
        std::strncpy(words, error.what(), Room - 1);
        return 1;
      }
    },
    seconds,
    bytes,
    progress);
  const std::string error = words;
  if (result.end != GuardEnd::Finished)
  {
    fail(path,
      spoken_end(result.end),
      result.end == GuardEnd::Stopped ? "run it again" : "write or copy it again");
  }
  if (result.status != 0)
  {
    throw std::runtime_error(!error.empty() ? error
                                            : path + ": is damaged, or takes more memory to read than "
                                                     "there is: write or copy it again");
  }
}

/// Reads all voxels of a grid, and forgets them.
template <class Grid>
bool read_voxels_of(openvdb::GridBase& base)
{
  if (!base.isType<Grid>())
  {
    return false;
  }
  using Leaf = typename Grid::TreeType::LeafNodeType;
  std::vector<Leaf*> leaves;
  static_cast<Grid&>(base).tree().getNodes(leaves);
  for (Leaf* leaf : leaves)
  {
    leaf->buffer().data();
    typename Leaf::Buffer nothing(openvdb::PartialCreate(), typename Grid::ValueType(0));
    leaf->swap(nothing);
  }
  return true;
}

}

bool looks_like_vdb(const std::string& path)
{
  std::ifstream in(path, std::ios::binary);
  char bytes[sizeof(Magic)] = {};
  return in.read(bytes, sizeof(bytes)) && std::equal(bytes, bytes + sizeof(bytes), Magic);
}

namespace
{

/// The grids, and whether the file is as long as they are.
std::vector<VdbGrid> list_grids(const std::string& path, std::uint64_t length)
{
  return guarded(path,
    [&]
    {
      openvdb::initialize();
      std::vector<openvdb::io::GridDescriptor> descriptors;
      {
        std::ifstream in(path, std::ios::binary);
        in.exceptions(std::ios::failbit | std::ios::badbit);
        descriptors = Listing().read(in);
      }
      for (const openvdb::io::GridDescriptor& grid : descriptors)
      {
        if (static_cast<std::uint64_t>(std::max<std::int64_t>(grid.getEndPos(), 0)) > length)
        {
          fail(path,
            "the file is cut short: its grid '" + spoken_name(grid) + "' needs " +
              std::to_string(grid.getEndPos()) + " bytes, and it has " + std::to_string(length),
            "copy or download it again");
        }
      }
      const auto file = open_file(path);
      std::vector<std::string> names;
      for (const openvdb::io::GridDescriptor& grid : descriptors)
      {
        names.push_back(spoken_name(grid));
      }
      if (descriptors.empty())
      {
        for (auto name = file->beginName(); name != file->endName(); ++name)
        {
          names.push_back(name.gridName());
        }
      }
      std::vector<VdbGrid> grids;
      for (const std::string& name : names)
      {
        const openvdb::GridBase::Ptr grid = file->readGridMetadata(name);
        keep_in_rehearsal(grid);
        grids.push_back({ name,
          type_of(*grid),
          kind_of(*grid),
          refusal_of(*grid),
          grid->getGridClass() == openvdb::GRID_LEVEL_SET });
      }
      return grids;
    });
}

}

namespace
{

/// Whether the file has no offsets of its grids: it was saved as a stream. The flag follows on the mark
/// (8 bytes), the version (4) and the library's version (8).
bool is_stream(const std::string& path)
{
  constexpr std::size_t Place = 20;
  std::ifstream in(path, std::ios::binary);
  char bytes[Place + 1] = {};
  return in.read(bytes, sizeof(bytes)) && bytes[Place] == 0;
}

}

std::vector<VdbGrid> list_vdb_grids(
  const std::string& path, std::uint64_t limit, const Progress& progress)
{
  const std::uint64_t length = file_length(path, path);
  if (length == 0)
  {
    fail(path, "is empty", "copy or download it again");
  }
  if (!looks_like_vdb(path))
  {
    fail(path, "is not an OpenVDB file", "name a .vdb file");
  }
  openvdb::initialize();
  // Headers take next to nothing; of a stream every voxel is read. A block of zeroes is packed to a
  // sixteenth at the most, since its masks are not.
  const double size = is_stream(path) ? static_cast<double>(length) : 0.0;
  const double bytes = std::min((32 << 20) + 32 * size, static_cast<double>(memory_limit(limit)));
  rehearse(
    path,
    [&] { list_grids(path, length); },
    1 + size / 5e6,
    std::max(bytes, static_cast<double>(32 << 20)),
    [&](double) { return !progress || progress(0); });
  return list_grids(path, length);
}

namespace
{

/// A text that Brume's writer left beside the grid; empty where it left none.
std::string told(const openvdb::GridBase& grid, const char* name)
{
  const auto text = grid.getMetadata<openvdb::StringMetadata>(name);
  return text && text->value().size() <= 64 ? text->value() : std::string();
}

/// Distances to densities, in place. The band's width is the background, which OpenVDB divides by.
template <class Grid>
void make_fog(const std::string& path, const VdbGrid& which, Grid& grid, std::uint64_t limit, VdbVolume& volume)
{
  const auto band = grid.background();
  if (!std::isfinite(band) || !(band > 0))
  {
    fail(path,
      "its grid '" + which.name + "' is a level set with a background of " + std::to_string(band) +
        ", which is no width of a band",
      "read it as distances, or repair it (LevelSetRebuild)");
  }
  // Every leaf is loaded and changed in place.
  using Leaf = typename Grid::TreeType::LeafNodeType;
  check_memory(path,
    static_cast<double>(grid.tree().leafCount()) *
      static_cast<double>(sizeof(Leaf) + Leaf::SIZE * sizeof(typename Leaf::ValueType)),
    limit);
  openvdb::tools::sdfToFogVolume(grid);
  volume.active_voxels = grid.activeVoxelCount();
  volume.level_set = false;
  volume.fog_volume = true;
  char width[32];
  std::snprintf(width, sizeof(width), "%.6g", static_cast<double>(band));
  volume.messages.push_back("its level set becomes a density: 0 at the surface, 1 from a depth of " +
    std::string(width) + " on");
}

}

VdbVolume read_vdb_grid(const std::string& path,
  const VdbGrid& which,
  bool level_set_to_fog,
  std::uint64_t limit,
  const Progress& progress)
{
  return guarded(path,
    [&]
    {
      if (!which.refusal.empty())
      {
        const std::size_t colon = which.refusal.find(": ");
        fail(path,
          "its grid '" + which.name + "' " + which.refusal.substr(0, colon),
          which.refusal.substr(colon + 2));
      }
      const double length = static_cast<double>(file_length(path, path));
      rehearse(
        path,
        [&]
        {
          guarded(path,
            [&]
            {
              const openvdb::GridBase::Ptr grid = open_file(path)->readGrid(which.name);
              keep_in_rehearsal(grid);
              read_voxels_of<openvdb::FloatGrid>(*grid) ||
                read_voxels_of<openvdb::DoubleGrid>(*grid);
            });
        },
        1 + length / 5e6,
        static_cast<double>(memory_limit(limit)),
        [&](double) { return !progress || progress(0); });
      const auto file = open_file(path);
      const openvdb::GridBase::Ptr grid = file->readGrid(which.name);
      VdbVolume volume;
      volume.name = which.name;
      volume.active_voxels = grid->activeVoxelCount();
      volume.level_set = which.level_set;
      volume.fog_volume = grid->getGridClass() == openvdb::GRID_FOG_VOLUME;
      volume.length_unit = told(*grid, "length_unit");
      volume.value_unit = told(*grid, "value_unit");
      volume.patient = told(*grid, "axes") == "RAS";
      const openvdb::Mat4R matrix = grid->constTransform().baseMap()->getAffineMap()->getMat4();
      for (int row = 0; row < 4; ++row)
      {
        for (int column = 0; column < 4; ++column)
        {
          volume.world_from_index[4 * row + column] = matrix(column, row); // OpenVDB's are rows
        }
      }
      const bool half = which.type == "half";
      try
      {
        const auto take = [&](auto& typed)
        {
          if (which.level_set && level_set_to_fog)
          {
            make_fog(path, which, typed, limit, volume);
          }
          volume.voxels = take_voxels(typed.tree(), half, path, limit, progress);
        };
        if (grid->isType<openvdb::FloatGrid>())
        {
          take(static_cast<openvdb::FloatGrid&>(*grid));
        }
        else
        {
          take(static_cast<openvdb::DoubleGrid&>(*grid));
          volume.messages.push_back("its doubles are rounded to single precision");
        }
      }
      catch (const std::invalid_argument& error)
      {
        fail(path,
          "its grid '" + which.name + "' cannot be held: " + error.what(),
          "take a part of it");
      }
      catch (const std::length_error& error)
      {
        fail(path,
          "its grid '" + which.name + "' cannot be held: " + error.what(),
          "take a part of it, or allow more (--max-memory)");
      }
      if (!volume.voxels)
      {
        fail(path, "its grid '" + which.name + "' holds no voxels", "name another grid");
      }
      return volume;
    });
}

}
