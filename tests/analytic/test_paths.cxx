// Light that is scattered any number of times: published results of transport theory, and what must
// hold whatever the medium.
#include "../support/path_truth.h"

#include "Transport/path_tracer.h"

#include <iostream>

using namespace path_truth;

namespace
{

Film trace(const Scene& scene, int edge, int samples, int scatterings = 0, std::uint32_t seed = 1,
  PathStatistics* statistics = nullptr)
{
  Film film(edge, edge);
  PathTracer tracer;
  PathSettings settings;
  settings.samples_per_pixel = std::max(static_cast<int>(std::lround(effort() * samples)), 1);
  settings.most_scatterings = scatterings;
  settings.seed = seed;
  const PathStatistics s = tracer.render(scene, settings, film);
  EXPECT_TRUE(s.completed);
  if (statistics)
  {
    *statistics = s;
  }
  return film;
}

/// A view of parallel rays along one direction from `zenith` degrees, all but at one place.
View narrow(const Slab& slab, double zenith)
{
  View view = slab.look(zenith, 1e-3);
  view.centre += glm::dvec3(1234.5, 777.7, 0.0);
  view.parallel = true;
  return view;
}

}

// By reciprocity, a ray into the slab meets the upper sky with the slab's total reflectance for light
// along it, and the ground with its total transmittance but for what passes unscattered.
TEST(PathTracing, SlabReflectsAndTransmitsAsPublished)
{
  Slab slab(glm::dvec3(2.0), 1e5);
  slab.medium().albedo = glm::dvec3(0.9);
  slab.medium().lobes = { { PhaseFunction::HenyeyGreenstein, 1.0, 0.75 } };
  slab.scene.sky.radiance = glm::dvec3(1.0, 0.0, 1.0);
  slab.scene.sky.ground = glm::dvec3(0.0, 1.0, 1.0);
  slab.scene.camera = narrow(slab, 0.0).camera(1.0);
  const Mean mean = mean_of(trace(slab.scene, 64, 1600));
  // H. C. van de Hulst, Multiple Light Scattering, 1980, as quoted by L. Wang, S. L. Jacques, L. Zheng,
  // MCML, Computer Methods and Programs in Biomedicine 47, 1995.
  const double reflectance = 0.09739;
  const double transmittance = 0.66096 - std::exp(-2.0);
  std::cout << "reflectance " << mean.value.x << " +- " << mean.error.x << ", transmittance "
            << mean.value.y + std::exp(-2.0) << " +- " << mean.error.y << '\n';
  const double fewer = 1.0 / std::sqrt(effort());
  EXPECT_LE(mean.error.x, fewer * 1e-3 * reflectance);
  EXPECT_LE(mean.error.y, fewer * 1e-3 * 0.66096);
  EXPECT_NEAR(mean.value.x, reflectance, most_off() * mean.error.x + 5e-6); // its last digit
  EXPECT_NEAR(mean.value.y, transmittance, most_off() * mean.error.y + 5e-6);
  EXPECT_NEAR(mean.value.z, mean.value.x + mean.value.y, 1e-6);
}

// A deep slab of isotropic scatterers. Deep enough for ω < 1 to be a half-space; for ω = 1 what
// passes through it is given by its asymptotic law, which holds to e^(−depth) (van de Hulst 1980,
// ch. 5): R = R∞ − 4 K(μ) K(μ₀) / (3 (b + 2 q)), K = √3/4 H, q = 0.71044609.
TEST(PathTracing, HalfSpaceFollowsChandrasekhar)
{
  for (const double albedo : { 0.9, 1.0 })
  {
    const HFunction h(albedo);
    const double depth = albedo < 1.0 ? 60.0 / std::sqrt(3.0 * (1.0 - albedo)) : 40.0;
    for (const double zenith : { 0.0, 80.0 })
    {
      Slab slab(glm::dvec3(depth), 1e5);
      slab.medium().albedo = glm::dvec3(albedo);
      // Three suns of one colour each.
      const double suns[3] = { 10.0, 50.0, 75.0 };
      for (int c = 0; c < 3; ++c)
      {
        glm::dvec3 colour(0.0);
        colour[c] = 1.0;
        slab.add_sun(suns[c], 40.0, colour);
      }
      slab.scene.camera = narrow(slab, zenith).camera(1.0);
      const Mean mean = mean_of(trace(slab.scene, 32, 3400));
      const double mu = std::cos(zenith * pi / 180.0);
      for (int c = 0; c < 3; ++c)
      {
        const double mu0 = std::cos(suns[c] * pi / 180.0);
        double reflection = 0.25 * albedo * h(mu) * h(mu0) / (mu + mu0);
        if (albedo == 1.0)
        {
          reflection -= 4.0 * (3.0 / 16.0) * h(mu) * h(mu0) / (3.0 * (depth + 2.0 * 0.71044609));
        }
        const double radiance = mu0 * reflection; // of an irradiance of π
        EXPECT_NEAR(mean.value[c], radiance, most_off() * mean.error[c])
          << "albedo " << albedo << ", view " << zenith << ", sun " << suns[c];
        EXPECT_LE(mean.error[c], 1e-3 * radiance / std::sqrt(effort()));
        std::cout << albedo << ' ' << zenith << ' ' << suns[c] << ": " << mean.value[c] / radiance - 1.0
                  << " +- " << mean.error[c] / radiance << '\n';
      }
    }
  }
}

// In light that is the same from everywhere, matter that absorbs nothing cannot be seen.
TEST(PathTracing, WhiteFurnaceShowsTheFurnace)
{
  const Voxels<float> voxels{ 9, 8, 7,
    [](int i, int j, int k) { return 0.5f + 0.5f * std::sin(1.3f * i) * std::cos(2.1f * j + k); } };
  for (const glm::dvec3& extinction : { glm::dvec3(0.05), glm::dvec3(3.0), glm::dvec3(0.2, 1.0, 4.0) })
  {
    for (const double g : { -0.9, 0.0, 0.9, 0.999 })
    {
      Scene scene;
      Volume& volume = scene.volumes[0];
      volume.grid = voxels.grid();
      volume.meaning = ValueMeaning::Density;
      const double most = std::max({ extinction.x, extinction.y, extinction.z });
      volume.density.extinction = most;
      volume.density.channels = extinction / most;
      volume.medium.lit = true;
      volume.medium.lobes = { { PhaseFunction::HenyeyGreenstein, 1.0, g } };
      scene.sky.radiance = scene.sky.ground = glm::dvec3(1.0);
      View view;
      view.centre = glm::dvec3(4.0, 3.5, 3.0);
      view.forward = glm::normalize(glm::dvec3(-0.4, -0.7, -0.5));
      view.distance = 20.0;
      view.half_height = 1e-4;
      view.parallel = true;
      view.far_plane = 40.0;
      scene.camera = view.camera(1.0);
      // Of coloured matter a path is of one colour, and the others make do with what it finds.
      const Film film = trace(scene, 32, extinction.x == extinction.y ? 260 : 2100);
      const Mean mean = mean_of(film);
      std::cout << "extinction " << extinction.x << ' ' << extinction.y << ' ' << extinction.z << ", g " << g << ':';
      for (int c = 0; c < 3; ++c)
      {
        const double seen = mean.value[c] + film.transmittance[c][0];
        std::cout << ' ' << seen - 1.0 << " +- " << mean.error[c] << (c < 2 ? ',' : '\n');
        EXPECT_NEAR(seen, 1.0, most_off() * mean.error[c] + 1e-5) << extinction[c] << ", g " << g;
        EXPECT_LE(mean.error[c], 1e-3 / std::sqrt(effort()));
      }
    }
  }
}
