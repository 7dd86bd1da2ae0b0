// Paths through fog without bounds: one scattering against the closed forms and the reference, any
// number against Chandrasekhar's half-space, which fog with falloff is.
#include "../support/path_truth.h"

#include "Transport/fog_film.h"

#include <iostream>
#include <stdexcept>

using namespace path_truth;

namespace
{

constexpr int edge = 16;

View downward()
{
  View view;
  view.centre = glm::dvec3(0.0, 0.0, 2.0);
  view.forward = glm::normalize(glm::dvec3(0.2, 0.9, -0.25));
  view.up = glm::dvec3(0.0, 0.0, 1.0);
  view.distance = 10.0;
  view.half_height = 5.0;
  view.far_plane = 40.0;
  return view;
}

Scene fog(double falloff)
{
  Scene scene;
  scene.volumes.clear();
  scene.fog.enabled = true;
  scene.fog.extinction = glm::dvec3(0.05, 0.1, 0.2);
  scene.fog.albedo = glm::dvec3(0.9, 0.8, 1.0);
  scene.fog.falloff = falloff;
  scene.fog.base_height = 1.0;
  scene.fog.lobes = { { PhaseFunction::HenyeyGreenstein, 0.8, 0.5 },
    { PhaseFunction::Rayleigh, 0.2, 0.0 } };
  scene.camera = downward().camera(1.0);
  return scene;
}

Light sun(const glm::dvec3& travel)
{
  Light light;
  light.direction = glm::normalize(travel);
  light.diffuse = glm::dvec3(2.0, 1.8, 1.5);
  return light;
}

void expect_agreement(const char* name, const Scene& scene, const Film& truth, int samples)
{
  PathSettings settings;
  settings.samples_per_pixel = samples;
  settings.most_scatterings = 1;
  const Film film = traced(scene, settings, edge, edge);
  double squares = 0.0;
  double sums[3] = { 0.0, 0.0, 0.0 };
  double variance = 0.0;
  int count = 0;
  for (std::size_t i = 0; i < film.size(); ++i)
  {
    const double sigma = film.error[i] / 3.0;
    double largest_off = 0.0;
    for (int c = 0; c < 3; ++c)
    {
      const double off = double(film.radiance[c][i]) - truth.radiance[c][i];
      sums[c] += off;
      largest_off = std::max(largest_off, std::abs(off));
      EXPECT_NEAR(film.transmittance[c][i], truth.transmittance[c][i], 1e-3) << name;
    }
    if (sigma > 0.0)
    {
      variance += sigma * sigma;
      squares += largest_off * largest_off / (sigma * sigma);
      ++count;
    }
  }
  const double mean =
    std::max({ std::abs(sums[0]), std::abs(sums[1]), std::abs(sums[2]) }) / std::sqrt(variance);
  std::cout << name << ": " << mean << " standard errors off, mean square " << squares / count
            << ", of " << count << " pixels\n";
  EXPECT_GT(count, edge * edge / 4) << name;
  EXPECT_LE(mean, 4.0) << name;
  EXPECT_LE(squares / count, 2.5) << name;
}

}

TEST(PathFog, OneScatteringOfFogAloneIsTheClosedForms)
{
  Light lamp;
  lamp.positional = true;
  lamp.position = glm::dvec3(-9.0, -8.0, 3.5); // no ray of the camera comes near
  lamp.diffuse = glm::dvec3(5.0, 8.0, 4.0);
  lamp.attenuation = glm::dvec3(0.0, 0.0, 1.0);
  for (const double falloff : { 0.0, 0.4 })
  {
    const char* const name = falloff > 0.0 ? "layers" : "homogeneous";
    Scene scene = fog(falloff);
    Film truth(edge, edge);
    scene.lights = { sun(glm::dvec3(0.3, 0.5, -0.6)), lamp };
    ASSERT_TRUE(render_fog(scene, truth));
    expect_agreement(name, scene, truth, 600);
    // Of light from all around what isotropic fog sends is known.
    scene.lights = {};
    scene.fog.lobes.clear();
    scene.sky.radiance = glm::dvec3(0.5, 0.6, 0.9);
    scene.sky.ground = falloff > 0.0 ? glm::dvec3(0.0) : glm::dvec3(0.2, 0.1, 0.05);
    ASSERT_TRUE(render_fog(scene, truth));
    expect_agreement("sky", scene, truth, 600);
  }
  // Up to surfaces.
  Scene scene = fog(0.4);
  scene.lights = { sun(glm::dvec3(0.3, 0.5, -0.6)) };
  scene.surface_depth.assign(edge * edge, 0.99f);
  Film truth(edge, edge);
  ASSERT_TRUE(render_fog(scene, truth));
  expect_agreement("surfaces", scene, truth, 600);
}

// The reference knows no shadows of volumes on the fog outside of their boxes: here there are none
// to be seen.
TEST(PathFog, OneScatteringWithVolumesIsTheReferences)
{
  const Voxels<float> voxels{ 12, 11, 10, [](int i, int j, int k) {
                               return 0.5f +
                                      0.5f * std::sin(0.9f * i) * std::cos(0.7f * j + 0.4f * k);
                             } };
  Scene scene = fog(0.2);
  scene.volumes.resize(1);
  Volume& volume = scene.volumes[0];
  volume.grid = voxels.grid();
  volume.data_from_index = placed(glm::dvec3(0.6), glm::dvec3(-3.3, -3.0, 0.0));
  volume.meaning = ValueMeaning::Density;
  volume.density.extinction = 0.5;
  volume.density.channels = glm::dvec3(1.0, 0.7, 0.5);
  volume.medium.lit = true;
  volume.medium.emission = glm::dvec3(0.02, 0.05, 0.01);
  volume.medium.albedo = glm::dvec3(0.9);
  Light lamp;
  lamp.positional = true;
  lamp.position = glm::dvec3(0.2, 5.0, 4.0);
  lamp.diffuse = glm::dvec3(20.0);
  lamp.attenuation = glm::dvec3(0.0, 0.0, 1.0);
  // Fog that scatters nothing; what glows is not scattered by the reference.
  Scene dark = scene;
  dark.fog.albedo = glm::dvec3(0.0);
  dark.volumes[0].medium.emission = glm::dvec3(0.0);
  dark.lights = { sun(glm::dvec3(0.3, 0.5, -0.6)), lamp };
  expect_agreement("absorbing fog", dark, by_reference(1e-4, 8)(dark, edge, edge), 400);
  dark = scene;
  dark.fog.albedo = glm::dvec3(0.0);
  dark.volumes[0].medium.albedo = glm::dvec3(0.0);
  dark.lights = {};
  expect_agreement("glow in fog", dark, by_reference(1e-4, 8)(dark, edge, edge), 400);
  // The sun behind the camera, and surfaces that end rays inside the box.
  Scene behind = scene;
  behind.volumes[0].medium.emission = glm::dvec3(0.0);
  View view = downward();
  view.parallel = true;
  view.half_height = 2.0;
  view.centre = glm::dvec3(0.0, 0.0, 2.7);
  view.forward = glm::normalize(glm::dvec3(0.1, 0.9, -0.3));
  behind.camera = view.camera(1.0);
  behind.lights = { sun(view.forward) };
  // 10 of 0.1 to 40 from the eye, in the box's middle.
  behind.surface_depth.assign(edge * edge, static_cast<float>(2.0 * (10.0 - 0.1) / 39.9 - 1.0));
  expect_agreement("sun behind", behind, by_reference(1e-4, 8)(behind, edge, edge), 400);
}

// By optical depth, fog with falloff is a half-space without end below.
TEST(PathFog, LayersFollowChandrasekhar)
{
  for (const double albedo : { 0.9, 1.0 })
  {
    const HFunction h(albedo);
    Scene scene = fog(0.5);
    scene.fog.lobes.clear();
    scene.fog.albedo = glm::dvec3(albedo);
    scene.fog.extinction = glm::dvec3(0.3, 0.3, 0.3);
    const double mu = 0.6;
    const double suns[3] = { 0.9, 0.5, 0.2 };
    for (int c = 0; c < 3; ++c)
    {
      Light light = sun(glm::dvec3(0.0, std::sqrt(1.0 - suns[c] * suns[c]), -suns[c]));
      light.diffuse = glm::dvec3(0.0);
      light.diffuse[c] = 1.0;
      scene.lights.push_back(light);
    }
    // From above all fog.
    scene.camera = pencil(glm::dvec3(0.0, 0.0, 60.0), glm::dvec3(0.8, 0.0, -mu), 10.0).camera(1.0);
    PathSettings settings;
    settings.samples_per_pixel = 60;
    const Mean mean = mean_of(traced(scene, settings, 24, 24));
    for (int c = 0; c < 3; ++c)
    {
      const double radiance = suns[c] * 0.25 * albedo * h(mu) * h(suns[c]) / (mu + suns[c]);
      std::cout << albedo << ' ' << suns[c] << ": " << mean.value[c] / radiance - 1.0 << " +- "
                << mean.error[c] / radiance << '\n';
      EXPECT_NEAR(mean.value[c], radiance, 4.0 * mean.error[c]);
      EXPECT_LE(mean.error[c], 0.02 * radiance);
    }
  }
}

// Albedo 1 in one channel alone: the floor is that channel's, and the others go on below.
TEST(PathFog, FloorsAreOfConservativeChannels)
{
  Scene scene = fog(0.5);
  scene.fog.lobes.clear();
  scene.fog.albedo = glm::dvec3(1.0, 0.99, 0.9);
  scene.fog.extinction = glm::dvec3(0.3, 0.3, 0.3);
  Light light = sun(glm::dvec3(0.0, 0.8, -0.6));
  light.diffuse = glm::dvec3(1.0);
  scene.lights = { light };
  scene.camera = pencil(glm::dvec3(0.0, 0.0, 60.0), glm::dvec3(0.6, 0.0, -0.8), 10.0).camera(1.0);
  PathSettings settings;
  settings.samples_per_pixel = 60;
  const Mean mean = mean_of(traced(scene, settings, 24, 24));
  for (int c = 0; c < 3; ++c)
  {
    const double albedo = scene.fog.albedo[c];
    const HFunction h(albedo);
    const double radiance = 0.6 * 0.25 * albedo * h(0.8) * h(0.6) / 1.4;
    std::cout << albedo << ": " << mean.value[c] / radiance - 1.0 << " +- "
              << mean.error[c] / radiance << '\n';
    EXPECT_NEAR(mean.value[c], radiance, 4.0 * mean.error[c]);
    EXPECT_LE(mean.error[c], 0.02 * radiance);
  }
}

TEST(PathFog, WhatHasNoEndIsRefused)
{
  Scene scene = fog(0.0);
  scene.lights = { sun(glm::dvec3(0.0, 0.0, -1.0)) };
  Film film(2, 2);
  PathTracer tracer;
  PathSettings settings;
  settings.samples_per_pixel = 1;
  EXPECT_THROW(tracer.render(scene, settings, film), std::invalid_argument);
  settings.most_scatterings = 2;
  EXPECT_THROW(tracer.render(scene, settings, film), std::invalid_argument);
  settings.most_scatterings = 1;
  EXPECT_TRUE(tracer.render(scene, settings, film).completed);
  scene.lights[0].positional = true;
  settings.most_scatterings = 0;
  EXPECT_THROW(tracer.render(scene, settings, film), std::invalid_argument); // one albedo is 1
  settings.most_scatterings = 3;
  EXPECT_TRUE(tracer.render(scene, settings, film).completed);
}
