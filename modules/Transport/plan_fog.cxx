#include "Transport/plan_fog.h"

#include "Transport/fog.h"
#include "Transport/fog_film.h"
#include "Transport/zoom.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace brume
{

namespace
{

constexpr int edge = 32; ///< rays along each side of the picture
/// Between the rays that are looked at a figure may be somewhat larger.
constexpr double between_rays = 1.05;
/// A ray through a lamp is as bright as a pixel of so many pixels a side is wide.
constexpr double most_pixels = 16384.0;

/// sup over t in [0, most] of |e^{−a t} − e^{−b t}|.
double largest_difference(double a, double b, double most)
{
  if (a == b || !(most > 0.0))
  {
    return 0.0;
  }
  double at = most;
  if (a > 0.0 && b > 0.0)
  {
    at = std::min(most, std::log(a / b) / (a - b));
  }
  return std::abs(std::exp(-a * at) - std::exp(-b * at));
}

struct Ray
{
  FogRay ray;
  double end;
};

/// Rays of the camera, and one through each lamp that can be seen.
std::vector<Ray> rays_of(const Scene& scene, const FogModel& fog)
{
  Scene view;
  view.camera = scene.camera;
  const FogRays all(view, fog, edge, edge);
  double deepest = 1.0;
  if (!scene.surface_depth.empty())
  {
    deepest = *std::max_element(scene.surface_depth.begin(), scene.surface_depth.end());
  }
  view.surface_depth.assign(edge * edge, static_cast<float>(deepest));
  const FogRays cut(view, fog, edge, edge);
  std::vector<Ray> rays;
  for (int y = 0; y < edge; ++y)
  {
    for (int x = 0; x < edge; ++x)
    {
      const FogRay ray = all.ray(x, y);
      rays.push_back({ ray, cut.end(x, y, ray) });
    }
  }
  const FogRay first = rays.front().ray;
  const bool parallel = rays.back().ray.origin != first.origin;
  for (const Light& light : scene.lights)
  {
    const glm::dvec4 clip = scene.camera.clip_from_world * glm::dvec4(light.position, 1.0);
    if (!light.positional || !(clip.w > 0.0) || std::abs(clip.x) > clip.w ||
        std::abs(clip.y) > clip.w)
    {
      continue;
    }
    const glm::dvec3 way = light.position - first.origin;
    if (parallel)
    {
      const double along = glm::dot(way, first.direction);
      const glm::dvec3 origin = light.position - first.direction * along;
      rays.push_back({ fog.ray(origin, first.direction, 0.0), rays.front().end });
    }
    else if (glm::length(way) > 0.0)
    {
      rays.push_back(
        { fog.ray(first.origin, glm::normalize(way), first.spread * edge / most_pixels),
          rays.front().end });
    }
  }
  return rays;
}

/// The same scene with another fog, and no volumes to copy.
Scene with_fog(const Scene& scene, const Fog& fog)
{
  Scene other;
  other.lights = scene.lights;
  other.sky = scene.sky;
  other.fog = fog;
  return other;
}

glm::dvec3 finite(const glm::dvec3& v)
{
  glm::dvec3 result;
  for (int c = 0; c < 3; ++c)
  {
    result[c] = std::isnan(v[c]) ? std::numeric_limits<double>::infinity() : v[c];
  }
  return result;
}

}

FogFigures look_at_fog(const Scene& scene)
{
  FogFigures figures;
  const FogModel fog(scene);
  if (!fog.visible())
  {
    return figures;
  }
  figures.any = true;
  Fog even = scene.fog;
  even.lobes.clear();
  const FogModel isotropic(with_fog(scene, even));
  Fog grey = scene.fog;
  const double mean = (grey.extinction.x + grey.extinction.y + grey.extinction.z) / 3.0;
  grey.extinction = glm::dvec3(mean);
  const bool coloured = grey.extinction != scene.fog.extinction;
  const FogModel without_colour(with_fog(scene, grey));

  const auto include = [](glm::dvec3& most, const glm::dvec3& v)
  { most = glm::max(most, finite(v) * between_rays); };
  glm::dvec3 passes(1.0);
  for (const auto& [ray, end] : rays_of(scene, fog))
  {
    const glm::dvec3 through = fog.transmittance(ray, 0.0, end);
    passes = glm::min(passes, through);
    include(figures.opacity, 1.0 - through);
    glm::dvec3 lit(0.0);
    glm::dvec3 deviation(0.0);
    glm::dvec3 grey_lit(0.0);
    for (std::size_t l = 0; l < scene.lights.size(); ++l)
    {
      const glm::dvec3 here = fog.lit_by(l, ray, 0.0, end);
      const glm::dvec3 isotropically = isotropic.lit_by(l, ray, 0.0, end);
      lit += here;
      // Of a light at infinity the angle is the same all along.
      deviation +=
        scene.lights[l].positional ? here + isotropically : glm::abs(here - isotropically);
      if (coloured)
      {
        grey_lit += without_colour.lit_by(l, ray, 0.0, end);
      }
    }
    const glm::dvec3 ambient = fog.ambient(ray, 0.0, end);
    include(figures.lit, lit);
    include(figures.ambient, ambient);
    include(figures.radiance, lit + ambient);
    include(figures.deviation, scene.fog.lobes.empty() ? glm::dvec3(0.0) : deviation);
    if (coloured)
    {
      const double column = fog.column(ray, 0.0, end);
      glm::dvec3 dims;
      for (int c = 0; c < 3; ++c)
      {
        dims[c] = largest_difference(scene.fog.extinction[c], mean, column);
      }
      include(figures.grey_dims, dims);
      include(figures.grey_change,
        dims + lit + ambient + grey_lit + without_colour.ambient(ray, 0.0, end));
    }
  }
  figures.opacity = glm::min(figures.opacity, glm::dvec3(1.0));
  figures.grey_dims = glm::min(figures.grey_dims, glm::dvec3(1.0));

  glm::dvec3 arrives(1.0);
  for (const glm::dvec3& corner : corners_of_volumes(scene, scene.volumes.size()))
  {
    for (std::size_t l = 0; l < scene.lights.size(); ++l)
    {
      arrives = glm::min(arrives, fog.light_transmittance(l, corner));
    }
    // Of light from the ground nothing arrives where the fog has no end below.
    const bool dark = scene.fog.falloff > 0.0 && scene.sky.ground != glm::dvec3(0.0);
    arrives = glm::min(arrives, dark ? glm::dvec3(0.0) : fog.sky_transmittance(corner));
  }
  figures.takes = 1.0 - passes * arrives;
  return figures;
}

glm::dvec3 change_in_fog(Effect effect, const FogFigures& fog, const EffectSet& on)
{
  const glm::dvec3 none(0.0);
  if (!fog.any || !on.has(Effect::Fog))
  {
    return none;
  }
  const bool scatters = on.has(Effect::Scattering);
  const glm::dvec3 lit = scatters ? fog.lit : none;
  const glm::dvec3 ambient = scatters && on.has(Effect::Ambient) ? fog.ambient : none;
  // Without lobes the light may be more than with them.
  const glm::dvec3 more = scatters && !on.has(Effect::PhaseAnisotropy) ? fog.deviation : none;
  switch (effect)
  {
    case Effect::Scattering:
      return lit + ambient + more;
    case Effect::PhaseAnisotropy:
      return scatters ? fog.deviation : none;
    case Effect::ColouredExtinction:
      return scatters ? fog.grey_change + 2.0 * more : fog.grey_dims;
    case Effect::Ambient:
      return ambient;
    case Effect::Fog:
    case Effect::Surfaces:
      return fog.opacity + lit + ambient + more;
    default:
      return none;
  }
}

}
