// Media in a window: under all kinds of lights the frame shows the film that is made without one.
#include "../support/vtk_scenes.h"

#include "vtkBrumeMedium.h"
#include "vtkBrumeRayMarchMapper.h"
#include "vtkBrumeSky.h"

#include "vtkLight.h"
#include "vtkLightCollection.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkUnsignedCharArray.h"

#include <gtest/gtest.h>

#include <functional>
#include <vector>

using namespace vtk_scenes;
using brume::Film;

namespace
{

constexpr int size = 100;
/// A frame of 8 bits is dimmed and added to, and each of the two rounds what it reads, the product
/// and the result.
constexpr double rounding = 2.5;
const double background[3] = { 0.2, 0.1, 0.3 };

struct View
{
  vtkSmartPointer<vtkVolume> volume = volume_of();
  vtkNew<vtkBrumeRayMarchMapper> mapper;
  vtkNew<vtkBrumeMedium> medium;
  vtkNew<vtkRenderer> renderer;
  vtkNew<vtkRenderWindow> window;

  View()
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
    renderer->SetBackground(const_cast<double*>(background));
    renderer->AddVolume(volume);
    renderer->AutomaticLightCreationOff();
    look_at(renderer->GetActiveCamera(), volume->GetCenter(), 90.0);
    renderer->GetActiveCamera()->SetClippingRange(20, 170);
    window->SetOffScreenRendering(1);
    window->SetMultiSamples(0);
    window->SetSize(size, size);
    window->AddRenderer(renderer);
  }
  vtkSmartPointer<vtkLight> light(double x, double y, double z)
  {
    auto light = vtkSmartPointer<vtkLight>::New();
    light->SetLightTypeToSceneLight();
    light->SetPosition(x, y, z);
    light->SetFocalPoint(volume->GetCenter());
    renderer->AddLight(light);
    return light;
  }
  Film film()
  {
    Film film(size, size);
    EXPECT_TRUE(
      mapper->RenderFilm(volume, renderer->GetActiveCamera(), renderer->GetLights(), film));
    return film;
  }
  /// How far the frame is from radiance + transmittance · background.
  double worst(const Film& film)
  {
    window->Render();
    vtkNew<vtkUnsignedCharArray> bytes;
    window->GetPixelData(0, 0, size - 1, size - 1, 0, bytes);
    double most = 0.0;
    for (std::size_t i = 0; i < film.size(); ++i)
    {
      for (int c = 0; c < 3; ++c)
      {
        const double behind = std::round(255.0 * background[c]);
        const double truth = 255.0 * film.radiance[c][i] + film.transmittance[c][i] * behind;
        most = std::max(most, std::abs(bytes->GetValue(3 * i + c) - std::min(truth, 255.0)));
      }
    }
    return most;
  }
};

double brightest(const Film& film)
{
  return *std::max_element(film.radiance[1].begin(), film.radiance[1].end());
}

/// The kinds of light that a renderer may have, each seen in the picture.
const std::pair<const char*, std::function<vtkSmartPointer<vtkLight>(View&)>> kinds[] = {
  { "directional",
    [](View& view)
    {
      auto light = view.light(80, 60, -40);
      light->SetIntensity(2.0);
      light->SetColor(1.0, 0.8, 0.5);
      return light;
    } },
  { "point",
    [](View& view)
    {
      auto light = view.light(40, 30, 20);
      light->PositionalOn();
      light->SetConeAngle(180.0);
      light->SetAttenuationValues(0.0, 0.0, 2e-3);
      return light;
    } },
  { "point inside",
    [](View& view)
    {
      auto light = view.light(15, 14, 17);
      light->SetFocalPoint(15, 14, 0);
      light->PositionalOn();
      light->SetConeAngle(180.0);
      light->SetAttenuationValues(0.0, 0.1, 1e-2);
      return light;
    } },
  { "spot",
    [](View& view)
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
    [](View& view)
    {
      auto light = view.light(0, 0, 0);
      light->SetLightTypeToHeadlight();
      return light;
    } },
  { "camera light",
    [](View& view)
    {
      auto light = view.light(1, 0.5, 0.2);
      light->SetLightTypeToCameraLight();
      light->SetFocalPoint(0, 0, 0);
      return light;
    } },
};

TEST(LitWindow, EachKindOfLightIsThatOfTheFilm)
{
  for (const auto& [name, add] : kinds)
  {
    SCOPED_TRACE(name);
    View view;
    const auto light = add(view);
    const Film film = view.film();
    EXPECT_GT(brightest(film), 0.02);
    EXPECT_GT(most_opaque(film), 0.5);
    EXPECT_LE(view.worst(film), rounding);
    // The camera goes elsewhere: lights of the scene stay, the camera's come along.
    view.renderer->GetActiveCamera()->Azimuth(50);
    const Film moved = view.film();
    EXPECT_GT(difference(film, moved), 0.01);
    EXPECT_LE(view.worst(moved), rounding);
    light->SwitchOff();
    const Film dark = view.film();
    EXPECT_EQ(brightest(dark), 0.0);
    EXPECT_LE(view.worst(dark), rounding);
  }
}

TEST(LitWindow, AllLightsTogetherAreTheirSum)
{
  std::vector<double> sum(3 * size * size, 0.0);
  const auto add_up = [&](const Film& film, double factor)
  {
    for (int c = 0; c < 3; ++c)
    {
      for (std::size_t i = 0; i < film.size(); ++i)
      {
        sum[c * film.size() + i] += factor * film.radiance[c][i];
      }
    }
  };
  View all;
  for (const auto& [name, add] : kinds)
  {
    View alone;
    add(alone);
    add(all);
    add_up(alone.film(), 1.0);
  }
  const Film film = all.film();
  EXPECT_LE(all.worst(film), rounding);
  add_up(film, -1.0);
  double most = 0.0;
  for (double left : sum)
  {
    most = std::max(most, std::abs(left));
  }
  // Rays are left, and shadows quantised, for each by itself.
  EXPECT_LT(most, 0.004 * 6);
}

TEST(LitWindow, SkyAndEnvironmentLightTheFrameToo)
{
  View view;
  vtkNew<vtkBrumeSky> sky;
  sky->SetSkyRadiance(0.3, 0.5, 0.9);
  sky->SetGroundRadiance(0.2, 0.1, 0.05);
  sky->SetUp(0, 1, 0);
  vtkNew<vtkImageData> map;
  map->SetDimensions(16, 8, 1);
  map->AllocateScalars(VTK_FLOAT, 3);
  for (int i = 0; i < 16 * 8 * 3; ++i)
  {
    static_cast<float*>(map->GetScalarPointer())[i] = i > 200 ? 0.6f : 0.1f;
  }
  view.mapper->SetSky(sky);
  // No light at all would be a headlight for a film and none for a renderer.
  view.light(1, 2, 3)->SwitchOff();
  const Film even = view.film();
  EXPECT_GT(brightest(even), 0.05);
  EXPECT_LE(view.worst(even), rounding);
  sky->SetEnvironmentMap(map);
  const Film more = view.film();
  EXPECT_GT(brightest(more), 1.2 * brightest(even));
  EXPECT_LE(view.worst(more), rounding);
}

}
