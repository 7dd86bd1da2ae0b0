// Grids into OpenVDB files. Private to this module; OpenVDB's own headers stay in vdb_writer.cxx.
#pragma once

#include "scan_header.h"
#include "voxel_reader.h" // for Progress

#include <array>
#include <memory>
#include <string>

namespace brume
{
class SparseVoxels;
}

namespace brume::io
{

/// What the values of a grid are, in OpenVDB's words.
enum class VdbClass
{
  Unknown,
  FogVolume,
  LevelSet
};

/// What is said of a grid beside its voxels.
struct VdbDescription
{
  std::string name;
  VdbClass kind = VdbClass::Unknown;
  bool half = false; ///< written in half precision
  /// Voxel (i, j, k) of the grid in the world, row-major 4 × 4, affine.
  std::array<double, 16> world_from_index{ { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1 } };
  std::string length_unit; ///< these become metadata that Brume's reader knows
  std::string value_unit;
  bool patient = false;
};

/// Dense voxels, x fastest: voxel (0, 0, 0) is the grid's voxel `first`.
struct DenseVoxels
{
  Scalar scalar = Scalar::Float32;
  const void* voxels = nullptr;
  std::array<int, 3> dimensions{ { 0, 0, 0 } };
  std::array<int, 3> first{ { 0, 0, 0 } };
};

/// Grids that become one file.
class VdbWriter
{
public:
  VdbWriter();
  ~VdbWriter();
  VdbWriter(const VdbWriter&) = delete;
  VdbWriter& operator=(const VdbWriter&) = delete;

  // Both throw std::invalid_argument for a transform that flattens space, and
  // std::runtime_error("interrupted") where `progress` asks to stop.

  /// Bricks become leaves and tiles tiles, all values as they are. Active is what differs from the
  /// background; of a level set what is nearer to the surface than the background tells.
  void add(const SparseVoxels& voxels, const VdbDescription& description, const Progress& progress);

  /// Voxels within `tolerance` of the background become background, and inactive; blocks of one
  /// value become tiles. Of a level set the background is the width of the band: values beyond it,
  /// on either side, become the background or its negative, and inactive; `tolerance` is not used.
  /// Returns the number of active voxels.
  std::uint64_t add(const DenseVoxels& voxels,
    double background,
    double tolerance,
    const VdbDescription& description,
    const Progress& progress);

  /// Writes them all beside `path` and moves the file there. Throws as AtomicFile does.
  void write(const std::string& path, const Progress& progress);

private:
  struct Grids;
  std::unique_ptr<Grids> grids_;
};

}
