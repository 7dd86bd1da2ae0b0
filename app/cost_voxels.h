// A scene whose voxels hold less, or more, than they came with.
#pragma once

#include "volume_scene.h"

#include <memory>
#include <string>
#include <vector>

namespace brume::app
{

/// A way to store voxels.
enum class VoxelStore
{
  Float,
  Half,
  UInt16,
  UInt8,
};

const char* voxel_store_name(VoxelStore store);

/// The scene with its voxels stored like that: integers spread over the range of the values, and
/// transfer functions or extinction stretched alike, so that the same matter is drawn. Null, with the
/// reason, where that cannot be: for what the voxels are already, for several components, for half
/// precision of a dense volume whose outermost voxels are not empty (half precision is sparse), for integers
/// in a sparse one.
std::unique_ptr<VolumeScene> with_voxels(
  const VolumeScene& scene, VoxelStore store, std::string& reason);

}
