// Media in a window: under all kinds of lights the frame shows the film that is made without one.
#include "../support/lit_props.h"

#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkUnsignedCharArray.h"

#include <gtest/gtest.h>

#include <vector>

using namespace lit_props;
using brume::Film;

namespace
{

constexpr int size = 100;
/// A frame of 8 bits is dimmed and added to, and each of the two rounds what it reads, the product
/// and the result.
constexpr double rounding = 2.5;
const double background[3] = { 0.2, 0.1, 0.3 };

/// The same in a window.
struct View : LitProp
{
  vtkNew<vtkRenderer> renderer;
  vtkNew<vtkRenderWindow> window;

  View()
  {
    renderer->SetBackground(const_cast<double*>(background));
    renderer->AddVolume(volume);
    renderer->AutomaticLightCreationOff();
    renderer->SetActiveCamera(camera);
    renderer->SetLightCollection(lights);
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

TEST(LitWindow, EachKindOfLightIsThatOfTheFilm)
{
  for (const auto& [name, add] : kinds_of_light)
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
  for (const auto& [name, add] : kinds_of_light)
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
  vtkBrumeSky* const sky = view.put_under_sky();
  const Film even = view.film();
  EXPECT_GT(brightest(even), 0.05);
  EXPECT_LE(view.worst(even), rounding);
  sky->SetEnvironmentMap(two_grey_map());
  const Film more = view.film();
  EXPECT_GT(brightest(more), 1.2 * brightest(even));
  EXPECT_LE(view.worst(more), rounding);
}

}
