// The ray-march mapper without a window: what it reads from VTK's objects, what it refuses, what it
// tells.
#include "../support/vtk_scenes.h"

#include "vtkBrumeRayMarchMapper.h"

#include "Transport/reference.h"

#include "vtkCallbackCommand.h"
#include "vtkCommand.h"
#include "vtkLight.h"
#include "vtkLightCollection.h"
#include "vtkMatrix3x3.h"
#include "vtkMatrix4x4.h"
#include "vtkTestErrorObserver.h"
#include "vtkSOADataArrayTemplate.h"
#include "vtkTransform.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <limits>
#include <sstream>

using namespace vtk_scenes;
using brume::Film;

namespace
{

/// A volume, its mapper and a camera; steps of a quarter, rays never left early.
struct Stage
{
  vtkSmartPointer<vtkVolume> volume = volume_of();
  vtkNew<vtkBrumeRayMarchMapper> mapper;
  vtkNew<vtkCamera> camera;
  vtkNew<vtkTest::ErrorObserver> errors;

  explicit Stage(vtkImageData* image = nullptr)
  {
    mapper->SetAutoAdjustSampleDistances(0);
    mapper->SetSampleDistance(0.25);
    mapper->SetTolerance(0.0);
    mapper->AddObserver(vtkCommand::ErrorEvent, errors);
    mapper->AddObserver(vtkCommand::WarningEvent, errors);
    volume->SetMapper(mapper);
    if (image)
    {
      mapper->SetInputData(image);
      look_at(camera, volume->GetCenter(), 100.0);
      fit();
    }
  }
  void fit() { vtkBrumeVolumeMapper::ResetClippingRange(volume, camera); }
  Film film(int size = 48, vtkLightCollection* lights = nullptr)
  {
    Film result(size, size);
    EXPECT_TRUE(mapper->RenderFilm(volume, camera, lights, result)) << errors->GetErrorMessage();
    return result;
  }
};

TEST(Mapper, MovingThePropIsMovingTheCameraBack)
{
  const auto image = ball_image(VTK_UNSIGNED_CHAR);
  for (bool parallel : { false, true })
  {
    for (bool shade : { false, true })
    {
      Stage moved(image);
      Stage still(image);
      for (Stage* stage : { &moved, &still })
      {
        stage->camera->SetParallelProjection(parallel);
        stage->camera->SetParallelScale(25.0);
        stage->volume->GetProperty()->SetShade(shade);
      }
      moved.volume->SetOrigin(3, 4, 5);
      moved.volume->SetPosition(7, -2, 11);
      moved.volume->RotateWXYZ(50, 1, 2, -1);
      still.camera->DeepCopy(moved.camera);
      vtkNew<vtkTransform> back;
      back->SetMatrix(moved.volume->GetMatrix());
      back->Inverse();
      still.camera->ApplyTransform(back);
      moved.fit();
      still.fit();
      const double range[2] = { 20.0, 250.0 };
      moved.camera->SetClippingRange(range);
      still.camera->SetClippingRange(range);
      const Film film = moved.film();
      EXPECT_GT(most_opaque(film), 0.5);
      EXPECT_LE(difference(film, still.film()), shade ? 1e-4 : 1e-5);
    }
  }
}

TEST(Mapper, DirectionAndOriginOfTheImageAreAMatrixOfTheProp)
{
  for (double mirror : { 1.0, -1.0 })
  {
    const auto plain = ball_image(VTK_SHORT);
    const auto turned = ball_image(VTK_SHORT);
    plain->SetSpacing(1.0, 0.7, 1.4);
    turned->SetSpacing(1.0, 0.7, 1.4);
    const double c = std::cos(0.6);
    const double s = std::sin(0.6);
    turned->SetDirectionMatrix(c, -s, 0, mirror * s, mirror * c, 0, 0, 0, 1);
    turned->SetOrigin(30, -20, 10);
    Stage by_image(turned);
    Stage by_prop(plain);
    vtkNew<vtkMatrix4x4> matrix;
    const double m[16] = { c, -s, 0, 30, mirror * s, mirror * c, 0, -20, 0, 0, 1, 10, 0, 0, 0, 1 };
    matrix->DeepCopy(m);
    by_prop.volume->SetUserMatrix(matrix);
    by_prop.camera->DeepCopy(by_image.camera);
    by_image.volume->GetProperty()->SetShade(1);
    by_prop.volume->GetProperty()->SetShade(1);
    const Film film = by_image.film();
    EXPECT_GT(most_opaque(film), 0.5);
    EXPECT_LE(difference(film, by_prop.film()), 1e-4) << mirror;
  }
}

TEST(Mapper, ScaleOfThePropLeavesOpticalDepthAsItIs)
{
  Stage stage(ball_image(VTK_UNSIGNED_CHAR));
  stage.camera->SetParallelProjection(1);
  stage.camera->SetParallelScale(25.0);
  double centre[3];
  std::copy_n(stage.volume->GetCenter(), 3, centre);
  stage.camera->SetPosition(centre[0], centre[1], centre[2] + 100.0);
  stage.fit();
  const Film film = stage.film();
  stage.volume->SetOrigin(centre);
  stage.volume->SetScale(1.0, 1.0, 3.0); // along the view: the same picture
  stage.fit();
  EXPECT_LE(difference(film, stage.film()), 1e-5);
}

TEST(Mapper, ExtentsNeedNotBeginAtZero)
{
  const auto image = ball_image(VTK_UNSIGNED_CHAR);
  Stage stage(image);
  const Film film = stage.film();
  int extent[6];
  image->GetExtent(extent);
  image->SetExtent(extent[0] + 5, extent[1] + 5, extent[2] - 9, extent[3] - 9, extent[4] + 2,
    extent[5] + 2);
  image->SetOrigin(-5, 9, -2);
  EXPECT_LE(difference(film, stage.film()), 1e-6);
}

TEST(Mapper, TypesThatAreConvertedGiveTheSamePicture)
{
  Stage reference(ball_image(VTK_FLOAT));
  const Film film = reference.film();
  EXPECT_GT(most_opaque(film), 0.5);
  for (int type : { VTK_DOUBLE, VTK_INT, VTK_UNSIGNED_INT, VTK_LONG_LONG, VTK_UNSIGNED_CHAR,
         VTK_SHORT, VTK_UNSIGNED_SHORT })
  {
    Stage stage(ball_image(type));
    EXPECT_LE(difference(film, stage.film()), 2e-6) << type;
  }
}

TEST(Mapper, ReadsArraysThatAreNotInterleaved)
{
  const auto image = ball_image(VTK_UNSIGNED_CHAR);
  Stage plain(image);
  const Film film = plain.film();
  const auto other = ball_image(VTK_UNSIGNED_CHAR);
  vtkNew<vtkSOADataArrayTemplate<unsigned char>> array;
  array->DeepCopy(image->GetPointData()->GetScalars());
  other->GetPointData()->SetScalars(array);
  Stage stage(other);
  EXPECT_LE(difference(film, stage.film()), 2e-6);
}

TEST(Mapper, CellsFillTheirBoxAndPointsReachBetweenThem)
{
  // n cells between n + 1 points: a constant box of cells is n long, one of points n − 1.
  const auto constant = [](int, int, int, int) { return 200.0; };
  const auto depth = [&](vtkImageData* image)
  {
    Stage stage(image);
    double centre[3];
    std::copy_n(stage.volume->GetCenter(), 3, centre);
    stage.camera->SetParallelProjection(1);
    stage.camera->SetParallelScale(1.0);
    stage.camera->SetPosition(centre[0], centre[1], centre[2] + 50.0);
    stage.fit();
    return -std::log(stage.film(3).transmittance[0][4]);
  };
  const double extinction = std::log(2.0) / 2.0;
  EXPECT_NEAR(depth(image(8, 8, 6, VTK_UNSIGNED_CHAR, constant)), extinction * 5, 1e-5);
  EXPECT_NEAR(
    depth(image(8, 8, 6, VTK_UNSIGNED_CHAR, constant, 1, true)), extinction * 6, 1e-5);
}

TEST(Mapper, VolumesOfOneVoxelAreDrawnWhereTheyFillSpace)
{
  const auto constant = [](int, int, int, int) { return 200.0; };
  const int sizes[][3] = { { 1, 9, 9 }, { 9, 1, 9 }, { 9, 9, 1 }, { 1, 1, 1 }, { 1, 1, 9 } };
  for (const int* n : sizes)
  {
    for (int type : { VTK_UNSIGNED_CHAR, VTK_DOUBLE })
    {
      Stage points(image(n[0], n[1], n[2], type, constant));
      points.camera->SetClippingRange(1, 200);
      EXPECT_EQ(most_opaque(points.film()), 0.0);
      Stage cells(image(n[0], n[1], n[2], type, constant, 1, true));
      cells.camera->Zoom(8.0);
      cells.fit();
      EXPECT_GT(most_opaque(cells.film()), 0.1) << n[0] << n[1] << n[2];
    }
  }
}

TEST(Mapper, ColoursOfFourComponentsAreTheirOwn)
{
  const auto rgba = image(20, 20, 20, VTK_UNSIGNED_CHAR,
    [](int, int, int, int c) { const double v[4] = { 255, 51, 102, 200 }; return v[c]; }, 4);
  Stage stage(rgba);
  stage.volume->GetProperty()->IndependentComponentsOff();
  const Film film = stage.film();
  const std::size_t middle = 24 * 48 + 24;
  const double opacity = 1.0 - film.transmittance[0][middle];
  EXPECT_GT(opacity, 0.9);
  EXPECT_NEAR(film.radiance[0][middle], opacity, 1e-4);
  EXPECT_NEAR(film.radiance[1][middle], 0.2 * opacity, 1e-4);
  EXPECT_NEAR(film.radiance[2][middle], 0.4 * opacity, 1e-4);
}

TEST(Mapper, ClippingPlanesOfTheCameraCut)
{
  Stage stage(image(21, 21, 21, VTK_UNSIGNED_CHAR, [](int, int, int, int) { return 200.0; }));
  double centre[3];
  std::copy_n(stage.volume->GetCenter(), 3, centre);
  stage.camera->SetPosition(centre[0], centre[1], centre[2] + 100.0);
  stage.camera->SetViewAngle(1.0);
  const auto depth = [&](double near, double far)
  {
    stage.camera->SetClippingRange(near, far);
    return -std::log(stage.film(3).transmittance[0][4]) / (std::log(2.0) / 2.0);
  };
  EXPECT_NEAR(depth(50, 150), 20.0, 1e-3);
  EXPECT_NEAR(depth(95, 150), 15.0, 1e-3);
  EXPECT_NEAR(depth(95, 103), 8.0, 1e-3);
  stage.camera->SetPosition(centre[0], centre[1], centre[2] + 4.0); // inside
  EXPECT_NEAR(depth(0.5, 150), 13.5, 1e-3);
}

TEST(Mapper, FollowsChangesOfDataAndProperty)
{
  const auto image = ball_image(VTK_UNSIGNED_CHAR);
  Stage stage(image);
  const Film first = stage.film();
  stage.volume->GetProperty()->GetScalarOpacity()->AddPoint(200, 0.2); // in place
  EXPECT_GT(difference(first, stage.film()), 0.05);
  stage.volume->GetProperty()->GetScalarOpacity()->AddPoint(200, 0.5);
  EXPECT_EQ(difference(first, stage.film()), 0.0);
  vtkDataArray* scalars = image->GetPointData()->GetScalars();
  scalars->FillComponent(0, 0.0);
  scalars->SetTuple1(0, 200.0);
  scalars->Modified();
  EXPECT_GT(difference(first, stage.film()), 0.05);
}

TEST(Mapper, TellsWhatItDid)
{
  auto image = ball_image(VTK_FLOAT);
  image->GetPointData()->GetScalars()->SetComponent(77, 0, std::nan(""));
  Stage stage(image);
  EXPECT_EQ(stage.mapper->GetStatistics(), "{}");
  stage.film();
  nlohmann::json statistics = nlohmann::json::parse(stage.mapper->GetStatistics());
  for (const char* key : { "mapper", "seconds", "seconds_prepare", "samples", "rays", "threads",
         "simd", "effects", "non_finite_voxels", "radiometric", "peak_memory_bytes" })
  {
    EXPECT_TRUE(statistics.contains(key)) << key;
  }
  EXPECT_EQ(statistics["mapper"], "raymarch");
  EXPECT_EQ(statistics["non_finite_voxels"], 1);
  EXPECT_EQ(statistics["radiometric"], true);
  EXPECT_GT(statistics["samples"], statistics["rays"]);
  EXPECT_GT(statistics["peak_memory_bytes"], 1 << 20);
  EXPECT_EQ(statistics["step"], 0.25);
  for (const auto& effect : statistics["effects"])
  {
    EXPECT_TRUE(effect["name"].is_string() && effect["on"].is_boolean() &&
      effect["reason"].is_string() && effect["error_bound"].is_number());
    EXPECT_FALSE(effect["reason"].get<std::string>().empty());
  }
  stage.volume->GetProperty()->SetShade(1);
  stage.film();
  statistics = nlohmann::json::parse(stage.mapper->GetStatistics());
  EXPECT_EQ(statistics["radiometric"], false);
  // A camera that moves prepares nothing.
  double least = 1.0;
  for (int i = 0; i < 3; ++i)
  {
    stage.camera->Azimuth(10);
    stage.film();
    least = std::min(least,
      nlohmann::json::parse(stage.mapper->GetStatistics())["seconds_prepare"].get<double>());
  }
  EXPECT_LT(least, 0.001);
  std::ostringstream text;
  stage.mapper->Print(text);
  for (const char* setting : { "Tolerance: 0", "SampleDistance: 0.25", "NumberOfThreads: 0",
         "AutoAdjustSampleDistances: Off", "TwoSidedLighting: On", "non_finite_voxels" })
  {
    EXPECT_NE(text.str().find(setting), std::string::npos) << setting;
  }
}

TEST(Mapper, RefusesWhatItCannotDrawWithAnError)
{
  const auto refuses = [](Stage& stage, const char* words)
  {
    Film film(8, 8);
    stage.errors->Clear();
    EXPECT_FALSE(stage.mapper->RenderFilm(stage.volume, stage.camera, nullptr, film));
    EXPECT_TRUE(stage.errors->GetError()) << words;
    EXPECT_NE(stage.errors->GetErrorMessage().find(words), std::string::npos)
      << stage.errors->GetErrorMessage();
    EXPECT_EQ(most_opaque(film), 0.0);
  };
  Stage none;
  refuses(none, "no image data");
  const auto five = image(
    5, 5, 5, VTK_UNSIGNED_CHAR, [](int, int, int, int) { return 1.0; }, 5);
  Stage components(five);
  refuses(components, "components");
  Stage short_rgba(image(5, 5, 5, VTK_SHORT, [](int, int, int, int) { return 1.0; }, 4));
  short_rgba.volume->GetProperty()->IndependentComponentsOff();
  refuses(short_rgba, "components");
  const auto flat_spacing = ball_image(VTK_SHORT);
  Stage spacing(flat_spacing);
  flat_spacing->SetSpacing(1, 0, 1);
  refuses(spacing, "spacing");
  Stage unit(ball_image(VTK_SHORT));
  unit.volume->GetProperty()->SetScalarOpacityUnitDistance(0.0);
  refuses(unit, "unit distance");
  unit.volume->GetProperty()->SetScalarOpacityUnitDistance(2.0);
  EXPECT_GT(most_opaque(unit.film()), 0.1); // and it recovers
  Stage flat(ball_image(VTK_SHORT));
  vtkNew<vtkMatrix4x4> matrix;
  matrix->SetElement(1, 1, 0.0);
  flat.volume->SetUserMatrix(matrix);
  refuses(flat, "flattens");
  Stage empty(vtkNew<vtkImageData>().Get());
  refuses(empty, "scalars");
}

TEST(Mapper, RefusesSampleDistancesThatAreNoLengths)
{
  Stage stage(ball_image(VTK_UNSIGNED_CHAR));
  for (double bad : { 0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity() })
  {
    stage.errors->Clear();
    stage.mapper->SetSampleDistance(bad);
    EXPECT_TRUE(stage.errors->GetWarning());
    EXPECT_EQ(stage.mapper->GetSampleDistance(), 0.25);
  }
}

TEST(Mapper, SendsProgressAndStopsWhenAsked)
{
  Stage stage(ball_image(VTK_UNSIGNED_CHAR));
  struct Log
  {
    int starts = 0, progress = 0, ends = 0;
    bool abort = false;
    double last = 0.0;
  } log;
  vtkNew<vtkCallbackCommand> callback;
  callback->SetClientData(&log);
  callback->SetCallback(
    [](vtkObject* caller, unsigned long event, void* data, void*)
    {
      auto& l = *static_cast<Log*>(data);
      auto* mapper = static_cast<vtkBrumeRayMarchMapper*>(caller);
      l.starts += event == vtkCommand::StartEvent;
      l.ends += event == vtkCommand::EndEvent;
      if (event == vtkCommand::ProgressEvent)
      {
        ++l.progress;
        l.last = mapper->GetProgress();
        if (l.abort)
        {
          mapper->AbortExecuteOn();
        }
      }
    });
  for (auto event : { vtkCommand::StartEvent, vtkCommand::ProgressEvent, vtkCommand::EndEvent })
  {
    stage.mapper->AddObserver(event, callback);
  }
  stage.mapper->SetNumberOfThreads(1); // of several the one that is told may have little to do
  stage.film(300);
  stage.mapper->SetNumberOfThreads(0);
  EXPECT_EQ(log.starts, 1);
  EXPECT_EQ(log.ends, 1);
  EXPECT_GT(log.progress, 5);
  EXPECT_EQ(log.last, 1.0);
  log = Log();
  log.abort = true;
  Film film(300, 300);
  EXPECT_FALSE(stage.mapper->RenderFilm(stage.volume, stage.camera, nullptr, film));
  EXPECT_EQ(log.progress, 1);
  EXPECT_EQ(log.ends, 1);
  EXPECT_EQ(nlohmann::json::parse(stage.mapper->GetStatistics())["completed"], false);
  log.abort = false;
  stage.film(300); // the next one is whole again
}

TEST(Mapper, AutoAdjustMeetsItsTolerance)
{
  for (double tolerance : { 0.02, 0.004, 0.001 })
  {
    Stage stage(ball_image(VTK_UNSIGNED_SHORT));
    stage.mapper->SetAutoAdjustSampleDistances(1);
    stage.mapper->SetTolerance(tolerance);
    const Film film = stage.film();
    const auto statistics = nlohmann::json::parse(stage.mapper->GetStatistics());
    const brume::Scene* scene =
      stage.mapper->UpdateScene(stage.volume, stage.camera, nullptr, 48, 48);
    ASSERT_NE(scene, nullptr);
    Film truth(48, 48);
    brume::ReferenceSettings settings;
    settings.tolerance = 1e-5;
    brume::render_reference(*scene, settings, truth);
    EXPECT_TRUE(statistics["tolerance_met"].get<bool>()) << tolerance;
    EXPECT_LE(difference(film, truth), tolerance);
  }
}

// A first view that misses the volume says nothing of its steps.
TEST(Mapper, ChoosesStepsAgainWhenTheFirstViewWasEmpty)
{
  Stage stage(ball_image(VTK_UNSIGNED_SHORT));
  stage.mapper->SetAutoAdjustSampleDistances(1);
  stage.mapper->SetTolerance(0.001);
  const Film right = stage.film();
  Stage other(ball_image(VTK_UNSIGNED_SHORT));
  other.mapper->SetAutoAdjustSampleDistances(1);
  other.mapper->SetTolerance(0.001);
  other.camera->Yaw(180);
  EXPECT_EQ(most_opaque(other.film()), 0.0);
  other.camera->DeepCopy(stage.camera);
  EXPECT_EQ(difference(right, other.film()), 0.0);
}

TEST(Mapper, NoLightsAreAHeadlight)
{
  Stage stage(ball_image(VTK_UNSIGNED_CHAR));
  stage.volume->GetProperty()->SetShade(1);
  const Film none = stage.film();
  vtkNew<vtkLightCollection> lights;
  EXPECT_EQ(difference(none, stage.film(48, lights)), 0.0);
  vtkNew<vtkLight> head;
  head->SetLightTypeToHeadlight();
  lights->AddItem(head);
  EXPECT_LE(difference(none, stage.film(48, lights)), 1e-6);
  // Lights that are all switched off are not none: the ambient term alone, as VTK has it.
  head->SetSwitch(0);
  const Film dark = stage.film(48, lights);
  EXPECT_GT(difference(none, dark), 0.1);
  stage.volume->GetProperty()->SetDiffuse(0);
  stage.volume->GetProperty()->SetSpecular(0);
  EXPECT_LE(difference(dark, stage.film()), 1e-6);
}

TEST(Mapper, RenderImageIsTheFilmOverABackground)
{
  Stage stage(ball_image(VTK_UNSIGNED_CHAR));
  const Film film = stage.film();
  const double background[3] = { 0.3, 0.0, 2.0 };
  vtkNew<vtkImageData> picture;
  ASSERT_TRUE(
    stage.mapper->RenderImage(stage.volume, stage.camera, nullptr, 48, 48, background, picture));
  const std::vector<float> truth = brume::over_background(film, background);
  vtkDataArray* rgb = picture->GetPointData()->GetArray("rgb");
  ASSERT_NE(rgb, nullptr);
  ASSERT_EQ(rgb->GetNumberOfValues(), vtkIdType(truth.size()));
  for (vtkIdType i = 0; i < rgb->GetNumberOfValues(); ++i)
  {
    ASSERT_EQ(rgb->GetComponent(i / 3, i % 3), truth[i]);
  }
}

}
