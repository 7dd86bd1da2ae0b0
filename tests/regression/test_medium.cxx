// vtkBrumeRayMarchMapper with a medium and without: what VTK's lights mean, against closed forms in
// a cube of even matter; what the statistics tell; that nothing changes where there is no medium.
#include "../support/lit_props.h"

#include "vtkBrumeEffectPlan.h"

#include "Transport/black_body.h"
#include "Transport/marcher.h"
#include "Transport/step_control.h"

#include "vtkContourValues.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <string>
#include <vector>

using namespace lit_props;
using brume::Film;
using nlohmann::json;

namespace
{

json statistics_of(const Cube& cube)
{
  return json::parse(cube.mapper->GetStatistics());
}

void expect_rgb(const glm::dvec3& measured, double r, double g, double b, double relative)
{
  const double expected[3] = { r, g, b };
  for (int c = 0; c < 3; ++c)
  {
    EXPECT_NEAR(measured[c], expected[c], relative * std::abs(expected[c]) + 1e-9) << c;
  }
}

// A directional light of intensity I and colour C is the irradiance π I C; light that comes along
// the view's axis is dimmed as much on its way in as out: ∫ ω σ / 4π · π I C e^(−2 σ s) ds.
TEST(LitCube, ADirectionalLightIsAnIrradiance)
{
  Cube cube;
  auto light = cube.light_from_the_front();
  const auto exact = [](double sigma, double albedo, double colour)
  { return albedo * 0.25 * 2.0 * colour * -std::expm1(-2.0 * sigma * edge) / 2.0; };
  expect_rgb(
    cube.radiance(), exact(0.05, 1.0, 1.0), exact(0.1, 0.5, 0.8), exact(0.2, 0.25, 0.6), 2e-4);
  EXPECT_NEAR(cube.transmittance(0), std::exp(-0.05 * edge), 2e-5);
  EXPECT_NEAR(cube.transmittance(2), std::exp(-0.2 * edge), 2e-5);
  // Of the same light as a headlight, or as a camera light behind the viewer.
  const glm::dvec3 scene_light = cube.radiance();
  light->SetLightTypeToHeadlight();
  expect_rgb(cube.radiance(), scene_light.x, scene_light.y, scene_light.z, 1e-6);
  put_at_the_camera(light);
  expect_rgb(cube.radiance(), scene_light.x, scene_light.y, scene_light.z, 1e-6);
  light->SwitchOff();
  expect_rgb(cube.radiance(), 0, 0, 0, 0);
}

// Lights add up, and each is dimmed on its own way: from the side by half the cube.
TEST(LitCube, SeveralLightsAddUp)
{
  Cube cube;
  const double sigma = 0.05;
  cube.light_from_three_sides(sigma);
  const double front = 0.25 * -std::expm1(-2.0 * sigma * edge) / 2.0;
  const double side = 0.25 * std::exp(-sigma * edge / 2.0) * -std::expm1(-sigma * edge);
  const double back = 0.25 * sigma * edge * std::exp(-sigma * edge);
  expect_rgb(cube.radiance(), front, side, back, 2e-4);
  // The phase function tells front from back: θ = 0 is light that goes on toward the viewer.
  const double g = 0.5;
  cube.medium->SetAnisotropy(g);
  const double straight = (1 - g * g) / std::pow(1 - g, 3.0);
  const double turned = (1 - g * g) / std::pow(1 + g, 3.0);
  const double across = (1 - g * g) / std::pow(1 + g * g, 1.5);
  expect_rgb(cube.radiance(), front * turned, side * across, back * straight, 2e-4);
}

// In matter so thin that nothing is dimmed: 1/4 · Σ of strength · σ ds.
TEST(LitCube, PointAndSpotLightsWeakenAsVTKHasIt)
{
  Cube cube;
  const double sigma = 1e-6;
  cube.medium->SetExtinction(sigma);
  cube.mapper->SetTolerance(1e-12);
  auto lamp = cube.add_lamp();
  const double far = 40.0 - edge / 2;
  const int n = 4000;
  const auto sum = [&](auto strength)
  {
    double total = 0.0;
    for (int i = 0; i < n; ++i)
    {
      const double z = edge * ((i + 0.5) / n - 0.5);
      total += strength(std::sqrt(far * far + z * z)) * edge / n;
    }
    return 0.25 * sigma * total;
  };
  const auto weakened = [](double d) { return 1.0 / (0.5 + 0.25 * d + 0.125 * d * d); };
  const double point = sum(weakened);
  expect_rgb(cube.radiance(), point, point, point, 1e-3);
  // A spot toward the middle: all within ±14° of its axis, of a fall-off cos³.
  make_spot(lamp);
  const double spot = sum([&](double d) { return weakened(d) * std::pow(far / d, 3.0); });
  expect_rgb(cube.radiance(), spot, spot, spot, 1e-3);
  // And none of it.
  lamp->SetFocalPoint(40.0, 40.0, edge / 2);
  expect_rgb(cube.radiance(), 0, 0, 0, 0);
}

TEST(LitCube, SkyGroundAndEnvironmentAreRadiances)
{
  Cube cube;
  const double sigma = 1e-6;
  cube.medium->SetExtinction(sigma);
  cube.mapper->SetTolerance(1e-12);
  cube.put_under_sky();
  const double thin = sigma * edge;
  expect_rgb(cube.radiance(), 0.5 * thin, 0.5 * thin, 0.125 * thin, 2e-3);
  cube.put_under_a_map(0.75);
  expect_rgb(cube.radiance(), 0.75 * thin, 0.75 * thin, 0.75 * thin, 2e-3);
}

TEST(LitCube, MatterGlows)
{
  Cube cube;
  const double sigma = 0.1;
  cube.glow(sigma);
  const double seen = -std::expm1(-sigma * edge) / sigma; // ∫ e^(−σ s) ds
  expect_rgb(cube.radiance(), 0.01 * seen, 0.02 * seen, 0.03 * seen, 1e-3);
  cube.glow_of_heat();
  const glm::dvec3 glow = brume::black_body_radiance(1800.0, 1500.0);
  EXPECT_GT(glow.x, 2.0);
  expect_rgb(
    cube.radiance(), 0.01 * seen * glow.x, 0.01 * seen * glow.y, 0.01 * seen * glow.z, 2e-3);
}

TEST(LitCube, ClassifiedMatterScattersItsColour)
{
  Cube cube;
  cube.classify();
  const double lit = 0.25 * -std::expm1(-2.0 * 0.05 * edge) / 2.0;
  expect_rgb(cube.radiance(), 0.9 * lit, 0.45 * lit, 0.125 * lit, 1e-3);
}

// Several volumes as one. ------------------------------------------------------------------------

TEST(LitTogether, EachCastsItsShadowOnTheOther)
{
  const double sigma = 0.05;
  TwoCubes cubes(sigma);
  cubes.first.add_light(90.0, edge / 2, edge / 2);
  const double alone = 0.25 * std::exp(-sigma * edge / 2.0) * -std::expm1(-sigma * edge);
  const double behind = alone * std::exp(-sigma * edge);
  const glm::dvec3 together = cubes.radiance();
  expect_rgb(together, behind, behind, behind, 1e-3);
  cubes.second.volume->SetPosition(-20.0, 0.0, 0.0);
  expect_rgb(cubes.radiance(), alone, alone, alone, 1e-3);
}

TEST(LitTogether, TheFirstSkyLightsAll)
{
  const double sigma = 1e-6;
  TwoCubes cubes(sigma);
  cubes.first.mapper->SetTolerance(1e-12);
  cubes.second.sky->SetSkyRadiance(1.0, 1.0, 1.0);
  cubes.second.mapper->SetSky(cubes.second.sky);
  const double half = 0.5 * sigma * edge;
  expect_rgb(cubes.radiance(), half, half, half, 2e-3);
  cubes.first.mapper->SetSky(cubes.first.sky);
  cubes.first.sky->SetSkyRadiance(0.0, 0.0, 0.5);
  expect_rgb(cubes.radiance(), 0.0, 0.0, 0.5 * half, 2e-3);
}

// Statistics. ----------------------------------------------------------------------------------

TEST(LitStatistics, TellOfLight)
{
  Cube cube;
  cube.light_aslant();
  const std::pair<int, const char*> methods[] = {
    { vtkBrumeRayMarchMapper::RayShadows, "rays" },
    { vtkBrumeRayMarchMapper::VolumeShadows, "volume" },
    { vtkBrumeRayMarchMapper::FunctionShadows, "functions" },
    { vtkBrumeRayMarchMapper::NoShadows, "none" },
  };
  for (const auto& [method, name] : methods)
  {
    cube.mapper->SetShadowMethod(method);
    cube.mapper->SetShadowSampleDistance(0.75);
    cube.radiance();
    const json told = statistics_of(cube);
    EXPECT_EQ(told["shadow_method"], name);
    const bool kept = method == vtkBrumeRayMarchMapper::VolumeShadows ||
                      method == vtkBrumeRayMarchMapper::FunctionShadows;
    EXPECT_EQ(told["light_bytes"].get<std::size_t>() > 0, kept) << name;
    EXPECT_TRUE(told["seconds_light"].is_number());
    if (method != vtkBrumeRayMarchMapper::NoShadows)
    {
      EXPECT_EQ(told["shadow_step"], 0.75) << name;
    }
    EXPECT_EQ(told["radiometric"], true);
    EXPECT_EQ(told["completed"], true);
  }
}

TEST(LitStatistics, NameEveryEffectAndWhatIsForced)
{
  Cube cube;
  cube.light_aslant();
  EXPECT_GT(cube.radiance().x, 0.01);
  const double through = cube.transmittance(0);
  const auto effect = [&](const std::string& name)
  {
    const json statistics = statistics_of(cube);
    for (const json& one : statistics["effects"])
    {
      if (one["name"] == name)
      {
        return one;
      }
    }
    ADD_FAILURE() << name;
    return json();
  };
  for (int i = 0; i < vtkBrumeEffectPlan::GetNumberOfEffects(); ++i)
  {
    const json one = effect(vtkBrumeEffectPlan::GetEffectName(i));
    EXPECT_EQ(one["on"], cube.mapper->GetEffectPlan()->GetEffectOn(i));
    EXPECT_EQ(one["reason"], cube.mapper->GetEffectPlan()->GetEffectReason(i));
    EXPECT_FALSE(one["reason"].get<std::string>().empty()) << one["name"];
    EXPECT_EQ(one["error_bound"], cube.mapper->GetEffectPlan()->GetEffectErrorBound(i));
    EXPECT_EQ(one["forced"], false);
  }
  for (const char* name : { "projection",
         "several volumes",
         "gradient opacity",
         "mask",
         "cropping",
         "clipping planes",
         "jitter",
         "final colour window",
         "leaving rays early" })
  {
    EXPECT_EQ(effect(name)["forced"], false);
  }
  EXPECT_EQ(effect("scattering")["on"], true);
  EXPECT_TRUE(cube.mapper->GetEffectPlan()->Force("scattering", false));
  expect_rgb(cube.radiance(), 0, 0, 0, 0);
  EXPECT_NEAR(cube.transmittance(0), through, 2e-5);
  EXPECT_EQ(effect("scattering")["on"], false);
  EXPECT_EQ(effect("scattering")["forced"], true);
  EXPECT_GT(effect("scattering")["error_bound"].get<double>(), 0.01);
  EXPECT_GT(statistics_of(cube)["effects_error_bound"].get<double>(), 0.01);
  cube.mapper->GetEffectPlan()->ForceNothing();
  EXPECT_GT(cube.radiance().x, 0.01);
  EXPECT_EQ(effect("scattering")["forced"], false);
}

TEST(LitStatistics, SayWhatIsNotRadiometric)
{
  Cube cube;
  cube.light_from_behind();
  const glm::dvec3 physical = cube.radiance();
  EXPECT_EQ(statistics_of(cube)["radiometric"], true);
  cube.medium->SilverLiningOn();
  EXPECT_GT(cube.radiance().x, 1.1 * physical.x);
  EXPECT_EQ(statistics_of(cube)["radiometric"], false);
  cube.medium->SilverLiningOff();
  cube.medium->PowderOn();
  EXPECT_LT(cube.radiance().x, 0.95 * physical.x);
  EXPECT_EQ(statistics_of(cube)["radiometric"], false);
  cube.medium->PowderOff();
  EXPECT_EQ(cube.radiance(), physical);
  EXPECT_EQ(statistics_of(cube)["radiometric"], true);
}

TEST(LitStatistics, ThePictureIsTheSameForAnyNumberOfThreads)
{
  Cube cube;
  cube.light_aslant();
  cube.mapper->SetShadowMethodToAutomatic();
  cube.sky->SetSkyRadiance(0.1, 0.2, 0.3);
  cube.mapper->SetNumberOfThreads(1);
  cube.radiance();
  const Film one = cube.film;
  cube.mapper->SetNumberOfThreads(3);
  cube.radiance();
  EXPECT_EQ(difference(one, cube.film), 0.0);
}

// Without a medium. ----------------------------------------------------------------------------

/// What the mapper drew before there were media: the step for three quarters of the tolerance, rays
/// left for one.
Film drawn_plainly(vtkBrumeRayMarchMapper* mapper, vtkVolume* volume, vtkCamera* camera)
{
  const brume::Scene* scene = mapper->UpdateScene(volume, camera, nullptr, 40, 30);
  EXPECT_NE(scene, nullptr);
  brume::Marcher marcher;
  brume::MarchSettings settings;
  settings.leave_error = 0.25 * mapper->GetTolerance();
  settings.step = mapper->GetSampleDistance();
  if (mapper->GetAutoAdjustSampleDistances())
  {
    const brume::StepChoice choice =
      brume::choose_step(marcher, *scene, 0.75 * mapper->GetTolerance());
    settings.rule = choice.rule;
    settings.step = choice.step;
    settings.refinements = choice.refinements;
    settings.refine_error = choice.refine_error;
  }
  Film film(40, 30);
  marcher.render(*scene, settings, film);
  return film;
}

TEST(WithoutAMedium, PicturesAreWhatTheyWereBitForBit)
{
  for (int mode : { vtkVolumeMapper::COMPOSITE_BLEND,
         vtkVolumeMapper::MAXIMUM_INTENSITY_BLEND,
         vtkVolumeMapper::ISOSURFACE_BLEND })
  {
    for (int automatic : { 0, 1 })
    {
      for (int variant = 0; variant < 4; ++variant)
      {
        SCOPED_TRACE(
          std::to_string(mode) + ' ' + std::to_string(automatic) + ' ' + std::to_string(variant));
        const auto volume = volume_of(variant == 3 ? 0.001 : 0.4);
        vtkNew<vtkBrumeRayMarchMapper> mapper;
        mapper->SetInputData(ball_image(VTK_SHORT));
        mapper->SetBlendMode(mode);
        mapper->SetAutoAdjustSampleDistances(automatic);
        mapper->SetSampleDistance(0.6);
        mapper->SetTolerance(0.02);
        volume->GetProperty()->SetShade(variant == 1);
        volume->GetProperty()->GetIsoSurfaceValues()->SetValue(0, 120.0);
        if (variant == 2 && mode == vtkVolumeMapper::COMPOSITE_BLEND)
        {
          mapper->SetExtinction(0.002);
        }
        volume->SetMapper(mapper);
        vtkNew<vtkCamera> camera;
        look_at(camera, volume->GetCenter(), 90.0);
        vtkBrumeVolumeMapper::ResetClippingRange(volume, camera);
        Film film(40, 30);
        ASSERT_TRUE(mapper->RenderFilm(volume, camera, nullptr, film));
        const Film plain = drawn_plainly(mapper, volume, camera);
        EXPECT_GT(most_opaque(film), variant == 3 ? 1e-4 : 0.1);
        EXPECT_EQ(difference(film, plain), 0.0);
        EXPECT_EQ(film.depth, plain.depth);
        EXPECT_EQ(json::parse(mapper->GetStatistics())["shadow_method"], "none");
        EXPECT_EQ(json::parse(mapper->GetStatistics())["effects_error_bound"], 0.0);
      }
    }
  }
}

TEST(WithoutAMedium, EffectsCanBeForced)
{
  const auto volume = volume_of(0.4);
  vtkNew<vtkBrumeRayMarchMapper> mapper;
  mapper->SetInputData(ball_image(VTK_SHORT));
  mapper->SetAutoAdjustSampleDistances(0);
  mapper->SetSampleDistance(0.5);
  volume->SetMapper(mapper);
  volume->GetProperty()->ShadeOn();
  vtkNew<vtkCamera> camera;
  look_at(camera, volume->GetCenter(), 90.0);
  vtkBrumeVolumeMapper::ResetClippingRange(volume, camera);
  Film shaded(40, 30);
  ASSERT_TRUE(mapper->RenderFilm(volume, camera, nullptr, shaded));
  mapper->GetEffectPlan()->Force("gradient-shading", false);
  Film forced(40, 30);
  ASSERT_TRUE(mapper->RenderFilm(volume, camera, nullptr, forced));
  EXPECT_GT(difference(shaded, forced), 0.05);
  volume->GetProperty()->ShadeOff();
  mapper->GetEffectPlan()->ForceNothing();
  Film unshaded(40, 30);
  ASSERT_TRUE(mapper->RenderFilm(volume, camera, nullptr, unshaded));
  EXPECT_LT(difference(unshaded, forced), 1e-6);
}

}
