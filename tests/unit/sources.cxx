// The generated volumes as VTK pipeline sources.
#include "vtkBrumeCloudSource.h"
#include "vtkBrumePhantomSource.h"
#include "vtkBrumeSmokeSource.h"

#include "data-generators/head_ct.h"
#include "tests/support/source_checks.h"

#include "vtkCallbackCommand.h"
#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <gtest/gtest.h>

#include <limits>
#include <sstream>
#include <vector>

using namespace brume_tests;

TEST(PhantomSource, DescribesItsVolumeBeforeMakingIt)
{
  vtkNew<vtkBrumePhantomSource> source;
  source->UpdateInformation();
  vtkInformation* info = source->GetOutputInformation(0);
  int extent[6];
  double origin[3], spacing[3];
  info->Get(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), extent);
  info->Get(vtkDataObject::ORIGIN(), origin);
  info->Get(vtkDataObject::SPACING(), spacing);
  EXPECT_EQ(std::vector<int>(extent, extent + 6), (std::vector<int>{ 0, 191, 0, 239, 0, 255 }));
  EXPECT_EQ(
    std::vector<double>(origin, origin + 3), (std::vector<double>{ -95.5, -119.5, -127.5 }));
  EXPECT_EQ(std::vector<double>(spacing, spacing + 3), (std::vector<double>{ 1, 1, 1 }));
  EXPECT_EQ(source->GetOutput()->GetNumberOfPoints(), 0) << "nothing was made yet";
}

TEST(PhantomSource, GivesHounsfieldUnitsInPatientSpace)
{
  vtkNew<vtkBrumePhantomSource> source;
  source->SetSize(128);
  source->SetNoiseLevel(0.0);
  source->Update();
  vtkImageData* scan = source->GetOutput();
  EXPECT_EQ(scan->GetScalarType(), VTK_SHORT);
  EXPECT_STREQ(scan->GetPointData()->GetScalars()->GetName(), "Hounsfield");
  double marker[3] = { brume::head_marker[0], brume::head_marker[1], brume::head_marker[2] };
  const auto value_at = [&](const double* p)
  { return scan->GetPointData()->GetScalars()->GetTuple1(scan->FindPoint(p[0], p[1], p[2])); };
  EXPECT_GT(value_at(marker), 2700.0);
  marker[0] = -marker[0];
  EXPECT_LT(value_at(marker), 200.0);
  EXPECT_EQ(scan->GetScalarComponentAsDouble(0, 0, 127, 0), -1000.0);
}

TEST(PhantomSource, PiecesEqualTheWhole)
{
  vtkNew<vtkBrumePhantomSource> whole;
  vtkNew<vtkBrumePhantomSource> parts;
  whole->SetSize(40);
  parts->SetSize(40);
  expect_pieces_equal_the_whole(whole, parts);
}

TEST(PhantomSource, WorksAgainOnlyWhenASettingChanged)
{
  vtkNew<vtkBrumePhantomSource> source;
  source->SetSize(24);
  int reports = 0;
  vtkNew<vtkCallbackCommand> counter;
  counter->SetCallback(count_progress);
  counter->SetClientData(&reports);
  source->AddObserver(vtkCommand::ProgressEvent, counter);
  source->Update();
  const int first = reports;
  EXPECT_GT(first, 0);
  const vtkMTimeType time = source->GetOutput()->GetUpdateTime();
  source->SetSize(24);
  source->Update();
  EXPECT_EQ(reports, first);
  EXPECT_EQ(source->GetOutput()->GetUpdateTime(), time);

  vtkNew<vtkImageData> before;
  before->DeepCopy(source->GetOutput());
  source->SetSeed(2);
  source->Update();
  EXPECT_GT(reports, first);
  bool differs = false;
  for (vtkIdType n = 0; n < before->GetNumberOfPoints(); ++n)
  {
    differs = differs || before->GetPointData()->GetScalars()->GetTuple1(n) !=
                           source->GetOutput()->GetPointData()->GetScalars()->GetTuple1(n);
  }
  EXPECT_TRUE(differs);
}

TEST(PhantomSource, CanBeAborted)
{
  vtkNew<vtkBrumePhantomSource> source;
  source->SetSize(64);
  expect_abort_and_recovery(source);
}

TEST(PhantomSource, HoldsItsSettingsToTheirRanges)
{
  vtkNew<vtkBrumePhantomSource> source;
  source->SetSize(1);
  EXPECT_EQ(source->GetSize(), 2);
  source->SetSize(100000);
  EXPECT_EQ(source->GetSize(), 4096);
  source->SetNoiseLevel(-1.0);
  EXPECT_EQ(source->GetNoiseLevel(), 0.0);
  source->SetKind(-1);
  EXPECT_EQ(source->GetKind(), static_cast<int>(vtkBrumePhantomSource::KindHeadCT));
  std::ostringstream text;
  source->Print(text);
  EXPECT_NE(text.str().find("NoiseLevel: 0 HU"), std::string::npos);
}

TEST(PhantomSource, MakesTheSmallestVolume)
{
  vtkNew<vtkBrumePhantomSource> source;
  source->SetSize(2);
  source->Update();
  EXPECT_EQ(source->GetOutput()->GetNumberOfPoints(), 8);
}

TEST(CloudSource, GivesADensityInMetres)
{
  vtkNew<vtkBrumeCloudSource> source;
  source->SetSize(50);
  source->Update();
  vtkImageData* cloud = source->GetOutput();
  EXPECT_EQ(cloud->GetScalarType(), VTK_FLOAT);
  EXPECT_STREQ(cloud->GetPointData()->GetScalars()->GetName(), "density");
  int dimensions[3];
  cloud->GetDimensions(dimensions);
  EXPECT_EQ(std::vector<int>(dimensions, dimensions + 3), (std::vector<int>{ 50, 50, 30 }));
  EXPECT_DOUBLE_EQ(cloud->GetSpacing()[0], 40.0);
  EXPECT_DOUBLE_EQ(cloud->GetOrigin()[0], -980.0);
  EXPECT_NEAR(cloud->GetOrigin()[2], 20.0, 1e-9);
  double range[2];
  cloud->GetScalarRange(range);
  EXPECT_EQ(range[0], 0.0);
  EXPECT_EQ(range[1], 1.0);
}

TEST(CloudSource, PiecesEqualTheWhole)
{
  vtkNew<vtkBrumeCloudSource> whole;
  vtkNew<vtkBrumeCloudSource> parts;
  whole->SetSize(40);
  parts->SetSize(40);
  expect_pieces_equal_the_whole(whole, parts);
}

TEST(CloudSource, CanBeAborted)
{
  vtkNew<vtkBrumeCloudSource> source;
  source->SetSize(64);
  expect_abort_and_recovery(source);
}

TEST(CloudSource, EverySettingMakesAnotherCloud)
{
  const auto total = [](void (*change)(vtkBrumeCloudSource*))
  {
    vtkNew<vtkBrumeCloudSource> source;
    source->SetSize(40);
    change(source);
    source->Update();
    vtkDataArray* density = source->GetOutput()->GetPointData()->GetScalars();
    double sum = 0.0;
    for (vtkIdType n = 0; n < density->GetNumberOfTuples(); ++n)
    {
      sum += density->GetTuple1(n);
    }
    return sum;
  };
  const double usual = total([](vtkBrumeCloudSource*) {});
  EXPECT_EQ(usual, total([](vtkBrumeCloudSource* s) { s->SetSeed(1); }));
  EXPECT_NE(usual, total([](vtkBrumeCloudSource* s) { s->SetSeed(2); }));
  EXPECT_NE(usual, total([](vtkBrumeCloudSource* s) { s->SetTime(50.0); }));
  EXPECT_NE(usual, total([](vtkBrumeCloudSource* s) { s->SetWidth(3000.0); }));
  EXPECT_NE(usual, total([](vtkBrumeCloudSource* s) { s->SetDetailSize(300.0); }));
  EXPECT_NE(usual, total([](vtkBrumeCloudSource* s) { s->SetOctaves(2); }));
  EXPECT_LT(usual, total([](vtkBrumeCloudSource* s) { s->SetOffset(0.4); }));
  EXPECT_LT(usual, total([](vtkBrumeCloudSource* s) { s->SetCrispness(8.0); }));
  EXPECT_NE(usual, total([](vtkBrumeCloudSource* s) { s->SetWarpAmplitude(0.0); }));
  EXPECT_NE(usual, total([](vtkBrumeCloudSource* s) { s->SetWarpSize(100.0); }));
  EXPECT_NE(total([](vtkBrumeCloudSource* s) { s->SetTime(50.0); }),
    total(
      [](vtkBrumeCloudSource* s)
      {
        s->SetTime(50.0);
        s->SetWind(0.0, 5.0, 0.0);
      }));
}

TEST(CloudSource, ASettingThatIsNoNumberIsAnError)
{
  vtkNew<vtkBrumeCloudSource> source;
  vtkNew<vtkCallbackCommand> counter;
  int errors = 0;
  counter->SetCallback(count_progress);
  counter->SetClientData(&errors);
  source->AddObserver(vtkCommand::ErrorEvent, counter);
  source->SetSize(26);
  source->SetWind(std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0);
  source->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, counter);
  source->Update();
  EXPECT_GT(errors, 0);
  EXPECT_EQ(source->GetOutput()->GetNumberOfPoints(), 0);
}

TEST(SmokeSource, GivesDensityAndTemperature)
{
  vtkNew<vtkBrumeSmokeSource> source;
  source->SetSize(64);
  source->Update();
  vtkImageData* smoke = source->GetOutput();
  EXPECT_STREQ(smoke->GetPointData()->GetScalars()->GetName(), "density");
  int dimensions[3];
  smoke->GetDimensions(dimensions);
  EXPECT_EQ(std::vector<int>(dimensions, dimensions + 3), (std::vector<int>{ 32, 32, 64 }));
  EXPECT_DOUBLE_EQ(smoke->GetSpacing()[0], 0.125);
  vtkDataArray* temperature = smoke->GetPointData()->GetArray("temperature");
  ASSERT_TRUE(temperature);
  EXPECT_EQ(temperature->GetNumberOfTuples(), smoke->GetNumberOfPoints());
  double range[2];
  temperature->GetRange(range);
  EXPECT_EQ(range[0], 300.0);
  EXPECT_GT(range[1], 1000.0);
  EXPECT_LE(range[1], 1900.0);
}

TEST(SmokeSource, PiecesEqualTheWhole)
{
  vtkNew<vtkBrumeSmokeSource> whole;
  vtkNew<vtkBrumeSmokeSource> parts;
  whole->SetSize(40);
  parts->SetSize(40);
  expect_pieces_equal_the_whole(whole, parts);
}

TEST(SmokeSource, CanBeAborted)
{
  vtkNew<vtkBrumeSmokeSource> source;
  source->SetSize(64);
  expect_abort_and_recovery(source);
}

TEST(SmokeSource, EverySettingMakesOtherSmoke)
{
  const auto totals = [](void (*change)(vtkBrumeSmokeSource*))
  {
    vtkNew<vtkBrumeSmokeSource> source;
    source->SetSize(40);
    change(source);
    source->Update();
    std::vector<double> sums;
    for (const char* name : { "density", "temperature" })
    {
      vtkDataArray* array = source->GetOutput()->GetPointData()->GetArray(name);
      sums.push_back(0.0);
      for (vtkIdType n = 0; n < array->GetNumberOfTuples(); ++n)
      {
        sums.back() += array->GetTuple1(n);
      }
    }
    return sums;
  };
  const std::vector<double> usual = totals([](vtkBrumeSmokeSource*) {});
  const std::vector<double> seed = totals([](vtkBrumeSmokeSource* s) { s->SetSeed(2); });
  const std::vector<double> time = totals([](vtkBrumeSmokeSource* s) { s->SetTime(2.0); });
  const std::vector<double> rise = totals(
    [](vtkBrumeSmokeSource* s)
    {
      s->SetTime(2.0);
      s->SetRise(0.1);
    });
  EXPECT_NE(usual, seed);
  EXPECT_NE(usual, time);
  EXPECT_NE(time, rise);
  // The plume grows with its box: the same numbers, farther apart.
  vtkNew<vtkBrumeSmokeSource> wide;
  wide->SetSize(40);
  wide->SetWidth(8.0);
  wide->Update();
  EXPECT_DOUBLE_EQ(wide->GetOutput()->GetSpacing()[0], 0.4);
  const std::vector<double> hot = totals([](vtkBrumeSmokeSource* s) { s->SetSourceTemperature(2500.0); });
  const std::vector<double> cold = totals([](vtkBrumeSmokeSource* s) { s->SetAirTemperature(250.0); });
  EXPECT_EQ(usual[0], hot[0]);
  EXPECT_LT(usual[1], hot[1]);
  EXPECT_EQ(usual[0], cold[0]);
  EXPECT_GT(usual[1], cold[1]);
}

TEST(SmokeSource, ASettingThatMakesNoSmokeIsAnError)
{
  vtkNew<vtkBrumeSmokeSource> source;
  vtkNew<vtkCallbackCommand> counter;
  int errors = 0;
  counter->SetCallback(count_progress);
  counter->SetClientData(&errors);
  source->AddObserver(vtkCommand::ErrorEvent, counter);
  source->SetSize(26);
  source->SetSourceTemperature(std::numeric_limits<double>::quiet_NaN());
  source->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, counter);
  source->Update();
  EXPECT_GT(errors, 0);
  EXPECT_EQ(source->GetOutput()->GetNumberOfPoints(), 0);
}
