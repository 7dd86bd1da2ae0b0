// Sparse voxels as the kernels read them: in packets of single precision.
#pragma once

#include "Transport/sparse_voxels.h"

#include <glm/vec3.hpp>

#include <vector>

/// The interpolated values at places of index space, with the instruction set that is chosen.
std::vector<float> packet_values(const brume::SparseVoxels& voxels,
  const std::vector<glm::vec3>& places);
