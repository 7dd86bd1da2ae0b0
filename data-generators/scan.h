// From a painted phantom to what a CT scanner stores.
#pragma once

#include "data-generators/sampling.h"

#include <cstdint>

namespace brume
{

class PaintedVolume;

/// Fills a block of a grid with a phantom in Hounsfield units, rounded to whole ones, with a
/// scanner's noise: independent Gaussian noise in each voxel, of standard deviation `noise` HU (0
/// or less: none), seeded, and the same whatever the block and the threads. Values are held to
/// [-1024, 3071], as scanners store them. `values` has extent.voxels() elements, x fastest. False
/// if `progress` asked to stop.
bool sample_scan(const PaintedVolume& phantom,
  double noise,
  std::uint32_t noise_seed,
  const Lattice& grid,
  const Extent& extent,
  std::int16_t* values,
  const Progress& progress = {});

}
