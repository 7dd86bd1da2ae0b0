// Lit props of VTK: a ball of voxels under each kind of light, and cubes of even matter.
#pragma once

#include "vtk_scenes.h"

#include "vtkBrumeMedium.h"
#include "vtkBrumeRayMarchMapper.h"
#include "vtkBrumeSky.h"

#include "vtkFloatArray.h"
#include "vtkLight.h"
#include "vtkLightCollection.h"
#include "vtkVolumeCollection.h"

#include <glm/vec3.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <utility>

namespace lit_props
{

using namespace vtk_scenes;
using brume::Film;

/// A ball in no light.
struct LitProp
{
  vtkSmartPointer<vtkVolume> volume = volume_of();
  vtkNew<vtkBrumeRayMarchMapper> mapper;
  vtkNew<vtkBrumeMedium> medium;
  vtkNew<vtkBrumeSky> sky;
  vtkNew<vtkCamera> camera;
  vtkNew<vtkLightCollection> lights;

  LitProp()
  {
    mapper->SetInputData(ball_image(VTK_UNSIGNED_CHAR));
    mapper->SetAutoAdjustSampleDistances(0);
    mapper->SetSampleDistance(0.5);
    mapper->SetMedium(medium);
    mapper->SetShadowMethodToVolume();
    medium->SetExtinction(4e-4, 5e-4, 6e-4); // the ball's values go to 200
    medium->SetAlbedo(0.9, 0.8, 0.9);
    medium->SetAnisotropy(0.4);
    volume->SetMapper(mapper);
    look_at(camera, volume->GetCenter(), 90.0);
    camera->SetClippingRange(20, 170);
  }
  vtkSmartPointer<vtkLight> light(double x, double y, double z)
  {
    auto light = vtkSmartPointer<vtkLight>::New();
    light->SetLightTypeToSceneLight();
    light->SetPosition(x, y, z);
    light->SetFocalPoint(volume->GetCenter());
    lights->AddItem(light);
    return light;
  }
  /// And in no other light.
  vtkBrumeSky* put_under_sky()
  {
    sky->SetSkyRadiance(0.3, 0.5, 0.9);
    sky->SetGroundRadiance(0.2, 0.1, 0.05);
    sky->SetUp(0, 1, 0);
    mapper->SetSky(sky);
    // No light at all would be a headlight for a film and none for a renderer.
    this->light(1, 2, 3)->SwitchOff();
    return sky;
  }
};

/// Dark below and light above.
inline vtkSmartPointer<vtkImageData> two_grey_map()
{
  auto map = vtkSmartPointer<vtkImageData>::New();
  map->SetDimensions(16, 8, 1);
  map->AllocateScalars(VTK_FLOAT, 3);
  for (int i = 0; i < 16 * 8 * 3; ++i)
  {
    static_cast<float*>(map->GetScalarPointer())[i] = i > 200 ? 0.6f : 0.1f;
  }
  return map;
}

/// The kinds of light that a renderer may have, each seen in the picture.
inline const std::pair<const char*, std::function<vtkSmartPointer<vtkLight>(LitProp&)>>
  kinds_of_light[] = {
    { "directional",
      [](LitProp& view)
      {
        auto light = view.light(80, 60, -40);
        light->SetIntensity(2.0);
        light->SetColor(1.0, 0.8, 0.5);
        return light;
      } },
    { "point",
      [](LitProp& view)
      {
        auto light = view.light(40, 30, 20);
        light->PositionalOn();
        light->SetConeAngle(180.0);
        light->SetAttenuationValues(0.0, 0.0, 2e-3);
        return light;
      } },
    { "point inside",
      [](LitProp& view)
      {
        auto light = view.light(15, 14, 17);
        light->SetFocalPoint(15, 14, 0);
        light->PositionalOn();
        light->SetConeAngle(180.0);
        light->SetAttenuationValues(0.0, 0.1, 1e-2);
        return light;
      } },
    { "spot",
      [](LitProp& view)
      {
        auto light = view.light(-30, 14, 40);
        light->PositionalOn();
        light->SetConeAngle(12.0);
        light->SetExponent(4.0);
        light->SetAttenuationValues(0.5, 0.01, 1e-4);
        light->SetColor(0.3, 1.0, 0.4);
        return light;
      } },
    { "headlight",
      [](LitProp& view)
      {
        auto light = view.light(0, 0, 0);
        light->SetLightTypeToHeadlight();
        return light;
      } },
    { "camera light",
      [](LitProp& view)
      {
        auto light = view.light(1, 0.5, 0.2);
        light->SetLightTypeToCameraLight();
        light->SetFocalPoint(0, 0, 0);
        return light;
      } },
  };

// A cube.
// ------------------------------------------------------------------------------------------

constexpr double edge = 16.0;
constexpr int size = 9; ///< of films; the middle pixel looks through the middle of the cube

/// A cube of density 1 from (0, 0, 0) to (16, 16, 16), and a temperature of 3 in "heat".
inline vtkSmartPointer<vtkImageData> cube_image()
{
  auto data = image(17, 17, 17, VTK_FLOAT, [](int, int, int, int) { return 1.0; });
  vtkNew<vtkFloatArray> heat;
  heat->SetName("heat");
  heat->SetNumberOfTuples(data->GetNumberOfPoints());
  heat->Fill(3.0);
  data->GetPointData()->AddArray(heat);
  return data;
}

/// Seen along −z in parallel projection.
struct Cube
{
  vtkSmartPointer<vtkVolume> volume = volume_of();
  vtkNew<vtkBrumeRayMarchMapper> mapper;
  vtkNew<vtkBrumeMedium> medium;
  vtkNew<vtkBrumeSky> sky;
  vtkNew<vtkCamera> camera;
  vtkNew<vtkLightCollection> lights;
  Film film{ size, size };

  Cube()
  {
    mapper->SetInputData(cube_image());
    mapper->SetMedium(medium);
    mapper->SetSky(sky);
    mapper->SetTolerance(1e-5);
    mapper->SetShadowMethodToRays();
    volume->SetMapper(mapper);
    camera->SetFocalPoint(edge / 2, edge / 2, edge / 2);
    camera->SetPosition(edge / 2, edge / 2, 50.0);
    camera->ParallelProjectionOn();
    camera->SetParallelScale(6.0);
    camera->SetClippingRange(1.0, 100.0);
    vtkNew<vtkLight> off; // with no light at all there would be a headlight
    off->SwitchOff();
    lights->AddItem(off);
  }
  vtkSmartPointer<vtkLight> add_light(double x, double y, double z)
  {
    auto light = vtkSmartPointer<vtkLight>::New();
    light->SetLightTypeToSceneLight();
    light->SetPosition(x, y, z);
    light->SetFocalPoint(edge / 2, edge / 2, edge / 2);
    lights->AddItem(light);
    return light;
  }
  /// The radiance of the middle pixel.
  glm::dvec3 radiance()
  {
    EXPECT_TRUE(mapper->RenderFilm(volume, camera, lights, film));
    const std::size_t middle = film.size() / 2;
    return { film.radiance[0][middle], film.radiance[1][middle], film.radiance[2][middle] };
  }
  double transmittance(int channel) { return film.transmittance[channel][film.size() / 2]; }

  // What it is in each test.

  vtkSmartPointer<vtkLight> light_from_the_front()
  {
    medium->SetExtinction(0.05, 0.1, 0.2);
    medium->SetAlbedo(1.0, 0.5, 0.25);
    auto light = add_light(edge / 2, edge / 2, 40.0);
    light->SetIntensity(2.0);
    light->SetColor(1.0, 0.8, 0.6);
    return light;
  }
  void light_from_three_sides(double sigma)
  {
    medium->SetExtinction(sigma);
    add_light(edge / 2, edge / 2, 90.0)->SetColor(1, 0, 0);
    add_light(90.0, edge / 2, edge / 2)->SetColor(0, 1, 0);
    add_light(edge / 2, edge / 2, -90.0)->SetColor(0, 0, 1);
  }
  vtkSmartPointer<vtkLight> add_lamp()
  {
    auto lamp = add_light(40.0, edge / 2, edge / 2);
    lamp->PositionalOn();
    lamp->SetConeAngle(180.0);
    lamp->SetAttenuationValues(0.5, 0.25, 0.125);
    return lamp;
  }
  void put_under_sky()
  {
    sky->SetSkyRadiance(1.0, 0.5, 0.0);
    sky->SetGroundRadiance(0.0, 0.5, 0.25);
  }
  /// And no sky.
  void put_under_a_map(double radiance)
  {
    sky->SetSkyRadiance(0, 0, 0);
    sky->SetGroundRadiance(0, 0, 0);
    vtkNew<vtkImageData> map;
    map->SetDimensions(32, 16, 1);
    map->AllocateScalars(VTK_FLOAT, 3);
    map->GetPointData()->GetScalars()->Fill(radiance);
    sky->SetEnvironmentMap(map);
  }
  void glow(double sigma)
  {
    medium->SetExtinction(sigma);
    medium->SetEmission(0.01, 0.02, 0.03);
  }
  void glow_of_heat()
  {
    medium->SetEmission(0.0);
    medium->SetBlackBody(0.01);
    medium->SetBlackBodyReference(1500.0);
    medium->SetTemperatureArrayName("heat");
    medium->SetTemperatureScale(600.0); // 3 · 600 kelvin
  }
  void classify()
  {
    vtkNew<vtkPiecewiseFunction> opacity;
    opacity->AddPoint(1.0, 1.0 - std::exp(-0.2));
    vtkNew<vtkColorTransferFunction> colour;
    colour->AddRGBPoint(1.0, 1.0, 0.5, 0.25);
    vtkVolumeProperty* property = volume->GetProperty();
    property->SetScalarOpacity(opacity);
    property->SetColor(colour);
    property->SetScalarOpacityUnitDistance(4.0); // σt = 0.05
    medium->SetAlbedo(0.9, 0.9, 0.5);
    add_light(edge / 2, edge / 2, 40.0);
  }
  void light_from_behind()
  {
    medium->SetExtinction(0.05);
    medium->SetAnisotropy(0.3);
    medium->SetNumberOfOctaves(3);
    add_light(edge / 2, edge / 2, -40.0);
  }
  void light_aslant()
  {
    medium->SetExtinction(0.05);
    add_light(edge, 30.0, 60.0);
  }
};

inline void put_at_the_camera(vtkLight* light)
{
  light->SetLightTypeToCameraLight();
  light->SetPosition(0, 0, 1);
  light->SetFocalPoint(0, 0, 0);
}

inline void make_spot(vtkLight* lamp)
{
  lamp->SetConeAngle(20.0);
  lamp->SetExponent(3.0);
}

/// Two cubes side by side along x, the first in the middle of the picture.
struct TwoCubes
{
  Cube first;
  Cube second;
  vtkNew<vtkVolumeCollection> volumes;

  TwoCubes(double sigma)
  {
    for (Cube* cube : { &first, &second })
    {
      cube->medium->SetExtinction(sigma);
      cube->mapper->SetSky(nullptr);
      volumes->AddItem(cube->volume);
    }
    second.volume->SetPosition(20.0, 0.0, 0.0);
  }
  glm::dvec3 radiance()
  {
    EXPECT_TRUE(first.mapper->RenderFilm(volumes, first.camera, first.lights, first.film));
    const std::size_t middle = first.film.size() / 2;
    return {
      first.film.radiance[0][middle], first.film.radiance[1][middle], first.film.radiance[2][middle]
    };
  }
};

}
