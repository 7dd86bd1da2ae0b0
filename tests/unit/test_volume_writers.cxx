// vtkBrumeImageWriter and vtkBrumeOpenVDBWriter: what is written comes back.
#include "../support/vdb_files.h"

#include "vtkBrumeImageReader.h"
#include "vtkBrumeImageWriter.h"
#include "vtkBrumeOpenVDBReader.h"
#include "vtkBrumeOpenVDBWriter.h"
#include "vtkBrumeSparseVolume.h"

#include "Transport/sparse_voxels.h"

#include "vtkBitArray.h"
#include "vtkCallbackCommand.h"
#include "vtkCommand.h"
#include "vtkDataArray.h"
#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkMath.h"
#include "vtkMatrix3x3.h"
#include "vtkMatrix4x4.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkSmartPointer.h"

#include <openvdb/tools/LevelSetSphere.h>

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace
{

namespace fs = std::filesystem;

std::string folder(const std::string& name)
{
  const std::string path = BRUME_TEST_OUTPUT "/volume-writers/" + name;
  fs::remove_all(path);
  fs::create_directories(path);
  return path;
}

struct Frame
{
  const char* name;
  double direction[9];
};
const double c = std::cos(0.4), s = std::sin(0.4);
const Frame Frames[] = { { "identity", { 1, 0, 0, 0, 1, 0, 0, 0, 1 } },
  { "rotated", { c, -s, 0, s* c, c* c, -s, s* s, c* s, c } },
  { "half turn", { -1, 0, 0, 0, -1, 0, 0, 0, 1 } },
  { "permuted", { 0, 0, 1, 1, 0, 0, 0, 1, 0 } },
  { "left-handed", { c, s, 0, s, -c, 0, 0, 0, 1 } } };

/// An image of distinct values whose extent does not begin at 0.
vtkSmartPointer<vtkImageData> image_of(int type, const Frame& frame, int components = 1)
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetExtent(2, 8, -3, 2, 1, 5);
  image->SetSpacing(0.7, 1.3, 2.1);
  image->SetOrigin(-12.5, 40.25, 3.0 / 7.0);
  image->SetDirectionMatrix(frame.direction);
  image->AllocateScalars(type, components);
  vtkDataArray* values = image->GetPointData()->GetScalars();
  values->SetName("density");
  const double low = std::max(values->GetDataTypeMin(), -1000.0);
  const double high = std::min(values->GetDataTypeMax(), 1000.0);
  const vtkIdType count = values->GetNumberOfValues();
  for (vtkIdType i = 0; i < count; ++i)
  {
    double v =
      low + (high - low) * static_cast<double>((i * 37) % count) / static_cast<double>(count);
    v = type == VTK_FLOAT || type == VTK_DOUBLE ? v + 1.0 / 3.0 : std::floor(v);
    values->SetComponent(i / components, static_cast<int>(i % components), v);
  }
  return image;
}

/// Every voxel of `read` is `written`'s at the same place in the world, and there are as many.
void expect_same_voxels(vtkImageData* read, vtkImageData* written, double places)
{
  vtkDataArray* out = read->GetPointData()->GetScalars();
  vtkDataArray* in = written->GetPointData()->GetScalars();
  ASSERT_TRUE(out);
  ASSERT_EQ(out->GetNumberOfTuples(), in->GetNumberOfTuples());
  ASSERT_EQ(out->GetNumberOfComponents(), in->GetNumberOfComponents());
  ASSERT_EQ(out->GetDataTypeSize(), in->GetDataTypeSize());
  EXPECT_GT(read->GetDirectionMatrix()->Determinant(), 0.0);
  for (vtkIdType i = 0; i < out->GetNumberOfTuples(); ++i)
  {
    double world[3];
    double index[3];
    int ijk[3];
    read->GetPoint(i, world);
    written->TransformPhysicalPointToContinuousIndex(world, index);
    for (int a = 0; a < 3; ++a)
    {
      ijk[a] = vtkMath::Round(index[a]);
      ASSERT_NEAR(index[a], ijk[a], places) << "voxel " << i;
    }
    for (int k = 0; k < out->GetNumberOfComponents(); ++k)
    {
      ASSERT_EQ(out->GetComponent(i, k), in->GetComponent(written->ComputePointId(ijk), k))
        << "voxel " << i;
    }
  }
}

/// Hears errors, and stops a writer at a progress of one half if asked.
struct Ear
{
  vtkNew<vtkCallbackCommand> command;
  int errors = 0;
  bool stop = false;
  double last = 0.0;
  bool rises = true;

  vtkAlgorithm* algorithm;

  explicit Ear(vtkAlgorithm* heard)
    : algorithm(heard)
  {
    this->command->SetClientData(this);
    this->command->SetCallback(
      [](vtkObject* caller, unsigned long event, void* data, void*)
      {
        Ear& self = *static_cast<Ear*>(data);
        auto* algorithm = static_cast<vtkAlgorithm*>(caller);
        if (event == vtkCommand::ErrorEvent)
        {
          ++self.errors;
          return;
        }
        self.rises = self.rises && algorithm->GetProgress() >= self.last;
        self.last = algorithm->GetProgress();
        if (self.stop && self.last > 0.1)
        {
          algorithm->AbortExecuteOn();
        }
      });
    this->algorithm->AddObserver(vtkCommand::ErrorEvent, this->command);
    this->algorithm->AddObserver(vtkCommand::ProgressEvent, this->command);
  }
  ~Ear() { this->algorithm->RemoveObserver(this->command); }
  Ear(const Ear&) = delete;
  Ear& operator=(const Ear&) = delete;
};

struct Format
{
  const char* ending;
  bool compress;
  double places; ///< how well it holds places, in voxels
};
const Format Formats[] = { { ".vti", false, 1e-12 },
  { ".vti", true, 1e-12 },
  { ".nrrd", false, 1e-12 },
  { ".nrrd", true, 1e-12 },
  { ".mha", false, 1e-12 },
  { ".mha", true, 1e-12 },
  { ".nii", false, 2e-5 },
  { ".nii.gz", false, 2e-5 },
  { ".raw", false, 1e-12 } };

TEST(ImageWriter, WhatIsWrittenComesBackInEachFormatTypeAndPlace)
{
  const std::string where = folder("round-trips");
  for (const Format& format : Formats)
  {
    int n = 0;
    for (int type : { VTK_SIGNED_CHAR,
           VTK_UNSIGNED_CHAR,
           VTK_SHORT,
           VTK_UNSIGNED_SHORT,
           VTK_INT,
           VTK_UNSIGNED_INT,
           VTK_LONG,
           VTK_UNSIGNED_LONG,
           VTK_FLOAT,
           VTK_DOUBLE })
    {
      for (int components : { 1, 3 })
      {
        // Each type in one frame and each frame in two types, a patient's and the world's in turn.
        const Frame& frame = Frames[n % 5];
        const bool patient = n % 2;
        ++n;
        SCOPED_TRACE(std::string(format.ending) + ", type " + std::to_string(type) + ", " +
                     frame.name + (patient ? ", a patient" : "") +
                     (format.compress ? ", deflated" : ""));
        const auto image = image_of(type, frame, components);
        const std::string path = where + "/" + std::to_string(n) + format.ending;
        vtkNew<vtkBrumeImageWriter> writer;
        const Ear ear(writer);
        writer->SetInputData(image);
        writer->SetFileName(path.c_str());
        writer->SetLengthUnit(patient ? "mm" : "km");
        writer->SetValueUnit(patient ? "HU" : "g/m3");
        writer->SetPatientAxes(patient);
        writer->SetCompress(format.compress);
        ASSERT_EQ(writer->Write(), 1) << writer->GetErrorMessage();
        EXPECT_EQ(ear.errors, 0);
        EXPECT_TRUE(ear.rises);
        EXPECT_EQ(ear.last, 1.0);

        vtkNew<vtkBrumeImageReader> reader;
        reader->SetFileName(path.c_str());
        reader->Update();
        ASSERT_STREQ(reader->GetErrorMessage(), "");
        EXPECT_STREQ(reader->GetLengthUnit(), patient ? "mm" : "km");
        EXPECT_STREQ(reader->GetValueUnit(), patient ? "HU" : "g/m3");
        EXPECT_EQ(reader->GetPatientAxes(), patient);
        if (std::string(format.ending) == ".vti" && frame.name == std::string("left-handed"))
        {
          continue; // VTI keeps the direction as it is
        }
        expect_same_voxels(reader->GetOutput(), image, format.places);
      }
    }
  }
  for (const auto& entry : fs::directory_iterator(where))
  {
    EXPECT_NE(entry.path().filename().string()[0], '.') << "debris: " << entry.path();
  }
}

// A TIFF holds voxels, spacing and the unit of lengths, and tells that the rest is lost.
TEST(ImageWriter, TiffHoldsVoxelsAndSpacing)
{
  const std::string where = folder("tiff");
  for (int type : { VTK_UNSIGNED_CHAR, VTK_SHORT, VTK_UNSIGNED_SHORT, VTK_INT, VTK_FLOAT, VTK_DOUBLE })
  {
    for (const bool compress : { false, true })
    {
      SCOPED_TRACE("type " + std::to_string(type) + (compress ? ", deflated" : ""));
      const auto image = image_of(type, Frames[0], type == VTK_FLOAT ? 3 : 1);
      const std::string path = where + "/" + std::to_string(type) + ".tif";
      vtkNew<vtkBrumeImageWriter> writer;
      writer->SetInputData(image);
      writer->SetFileName(path.c_str());
      writer->SetLengthUnit("mm");
      writer->SetCompress(compress);
      ASSERT_EQ(writer->Write(), 1) << writer->GetErrorMessage();
      ASSERT_GE(writer->GetNumberOfMessages(), 1);
      EXPECT_NE(std::string(writer->GetMessage(0)).find("origin"), std::string::npos);
      vtkNew<vtkBrumeImageReader> reader;
      reader->SetFileName(path.c_str());
      reader->Update();
      ASSERT_STREQ(reader->GetErrorMessage(), "");
      EXPECT_STREQ(reader->GetLengthUnit(), "mm");
      vtkImageData* read = reader->GetOutput();
      for (int axis = 0; axis < 3; ++axis)
      {
        EXPECT_EQ(read->GetDimensions()[axis], image->GetDimensions()[axis]);
        EXPECT_DOUBLE_EQ(read->GetSpacing()[axis], image->GetSpacing()[axis]);
      }
      vtkDataArray* out = read->GetPointData()->GetScalars();
      vtkDataArray* in = image->GetPointData()->GetScalars();
      ASSERT_EQ(out->GetNumberOfValues(), in->GetNumberOfValues());
      for (vtkIdType i = 0; i < in->GetNumberOfTuples(); ++i)
      {
        for (int k = 0; k < in->GetNumberOfComponents(); ++k)
        {
          ASSERT_EQ(out->GetComponent(i, k), in->GetComponent(i, k)) << i;
        }
      }
    }
  }
  vtkNew<vtkBrumeImageWriter> writer;
  const Ear ear(writer);
  writer->SetInputData(image_of(VTK_LONG, Frames[0]));
  writer->SetFileName((where + "/long.tif").c_str());
  EXPECT_EQ(writer->Write(), 0);
  EXPECT_NE(std::string(writer->GetErrorMessage()).find("64 bits"), std::string::npos);
}

TEST(ImageWriter, TellsWhatAFormatCannotHold)
{
  const std::string where = folder("messages");
  const auto told = [&](const char* name, vtkImageData* image, const char* unit, bool patient)
  {
    vtkNew<vtkBrumeImageWriter> writer;
    writer->SetInputData(image);
    writer->SetFileName((where + "/" + name).c_str());
    writer->SetLengthUnit(unit);
    writer->SetPatientAxes(patient);
    EXPECT_EQ(writer->Write(), 1);
    std::string all;
    for (int i = 0; i < writer->GetNumberOfMessages(); ++i)
    {
      all += std::string(writer->GetMessage(i)) + "\n";
    }
    EXPECT_EQ(writer->GetMessage(writer->GetNumberOfMessages()), nullptr);
    return all;
  };
  auto image = image_of(VTK_FLOAT, Frames[1]);
  EXPECT_EQ(told("a.nrrd", image, "mm", true), "");
  EXPECT_EQ(told("a.vti", image, "mm", true), "");
  EXPECT_EQ(told("a.mha", image, "mm", true), "the name of its array, density, is left out\n");
  EXPECT_NE(told("b.mha", image, "m", false).find("the unit of length, m,"), std::string::npos);
  EXPECT_NE(told("b.nii", image, "m", false).find("not is in a comment"), std::string::npos);
  EXPECT_EQ(told("b.nii", image, "m", false).find("the unit of length"), std::string::npos);
  EXPECT_NE(told("a.nii", image, "mm", true).find("seven digits"), std::string::npos);
  vtkNew<vtkFloatArray> more;
  more->SetName("temperature");
  more->SetNumberOfTuples(image->GetNumberOfPoints());
  more->Fill(300.0);
  image->GetPointData()->AddArray(more);
  EXPECT_NE(told("two.nrrd", image, "mm", true).find("of its 2 arrays"), std::string::npos);
  EXPECT_EQ(told("two.vti", image, "mm", true), "");
  vtkNew<vtkBrumeImageReader> reader;
  reader->SetFileName((where + "/two.vti").c_str());
  reader->Update();
  EXPECT_TRUE(reader->GetOutput()->GetPointData()->GetArray("temperature"));
}

/// A writer's error, its words, and a folder that holds what it held.
template <class Writer>
void expect_error(Writer* writer, const char* path, const std::string& words)
{
  SCOPED_TRACE(words);
  const Ear ear(writer);
  writer->SetFileName(path);
  EXPECT_EQ(writer->Write(), 0);
  EXPECT_EQ(ear.errors, 1);
  EXPECT_NE(std::string(writer->GetErrorMessage()).find(words), std::string::npos)
    << writer->GetErrorMessage();
}

TEST(ImageWriter, APatientInMetresComesBackInMillimetres)
{
  const std::string path = folder("metres") + "/a.mha";
  const auto image = image_of(VTK_FLOAT, Frames[1]);
  vtkNew<vtkBrumeImageWriter> writer;
  writer->SetInputData(image);
  writer->SetFileName(path.c_str());
  writer->SetLengthUnit("m");
  writer->SetPatientAxes(true);
  ASSERT_EQ(writer->Write(), 1);
  vtkNew<vtkBrumeImageReader> reader;
  reader->SetFileName(path.c_str());
  reader->Update();
  EXPECT_STREQ(reader->GetLengthUnit(), "mm");
  for (int a = 0; a < 3; ++a)
  {
    EXPECT_NEAR(reader->GetOutput()->GetSpacing()[a], 1000.0 * image->GetSpacing()[a], 1e-9);
  }
}

TEST(ImageWriter, TheNameOfAnArrayStays)
{
  const std::string where = folder("name");
  for (const char* name : { "/a.nrrd", "/a.raw", "/a.vti" })
  {
    vtkNew<vtkBrumeImageWriter> writer;
    writer->SetInputData(image_of(VTK_FLOAT, Frames[0]));
    writer->SetFileName((where + name).c_str());
    writer->SetLengthUnit("mm");
    ASSERT_EQ(writer->Write(), 1);
    EXPECT_EQ(writer->GetNumberOfMessages(), 0) << name << ": " << writer->GetMessage(0);
    vtkNew<vtkBrumeImageReader> reader;
    reader->SetFileName((where + name).c_str());
    reader->Update();
    EXPECT_STREQ(reader->GetOutput()->GetPointData()->GetScalars()->GetName(), "density") << name;
  }
}

TEST(ImageWriter, LongAxesGoIntoNifti2)
{
  const std::string where = folder("nifti-2");
  for (bool patient : { false, true })
    for (const char* name : { "/a.nii", "/a.nii.gz" })
    {
      SCOPED_TRACE(std::string(name) + (patient ? ", a patient" : ""));
      vtkNew<vtkImageData> image;
      image->SetDimensions(3, 40000, 2);
      image->SetSpacing(0.1, 0.2, 0.3);
      image->SetOrigin(1.0 / 3.0, -1e6 / 7.0, 2);
      image->SetDirectionMatrix(Frames[1].direction);
      image->AllocateScalars(VTK_UNSIGNED_SHORT, 1);
      vtkDataArray* values = image->GetPointData()->GetScalars();
      for (vtkIdType i = 0; i < values->GetNumberOfTuples(); ++i)
      {
        values->SetComponent(i, 0, static_cast<double>(i * 7919 % 65521));
      }
      vtkNew<vtkBrumeImageWriter> writer;
      writer->SetInputData(image);
      writer->SetFileName((where + name).c_str());
      writer->SetLengthUnit(patient ? "mm" : "km");
      writer->SetValueUnit("HU");
      writer->SetPatientAxes(patient);
      ASSERT_EQ(writer->Write(), 1) << writer->GetErrorMessage();
      EXPECT_NE(std::string(writer->GetMessage(0)).find("it is NIfTI-2"), std::string::npos);
      vtkNew<vtkBrumeImageReader> reader;
      reader->SetFileName((where + name).c_str());
      reader->Update();
      ASSERT_STREQ(reader->GetErrorMessage(), "");
      EXPECT_EQ(std::string(reader->GetFormat()).substr(0, 7), "NIfTI-2");
      EXPECT_STREQ(reader->GetLengthUnit(), patient ? "mm" : "km");
      EXPECT_STREQ(reader->GetValueUnit(), "HU");
      EXPECT_EQ(reader->GetPatientAxes(), patient);
      expect_same_voxels(reader->GetOutput(), image, 1e-6); // doubles: 40 000 voxels away
      for (int a = 0; a < 3; ++a)
      {
        EXPECT_NEAR(reader->GetOutput()->GetOrigin()[a], image->GetOrigin()[a], 1e-9);
      }
    }
}

TEST(VolumeWriters, ErrorsAreToldAndLeaveNothing)
{
  const std::string where = folder("errors");
  const auto image = image_of(VTK_FLOAT, Frames[0]);
  vtkNew<vtkImageData> empty;
  for (const std::string ending : { ".vti", ".nrrd", ".mha", ".nii", ".nii.gz", ".raw", ".tif" })
  {
    vtkNew<vtkBrumeImageWriter> writer;
    writer->SetInputData(image);
    expect_error(
      writer.Get(), (where + "/none/a" + ending).c_str(), "none does not exist: make the folder");
    writer->SetInputData(empty);
    expect_error(writer.Get(), (where + "/a" + ending).c_str(), "there are no voxels");
  }
  vtkNew<vtkBrumeImageWriter> writer;
  writer->SetInputData(image);
  expect_error(writer.Get(), (where + "/a.png").c_str(), "names no format");
  expect_error(writer.Get(), nullptr, "SetFileName");
  vtkNew<vtkBrumeOpenVDBWriter> vdb;
  vdb->SetInputData(image);
  expect_error(vdb.Get(), (where + "/none/a.vdb").c_str(), "none does not exist: make the folder");
  expect_error(vdb.Get(), nullptr, "SetFileName");
  vdb->SetInputData(image_of(VTK_FLOAT, Frames[0], 3));
  expect_error(vdb.Get(), (where + "/a.vdb").c_str(), "no array of one component");
  EXPECT_TRUE(fs::is_empty(where));
}

TEST(VolumeWriters, StopWhenAskedAndLeaveTheFormerFile)
{
  const std::string where = folder("stopped");
  vtkNew<vtkImageData> image;
  image->SetDimensions(160, 128, 128);
  image->AllocateScalars(VTK_FLOAT, 1);
  auto* values = static_cast<float*>(image->GetScalarPointer());
  for (vtkIdType i = 0; i < image->GetNumberOfPoints(); ++i)
  {
    values[i] = static_cast<float>((i * 2654435761u) % 1000003u);
  }
  const auto stopped = [&](auto* writer, const std::string& name)
  {
    SCOPED_TRACE(name);
    const std::string path = where + "/" + name;
    std::ofstream(path) << "former";
    Ear ear(writer);
    ear.stop = true;
    writer->SetInputData(image);
    writer->SetFileName(path.c_str());
    writer->Write();
    EXPECT_EQ(ear.errors, 1);
    EXPECT_LT(ear.last, 0.9);
    std::string text;
    std::getline(std::ifstream(path), text);
    EXPECT_EQ(text, "former");
    fs::remove(path);
    EXPECT_TRUE(fs::is_empty(where));
  };
  for (const char* name : { "a.vti", "a.nrrd", "a.mha", "a.nii.gz", "a.raw", "a.tif" })
  {
    vtkNew<vtkBrumeImageWriter> writer;
    writer->SetCompress(name[2] == 'm');
    stopped(writer.Get(), name);
  }
  vtkNew<vtkBrumeOpenVDBWriter> writer;
  stopped(writer.Get(), "a.vdb");
}

/// The sparse volume of a file, by one grid's name.
vtkSmartPointer<vtkBrumeSparseVolume> read_vdb(const std::string& path,
  const char* grid = nullptr,
  int level_sets = vtkBrumeOpenVDBReader::LevelSetsAsDistances)
{
  vtkNew<vtkBrumeOpenVDBReader> reader;
  reader->SetFileName(path.c_str());
  reader->SetGridName(grid);
  reader->SetLevelSets(level_sets);
  reader->Update();
  EXPECT_STREQ(reader->GetErrorMessage(), "");
  return reader->GetOutput();
}

TEST(OpenVDBWriter, KeepsADenseVolumeInItsPlace)
{
  const std::string path = folder("dense") + "/a.vdb";
  for (const Frame& frame : Frames)
  {
    SCOPED_TRACE(frame.name);
    for (int type : { VTK_UNSIGNED_CHAR, VTK_SHORT, VTK_FLOAT, VTK_DOUBLE })
    {
      const auto image = image_of(type, frame);
      vtkNew<vtkBrumeOpenVDBWriter> writer;
      writer->SetInputData(image);
      writer->SetFileName(path.c_str());
      writer->SetLengthUnit("km");
      writer->SetValueUnit("g/m3");
      writer->SetBackground(5.0);
      ASSERT_EQ(writer->Write(), 1) << writer->GetErrorMessage();
      vtkNew<vtkBrumeOpenVDBReader> reader;
      reader->SetFileName(path.c_str());
      reader->Update();
      EXPECT_STREQ(reader->GetLengthUnit(), "km");
      EXPECT_STREQ(reader->GetValueUnit(), "g/m3");
      EXPECT_FALSE(reader->GetPatientAxes());
      vtkBrumeSparseVolume* volume = reader->GetOutput();
      ASSERT_TRUE(volume->GetVoxels());
      EXPECT_EQ(volume->GetVoxels()->background(), 5.0);
      const int* extent = image->GetExtent();
      const auto& origin = volume->GetVoxels()->origin();
      for (int k = extent[4] - 1; k <= extent[5] + 1; ++k)
        for (int j = extent[2] - 1; j <= extent[3] + 1; ++j)
          for (int i = extent[0] - 1; i <= extent[1] + 1; ++i)
          {
            const bool within = i >= extent[0] && i <= extent[1] && j >= extent[2] &&
                                j <= extent[3] && k >= extent[4] && k <= extent[5];
            const double expected = within ? image->GetScalarComponentAsDouble(i, j, k, 0) : 5.0;
            ASSERT_EQ(volume->GetVoxels()->value(i - origin[0], j - origin[1], k - origin[2]),
              static_cast<float>(expected));
          }
      vtkMatrix4x4* expected = image->GetIndexToPhysicalMatrix();
      for (int e = 0; e < 16; ++e)
      {
        EXPECT_NEAR(volume->GetIndexToWorld()->GetData()[e], expected->GetData()[e], 1e-12);
      }
    }
  }
}

TEST(OpenVDBWriter, LeavesOutTheBackgroundAndMakesTiles)
{
  vtkNew<vtkImageData> image;
  image->SetDimensions(48, 48, 48);
  image->AllocateScalars(VTK_FLOAT, 1);
  auto* values = static_cast<float*>(image->GetScalarPointer());
  for (int k = 0; k < 48; ++k)
    for (int j = 0; j < 48; ++j)
      for (int i = 0; i < 48; ++i)
      {
        const double r = std::hypot(i - 24.0, j - 24.0, k - 24.0);
        *values++ = static_cast<float>(r < 18.0 ? 2.0 : r < 20.0 ? 1.0 : i % 2 ? 0.001 : -0.001);
      }
  const std::string path = folder("background") + "/a.vdb";
  vtkNew<vtkBrumeOpenVDBWriter> writer;
  writer->SetInputData(image);
  writer->SetFileName(path.c_str());
  ASSERT_EQ(writer->Write(), 1);
  EXPECT_EQ(read_vdb(path)->GetActiveVoxelCount(), 48 * 48 * 48);
  writer->SetTolerance(0.0015);
  ASSERT_EQ(writer->Write(), 1);
  const auto volume = read_vdb(path);
  EXPECT_GT(volume->GetVoxels()->tiles().size(), 8u);
  vtkIdType expected = 0;
  values = static_cast<float*>(image->GetScalarPointer());
  for (vtkIdType i = 0; i < image->GetNumberOfPoints(); ++i)
  {
    expected += values[i] >= 1.0f;
  }
  EXPECT_EQ(volume->GetActiveVoxelCount(), expected);
  EXPECT_EQ(
    volume->GetGridClass(), vtkBrumeSparseVolume::GridClassUnknown); // negative values were there
  EXPECT_EQ(volume->GetValueRange()[0], 0.0);
}

TEST(OpenVDBWriter, LeavesOutSingleBitsAndBandsWithoutWidth)
{
  const std::string path = folder("bits") + "/a.vdb";
  const auto image = image_of(VTK_FLOAT, Frames[0]);
  vtkNew<vtkBitArray> bits;
  bits->SetName("mask");
  bits->SetNumberOfTuples(image->GetNumberOfPoints());
  bits->FillComponent(0, 1.0);
  image->GetPointData()->AddArray(bits);
  vtkNew<vtkBrumeOpenVDBWriter> writer;
  writer->SetInputData(image);
  writer->SetFileName(path.c_str());
  ASSERT_EQ(writer->Write(), 1) << writer->GetErrorMessage();
  ASSERT_EQ(writer->GetNumberOfMessages(), 1);
  EXPECT_STREQ(writer->GetMessage(0), "its array mask of single bits is left out");

  const auto sparse = read_vdb(path, "density");
  ASSERT_EQ(sparse->GetVoxels()->background(), 0.0);
  writer->SetInputDataObject(sparse);
  writer->SetGridClass(vtkBrumeOpenVDBWriter::GridClassLevelSet);
  expect_error(writer.Get(), path.c_str(), "its background is no width of a band: leave --grid-class out");
}

TEST(OpenVDBWriter, ASparseVolumeStaysWhatItIs)
{
  const std::string where = folder("sparse");
  auto density = vdb_files::fog("density", { 1000, -2000, 3000 }, 15.0);
  density->tree().addTile(1, { 1040, -2000, 3000 }, 0.5f, true);
  density->tree().addTile(2, { 1152, -2048, 2944 }, 0.25f, true);
  auto heat = vdb_files::fog("heat", { 0, 0, 0 }, 9.0, 300.0);
  heat->setSaveFloatAsHalf(true);
  auto surface =
    openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(30.0f, openvdb::Vec3f(1, 2, 3), 1.5f);
  surface->setName("surface");
  const std::string path = vdb_files::write(where, "in.vdb", { density, heat, surface });
  const std::string again = where + "/out.vdb";
  const auto first = read_vdb(path, "density");
  const auto second = read_vdb(path, "heat");
  const auto third = read_vdb(path, "surface");
  vtkNew<vtkBrumeOpenVDBWriter> writer;
  writer->AddInputDataObject(first);
  writer->AddInputDataObject(second);
  writer->AddInputDataObject(third);
  writer->SetFileName(again.c_str());
  ASSERT_EQ(writer->Write(), 1) << writer->GetErrorMessage();
  openvdb::io::File file(again);
  file.open();
  for (const openvdb::FloatGrid::Ptr& grid : { density, heat, surface })
  {
    SCOPED_TRACE(grid->getName());
    const auto read = openvdb::gridPtrCast<openvdb::FloatGrid>(file.readGrid(grid->getName()));
    ASSERT_TRUE(read);
    EXPECT_EQ(read->background(), grid->background());
    EXPECT_EQ(read->getGridClass(), grid->getGridClass());
    EXPECT_EQ(read->saveFloatAsHalf(), grid->saveFloatAsHalf());
    EXPECT_EQ(read->activeVoxelCount(), grid->activeVoxelCount());
    EXPECT_EQ(read->tree().leafCount(), grid->tree().leafCount());
    EXPECT_EQ(read->tree().activeTileCount(), grid->tree().activeTileCount());
    EXPECT_EQ(read->transform(), grid->transform());
    // Half precision was in the file already.
    const auto same = [&](float a, float b)
    { return grid->saveFloatAsHalf() ? a == static_cast<float>(openvdb::math::half(b)) : a == b; };
    for (auto voxel = grid->cbeginValueAll(); voxel; ++voxel)
    {
      openvdb::CoordBBox box;
      voxel.getBoundingBox(box);
      ASSERT_TRUE(same(read->tree().getValue(box.min()), *voxel)) << box.min();
      ASSERT_EQ(read->tree().isValueOn(box.min()), voxel.isValueOn()) << box.min();
    }
  }
  writer->HalfOn();
  ASSERT_EQ(writer->Write(), 1);
  EXPECT_EQ(read_vdb(again, "density")->GetVoxels()->type(), brume::VoxelType::Float16);
}

TEST(OpenVDBWriter, CutsDistancesToABandAndNamesSeveralGrids)
{
  vtkNew<vtkImageData> image;
  image->SetDimensions(40, 40, 40);
  image->SetSpacing(0.5, 0.5, 0.5);
  vtkNew<vtkFloatArray> distance;
  vtkNew<vtkDoubleArray> other;
  distance->SetName("distance");
  other->SetName("distance"); // the same name again, after it was renamed below
  for (int k = 0; k < 40; ++k)
    for (int j = 0; j < 40; ++j)
      for (int i = 0; i < 40; ++i)
      {
        distance->InsertNextValue(
          static_cast<float>(0.5 * std::hypot(i - 19.5, j - 19.5, k - 19.5) - 7.0));
        other->InsertNextValue(i);
      }
  image->GetPointData()->SetScalars(distance);
  const std::string path = folder("band") + "/a.vdb";
  vtkNew<vtkBrumeOpenVDBWriter> writer;
  writer->SetInputData(image);
  writer->SetGridClass(vtkBrumeOpenVDBWriter::GridClassLevelSet);
  writer->SetFileName(path.c_str());
  ASSERT_EQ(writer->Write(), 1);
  openvdb::io::File file(path);
  file.open();
  const auto read = openvdb::gridPtrCast<openvdb::FloatGrid>(file.readGrid("distance"));
  EXPECT_EQ(read->getGridClass(), openvdb::GRID_LEVEL_SET);
  EXPECT_EQ(read->background(), 1.5f);
  EXPECT_EQ(read->tree().getValue({ 20, 20, 20 }), -1.5f);
  EXPECT_FALSE(read->tree().isValueOn({ 20, 20, 20 }));
  const float expected = static_cast<float>(0.5 * std::hypot(33 - 19.5, 0.5, 0.5) - 7.0);
  EXPECT_EQ(read->tree().getValue({ 33, 20, 20 }), expected);
  EXPECT_TRUE(read->tree().isValueOn({ 33, 20, 20 }));
  EXPECT_LT(read->tree().leafCount(), 120u);

  // Two arrays of one name become two grids, each with its own background.
  image->GetPointData()->AddArray(other);
  EXPECT_EQ(image->GetPointData()->GetNumberOfArrays(), 1); // VTK replaces it
  other->SetName("number");
  image->GetPointData()->SetScalars(distance);
  image->GetPointData()->AddArray(other);
  vtkNew<vtkBrumeOpenVDBWriter> two;
  two->AddInputDataObject(image);
  two->AddInputDataObject(image);
  two->SetArrayBackground("number", 7.0);
  two->SetFileName(path.c_str());
  ASSERT_EQ(two->Write(), 1);
  vtkNew<vtkBrumeOpenVDBReader> reader;
  reader->SetFileName(path.c_str());
  reader->UpdateInformation();
  ASSERT_EQ(reader->GetNumberOfGrids(), 4);
  EXPECT_EQ(read_vdb(path, "number")->GetVoxels()->background(), 7.0);
  EXPECT_EQ(read_vdb(path, "number_2")->GetVoxels()->background(), 7.0);
  EXPECT_EQ(read_vdb(path, "distance_2")->GetVoxels()->background(), 0.0);
}

}
