// Scenes of lit media whose pictures are known: phase functions and light written anew, slabs, and
// how pictures are held against formulas.
#pragma once

#include "transport_scenes.h"

#include "Transport/reference.h"
#include "Transport/step_control.h"

#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <boost/math/tools/roots.hpp>
#include <gtest/gtest.h>

#include <functional>
#include <vector>

namespace lit_scenes
{

using namespace transport_scenes;

constexpr double pi = 3.14159265358979323846;

/// ∫ f over [a, b], adaptive, to a relative 1e-11.
template <class F>
double integral(const F& f, double a, double b)
{
  return a < b ? boost::math::quadrature::gauss_kronrod<double, 31>::integrate(f, a, b, 12, 1e-11)
               : 0.0;
}

// Phase functions of the cosine between directions of travel, as books have them.

inline double henyey_greenstein(double g, double cosine)
{
  return (1.0 - g * g) / (4.0 * pi) / std::pow(1.0 + g * g - 2.0 * g * cosine, 1.5);
}

inline double rayleigh(double cosine)
{
  return 3.0 / (16.0 * pi) * (1.0 + cosine * cosine);
}

inline double schlick_of_k(double k, double cosine)
{
  return (1.0 - k * k) / (4.0 * pi) / std::pow(1.0 - k * cosine, 2.0);
}

/// With the k whose mean cosine is g.
inline double schlick(double g, double cosine)
{
  const auto mean_minus_g = [g](double k) {
    return integral([k](double mu) { return 2.0 * pi * mu * schlick_of_k(k, mu); }, -1.0, 1.0) - g;
  };
  const auto k = boost::math::tools::bisect(
    mean_minus_g, -0.99999, 0.99999, boost::math::tools::eps_tolerance<double>(48));
  return schlick_of_k(0.5 * (k.first + k.second), cosine);
}

/// Of a medium's lobes, whose anisotropies are multiplied with `factor`.
inline double phase(const Medium& medium, double cosine, double factor = 1.0)
{
  if (medium.lobes.empty())
  {
    return 1.0 / (4.0 * pi);
  }
  double sum = 0.0;
  double weights = 0.0;
  for (const PhaseLobe& lobe : medium.lobes)
  {
    const double g = lobe.anisotropy * factor;
    weights += lobe.weight;
    switch (lobe.function)
    {
      case PhaseFunction::Isotropic:
        sum += lobe.weight / (4.0 * pi);
        break;
      case PhaseFunction::Rayleigh:
        sum += lobe.weight * rayleigh(cosine);
        break;
      case PhaseFunction::HenyeyGreenstein:
        sum += lobe.weight * henyey_greenstein(g, cosine);
        break;
      case PhaseFunction::Schlick:
        sum += lobe.weight * schlick(g, cosine);
        break;
    }
  }
  return sum / weights;
}

/// A homogeneous slab, 0 ≤ z ≤ 1, that has to be so wide that nothing of its sides is seen.
struct Slab
{
  Voxels<float> voxels{ 3, 3, 5, [](int, int, int) { return 0.5f; } };
  Scene scene;

  /// `depth`: its optical depth straight through.
  explicit Slab(const glm::dvec3& depth, double width = 256.0)
  {
    Volume& volume = scene.volumes[0];
    volume.grid = voxels.grid();
    volume.data_from_index = placed(
      glm::dvec3(0.5 * width, 0.5 * width, 0.25), glm::dvec3(-0.5 * width, -0.5 * width, 0.0));
    volume.meaning = ValueMeaning::Density;
    const double most = std::max({ depth.x, depth.y, depth.z });
    volume.density.extinction = 2.0 * most;
    volume.density.channels = depth / most;
    volume.medium.lit = true;
  }

  Medium& medium() { return scene.volumes[0].medium; }

  /// A sun that stands so many degrees from the zenith.
  void add_sun(double zenith, double azimuth, const glm::dvec3& diffuse)
  {
    const double degree = pi / 180.0;
    Light sun;
    sun.diffuse = diffuse;
    sun.direction = -glm::dvec3(std::sin(zenith * degree) * std::cos(azimuth * degree),
      std::sin(zenith * degree) * std::sin(azimuth * degree),
      std::cos(zenith * degree));
    scene.lights.push_back(sun);
  }

  /// Looks at its middle, from so many degrees from the zenith (more than 90: from below).
  View look(double zenith, double half_height = 4.0) const
  {
    View view;
    view.centre = glm::dvec3(0.0, 0.0, 0.5);
    view.forward = -glm::dvec3(std::sin(zenith * pi / 180.0), 0.0, std::cos(zenith * pi / 180.0));
    view.up = glm::dvec3(0.0, 1.0, 0.0);
    view.distance = 12.0;
    view.half_height = half_height;
    view.near_plane = 0.1;
    view.far_plane = 200.0;
    return view;
  }
};

/// n³ voxels of 1 inside a ball of `radius` voxels, and a soft edge of one voxel.
struct LitBall
{
  int n;
  double radius;
  Voxels<float> voxels;
  Scene scene;
  View view;

  LitBall(int size, double the_radius, double extinction)
    : n(size)
    , radius(the_radius)
    , voxels(size,
        size,
        size,
        [=](int i, int j, int k)
        {
          const glm::dvec3 p = glm::dvec3(i, j, k) - 0.5 * (size - 1);
          return static_cast<float>(std::clamp(the_radius + 0.5 - glm::length(p), 0.0, 1.0));
        })
  {
    Volume& volume = scene.volumes[0];
    volume.grid = voxels.grid();
    volume.data_from_index = placed(glm::dvec3(1.0), glm::dvec3(-0.5 * (n - 1)));
    volume.meaning = ValueMeaning::Density;
    volume.density.extinction = extinction;
    volume.medium.lit = true;
    volume.medium.lobes = { { PhaseFunction::HenyeyGreenstein, 1.0, 0.3 } };
    Light sun;
    sun.direction = glm::normalize(glm::dvec3(-0.6, 0.35, -0.7));
    scene.lights = { sun };
    view = view_of(scene, glm::dvec3(0.3, 0.5, -1.0), false);
    view.half_height *= 0.62;
    scene.camera = view.camera(1.0);
  }
};

/// The unit vector along a pixel's ray, and the ray's begin, relative to nothing (the world's).
struct WorldRay
{
  glm::dvec3 begin;
  glm::dvec3 direction;
};
inline WorldRay world_ray(const View& view, int x, int y, int width, int height)
{
  long double from[3], to[3];
  view.ray(x, y, width, height, from, to);
  const glm::dvec3 a(from[0], from[1], from[2]);
  const glm::dvec3 b(to[0], to[1], to[2]);
  return { view.centre + a, glm::normalize(b - a) };
}

/// How a scene is drawn.
using Draw = std::function<Film(const Scene& scene, int width, int height)>;

/// The reference's picture; `tolerance` as a fraction of white.
inline Draw by_reference(double tolerance, int most_pieces = 64)
{
  return [=](const Scene& scene, int width, int height)
  {
    Film film(width, height);
    ReferenceSettings settings;
    settings.tolerance = tolerance;
    settings.most_pieces = most_pieces;
    EXPECT_TRUE(render_reference(scene, settings, film).completed);
    return film;
  };
}

/// The marcher's picture with steps of `step`. Shadow rays go cell by cell where they can, unless
/// `shadow_step` tells otherwise.
inline Draw by_marcher(ShadowMethod shadows, double step, double shadow_step = 0.0)
{
  return [=](const Scene& scene, int width, int height)
  {
    Film film(width, height);
    MarchSettings settings;
    settings.step = step;
    settings.leave_error = 0.0;
    settings.shadows = shadows;
    settings.shadow_step = shadow_step;
    settings.precise_shadows = true;
    Marcher marcher;
    const MarchStatistics statistics = marcher.render(scene, settings, film);
    if (!scene.lights.empty() && scene.volumes[0].medium.lit)
    {
      EXPECT_EQ(statistics.shadows, shadows);
    }
    return film;
  };
}

/// The marcher's picture with the shadows and the steps that it chooses itself for a tolerance.
inline Draw by_tolerance(double tolerance)
{
  return [=](const Scene& scene, int width, int height)
  {
    Film film(width, height);
    Marcher marcher;
    const ShadowChoice shadows = choose_shadows(marcher, scene, tolerance);
    MarchSettings settings;
    settings.leave_error = 0.25 * tolerance;
    settings.shadows = shadows.method;
    settings.shadow_step = shadows.step;
    settings.precise_shadows = shadows.precise;
    const StepChoice steps = choose_step(marcher, scene, tolerance, 0, settings);
    settings.rule = steps.rule;
    settings.step = steps.step;
    settings.refinements = steps.refinements;
    settings.refine_error = steps.refine_error;
    marcher.render(scene, settings, film);
    return film;
  };
}

/// What a pixel has to be.
struct Truth
{
  glm::dvec3 radiance;
  glm::dvec3 transmittance;
};

/// The largest error of a picture, of radiances by the brightest of the picture (by channel) or
/// `least_white`, of transmittances by 1. truth(x, y).
template <class TruthOf>
double worst_error(const Film& film, const TruthOf& truth_of, double least_white = 1e-30)
{
  double worst = 0.0;
  for (int c = 0; c < 3; ++c)
  {
    double brightest = least_white;
    double most = 0.0;
    for (int y = 0; y < film.height; ++y)
    {
      for (int x = 0; x < film.width; ++x)
      {
        const Truth truth = truth_of(x, y);
        const std::size_t pixel = static_cast<std::size_t>(y) * film.width + x;
        brightest = std::max(brightest, truth.radiance[c]);
        const double off = std::abs(film.radiance[c][pixel] - truth.radiance[c]);
        most = off <= most ? most : off; // a NaN wins
        const double passes = std::abs(film.transmittance[c][pixel] - truth.transmittance[c]);
        worst = passes <= worst ? worst : passes;
      }
    }
    worst = most / brightest <= worst ? worst : most / brightest;
  }
  return worst;
}

/// The largest relative error of any pixel's radiance.
template <class TruthOf>
double worst_relative_error(const Film& film, const TruthOf& truth_of)
{
  double worst = 0.0;
  for (int y = 0; y < film.height; ++y)
  {
    for (int x = 0; x < film.width; ++x)
    {
      const Truth truth = truth_of(x, y);
      const std::size_t pixel = static_cast<std::size_t>(y) * film.width + x;
      for (int c = 0; c < 3; ++c)
      {
        const double off = std::abs(film.radiance[c][pixel] - truth.radiance[c]) /
                           std::max(truth.radiance[c], 1e-30);
        worst = off <= worst ? worst : off;
      }
    }
  }
  return worst;
}

}
