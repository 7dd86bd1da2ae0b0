// The mapper in a window: blending, geometry, viewports, abort, and windows that come and go.
#include "../support/vtk_scenes.h"

#include "vtkBrumeRayMarchMapper.h"

#include "Transport/marcher.h"

#include "vtkActor.h"
#include "vtkCallbackCommand.h"
#include "vtkCommand.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkSphereSource.h"
#include "vtkUnsignedCharArray.h"

#include <gtest/gtest.h>

#include <vector>

using namespace vtk_scenes;
using brume::Film;

namespace
{

constexpr int size = 100;
/// A frame of 8 bits is blended by rounding the source, 1 − A and the product by half a level each.
constexpr double rounding = 1.5;
const double background[3] = { 0.2, 0.5, 0.8 };

struct View
{
  vtkSmartPointer<vtkVolume> volume = volume_of(0.3);
  vtkNew<vtkBrumeRayMarchMapper> mapper;
  vtkNew<vtkRenderer> renderer;
  vtkNew<vtkActor> sphere;

  explicit View(bool with_volume = true)
  {
    mapper->SetInputData(ball_image(VTK_UNSIGNED_CHAR));
    mapper->SetAutoAdjustSampleDistances(0);
    mapper->SetSampleDistance(0.5);
    volume->SetMapper(mapper);
    renderer->SetBackground(const_cast<double*>(background));
    if (with_volume)
    {
      renderer->AddVolume(volume);
    }
    const double centre[3] = { 15.5, 14.0, 16.5 };
    look_at(renderer->GetActiveCamera(), centre, 90.0);
    renderer->GetActiveCamera()->SetClippingRange(20, 170);
  }
  void add_sphere(double x, double y, double z, double radius)
  {
    vtkNew<vtkSphereSource> source;
    source->SetCenter(x, y, z);
    source->SetRadius(radius);
    source->SetThetaResolution(40);
    source->SetPhiResolution(40);
    vtkNew<vtkPolyDataMapper> polygons;
    polygons->SetInputConnection(source->GetOutputPort());
    sphere->SetMapper(polygons);
    sphere->GetProperty()->LightingOff();
    sphere->GetProperty()->SetColor(0.1, 0.9, 0.3);
    renderer->AddActor(sphere);
  }
};

vtkSmartPointer<vtkRenderWindow> window_of(int width, int height)
{
  auto window = vtkSmartPointer<vtkRenderWindow>::New();
  window->SetOffScreenRendering(1);
  window->SetMultiSamples(0);
  window->SetSize(width, height);
  return window;
}

std::vector<int> pixels(vtkRenderWindow* window, int x0, int x1, int y1 = size - 1)
{
  vtkNew<vtkUnsignedCharArray> bytes;
  window->GetPixelData(x0, 0, x1, y1, 0, bytes);
  return std::vector<int>(bytes->GetPointer(0), bytes->GetPointer(0) + bytes->GetNumberOfValues());
}

/// How far the bytes are from radiance + transmittance · behind.
double worst(const std::vector<int>& bytes, const Film& film, const std::vector<int>* behind)
{
  double most = 0.0;
  for (std::size_t i = 0; i < film.size(); ++i)
    for (int c = 0; c < 3; ++c)
    {
      const double frame = behind ? (*behind)[3 * i + c] : std::round(255.0 * background[c]);
      const double truth =
        255.0 * film.radiance[c][i] + film.transmittance[c][i] * frame;
      most = std::max(most, std::abs(bytes[3 * i + c] - std::min(truth, 255.0)));
    }
  return most;
}

Film film_of(View& view, int width = size, int height = size)
{
  Film film(width, height);
  EXPECT_TRUE(view.mapper->RenderFilm(
    view.volume, view.renderer->GetActiveCamera(), view.renderer->GetLights(), film));
  return film;
}

TEST(Window, ShowsTheFilmOverTheBackground)
{
  for (int samples : { 0, 8 })
  {
    View view;
    const auto window = window_of(size, size);
    window->SetMultiSamples(samples);
    window->AddRenderer(view.renderer);
    window->Render();
    const Film film = film_of(view);
    EXPECT_GT(most_opaque(film), 0.5);
    EXPECT_LE(worst(pixels(window, 0, size - 1), film, nullptr), rounding) << samples;
  }
}

TEST(Window, EveryViewportHasItsPicture)
{
  View left, right;
  const auto window = window_of(2 * size, size);
  left.renderer->SetViewport(0, 0, 0.5, 1);
  right.renderer->SetViewport(0.5, 0, 1, 1);
  right.renderer->GetActiveCamera()->Azimuth(70);
  right.renderer->ResetCameraClippingRange();
  window->AddRenderer(left.renderer);
  window->AddRenderer(right.renderer);
  window->Render();
  EXPECT_LE(worst(pixels(window, 0, size - 1), film_of(left), nullptr), rounding);
  EXPECT_LE(worst(pixels(window, size, 2 * size - 1), film_of(right), nullptr), rounding);
}

// A sphere that the volume cuts, one in front and one behind: the volume stops at it.
TEST(Window, StopsAtOpaqueGeometry)
{
  const double places[][3] = { { 15.5, 14.0, 16.5 }, { 35.0, 0.0, 55.0 }, { -5.0, 30.0, -20.0 } };
  for (const double* p : places)
  {
    View view;
    view.add_sphere(p[0], p[1], p[2], 7.0);
    View alone(false);
    alone.add_sphere(p[0], p[1], p[2], 7.0);
    const auto window = window_of(size, size);
    const auto bare = window_of(size, size);
    window->AddRenderer(view.renderer);
    bare->AddRenderer(alone.renderer);
    window->Render();
    bare->Render();
    std::vector<float> depth(size * size);
    bare->GetZbufferData(0, 0, size - 1, size - 1, depth.data());
    alone.renderer->GetActiveCamera()->DeepCopy(view.renderer->GetActiveCamera());
    // The truth: rays cut at the sphere's depths, over the frame without the volume.
    const brume::Scene* updated = view.mapper->UpdateScene(view.volume,
      view.renderer->GetActiveCamera(), view.renderer->GetLights(), size, size);
    ASSERT_NE(updated, nullptr);
    brume::Scene scene = *updated;
    for (float& d : depth)
    {
      scene.surface_depth.push_back(2.0f * d - 1.0f);
    }
    Film film(size, size);
    brume::Marcher marcher;
    brume::MarchSettings settings;
    settings.step = 0.5;
    marcher.render(scene, settings, film);
    const std::vector<int> behind = pixels(bare, 0, size - 1);
    EXPECT_LE(worst(pixels(window, 0, size - 1), film, &behind), rounding);
    // And it matters.
    const Film uncut = film_of(view);
    EXPECT_GT(difference(film, uncut) + (p[0] < 0 ? 1.0 : 0.0), 0.1);
  }
}

TEST(Window, TwoVolumesAreBothThere)
{
  View view;
  auto second = volume_of(0.3);
  vtkNew<vtkBrumeRayMarchMapper> mapper;
  mapper->SetInputData(ball_image(VTK_SHORT));
  second->SetMapper(mapper);
  second->SetPosition(0, 18, 0);
  const auto window = window_of(size, size);
  window->AddRenderer(view.renderer);
  window->Render();
  const std::vector<int> one = pixels(window, 0, size - 1);
  view.renderer->AddVolume(second);
  window->Render();
  EXPECT_NE(one, pixels(window, 0, size - 1));
}

TEST(Window, SurvivesReleaseAndAnotherWindow)
{
  View view;
  std::vector<int> first;
  {
    const auto window = window_of(size, size);
    window->AddRenderer(view.renderer);
    window->Render();
    first = pixels(window, 0, size - 1);
    view.mapper->ReleaseGraphicsResources(window);
    window->Render();
    EXPECT_EQ(first, pixels(window, 0, size - 1));
    window->RemoveRenderer(view.renderer);
  }
  const auto window = window_of(size, size);
  window->AddRenderer(view.renderer);
  window->Render();
  EXPECT_EQ(first, pixels(window, 0, size - 1));
  window->SetSize(size / 2, size); // another size of picture
  window->Render();
  EXPECT_LE(
    worst(pixels(window, 0, size / 2 - 1), film_of(view, size / 2, size), nullptr), rounding);
}

TEST(Window, AbortsWhenTheWindowSaysSo)
{
  View view;
  const auto window = window_of(size, size);
  window->AddRenderer(view.renderer);
  vtkNew<vtkCallbackCommand> abort;
  abort->SetCallback([](vtkObject* caller, unsigned long, void*, void*)
    { static_cast<vtkRenderWindow*>(caller)->SetAbortRender(1); });
  const unsigned long tag = window->AddObserver(vtkCommand::AbortCheckEvent, abort);
  window->Render();
  for (int byte : pixels(window, 0, size - 1))
  {
    // Only the background is there.
    ASSERT_TRUE(byte == 51 || byte == 127 || byte == 128 || byte == 204) << byte;
  }
  window->RemoveObserver(tag);
  window->Render();
  EXPECT_LE(worst(pixels(window, 0, size - 1), film_of(view), nullptr), rounding);
}

TEST(Window, LeavesTheMappersSettingsAlone)
{
  View view;
  view.renderer->TwoSidedLightingOff();
  const auto window = window_of(size, size);
  window->AddRenderer(view.renderer);
  window->Render();
  EXPECT_TRUE(view.mapper->GetTwoSidedLighting());
}

}
