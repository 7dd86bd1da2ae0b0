// From OpenVDB's tree to sparse voxels. Private to this module; includes OpenVDB.
#pragma once

#include "vdb_file.h"

#include <openvdb/openvdb.h>

namespace brume::io
{

/// Takes the voxels out of the tree, leaf by leaf: the tree's leaves are empty afterwards. Null for
/// a tree that holds nothing but its background. `half`: store them in half precision. Throws
/// fail() with `path` where they take more than `limit` bytes (memory_limit.h), before any is read.
std::shared_ptr<const SparseVoxels> take_voxels(openvdb::FloatTree& tree,
  bool half,
  const std::string& path,
  std::uint64_t limit,
  const Progress& progress);
/// Doubles are rounded to single precision.
std::shared_ptr<const SparseVoxels> take_voxels(openvdb::DoubleTree& tree,
  bool half,
  const std::string& path,
  std::uint64_t limit,
  const Progress& progress);

}
