// Series over time: how many volumes and when, and that the one that is asked for is read; and the
// limit on memory. The files are made byte by byte.
#include "scan_files.h"

#include "vtkBrumeImageReader.h"

#include "vtkCallbackCommand.h"
#include "vtkCommand.h"
#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkStreamingDemandDrivenPipeline.h"

using namespace scan_files;

namespace
{

constexpr int Steps = 3;

vtkSmartPointer<vtkBrumeImageReader> reader_of(const std::string& path)
{
  vtkNew<vtkCallbackCommand> silent;
  silent->SetCallback([](vtkObject*, unsigned long, void*, void*) {});
  auto reader = vtkSmartPointer<vtkBrumeImageReader>::New();
  reader->AddObserver(vtkCommand::ErrorEvent, silent);
  reader->SetFileName(path.c_str());
  return reader;
}

std::vector<double> times_of(vtkBrumeImageReader* reader)
{
  reader->UpdateInformation();
  vtkInformation* info = reader->GetOutputInformation(0);
  auto* key = vtkStreamingDemandDrivenPipeline::TIME_STEPS();
  const double* times = info->Get(key);
  return times ? std::vector<double>(times, times + info->Length(key)) : std::vector<double>();
}

/// Voxels of all steps: those of step t are voxels() plus 2000 t.
std::string all_voxels(bool text = false)
{
  std::string bytes;
  for (int t = 0; t < Steps; ++t)
  {
    for (int value : numbers())
    {
      const auto number = static_cast<std::int16_t>(value + 2000 * t);
      if (text)
      {
        bytes += std::to_string(number) + (value % 5 ? " " : "\n");
      }
      else
      {
        bytes.resize(bytes.size() + 2);
        put<std::int16_t>(bytes, bytes.size() - 2, number);
      }
    }
  }
  return bytes;
}

/// The steps in an order that is not the file's, each with its voxels, and the nearest to a time.
void expect_series(const std::string& path, const std::vector<double>& times)
{
  const auto reader = reader_of(path);
  const std::vector<double> told = times_of(reader);
  ASSERT_STREQ(reader->GetErrorMessage(), "");
  ASSERT_EQ(told.size(), times.size());
  for (std::size_t i = 0; i < times.size(); ++i)
  {
    EXPECT_NEAR(told[i], times[i], 1e-6 * std::abs(times[i]));
  }
  const std::vector<int> values = numbers();
  for (int t : { 2, 0, 1 })
  {
    const double gap = (times[1] - times[0]) * 0.3;
    reader->UpdateTimeStep(times[t] + gap);
    ASSERT_STREQ(reader->GetErrorMessage(), "");
    vtkImageData* image = reader->GetOutput();
    ASSERT_EQ(image->GetNumberOfPoints(), Nx * Ny * Nz);
    for (int n = 0; n < Nx * Ny * Nz; ++n)
    {
      ASSERT_EQ(image->GetPointData()->GetScalars()->GetComponent(n, 0), values[n] + 2000 * t)
        << "step " << t << ", voxel " << n;
    }
    EXPECT_NEAR(
      image->GetInformation()->Get(vtkDataObject::DATA_TIME_STEP()), told[t], 1e-9);
  }
}

std::string nifti_series(int units = 2 | 16)
{
  NiftiOptions o;
  o.dim[0] = 4;
  o.dim[4] = Steps;
  o.units = static_cast<char>(units);
  std::string header = nifti_header(o);
  put<float>(header, 76 + 16, 1500.f); // a volume each 1500 ms
  put<float>(header, 136, 500.f);      // the first at 500 ms
  return header;
}

}

TEST(Series, Nifti)
{
  const std::string here = folder();
  expect_series(save(here + "a.nii", nifti_series() + all_voxels()), { 0.5, 2.0, 3.5 });
  expect_series(save(here + "a.nii.gz", deflated(nifti_series() + all_voxels())), { 0.5, 2.0, 3.5 });
  EXPECT_STREQ(reader_of(here + "a.nii")->GetTimeUnit(), ""); // before an update
  const auto reader = reader_of(here + "a.nii");
  reader->UpdateInformation();
  EXPECT_STREQ(reader->GetTimeUnit(), "s");
}

TEST(Series, MetaImage)
{
  const std::string here = folder();
  const std::string head = "ObjectType = Image\nNDims = 4\nDimSize = 5 4 3 3\n"
                           "ElementSpacing = 1 1 1 0.25\nOffset = 0 0 0 10\n"
                           "ElementType = MET_SHORT\n";
  const std::vector<double> times{ 10, 10.25, 10.5 };
  expect_series(save(here + "a.mha", head + "ElementDataFile = LOCAL\n" + all_voxels()), times);
  expect_series(save(here + "b.mha",
                  head + "CompressedData = True\nElementDataFile = LOCAL\n" +
                    deflated(all_voxels(), 15)),
    times);
  expect_series(save(here + "c.mha",
                  head + "BinaryData = False\nElementDataFile = LOCAL\n" + all_voxels(true)),
    times);
  // One file a volume, then one file a slice.
  const std::string bytes = all_voxels();
  std::string volumes, slices;
  for (int t = 0; t < Steps; ++t)
  {
    const std::string name = "v" + std::to_string(t) + ".raw";
    save(here + name, bytes.substr(t * 120, 120));
    volumes += name + "\n";
    for (int k = 0; k < Nz; ++k)
    {
      const std::string slice = "s" + std::to_string(t * Nz + k) + ".raw";
      save(here + slice, bytes.substr(t * 120 + k * 40, 40));
      slices += slice + "\n";
    }
  }
  expect_series(save(here + "d.mhd", head + "ElementDataFile = LIST\n" + volumes), times);
  expect_series(save(here + "e.mhd", head + "ElementDataFile = LIST\n" + slices), times);
}

TEST(Series, Nrrd)
{
  const std::string here = folder();
  const std::string head = "NRRD0005\ntype: short\nendian: little\ndimension: 4\nsizes: 5 4 3 3\n"
                           "kinds: domain domain domain time\nspacings: 1 1 1 20\n"
                           "axis mins: 0 0 0 40\nunits: \"mm\" \"mm\" \"mm\" \"ms\"\n";
  const std::vector<double> times{ 0.04, 0.06, 0.08 };
  expect_series(save(here + "a.nrrd", head + "encoding: raw\n\n" + all_voxels()), times);
  expect_series(
    save(here + "b.nrrd", head + "encoding: gzip\n\n" + deflated(all_voxels())), times);
  expect_series(
    save(here + "c.nrrd", head + "encoding: ascii\n\n" + all_voxels(true)), times);
}

TEST(Series, NumberedFiles)
{
  const std::string here = folder();
  const std::string bytes = all_voxels();
  const int order[Steps] = { 8, 10, 12 }; // as text, 10 and 12 come before 8
  for (int t = 0; t < Steps; ++t)
  {
    save(here + "f" + std::to_string(order[t]) + ".nii",
      nifti_header(NiftiOptions()) + bytes.substr(t * 120, 120));
  }
  expect_series(here + "f%d.nii", { 8, 10, 12 });
  expect_series(here + "f*.nii", { 8, 10, 12 });
  expect_series(here + "f#.nii", { 8, 10, 12 });
  EXPECT_TRUE(vtkBrumeImageReader::CanReadFile((here + "f%d.nii").c_str()));
  const auto none = reader_of(here + "g%d.nii");
  none->Update();
  EXPECT_NE(std::string(none->GetErrorMessage()).find("no such file"), std::string::npos);
  // A volume of another size among them.
  NiftiOptions wide;
  wide.dim[1] = 4;
  save(here + "f12.nii", nifti_header(wide) + bytes);
  const auto mixed = reader_of(here + "f%d.nii");
  mixed->UpdateInformation();
  mixed->UpdateTimeStep(12);
  EXPECT_NE(std::string(mixed->GetErrorMessage()).find("f12.nii: is not of the size and type"),
    std::string::npos)
    << mixed->GetErrorMessage();
  mixed->UpdateTimeStep(8);
  EXPECT_STREQ(mixed->GetErrorMessage(), "");
  mixed->UpdateTimeStep(12);
  EXPECT_NE(std::string(mixed->GetErrorMessage()).find("is not of the size"), std::string::npos);
}

TEST(Series, OneDamagedFileLeavesTheOthers)
{
  const std::string here = folder();
  const std::string bytes = all_voxels();
  for (int t = 0; t < Steps; ++t)
  {
    // Of the second, the header alone; the third ends within its header.
    const std::string whole =
      "NRRD0004\ntype: short\nendian: little\nencoding: raw\ndimension: 3\nsizes: 5 4 3\n\n" +
      bytes.substr(t * 120, 120);
    char name[16];
    std::snprintf(name, sizeof(name), "s_%03d.nrrd", t);
    save(here + name, whole.substr(0, t == 1 ? whole.size() - 60 : t == 2 ? 30 : whole.size()));
  }
  const auto reader = reader_of(here + "s_%03d.nrrd");
  ASSERT_EQ(times_of(reader).size(), 3u);
  for (int t : { 0, 1, 0, 2, 2, 0, 2, 1, 0 })
  {
    reader->UpdateTimeStep(t);
    const std::string error = reader->GetErrorMessage();
    vtkImageData* image = reader->GetOutput();
    if (t > 0)
    {
      EXPECT_NE(error.find("s_00" + std::to_string(t) + ".nrrd"), std::string::npos) << error;
      EXPECT_EQ(image->GetNumberOfPoints(), 0);
      continue;
    }
    ASSERT_EQ(error, "");
    ASSERT_EQ(image->GetNumberOfPoints(), Nx * Ny * Nz);
    EXPECT_EQ(image->GetPointData()->GetScalars()->GetComponent(7, 0), numbers()[7]);
  }
}

TEST(Series, CutShort)
{
  const std::string here = folder();
  const std::string bytes = nifti_series() + all_voxels();
  const auto reader = reader_of(save(here + "a.nii", bytes.substr(0, bytes.size() - 1)));
  EXPECT_EQ(times_of(reader).size(), 2u); // the whole ones
  reader->Update();
  EXPECT_STREQ(reader->GetErrorMessage(), "");
  const std::string packed = deflated(bytes.substr(0, bytes.size() - 1));
  const auto deflating = reader_of(save(here + "a.nii.gz", packed));
  deflating->UpdateInformation();
  deflating->UpdateTimeStep(3.5);
  EXPECT_NE(std::string(deflating->GetErrorMessage()).find("cut short"), std::string::npos);
  // More volumes than any series has.
  const auto many = reader_of(save(here + "b.nrrd",
    "NRRD0005\ntype: uchar\nencoding: gzip\ndimension: 4\nsizes: 5 4 3 2000000\n\nx"));
  many->Update();
  EXPECT_NE(std::string(many->GetErrorMessage()).find("2000000 volumes"), std::string::npos);
}

TEST(MemoryLimit, IsKept)
{
  const std::string here = folder();
  const std::string path = save(here + "a.nii", nifti_header(NiftiOptions()) + voxels());
  const auto reader = reader_of(path); // 120 bytes
  reader->SetMaximumMemory(119);
  reader->Update();
  EXPECT_NE(std::string(reader->GetErrorMessage()).find("and the limit is 0.119 kB"),
    std::string::npos)
    << reader->GetErrorMessage();
  EXPECT_EQ(reader->GetOutput()->GetNumberOfPoints(), 0);
  reader->SetMaximumMemory(120);
  reader->Update();
  EXPECT_STREQ(reader->GetErrorMessage(), "");
  // Slope and intercept make floats beside the stored numbers.
  NiftiOptions scaled;
  scaled.slope = 0.5f;
  save(path, nifti_header(scaled) + voxels());
  const auto floats = reader_of(path);
  floats->SetMaximumMemory(359);
  floats->Update();
  EXPECT_NE(std::string(floats->GetErrorMessage()).find("takes 0.36 kB"), std::string::npos)
    << floats->GetErrorMessage();
}

TEST(MemoryLimit, TrillionsOfVoxels)
{
  // A sparse file of 10^12 bytes, which takes next to nothing of the disk.
  const std::string here = folder();
  const std::string path = save(here + "a.nrrd",
    "NRRD0005\ntype: uchar\nencoding: raw\ndimension: 3\nsizes: 10000 10000 10000\n\n");
  std::error_code error;
  std::filesystem::resize_file(path, 1000000000100, error);
  if (error)
  {
    GTEST_SKIP() << "this file system holds no file of a terabyte: " << error.message();
  }
  const auto reader = reader_of(path);
  reader->Update();
  EXPECT_NE(std::string(reader->GetErrorMessage()).find("takes 1 TB of memory, and the limit is"),
    std::string::npos)
    << reader->GetErrorMessage();
  EXPECT_EQ(reader->GetOutput()->GetNumberOfPoints(), 0);
  std::filesystem::remove(path);
}
