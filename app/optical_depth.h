// How deep a density is, at a glance.
#pragma once

#include <array>
#include <cstdint>
#include <string>

class vtkBrumeSparseVolume;
class vtkImageData;

namespace brume::app
{

/// Of all straight lines of voxels along one index axis: how many meet anything, and the median and
/// the largest of their optical depths. 0 where none meets anything.
struct AxisDepth
{
  std::uint64_t lines = 0;
  double median = 0;
  double largest = 0;
};

/// The optical depth ∫ extinction · density ds along every line of voxels, for each of the three
/// index axes. `extinction` is per world unit and unit of density; values below 0 and those that
/// are not finite count as 0, as when the density is drawn. Between voxels the density is linear,
/// so that the sum is exact along these lines: dense volumes end at their outer voxels, which count
/// half; sparse ones fall off to the background, and end one voxel beyond what is stored.
std::array<AxisDepth, 3> optical_depths(vtkImageData* image, double extinction);
/// Throws std::runtime_error where the lines would take more than `max_memory` bytes (0: three quarters
/// of the machine's), naming the volume by `name`.
std::array<AxisDepth, 3> optical_depths(vtkBrumeSparseVolume* volume,
  double extinction,
  const std::string& name,
  std::uint64_t max_memory);

}
