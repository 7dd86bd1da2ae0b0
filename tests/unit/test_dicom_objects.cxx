// DICOM objects of several frames in a file: doses, enhanced ones with functional groups, compressed
// ones, colours. The files are made byte by byte.
#include "../support/dicom_bytes.h"
#include "../support/dicom_files.h"
#include "../support/pictures.h"
#include "scan_files.h"

#include "vtkBrumeImageReader.h"

#include "vtkCallbackCommand.h"
#include "vtkCommand.h"
#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkPointData.h"

#include <cmath>

using namespace dicom_bytes;

namespace
{

constexpr int W = 4, H = 3;

struct Opened
{
  vtkSmartPointer<vtkBrumeImageReader> reader = vtkSmartPointer<vtkBrumeImageReader>::New();
  vtkImageData* image = nullptr;
  std::string error;
  std::string messages;

  explicit Opened(const std::string& path, vtkTypeInt64 memory = 0)
  {
    vtkNew<vtkCallbackCommand> silent;
    silent->SetCallback([](vtkObject*, unsigned long, void*, void*) {});
    reader->AddObserver(vtkCommand::ErrorEvent, silent);
    reader->SetFileName(path.c_str());
    reader->SetMaximumMemory(memory);
    reader->Update();
    image = reader->GetOutput();
    error = reader->GetErrorMessage();
    for (int i = 0; i < reader->GetNumberOfMessages(); ++i)
    {
      messages += std::string(reader->GetMessage(i)) + "\n";
    }
  }
  /// The value at a place in RAS+ mm; NaN where no voxel stands.
  double at(double x, double y, double z, int component = 0) const
  {
    double world[3] = { x, y, z };
    double index[3];
    image->TransformPhysicalPointToContinuousIndex(world, index);
    for (int a = 0; a < 3; ++a)
    {
      const double voxel = std::round(index[a]);
      if (std::abs(index[a] - voxel) > 1e-6 || voxel < 0 || voxel >= image->GetDimensions()[a])
      {
        return NAN;
      }
      index[a] = voxel;
    }
    return image->GetScalarComponentAsDouble(static_cast<int>(index[0]), static_cast<int>(index[1]),
      static_cast<int>(index[2]), component);
  }
};

/// The numbers of a frame, all different.
std::string frame_of(int frame)
{
  std::string pixels;
  for (int n = 0; n < W * H; ++n)
  {
    pixels += number(static_cast<std::uint64_t>(1000 * frame + 37 * n + 5), 2);
  }
  return pixels;
}

std::string frames_of(int count)
{
  std::string pixels;
  for (int f = 0; f < count; ++f)
  {
    pixels += frame_of(f);
  }
  return pixels;
}

/// A dose of 5 frames at 30 mm, rows 1.5 mm apart and columns 2 mm. `orientation` tells which way the
/// frames' normal points.
std::string dose(const std::string& offsets, const std::string& orientation = "1\\0\\0\\0\\1\\0")
{
  return file(Plain,
    element(0x00080060, "CS", "RTDOSE") + element(0x00180050, "DS", "9") +
      element(0x0020000e, "UI", "1.2.5") + element(0x00200032, "DS", "10\\20\\30") +
      element(0x00200037, "DS", orientation) + pixel_format(W, H, 5) +
      element(0x00280030, "DS", "1.5\\2") + bits_of(16) +
      element(0x30040002, "CS", "GY") + (offsets.empty() ? "" : element(0x3004000c, "DS", offsets)) +
      element(0x3004000e, "DS", "0.01") + element(0x7fe00010, "OW", frames_of(5)));
}

}

TEST(DicomObjects, ADosesOffsetsPlaceItsSlices)
{
  const std::string here = scan_files::folder();
  struct Case
  {
    std::string offsets, orientation;
    double z[5];
  };
  const Case cases[] = {
    { "0\\2.5\\5\\7.5\\10", "1\\0\\0\\0\\1\\0", { 30, 32.5, 35, 37.5, 40 } },
    { "0\\-2.5\\-5\\-7.5\\-10", "1\\0\\0\\0\\1\\0", { 30, 27.5, 25, 22.5, 20 } },
    { "30\\33\\36\\39\\42", "1\\0\\0\\0\\1\\0", { 30, 33, 36, 39, 42 } }, // the patient's z itself
    { "30\\33\\36\\39\\42", "1\\0\\0\\0\\-1\\0", { 30, 33, 36, 39, 42 } },
    { "0\\2\\4\\6\\8", "1\\0\\0\\0\\-1\\0", { 30, 28, 26, 24, 22 } }, // along the frames' normal
  };
  for (const Case& c : cases)
  {
    SCOPED_TRACE(c.offsets + ", " + c.orientation);
    const Opened opened(scan_files::save(here + "dose.dcm", dose(c.offsets, c.orientation)));
    ASSERT_EQ(opened.error, "");
    ASSERT_EQ(opened.image->GetNumberOfPoints(), W * H * 5);
    EXPECT_STREQ(opened.reader->GetValueUnit(), "Gy");
    const double down = c.orientation.find('-') == std::string::npos ? 1 : -1;
    for (int f = 0; f < 5; ++f)
      for (int n = 0; n < W * H; ++n)
      {
        const double x = 10 + 2.0 * (n % W), y = 20 + down * 1.5 * (n / W);
        ASSERT_NEAR(opened.at(-x, -y, c.z[f]), 0.01 * (1000 * f + 37 * n + 5), 1e-5)
          << "frame " << f << ", pixel " << n;
      }
    EXPECT_EQ(opened.messages.find("do not tell where"), std::string::npos);
  }
  const Opened without(scan_files::save(here + "dose.dcm", dose("")));
  ASSERT_EQ(without.error, "");
  EXPECT_EQ(without.image->GetNumberOfPoints(), W * H * 5);
  EXPECT_NEAR(without.image->GetSpacing()[2], 9, 1e-9);
  EXPECT_NE(without.messages.find("they are set 9 mm apart"), std::string::npos) << without.messages;
}

TEST(DicomObjects, FramesOfAnEnhancedObjectHavePlacesAndSlopesOfTheirOwn)
{
  const int order[4] = { 2, 0, 3, 1 }; // of the frames along z
  std::string groups;
  for (int f = 0; f < 4; ++f)
  {
    groups += item(sequence(0x00209113,
                     element(0x00200032, "DS", "1\\2\\" + std::to_string(10 + 4 * order[f]))) +
      sequence(0x00289145,
        element(0x00281052, "DS", std::to_string(-100 * f)) +
          element(0x00281053, "DS", std::to_string(f + 1))));
  }
  const std::string shared = sequence(0x00209116, element(0x00200037, "DS", "1\\0\\0\\0\\1\\0")) +
    sequence(0x00289110, element(0x00180050, "DS", "4") + element(0x00280030, "DS", "0.5\\0.25"));
  const std::string here = scan_files::folder();
  const Opened opened(scan_files::save(here + "a.dcm",
    file(Plain,
      element(0x00080060, "CS", "CT") + element(0x0020000e, "UI", "1.2.5") + pixel_format(W, H, 4) +
        bits_of(16) + sequence(0x52009229, shared) + element(0x52009230, "SQ", groups) +
        element(0x7fe00010, "OW", frames_of(4)))));
  ASSERT_EQ(opened.error, "");
  ASSERT_EQ(opened.image->GetNumberOfPoints(), W * H * 4);
  EXPECT_STREQ(opened.reader->GetValueUnit(), "HU");
  for (int f = 0; f < 4; ++f)
    for (int n = 0; n < W * H; ++n)
    {
      ASSERT_NEAR(opened.at(-(1 + 0.25 * (n % W)), -(2 + 0.5 * (n / W)), 10 + 4 * order[f]),
        (f + 1) * (1000 * f + 37 * n + 5) - 100 * f,
        1e-6)
        << "frame " << f << ", pixel " << n;
    }
}

TEST(DicomObjects, CompressedFramesAreDecodedWithinTheMemory)
{
  const std::string here = scan_files::folder();
  std::vector<std::string> frames;
  for (int f = 0; f < 3; ++f)
  {
    frames.push_back(rle(frame_of(f), 2));
  }
  const std::string path = scan_files::save(here + "a.dcm",
    file(Rle,
      element(0x00080060, "CS", "MR") + element(0x0020000e, "UI", "1.2.5") + pixel_format(W, H, 3) +
        bits_of(16) + fragments(frames)));
  const Opened opened(path);
  ASSERT_EQ(opened.error, "");
  EXPECT_STREQ(opened.reader->GetFormat(), "DICOM (RLE)");
  ASSERT_EQ(opened.image->GetNumberOfPoints(), W * H * 3);
  for (int i = 0; i < W * H * 3; ++i)
  {
    ASSERT_EQ(opened.image->GetPointData()->GetScalars()->GetComponent(i, 0),
      1000 * (i / (W * H)) + 37 * (i % (W * H)) + 5);
  }
  // The decoder's own memory counts, six times the 72 bytes of voxels, beside these.
  const Opened refused(path, 503);
  EXPECT_NE(refused.error.find("takes 0.504 kB of memory, and the limit is 0.503 kB"), std::string::npos)
    << refused.error;
  EXPECT_EQ(Opened(path, 504).error, "");
}

TEST(DicomObjects, Colours)
{
  const std::string here = scan_files::folder();
  const auto value = [](int n, int c) { return static_cast<unsigned char>(50 * c + 3 * n + 1); };
  for (int planar : { 0, 1 })
    for (bool packed : { false, true })
    {
      SCOPED_TRACE(std::string(planar ? "planes" : "pixels") + (packed ? ", packed" : ""));
      std::string pixels;
      for (int i = 0; i < W * H * 3; ++i)
      {
        const int n = planar && !packed ? i % (W * H) : i / 3;
        pixels.push_back(static_cast<char>(value(n, planar && !packed ? i / (W * H) : i % 3)));
      }
      std::string planes[3];
      for (int c = 0; c < 3; ++c)
        for (int n = 0; n < W * H; ++n)
        {
          planes[c].push_back(static_cast<char>(value(n, c)));
        }
      // Annex G: one segment a colour, whatever the planar configuration: those of 3 bytes, turned.
      std::string turned;
      for (int n = 0; n < W * H; ++n)
        for (int c = 2; c >= 0; --c)
        {
          turned.push_back(planes[c][static_cast<std::size_t>(n)]);
        }
      const std::string data = packed ? fragments({ rle(turned, 3) }) : element(0x7fe00010, "OW", pixels);
      const Opened opened(scan_files::save(here + "a.dcm",
        file(packed ? Rle : Plain,
          element(0x00080060, "CS", "OT") + element(0x0020000e, "UI", "1.2.5") +
            pixel_format(W, H, 1, 3, planar) + bits_of(8) + data)));
      ASSERT_EQ(opened.error, "");
      ASSERT_EQ(opened.image->GetNumberOfScalarComponents(), 3);
      for (int n = 0; n < W * H; ++n)
        for (int c = 0; c < 3; ++c)
        {
          ASSERT_EQ(opened.image->GetScalarComponentAsDouble(n % W, n / W, 0, c), value(n, c))
            << "pixel " << n << ", colour " << c;
        }
    }
}

TEST(DicomObjects, ScansBelowAFolderGoBeforePicturesInIt)
{
  const std::string here = scan_files::folder();
  pictures::write<unsigned char>(here + "figure.tif", W, H, { std::vector<unsigned char>(W * H, 7) });
  pictures::write<unsigned char>(here + "shot.png", W, H, { std::vector<unsigned char>(W * H, 7) });
  const dicom_files::Series s;
  dicom_files::write(s, here + "study/series");
  const Opened opened(here);
  ASSERT_EQ(opened.error, "");
  EXPECT_STREQ(opened.reader->GetFormat(), "DICOM");
  EXPECT_EQ(opened.image->GetNumberOfPoints(), s.size[0] * s.size[1] * s.size[2]);
  EXPECT_NE(opened.messages.find("2 TIFF or PNG pictures lie beside the DICOM files and are passed over"),
    std::string::npos)
    << opened.messages;
}
