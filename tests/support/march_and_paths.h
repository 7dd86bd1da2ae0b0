// One scattering, by paths and by the ray march: two integrators that share neither steps nor
// random numbers, and how their pictures are held against one another.
#pragma once

#include "transport_scenes.h"

#include "Transport/path_tracer.h"
#include "Transport/reference.h"

#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace march_and_paths
{

using namespace transport_scenes;

struct Picture
{
  std::string name;
  std::shared_ptr<const void> owner; ///< of the voxels
  Scene scene;
  int edge = 8;                ///< pixels
  double parts_of_voxel = 2.0; ///< steps of the march in one
  int parts_of_sky = 30;       ///< lights in its place
  double noise = 0.02;         ///< of the sum of the paths, relative
  bool by_reference = false;   ///< for what is beyond the march: double precision in its place
};

// What has a meaning for both.
// ---------------------------------------------------------------------

/// Without what is no transport of light (gradient shading, octaves, silver lining, powder), and
/// with densities in one place that add up: the mixture of VTK's components sends more than it
/// takes.
inline void leave_out_what_paths_do_not_know(Scene& scene)
{
  bool lit = false;
  for (Volume& volume : scene.volumes)
  {
    volume.shading.enabled = false;
    volume.medium.octaves = Octaves();
    volume.medium.silver_lining.enabled = false;
    volume.medium.powder.enabled = false;
    lit |= volume.medium.lit;
  }
  if (lit)
  {
    scene.mixture = Mixture::Sum;
  }
}

inline bool glows(const Volume& volume)
{
  const Medium& medium = volume.medium;
  return medium.lit ? medium.black_body > 0.0 || glm::length(medium.emission) > 0.0
                    : volume.meaning == ValueMeaning::Classified;
}

inline bool is_lit(const Scene& scene)
{
  return !scene.lights.empty() || glm::length(scene.sky.radiance + scene.sky.ground) > 0.0;
}

inline bool scatters(const Scene& scene)
{
  return (scene.fog.enabled && glm::length(scene.fog.albedo) > 0.0) ||
         std::any_of(scene.volumes.begin(),
           scene.volumes.end(),
           [](const Volume& v) { return v.medium.lit && glm::length(v.medium.albedo) > 0.0; });
}

/// The march does not scatter what glows: a scene that does both is two, one that only glows and
/// one that only scatters.
inline std::vector<Picture> parts_of(const Picture& picture)
{
  const Scene& scene = picture.scene;
  const bool both =
    std::any_of(scene.volumes.begin(), scene.volumes.end(), glows) && scatters(scene);
  if (!both)
  {
    return { picture };
  }
  Picture glow = picture;
  glow.name += ", its glow";
  glow.scene.fog.albedo = glm::dvec3(0.0);
  Picture light = picture;
  light.name += ", its light";
  for (Volume& volume : glow.scene.volumes)
  {
    volume.medium.albedo = glm::dvec3(0.0);
  }
  for (Volume& volume : light.scene.volumes)
  {
    volume.medium.emission = glm::dvec3(0.0);
    volume.medium.black_body = 0.0;
    if (!volume.medium.lit)
    {
      std::fill(volume.classification.rgb.begin(), volume.classification.rgb.end(), 0.0);
    }
  }
  return is_lit(scene) ? std::vector<Picture>{ glow, light } : std::vector<Picture>{ glow };
}

/// Directional lights in place of the sky, evenly spread (a spherical Fibonacci lattice): the
/// march's own sky is the integral over a slab, of matter that scatters evenly.
inline void take_sky_apart(Scene& scene, int count)
{
  const double pi = 3.14159265358979323846;
  const glm::dvec3 up = scene.sky.up;
  const glm::dvec3 side = glm::normalize(
    glm::cross(up, std::abs(up.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
  const glm::dvec3 other = glm::cross(up, side);
  for (int i = 0; i < count; ++i)
  {
    const double z = 1.0 - (2.0 * i + 1.0) / count;
    const glm::dvec3& radiance = z > 0.0 ? scene.sky.radiance : scene.sky.ground;
    if (glm::length(radiance) > 0.0)
    {
      const double turn = pi * (3.0 - std::sqrt(5.0)) * i;
      const double across = std::sqrt(1.0 - z * z);
      Light light;
      light.direction = -(z * up + across * (std::cos(turn) * side + std::sin(turn) * other));
      light.diffuse = radiance * (4.0 / count); // irradiance is π times this
      scene.lights.push_back(light);
    }
  }
  scene.sky.radiance = scene.sky.ground = glm::dvec3(0.0);
}

/// The march casts shadows on fog inside of volumes alone. An empty one around all that is seen
/// makes that everywhere; what is beyond it is not seen.
inline void surround_by_nothing(Scene& scene)
{
  static const Voxels<std::uint8_t> nothing(2, 2, 2, [](int, int, int) { return 0; });
  const float farthest = *std::max_element(scene.surface_depth.begin(), scene.surface_depth.end());
  const glm::dmat4 world_from_clip = glm::inverse(scene.camera.clip_from_world);
  glm::dvec3 lower(std::numeric_limits<double>::infinity());
  glm::dvec3 upper(-lower);
  for (int corner = 0; corner < 8; ++corner)
  {
    const glm::dvec4 at = world_from_clip * glm::dvec4(corner & 1 ? 1.0 : -1.0,
                                              corner & 2 ? 1.0 : -1.0,
                                              corner & 4 ? double(farthest) : -1.0,
                                              1.0);
    lower = glm::min(lower, glm::dvec3(at) / at.w);
    upper = glm::max(upper, glm::dvec3(at) / at.w);
  }
  Volume around;
  around.grid = nothing.grid();
  around.meaning = ValueMeaning::Density;
  around.data_from_index = placed(1.02 * (upper - lower), lower - 0.01 * (upper - lower));
  scene.volumes.push_back(around);
}

// Their pictures.
// ----------------------------------------------------------------------------------

/// The march's, with steps of a part of a voxel and shadow rays.
inline Film marched(const Scene& scene, int edge, double parts_of_voxel)
{
  double voxel = std::numeric_limits<double>::infinity();
  for (const Volume& volume : scene.volumes)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      voxel = std::min(voxel, glm::length(glm::dvec3(volume.data_from_index[axis])));
    }
  }
  MarchSettings settings;
  settings.leave_error = 0.0;
  settings.shadows = ShadowMethod::Rays;
  settings.precise_shadows = true;
  if (!scene.volumes.empty())
  {
    settings.step = voxel / parts_of_voxel;
    settings.shadow_step = has_exact_shadow_rays(scene) ? 0.0 : 2.0 * settings.step;
  }
  Film film(edge, edge);
  Marcher marcher;
  marcher.render(scene, settings, film);
  return film;
}

/// The march's picture, and how far it may be off.
struct Truth
{
  Film film;
  std::vector<double> error[3];
};

/// Its error is what half the step changes, of steps and, where there is a sky, of the sky's parts;
/// no less than single precision.
inline Truth find_truth(const Picture& picture)
{
  const Scene& scene = picture.scene;
  const int edge = picture.edge;
  Truth truth;
  if (picture.by_reference)
  {
    constexpr double tolerance = 1e-5;
    ReferenceSettings settings;
    settings.tolerance = tolerance;
    settings.most_pieces = 256;
    truth.film = Film(edge, edge);
    render_reference(scene, settings, truth.film);
    for (std::vector<double>& error : truth.error)
    {
      error.assign(truth.film.size(), tolerance);
    }
    return truth;
  }
  const bool sky = glm::length(scene.sky.radiance + scene.sky.ground) > 0.0;
  const bool surround =
    scene.fog.enabled && !scene.volumes.empty() && glm::length(scene.fog.albedo) > 0.0;
  Film films[2];
  for (const int level : { 0, 1 })
  {
    Scene seen = scene;
    if (sky)
    {
      take_sky_apart(seen, (level ? 2 : 1) * picture.parts_of_sky);
    }
    if (surround)
    {
      surround_by_nothing(seen);
    }
    films[level] = marched(seen, edge, (level ? 2.0 : 1.0) * picture.parts_of_voxel);
  }
  for (int c = 0; c < 3; ++c)
  {
    for (std::size_t i = 0; i < films[0].size(); ++i)
    {
      const double fine = films[1].radiance[c][i];
      truth.error[c].push_back(std::abs(fine - films[0].radiance[c][i]) + 1e-5 * fine);
    }
  }
  truth.film = films[1];
  return truth;
}

/// Paths with one scattering until the sum over the picture is known to its `noise`, or there are
/// 4096 of them a pixel; `effort` times as many.
inline Film traced(const Picture& picture, double effort, std::uint32_t seed)
{
  const Scene& scene = picture.scene;
  const double noise = picture.noise / std::sqrt(effort);
  const int most = static_cast<int>(4096 * effort);
  Film film(picture.edge, picture.edge);
  PathTracer tracer;
  PathSettings settings;
  settings.most_scatterings = 1;
  settings.seed = seed;
  for (int samples = 64;; samples *= 2)
  {
    settings.samples_per_pixel = std::min(samples, most);
    tracer.render(scene, settings, film);
    settings.resume = true;
    double sum = 0.0;
    double variance = 0.0;
    for (std::size_t i = 0; i < film.size(); ++i)
    {
      sum += std::max({ film.radiance[0][i], film.radiance[1][i], film.radiance[2][i] });
      variance += film.error[i] * film.error[i] / 9.0;
    }
    const bool black = sum == 0.0 && samples >= 256;
    if (samples >= most || black || (sum > 0.0 && std::sqrt(variance) <= noise * sum))
    {
      return film;
    }
  }
}

/// How far paths are from the march, in their own standard errors, after the march's own.
struct Agreement
{
  double sum = 0.0;    ///< of all pixels, in the worst channel
  double square = 0.0; ///< mean square of the pixels' in their worst channel: about 1
  double noise = 0.0;  ///< of the sum, relative
  double stated = 0.0; ///< the march's error of the sum, relative
  int count = 0;       ///< pixels in which paths differ
  int lost = 0;        ///< pixels that are off where paths do not differ
};

/// The mean variance of a pixel and those around it: few paths that are much alike tell little of
/// what is rare and bright.
inline double mean_around(const Film& paths, std::size_t pixel)
{
  const int x = static_cast<int>(pixel) % paths.width;
  const int y = static_cast<int>(pixel) / paths.width;
  double sum = 0.0;
  int count = 0;
  for (int j = std::max(y - 1, 0); j <= std::min(y + 1, paths.height - 1); ++j)
  {
    for (int i = std::max(x - 1, 0); i <= std::min(x + 1, paths.width - 1); ++i, ++count)
    {
      const double sigma = paths.error[j * paths.width + i] / 3.0;
      sum += sigma * sigma;
    }
  }
  return sum / count;
}

inline Agreement agreement(const Film& paths, const Truth& truth)
{
  Agreement a;
  double sums[3] = {};
  double errors[3] = {};
  double brightness = 0.0;
  double variance = 0.0;
  double squares = 0.0;
  std::vector<double> unseen;
  for (int c = 0; c < 3; ++c)
  {
    double sum = 0.0;
    for (float v : truth.film.radiance[c])
    {
      sum += v;
    }
    brightness = std::max(brightness, sum);
  }
  for (std::size_t i = 0; i < paths.size(); ++i)
  {
    const double sigma = paths.error[i] / 3.0; // of the noisiest channel
    double most = 0.0;                         // beyond the march's error
    for (int c = 0; c < 3; ++c)
    {
      const double off = double(paths.radiance[c][i]) - truth.film.radiance[c][i];
      sums[c] += off;
      errors[c] += truth.error[c][i];
      most = std::max(most, std::abs(off) - truth.error[c][i]);
    }
    if (sigma > 0.0)
    {
      variance += sigma * sigma;
      const double careful = std::max(sigma * sigma, mean_around(paths, i));
      squares += most * most / careful;
      ++a.count;
    }
    else
    {
      unseen.push_back(most);
    }
  }
  // No path of these pixels met anything, or all brought the same; as noisy as the others they may
  // be.
  const double usual = std::sqrt(variance / std::max(a.count, 1)) + 1e-6;
  a.lost = static_cast<int>(
    std::count_if(unseen.begin(), unseen.end(), [usual](double off) { return off > 5.0 * usual; }));
  for (int c = 0; c < 3; ++c)
  {
    const double off = std::max(std::abs(sums[c]) - errors[c], 0.0);
    a.sum = std::max(a.sum, off / (std::sqrt(variance) + 1e-9));
    a.stated = std::max(a.stated, errors[c] / std::max(brightness, 1e-300));
  }
  a.square = squares / std::max(a.count, 1);
  a.noise = std::sqrt(variance) / std::max(brightness, 1e-300);
  return a;
}

}
