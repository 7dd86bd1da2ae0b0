// Single scattering of a sun in a homogeneous slab against Chandrasekhar's closed forms (Radiative
// Transfer, 1960, section 7): reflected and transmitted, at many angles of sun and view, per
// channel.
#include "../support/slab_scenes.h"

#include <iostream>

using namespace slab_scenes;

namespace
{

constexpr int edge = 5;

/// Radiance of a slab of optical depth `depth` that a sun at µ₀ = cos zenith lights from above.
/// `scatters`: albedo · irradiance · phase function. Rays run along `direction`.
double single_scattering(double depth, double mu0, const glm::dvec3& direction, double scatters)
{
  const double mu = std::abs(direction.z);
  if (direction.z < 0.0) // seen from above: reflected
  {
    return scatters * mu0 / (mu0 + mu) * -std::expm1(-depth * (1.0 / mu0 + 1.0 / mu));
  }
  const double difference = 1.0 / mu - 1.0 / mu0;
  if (std::abs(difference) * depth < 1e-7)
  {
    return scatters * depth / mu * std::exp(-depth / mu);
  }
  // e^(−τ/µ₀) − e^(−τ/µ) over 1/µ − 1/µ₀, kept from cancelling.
  return scatters / mu * std::exp(-depth / mu0) * -std::expm1(-depth * difference) / difference;
}

/// Of a slab made of the case, under one sun.
Truth truth_of(const Slab& slab, const Case& c, const View& view, int x, int y)
{
  const Light& sun = slab.scene.lights[0];
  const glm::dvec3 direction = world_ray(view, x, y, edge, edge).direction;
  const double p = phase(slab.scene.volumes[0].medium, -glm::dot(sun.direction, direction));
  Truth truth;
  for (int k = 0; k < 3; ++k)
  {
    truth.transmittance[k] = std::exp(-c.depth[k] / std::abs(direction.z));
    truth.radiance[k] = single_scattering(
      c.depth[k], -sun.direction.z, direction, c.albedo[k] * pi * sun.diffuse[k] * p);
  }
  return truth;
}

/// Draws every case at every angle; the largest error of any.
double worst_of_all(const Draw& draw, const std::vector<Case>& some, const glm::dvec3& diffuse)
{
  double worst = 0.0;
  for (const Case& c : some)
  {
    for (const double sun : suns_of_cases)
    {
      Slab slab = slab_of(c, sun, diffuse);
      for (const double zenith : views_of_cases)
      {
        const View view = slab.look(zenith);
        slab.scene.camera = view.camera(1.0);
        const Film film = draw(slab.scene, edge, edge);
        const double error =
          worst_error(film, [&](int x, int y) { return truth_of(slab, c, view, x, y); });
        if (!(error <= worst))
        {
          worst = error;
          std::cout << c.name << ", sun " << sun << ", view " << zenith << ": " << error << "\n";
        }
      }
    }
  }
  return worst;
}

}

TEST(SingleScattering, ReferenceOfASlab)
{
  EXPECT_LE(worst_of_all(by_reference(1e-13), cases, { 1.0, 0.8, 3.0 }), 1e-6);
}

// Within 1e-5, whatever the step: the light of a step is integrated in closed form.
TEST(SingleScattering, ShadowRaysOfASlab)
{
  for (const double step : { 0.25, 0.05, 0.01 })
  {
    EXPECT_LE(worst_of_all(by_marcher(ShadowMethod::Rays, step), cases, { 1.0, 0.8, 3.0 }), 1e-5)
      << step;
  }
}

// The steps and shadows that are chosen for a tolerance, a fraction of white or of the brightest.
TEST(SingleScattering, TolerancesOfASlab)
{
  Slab slab = slab_of(cases[1], 35.0, { 1.0, 0.8, 3.0 }, 64.0);
  const View view = slab.look(40.0, 1.0);
  slab.scene.camera = view.camera(1.0);
  for (const double tolerance : { 1e-3, 1e-5 })
  {
    const double error = worst_error(
      by_tolerance(tolerance)(slab.scene, edge, edge),
      [&](int x, int y) { return truth_of(slab, cases[1], view, x, y); },
      1.0);
    EXPECT_LE(error, tolerance);
    std::cout << "tolerance " << tolerance << ": " << error << "\n";
  }
}

// The same slab under two suns is the sum of both.
TEST(SingleScattering, LightsAddUp)
{
  const View view = Slab(glm::dvec3(1.0)).look(30.0);
  std::vector<Film> films;
  for (const int which : { 1, 2, 3 })
  {
    Slab slab = slab_under_two_suns(which);
    slab.scene.camera = view.camera(1.0);
    films.push_back(by_reference(1e-7)(slab.scene, edge, edge));
  }
  for (int c = 0; c < 3; ++c)
  {
    for (std::size_t i = 0; i < films[0].size(); ++i)
    {
      EXPECT_NEAR(films[2].radiance[c][i], films[0].radiance[c][i] + films[1].radiance[c][i], 1e-6);
      EXPECT_EQ(films[2].transmittance[c][i], films[0].transmittance[c][i]);
    }
  }
}
