// Speed and quality in a window: coarser pictures while something moves, whole ones when it rests,
// several rays a pixel, volumes that are drawn as one.
#include "../support/vtk_scenes.h"

#include "vtkBrumeRayMarchMapper.h"

#include "vtkActor.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkSphereSource.h"
#include "vtkUnsignedCharArray.h"
#include "vtkVolumeCollection.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <vector>

using namespace vtk_scenes;
using brume::Film;

namespace
{

constexpr int size = 200;

struct View
{
  vtkNew<vtkRenderWindow> window;
  vtkNew<vtkRenderer> renderer;
  vtkSmartPointer<vtkVolume> volume = volume_of(0.3);
  vtkNew<vtkBrumeRayMarchMapper> mapper;

  explicit View(vtkImageData* image = nullptr)
  {
    mapper->SetInputData(image ? image : ball_image(VTK_SHORT).Get());
    volume->SetMapper(mapper);
    renderer->AddVolume(volume);
    renderer->SetBackground(26 / 255.0, 51 / 255.0, 77 / 255.0); // whole levels
    window->SetOffScreenRendering(1);
    window->SetMultiSamples(0);
    window->SetSize(size, size);
    window->AddRenderer(renderer);
    const double centre[3] = { 15.5, 14.0, 16.5 };
    look_at(renderer->GetActiveCamera(), centre, 90.0);
    renderer->GetActiveCamera()->SetClippingRange(20, 170);
  }
  std::vector<int> draw()
  {
    window->Render();
    vtkNew<vtkUnsignedCharArray> bytes;
    window->GetPixelData(0, 0, size - 1, size - 1, 0, bytes);
    return { bytes->GetPointer(0), bytes->GetPointer(0) + bytes->GetNumberOfValues() };
  }
  double distance()
  {
    return nlohmann::json::parse(mapper->GetStatistics())["image_sample_distance"];
  }
};

double mean(const std::vector<int>& a, const std::vector<int>& b)
{
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i)
    sum += std::abs(a[i] - b[i]);
  return sum / a.size();
}
int worst(const std::vector<int>& a, const std::vector<int>& b)
{
  int most = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

TEST(Interaction, PicturesAreCoarserWhenTimeIsShortAndWholeAtRest)
{
  View view;
  const std::vector<int> whole = view.draw(); // a still window: VTK's default rate is 0.0001
  EXPECT_EQ(view.distance(), 1.0);
  const float seconds = view.mapper->GetEstimatedRenderTime(view.renderer, view.volume);
  ASSERT_GT(seconds, 0.0f);
  // Nine times as fast as it was.
  view.window->SetDesiredUpdateRate(9.0 / seconds);
  const std::vector<int> coarse = view.draw();
  EXPECT_GT(view.distance(), 2.0);
  EXPECT_LE(view.distance(), 10.1);
  EXPECT_GT(worst(coarse, whole), 2);
  EXPECT_LT(mean(coarse, whole), 3.0); // blended up, in its place
  // Out of reach: as coarse as may be.
  view.mapper->SetMaximumImageSampleDistance(4.0f);
  view.window->SetDesiredUpdateRate(1e6);
  view.draw();
  EXPECT_NEAR(view.distance(), 4.0, 0.1);
  // At rest, the whole picture, to the bit.
  view.window->SetDesiredUpdateRate(0.0001);
  EXPECT_EQ(view.draw(), whole);
  EXPECT_EQ(view.distance(), 1.0);
}

TEST(Interaction, AFirstPictureIsWholeAndASlowRateChangesNothing)
{
  View view;
  view.window->SetDesiredUpdateRate(1e6);
  view.draw();
  EXPECT_EQ(view.distance(), 1.0);
  view.window->SetDesiredUpdateRate(0.01);
  view.draw();
  EXPECT_EQ(view.distance(), 1.0);
}

TEST(Interaction, WithoutAutoAdjustTheDistanceIsTheCallers)
{
  View view;
  view.mapper->AutoAdjustSampleDistancesOff();
  view.mapper->SetSampleDistance(0.5);
  view.window->SetDesiredUpdateRate(1e6);
  const std::vector<int> whole = view.draw();
  EXPECT_EQ(view.distance(), 1.0);
  EXPECT_EQ(view.draw(), whole);
  view.mapper->SetImageSampleDistance(3.0f);
  const std::vector<int> coarse = view.draw();
  EXPECT_NEAR(view.distance(), 3.0, 0.05);
  EXPECT_GT(worst(coarse, whole), 2);
  EXPECT_LT(mean(coarse, whole), 2.0);
  view.mapper->SetImageSampleDistance(0.5f);
  const std::vector<int> fine = view.draw();
  EXPECT_EQ(view.distance(), 0.5);
  // Four rays to a pixel: the film of twice the size, averaged.
  Film film(2 * size, 2 * size);
  ASSERT_TRUE(view.mapper->RenderFilm(
    view.volume, view.renderer->GetActiveCamera(), view.renderer->GetLights(), film));
  const double background[3] = { 26 / 255.0, 51 / 255.0, 77 / 255.0 };
  double most = 0.0;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x)
      for (int c = 0; c < 3; ++c)
      {
        double sum = 0.0;
        for (int sub = 0; sub < 4; ++sub)
        {
          const std::size_t i = std::size_t(2 * y + sub / 2) * 2 * size + 2 * x + sub % 2;
          sum += film.radiance[c][i] + film.transmittance[c][i] * background[c];
        }
        most = std::max(most, std::abs(fine[3 * (y * size + x) + c] - 255.0 * sum / 4.0));
      }
  EXPECT_LE(most, 1.6); // bytes: see Window.ShowsTheFilmOverTheBackground
  view.mapper->SetImageSampleDistance(1.0f);
  EXPECT_EQ(view.draw(), whole);
}

// A sphere in the volume cuts coarse and fine pictures where it cuts whole ones.
TEST(Interaction, CoarsePicturesStopAtGeometryToo)
{
  View view;
  vtkNew<vtkSphereSource> source;
  source->SetCenter(18, 14, 22);
  source->SetRadius(8);
  source->SetThetaResolution(40);
  source->SetPhiResolution(40);
  vtkNew<vtkPolyDataMapper> polygons;
  polygons->SetInputConnection(source->GetOutputPort());
  vtkNew<vtkActor> sphere;
  sphere->SetMapper(polygons);
  sphere->GetProperty()->LightingOff();
  view.renderer->AddActor(sphere);
  view.mapper->AutoAdjustSampleDistancesOff();
  const std::vector<int> whole = view.draw();
  for (float distance : { 2.0f, 0.5f })
  {
    view.mapper->SetImageSampleDistance(distance);
    EXPECT_LT(mean(view.draw(), whole), 1.5) << distance;
  }
  view.mapper->SetImageSampleDistance(1.0f);
  view.mapper->IntermixIntersectingGeometryOff();
  EXPECT_GT(mean(view.draw(), whole), 2.0);
}

// Volumes that are drawn as one. -----------------------------------------------------------------

struct Pair : View
{
  vtkSmartPointer<vtkVolume> other = volume_of(0.3);
  vtkNew<vtkBrumeRayMarchMapper> other_mapper;

  Pair()
  {
    other_mapper->SetInputData(ball_image(VTK_SHORT));
    other->SetMapper(other_mapper);
    renderer->AddVolume(other);
    for (vtkBrumeRayMarchMapper* m : { mapper.Get(), other_mapper.Get() })
    {
      m->AutoAdjustSampleDistancesOff();
      m->SetSampleDistance(0.25);
    }
  }
  std::vector<int> dense()
  {
    View view;
    view.mapper->AutoAdjustSampleDistancesOff();
    view.mapper->SetSampleDistance(0.25);
    view.volume->GetProperty()->SetScalarOpacityUnitDistance(1.0);
    return view.draw();
  }
};

TEST(Combined, OverlappingVolumesAreTheSumOfTheirExtinctions)
{
  Pair pair;
  const std::vector<int> truth = pair.dense();
  EXPECT_LE(worst(pair.draw(), truth), 1);
  EXPECT_LE(worst(pair.draw(), truth), 1); // and in the next frame
  EXPECT_EQ(pair.mapper->GetStatistics(), pair.other_mapper->GetStatistics());
  EXPECT_EQ(nlohmann::json::parse(pair.mapper->GetStatistics())["volumes"], 2);
}

// Whichever is hidden, taken away or brought back, the others are drawn.
TEST(Combined, FollowsVolumesThatComeAndGo)
{
  Pair pair;
  View single;
  single.mapper->AutoAdjustSampleDistancesOff();
  single.mapper->SetSampleDistance(0.25);
  const std::vector<int> one = single.draw();
  const std::vector<int> two = pair.draw();
  for (vtkVolume* hidden : { pair.volume.Get(), pair.other.Get() })
  {
    hidden->VisibilityOff();
    EXPECT_LE(worst(pair.draw(), one), 1);
    hidden->VisibilityOn();
    EXPECT_EQ(pair.draw(), two);
    pair.renderer->RemoveVolume(hidden);
    EXPECT_LE(worst(pair.draw(), one), 1);
    pair.renderer->AddVolume(hidden);
    EXPECT_LE(worst(pair.draw(), two), 1);
  }
  pair.other->SetPosition(0, 0, 500); // behind the camera: VTK does not even call its mapper
  EXPECT_LE(worst(pair.draw(), one), 1);
  pair.other->SetPosition(0, 0, 0);
  EXPECT_LE(worst(pair.draw(), two), 1);
}

TEST(Combined, OnlyWhenAllWantIt)
{
  Pair pair;
  const std::vector<int> two = pair.draw();
  pair.other_mapper->CombineVolumesOff();
  const std::vector<int> apart = pair.draw();
  EXPECT_GT(worst(apart, two), 3); // one over the other: the nearer half of both is not the same
  EXPECT_EQ(nlohmann::json::parse(pair.mapper->GetStatistics())["volumes"], 1);
  pair.other_mapper->CombineVolumesOn();
  EXPECT_EQ(pair.draw(), two);
}

TEST(Combined, EveryRendererHasItsOwn)
{
  Pair pair;
  const std::vector<int> two = pair.draw();
  // The same volumes in a second renderer, on the other half of the window.
  pair.window->SetSize(2 * size, size);
  pair.renderer->SetViewport(0, 0, 0.5, 1);
  vtkNew<vtkRenderer> second;
  second->SetViewport(0.5, 0, 1, 1);
  second->SetBackground(pair.renderer->GetBackground());
  second->SetActiveCamera(pair.renderer->GetActiveCamera());
  second->AddVolume(pair.other);
  second->AddVolume(pair.volume);
  pair.window->AddRenderer(second);
  EXPECT_LE(worst(pair.draw(), two), 1);
  vtkNew<vtkUnsignedCharArray> bytes;
  pair.window->GetPixelData(size, 0, 2 * size - 1, size - 1, 0, bytes);
  const std::vector<int> right(
    bytes->GetPointer(0), bytes->GetPointer(0) + bytes->GetNumberOfValues());
  EXPECT_LE(worst(right, two), 1);
}

}
