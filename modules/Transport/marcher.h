// The ray marcher: packets of rays, tiles shared by threads, caches.
#pragma once

#include "Transport/film.h"
#include "Transport/scene.h"

#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <utility>

namespace brume
{

/// How the light of a step is found from the values on it.
enum class StepRule
{
  /// The value in the middle of the step stands for all of it.
  Midpoint,
  /// The values at both ends: between them they are taken to run evenly, and the transfer functions
  /// are integrated over that run. Steep functions then need no short steps. For one classified
  /// volume without a mask whose colour comes from its value; others are marched by Midpoint.
  Integrated,
  /// Two Gauss–Legendre points in each cell that the ray crosses: the optical depth of a trilinear
  /// density is exact, whatever the step. For one density; others are marched by Midpoint.
  Cells,
};

/// "midpoint", "integrated" or "cells".
const char* step_rule_name(StepRule rule);

constexpr int most_refinements = 8;

/// How the light that reaches a place in a lit medium is found to be dimmed on its way.
enum class ShadowMethod
{
  /// It is not.
  None,
  /// A ray toward each light from each sample: right, and dear.
  Rays,
  /// Optical depths toward each light on a grid, swept once and kept while light and medium stay.
  Volume,
  /// For each light a map of functions of depth: where matter begins and ends, and six cosine
  /// coefficients of the transmittance between. Little memory, soft shadows.
  Functions,
};

/// "none", "rays", "volume" or "functions".
const char* shadow_method_name(ShadowMethod method);

/// How a picture is to be made.
struct MarchSettings
{
  StepRule rule = StepRule::Midpoint;
  /// Length of a step, in the data's units; > 0. Largest and smallest values, isosurfaces and slices
  /// are found cell by cell, whatever the step. The last step of a ray is cut at the grid's end.
  /// Longer for all where one of the picture's rays would have more than 2¹⁶ of them in a volume:
  /// beyond, rounding would cost more than they gain.
  double step = 1.0;
  /// The largest error of a pixel, as a fraction of white, that may be made by ending rays early;
  /// ≥ 0. A ray is left when all that is behind could not change its pixel by more.
  double leave_error = 0.001;
  /// An error of the picture that the caller knows of; added to Film::error. ≥ 0.
  double step_error = 0.0;
  /// Where the estimated error of a pixel is larger than `refine_error`, it and its neighbours are
  /// marched again with half the step, up to `refinements` times; 0 to most_refinements.
  int refinements = 0;
  double refine_error = 0.0;
  /// Of lit media.
  ShadowMethod shadows = ShadowMethod::Volume;
  /// Length of a shadow ray's step, or distance between the nodes of a light volume or a shadow
  /// map, in the data's units. 0: one voxel edge; rays through one density then go cell by cell, which
  /// is exact.
  double shadow_step = 0.0;
  /// Light volumes of 32-bit floats in place of 16 bits (of which each is 80 / 65535 of optical depth
  /// or less; where it would be more, 32 bits are taken anyway).
  bool precise_shadows = false;
  /// Whether the media dim what is behind them (Effect::Absorption), and whether bricks that hold
  /// nothing are leapt over. Other effects are left out by leaving them out of the scene
  /// (effect_plan.h).
  bool absorption = true;
  bool leaping = true;
  /// Rays begin within their first step at a place that differs from pixel to pixel: long steps
  /// then show as grain rather than as bands. The same in every picture.
  bool jitter = false;
  /// Worker threads; 0 for as many as the machine has processors.
  int threads = 0;
};

/// What making a picture took.
struct MarchStatistics
{
  double seconds_prepare = 0.0; ///< scanning voxels, building tables, sweeping light; 0 when all was kept
  double seconds_light = 0.0;   ///< of these, sweeping light
  double seconds = 0.0;         ///< the render alone
  double step = 0.0;            ///< the step that was taken, in the data's units
  StepRule rule = StepRule::Midpoint; ///< the rule that was followed
  ShadowMethod shadows = ShadowMethod::None; ///< of lit media; None where nothing is lit
  double shadow_step = 0.0;                  ///< in the data's units
  std::size_t light_bytes = 0;               ///< memory that light volumes or shadow maps take
  std::uint64_t samples = 0;    ///< places at which the grid was read
  std::uint64_t rays = 0;       ///< rays that met the grid
  int threads = 0;
  std::string simd;             ///< the instruction set that was used: SSE4, AVX2, AVX3…
  std::size_t non_finite_voxels = 0;
  std::size_t bricks = 0;
  std::size_t visible_bricks = 0;
  bool completed = false;       ///< false when the render was aborted; the film is then partial
};

/// Called from the thread that called render(), now and then, with the fraction done in [0, 1].
/// Returns false to abort.
using Progress = std::function<bool(double)>;

/// Draws scenes, and keeps between pictures what does not change: the bricks as long as
/// Scene::data_revision stays, the tables and
/// the visible bricks as long as medium_revision stays, too.
/// Not to be used from two threads at once; two marchers may be.
class Marcher
{
public:
  Marcher();
  ~Marcher();
  Marcher(const Marcher&) = delete;
  Marcher& operator=(const Marcher&) = delete;

  /// Fills the film, whose size is the picture's. Throws std::invalid_argument for a scene or
  /// settings that cannot be drawn (see Scene, MarchSettings). Same scene, same picture, bit for
  /// bit, whatever the number of threads.
  MarchStatistics render(const Scene& scene, const MarchSettings& settings, Film& film,
    const Progress& progress = {});

  /// Thrown by render() where the watch ends it.
  struct Interrupted : std::exception
  {
    const char* what() const noexcept override { return "the render was ended by its watch"; }
  };
  /// Asked now and then, from the calling thread, by each render() that has no progress of its own;
  /// false ends it by an exception, so that whatever is made of many renders (choose_step,
  /// choose_shadows, plan_effects) ends with it. The marcher stays usable. Default: none.
  void set_watch(std::function<bool()> watch) { this->Watch = std::move(watch); }

private:
  std::function<bool()> Watch;
  struct Cache;
  std::unique_ptr<Cache> Kept;
};

/// Whether a scene can be marched by a rule; where it cannot, Marcher::render takes Midpoint.
bool follows_rule(const Scene& scene, StepRule rule);

/// Whether shadow rays of a lit scene can go cell by cell, which is exact: through one trilinear
/// density that is drawn as one box.
bool has_exact_shadow_rays(const Scene& scene);

/// Names of the SIMD targets that this machine can run, best first.
std::string simd_targets();
/// Uses only the target of this name (as simd_targets() has it) from now on; "" for the best again.
/// Returns false and changes nothing for a name that is not there. For tests and measurements.
bool force_simd_target(const std::string& name);

}
