// What lit matter sends besides a sun's single scattering, in a slab: quadratures of the model as
// docs/theory/light.md has it, written anew.
#include "../support/slab_scenes.h"

#include "Transport/black_body.h"

#include <boost/math/special_functions/expint.hpp>
#include <glm/matrix.hpp>

#include <iostream>

using namespace slab_scenes;

namespace
{

constexpr int edge = 4;

double e2(double x)
{
  return boost::math::expint(2u, x);
}

/// Radiance of a slab of optical depth `depth` whose matter sends send(z) per unit of length at the
/// height z, isotropically, along a ray.
template <class Send>
double slab_radiance(double depth, const glm::dvec3& direction, const Send& send)
{
  const double mu = std::abs(direction.z);
  return integral([&](double z)
    { return send(z) * std::exp(-depth * (direction.z < 0.0 ? 1.0 - z : z) / mu) / mu; },
    0.0,
    1.0);
}

/// The largest error of the slab's pictures from above and from below, against send(z, channel,
/// direction). Every picture is brighter than nothing.
template <class Send>
double worst_of(const Draw& draw, Slab& slab, const glm::dvec3& depth, const Send& send)
{
  double worst = 0.0;
  for (const double zenith : { 25.0, 120.0 })
  {
    const View view = slab.look(zenith, 1.0);
    slab.scene.camera = view.camera(1.0);
    const Film film = draw(slab.scene, edge, edge);
    worst = std::max(worst,
      worst_error(film,
        [&](int x, int y)
        {
          const glm::dvec3 direction = world_ray(view, x, y, edge, edge).direction;
          Truth truth;
          for (int c = 0; c < 3; ++c)
          {
            truth.transmittance[c] = std::exp(-depth[c] / std::abs(direction.z));
            truth.radiance[c] =
              slab_radiance(depth[c], direction, [&](double z) { return send(z, c, direction); });
          }
          return truth;
        }));
    EXPECT_GT(*std::max_element(film.radiance[0].begin(), film.radiance[0].end()), 1e-6f);
  }
  return worst;
}

const Draw reference = by_reference(1e-11);
const Draw by_rays = by_marcher(ShadowMethod::Rays, 0.02);
/// With ten nodes in the slab's height.
const Draw by_volume = by_marcher(ShadowMethod::Volume, 0.02, 0.1);
const Draw by_functions = by_marcher(ShadowMethod::Functions, 0.02, 0.1);

/// The errors that are accepted of each; 0 for what is not drawn.
struct Bounds
{
  double of_reference;
  double of_rays;
  double of_volume;
  double of_functions;
};

template <class Send>
void expect_close(Slab& slab, const glm::dvec3& depth, const Send& send, const Bounds& bounds)
{
  const auto look = [&](const char* name, const Draw& draw, double bound)
  {
    if (bound > 0.0)
    {
      const double error = worst_of(draw, slab, depth, send);
      EXPECT_LE(error, bound) << name;
      std::cout << "  " << name << ": " << error << "\n";
    }
  };
  look("reference", reference, bounds.of_reference);
  look("shadow rays", by_rays, bounds.of_rays);
  look("light volume", by_volume, bounds.of_volume);
  look("shadow functions", by_functions, bounds.of_functions);
}

const double mu0 = std::cos(sun_zenith * pi / 180.0);

double sun_irradiance(double depth, double z, int c)
{
  return pi * sun_diffuse[c] * std::exp(-depth * (1.0 - z) / mu0);
}

double cosine(const Slab& slab, const glm::dvec3& direction)
{
  return -glm::dot(slab.scene.lights[0].direction, direction);
}

}

TEST(LitMedia, SkyAndGround)
{
  for (const double side : { 1.0, -1.0 })
  {
    Slab slab = slab_under_sky(side);
    const glm::dvec3 above = side > 0.0 ? slab.scene.sky.radiance : slab.scene.sky.ground;
    const glm::dvec3 below = side > 0.0 ? slab.scene.sky.ground : slab.scene.sky.radiance;
    expect_close(slab,
      depths,
      [&](double z, int c, const glm::dvec3&)
      {
        return slab.medium().albedo[c] * depths[c] * 0.5 *
               (above[c] * e2(depths[c] * (1.0 - z)) + below[c] * e2(depths[c] * z));
      },
      { 1e-6, 0.0, 0.003, 0.0 });
  }
}

// A white sky over black ground and none besides: where matter is thin all of it is seen.
TEST(LitMedia, ThinMatterScattersHalfOfASky)
{
  Slab slab = thin_slab_under_sky();
  expect_close(slab,
    glm::dvec3(1e-5),
    [](double, int, const glm::dvec3&) { return 0.5e-5; },
    { 2e-4, 2e-4, 2e-4, 0.0 }); // E₂ falls steeply from 1
}

TEST(LitMedia, Octaves)
{
  Slab slab = slab_of_octaves();
  expect_close(slab,
    depths,
    [&](double z, int c, const glm::dvec3& direction)
    {
      double sum = 0.0;
      for (int m = 0; m < 5; ++m)
      {
        sum += std::pow(0.45, m) * sun_irradiance(std::pow(0.6, m) * depths[c], z, c) *
               phase(slab.medium(), cosine(slab, direction), std::pow(0.7, m));
      }
      return slab.medium().albedo[c] * depths[c] * sum;
    },
    { 1e-6, 1e-5, 0.015, 0.04 });
}

TEST(LitMedia, SilverLining)
{
  Slab slab = slab_with_silver_lining();
  expect_close(slab,
    depths,
    [&](double z, int c, const glm::dvec3& direction)
    {
      const double mu = cosine(slab, direction);
      const double lining =
        0.7 * (0.75 * henyey_greenstein(0.85, mu) + 0.25 * henyey_greenstein(-0.85, mu));
      return depths[c] * (sun_irradiance(depths[c], z, c) * (0.25 / pi + lining) +
                           0.5 * sun_irradiance(0.5 * depths[c], z, c) * 0.25 / pi);
    },
    { 1e-6, 1e-5, 0.015, 0.05 });
}

TEST(LitMedia, Powder)
{
  const auto remap = [](double x, double a, double b, double from, double to)
  { return from + (to - from) * std::min(std::max((x - a) / (b - a), 0.0), 1.0); };
  for (const Powder::Form form : { Powder::Form::Exponential, Powder::Form::Height })
  {
    Slab slab = slab_of_powder(form);
    const double d = 1.5 * 0.5;
    expect_close(slab,
      depths,
      [&](double z, int c, const glm::dvec3&)
      {
        const double factor = form == Powder::Form::Exponential
                                ? 1.0 - 0.8 * std::exp(-2.0 * d)
                                : 1.0 - 0.8 * std::pow(d, remap(z, 0.3, 0.9, 0.5, 1.0)) *
                                          std::pow(remap(z, 0.0, 0.3, 0.8, 1.0), 0.8);
        return 0.15 +
               factor * depths[c] *
                 (0.25 / pi * sun_irradiance(depths[c], z, c) + 0.5 * e2(depths[c] * (1.0 - z)));
      },
      { form == Powder::Form::Exponential ? 1e-6 : 1e-5, 0.0, 0.04, 0.0 }); // kinks at 0.3 and 0.9
  }
}

TEST(LitMedia, EmissionAndBlackBody)
{
  WarmSlab slab;
  const Medium& medium = slab.medium();
  expect_close(slab,
    depths,
    [&](double z, int c, const glm::dvec3&)
    {
      const double kelvin = 800.0 + 800.0 * z;
      return 0.5 * (medium.emission[c] + 3.0 * black_body_radiance(kelvin, 1200.0)[c]);
    },
    { 1e-6, 2e-3, 0.0, 0.0 });
}

// Matter that glows and takes nothing: length times emission.
TEST(LitMedia, ThereIsEmissionWithoutExtinction)
{
  Slab slab = glowing_slab_without_extinction();
  expect_close(slab,
    glm::dvec3(0.0),
    [&](double, int c, const glm::dvec3&) { return 0.5 * slab.medium().emission[c]; },
    { 1e-6, 1e-6, 0.0, 0.0 });
}

TEST(LitMedia, ClassifiedMatterHasItsColourForAlbedo)
{
  ClassifiedSlab slab = glowing_classified_slab();
  const double sigma = ClassifiedSlab::sigma;
  const double w = 0.75;
  const double factor = 1.0 - 0.5 * std::exp(-4.0 * -std::expm1(-w * sigma * 0.1));
  expect_close(slab,
    glm::dvec3(w * sigma),
    [&](double z, int c, const glm::dvec3&)
    {
      return w * sigma * ClassifiedSlab::colour(z)[c] *
             (slab.medium().albedo[c] * factor * 0.25 / pi * sun_irradiance(w * sigma, z, c) +
               slab.medium().emission[c]);
    },
    { 1e-6, 2e-4, 3e-3, 5e-3 });
}

TEST(LitMedia, ShadedMatterIsShadowed)
{
  ClassifiedSlab slab = shaded_slab();
  const double sigma = ClassifiedSlab::sigma;
  const Shading& shading = slab.scene.volumes[0].shading;
  expect_close(slab,
    glm::dvec3(sigma),
    [&](double z, int c, const glm::dvec3& direction)
    {
      const glm::dvec3 normal(0.0, 0.0, direction.z < 0.0 ? 1.0 : -1.0);
      const glm::dvec3 to_light = -slab.scene.lights[0].direction;
      const glm::dvec3 half = glm::normalize(to_light - direction);
      const double facing = glm::dot(normal, to_light);
      const double colour = slab.medium().albedo[c] * ClassifiedSlab::colour(z)[c];
      const double passes = std::exp(-sigma * (1.0 - z) / mu0);
      double source = colour * (shading.ambient * shading.ambient_light[c] +
                                 0.5 * slab.scene.sky.radiance[c] * e2(sigma * (1.0 - z)));
      if (facing > 0.0)
      {
        source +=
          passes * (colour * shading.diffuse * sun_diffuse[c] * facing +
                     shading.specular * slab.scene.lights[0].specular[c] *
                       std::pow(std::max(glm::dot(normal, half), 0.0), shading.specular_power));
      }
      return sigma * source;
    },
    { 1e-6, 0.0, 0.01, 0.0 });
}

// Two densities in one place: extinctions and light add up, or are mixed as components are.
TEST(LitMedia, Mixtures)
{
  for (const Mixture mixture : { Mixture::Sum, Mixture::Components })
  {
    const glm::dvec3 first(0.4, 1.0, 0.2);
    const glm::dvec3 second(1.5, 0.3, 0.3);
    Slab slab = mixed_slab(first, second, mixture);
    const bool sum_up = mixture == Mixture::Sum;
    const glm::dvec3 sum = first + second;
    const glm::dvec3 depth = sum_up ? sum : (first * first + second * second) / sum;
    expect_close(slab,
      depth,
      [&](double z, int c, const glm::dvec3& direction)
      {
        return sun_irradiance(depth[c], z, c) *
               (slab.medium().albedo[c] * first[c] * 0.25 / pi +
                 second[c] * henyey_greenstein(0.5, cosine(slab, direction)));
      },
      { 1e-6, 1e-5, 0.015, 0.0 });
  }
}

// Coloured extinction needs no light.
TEST(LitMedia, ColouredExtinctionOfUnlitMatter)
{
  Slab slab = unlit_slab();
  const View view = slab.look(30.0, 1.0);
  slab.scene.camera = view.camera(1.0);
  const auto truth_of = [&](int x, int y)
  {
    const glm::dvec3 direction = world_ray(view, x, y, edge, edge).direction;
    return Truth{ glm::dvec3(0.0), glm::exp(-depths / std::abs(direction.z)) };
  };
  EXPECT_LE(worst_error(reference(slab.scene, edge, edge), truth_of), 1e-7);
  EXPECT_LE(worst_error(by_rays(slab.scene, edge, edge), truth_of), 1e-6);
}

// A prop that is scaled unevenly: lengths are the data's, angles the world's.
TEST(LitMedia, PlacesAreTheDatasAndAnglesTheWorlds)
{
  const glm::dvec3 scale(3.0, 0.5, 2.0);
  Slab slab = scaled_slab(scale);
  const glm::dvec3 sun = glm::normalize(slab.scene.lights[0].direction / scale);
  View view = slab.look(30.0, 1.0);
  view.centre.z = 1.0;
  slab.scene.camera = view.camera(1.0);
  const auto truth_of = [&](int x, int y)
  {
    const glm::dvec3 direction = world_ray(view, x, y, edge, edge).direction;
    const glm::dvec3 in_data = glm::normalize(direction / scale);
    Truth truth;
    for (int c = 0; c < 3; ++c)
    {
      truth.transmittance[c] = std::exp(-depths[c] / std::abs(in_data.z));
      truth.radiance[c] = slab_radiance(depths[c],
        in_data,
        [&](double z)
        {
          return depths[c] * henyey_greenstein(0.6, cosine(slab, direction)) * pi * sun_diffuse[c] *
                 std::exp(-depths[c] * (1.0 - z) / std::abs(sun.z));
        });
    }
    return truth;
  };
  EXPECT_LE(worst_error(reference(slab.scene, edge, edge), truth_of), 1e-6);
  EXPECT_LE(worst_error(by_rays(slab.scene, edge, edge), truth_of), 1e-5);
  EXPECT_LE(worst_error(by_volume(slab.scene, edge, edge), truth_of), 0.05);
}

// What is not drawn casts no shadow: cropping, a clipping plane and a mask that hide the slab's
// upper part.
TEST(LitMedia, HiddenPartsCastNoShadow)
{
  for (const std::string way : { "cropping", "clipping plane", "mask" })
  {
    HalfHiddenSlab slab(way);
    const double sigma = ClassifiedSlab::sigma;
    expect_close(slab,
      glm::dvec3(0.625 * sigma),
      [&](double z, int c, const glm::dvec3&)
      {
        return 0.625 * sigma * ClassifiedSlab::colour(0.625 * z)[c] * 0.25 / pi *
               sun_irradiance(0.625 * sigma, z, c);
      },
      { 1e-6, way == "mask" ? 0.07 : 1e-3, 0.0, 0.0 });
  }
}

// One octave is single scattering, and what is switched off is not there, to the bit.
TEST(LitMedia, WhatIsOffChangesNoBit)
{
  const View view = Slab(depths).look(30.0, 1.0);
  std::vector<Film> films;
  std::vector<Film> marched;
  for (const bool other : { false, true })
  {
    Slab slab = slab_with_all_off(other);
    slab.scene.camera = view.camera(1.0);
    films.push_back(reference(slab.scene, edge, edge));
    marched.push_back(by_rays(slab.scene, edge, edge));
  }
  EXPECT_TRUE(same_bits(films[0], films[1]));
  EXPECT_TRUE(same_bits(marched[0], marched[1]));
}
