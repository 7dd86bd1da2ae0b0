// A volume's picture is the same after it has been through a file, but for what the format rounds.
#include "../support/vtk_scenes.h"

#include "vtkBrumeImageReader.h"
#include "vtkBrumeImageWriter.h"
#include "vtkBrumeOpenVDBReader.h"
#include "vtkBrumeOpenVDBWriter.h"
#include "vtkBrumeRayMarchMapper.h"
#include "vtkBrumeSparseVolume.h"

#include "dense_volume.h"

#include "vtkMatrix3x3.h"
#include "vtkMatrix4x4.h"

#include <gtest/gtest.h>

#include <filesystem>

using namespace vtk_scenes;

namespace
{

constexpr int edge = 32;

struct Frame
{
  const char* name;
  double direction[9];
};
const double c = std::cos(0.5), s = std::sin(0.5);
const Frame Frames[] = { { "identity", { 1, 0, 0, 0, 1, 0, 0, 0, 1 } },
  { "rotated", { c, -s, 0, s* c, c* c, -s, s* s, c* s, c } },
  { "left-handed", { c, s, 0, s, -c, 0, 0, 0, 1 } } };

/// A ball that touches the outer bricks of 8³ on every side, and one voxel of nothing around them,
/// so that the box of the sparse volume is the image's and rays are sampled at the same places.
vtkSmartPointer<vtkImageData> ball_in(const Frame& frame, int type)
{
  auto data = image(edge + 2,
    edge + 2,
    edge + 2,
    type,
    [](int i, int j, int k, int)
    {
      const double v = ball(2.0 * (i - 1) / (edge - 1) - 1,
        2.0 * (j - 1) / (edge - 1) - 1,
        2.0 * (k - 1) / (edge - 1) - 1);
      const bool within = i > 0 && j > 0 && k > 0 && i <= edge && j <= edge && k <= edge;
      return !within || v < 0.5 ? 0.0 : v + 1.0;
    });
  data->SetExtent(-1, edge, -1, edge, -1, edge);
  data->SetSpacing(0.5, 0.75, 0.6);
  data->SetOrigin(30, -20, 7);
  data->SetDirectionMatrix(frame.direction);
  if (type == VTK_FLOAT) // numbers with fractions
  {
    vtkDataArray* values = data->GetPointData()->GetScalars();
    for (vtkIdType i = 0; i < values->GetNumberOfTuples(); ++i)
    {
      values->SetComponent(i, 0, values->GetComponent(i, 0) * 0.97);
    }
  }
  return data;
}

brume::Film draw(vtkDataObject* data, const double centre[3])
{
  const auto volume = volume_of();
  vtkNew<vtkBrumeRayMarchMapper> mapper;
  mapper->SetInputDataObject(data);
  mapper->SetAutoAdjustSampleDistances(0);
  mapper->SetSampleDistance(0.3);
  volume->SetMapper(mapper);
  vtkNew<vtkCamera> camera;
  look_at(camera, centre, 60.0);
  brume::Film film(40, 36);
  mapper->RenderFilm(volume, camera, nullptr, film);
  return film;
}

TEST(RoundTrips, NoFormatChangesThePictureBeyondItsOwnRounding)
{
  const std::string folder = BRUME_TEST_OUTPUT "/round-trips";
  std::filesystem::create_directories(folder);
  for (const Frame& frame : Frames)
  {
    for (int type : { VTK_UNSIGNED_CHAR, VTK_SHORT, VTK_FLOAT })
    {
      const auto data = ball_in(frame, type);
      double centre[3];
      data->GetCenter(centre);
      const brume::Film expected = draw(data, centre);
      ASSERT_GT(most_opaque(expected), 0.8);
      for (const char* ending : { ".vti", ".nrrd", ".mha", ".nii", ".nii.gz" })
      {
        for (bool patient : { false, true })
        {
          SCOPED_TRACE(std::string(frame.name) + ending + (patient ? ", a patient's" : ""));
          const std::string path = folder + "/a" + ending;
          vtkNew<vtkBrumeImageWriter> writer;
          writer->SetInputData(data);
          writer->SetFileName(path.c_str());
          writer->SetPatientAxes(patient);
          writer->SetLengthUnit("mm");
          ASSERT_EQ(writer->Write(), 1) << writer->GetErrorMessage();
          vtkNew<vtkBrumeImageReader> reader;
          reader->SetFileName(path.c_str());
          reader->Update();
          ASSERT_STREQ(reader->GetErrorMessage(), "");
          // NIfTI-1 holds places in single precision: some 1e-6 of a voxel here.
          const double limit = ending[2] == 'i' ? 1e-4 : 2e-6;
          EXPECT_LT(difference(expected, draw(reader->GetOutput(), centre)), limit);
        }
      }
      for (bool half : { false, true })
      {
        SCOPED_TRACE(std::string(frame.name) + ".vdb" + (half ? ", half" : ""));
        const std::string path = folder + "/a.vdb";
        vtkNew<vtkBrumeOpenVDBWriter> writer;
        writer->SetInputData(data);
        writer->SetFileName(path.c_str());
        writer->SetHalf(half);
        ASSERT_EQ(writer->Write(), 1) << writer->GetErrorMessage();
        vtkNew<vtkBrumeOpenVDBReader> reader;
        reader->SetFileName(path.c_str());
        reader->Update();
        ASSERT_STREQ(reader->GetErrorMessage(), "");
        // Whole numbers to 2048 are what they are in half precision, others are right to 2⁻¹¹.
        const double limit = half && type == VTK_FLOAT ? 2e-3 : 5e-6;
        EXPECT_LT(difference(expected, draw(reader->GetOutput(), centre)), limit);
        // And dense again, without the voxel of nothing around it: other places on the rays.
        std::vector<std::string> messages;
        const auto dense = brume::make_dense(reader->GetOutput(), "a.vdb", 0, messages);
        EXPECT_TRUE(messages.empty());
        int dims[3];
        dense->GetDimensions(dims);
        EXPECT_EQ(dims[0], edge);
        double place[3], other[3];
        const int corner[3] = { 0, 0, 0 };
        dense->GetPoint(0, place);
        data->TransformIndexToPhysicalPoint(corner, other);
        for (int a = 0; a < 3; ++a)
        {
          EXPECT_NEAR(place[a], other[a], 1e-12);
        }
        EXPECT_NEAR(dense->GetDirectionMatrix()->Determinant(),
          data->GetDirectionMatrix()->Determinant(),
          1e-12);
        for (int k = 0; k < edge; k += 3)
          for (int j = 0; j < edge; ++j)
            for (int i = 0; i < edge; ++i)
            {
              ASSERT_NEAR(dense->GetScalarComponentAsDouble(i, j, k, 0),
                data->GetScalarComponentAsDouble(i, j, k, 0),
                half && type == VTK_FLOAT ? 0.1 : 1e-6);
            }
      }
    }
  }
}

TEST(RoundTrips, AShearedVolumeMadeDenseSaysSoAndKeepsItsCentreAndMemoryItsLimit)
{
  const std::string folder = BRUME_TEST_OUTPUT "/round-trips";
  std::filesystem::create_directories(folder);
  const auto data = ball_in(Frames[0], VTK_FLOAT);
  vtkNew<vtkBrumeOpenVDBWriter> writer;
  writer->SetInputData(data);
  writer->SetFileName((folder + "/sheared.vdb").c_str());
  ASSERT_EQ(writer->Write(), 1);
  vtkNew<vtkBrumeOpenVDBReader> reader;
  reader->SetFileName((folder + "/sheared.vdb").c_str());
  reader->Update();
  for (double sign : { 1.0, -1.0 })
  {
    vtkNew<vtkBrumeSparseVolume> volume;
    volume->ShallowCopy(reader->GetOutput());
    vtkNew<vtkMatrix4x4> matrix;
    matrix->DeepCopy(volume->GetIndexToWorld());
    matrix->SetElement(0, 1, 0.2);
    matrix->SetElement(2, 2, sign * 0.6);
    volume->SetIndexToWorld(matrix);
    std::vector<std::string> messages;
    const auto dense = brume::make_dense(volume, "sheared", 0, messages);
    ASSERT_EQ(messages.size(), 1u);
    EXPECT_NE(messages[0].find("not perpendicular"), std::string::npos);
    EXPECT_NEAR(dense->GetDirectionMatrix()->Determinant(), sign, 1e-12);
    double a[4] = { 0.5 * (edge - 1), 0.5 * (edge - 1), 0.5 * (edge - 1), 1 };
    double b[3];
    dense->GetCenter(b);
    matrix->MultiplyPoint(a, a);
    for (int axis = 0; axis < 3; ++axis)
    {
      EXPECT_NEAR(a[axis], b[axis], 1e-9);
    }
  }
  std::vector<std::string> messages;
  EXPECT_THROW(brume::make_dense(reader->GetOutput(), "small", 1000, messages), std::runtime_error);
}

}
