// Single scattering of a sun in a homogeneous slab against Chandrasekhar's closed forms (Radiative
// Transfer, 1960, section 7): reflected and transmitted, at many angles of sun and view, per
// channel.
#include "../support/lit_scenes.h"

#include <iostream>

using namespace lit_scenes;

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

struct Case
{
  const char* name;
  glm::dvec3 depth;
  glm::dvec3 albedo;
  std::vector<PhaseLobe> lobes;
};

const std::vector<Case> cases = {
  { "thin, isotropic", glm::dvec3(0.05), glm::dvec3(1.0), {} },
  { "coloured, forward",
    { 0.3, 1.0, 2.5 },
    { 0.9, 0.5, 1.0 },
    { { PhaseFunction::HenyeyGreenstein, 1.0, 0.7 } } },
  { "thick, backward",
    glm::dvec3(12.0),
    { 1.0, 0.99, 0.2 },
    { { PhaseFunction::HenyeyGreenstein, 1.0, -0.5 } } },
  { "air", { 0.05, 0.12, 0.3 }, glm::dvec3(1.0), { { PhaseFunction::Rayleigh, 1.0, 0.0 } } },
  { "Schlick and a mixture",
    { 1.0, 1.0, 0.5 },
    glm::dvec3(0.8),
    { { PhaseFunction::Schlick, 2.0, 0.6 },
      { PhaseFunction::HenyeyGreenstein, 1.0, -0.3 },
      { PhaseFunction::Isotropic, 0.5, 0.0 } } },
};

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
    for (const double sun : { 0.0, 35.0, 60.0, 78.0 })
    {
      Slab slab(c.depth);
      slab.medium().albedo = c.albedo;
      slab.medium().lobes = c.lobes;
      slab.add_sun(sun, 130.0, diffuse);
      for (const double zenith : { 0.0, 40.0, 65.0, 115.0, 145.0 })
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
  Slab slab(cases[1].depth, 64.0);
  slab.medium().albedo = cases[1].albedo;
  slab.medium().lobes = cases[1].lobes;
  slab.add_sun(35.0, 130.0, { 1.0, 0.8, 3.0 });
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
    Slab slab(glm::dvec3(1.0, 0.7, 0.4));
    if (which & 1)
    {
      slab.add_sun(20.0, 0.0, { 1.0, 0.0, 0.5 });
    }
    if (which & 2)
    {
      slab.add_sun(70.0, 200.0, { 0.2, 2.0, 0.5 });
    }
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
