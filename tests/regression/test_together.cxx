// Volumes that overlap, drawn as one without a window; projections of several components; jitter;
// window and level.
#include "../support/vtk_scenes.h"

#include "vtkBrumeRayMarchMapper.h"

#include "vtkCommand.h"
#include "vtkTestErrorObserver.h"
#include "vtkVolumeCollection.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

using namespace vtk_scenes;
using brume::Film;

namespace
{

constexpr int size = 64;

struct Part
{
  vtkSmartPointer<vtkVolume> volume;
  vtkNew<vtkBrumeRayMarchMapper> mapper;
  vtkNew<vtkTest::ErrorObserver> errors;

  explicit Part(vtkImageData* image, double opacity = 0.3)
    : volume(volume_of(opacity))
  {
    mapper->AddObserver(vtkCommand::ErrorEvent, errors);
    mapper->AddObserver(vtkCommand::WarningEvent, errors);
    mapper->SetInputData(image);
    mapper->SetAutoAdjustSampleDistances(0);
    mapper->SetSampleDistance(0.25);
    mapper->SetTolerance(0.0);
    volume->SetMapper(mapper);
  }
};

vtkSmartPointer<vtkCamera> camera_at(vtkVolume* volume)
{
  auto camera = vtkSmartPointer<vtkCamera>::New();
  look_at(camera, volume->GetCenter(), 100.0);
  camera->SetClippingRange(10, 200);
  return camera;
}

Film together(std::initializer_list<Part*> parts, vtkCamera* camera)
{
  vtkNew<vtkVolumeCollection> volumes;
  for (Part* part : parts)
  {
    volumes->AddItem(part->volume);
  }
  Film film(size, size);
  EXPECT_TRUE((*parts.begin())->mapper->RenderFilm(volumes, camera, nullptr, film))
    << (*parts.begin())->errors->GetErrorMessage();
  return film;
}

Film alone(Part& part, vtkCamera* camera)
{
  Film film(size, size);
  EXPECT_TRUE(part.mapper->RenderFilm(part.volume, camera, nullptr, film))
    << part.errors->GetErrorMessage();
  return film;
}

// Two of the same are one of twice the extinction: half the unit distance.
TEST(Together, TwoOfTheSameAreOneTwiceAsDense)
{
  const auto ball = ball_image(VTK_SHORT);
  for (bool shade : { false, true })
  {
    Part a(ball), b(ball), dense(ball);
    for (Part* part : { &a, &b, &dense })
    {
      part->volume->GetProperty()->SetShade(shade);
    }
    dense.volume->GetProperty()->SetScalarOpacityUnitDistance(1.0);
    const auto camera = camera_at(a.volume);
    const Film truth = alone(dense, camera);
    EXPECT_GT(most_opaque(truth), 0.5);
    EXPECT_LE(difference(together({ &a, &b }, camera), truth), 2e-4) << shade;
    EXPECT_EQ(nlohmann::json::parse(a.mapper->GetStatistics())["volumes"], 2);
    EXPECT_GT(difference(alone(a, camera), truth), 0.05);
    EXPECT_EQ(nlohmann::json::parse(a.mapper->GetStatistics())["volumes"], 1);
  }
}

// The same matter in another lattice and place: moved by its prop, with voxels of its own size.
TEST(Together, EachVolumeKeepsItsMatrixAndItsLattice)
{
  const auto ball = ball_image(VTK_SHORT);
  Part a(ball), moved(ball), reference(ball);
  const auto camera = camera_at(a.volume);
  const auto elsewhere = ball_image(VTK_SHORT);
  elsewhere->SetOrigin(-30, 10, 5);
  Part b(elsewhere);
  b.volume->SetPosition(30, -10, -5);
  reference.volume->GetProperty()->SetScalarOpacityUnitDistance(1.0);
  EXPECT_LE(difference(together({ &a, &b }, camera), alone(reference, camera)), 2e-4);
  // And out of the way it is the sum of two pictures that do not meet.
  b.volume->SetPosition(30 + 33, -10, -5);
  const Film both = together({ &a, &b }, camera);
  const Film left = alone(a, camera);
  const Film right = alone(b, camera);
  double most = 0.0;
  for (std::size_t i = 0; i < both.size(); ++i)
  {
    if (left.transmittance[0][i] > 0.999999f || right.transmittance[0][i] > 0.999999f)
    {
      most = std::max<double>(
        most, std::abs(both.radiance[0][i] - left.radiance[0][i] - right.radiance[0][i]));
    }
  }
  EXPECT_LE(most, 2e-4);
}

TEST(Together, TheOrderDoesNotMatter)
{
  const auto ball = ball_image(VTK_UNSIGNED_CHAR);
  Part a(ball), b(ball, 0.6);
  b.volume->SetPosition(6, 4, -5);
  const auto camera = camera_at(a.volume);
  EXPECT_LE(difference(together({ &a, &b }, camera), together({ &b, &a }, camera)), 2e-5);
}

TEST(Together, EachVolumeKeepsItsCroppingAndMask)
{
  const auto ball = ball_image(VTK_SHORT);
  Part a(ball), b(ball), dense(ball);
  dense.volume->GetProperty()->SetScalarOpacityUnitDistance(1.0);
  // Two halves of twice the matter, cut at a plane between voxels, are the whole.
  for (Part* part : { &a, &b })
  {
    part->volume->GetProperty()->SetScalarOpacityUnitDistance(1.0);
    part->mapper->CroppingOn();
  }
  a.mapper->SetCroppingRegionPlanes(-1, 14.3, -1, 40, -1, 40);
  b.mapper->SetCroppingRegionPlanes(14.3, 40, -1, 40, -1, 40);
  const auto camera = camera_at(a.volume);
  // The step that holds the plane belongs to the side of its middle in one volume, and is cut there
  // in two: their difference is the change of the matter within a step.
  EXPECT_LE(difference(together({ &a, &b }, camera), alone(dense, camera)), 2e-3);
  EXPECT_GT(difference(alone(a, camera), alone(dense, camera)), 0.05);
}

TEST(Together, RefusesWhatIsNotDrawnAsOne)
{
  const auto ball = ball_image(VTK_SHORT);
  Part a(ball), b(ball);
  const auto camera = camera_at(a.volume);
  Film film(8, 8);
  vtkNew<vtkVolumeCollection> volumes;
  const auto refused = [&]
  {
    a.errors->Clear();
    EXPECT_FALSE(a.mapper->RenderFilm(volumes, camera, nullptr, film));
    EXPECT_TRUE(a.errors->GetError());
  };
  refused(); // no volume at all
  volumes->AddItem(b.volume);
  refused(); // the first has another mapper
  volumes->RemoveAllItems();
  volumes->AddItem(a.volume);
  volumes->AddItem(b.volume);
  b.mapper->CombineVolumesOff();
  refused();
  b.mapper->CombineVolumesOn();
  b.mapper->SetBlendModeToMaximumIntensity();
  refused();
  b.mapper->SetBlendModeToComposite();
  EXPECT_TRUE(a.mapper->RenderFilm(volumes, camera, nullptr, film));
}

// Components are mixed as VTK's mappers do: two equal ones are as opaque as one, and twice as bright.
TEST(Together, ComponentsAreMixedAsVTKMixesThem)
{
  const auto two = image(
    32,
    29,
    34,
    VTK_SHORT,
    [](int i, int j, int k, int)
    { return ball(2.0 * i / 31 - 1, 2.0 * j / 28 - 1, 2.0 * k / 33 - 1); },
    2);
  Part components(two), single(ball_image(VTK_SHORT));
  vtkVolumeProperty* property = components.volume->GetProperty();
  property->SetScalarOpacity(1, property->GetScalarOpacity(0));
  property->SetColor(1, property->GetRGBTransferFunction(0));
  property->SetScalarOpacityUnitDistance(1, 2.0);
  const auto camera = camera_at(single.volume);
  const Film both = alone(components, camera);
  const Film one = alone(single, camera);
  for (std::size_t i = 0; i < one.size(); ++i)
  {
    ASSERT_NEAR(both.transmittance[0][i], one.transmittance[0][i], 2e-4);
    ASSERT_NEAR(both.radiance[1][i], 2.0 * one.radiance[1][i], 4e-4);
  }
}

TEST(Jitter, IsTheSameEveryTimeAndSmall)
{
  Part part(ball_image(VTK_SHORT));
  part.mapper->SetSampleDistance(2.0);
  const auto camera = camera_at(part.volume);
  const Film plain = alone(part, camera);
  part.mapper->UseJitteringOn();
  const Film jittered = alone(part, camera);
  part.mapper->SetNumberOfThreads(1);
  EXPECT_EQ(difference(jittered, alone(part, camera)), 0.0);
  EXPECT_GT(difference(jittered, plain), 1e-4);
  EXPECT_LT(difference(jittered, plain), 0.2);
  // It is an estimate of the same picture.
  part.mapper->SetSampleDistance(0.1);
  const Film fine = alone(part, camera);
  part.mapper->UseJitteringOff();
  EXPECT_LE(difference(fine, alone(part, camera)), 5e-3);
}

TEST(WindowLevel, ScalesTheRadianceAroundTheLevel)
{
  Part part(ball_image(VTK_SHORT));
  const auto camera = camera_at(part.volume);
  const Film plain = alone(part, camera);
  part.mapper->SetFinalColorWindow(0.5f);
  part.mapper->SetFinalColorLevel(0.4f);
  const Film film = alone(part, camera);
  for (std::size_t i = 0; i < film.size(); ++i)
  {
    const float opacity = 1.0f - plain.transmittance[1][i];
    ASSERT_NEAR(
      film.radiance[1][i], std::max(0.0f, 2.0f * plain.radiance[1][i] - 0.3f * opacity), 1e-6);
    ASSERT_EQ(film.transmittance[1][i], plain.transmittance[1][i]);
  }
  EXPECT_EQ(nlohmann::json::parse(part.mapper->GetStatistics())["radiometric"], false);
  part.errors->Clear();
  part.mapper->SetFinalColorWindow(0.0f);
  EXPECT_TRUE(part.errors->GetWarning());
  EXPECT_EQ(part.mapper->GetFinalColorWindow(), 0.5f);
}

}
