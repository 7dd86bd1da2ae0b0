// From the place a header names to numbers in memory. Private to this module.
#pragma once

#include "scan_header.h"

#include <functional>

namespace brume::io
{

/// Called now and then with the part of the work that is done, in [0, 1]; false stops the reading.
using Progress = std::function<bool(double)>;

/// Reads the volume of a header that check_header() has passed: x fastest, components together,
/// in this machine's byte order. `out` has room for header.bytes().
/// Throws fail() when the data end early, are damaged (a gzip checksum that does not hold counts)
/// or hold what is no number, and when `progress` stops it.
void read_voxels(const ScanHeader& header, void* out, const Progress& progress);

/// Turns a volume over along one index axis, in place. `voxel_bytes` is the size of one voxel.
void reverse_axis(void* voxels, const std::array<std::int64_t, 3>& dimensions,
  std::size_t voxel_bytes, int axis);

}
