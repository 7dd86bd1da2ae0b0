// DICOM as vtk-dicom writes it: the order of slices, Hounsfield units to the bit, places in the
// patient, what is missing or there twice, series to choose from, volumes over time.
#include "../support/dicom_files.h"
#include "scan_files.h"

#include "vtkBrumeImageReader.h"

#include "vtkCallbackCommand.h"
#include "vtkCommand.h"
#include "vtkDataArray.h"
#include "vtkInformation.h"
#include "vtkPointData.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <cmath>

namespace
{

using dicom_files::Series;

struct Opened
{
  vtkSmartPointer<vtkBrumeImageReader> reader = vtkSmartPointer<vtkBrumeImageReader>::New();
  std::string error;

  explicit Opened(const std::string& path, const std::string& series = {}, double time = NAN)
  {
    vtkNew<vtkCallbackCommand> silent;
    silent->SetCallback([](vtkObject*, unsigned long, void*, void*) {});
    reader->AddObserver(vtkCommand::ErrorEvent, silent);
    reader->SetFileName(path.c_str());
    reader->SetSeries(series.empty() ? nullptr : series.c_str());
    reader->UpdateInformation();
    if (std::isnan(time))
    {
      reader->Update();
    }
    else
    {
      reader->UpdateTimeStep(time);
    }
    error = reader->GetErrorMessage();
  }
  vtkImageData* image() const { return reader->GetOutput(); }
  std::string messages() const
  {
    std::string all;
    for (int i = 0; i < reader->GetNumberOfMessages(); ++i)
    {
      all += std::string(reader->GetMessage(i)) + "\n";
    }
    return all;
  }
};

/// Every voxel of the series stands at its place in RAS+ with its value in Hounsfield units. `from` names
/// the slice whose numbers a slice has.
void expect_series(const Opened& opened, const Series& s, const std::vector<int>& from = {}, int t = 0)
{
  ASSERT_EQ(opened.error, "");
  ASSERT_EQ(opened.image()->GetNumberOfPoints(), s.size[0] * s.size[1] * s.size[2]);
  EXPECT_TRUE(opened.reader->GetPatientAxes());
  EXPECT_STREQ(opened.reader->GetLengthUnit(), "mm");
  EXPECT_STREQ(opened.reader->GetValueUnit(), s.times > 1 ? "" : "HU");
  for (int k = 0; k < s.size[2]; ++k)
    for (int j = 0; j < s.size[1]; ++j)
      for (int i = 0; i < s.size[0]; ++i)
      {
        const double mm[3] = { i * s.spacing[0], j * s.spacing[1], k * s.spacing[2] };
        double world[3];
        for (int row = 0; row < 3; ++row)
        {
          const double* m = &s.place[4 * row];
          world[row] = (row < 2 ? -1 : 1) * (m[0] * mm[0] + m[1] * mm[1] + m[2] * mm[2] + m[3]);
        }
        double index[3];
        opened.image()->TransformPhysicalPointToContinuousIndex(world, index);
        int voxel[3];
        for (int a = 0; a < 3; ++a)
        {
          voxel[a] = static_cast<int>(std::lround(index[a]));
          ASSERT_NEAR(index[a], voxel[a], 1e-4);
          ASSERT_TRUE(voxel[a] >= 0 && voxel[a] < opened.image()->GetDimensions()[a]);
        }
        const int slice = from.empty() ? k : from[k];
        ASSERT_EQ(opened.image()->GetScalarComponentAsDouble(voxel[0], voxel[1], voxel[2], 0),
          s.slope * dicom_files::stored(s, i, j, slice, t) + s.intercept)
          << "voxel " << i << ' ' << j << ' ' << k;
      }
}

}

TEST(DicomReader, ShuffledNamesComeBackInOrderAndHounsfieldUnits)
{
  const std::string here = scan_files::folder();
  for (unsigned seed = 1; seed <= 5; ++seed)
  {
    const Series s;
    const std::string folder = here + std::to_string(seed);
    dicom_files::shuffle(dicom_files::write(s, folder), seed);
    scan_files::save(folder + "/README", "no DICOM");
    const Opened opened(folder);
    expect_series(opened, s);
    EXPECT_EQ(opened.image()->GetScalarType(), VTK_FLOAT); // 16 bits less 1024 do not fit into 16
    EXPECT_STREQ(opened.reader->GetFormat(), "DICOM");
    EXPECT_EQ(opened.messages(), "");
  }
}

TEST(DicomReader, Orientations)
{
  const std::string here = scan_files::folder();
  const double c = std::cos(0.4), z = std::sin(0.4);
  const std::vector<std::array<double, 12>> places{
    { { 0, 0, 1, 5, 1, 0, 0, 6, 0, -1, 0, 7 } },   // sagittal
    { { 1, 0, 0, 5, 0, 0, 1, 6, 0, -1, 0, 7 } },   // coronal
    { { c, -z, 0, 5, z, c, 0, 6, 0, 0, 1, 7 } },   // oblique
    { { 1, 0, 0, 5, 0, -1, 0, 6, 0, 0, -1, 7 } },  // upside down
  };
  for (std::size_t n = 0; n < places.size(); ++n)
  {
    Series s;
    s.place = places[n];
    const std::string folder = here + std::to_string(n);
    dicom_files::shuffle(dicom_files::write(s, folder), 9);
    expect_series(Opened(folder), s);
  }
}

TEST(DicomReader, SlopeAndInterceptThatAreNotWhole)
{
  const std::string here = scan_files::folder();
  Series s;
  s.slope = 0.5;
  s.intercept = -1000.25;
  dicom_files::write(s, here + "a");
  const Opened opened(here + "a");
  expect_series(opened, s);
  EXPECT_EQ(opened.image()->GetScalarType(), VTK_FLOAT);
}

TEST(DicomReader, WholeValuesOfTwelveBitsStayShorts)
{
  const std::string here = scan_files::folder();
  const Series s;
  for (const std::string& name : dicom_files::write(s, here + "a"))
  {
    std::string bytes = scan_files::load(name);
    const std::size_t stored = bytes.find(std::string("\x28\x00\x01\x01US\x02\x00", 8)) + 8;
    bytes[stored] = 12;
    // Above the bits that count there may be anything.
    bytes[bytes.size() - 1] = static_cast<char>(bytes[bytes.size() - 1] ^ 0x50);
    scan_files::save(name, bytes);
  }
  const Opened opened(here + "a");
  expect_series(opened, s);
  EXPECT_EQ(opened.image()->GetScalarType(), VTK_SHORT);
}

TEST(DicomReader, UnsignedNumbersKeepTheBitsThatCount)
{
  const std::string here = scan_files::folder();
  const Series s;
  const auto names = dicom_files::write(s, here + "a");
  for (const std::string& name : names)
  {
    std::string bytes = scan_files::load(name);
    bytes[bytes.find(std::string("\x28\x00\x01\x01US\x02\x00", 8)) + 8] = 12;
    const std::size_t sign = bytes.find(std::string("\x28\x00\x03\x01US\x02\x00", 8));
    ASSERT_NE(sign, std::string::npos);
    bytes[sign + 8] = 0;
    bytes[bytes.size() - 1] = static_cast<char>(bytes[bytes.size() - 1] ^ 0xd0);
    scan_files::save(name, bytes);
  }
  const Opened opened(here + "a");
  expect_series(opened, s);
  EXPECT_EQ(opened.image()->GetScalarType(), VTK_SHORT);

  // A picture of other bits is not of the same volume.
  std::string bytes = scan_files::load(names[6]);
  bytes[bytes.find(std::string("\x28\x00\x01\x01US\x02\x00", 8)) + 8] = 10;
  scan_files::save(names[6], bytes);
  const Opened mixed(here + "a");
  EXPECT_EQ(mixed.image()->GetDimensions()[2], 6);
  EXPECT_NE(mixed.messages().find("1 of the series' 7 pictures"), std::string::npos)
    << mixed.messages();
}

TEST(DicomReader, MissingAndDoubledSlices)
{
  const std::string here = scan_files::folder();
  const Series s;
  const auto names = dicom_files::shuffle(dicom_files::write(s, here + "a"), 4);
  std::filesystem::remove(names[3]);
  const Opened missing(here + "a");
  expect_series(missing, s, { 0, 1, 2, 2, 4, 5, 6 });
  EXPECT_NE(missing.messages().find("1 slice is missing, between"), std::string::npos)
    << missing.messages();

  std::filesystem::remove(names[1]);
  std::filesystem::remove(names[2]);
  const Opened more(here + "a");
  expect_series(more, s, { 0, 0, 0, 4, 4, 5, 6 });
  EXPECT_NE(more.messages().find("3 slices are missing"), std::string::npos) << more.messages();

  // The same file under two names; and another picture at the place of one.
  const auto whole = dicom_files::write(s, here + "b");
  std::filesystem::copy_file(whole[2], here + "b/copy");
  std::string twin = scan_files::load(whole[4]);
  const std::size_t uid = twin.find(std::string("\x08\x00\x18\x00UI", 6)) + 12;
  twin[uid] = '2';
  const std::size_t number = twin.find(std::string("\x20\x00\x13\x00IS", 6)) + 8;
  twin[number] = '9';
  scan_files::save(here + "b/twin", twin);
  const Opened doubled(here + "b");
  expect_series(doubled, s);
  EXPECT_NE(doubled.messages().find("1 file is there twice"), std::string::npos);
  EXPECT_NE(doubled.messages().find("1 slices are doubled"), std::string::npos)
    << doubled.messages();
}

TEST(DicomReader, UnevenSlicesAndTiltedGantry)
{
  const std::string here = scan_files::folder();
  Series s;
  auto names = dicom_files::write(s, here + "a");
  // ImagePositionPatient of one slice, moved by 0.8 mm of the 2.5 between slices.
  const auto move = [](const std::string& name, const std::string& from, const std::string& to)
  {
    std::string bytes = scan_files::load(name);
    const std::size_t at = bytes.find(from);
    ASSERT_NE(at, std::string::npos) << name;
    ASSERT_EQ(from.size(), to.size());
    bytes.replace(at, from.size(), to);
    scan_files::save(name, bytes);
  };
  move(names[3], "\\47.5", "\\48.3");
  const Opened uneven(here + "a");
  EXPECT_EQ(uneven.error, "");
  EXPECT_NE(uneven.messages().find("unevenly spaced, 1.7 to 3.3 mm"), std::string::npos)
    << uneven.messages();
  // Slices that are shifted along the patient as they go up: a gantry of 21.8 degrees.
  names = dicom_files::write(s, here + "b");
  for (int k = 0; k < s.size[2]; ++k)
  {
    char from[40], to[40];
    std::snprintf(from, sizeof(from), "-20\\-30\\");
    std::snprintf(to, sizeof(to), "-20\\-%02d\\", 30 - k);
    move(names[k], from, to);
  }
  const Opened tilted(here + "b");
  EXPECT_EQ(tilted.error, "");
  EXPECT_NE(tilted.messages().find("the gantry was tilted"), std::string::npos) << tilted.messages();
  EXPECT_NE(tilted.messages().find("by 21.8 degrees"), std::string::npos) << tilted.messages();
  EXPECT_NE(tilted.messages().find("closest perpendicular axes"), std::string::npos);
}

TEST(DicomReader, SeveralSeriesAskForAChoice)
{
  const std::string here = scan_files::folder();
  Series head, chest;
  chest.description = "Chest 5.0";
  chest.number = "12";
  chest.size = { { 4, 4, 3 } };
  dicom_files::write(head, here + "a/x");
  dicom_files::shuffle(dicom_files::write(chest, here + "a/y"), 3);
  const Opened none(here + "a");
  EXPECT_NE(none.error.find("holds 2 different series: choose one with --series N (1: CT, Head, "
                            "6 x 5 x 7; 2: CT, Chest 5.0, 4 x 4 x 3)"),
    std::string::npos)
    << none.error;
  EXPECT_EQ(none.image()->GetNumberOfPoints(), 0);
  ASSERT_EQ(none.reader->GetNumberOfSeries(), 2);
  EXPECT_STREQ(none.reader->GetNameOfSeries(1), "CT, Chest 5.0, 4 x 4 x 3");
  expect_series(Opened(here + "a", "1"), head);
  expect_series(Opened(here + "a", "2"), chest);
  expect_series(Opened(here + "a", none.reader->GetUIDOfSeries(1)), chest);
  EXPECT_NE(Opened(here + "a", "3").error.find("has no series '3'"), std::string::npos);
  EXPECT_NE(Opened(here + "a", "-1").error.find("has no series"), std::string::npos);
}

TEST(DicomReader, ASeriesWithoutUidIsNotTakenUnasked)
{
  const std::string here = scan_files::folder();
  Series other;
  other.number = "12";
  const auto names = dicom_files::write(Series(), here + "a");
  dicom_files::write(other, here + "a");
  for (const std::string& name : names)
  {
    std::string bytes = scan_files::load(name);
    const std::size_t at = bytes.find(std::string("\x20\x00\x0e\x00UI", 6));
    ASSERT_NE(at, std::string::npos);
    const auto length = static_cast<unsigned char>(bytes[at + 6]);
    scan_files::save(name, bytes.replace(at + 8, length, std::string(length, '\0')));
  }
  const Opened opened(here + "a");
  EXPECT_NE(opened.error.find("holds 2 different series"), std::string::npos) << opened.error;
}

TEST(DicomReader, VolumesOverTime)
{
  const std::string here = scan_files::folder();
  Series s;
  s.times = 3;
  s.intercept = 0;
  s.size = { { 4, 3, 5 } };
  dicom_files::shuffle(dicom_files::write(s, here + "a"), 8);
  const Opened first(here + "a");
  vtkInformation* info = first.reader->GetOutputInformation(0);
  auto* key = vtkStreamingDemandDrivenPipeline::TIME_STEPS();
  ASSERT_EQ(info->Length(key), 3) << first.error << first.messages();
  const std::vector<double> times(info->Get(key), info->Get(key) + 3);
  EXPECT_STREQ(first.reader->GetTimeUnit(), "s");
  for (int t = 0; t < 3; ++t)
  {
    EXPECT_NEAR(times[t], 1.5 * t, 1e-9);
    expect_series(Opened(here + "a", {}, times[t]), s, {}, t);
  }
}

TEST(DicomReader, CompressedPixels)
{
  const std::string here = scan_files::folder();
  Series s;
  s.size = { { 16, 16, 3 } };
  s.syntax = "1.2.840.10008.1.2.5"; // RLE
  dicom_files::shuffle(dicom_files::write(s, here + "a"), 6);
  const Opened opened(here + "a");
  expect_series(opened, s);
  EXPECT_STREQ(opened.reader->GetFormat(), "DICOM (RLE)");

  // The same said to be of a kind that nothing here reads.
  s.syntax = nullptr;
  const auto names = dicom_files::write(s, here + "b");
  std::string bytes = scan_files::load(names[0]);
  const std::size_t at = bytes.find("1.2.840.10008.1.2");
  const std::size_t pixels = bytes.find(std::string("\xe0\x7f\x10\x00O", 5));
  ASSERT_NE(pixels, std::string::npos);
  // Group 2 element 0010, then fragments in place of the pixels.
  const std::size_t syntax = bytes.find(std::string("\x02\x00\x10\x00UI", 6));
  ASSERT_LT(syntax, at);
  const auto length = static_cast<unsigned char>(bytes[syntax + 6]);
  const std::string uid = std::string("1.2.840.10008.1.2.4.102") + '\0';
  std::string mpeg = bytes.substr(0, syntax + 6) + static_cast<char>(uid.size()) + '\0' + uid +
    bytes.substr(syntax + 8 + length, pixels - (syntax + 8 + length));
  // The length of group 2 grows with it.
  const std::size_t group = mpeg.find(std::string("\x02\x00\x00\x00UL", 6)) + 8;
  mpeg[group] = static_cast<char>(mpeg[group] + static_cast<int>(uid.size()) - length);
  mpeg += std::string("\xe0\x7f\x10\x00OB\0\0\xff\xff\xff\xff", 12) +
    std::string("\xfe\xff\x00\xe0\0\0\0\0", 8) + std::string("\xfe\xff\x00\xe0\x04\0\0\0abcd", 12) +
    std::string("\xfe\xff\xdd\xe0\0\0\0\0", 8);
  const Opened film(scan_files::save(here + "film", mpeg));
  EXPECT_NE(film.error.find("compressed as MPEG-4, which Brume does not read: decompress it first"),
    std::string::npos)
    << film.error;

  // JPEG that is none: the decoder's own process ends, this one goes on.
  std::string jpeg = mpeg;
  jpeg.replace(jpeg.find("1.2.840.10008.1.2.4.102"), 24, std::string("1.2.840.10008.1.2.4.90") + '\0' + '\0');
  const Opened broken(scan_files::save(here + "broken", jpeg));
  EXPECT_NE(broken.error.find("its compressed pixels cannot be decoded"), std::string::npos)
    << broken.error;
}

TEST(DicomReader, OneFileAndBadOnes)
{
  const std::string here = scan_files::folder();
  const Series s;
  const auto names = dicom_files::write(s, here + "a");
  const Opened one(names[2]);
  EXPECT_EQ(one.error, "");
  EXPECT_EQ(one.image()->GetDimensions()[2], 1);
  EXPECT_EQ(one.image()->GetScalarComponentAsDouble(0, 0, 0, 0), dicom_files::stored(s, 0, 0, 2) - 1024);
  EXPECT_NE(one.messages().find("name its folder"), std::string::npos);

  const std::string bytes = scan_files::load(names[2]);
  const Opened cut(scan_files::save(here + "cut", bytes.substr(0, bytes.size() - 1)));
  EXPECT_NE(cut.error.find(here + "cut: "), std::string::npos) << cut.error;
  scan_files::save(here + "a/cut", bytes.substr(0, 700));
  const Opened left_out(here + "a");
  expect_series(left_out, s);
  EXPECT_NE(left_out.messages().find("1 file is left out"), std::string::npos);

  std::filesystem::create_directories(here + "empty");
  EXPECT_NE(Opened(here + "empty").error.find("no file in it is DICOM"), std::string::npos);
}
