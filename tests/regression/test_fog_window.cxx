// Fog in a window: over meshes at their depth, and as one with volumes, whatever their order.
#include "../support/vtk_scenes.h"

#include "vtkBrumeFog.h"
#include "vtkBrumeMedium.h"
#include "vtkBrumeRayMarchMapper.h"
#include "vtkBrumeSky.h"

#include "vtkActor.h"
#include "vtkLight.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkSphereSource.h"
#include "vtkUnsignedCharArray.h"
#include "vtkVolumeCollection.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

using namespace vtk_scenes;
using brume::Film;

namespace
{

constexpr int size = 100;
/// A frame of 8 bits is dimmed and added to, and each of the two rounds what it reads, the product
/// and the result.
constexpr double rounding = 2.5;
const double background[3] = { 0.2, 0.5, 0.8 };

struct View
{
  vtkNew<vtkBrumeFog> fog;
  vtkSmartPointer<vtkVolume> volume = volume_of();
  vtkNew<vtkBrumeRayMarchMapper> mapper;
  vtkNew<vtkRenderer> renderer;
  vtkNew<vtkRenderWindow> window;

  View()
  {
    fog->SetExtinction(0.01, 0.006, 0.012);
    fog->SetFalloff(0.01);
    mapper->SetInputData(ball_image(VTK_UNSIGNED_CHAR));
    mapper->SetAutoAdjustSampleDistances(0);
    mapper->SetSampleDistance(0.5);
    volume->SetMapper(mapper);
    renderer->SetBackground(const_cast<double*>(background));
    vtkNew<vtkLight> sun;
    sun->SetLightTypeToSceneLight();
    sun->SetPosition(1.0, -0.5, 2.0);
    renderer->AddLight(sun);
    const double centre[3] = { 15.5, 14.0, 16.5 };
    look_at(renderer->GetActiveCamera(), centre, 90.0);
    renderer->GetActiveCamera()->SetClippingRange(20, 170);
    window->SetOffScreenRendering(1);
    window->SetMultiSamples(0);
    window->SetSize(size, size);
    window->AddRenderer(renderer);
  }

  std::vector<int> pixels()
  {
    window->Render();
    vtkNew<vtkUnsignedCharArray> bytes;
    window->GetPixelData(0, 0, size - 1, size - 1, 0, bytes);
    return std::vector<int>(
      bytes->GetPointer(0), bytes->GetPointer(0) + bytes->GetNumberOfValues());
  }

  Film film_with_volume()
  {
    mapper->SetFog(fog);
    Film film(size, size);
    EXPECT_TRUE(
      mapper->RenderFilm(volume, renderer->GetActiveCamera(), renderer->GetLights(), film));
    mapper->SetFog(nullptr);
    return film;
  }
  Film film_alone()
  {
    Film film(size, size);
    EXPECT_TRUE(fog->RenderFilm(renderer->GetActiveCamera(), renderer->GetLights(), film));
    return film;
  }
};

/// How far the bytes are from radiance + transmittance · background.
double worst(const std::vector<int>& bytes, const Film& film)
{
  double most = 0.0;
  for (std::size_t i = 0; i < film.size(); ++i)
  {
    for (int c = 0; c < 3; ++c)
    {
      const double truth = 255.0 *
        (film.radiance[c][i] + film.transmittance[c][i] * std::round(255.0 * background[c]) / 255.0);
      most = std::max(most, std::abs(bytes[3 * i + c] - std::min(truth, 255.0)));
    }
  }
  return most;
}

int at(const std::vector<int>& bytes, int x, int y, int c)
{
  return bytes[3 * (static_cast<std::size_t>(y) * size + x) + c];
}

TEST(FogWindow, ShowsTheFilmOverTheBackground)
{
  View view;
  view.renderer->AddViewProp(view.fog);
  EXPECT_LE(worst(view.pixels(), view.film_alone()), rounding);
  view.fog->VisibilityOff();
  Film nothing(size, size);
  EXPECT_LE(worst(view.pixels(), nothing), rounding);
}

// Black smoke before a ball: what of its colour is left tells how far away it is.
TEST(FogWindow, EndsAtSurfaces)
{
  View view;
  view.fog->SetExtinction(0.01);
  view.fog->SetFalloff(0.0);
  view.fog->SetAlbedo(0.0);
  view.renderer->AddViewProp(view.fog);
  vtkNew<vtkSphereSource> source;
  source->SetThetaResolution(60);
  source->SetPhiResolution(60);
  vtkNew<vtkPolyDataMapper> polygons;
  polygons->SetInputConnection(source->GetOutputPort());
  vtkNew<vtkActor> ball;
  ball->SetMapper(polygons);
  ball->GetProperty()->LightingOff();
  ball->GetProperty()->SetColor(1.0, 0.8, 0.6);
  view.renderer->AddActor(ball);
  vtkCamera* camera = view.renderer->GetActiveCamera();
  for (bool parallel : { false, true })
  {
    camera->SetParallelProjection(parallel);
    camera->SetParallelScale(20.0);
    for (double radius : { 5.0, 15.0 })
    {
      source->SetCenter(camera->GetFocalPoint());
      source->SetRadius(radius);
      const std::vector<int> bytes = view.pixels();
      // In front of the ball's middle; parallel rays begin on the near plane.
      const double way = camera->GetDistance() - radius - (parallel ? 20.0 : 0.0);
      const double passes = std::exp(-0.01 * way);
      EXPECT_NEAR(at(bytes, size / 2, size / 2, 0), 255.0 * passes, rounding) << radius;
      EXPECT_NEAR(at(bytes, size / 2, size / 2, 1), 204.0 * passes, rounding) << radius;
      // Beside it the fog has no end.
      EXPECT_EQ(at(bytes, 2, 2, 0), 0) << radius;
    }
  }
}

TEST(FogWindow, IsOneWithAVolumeWhateverTheirOrder)
{
  for (bool lit : { false, true })
  {
    std::array<std::vector<int>, 2> frames;
    for (int order = 0; order < 2; ++order)
    {
      View view;
      vtkNew<vtkBrumeMedium> medium;
      medium->SetAlbedo(0.9);
      if (lit)
      {
        view.mapper->SetMedium(medium);
        view.mapper->SetShadowMethodToVolume();
      }
      if (order == 0)
      {
        view.renderer->AddViewProp(view.fog);
      }
      view.renderer->AddVolume(view.volume);
      if (order == 1)
      {
        view.renderer->AddViewProp(view.fog);
      }
      frames[order] = view.pixels();
      const Film film = view.film_with_volume();
      const Film alone = view.film_alone();
      EXPECT_GT(difference(film, alone), 0.02) << lit;
      EXPECT_LE(worst(frames[order], film), rounding) << lit << order;
      // And again: each frame begins anew.
      EXPECT_EQ(frames[order], view.pixels()) << lit << order;
      // Without the volume the fog is drawn by itself, also where the volume is out of sight.
      view.volume->VisibilityOff();
      EXPECT_LE(worst(view.pixels(), alone), rounding) << lit << order;
      view.volume->VisibilityOn();
      view.volume->SetPosition(1e4, 0.0, 0.0);
      EXPECT_LE(worst(view.pixels(), alone), rounding) << lit << order;
    }
    EXPECT_EQ(frames[0], frames[1]) << lit;
  }
}

TEST(FogWindow, JoinsVolumesThatDoNotMeet)
{
  View view;
  view.fog->SetFalloff(0.0);
  auto second = volume_of();
  vtkNew<vtkBrumeRayMarchMapper> mapper;
  mapper->SetInputData(ball_image(VTK_UNSIGNED_CHAR));
  mapper->SetAutoAdjustSampleDistances(0);
  mapper->SetSampleDistance(0.5);
  second->SetMapper(mapper);
  second->SetPosition(-45.0, 35.0, -82.0); // behind the first
  view.renderer->AddVolume(second);
  view.renderer->AddViewProp(view.fog);
  view.renderer->AddVolume(view.volume);
  view.renderer->GetActiveCamera()->SetClippingRange(20, 400);
  const std::vector<int> bytes = view.pixels();
  vtkNew<vtkVolumeCollection> both;
  both->AddItem(view.volume);
  both->AddItem(second);
  view.mapper->SetFog(view.fog);
  Film film(size, size);
  ASSERT_TRUE(view.mapper->RenderFilm(
    both, view.renderer->GetActiveCamera(), view.renderer->GetLights(), film));
  EXPECT_LE(worst(bytes, film), rounding);
}

TEST(FogWindow, DoesNotJoinOtherBlendModes)
{
  View view;
  view.mapper->SetBlendModeToMaximumIntensity();
  view.renderer->AddVolume(view.volume);
  view.renderer->AddViewProp(view.fog);
  const std::vector<int> bytes = view.pixels();
  // The fog lies over the finished volume.
  Film volume(size, size);
  ASSERT_TRUE(view.mapper->RenderFilm(
    view.volume, view.renderer->GetActiveCamera(), view.renderer->GetLights(), volume));
  Film both = view.film_alone();
  for (int c = 0; c < 3; ++c)
  {
    for (std::size_t i = 0; i < both.size(); ++i)
    {
      both.radiance[c][i] += both.transmittance[c][i] * volume.radiance[c][i];
      both.transmittance[c][i] *= volume.transmittance[c][i];
    }
  }
  EXPECT_LE(worst(bytes, both), 2.0 * rounding);
}

TEST(FogWindow, ItsSkyLightsTheVolumeToo)
{
  View view;
  vtkNew<vtkBrumeMedium> medium;
  view.mapper->SetMedium(medium);
  view.fog->SetExtinction(1e-9); // all but none
  const Film without = view.film_with_volume();
  vtkNew<vtkBrumeSky> sky;
  sky->SetSkyRadiance(1.0, 1.0, 1.0);
  view.fog->SetSky(sky);
  const Film with = view.film_with_volume();
  double more = 0.0;
  for (std::size_t i = 0; i < with.size(); ++i)
  {
    EXPECT_GE(with.radiance[0][i], without.radiance[0][i] - 1e-5f);
    more = std::max(more, double(with.radiance[0][i] - without.radiance[0][i]));
  }
  EXPECT_GT(more, 0.1);
}

TEST(FogSettings, AreCheckedAndReported)
{
  vtkNew<vtkBrumeFog> fog;
  vtkObject::GlobalWarningDisplayOff();
  fog->SetExtinction(-1.0, 2.0, std::nan(""));
  EXPECT_EQ(fog->GetExtinction()[1], 0.001);
  fog->SetExtinction(-1.0, 2.0, 3.0);
  EXPECT_EQ(fog->GetExtinction()[0], 0.0);
  fog->SetAlbedo(1.5);
  EXPECT_EQ(fog->GetAlbedo()[2], 1.0);
  fog->SetFalloff(-1.0);
  EXPECT_EQ(fog->GetFalloff(), 0.0);
  fog->SetBaseHeight(std::numeric_limits<double>::infinity());
  EXPECT_EQ(fog->GetBaseHeight(), 0.0);
  fog->SetAnisotropy(0.5);
  EXPECT_EQ(fog->GetAnisotropy(), 0.5);
  EXPECT_EQ(fog->GetNumberOfLobes(), 1);
  fog->AddRayleighLobe(0.0);
  EXPECT_EQ(fog->GetNumberOfLobes(), 1);
  fog->AddRayleighLobe(1.0);
  EXPECT_EQ(fog->GetNumberOfLobes(), 2);
  EXPECT_EQ(fog->GetAnisotropy(), 0.25);
  fog->RemoveAllLobes();
  EXPECT_EQ(fog->GetNumberOfLobes(), 0);
  Film film(4, 4);
  EXPECT_FALSE(fog->RenderFilm(nullptr, nullptr, film));
  vtkObject::GlobalWarningDisplayOn();
  EXPECT_EQ(fog->GetBounds(), nullptr);
  const vtkMTimeType before = fog->GetRedrawMTime();
  vtkNew<vtkBrumeSky> sky;
  fog->SetSky(sky);
  EXPECT_GT(fog->GetRedrawMTime(), before);
  const vtkMTimeType then = fog->GetRedrawMTime();
  sky->SetSkyRadiance(1.0, 1.0, 1.0);
  EXPECT_GT(fog->GetRedrawMTime(), then);
}

}
