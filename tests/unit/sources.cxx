// The generated volumes as VTK pipeline sources.
#include "vtkBrumeCloudSource.h"
#include "vtkBrumeFogSource.h"
#include "vtkBrumePhantomSource.h"
#include "vtkBrumeSignedDistanceSource.h"
#include "vtkBrumeSmokeSource.h"
#include "vtkBrumeSparseVolume.h"

#include "Transport/sparse_voxels.h"
#include "data-generators/head_ct.h"
#include "data-generators/plume.h"
#include "tests/support/source_checks.h"

#include "vtkCallbackCommand.h"
#include "vtkDataArray.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMatrix4x4.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <gtest/gtest.h>

#include <algorithm>
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

namespace
{

/// The sparse output holds, voxel by voxel, what the dense one does in the array of its name, held
/// to a band.
void expect_sparse_equals_dense(vtkBrumeSampledSource* source,
  double background = 0.0,
  double band = std::numeric_limits<double>::infinity())
{
  source->SparseOff();
  source->Update();
  vtkNew<vtkImageData> dense;
  dense->DeepCopy(source->GetOutput());
  EXPECT_FALSE(source->GetSparseOutput());
  source->SparseOn();
  source->Update();
  vtkBrumeSparseVolume* sparse = source->GetSparseOutput();
  ASSERT_TRUE(sparse);
  EXPECT_FALSE(source->GetOutput());
  ASSERT_TRUE(sparse->GetVoxels());
  EXPECT_EQ(sparse->GetVoxels()->background(), static_cast<float>(background));
  vtkDataArray* values = dense->GetPointData()->GetArray(sparse->GetName().c_str());
  ASSERT_TRUE(values) << sparse->GetName();
  const auto& origin = sparse->GetVoxels()->origin();
  int dimensions[3];
  dense->GetDimensions(dimensions);
  vtkIdType active = 0;
  for (int k = 0; k < dimensions[2]; ++k)
    for (int j = 0; j < dimensions[1]; ++j)
      for (int i = 0; i < dimensions[0]; ++i)
      {
        const vtkIdType n = (vtkIdType(k) * dimensions[1] + j) * dimensions[0] + i;
        const float value = static_cast<float>(std::clamp(values->GetTuple1(n), -band, band));
        active += value != static_cast<float>(background);
        ASSERT_EQ(sparse->GetVoxels()->value(i - origin[0], j - origin[1], k - origin[2]), value);
      }
  EXPECT_EQ(sparse->GetActiveVoxelCount(), active);
  const double index[4] = { 3.0, 4.0, 5.0, 1.0 };
  double place[4];
  sparse->GetIndexToWorld()->MultiplyPoint(index, place);
  for (int axis = 0; axis < 3; ++axis)
  {
    EXPECT_DOUBLE_EQ(
      place[axis], dense->GetOrigin()[axis] + index[axis] * dense->GetSpacing()[axis]);
  }
  source->SparseOff();
}

/// The first number of the output at a moment that the pipeline asks for, summed.
double sum_at(vtkImageAlgorithm* source, double time)
{
  source->UpdateTimeStep(time);
  vtkImageData* image = source->GetOutput();
  EXPECT_EQ(image->GetInformation()->Get(vtkDataObject::DATA_TIME_STEP()), time);
  double sum = 0.0;
  for (vtkIdType n = 0; n < image->GetNumberOfPoints(); ++n)
  {
    sum += image->GetPointData()->GetScalars()->GetTuple1(n);
  }
  return sum;
}

}

TEST(CloudSource, EachKindComesWithItsDefaults)
{
  vtkNew<vtkBrumeCloudSource> source;
  source->SetCoverage(0.9);
  source->SetKindToCirrus();
  EXPECT_EQ(source->GetWidth(), 12000.0);
  EXPECT_EQ(source->GetBaseHeight(), 8000.0);
  EXPECT_EQ(source->GetCoverage(), 0.55);
  source->SetCoverage(0.2);
  source->SetKind(vtkBrumeCloudSource::KindCirrus); // no other one: nothing changes
  EXPECT_EQ(source->GetCoverage(), 0.2);
  source->SetKind(99);
  EXPECT_EQ(source->GetKind(), static_cast<int>(vtkBrumeCloudSource::KindCumulonimbus));
  source->SetKindToCumulus();
  EXPECT_EQ(source->GetWidth(), 2000.0);
  std::ostringstream text;
  source->SetKindToStratocumulus();
  source->Print(text);
  EXPECT_NE(text.str().find("Kind: Stratocumulus"), std::string::npos);
  EXPECT_NE(text.str().find("TopHeight: 1500 m"), std::string::npos);
  EXPECT_NE(text.str().find("Sparse: off"), std::string::npos);
}

TEST(CloudSource, EveryKindInPiecesAndSparse)
{
  for (int kind = 0; kind <= vtkBrumeCloudSource::KindCumulonimbus; ++kind)
  {
    vtkNew<vtkBrumeCloudSource> whole;
    vtkNew<vtkBrumeCloudSource> parts;
    for (vtkBrumeCloudSource* source : { whole.Get(), parts.Get() })
    {
      source->SetKind(kind);
      source->SetSize(50);
      source->SetTime(25.0);
      source->SetTopHeight(source->GetTopHeight() * 1.05);
    }
    expect_pieces_equal_the_whole(whole, parts);
    expect_sparse_equals_dense(whole);
  }
}

TEST(CloudSource, LayersFollowTheirHeightsAndCoverage)
{
  const auto total = [](void (*change)(vtkBrumeCloudSource*))
  {
    vtkNew<vtkBrumeCloudSource> source;
    source->SetKindToStratocumulus();
    source->SetSize(64);
    change(source);
    source->Update();
    double sum = 0.0;
    for (vtkIdType n = 0; n < source->GetOutput()->GetNumberOfPoints(); ++n)
    {
      sum += source->GetOutput()->GetPointData()->GetScalars()->GetTuple1(n);
    }
    return sum;
  };
  const double all = total([](vtkBrumeCloudSource*) {});
  EXPECT_GT(all, 1.3 * total([](vtkBrumeCloudSource* s) { s->SetCoverage(0.3); }));
  EXPECT_LT(all, total([](vtkBrumeCloudSource* s) { s->SetTopHeight(1900.0); }));
  vtkNew<vtkBrumeCloudSource> source;
  source->SetKindToStratocumulus();
  source->SetBaseHeight(1000.0);
  source->UpdateInformation();
  double origin[3];
  source->GetOutputInformation(0)->Get(vtkDataObject::ORIGIN(), origin);
  EXPECT_NEAR(origin[2], 950.0, 32.0);
}

TEST(CloudSource, IsToldTheTimeByThePipeline)
{
  vtkNew<vtkBrumeCloudSource> source;
  source->SetSize(40);
  source->SetEndTime(90.0);
  source->SetNumberOfTimeSteps(4);
  source->UpdateInformation();
  vtkInformation* info = source->GetOutputInformation(0);
  ASSERT_EQ(info->Length(vtkStreamingDemandDrivenPipeline::TIME_STEPS()), 4);
  EXPECT_EQ(info->Get(vtkStreamingDemandDrivenPipeline::TIME_STEPS())[2], 60.0);
  EXPECT_EQ(info->Get(vtkStreamingDemandDrivenPipeline::TIME_RANGE())[1], 90.0);
  const double at_60 = sum_at(source, 60.0);
  EXPECT_NE(at_60, sum_at(source, 0.0));
  EXPECT_NE(at_60, sum_at(source, 61.5)) << "between the steps, too";
  EXPECT_EQ(at_60, sum_at(source, 60.0));
}

TEST(CloudSource, SparseCanBeAborted)
{
  vtkNew<vtkBrumeCloudSource> source;
  source->SetSize(64);
  source->SparseOn();
  vtkNew<vtkCallbackCommand> abort;
  abort->SetCallback(abort_at_once);
  const unsigned long tag = source->AddObserver(vtkCommand::ProgressEvent, abort);
  source->Update();
  EXPECT_FALSE(source->GetSparseOutput()->GetVoxels());
  source->RemoveObserver(tag);
  source->Update();
  EXPECT_TRUE(source->GetSparseOutput()->GetVoxels());
}

TEST(FogSource, EveryKindInPiecesAndSparse)
{
  for (int kind = 0; kind <= vtkBrumeFogSource::KindValley; ++kind)
  {
    vtkNew<vtkBrumeFogSource> whole;
    vtkNew<vtkBrumeFogSource> parts;
    for (vtkBrumeFogSource* source : { whole.Get(), parts.Get() })
    {
      source->SetKind(kind);
      source->SetSize(60);
    }
    expect_pieces_equal_the_whole(whole, parts);
    expect_sparse_equals_dense(whole);
    double range[2];
    whole->Update();
    whole->GetOutput()->GetScalarRange(range);
    EXPECT_GT(range[1], 0.7);
  }
}

TEST(FogSource, EverySettingMakesOtherFog)
{
  const auto total = [](int kind, void (*change)(vtkBrumeFogSource*))
  {
    vtkNew<vtkBrumeFogSource> source;
    source->SetKind(kind);
    source->SetSize(48);
    source->SetTime(100.0);
    change(source);
    source->Update();
    double sum = 0.0;
    for (vtkIdType n = 0; n < source->GetOutput()->GetNumberOfPoints(); ++n)
    {
      sum += source->GetOutput()->GetPointData()->GetScalars()->GetTuple1(n);
    }
    return sum;
  };
  for (const int kind : { vtkBrumeFogSource::KindHeight, vtkBrumeFogSource::KindValley })
  {
    const double usual = total(kind, [](vtkBrumeFogSource*) {});
    EXPECT_EQ(usual, total(kind, [](vtkBrumeFogSource* s) { s->SetSeed(1); }));
    EXPECT_NE(usual, total(kind, [](vtkBrumeFogSource* s) { s->SetSeed(2); }));
    EXPECT_NE(usual, total(kind, [](vtkBrumeFogSource* s) { s->SetTime(300.0); }));
    EXPECT_NE(usual, total(kind, [](vtkBrumeFogSource* s) { s->SetWidth(3000.0); }));
    EXPECT_LT(usual, total(kind, [](vtkBrumeFogSource* s) { s->SetNoise(0.2); }));
    EXPECT_NE(usual, total(kind, [](vtkBrumeFogSource* s) { s->SetDetailSize(300.0); }));
    EXPECT_NE(usual, total(kind, [](vtkBrumeFogSource* s) { s->SetOctaves(2); }));
    EXPECT_NE(usual, total(kind, [](vtkBrumeFogSource* s) { s->SetWind(0.0, 5.0, 0.0); }));
  }
  const double height = total(vtkBrumeFogSource::KindHeight, [](vtkBrumeFogSource*) {});
  EXPECT_LT(height,
    total(vtkBrumeFogSource::KindHeight, [](vtkBrumeFogSource* s) { s->SetScaleHeight(150.0); }));
  EXPECT_NE(height,
    total(vtkBrumeFogSource::KindHeight, [](vtkBrumeFogSource* s) { s->SetTopHeight(700.0); }));
  EXPECT_GT(height,
    total(vtkBrumeFogSource::KindHeight, [](vtkBrumeFogSource* s) { s->SetBaseHeight(250.0); }));
  const double valley = total(vtkBrumeFogSource::KindValley, [](vtkBrumeFogSource*) {});
  EXPECT_LT(valley,
    total(vtkBrumeFogSource::KindValley, [](vtkBrumeFogSource* s) { s->SetCoverage(0.8); }));
  EXPECT_GT(valley,
    total(vtkBrumeFogSource::KindValley, [](vtkBrumeFogSource* s) { s->SetSoftness(120.0); }));
  EXPECT_LT(
    valley, total(vtkBrumeFogSource::KindValley, [](vtkBrumeFogSource* s) { s->SetSink(90.0); }));
  EXPECT_NE(valley,
    total(vtkBrumeFogSource::KindValley, [](vtkBrumeFogSource* s) { s->SetRelief(900.0); }));
}

TEST(FogSource, TakesAHeightMapAndHandsItOut)
{
  // A slope along x, whose lower half is to be under fog.
  vtkNew<vtkImageData> slope;
  slope->SetExtent(3, 43, -5, 5, 7, 7);
  slope->SetOrigin(-2300.0, 0.0, 0.0);
  slope->SetSpacing(100.0, 400.0, 1.0);
  vtkNew<vtkFloatArray> heights;
  for (int n = 0; n < 41 * 11; ++n)
  {
    heights->InsertNextValue(static_cast<float>(n % 41 * 10));
  }
  slope->GetPointData()->SetScalars(heights);
  vtkNew<vtkBrumeFogSource> source;
  source->SetInputData(slope);
  source->SetKindToValley();
  source->SetNoise(0.0);
  source->SetCoverage(0.5);
  source->SetSize(100);
  source->Update();
  const auto value_at = [&](double x, double z)
  {
    vtkImageData* image = source->GetOutput();
    return image->GetPointData()->GetScalars()->GetTuple1(image->FindPoint(x, 0.0, z));
  };
  // The map spans x from -2000 to 2000, heights from 0 to 400; the level is 200.
  EXPECT_EQ(value_at(-1900.0, 100.0), 1.0);
  EXPECT_EQ(value_at(1500.0, 190.0), 0.0);
  EXPECT_EQ(source->GetOutput()->FindPoint(0.0, 0.0, 390.0), -1) << "no fog, no box";
  vtkNew<vtkImageData> ground;
  source->GetGround(ground);
  EXPECT_EQ(ground->GetNumberOfPoints(), 41 * 11);
  EXPECT_DOUBLE_EQ(ground->GetOrigin()[0], -2000.0);
  EXPECT_EQ(ground->GetPointData()->GetScalars()->GetTuple1(40), 400.0);

  // Another height, other fog; and a map of two layers is none.
  heights->FillValue(50.0f);
  heights->SetValue(0, 0.0f);
  heights->Modified();
  slope->Modified();
  source->Update();
  EXPECT_LT(source->GetOutput()->GetBounds()[5], 60.0);
  slope->SetExtent(3, 43, -5, 5, 7, 8);
  slope->GetPointData()->Initialize();
  slope->AllocateScalars(VTK_FLOAT, 1);
  vtkNew<vtkCallbackCommand> counter;
  int errors = 0;
  counter->SetCallback(count_progress);
  counter->SetClientData(&errors);
  source->AddObserver(vtkCommand::ErrorEvent, counter);
  source->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, counter);
  source->Update();
  EXPECT_GT(errors, 0);

  // Nor is one that is turned.
  slope->SetExtent(3, 43, -5, 5, 7, 7);
  slope->GetPointData()->Initialize();
  slope->GetPointData()->SetScalars(heights);
  errors = 0;
  source->Update();
  EXPECT_EQ(errors, 0);
  slope->SetDirectionMatrix(0, -1, 0, 1, 0, 0, 0, 0, 1);
  slope->Modified();
  source->Update();
  EXPECT_GT(errors, 0);
}

namespace
{

/// A height map that tells of so many moments.
class MovingGround : public vtkImageAlgorithm
{
public:
  static MovingGround* New();
  int Steps = 1;

protected:
  MovingGround() { this->SetNumberOfInputPorts(0); }
  int RequestInformation(vtkInformation*,
    vtkInformationVector**,
    vtkInformationVector* outputs) override
  {
    vtkInformation* info = outputs->GetInformationObject(0);
    const int extent[6] = { 0, 8, 0, 8, 0, 0 };
    const double steps[3] = { 0.0, 1.0, 2.0 };
    info->Set(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), extent, 6);
    info->Set(vtkStreamingDemandDrivenPipeline::TIME_STEPS(), steps, this->Steps);
    return 1;
  }
  void ExecuteDataWithInformation(vtkDataObject* output, vtkInformation* info) override
  {
    vtkImageData* image = this->AllocateOutputData(output, info);
    image->GetPointData()->GetScalars()->Fill(5.0);
    image->SetScalarComponentFromDouble(0, 0, 0, 0, 0.0);
  }
};
vtkStandardNewMacro(MovingGround);

}

TEST(FogSource, RefusesGroundThatMoves)
{
  vtkNew<MovingGround> ground;
  vtkNew<vtkBrumeFogSource> source;
  source->SetInputConnection(ground->GetOutputPort());
  source->SetKindToValley();
  source->SetSize(20);
  EXPECT_EQ(error_of(source), "");
  ground->Steps = 3;
  ground->Modified();
  EXPECT_NE(error_of(source).find("the height map changes over time"), std::string::npos);
  source->SetKindToHeight(); // which stands on no map
  EXPECT_EQ(error_of(source), "");
}

TEST(FogSource, CanBeAbortedAndHoldsItsSettings)
{
  vtkNew<vtkBrumeFogSource> source;
  source->SetSize(64);
  expect_abort_and_recovery(source);
  source->SetNoise(7.0);
  EXPECT_EQ(source->GetNoise(), 1.0);
  source->SetKind(12);
  EXPECT_EQ(source->GetKind(), static_cast<int>(vtkBrumeFogSource::KindValley));
  std::ostringstream text;
  source->Print(text);
  EXPECT_NE(text.str().find("Kind: Valley"), std::string::npos);
  EXPECT_NE(text.str().find("ScaleHeight: 90 m"), std::string::npos);
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

TEST(SmokeSource, IsSparseInDensityAndInTemperature)
{
  for (const double time : { 0.0, 3.7 })
  {
    vtkNew<vtkBrumeSmokeSource> source;
    source->SetSize(90);
    source->SetTime(time);
    source->SetWidth(3.0);
    source->SetAirTemperature(290.3);
    expect_sparse_equals_dense(source);
    source->SetSparseQuantityToTemperature();
    expect_sparse_equals_dense(source, 290.3);
    source->SparseOn();
    source->Update();
    EXPECT_EQ(source->GetSparseOutput()->GetName(), "temperature");
    // Of 45 x 45 x 90 voxels fewer than half: the rest is air, and takes no brick.
    EXPECT_LT(source->GetSparseOutput()->GetVoxels()->places().size(), 6 * 6 * 12 / 2);
  }
}

TEST(SmokeSource, IsAirWhereItSaysSo)
{
  const brume::Plume plume;
  int air = 0;
  for (int n = 0; n < 24 * 24 * 24; ++n)
  {
    const glm::dvec3 lower = glm::dvec3(n % 24, n / 24 % 24, n / 576) * glm::dvec3(0.2, 0.2, 0.4) -
                             glm::dvec3(2.4, 2.4, 0.8);
    const brume::Box box{ lower, lower + glm::dvec3(0.2, 0.2, 0.4) };
    if (plume.range_in(box, 2.0).upper > 0.0f)
    {
      continue;
    }
    ++air;
    for (int m = 0; m < 27; ++m)
    {
      const glm::dvec3 part(m % 3 * 0.5, m / 3 % 3 * 0.5, m / 9 * 0.5);
      ASSERT_EQ(plume.value(lower + part * (box.upper - box.lower), 2.0), 0.0f);
    }
  }
  EXPECT_GT(air, 4000);
}

TEST(SignedDistanceSource, IsSparseAsADensityAndAsALevelSet)
{
  vtkNew<vtkBrumeSignedDistanceSource> source;
  source->SetSize(60);
  source->SetDescription("(smooth-unite 0.3 (sphere 1) (move 0 0 1.2 (box 0.5 0.5 0.5 0.1)))");
  expect_sparse_equals_dense(source);
  source->SetQuantityToDistance();
  source->UpdateInformation();
  const double spacing = source->GetOutputInformation(0)->Get(vtkDataObject::SPACING())[0];
  const double band = static_cast<float>(3.0 * spacing);
  expect_sparse_equals_dense(source, band, band);
  source->SetBandWidth(5.0);
  const double wider = static_cast<float>(5.0 * spacing);
  expect_sparse_equals_dense(source, wider, wider);
  source->SparseOn();
  source->Update();
  EXPECT_EQ(source->GetSparseOutput()->GetGridClass(), vtkBrumeSparseVolume::GridClassLevelSet);
  EXPECT_FALSE(source->GetOutputInformation(0)->Has(vtkStreamingDemandDrivenPipeline::TIME_STEPS()))
    << "shapes do not move";
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
  const std::vector<double> hot =
    totals([](vtkBrumeSmokeSource* s) { s->SetSourceTemperature(2500.0); });
  const std::vector<double> cold =
    totals([](vtkBrumeSmokeSource* s) { s->SetAirTemperature(250.0); });
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
