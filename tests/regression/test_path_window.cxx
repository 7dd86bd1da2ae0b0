// Path tracing in a window: pictures that refine while nothing changes, fog, and an environment
// map.
#include "../support/vtk_scenes.h"

#include "vtkBrumeFog.h"
#include "vtkBrumeMedium.h"
#include "vtkBrumePathTraceMapper.h"
#include "vtkBrumeSky.h"

#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkLight.h"
#include "vtkLightCollection.h"
#include "vtkPointData.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkUnsignedCharArray.h"

#include <nlohmann/json.hpp>

#include <gtest/gtest.h>

#include <vector>

using namespace vtk_scenes;
using brume::Film;

namespace
{

constexpr int size = 48;

struct View
{
  vtkSmartPointer<vtkVolume> volume = volume_of();
  vtkNew<vtkBrumePathTraceMapper> mapper;
  vtkNew<vtkBrumeMedium> medium;
  vtkNew<vtkRenderer> renderer;
  vtkNew<vtkRenderWindow> window;
  vtkNew<vtkLight> light;

  View()
  {
    mapper->SetInputData(ball_image(VTK_UNSIGNED_CHAR));
    mapper->SetMedium(medium);
    mapper->SetTolerance(0.0);
    mapper->SetSamplesPerPixel(12);
    medium->SetExtinction(4e-4, 5e-4, 6e-4); // the ball's values go to 200
    medium->SetAlbedo(0.9, 0.8, 0.9);
    medium->SetAnisotropy(0.4);
    volume->SetMapper(mapper);
    renderer->AddVolume(volume);
    renderer->AutomaticLightCreationOff();
    light->SetLightTypeToSceneLight();
    light->SetPosition(80, 60, -40);
    light->SetFocalPoint(volume->GetCenter());
    renderer->AddLight(light);
    look_at(renderer->GetActiveCamera(), volume->GetCenter(), 90.0);
    renderer->GetActiveCamera()->SetClippingRange(20, 170);
    window->SetOffScreenRendering(1);
    window->SetMultiSamples(0);
    window->SetSize(size, size);
    window->AddRenderer(renderer);
  }
  Film film()
  {
    Film film(size, size);
    EXPECT_TRUE(
      mapper->RenderFilm(volume, renderer->GetActiveCamera(), renderer->GetLights(), film));
    return film;
  }
  std::vector<unsigned char> frame()
  {
    window->Render();
    vtkNew<vtkUnsignedCharArray> bytes;
    window->GetPixelData(0, 0, size - 1, size - 1, 0, bytes);
    return { bytes->GetPointer(0), bytes->GetPointer(0) + bytes->GetNumberOfValues() };
  }
};

bool same_bits(const Film& a, const Film& b)
{
  bool same = a.error == b.error && a.depth == b.depth;
  for (int c = 0; c < 3; ++c)
  {
    same = same && a.radiance[c] == b.radiance[c] && a.transmittance[c] == b.transmittance[c];
  }
  return same;
}

double sum_of(const Film& film)
{
  double sum = 0.0;
  for (float v : film.radiance[1])
  {
    sum += v;
  }
  return sum;
}

}

// Three renders of four paths are one of twelve, bit for bit, and whatever changes begins anew.
TEST(PathWindow, RefinesWhileNothingChanges)
{
  View whole;
  const Film once = whole.film();
  EXPECT_EQ(whole.mapper->GetRenderedSamplesPerPixel(), 12);
  View view;
  view.mapper->SetSamplesPerRender(4);
  Film film(size, size);
  for (int n = 1; n <= 3; ++n)
  {
    film = view.film();
    EXPECT_EQ(view.mapper->GetRenderedSamplesPerPixel(), 4 * n);
    EXPECT_EQ(same_bits(once, film), n == 3);
  }
  film = view.film(); // has all that are asked for
  EXPECT_EQ(view.mapper->GetRenderedSamplesPerPixel(), 12);
  EXPECT_TRUE(same_bits(once, film));

  const auto begins_anew = [&](const char* what)
  {
    view.film();
    EXPECT_EQ(view.mapper->GetRenderedSamplesPerPixel(), 4) << what;
    view.film();
    EXPECT_EQ(view.mapper->GetRenderedSamplesPerPixel(), 8) << what;
  };
  view.renderer->GetActiveCamera()->Azimuth(1.0);
  begins_anew("camera");
  view.light->SetIntensity(0.9);
  begins_anew("intensity");
  view.light->SetPosition(80, 61, -40);
  begins_anew("light");
  view.medium->SetAlbedo(0.8, 0.8, 0.9);
  begins_anew("medium");
  view.volume->SetPosition(0.5, 0.0, 0.0);
  begins_anew("place");
  view.mapper->SetSeed(7);
  begins_anew("seed");
  view.mapper->SetCropping(1);
  view.mapper->SetCroppingRegionPlanes(5, 20, 5, 20, 5, 20);
  begins_anew("cropping");
  static_cast<vtkImageData*>(view.mapper->GetInputDataObject(0, 0))
    ->GetPointData()
    ->GetScalars()
    ->Modified();
  static_cast<vtkImageData*>(view.mapper->GetInputDataObject(0, 0))->Modified();
  begins_anew("voxels");
  view.mapper->SetSurfaceDepth(std::vector<float>(size * size, 0.9f));
  begins_anew("surfaces");
}

TEST(PathWindow, FramesRefineToo)
{
  View whole;
  const std::vector<unsigned char> once = whole.frame();
  View view;
  view.mapper->SetSamplesPerRender(4);
  const std::vector<unsigned char> first = view.frame();
  EXPECT_EQ(view.mapper->GetRenderedSamplesPerPixel(), 4);
  EXPECT_NE(first, once);
  view.frame();
  EXPECT_EQ(view.frame(), once);
  EXPECT_EQ(view.mapper->GetRenderedSamplesPerPixel(), 12);
  view.window->SetSize(size + 2, size);
  view.window->Render();
  EXPECT_EQ(view.mapper->GetRenderedSamplesPerPixel(), 4);
}

// A vtkBrumeFog in the renderer is traced with the volume.
TEST(PathWindow, TracesFog)
{
  View view;
  const std::vector<unsigned char> clear = view.frame();
  vtkNew<vtkBrumeFog> fog;
  fog->SetExtinction(0.01, 0.01, 0.01);
  fog->SetFalloff(0.02);
  view.renderer->AddViewProp(fog);
  EXPECT_NE(view.frame(), clear);
  const auto statistics = nlohmann::json::parse(view.mapper->GetStatistics());
  bool on = false;
  for (const auto& effect : statistics["effects"])
  {
    on |= effect["name"] == "fog" && effect["on"] == true;
  }
  EXPECT_TRUE(on);
}

// The map lights the ball itself: its directional lights are not there a second time, and their
// number does not matter.
TEST(PathWindow, TakesEnvironmentMapsAsTheyAre)
{
  View view;
  view.light->SwitchOff();
  EXPECT_EQ(sum_of(view.film()), 0.0);
  vtkNew<vtkImageData> map;
  map->SetDimensions(16, 8, 1);
  vtkNew<vtkFloatArray> pixels;
  pixels->SetNumberOfComponents(3);
  pixels->SetNumberOfTuples(16 * 8);
  pixels->Fill(0.5);
  map->GetPointData()->SetScalars(pixels);
  vtkNew<vtkBrumeSky> sky;
  sky->SetEnvironmentMap(map);
  view.mapper->SetSky(sky);
  const Film of_map = view.film();
  sky->SetNumberOfEnvironmentLights(3);
  EXPECT_TRUE(same_bits(view.film(), of_map));
  // As bright as a sky of the same radiance all around.
  sky->SetEnvironmentMap(nullptr);
  sky->SetSkyRadiance(0.5, 0.5, 0.5);
  sky->SetGroundRadiance(0.5, 0.5, 0.5);
  EXPECT_NEAR(sum_of(of_map) / sum_of(view.film()), 1.0, 0.02);
}
