// A march that makes a picture's fetches and nothing else: what the memory alone would take.
#pragma once

#include "Transport/scene.h"

#include <cstdint>
#include <vector>

namespace benchmarks
{

/// Where a march of fixed steps reads, packet by packet, in the kernels' order: tiles of 32²,
/// packets as square as the lanes allow, empty bricks leapt over, four samples between two looks.
/// Grids of one 16-bit component.
struct FetchTrace
{
  const std::uint8_t* voxels = nullptr;
  std::int32_t row = 0;   ///< bytes to the next row of voxels
  std::int32_t slice = 0; ///< bytes to the next slice
  /// For each sample of a packet as many as there are lanes: the byte at which its cell begins, and
  /// the place of the transfer function's node below its value.
  std::vector<std::int32_t> cells;
  std::vector<std::int32_t> nodes;
  std::vector<float> table;  ///< red, green, blue, optical depth a node
  std::uint64_t samples = 0; ///< those of rays that are under way
};

FetchTrace record_fetches(const brume::Scene& scene, int width, int height, double step);

/// Makes the fetches on one thread with the widest instructions of the machine: for each sample
/// four pairs of voxels, two optical depths, and six colours where any lane of the packet can be
/// seen. Returns the seconds.
double run_fetches(const FetchTrace& trace);

}
