// What properties of random scenes have in common: settings, pictures, what rounding may change.
#pragma once

#include "hard_case.h"
#include "property.h"
#include "random_scene.h"
#include "ray_truth.h"

#include "Transport/reference.h"

#include <glm/ext/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace stability
{

using namespace brume_tests;

constexpr int edge = 8; ///< pixels
constexpr int few = 40; ///< scenes that a property is tried in, if nothing else is asked for

/// Undoes draw_target(), whatever a property threw.
struct TargetGuard
{
  ~TargetGuard() { force_simd_target(""); }
};

/// Steps of a sixtieth of the picture's height.
inline double step_of(const RandomScene& random)
{
  // Lengths are the data's, which for random scenes are the world's.
  return random.view.half_height / 30.0;
}

inline MarchSettings settings_of(const RandomScene& random)
{
  MarchSettings settings;
  settings.step = step_of(random);
  settings.leave_error = 0.0;
  settings.threads = 1;
  settings.precise_shadows = true;
  settings.shadow_step = 3.1416 * settings.step; // lattices of some thousand nodes
  return settings;
}

inline ShadowMethod draw_shadows()
{
  return *rc::gen::element(ShadowMethod::Rays, ShadowMethod::Volume, ShadowMethod::Functions);
}

inline Film drawn(const Scene& scene, const MarchSettings& settings)
{
  Film film(edge, edge);
  Marcher().render(scene, settings, film);
  return film;
}

inline Film by_reference(const Scene& scene, double tolerance)
{
  Film film(edge, edge);
  ReferenceSettings settings;
  settings.tolerance = tolerance;
  settings.threads = 1;
  settings.most_pieces = 256;
  render_reference(scene, settings, film);
  return film;
}

/// What light of the brightest of a picture, or white, is.
inline double brightest(const Film& film)
{
  double most = 1.0;
  for (int c = 0; c < 3; ++c)
  {
    for (float v : film.radiance[c])
    {
      most = std::max(most, double(v));
    }
  }
  return most;
}

inline double relative(const Film& a, const Film& b)
{
  return difference(a, b) / brightest(a);
}

/// What rounding may change, of white: 5e-5, and where matter is dense 1e-6 of the optical depth
/// across, as places are single precision; where transfer functions are steep, 4e-7 of it for each
/// of their nodes, as values are, too. By light volumes and functions of depth 2e-3 more: whether a
/// node on a face of the box is within it is a matter of rounding.
inline double rounding(const Scene& scene, ShadowMethod shadows = ShadowMethod::None)
{
  double worst = 0.0;
  for (const Volume& volume : scene.volumes)
  {
    const bool density = volume.meaning == ValueMeaning::Density;
    const std::vector<double>& opacity = volume.classification.opacity;
    const double extinction = density
                                ? volume.density.extinction
                                : -std::log1p(-*std::max_element(opacity.begin(), opacity.end())) /
                                    volume.classification.unit_distance;
    double across = 0.0;
    for (int axis = 0; axis < 3; ++axis)
    {
      across += glm::length(glm::dvec3(volume.data_from_index[axis])) * volume.grid.dims[axis];
    }
    const double steps = density ? 0.0 : static_cast<double>(opacity.size() - 1);
    worst = std::max(worst, extinction * across * (1e-6 + 4e-7 * steps));
  }
  const bool nodes = shadows == ShadowMethod::Volume || shadows == ShadowMethod::Functions;
  return 5e-5 + worst + (nodes ? 2e-3 : 0.0);
}

/// The worst of a property's figures, for the page; NaN wins.
struct Worst
{
  double value = 0.0;
  double operator()(double next)
  {
    value = next <= value ? value : next;
    return next;
  }
};

/// Tells the page of a property: the figure, and in how many scenes it held.
inline void tell(HardCase& hard_case,
  int held,
  const Worst& worst,
  double bound,
  const std::string& unit,
  const std::string& by)
{
  hard_case.measure(worst.value, bound, unit, by);
  hard_case.holds(held, property_trials(few), "random scenes", by);
}

/// All that has a place in the world, moved by a matrix; the view stays in the scene's own frame.
inline void move_world(Scene& scene, const glm::dmat4& m, double lengths)
{
  for (Volume& volume : scene.volumes)
  {
    volume.data_from_index = m * volume.data_from_index;
    volume.density.extinction /= lengths;
    volume.classification.unit_distance *= lengths;
  }
  for (Light& light : scene.lights)
  {
    light.direction = glm::normalize(glm::dmat3(m) * light.direction);
    light.position = glm::dvec3(m * glm::dvec4(light.position, 1.0));
    light.attenuation.y /= lengths;
    light.attenuation.z /= lengths * lengths;
  }
  scene.sky.up = glm::normalize(glm::dmat3(m) * scene.sky.up);
  scene.camera.clip_from_world = scene.camera.clip_from_world * glm::inverse(m);
  scene.camera.direction = glm::normalize(glm::dmat3(m) * scene.camera.direction);
}

inline SceneWishes lit_or_not(bool lit)
{
  SceneWishes wishes;
  wishes.lit = lit;
  wishes.volumes = 2;
  return wishes;
}

}
