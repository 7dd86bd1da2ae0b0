// A sparse volume made dense, for formats and filters that hold nothing else.
#pragma once

#include "vtkBrumeIOModule.h" // the export macro alone

#include "vtkSmartPointer.h"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

class vtkBrumeSparseVolume;
class vtkImageData;

namespace brume
{

/// The box of bricks around all that is stored, as floats: voxel (0, 0, 0) is the lowest one,
/// values are bit for bit those of the sparse volume, the background where nothing is stored.
/// Spacing, origin and direction place each voxel where it was; mirrored axes give a left-handed
/// direction. An image cannot be sheared: the closest perpendicular axes are taken then
/// (orientation.h), and a line in `messages` says so.
///
/// Nothing is allocated before `limit` (bytes; 0: three quarters of the machine's memory) has been
/// asked. Throws std::runtime_error, "NAME: what is wrong: what to do", and
/// std::runtime_error("interrupted") where `progress` returns false.
VTKBRUMEIO_EXPORT vtkSmartPointer<vtkImageData> make_dense(vtkBrumeSparseVolume* volume,
  const std::string& name,
  std::uint64_t limit,
  std::vector<std::string>& messages,
  const std::function<bool(double)>& progress = {});

}
