// Stacks of pictures, and raw voxels with a sidecar.
#include "../support/pictures.h"
#include "scan_files.h"

#include "vtkBrumeImageReader.h"

#include "vtkCallbackCommand.h"
#include "vtkCommand.h"
#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkMatrix3x3.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkStreamingDemandDrivenPipeline.h"

using namespace scan_files;

namespace
{

struct Opened
{
  vtkSmartPointer<vtkBrumeImageReader> reader = vtkSmartPointer<vtkBrumeImageReader>::New();
  vtkImageData* image = nullptr;
  std::string error;
  std::string messages;

  explicit Opened(const std::string& path)
  {
    vtkNew<vtkCallbackCommand> silent;
    silent->SetCallback([](vtkObject*, unsigned long, void*, void*) {});
    reader->AddObserver(vtkCommand::ErrorEvent, silent);
    reader->SetFileName(path.c_str());
    reader->Update();
    image = reader->GetOutput();
    error = reader->GetErrorMessage();
    for (int i = 0; i < reader->GetNumberOfMessages(); ++i)
    {
      messages += std::string(reader->GetMessage(i)) + "\n";
    }
  }
};

template <class T>
std::vector<std::vector<T>> pages(T scale)
{
  std::vector<std::vector<T>> result(Nz);
  const std::vector<int> values = numbers();
  for (std::size_t n = 0; n < values.size(); ++n)
  {
    result[n / (Nx * Ny)].push_back(static_cast<T>(static_cast<T>(values[n] % 251) * scale));
  }
  return result;
}

template <class T>
void expect_pages(const Opened& opened, T scale, int type)
{
  ASSERT_EQ(opened.error, "");
  ASSERT_EQ(opened.image->GetNumberOfPoints(), Nx * Ny * Nz);
  EXPECT_EQ(opened.image->GetDimensions()[2], Nz);
  EXPECT_EQ(opened.image->GetScalarType(), type);
  const std::vector<int> values = numbers();
  for (std::size_t n = 0; n < values.size(); ++n)
  {
    ASSERT_EQ(opened.image->GetPointData()->GetScalars()->GetComponent(static_cast<vtkIdType>(n), 0),
      static_cast<double>(static_cast<T>(static_cast<T>(values[n] % 251) * scale)))
      << n;
  }
}

template <class T>
void expect_stack(const std::string& here, T scale, int type, const std::string& ending = ".tif")
{
  const auto all = pages<T>(scale);
  if (ending == ".tif")
  {
    pictures::write(here + "all.tif", Nx, Ny, all);
    expect_pages<T>(Opened(here + "all.tif"), scale, type);
  }
  const std::string folder = here + "slices/";
  std::filesystem::create_directories(folder);
  for (int k = 0; k < Nz; ++k)
  {
    pictures::write<T>(folder + "s_" + std::to_string(9 + k) + ending, Nx, Ny, { all[k] });
  }
  expect_pages<T>(Opened(here + "slices"), scale, type); // 9, 10, 11: by number, not by letter
  expect_pages<T>(Opened(folder + "s_%d" + ending), scale, type);
}

}

TEST(Pictures, TypesOfTiff)
{
  const std::string here = folder();
  expect_stack<unsigned char>(here, 1, VTK_UNSIGNED_CHAR);
  expect_stack<unsigned short>(here, 200, VTK_UNSIGNED_SHORT);
  expect_stack<unsigned int>(here, 10000000, VTK_UNSIGNED_INT);
  expect_stack<int>(here, -1000000, VTK_INT);
  expect_stack<float>(here, 0.37f, VTK_FLOAT);
}

TEST(Pictures, Png)
{
  expect_stack<unsigned short>(folder(), 200, VTK_UNSIGNED_SHORT, ".png");
}

TEST(Pictures, PlacesAndTimes)
{
  const std::string here = folder();
  const auto all = pages<unsigned char>(1);
  pictures::write(here + "a.tif", Nx, Ny, all, "", 20.f);
  const Opened cm(here + "a.tif");
  EXPECT_NEAR(cm.image->GetSpacing()[0], 0.5, 1e-6);
  EXPECT_NEAR(cm.image->GetSpacing()[1], 0.5, 1e-6);
  EXPECT_STREQ(cm.reader->GetLengthUnit(), "mm");
  EXPECT_NE(cm.messages.find("how far apart"), std::string::npos);
  auto twice = all;
  twice.insert(twice.end(), all.begin(), all.end());
  twice[3][0] = 99;
  pictures::write(here + "b.tif", Nx, Ny, twice,
    "ImageJ=1.53\nimages=6\nslices=3\nframes=2\nunit=micron\nspacing=2.5\nfinterval=0.5\n", 4.f);
  const Opened series(here + "b.tif");
  ASSERT_EQ(series.error, "");
  EXPECT_EQ(series.image->GetDimensions()[2], 3);
  EXPECT_STREQ(series.reader->GetLengthUnit(), "um");
  EXPECT_NEAR(series.image->GetSpacing()[2], 2.5, 1e-9);
  EXPECT_EQ(series.reader->GetOutputInformation(0)->Length(
              vtkStreamingDemandDrivenPipeline::TIME_STEPS()),
    2);
  series.reader->UpdateTimeStep(0.5);
  EXPECT_EQ(series.reader->GetOutput()->GetScalarComponentAsDouble(0, 0, 0, 0), 99);
}

TEST(Pictures, ChannelsOfHyperstacksAreComponents)
{
  // Pages in ImageJ's order: two channels, then three slices, then two frames.
  const std::string here = folder();
  std::vector<std::vector<unsigned short>> all;
  for (int page = 0; page < 12; ++page)
  {
    all.emplace_back();
    for (int n = 0; n < Nx * Ny; ++n)
    {
      all.back().push_back(static_cast<unsigned short>(1000 * page + n));
    }
  }
  const std::string head = "ImageJ=1.53t\nimages=12\nchannels=2\nslices=3\n";
  pictures::write(here + "a.tif", Nx, Ny, all,
    head + "frames=2\nhyperstack=true\nmode=composite\nspacing=2\nfinterval=0.5\n", 4.f);
  const Opened opened(here + "a.tif");
  ASSERT_EQ(opened.error, "");
  ASSERT_EQ(opened.image->GetNumberOfScalarComponents(), 2);
  ASSERT_EQ(opened.image->GetDimensions()[2], 3);
  for (int frame = 0; frame < 2; ++frame)
  {
    opened.reader->UpdateTimeStep(0.5 * frame);
    ASSERT_STREQ(opened.reader->GetErrorMessage(), "");
    for (int n = 0; n < Nx * Ny * 3; ++n)
      for (int c = 0; c < 2; ++c)
      {
        const int slice = n / (Nx * Ny);
        ASSERT_EQ(opened.reader->GetOutput()->GetPointData()->GetScalars()->GetComponent(n, c),
          1000 * (c + 2 * (slice + 3 * frame)) + n % (Nx * Ny))
          << "frame " << frame << ", voxel " << n << ", channel " << c;
      }
  }
  pictures::write(here + "b.tif", Nx, Ny, all, "ImageJ=1.53t\nimages=12\nchannels=5\n", 4.f);
  const Opened odd(here + "b.tif");
  ASSERT_EQ(odd.error, "");
  EXPECT_EQ(odd.image->GetDimensions()[2], 12);
  EXPECT_NE(odd.messages.find("5 channels, which its 12 pages cannot be"), std::string::npos)
    << odd.messages;
}

TEST(Pictures, ThatDoNotFit)
{
  const std::string here = folder();
  const auto all = pages<unsigned char>(1);
  pictures::write<unsigned char>(here + "s1.tif", Nx, Ny, { all[0] });
  pictures::write<unsigned char>(here + "s2.tif", Ny, Nx, { all[1] });
  const Opened sizes(here + "s%d.tif");
  EXPECT_NE(sizes.error.find("s2.tif: is of another size or type"), std::string::npos) << sizes.error;
  const std::string bytes = load(here + "s1.tif");
  const Opened cut(save(here + "cut.tif", bytes.substr(0, 12)));
  EXPECT_NE(cut.error.find("cut.tif: "), std::string::npos);
  EXPECT_EQ(cut.image->GetNumberOfPoints(), 0);
  pictures::write<unsigned char>(here + "s2.png", Nx, Ny, { all[1] });
  EXPECT_NE(Opened(here).error.find("both TIFF and PNG"), std::string::npos);
}

TEST(RawVoxels, Sidecar)
{
  const std::string here = folder();
  const std::string raw = save(here + "a.raw", "HEAD" + voxels(true));
  const std::string json = R"({ "dimensions": [5, 4, 3], "type": "int16", "byte_order": "big",
    "offset": 4, "spacing": [1, 2, 3], "origin": [10, 20, 30],
    "direction": [[0, -1, 0], [1, 0, 0], [0, 0, 1]], "unit": "um", "value_unit": "counts",
    "slope": 0.5, "intercept": 1 })";
  save(raw + ".json", json);
  for (const std::string& name : { raw, raw + ".json" })
  {
    const Opened opened(name);
    ASSERT_EQ(opened.error, "");
    const std::vector<int> values = numbers();
    for (int n = 0; n < Nx * Ny * Nz; ++n)
    {
      ASSERT_EQ(opened.image->GetPointData()->GetScalars()->GetComponent(n, 0), 0.5 * values[n] + 1);
    }
    EXPECT_EQ(opened.image->GetSpacing()[1], 2);
    EXPECT_EQ(opened.image->GetOrigin()[2], 30);
    EXPECT_EQ(opened.image->GetDirectionMatrix()->GetElement(0, 1), -1);
    EXPECT_STREQ(opened.reader->GetLengthUnit(), "um");
    EXPECT_STREQ(opened.reader->GetValueUnit(), "counts");
    EXPECT_STREQ(opened.reader->GetFormat(), "raw");
  }
}

TEST(RawVoxels, BadSidecars)
{
  const std::string here = folder();
  const std::string raw = save(here + "a.raw", voxels());
  const Opened none(raw);
  EXPECT_NE(none.error.find("write a.raw.json beside it: {\"dimensions\""), std::string::npos)
    << none.error;
  const auto expect = [&](const std::string& json, const std::string& words)
  {
    save(raw + ".json", json);
    const Opened opened(raw);
    EXPECT_NE(opened.error.find(words), std::string::npos) << json << '\n' << opened.error;
    EXPECT_EQ(opened.image->GetNumberOfPoints(), 0);
  };
  expect("{", "is no JSON");
  expect("[1]", "holds no JSON object");
  expect(std::string(100000, '['), "nested too deeply");
  expect("{\"sizes\": [1]}", "has a key \"sizes\"");
  expect("{\"dimensions\": [5, 4, 3]}", "\"type\" is not one of");
  expect("{\"dimensions\": [5, 4, 3], \"type\": \"int16\"}", "\"byte_order\" is not little or big");
  expect("{\"dimensions\": [5, 4], \"type\": \"uint8\"}", "\"dimensions\" is not three counts");
  expect("{\"dimensions\": [5, 4, -3], \"type\": \"uint8\"}", "\"dimensions\" is not made of counts");
  expect("{\"dimensions\": [5, 4, 7], \"type\": \"uint8\"}", "cut short");
  expect("{\"dimensions\": [10000, 10000, 10000], \"type\": \"uint8\"}", "cut short");
}
