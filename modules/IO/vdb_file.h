// OpenVDB files: what is in one, and a grid of it as sparse voxels. Private to this module;
// OpenVDB's own headers stay in vdb_file.cxx and vdb_bricks.cxx.
#pragma once

#include "voxel_reader.h" // for Progress

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace brume
{
class SparseVoxels;
}

namespace brume::io
{

/// A grid of a file, without its voxels.
struct VdbGrid
{
  std::string name; ///< as the file has it; a second one of the same name is "name[1]"
  std::string type; ///< "float", "half" (a float grid stored as such), "double", "vec3s", …
  std::string kind; ///< "fog volume", "level set", "staggered", "unknown"
  /// Why it cannot be read and what to do, "holds vec3s: …"; empty where it can.
  std::string refusal;
  bool level_set = false;
};

/// A grid with its voxels.
struct VdbVolume
{
  std::string name;
  std::shared_ptr<const SparseVoxels> voxels;
  /// The file's voxel (i, j, k) in its world, row-major 4 × 4: world = matrix · (i, j, k, 1).
  std::array<double, 16> world_from_index{};
  std::uint64_t active_voxels = 0;
  bool fog_volume = false; ///< what it is in memory
  bool level_set = false;
  std::string length_unit; ///< where Brume's writer left them in the grid's metadata
  std::string value_unit;
  bool patient = false;
  std::vector<std::string> messages; ///< what was settled by itself, one line each
};

/// Whether the file begins as OpenVDB files do. Throws nothing.
bool looks_like_vdb(const std::string& path);

/// The grids in the order of the file. Nothing of their size is read; a file that is shorter than
/// its grids is found out. A file that was saved as a stream has no table of contents and is read whole,
/// within `limit` bytes (memory_limit.h). Throws std::runtime_error as fail() in scan_header.h does.
std::vector<VdbGrid> list_vdb_grids(
  const std::string& path, std::uint64_t limit = 0, const Progress& progress = {});

/// Reads one grid of list_vdb_grids(). Its voxels go from the file to their bricks at once, on all
/// processors, and are never held twice. `level_set_to_fog`: a level set becomes a density, 1 where it
/// is deeper than its band is wide, falling to 0 at the surface (openvdb::tools::sdfToFogVolume). Throws as above, also where they take more than `limit` bytes
/// (memory_limit.h); std::bad_alloc where memory runs out.
VdbVolume read_vdb_grid(const std::string& path,
  const VdbGrid& grid,
  bool level_set_to_fog,
  std::uint64_t limit,
  const Progress& progress);

}
