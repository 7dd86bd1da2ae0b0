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

/// Of lit scenes with shadows of a kind that is drawn.
inline MarchSettings settings_of(const RandomScene& random, bool lit)
{
  MarchSettings settings;
  settings.step = step_of(random);
  settings.leave_error = 0.0;
  settings.threads = 1;
  settings.precise_shadows = true;
  settings.shadow_step = 3.1416 * settings.step; // lattices of some thousand nodes
  settings.shadows =
    lit ? *rc::gen::element(ShadowMethod::Rays, ShadowMethod::Volume, ShadowMethod::Functions)
        : ShadowMethod::None;
  return settings;
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

/// By how much two references were still changing: rays that reached the shortest pieces tell so.
inline double unsettled(const Film& a, const Film& b)
{
  double most = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    most = std::max({ most, double(a.error[i]), double(b.error[i]) });
  }
  return most;
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

/// What rounding may change, of white: five times the worst of 20,000 random scenes without
/// shadows.
constexpr double rounding = 2e-5;

/// How far `other`, the same picture but for rounding, is from `film`, by what is allowed. Where a
/// shadow ray grazes the box of a further volume, or a light volume's node lies on a face, rounding
/// tells whether matter is met there, and with it how long the ray's equal steps are: its error by
/// steps is another one then. Half of what halving those steps changes is allowed for that.
inline double beyond_rounding(const Scene& scene,
  MarchSettings settings,
  const Film& film,
  const Film& other)
{
  const double off = relative(film, other);
  double allowed = rounding;
  if (off > rounding && settings.shadows != ShadowMethod::None)
  {
    settings.shadow_step *= 0.5;
    allowed += 0.5 * relative(film, drawn(scene, settings));
  }
  return off / allowed;
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

/// Tries a property of random scenes, each on one of this machine's SIMD targets. Returns how often
/// it held.
template <class Property>
int try_scenes(const std::string& name, Property property)
{
  return expect_property(
    name,
    few,
    [&]()
    {
      const TargetGuard guard;
      draw_target();
      property();
    },
    true);
}

inline std::string march(bool lit)
{
  return lit ? "lit march" : "march";
}

/// The same for a property of unlit and of lit scenes, property(lit, worst), and tells the page.
template <class Property>
void try_unlit_and_lit(HardCase& hard_case,
  const std::string& name,
  double bound,
  const std::string& unit,
  Property property)
{
  for (const bool lit : { false, true })
  {
    Worst worst;
    const int held = try_scenes(name, [&]() { property(lit, worst); });
    tell(hard_case, held, worst, bound, unit, march(lit));
  }
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
