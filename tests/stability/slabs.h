// A homogeneous slab, 0 ≤ z ≤ 1 and 8 wide, as every integrator and every mapper draws it, and its
// single scattering in closed form.
#pragma once

#include "../support/path_truth.h"

#include "Transport/path_tracer.h"

#include "vtkBrumeMedium.h"
#include "vtkBrumePathTraceMapper.h"
#include "vtkBrumeRayMarchMapper.h"
#include "vtkBrumeSky.h"
#include "vtkBrumeSmartVolumeMapper.h"

#include "vtkCamera.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkLight.h"
#include "vtkLightCollection.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkSmartPointer.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"

#include <cmath>
#include <string>
#include <vector>

namespace slabs
{

using namespace path_truth;

constexpr double width = 8.0;
constexpr int pixels = 4; ///< edge of the pictures; all pixels see the same

/// What stands in the slab and shines on it.
struct Case
{
  glm::dvec3 depth{ 1.0 }; ///< optical depth straight through
  glm::dvec3 albedo{ 1.0 };
  glm::dvec3 emission{ 0.0 }; ///< radiance per unit of length
  double anisotropy = 0.0;
  struct Sun
  {
    double zenith;  ///< degrees
    double azimuth; ///< degrees
    double diffuse = 1.0;
  };
  std::vector<Sun> suns;
  double sky = 0.0;   ///< radiance from all around
  double view = 25.0; ///< zenith angle of the eye, degrees
};

inline glm::dvec3 toward(const Case::Sun& sun)
{
  const double degree = pi / 180.0;
  return { std::sin(sun.zenith * degree) * std::cos(sun.azimuth * degree),
    std::sin(sun.zenith * degree) * std::sin(sun.azimuth * degree),
    std::cos(sun.zenith * degree) };
}

/// Single scattering and emission, as the eye above sees them; suns above the horizon.
inline Truth truth_of(const Case& what)
{
  Truth truth{ glm::dvec3(0.0), glm::dvec3(1.0) };
  const double eye = std::cos(what.view * pi / 180.0);
  const glm::dvec3 back(std::sin(what.view * pi / 180.0), 0.0, eye);
  for (int c = 0; c < 3; ++c)
  {
    const double tau = what.depth[c];
    const auto mean = [](double x) { return x > 0.0 ? -std::expm1(-x) / x : 1.0; };
    truth.transmittance[c] = std::exp(-tau / eye);
    truth.radiance[c] = what.emission[c] / eye * mean(tau / eye);
    for (const Case::Sun& sun : what.suns)
    {
      const glm::dvec3 to = toward(sun);
      const double cosine = -glm::dot(to, back); // travel to travel
      const double p = henyey_greenstein(what.anisotropy, cosine);
      truth.radiance[c] +=
        what.albedo[c] * pi * sun.diffuse * p * tau / eye * mean(tau * (1.0 / eye + 1.0 / to.z));
    }
  }
  return truth;
}

struct TransportSlab : Slab
{
  explicit TransportSlab(const Case& what)
    : Slab(glm::max(what.depth, glm::dvec3(1e-300)), width)
  {
    Volume& volume = scene.volumes[0];
    const double most = std::max({ what.depth.x, what.depth.y, what.depth.z });
    volume.density.extinction = 2.0 * most;
    volume.density.channels = most > 0.0 ? what.depth / most : glm::dvec3(1.0);
    medium().albedo = what.albedo;
    medium().emission = 2.0 * what.emission; // the density is ½
    if (what.anisotropy != 0.0)
    {
      medium().lobes = { { PhaseFunction::HenyeyGreenstein, 1.0, what.anisotropy } };
    }
    for (const Case::Sun& sun : what.suns)
    {
      add_sun(sun.zenith, sun.azimuth, glm::dvec3(sun.diffuse));
    }
    scene.sky.radiance = scene.sky.ground = glm::dvec3(what.sky);
    View view = look(what.view, 1e-3);
    view.parallel = true;
    view.far_plane = 30.0;
    scene.camera = view.camera(1.0);
  }
};

/// The same by VTK's objects.
struct MapperSlab
{
  vtkSmartPointer<vtkVolume> volume = vtkSmartPointer<vtkVolume>::New();
  vtkNew<vtkBrumeMedium> medium;
  vtkNew<vtkBrumeSky> sky;
  vtkNew<vtkCamera> camera;
  vtkNew<vtkLightCollection> lights;

  MapperSlab(const Case& what, vtkBrumeVolumeMapper* mapper)
  {
    vtkNew<vtkImageData> image;
    image->SetDimensions(3, 3, 5);
    image->SetSpacing(0.5 * width, 0.5 * width, 0.25);
    image->SetOrigin(-0.5 * width, -0.5 * width, 0.0);
    vtkNew<vtkFloatArray> values;
    values->SetNumberOfTuples(45);
    values->Fill(0.5);
    image->GetPointData()->SetScalars(values);
    mapper->SetInputDataObject(image);
    // Without any extinction the values would be classified.
    const double most = std::max({ what.depth.x, what.depth.y, what.depth.z });
    const glm::dvec3 extinction = most > 0.0 ? 2.0 * what.depth : glm::dvec3(1e-12);
    medium->SetExtinction(extinction.x, extinction.y, extinction.z);
    volume->GetProperty()->SetInterpolationTypeToLinear();
    medium->SetAlbedo(what.albedo.x, what.albedo.y, what.albedo.z);
    medium->SetEmission(2.0 * what.emission.x, 2.0 * what.emission.y, 2.0 * what.emission.z);
    medium->SetAnisotropy(what.anisotropy);
    mapper->SetMedium(medium);
    if (what.sky > 0.0)
    {
      sky->SetSkyRadiance(what.sky, what.sky, what.sky);
      sky->SetGroundRadiance(what.sky, what.sky, what.sky);
      mapper->SetSky(sky);
    }
    volume->SetMapper(mapper);
    vtkNew<vtkLight> off; // with no light at all there would be a headlight
    off->SwitchOff();
    lights->AddItem(off);
    for (const Case::Sun& sun : what.suns)
    {
      vtkNew<vtkLight> light;
      const glm::dvec3 to = toward(sun);
      light->SetLightTypeToSceneLight();
      light->SetPosition(to.x, to.y, to.z);
      light->SetFocalPoint(0.0, 0.0, 0.0);
      light->SetIntensity(sun.diffuse);
      lights->AddItem(light);
    }
    const double degree = pi / 180.0;
    camera->ParallelProjectionOn();
    camera->SetParallelScale(1e-3);
    camera->SetFocalPoint(0.0, 0.0, 0.5);
    camera->SetPosition(
      12.0 * std::sin(what.view * degree), 0.0, 0.5 + 12.0 * std::cos(what.view * degree));
    camera->SetViewUp(0.0, 1.0, 0.0);
    camera->SetClippingRange(0.1, 30.0);
  }
};

/// How a case is drawn, and how near to the truth that has to be.
struct Way
{
  std::string name;
  bool random = false;       ///< by paths: within standard errors
  bool scatters_once = true; ///< not: any number of times
  double bound = 0.0;        ///< of an error: relative, or of white for what chooses by a tolerance
  bool of_white = false;
  bool packets = false; ///< may be run with each SIMD target
  std::function<Film(const Case&)> draw;
  bool lattice = false; ///< light by nodes 0.05 apart
};

inline Film by_mapper(const Case& what, vtkBrumeVolumeMapper* mapper)
{
  MapperSlab slab(what, mapper);
  Film film(pixels, pixels);
  EXPECT_TRUE(mapper->RenderFilm(slab.volume, slab.camera, slab.lights, film));
  return film;
}

/// All of them. `paths` a pixel.
inline std::vector<Way> ways(int paths = 256)
{
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  paths /= 8; // errors are by their own scatter
#endif
  std::vector<Way> all;
  for (const auto& [name, shadows] : { std::pair{ "ray march (shadow rays)", ShadowMethod::Rays },
         { "ray march (light volume)", ShadowMethod::Volume },
         { "ray march (shadow functions)", ShadowMethod::Functions } })
  {
    const bool rays = shadows == ShadowMethod::Rays;
    all.push_back({ name,
      false,
      true,
      rays ? 1e-5 : 0.02,
      !rays,
      true,
      [shadows = shadows](const Case& what)
      {
        const TransportSlab slab(what);
        return by_marcher(shadows, 0.05, shadows == ShadowMethod::Rays ? 0.0 : 0.05)(
          slab.scene, pixels, pixels);
      },
      !rays });
  }
  all.push_back({ "reference",
    false,
    true,
    1e-5,
    false,
    false,
    [](const Case& what)
    {
      const double tolerance = what.suns.size() > 100 ? 1e-5 : 1e-7;
      return by_reference(tolerance)(TransportSlab(what).scene, pixels, pixels);
    } });
  all.push_back({ "path tracer",
    true,
    true,
    4.5,
    false,
    true,
    [paths](const Case& what)
    {
      PathSettings settings;
      settings.samples_per_pixel = paths;
      settings.most_scatterings = 1;
      return traced(TransportSlab(what).scene, settings, pixels, pixels);
    } });
  all.push_back({ "vtkBrumeRayMarchMapper",
    false,
    true,
    0.004,
    true,
    false,
    [](const Case& what)
    {
      vtkNew<vtkBrumeRayMarchMapper> mapper;
      if (what.suns.size() > 100)
      {
        // The choice of a step marches thousands of rays, whatever the picture's size.
        mapper->SetAutoAdjustSampleDistances(0);
        mapper->SetSampleDistance(0.05);
        mapper->SetShadowMethodToRays();
      }
      return by_mapper(what, mapper);
    } });
  all.push_back({ "vtkBrumePathTraceMapper",
    true,
    true,
    4.5,
    false,
    false,
    [paths](const Case& what)
    {
      vtkNew<vtkBrumePathTraceMapper> mapper;
      mapper->SetSamplesPerPixel(paths);
      mapper->SetMaximumScatterings(1);
      mapper->SetTolerance(0.0);
      return by_mapper(what, mapper);
    } });
  all.push_back({ "vtkBrumeSmartVolumeMapper",
    false,
    false,
    0.02,
    true,
    false,
    [](const Case& what)
    {
      vtkNew<vtkBrumeSmartVolumeMapper> mapper;
      mapper->SetTolerance(0.02);
      return by_mapper(what, mapper);
    } });
  return all;
}

}
