// The path tracer: an unbiased estimate of the light that any number of scatterings sends to the
// eye, and of its own error. Theory: docs/theory/paths.md.
#pragma once

#include "Transport/film.h"
#include "Transport/marcher.h"
#include "Transport/scene.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>

namespace brume
{

struct PlacedEnvironment;

struct PathSettings
{
  /// Paths a pixel, at the most; 1 to 2³¹ − 1.
  int samples_per_pixel = 64;
  /// Stops sooner when the estimated error is no larger; see PathStatistics. 0: never.
  double tolerance = 0.0;
  /// The share of the pixels that may have a larger error than the tolerance, in (0, 1). Asking for
  /// less than what the picture is judged by leaves room for chance.
  double beyond = 0.001;
  /// Pixels have paths by their own noise, as many as the tolerance or the seconds ask for: at least
  /// `fewest_samples`, at most samples_per_pixel. Off: all have the same number. On, whether a pixel
  /// has enough is told from the paths themselves, which leaves a bias that is small against the
  /// noise.
  bool adaptive = false;
  static constexpr int fewest_samples = 16;
  /// Stops sooner rather than trace paths for longer than this, in seconds, after one path a pixel.
  /// 0: never. A pass that takes longer than was to be expected is left within it, and single paths are,
  /// too, that are not in the picture then. Where one path a pixel takes more than four times as long, pixels
  /// are left without.
  double seconds = 0.0;
  /// The seconds count from the call on, with what is prepared.
  bool seconds_of_all = false;
  /// Scatterings of a path, at the most; 0: any number. With 1 the picture is the ray marcher's
  /// without octaves, but for sky and glow, of which the marcher knows less.
  int most_scatterings = 0;
  /// Chooses among all pictures of this noise: same seed, same picture, bit for bit, for every
  /// number of threads.
  std::uint32_t seed = 1;
  /// Step of the transmittance through classified matter, in the data's units; 0: an eighth of the
  /// smallest voxel edge. One density that is drawn as one box, and is grey and nowhere negative,
  /// needs none.
  double step = 0.0;
  /// Light from all around (environment.h), added to the scene's lights and sky: itself, not as lights
  /// in its place. Null: none.
  std::shared_ptr<const PlacedEnvironment> environment;
  /// Goes on where the last render() of the same scene stopped, with its paths counted in: for
  /// pictures that refine. The caller vouches that nothing else has changed.
  bool resume = false;
  /// Worker threads; 0 for as many as the machine has processors.
  int threads = 0;
};

struct PathStatistics
{
  double seconds_prepare = 0.0; ///< bounds of bricks, transmittance
  double seconds = 0.0;         ///< paths alone, of this call
  int samples_per_pixel = 0; ///< paths that each pixel has at the least, those resumed from among them
  double mean_samples = 0.0; ///< the mean over the pixels
  std::uint64_t paths = 0;      ///< of this call
  std::uint64_t collisions = 0; ///< places at which matter was read, of this call
  std::uint64_t scatterings = 0;
  std::uint64_t shadow_rays = 0;
  /// What 99.9 % of the pixels' errors of radiance are expected to be below, as a fraction of
  /// white: normally distributed with the largest standard error of a pixel's channels, and no less
  /// than the mean of the pixels around it, as samples that are all alike tell little. +infinity
  /// before sixteen paths a pixel. Light that hardly any path finds is not in it.
  double estimated_error = std::numeric_limits<double>::infinity();
  /// Root mean square of the standard errors, over pixels and channels.
  double rms_error = std::numeric_limits<double>::infinity();
  int threads = 0;
  std::string simd = "none"; ///< the instruction set, where paths were traced in packets: SSE4, AVX2, …
  std::size_t non_finite_voxels = 0;
  bool completed = false; ///< false when aborted; the film then holds what there was
};

/// Draws scenes by tracing paths in composite mode. Film::radiance is the mean of the paths through
/// each pixel's centre; Film::transmittance and depth are the ray marcher's, whose error is far
/// smaller; Film::error is three times the largest channel's standard error, from the second path
/// on. Of a pixel whose paths are all black, in matter, that is at least what paths around it bring that
/// find light, by its number of paths.
///
/// What is not simulated: gradient shading (the phase function holds instead), octaves (all
/// scatterings are followed), silver lining and powder (they are no physics).
///
/// Fog without bounds scatters light as often as volumes do, and they throw shadows on it. Without
/// falloff it has no upper end, and light from infinity reaches all of it undimmed (fog.h): that has a
/// meaning for one scattering alone, and is refused with more. Without falloff and with an albedo of 1
/// paths have no end, and scatterings need a limit.
///
/// Not to be used from two threads at once; two tracers may be.
class PathTracer
{
public:
  PathTracer();
  ~PathTracer();
  PathTracer(const PathTracer&) = delete;
  PathTracer& operator=(const PathTracer&) = delete;

  /// Fills the film, whose size is the picture's. Throws std::invalid_argument for a scene or
  /// settings that cannot be drawn.
  PathStatistics render(const Scene& scene,
    const PathSettings& settings,
    Film& film,
    const Progress& progress = {});

private:
  struct Kept;
  std::unique_ptr<Kept> Internal;
};

}
