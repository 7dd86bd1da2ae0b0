// Shapes, fields and particles as VTK pipeline sources, and shapes as implicit functions in VTK's
// own filters.
#include "vtkBrumeParticleSource.h"
#include "vtkBrumePhantomSource.h"
#include "vtkBrumeSignedDistance.h"
#include "vtkBrumeSignedDistanceSource.h"
#include "vtkBrumeSmokeSource.h"
#include "vtkBrumeSparseVolume.h"

#include "Transport/sparse_voxels.h"
#include "tests/support/source_checks.h"

#include "vtkContourFilter.h"
#include "vtkCutter.h"
#include "vtkDataArray.h"
#include "vtkInformation.h"
#include "vtkMath.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkTransform.h"

#include <tbb/global_control.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <sstream>

using namespace brume_tests;

namespace
{

constexpr double endless = std::numeric_limits<double>::infinity();
const char* const drop = "(smooth-unite 0.3 (sphere 1) (move 0 0 1.2 (box 0.5 0.5 0.5 0.1)))";

void expect_same_bytes(vtkImageData* a, vtkImageData* b)
{
  ASSERT_EQ(a->GetNumberOfPoints(), b->GetNumberOfPoints());
  vtkDataArray* x = a->GetPointData()->GetScalars();
  vtkDataArray* y = b->GetPointData()->GetScalars();
  EXPECT_EQ(std::memcmp(x->GetVoidPointer(0),
              y->GetVoidPointer(0),
              static_cast<std::size_t>(x->GetNumberOfTuples()) * x->GetDataTypeSize()),
    0);
}

vtkSmartPointer<vtkImageData> copy_of(vtkImageData* image)
{
  auto copy = vtkSmartPointer<vtkImageData>::New();
  copy->DeepCopy(image);
  return copy;
}

}

TEST(SignedDistance, IsAnImplicitFunction)
{
  vtkNew<vtkBrumeSignedDistance> shape;
  shape->SetDescription("(torus 1 0.25)");
  EXPECT_STREQ(shape->GetDescription(), "(torus 1 0.25)");
  EXPECT_DOUBLE_EQ(shape->FunctionValue(3.0, 0.0, 0.0), 1.75);
  double x[3] = { 0.0, 2.0, 0.0 }, g[3];
  shape->FunctionGradient(x, g);
  EXPECT_NEAR(g[0], 0.0, 1e-9);
  EXPECT_NEAR(g[1], 1.0, 1e-9);
  EXPECT_EQ(shape->GetLipschitz(), 1.0);
  double bounds[6];
  EXPECT_TRUE(shape->GetShapeBounds(bounds));
  EXPECT_DOUBLE_EQ(bounds[1], 1.25);
  EXPECT_DOUBLE_EQ(bounds[4], -0.25);
  vtkNew<vtkTransform> shift;
  shift->Translate(-3.0, 0.0, 0.0);
  shape->SetTransform(shift);
  EXPECT_DOUBLE_EQ(shape->FunctionValue(6.0, 0.0, 0.0), 1.75);
  shape->SetTransform(static_cast<vtkAbstractTransform*>(nullptr));
  shape->SetDescription("(plane 0 0 1 0)");
  EXPECT_FALSE(shape->GetShapeBounds(bounds));
  EXPECT_GT(bounds[0], bounds[1]);
  std::ostringstream text;
  shape->Print(text);
  EXPECT_NE(text.str().find("(plane 0 0 1 0)"), std::string::npos);
}

TEST(SignedDistance, KeepsItsShapeWhenATextIsWrong)
{
  vtkNew<vtkBrumeSignedDistance> shape;
  shape->SetDescription("(sphere 2)");
  std::string error;
  vtkNew<vtkCallbackCommand> listen;
  listen->SetClientData(&error);
  listen->SetCallback([](vtkObject*, unsigned long, void* data, void* message)
    { *static_cast<std::string*>(data) += static_cast<const char*>(message); });
  shape->AddObserver(vtkCommand::ErrorEvent, listen);
  const vtkMTimeType time = shape->GetMTime();
  shape->SetDescription("(sphere\n  -2)");
  EXPECT_NE(error.find("line 1, column 1: sphere: the radius must be above 0"), std::string::npos)
    << error;
  shape->SetDescription(nullptr);
  EXPECT_NE(error.find("there is no shape"), std::string::npos) << error;
  EXPECT_EQ(shape->GetMTime(), time);
  EXPECT_DOUBLE_EQ(shape->FunctionValue(5.0, 0.0, 0.0), 3.0);
}

TEST(SignedDistance, CutsWithVTK)
{
  // vtkCutter on an image: what it draws is the shape's surface, within what a cell can do.
  vtkNew<vtkBrumePhantomSource> room;
  room->SetKindToConstant();
  room->SetSize(48);
  vtkNew<vtkBrumeSignedDistance> shape;
  shape->SetDescription("(subtract (sphere 0.8) (move 0.5 0 0 (sphere 0.5)))");
  vtkNew<vtkCutter> cutter;
  cutter->SetInputConnection(room->GetOutputPort());
  cutter->SetCutFunction(shape);
  cutter->Update();
  vtkPolyData* surface = cutter->GetOutput();
  ASSERT_GT(surface->GetNumberOfPoints(), 2000);
  double worst = 0.0;
  for (vtkIdType n = 0; n < surface->GetNumberOfPoints(); ++n)
  {
    double p[3];
    surface->GetPoint(n, p);
    worst = std::max(worst, std::fabs(shape->EvaluateFunction(p)));
  }
  const double spacing = 2.0 / 48.0;
  EXPECT_LT(worst, spacing); // at the edge of the bite; elsewhere the square of it
}

TEST(SignedDistanceSource, ItsContourIsTheSurface)
{
  vtkNew<vtkBrumeSignedDistanceSource> source;
  source->SetDescription("(ellipsoid 1 0.7 0.5)");
  source->SetSize(60);
  source->SetQuantityToDistance();
  vtkNew<vtkContourFilter> contour;
  contour->SetInputConnection(source->GetOutputPort());
  contour->SetValue(0, 0.0);
  contour->Update();
  EXPECT_STREQ(source->GetOutput()->GetPointData()->GetScalars()->GetName(), "distance");
  vtkPolyData* surface = contour->GetOutput();
  ASSERT_GT(surface->GetNumberOfPoints(), 2000);
  for (vtkIdType n = 0; n < surface->GetNumberOfPoints(); ++n)
  {
    double p[3];
    surface->GetPoint(n, p);
    EXPECT_NEAR(std::sqrt(p[0] * p[0] + p[1] * p[1] / 0.49 + p[2] * p[2] / 0.25), 1.0, 2e-3);
  }
}

TEST(SignedDistanceSource, FillsTheShapeWithDensity)
{
  vtkNew<vtkBrumeSignedDistanceSource> source;
  source->SetSize(80);
  source->Update();
  vtkImageData* ball = source->GetOutput();
  EXPECT_EQ(ball->GetScalarType(), VTK_FLOAT);
  EXPECT_STREQ(ball->GetPointData()->GetScalars()->GetName(), "density");
  // The bounds of the ball, and 5 % of its width on each side.
  EXPECT_NEAR(ball->GetOrigin()[0] - 0.5 * ball->GetSpacing()[0], -1.1, 1e-12);
  double range[2], volume = 0.0;
  ball->GetScalarRange(range);
  EXPECT_EQ(range[0], 0.0);
  EXPECT_EQ(range[1], 1.0);
  vtkDataArray* density = ball->GetPointData()->GetScalars();
  for (vtkIdType n = 0; n < density->GetNumberOfTuples(); ++n)
  {
    volume += density->GetTuple1(n) * std::pow(ball->GetSpacing()[0], 3);
  }
  EXPECT_NEAR(volume, 4.0 / 3.0 * vtkMath::Pi(), 0.005);
}

TEST(SignedDistanceSource, PiecesEqualTheWhole)
{
  for (const int quantity : { 0, 1 })
  {
    vtkNew<vtkBrumeSignedDistanceSource> whole, parts;
    for (vtkBrumeSignedDistanceSource* s : { whole.Get(), parts.Get() })
    {
      s->SetSize(30);
      s->SetDescription(drop);
      s->SetQuantity(quantity);
    }
    expect_pieces_equal_the_whole(whole, parts);
  }
}

TEST(SignedDistanceSource, TellsWhatIsWrong)
{
  vtkNew<vtkBrumeSignedDistanceSource> source;
  source->SetSize(8);
  source->SetDescription("(sphere 1");
  EXPECT_NE(error_of(source).find("line 1, column 1: the bracket opened here is not closed"),
    std::string::npos);
  source->SetDescription("(repeat 2 2 2 (sphere 0.5))");
  EXPECT_NE(error_of(source).find("set Bounds"), std::string::npos);
  EXPECT_EQ(source->GetOutput()->GetNumberOfPoints(), 0);
  source->SetBounds(-2.0, 2.0, -2.0, 2.0, -1.0, 1.0);
  EXPECT_EQ(error_of(source), "");
  EXPECT_EQ(source->GetOutput()->GetNumberOfPoints(), 8 * 8 * 4);
  source->SetBounds(-2.0, 2.0, 2.0, -2.0, -1.0, 1.0);
  EXPECT_NE(error_of(source).find("Bounds must be finite"), std::string::npos);
  source->SetBounds(-2.0, endless, -2.0, 2.0, -1.0, 1.0);
  EXPECT_NE(error_of(source).find("Bounds must be finite"), std::string::npos);
  source->SetBounds(-2.0, 2.0, -2.0, 2.0, -1.0, 1.0);
  source->SetSize(64);
  expect_abort_and_recovery(source);
  std::ostringstream text;
  source->Print(text);
  EXPECT_NE(text.str().find("Quantity: Density"), std::string::npos);
}

TEST(PhantomFields, AreWhatTheirHeaderSays)
{
  vtkNew<vtkBrumePhantomSource> source;
  source->SetSize(40);
  source->SetDensity(2.0);
  const auto value = [&](double x, double y, double z)
  {
    source->Update();
    vtkImageData* image = source->GetOutput();
    return image->GetPointData()->GetScalars()->GetTuple1(image->FindPoint(x, y, z));
  };
  source->SetKindToConstant();
  EXPECT_EQ(value(0.3, -0.9, 0.9), 2.0);
  EXPECT_STREQ(source->GetOutput()->GetPointData()->GetScalars()->GetName(), "density");
  EXPECT_EQ(source->GetOutput()->GetScalarType(), VTK_FLOAT);
  EXPECT_DOUBLE_EQ(source->GetOutput()->GetOrigin()[2], -0.975);
  source->SetKindToRamp();
  EXPECT_NEAR(value(-0.975, 0, 0), 0.025, 1e-6);
  EXPECT_NEAR(value(0.975, 0, 0), 1.975, 1e-6);
  source->SetKindToBall();
  EXPECT_EQ(value(0, 0, 0.6), 2.0);
  EXPECT_EQ(value(0, 0, 0.95), 0.0);
  source->SetKindToSoftBall();
  EXPECT_NEAR(value(0.025, 0.025, 0.025), 2.0 * (1.0 - 3 * 0.025 * 0.025 / 0.64), 1e-6);
  source->SetKindToSlab();
  source->SetNormal(0.0, 1.0, 0.0);
  EXPECT_EQ(value(0.5, 0.1, 0.5), 2.0);
  EXPECT_EQ(value(0.5, 0.5, 0.5), 0.0);
  source->SetKindToChecker();
  source->SetCells(2);
  EXPECT_EQ(value(-0.5, -0.5, -0.5), 2.0);
  EXPECT_EQ(value(0.5, -0.5, -0.5), 0.0);
  EXPECT_EQ(value(0.5, 0.5, -0.5), 2.0);
  source->SetKindToSheppLogan();
  EXPECT_NEAR(value(0, 0, 0), 0.2, 1e-6);
  source->RaisedContrastOff();
  EXPECT_NEAR(value(0, 0, 0), 1.02, 1e-6);
}

TEST(PhantomFields, KnowTheirOpticalDepth)
{
  vtkNew<vtkBrumePhantomSource> source;
  source->SetSize(64);
  source->SetEdgeWidth(1.0);
  for (int kind = vtkBrumePhantomSource::KindSheppLogan; kind <= vtkBrumePhantomSource::KindChecker;
       ++kind)
  {
    source->SetKind(kind);
    source->Update();
    vtkImageData* image = source->GetOutput();
    // Rays along z through the middles of voxels: the sum over them is nearly the integral.
    for (const auto& [i, j] : { std::pair(31, 32), std::pair(20, 40), std::pair(50, 25) })
    {
      double sum = 0.0;
      for (int k = 0; k < 64; ++k)
      {
        sum += image->GetScalarComponentAsDouble(i, j, k, 0) * image->GetSpacing()[2];
      }
      const double origin[3] = { image->GetOrigin()[0] + i * image->GetSpacing()[0],
        image->GetOrigin()[1] + j * image->GetSpacing()[1],
        -5.0 };
      const double along[3] = { 0.0, 0.0, 3.0 };
      EXPECT_NEAR(source->GetOpticalDepth(origin, along, 0.0, endless), sum, 0.05)
        << "kind " << kind;
    }
  }
  const double o[3] = { 0, 0, 0 }, d[3] = { 0, 0, 1 };
  source->SetKindToBall();
  EXPECT_DOUBLE_EQ(source->GetOpticalDepth(o, d, -endless, endless), 1.6);
  EXPECT_TRUE(std::isnan(source->GetOpticalDepth(o, o, 0.0, 1.0)));
  source->SetKindToHeadCT();
  EXPECT_TRUE(std::isnan(source->GetOpticalDepth(o, d, 0.0, 1.0)));
  source->SetKindToSlab();
  source->SetNormal(0.0, 0.0, 0.0);
  EXPECT_TRUE(std::isnan(source->GetOpticalDepth(o, d, 0.0, 1.0)));
  EXPECT_NE(error_of(source).find("the normal of a slab"), std::string::npos);
  EXPECT_EQ(source->GetOutput()->GetNumberOfPoints(), 0);
}

TEST(PhantomFields, RefuseWhatIsNoNumber)
{
  vtkNew<vtkBrumePhantomSource> source;
  source->SetKind(vtkBrumePhantomSource::KindBall);
  source->SetSize(8);
  const double nowhere[3] = { std::nan(""), 0.0, 0.0 };
  const double along[3] = { 1.0, 0.0, 0.0 };
  EXPECT_TRUE(std::isnan(source->GetOpticalDepth(nowhere, along, -1.0, 1.0)));
  const double endless_place[3] = { 0.0, endless, 0.0 };
  EXPECT_TRUE(std::isnan(source->GetOpticalDepth(endless_place, along, -1.0, 1.0)));
  source->SetEdgeWidth(std::nan(""));
  EXPECT_NE(error_of(source).find("EdgeWidth must be finite"), std::string::npos);
}

TEST(ParticleSource, RefusesTimesWithoutAnEnd)
{
  vtkNew<vtkBrumeParticleSource> source;
  source->SetSize(8);
  source->SetEndTime(endless);
  EXPECT_NE(error_of(source).find("must be finite"), std::string::npos);
}

TEST(PhantomFields, PiecesEqualTheWhole)
{
  for (int kind = vtkBrumePhantomSource::KindTorsoCT; kind <= vtkBrumePhantomSource::KindChecker;
       ++kind)
  {
    vtkNew<vtkBrumePhantomSource> whole, parts;
    for (vtkBrumePhantomSource* s : { whole.Get(), parts.Get() })
    {
      s->SetSize(24);
      s->SetKind(kind);
    }
    expect_pieces_equal_the_whole(whole, parts);
    if (kind == vtkBrumePhantomSource::KindTorsoCT)
    {
      EXPECT_EQ(whole->GetOutput()->GetScalarType(), VTK_SHORT);
      int size[3];
      whole->GetOutput()->GetDimensions(size);
      EXPECT_EQ(std::vector<int>(size, size + 3), (std::vector<int>{ 17, 12, 24 }));
      EXPECT_STREQ(whole->GetOutput()->GetPointData()->GetScalars()->GetName(), "Hounsfield");
    }
  }
}

TEST(ParticleSource, HasTimeSteps)
{
  vtkNew<vtkBrumeParticleSource> source;
  source->SetStartTime(1.0);
  source->SetEndTime(2.0);
  source->SetNumberOfTimeSteps(5);
  source->UpdateInformation();
  vtkInformation* info = source->GetOutputInformation(0);
  ASSERT_EQ(info->Length(vtkStreamingDemandDrivenPipeline::TIME_STEPS()), 5);
  const double* steps = info->Get(vtkStreamingDemandDrivenPipeline::TIME_STEPS());
  EXPECT_EQ(
    std::vector<double>(steps, steps + 5), (std::vector<double>{ 1.0, 1.25, 1.5, 1.75, 2.0 }));
  const double* range = info->Get(vtkStreamingDemandDrivenPipeline::TIME_RANGE());
  EXPECT_EQ(range[0], 1.0);
  EXPECT_EQ(range[1], 2.0);
  source->SetEndTime(0.0);
  source->UpdateInformation();
  EXPECT_EQ(info->Length(vtkStreamingDemandDrivenPipeline::TIME_STEPS()), 1);
}

template <typename Source>
void expect_moments_do_not_depend_on_their_order()
{
  vtkNew<Source> source;
  source->SetSize(32);
  source->SetTime(4.0);
  source->Update();
  const auto own = copy_of(source->GetOutput());
  EXPECT_EQ(own->GetInformation()->Get(vtkDataObject::DATA_TIME_STEP()), 4.0);
  source->UpdateTimeStep(2.5);
  const auto early = copy_of(source->GetOutput());
  EXPECT_EQ(early->GetInformation()->Get(vtkDataObject::DATA_TIME_STEP()), 2.5);
  source->UpdateTimeStep(4.0);
  expect_same_bytes(source->GetOutput(), own);
  source->UpdateTimeStep(2.5);
  expect_same_bytes(source->GetOutput(), early);
  double sum = 0.0;
  for (vtkIdType n = 0; n < own->GetNumberOfPoints(); ++n)
  {
    sum += std::fabs(own->GetPointData()->GetScalars()->GetTuple1(n) -
                     early->GetPointData()->GetScalars()->GetTuple1(n));
  }
  EXPECT_GT(sum, 1.0) << "it moves";
  tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  vtkNew<Source> alone;
  alone->SetSize(32);
  alone->UpdateTimeStep(2.5);
  expect_same_bytes(alone->GetOutput(), early);
}

TEST(ParticleSource, MomentsDoNotDependOnTheirOrder)
{
  expect_moments_do_not_depend_on_their_order<vtkBrumeParticleSource>();
}

TEST(SmokeSource, MomentsDoNotDependOnTheirOrder)
{
  expect_moments_do_not_depend_on_their_order<vtkBrumeSmokeSource>();
}

TEST(ParticleSource, PiecesEqualTheWhole)
{
  vtkNew<vtkBrumeParticleSource> whole, parts;
  for (vtkBrumeParticleSource* s : { whole.Get(), parts.Get() })
  {
    s->SetSize(40);
    s->SetNumberOfEmitters(3);
    s->SetRate(300.0);
  }
  expect_pieces_equal_the_whole(whole, parts);
  double range[2];
  whole->GetOutput()->GetScalarRange(range);
  EXPECT_EQ(range[0], 0.0);
  EXPECT_GT(range[1], 0.1);
  EXPECT_LT(range[1], 20.0);
}

TEST(ParticleSource, SparseHoldsTheSameVoxels)
{
  vtkNew<vtkBrumeParticleSource> source;
  source->SetSize(48);
  source->SetRate(300.0);
  source->Update();
  const auto dense = copy_of(source->GetOutput());
  source->SparseOn();
  source->Update();
  vtkBrumeSparseVolume* sparse = source->GetSparseOutput();
  ASSERT_TRUE(sparse && sparse->GetVoxels());
  const auto& origin = sparse->GetVoxels()->origin();
  vtkIdType active = 0;
  for (int k = 0; k < 48; ++k)
    for (int j = 0; j < 48; ++j)
      for (int i = 0; i < 48; ++i)
      {
        const double value = dense->GetScalarComponentAsDouble(i, j, k, 0);
        active += value != 0.0;
        ASSERT_EQ(sparse->GetVoxels()->value(i - origin[0], j - origin[1], k - origin[2]), value);
      }
  EXPECT_EQ(sparse->GetActiveVoxelCount(), active);
  EXPECT_GT(active, 500);
  EXPECT_LT(active, 48 * 48 * 48 / 2);
}

TEST(ParticleSource, EverySettingMakesAnotherCloud)
{
  const auto total = [](void (*change)(vtkBrumeParticleSource*))
  {
    vtkNew<vtkBrumeParticleSource> source;
    source->SetSize(24);
    source->SetRate(100.0);
    change(source);
    source->Update();
    vtkDataArray* density = source->GetOutput()->GetPointData()->GetScalars();
    double sum = 0.0;
    for (vtkIdType n = 0; n < density->GetNumberOfTuples(); ++n)
    {
      sum += density->GetTuple1(n) * (1.0 + 1e-3 * (n % 24));
    }
    return sum;
  };
  const double usual = total([](vtkBrumeParticleSource*) {});
  EXPECT_GT(usual, 1.0);
  void (*const changes[])(vtkBrumeParticleSource*) = {
    [](vtkBrumeParticleSource* s) { s->SetSeed(2); },
    [](vtkBrumeParticleSource* s) { s->SetTime(-1.0); },
    [](vtkBrumeParticleSource* s) { s->SetWarmUp(3.0); },
    [](vtkBrumeParticleSource* s) { s->SetWidth(7.0); },
    [](vtkBrumeParticleSource* s) { s->SetNumberOfEmitters(2); },
    [](vtkBrumeParticleSource* s) { s->SetEmitterRadius(0.3); },
    [](vtkBrumeParticleSource* s) { s->SetRate(120.0); },
    [](vtkBrumeParticleSource* s) { s->SetSpeed(4.0); },
    [](vtkBrumeParticleSource* s) { s->SetSpread(0.5); },
    [](vtkBrumeParticleSource* s) { s->SetLife(4.0); },
    [](vtkBrumeParticleSource* s) { s->SetParticleRadius(0.2); },
    [](vtkBrumeParticleSource* s) { s->SetGrowth(0.1); },
    [](vtkBrumeParticleSource* s) { s->SetDensity(0.3); },
    [](vtkBrumeParticleSource* s) { s->SetWind(0.0, 0.15, 0.0); },
    [](vtkBrumeParticleSource* s) { s->SetRise(0.0); },
    [](vtkBrumeParticleSource* s) { s->SetResponse(0.3); },
    [](vtkBrumeParticleSource* s) { s->SetTurbulence(0.2); },
    [](vtkBrumeParticleSource* s) { s->SetEddySize(1.3); },
  };
  int n = 0;
  for (const auto change : changes)
  {
    EXPECT_NE(total(change), usual) << "change " << n;
    ++n;
  }
}

TEST(ParticleSource, TellsWhatIsWrongAndCanBeAborted)
{
  vtkNew<vtkBrumeParticleSource> source;
  source->SetSize(32);
  source->SetRate(1e9);
  EXPECT_NE(error_of(source).find("more than 20 million"), std::string::npos);
  EXPECT_EQ(source->GetOutput()->GetNumberOfPoints(), 0);
  source->SetRate(100.0);
  source->SetLife(std::nan(""));
  EXPECT_NE(error_of(source).find("the life must be above 0"), std::string::npos);
  source->SetLife(2.0);
  EXPECT_EQ(error_of(source), "");
  source->SetSize(64);
  expect_abort_and_recovery(source);
  std::ostringstream text;
  source->Print(text);
  EXPECT_NE(text.str().find("Turbulence: 0.8 m/s"), std::string::npos);
}
