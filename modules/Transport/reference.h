// The truth that pictures are measured against: the same optics in double precision, refined until
// the picture stops changing. Slow and plain. It shares no arithmetic with the kernels; of their
// machinery it uses the brick ranges, to pass over what cannot be seen.
#pragma once

#include "Transport/film.h"
#include "Transport/marcher.h"
#include "Transport/scene.h"

#include <cstdint>

namespace brume
{

struct ReferenceSettings
{
  /// A ray is refined until neither radiance nor transmittance changes by more than this, as a
  /// fraction of white, in two doublings in a row; > 0.
  double tolerance = 1e-4;
  /// Pieces that each voxel cell on the way is cut into at the most; a power of two, ≥ 2. A ray
  /// that still changes there keeps its last change as its error.
  int most_pieces = 64;
  int threads = 0; ///< 0 for as many as the machine has processors
};

struct ReferenceStatistics
{
  double seconds = 0.0;
  std::uint64_t samples = 0;
  /// How much the last doubling of the pieces still changed the pixels. The midpoint rule converges
  /// with the square of the piece, so about a third of this remains.
  double mean_change = 0.0;
  double largest_change = 0.0;
  /// Rays that reached `most_pieces` before they stopped changing.
  std::uint64_t unsettled_rays = 0;
  bool completed = false;
};

/// Fills the film with the truth, in any blend mode. Along each ray, the places where it passes
/// from one voxel cell to the next are found first; each stretch between two of them, in which the
/// interpolated value is smooth, is cut into pieces of equal length (midpoint rule), 1, 2, 4, 8, …
/// of them until the ray's result stops changing; more where the transfer functions rise and fall
/// within the stretch. Largest and smallest values, isosurfaces and slices are found in closed form
/// instead (docs/theory/modes.md) and count as settled. Film::error holds the last change. Throws
/// as Marcher::render does.
ReferenceStatistics render_reference(const Scene& scene, const ReferenceSettings& settings,
  Film& film, const Progress& progress = {});

/// Where the samples of a fixed step lie along a ray.
enum class SamplePlacement
{
  /// In the middle of each step from the grid's near face on, the last step cut: Brume's marcher.
  Middle,
  /// At whole steps from the camera's near plane, each counted as a whole step:
  /// vtkFixedPointVolumeRayCastMapper.
  FromNearPlane,
  /// At whole steps from the grid's near face: vtkOpenGLGPUVolumeRayCastMapper without jitter.
  FromEntry,
};

/// Fills the film with a fixed step's picture in double precision: what a step and its placement do
/// to the picture, apart from any rounding. The step is a length of the first volume's data. Rays
/// end when less than `leave_below` passes. Projections take their values at the samples;
/// isosurfaces and slices are exact. Returns whether it was completed.
bool render_fixed_step(const Scene& scene, double step, SamplePlacement placement,
  double leave_below, int threads, Film& film, const Progress& progress = {});

}
