// Many paths side by side, one in each lane of the SIMD registers. For scenes of one grey density
// under suns and an even sky; PathScene follows all others one by one. The estimator is
// PathScene's, in single precision. Theory: docs/theory/paths.md. Internal to Transport.
#pragma once

#include "Transport/path_matter.h"
#include "Transport/phase_sampler.h"
#include "Transport/scene.h"
#include "Transport/sparse_table.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace brume
{

struct PathCounts;

/// A light at infinity.
struct PathSun
{
  float toward[3]; ///< unit vector of the world
  float irradiance[3];
};

/// What packets need to know of a scene. Rates and densities are those of the one extinction that
/// all channels have, per unit of the data's length.
struct PathPacketScene
{
  const PathMatter* matter = nullptr;
  std::vector<float>
    bricks; ///< of each brick: its rate, or minus its distance if that is 0; its least
  int shift = 3;
  int brick_dims[3] = { 0, 0, 0 };
  float lower[3], upper[3]; ///< the box, index space
  int first[3], last[3];    ///< voxels along each axis
  /// Voxels at hand as floats, dense or a sparse grid's pool; null: PathMatter::read_voxels.
  const float* voxels = nullptr;
  int components = 1;
  const SparseTable* table = nullptr; ///< of a sparse grid
  float scale = 0.0f;                 ///< extinction of a voxel of 1
  float index_from_world[9];          ///< directions; row by row
  float data_from_index[9];
  float albedo[3];
  std::vector<PathSun> suns;
  float sky[3], ground[3], up[3];
  bool glows = false; ///< sky or ground send light
};

/// Where the paths of a pixel begin: on their way into the box, or in it.
struct PathStart
{
  float begin[3];      ///< index space
  float direction[3];  ///< unit vector of the world
  float length = 0.0f; ///< world units to where the matter or the view ends
  std::uint32_t pixel = 0;
  std::uint32_t first = 0; ///< the first sample
};

/// Traces `samples` paths from each start, and writes R, G, B of each, sample by sample.
/// The same whatever they are traced together with.
void trace_paths(const PathPacketScene& scene,
  const std::vector<PathStart>& starts,
  int samples,
  int most_scatterings,
  std::uint32_t seed,
  float* radiance,
  PathCounts& counts);

}
