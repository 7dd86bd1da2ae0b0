// What the C++ code of this process holds in memory: operator new and delete are counted.
#pragma once

#include <cstddef>

namespace benchmarks
{

/// Bytes from operator new that live now, in all libraries. VTK's voxels come from malloc and are
/// not among them.
std::size_t live_bytes();
/// The most since the last reset_peak().
std::size_t peak_bytes();
void reset_peak();

}
