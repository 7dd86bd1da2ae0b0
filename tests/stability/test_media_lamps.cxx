// Hard cases of lamps in matter, and of light and fog.
#include "hard_case.h"
#include "slabs.h"

#include "Transport/fog_film.h"

#include "vtkBrumeFog.h"

using namespace slabs;
using brume_tests::HardCase;

namespace
{

/// A slab with a lamp in its middle, seen straight down past it at a distance.
TransportSlab lamp_slab(double extinction, const glm::dvec3& attenuation, double past)
{
  Case what;
  what.depth = glm::dvec3(extinction);
  what.view = 0.0;
  TransportSlab slab(what);
  Light lamp;
  lamp.positional = true;
  lamp.position = glm::dvec3(0.0, 0.0, 0.5);
  lamp.attenuation = attenuation;
  slab.scene.lights = { lamp };
  View view = slab.look(0.0, 1e-12);
  view.centre.x = past;
  view.parallel = true;
  view.far_plane = 30.0;
  slab.scene.camera = view.camera(1.0);
  return slab;
}

double middle(const Film& film)
{
  return film.radiance[0][film.size() / 2];
}

void expect_finite(HardCase& one, const Film& film, const std::string& by)
{
  bool good = true;
  for (int c = 0; c < 3; ++c)
  {
    for (std::size_t i = 0; i < film.size(); ++i)
    {
      good = good && std::isfinite(film.radiance[c][i]) && film.radiance[c][i] >= 0.0f &&
             film.transmittance[c][i] >= 0.0f && film.transmittance[c][i] <= 1.0f;
    }
  }
  one.holds(good, "finite, not negative, transmittance in [0, 1]", by);
}

}

// Thin matter: σ/4 ∫ ds / (a + c d²), a closed form.
TEST(MediaLamps, LampAtASamplePoint)
{
  HardCase even("Media",
    "a lamp at a sample point, its light not weakened by distance",
    "the direction toward the lamp is 0/0 there",
    "the closed form of thin matter, σ/4 for a ray of 1, within a relative 1e-5");
  HardCase square("Media",
    "a ray past and through a lamp whose light falls with 1/d²",
    "∫ ds/d² is π/δ: a thousandfold peak in one step at δ = 1e-3, infinite at 0",
    "the closed form within a relative 1e-3 down to δ = 1e-3 whatever the step, 1e-2 at 1e-5; "
    "finite at 0");
  const double sigma = 1e-6;
  // With steps of 0.1 and 0.25 the middle of a step, its end, and a voxel are at the lamp.
  for (const double step : { 0.1, 0.25 })
  {
    for (const std::string& target : targets())
    {
      ASSERT_TRUE(force_simd_target(target));
      const std::string by = "ray march (shadow rays), " + target;
      const Draw draw = by_marcher(ShadowMethod::Rays, step);
      for (const double past : { 0.0, 1e-6, 0.125 })
      {
        const Film film = draw(lamp_slab(sigma, { 1.0, 0.0, 0.0 }, past).scene, 3, 3);
        even.measure(std::abs(middle(film) / (0.25 * sigma) - 1.0), 1e-5, "relative", by);
      }
      for (const double past : { 0.125, 1e-2, 1e-3, 1e-5 })
      {
        const Film film = draw(lamp_slab(sigma, { 0.0, 0.0, 1.0 }, past).scene, 3, 3);
        const double truth = 0.25 * sigma / past * 2.0 * std::atan(0.5 / past);
        square.measure(std::abs(middle(film) / truth - 1.0),
          past < 1e-4 ? 1e-2 : 1e-3,
          past < 1e-4 ? "relative at 1e-5" : "relative",
          by);
      }
      expect_finite(square, draw(lamp_slab(sigma, { 0.0, 0.0, 1.0 }, 0.0).scene, 3, 3), by);
      expect_finite(square, draw(lamp_slab(3.0, { 0.0, 0.0, 1.0 }, 0.0).scene, 3, 3), by);
      force_simd_target("");
    }
  }
  const Draw reference = by_reference(1e-10);
  for (const double past : { 0.0, 1e-6, 0.125 })
  {
    even.measure(std::abs(middle(reference(lamp_slab(sigma, { 1.0, 0.0, 0.0 }, past).scene, 3, 3)) /
                            (0.25 * sigma) -
                          1.0),
      1e-5,
      "relative",
      "reference");
  }
  for (const double past : { 0.125, 1e-2, 1e-3, 1e-5 })
  {
    const double truth = 0.25 * sigma / past * 2.0 * std::atan(0.5 / past);
    square.measure(
      std::abs(
        middle(reference(lamp_slab(sigma, { 0.0, 0.0, 1.0 }, past).scene, 3, 3)) / truth - 1.0),
      1e-3,
      "relative",
      "reference");
  }
  expect_finite(square, reference(lamp_slab(3.0, { 0.0, 0.0, 1.0 }, 0.0).scene, 3, 3), "reference");
  // Paths, in matter that they meet, against the reference.
  PathSettings settings;
  settings.samples_per_pixel = 256;
  settings.most_scatterings = 1;
  for (const double past : { 0.125, 1e-2 })
  {
    const TransportSlab slab = lamp_slab(1.0, { 0.0, 0.0, 1.0 }, past);
    const Mean mean = mean_of(traced(slab.scene, settings, 8, 8));
    const double truth = middle(by_reference(1e-6)(slab.scene, 3, 3));
    square.measure(
      std::abs(mean.value.x - truth) / mean.error.x, 4.5, "standard errors", "path tracer");
  }
  settings.most_scatterings = 0;
  expect_finite(
    square, traced(lamp_slab(3.0, { 0.0, 0.0, 1.0 }, 0.0).scene, settings, 3, 3), "path tracer");
}

TEST(MediaLamps, AThousandLamps)
{
  HardCase one("Media",
    "a thousand lamps in thin matter",
    "the sum of a thousand peaks along one ray, each narrower than a step",
    "the sum of the closed forms: by march and reference within a relative 1e-3");
  const double sigma = 1e-6;
  Case what;
  what.depth = glm::dvec3(sigma);
  what.view = 0.0;
  TransportSlab slab(what);
  View view = slab.look(0.0, 1e-12);
  view.parallel = true;
  view.far_plane = 30.0;
  slab.scene.camera = view.camera(1.0);
  slab.scene.lights.clear();
  double truth = 0.0;
  double truth_of_few = 0.0;
  double before = 0.0;
  std::vector<Light> few; // for the reference, which cuts its ray at each
  for (int i = 0; i < 1000; ++i)
  {
    const double past = 0.01 + 2.0 * std::sqrt(i / 1000.0);
    const double height = std::fmod(0.618034 * i, 1.4) - 0.2; // some above, some below
    Light lamp;
    lamp.positional = true;
    lamp.position = { past * std::cos(2.4 * i), past * std::sin(2.4 * i), height };
    lamp.attenuation = { 0.0, 0.0, 1.0 };
    lamp.diffuse = glm::dvec3(1e-3);
    slab.scene.lights.push_back(lamp);
    truth +=
      1e-3 * 0.25 * sigma / past * (std::atan((1.0 - height) / past) + std::atan(height / past));
    if (i % 20 == 0)
    {
      few.push_back(lamp);
      truth_of_few = i == 0 ? truth : truth_of_few + (truth - before);
    }
    before = truth;
  }
  for (const std::string& target : targets())
  {
    ASSERT_TRUE(force_simd_target(target));
    const double got = middle(by_marcher(ShadowMethod::Rays, 0.1)(slab.scene, 1, 1));
    one.measure(
      std::abs(got / truth - 1.0), 1e-3, "relative", "ray march (shadow rays), " + target);
  }
  force_simd_target("");
  slab.scene.lights = few;
  one.measure(std::abs(middle(by_reference(1e-9)(slab.scene, 1, 1)) / truth_of_few - 1.0),
    1e-3,
    "relative",
    "reference (of fifty)");
}

// In layers light from below comes through endlessly many, ever denser ones.
TEST(MediaLamps, LightBelowTheFog)
{
  HardCase one("Media",
    "lights below the fog: a sun under the horizon, a lamp 200 under the ground",
    "the optical depth toward them is infinite or 1e20, and times a profile of 0 it is NaN",
    "they send nothing, exactly, into fog or into matter within it; everything stays finite");
  Case what;
  what.depth = glm::dvec3(0.5);
  TransportSlab slab(what);
  Scene& scene = slab.scene;
  scene.fog.enabled = true;
  scene.fog.extinction = glm::dvec3(0.3);
  scene.fog.albedo = glm::dvec3(0.9);
  scene.fog.falloff = 0.25;
  Light sun;
  sun.direction = glm::normalize(glm::dvec3(0.3, 0.0, 0.9));
  Light lamp;
  lamp.positional = true;
  lamp.position = glm::dvec3(0.0, 0.0, -200.0);
  scene.lights = { sun, lamp };
  const auto brightest = [](const Film& film)
  {
    double most = 0.0;
    for (const auto& channel : film.radiance)
    {
      for (const float v : channel)
      {
        most = v <= most ? most : double(v);
      }
    }
    return most;
  };
  const auto expect_dark = [&](const Film& film, const std::string& by)
  {
    one.measure(brightest(film), 0.0, "radiance", by);
    expect_finite(one, film, by);
  };
  for (const std::string& target : targets())
  {
    ASSERT_TRUE(force_simd_target(target));
    expect_dark(
      by_marcher(ShadowMethod::Rays, 0.1)(scene, 3, 3), "ray march (shadow rays), " + target);
    expect_dark(by_marcher(ShadowMethod::Volume, 0.1, 0.25)(scene, 3, 3),
      "ray march (light volume), " + target);
  }
  force_simd_target("");
  expect_dark(by_reference(1e-6)(scene, 3, 3), "reference");
  Film alone(3, 3);
  ASSERT_TRUE(render_fog(scene, alone));
  expect_dark(alone, "fog alone");
  PathSettings settings;
  settings.samples_per_pixel = 64;
  settings.most_scatterings = 1;
  expect_dark(traced(scene, settings, 3, 3), "path tracer");
  // By the mappers: a fog over which the same lights hang upside down.
  const auto mapped = [&](vtkBrumeVolumeMapper* mapper, const std::string& by)
  {
    MapperSlab by_vtk(what, mapper);
    vtkNew<vtkBrumeFog> fog;
    fog->SetExtinction(0.3);
    fog->SetAlbedo(0.9);
    fog->SetFalloff(0.25);
    mapper->SetFog(fog);
    vtkNew<vtkLight> below;
    below->SetLightTypeToSceneLight();
    below->SetPosition(-0.3, 0.0, -0.9);
    below->SetFocalPoint(0.0, 0.0, 0.0);
    vtkNew<vtkLight> deep;
    deep->SetLightTypeToSceneLight();
    deep->SetPositional(1);
    deep->SetConeAngle(180.0);
    deep->SetPosition(0.0, 0.0, -200.0);
    by_vtk.lights->AddItem(below);
    by_vtk.lights->AddItem(deep);
    Film film(3, 3);
    EXPECT_TRUE(mapper->RenderFilm(by_vtk.volume, by_vtk.camera, by_vtk.lights, film));
    expect_dark(film, by);
  };
  vtkNew<vtkBrumeRayMarchMapper> march;
  mapped(march, "vtkBrumeRayMarchMapper");
  vtkNew<vtkBrumePathTraceMapper> paths;
  paths->SetSamplesPerPixel(16);
  mapped(paths, "vtkBrumePathTraceMapper");
  vtkNew<vtkBrumeSmartVolumeMapper> smart;
  smart->SetTolerance(0.02);
  mapped(smart, "vtkBrumeSmartVolumeMapper");
}

// Two sheets with nothing between, which a cut cosine series rings about.
TEST(MediaLamps, ShadowFunctionsStayInBounds)
{
  HardCase one("Optics",
    "transmittance functions and light volumes behind two thin, dense sheets",
    "a step of the transmittance cut to six cosines overshoots on both sides: negative light, and "
    "light from nothing",
    "the transmittance never leaves [0, 1]: radiance is at least 0, and never above that without "
    "shadows "
    "by more than a relative 1e-6");
  const Voxels<float> sheets(
    5, 5, 33, [](int, int, int k) { return k == 8 || k == 24 ? 1.0f : 0.02f; });
  for (const double extinction : { 1.0, 20.0, 1000.0 })
  {
    const double wide = 1.0;
    Slab slab(glm::dvec3(extinction), wide);
    Volume& volume = slab.scene.volumes[0];
    volume.grid = sheets.grid();
    volume.data_from_index = placed(
      glm::dvec3(0.25 * wide, 0.25 * wide, 1.0 / 32.0), glm::dvec3(-0.5 * wide, -0.5 * wide, 0.0));
    slab.add_sun(30.0, 20.0, glm::dvec3(1.0));
    for (const double zenith : { 20.0, 160.0 })
    {
      View view = slab.look(zenith, 0.5);
      slab.scene.camera = view.camera(1.0);
      for (const std::string& target : targets())
      {
        ASSERT_TRUE(force_simd_target(target));
        const Film bare = by_marcher(ShadowMethod::None, 0.02)(slab.scene, 7, 7);
        for (const auto& [name, method] : { std::pair{ "light volume", ShadowMethod::Volume },
               { "shadow functions", ShadowMethod::Functions } })
        {
          const Film film = by_marcher(method, 0.02, 0.03)(slab.scene, 7, 7);
          double above = 0.0;
          double below = 0.0;
          for (std::size_t i = 0; i < film.size(); ++i)
          {
            const double here = film.radiance[0][i];
            above = here <= bare.radiance[0][i] * (1.0 + above) ? above
                                                                : here / bare.radiance[0][i] - 1.0;
            below = here >= -below ? below : -here;
          }
          one.measure(
            above, 1e-6, "relative above light without shadows", std::string(name) + ", " + target);
          one.measure(below, 0.0, "below 0", std::string(name) + ", " + target);
        }
      }
      force_simd_target("");
    }
  }
}

// The mapper's own figure must not be better than the picture.
TEST(MediaLamps, AnErrorThatIsTold)
{
  HardCase one("Media",
    "opaque matter of voxels that do not interpolate, lit",
    "no light volume has nodes close enough, and rays through it are not exact: the mapper cannot "
    "keep its tolerance in its time",
    "it says so: the error of the picture is at most the `estimated_error` of the statistics");
  for (const double depth : { 30.0, 300.0, 1e6 })
  {
    Case what;
    what.depth = glm::dvec3(depth);
    what.suns = { { 40.0, 20.0 } };
    vtkNew<vtkBrumeRayMarchMapper> mapper;
    MapperSlab slab(what, mapper);
    slab.volume->GetProperty()->SetInterpolationTypeToNearest();
    Film film(3, 3);
    ASSERT_TRUE(mapper->RenderFilm(slab.volume, slab.camera, slab.lights, film));
    const std::string& text = mapper->GetStatistics();
    const std::size_t at = text.find("\"estimated_error\":");
    ASSERT_NE(at, std::string::npos);
    const double told = std::stod(text.substr(at + 18));
    const double off = std::abs(middle(film) - truth_of(what).radiance.x);
    one.measure(off / told, 1.0, "of the error told", "vtkBrumeRayMarchMapper");
  }
}
