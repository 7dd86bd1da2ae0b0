// Every integrator that can draw the matter of a RampRay, with what it must show.
#pragma once

#include "hard_case.h"
#include "ray_truth.h"

#include <functional>
#include <string>
#include <vector>

namespace stability
{

/// What a pixel shows. NaN: not asked.
struct Pixel
{
  double transmittance = NAN;
  double radiance = NAN;
};

struct RayIntegrator
{
  std::string name;
  bool simd = false; ///< runs once for each SIMD target
  /// Largest errors, of white: of rounding, with optical depths of a few.
  double bound = 2e-6;
  /// Draws it. `reads`: at how many places the matter was read; 0 if nobody tells.
  std::function<Pixel(const RampRay& ray, double& reads)> draw;
  /// The pixel in closed form.
  std::function<Pixel(const RampRay& ray)> truth;
  /// Bound of what was read, by the cells on the way; 0 for none.
  double reads_per_cell = 0.0;
  /// Expected to be a mean of random paths: the error is in standard errors.
  bool random = false;
  /// Shows a value that is on the way, however short that is.
  bool by_value = false;
};

/// What lit matter sends: a sun's light from behind the camera, scattered once, its own, or both.
enum class Sends
{
  Both,
  Sunlight,
  Glow,
};

constexpr int ray_paths = 1024; ///< a pixel, for what is random

/// Lights a ramp's scene from behind its camera, and lets it glow.
void light_ramp(const RampRay& ray, Scene& scene, Sends sends);

/// The pixel in closed form.
Pixel lit_truth(const RampRay& ray, Sends sends);

/// The longest edge of what a unit of index space is in the data: steps are made for it.
double longest_edge(const RampRay& ray);

/// All of them. Among them: the reference, fixed steps, the marcher by every rule, projections and
/// surfaces, lit media with a sun behind the camera and glow, by shadow rays and light volumes,
/// paths in packets and one by one; and the mappers (ray_mappers.h).
const std::vector<RayIntegrator>& ray_integrators();

/// Draws a ray with all of them, on all SIMD targets, and measures them. `loosen` multiplies the
/// bounds: where the ray's own numbers are known no better.
void measure_ray(brume_tests::HardCase& hard_case, const RampRay& ray, double loosen = 1.0);

}
