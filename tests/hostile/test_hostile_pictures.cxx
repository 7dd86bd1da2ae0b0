// Damaged pictures: stacks of slices, raw voxels with their description, environment maps.
#include "read_image.h"

#include "../support/pictures.h"
#include "../unit/scan_files.h"

#include "vtkBrumeEnvironmentReader.h"

using namespace hostile;

namespace
{

template <class T>
std::string tiff(const std::string& path, int pages, const std::string& description)
{
  std::vector<std::vector<T>> numbers(pages, std::vector<T>(6 * 5));
  for (int p = 0; p < pages; ++p)
    for (int i = 0; i < 30; ++i)
    {
      numbers[p][i] = static_cast<T>(i * 7 + p);
    }
  pictures::write<T>(path, 6, 5, numbers, description, 20.f);
  return scan_files::load(path);
}

std::string read_environment(const std::string& path)
{
  vtkNew<vtkCallbackCommand> silent;
  silent->SetCallback([](vtkObject*, unsigned long, void*, void*) {});
  vtkNew<vtkBrumeEnvironmentReader> reader;
  reader->AddObserver(vtkCommand::ErrorEvent, silent);
  reader->SetMaximumMemory(memory_limit);
  reader->SetFileName(path.c_str());
  reader->Update();
  const std::string error = reader->GetErrorMessage();
  if (error.empty() && reader->GetOutput()->GetNumberOfPoints() < 2)
  {
    throw std::runtime_error(path + ": read, and no picture");
  }
  return error;
}

std::string map(const std::string& path)
{
  OIIO::attribute("exr_threads", -1); // as Brume has it: what reads is a copy of this process
  OIIO::ImageSpec spec(8, 4, 3, OIIO::TypeDesc::FLOAT);
  const std::vector<float> pixels(8 * 4 * 3, 0.75f);
  const auto out = OIIO::ImageOutput::create(path);
  if (!out || !out->open(path, spec) || !out->write_image(spec.format, pixels.data()) || !out->close())
  {
    throw std::runtime_error("the test cannot write " + path);
  }
  return scan_files::load(path);
}

}

TEST(HostileFiles, Tiff)
{
  const std::string here = scan_files::folder();
  const std::string imagej = "ImageJ=1.53\nimages=4\nslices=2\nframes=2\nunit=micron\nspacing=2.5\n";
  const std::string one = tiff<unsigned char>(here + "a.tif", 1, "");
  try_reader({ alone("a.tif", tiff<unsigned short>(here + "a.tif", 3, "")),
               alone("b.tif", tiff<float>(here + "b.tif", 4, imagej)),
               { ".", { { "s1.tif", one }, { "s2.tif", one }, { "s3.tif", one } } },
               { "s%d.png", { { "s1.png", tiff<unsigned short>(here + "s1.png", 1, "") },
                              { "s2.png", tiff<unsigned short>(here + "s2.png", 1, "") } } } },
    read_image);
}

TEST(HostileFiles, RawVoxels)
{
  const std::string json = "{ \"dimensions\": [5, 4, 3], \"type\": \"int16\", \"byte_order\": "
                           "\"little\", \"spacing\": [1, 2, 3], \"origin\": [1, 2, 3], \"unit\": "
                           "\"mm\", \"slope\": 2, \"direction\": [[1,0,0],[0,1,0],[0,0,1]] }";
  const std::string series = "{ \"dimensions\": [5, 4, 1, 3], \"type\": \"uint16\", \"byte_order\": "
                             "\"big\", \"offset\": 0, \"file\": \"b.dat\", \"time_step\": 0.5 }";
  try_reader({ { "a.raw", { { "a.raw", scan_files::voxels() }, { "a.raw.json", json } } },
               { "b.json", { { "b.dat", scan_files::voxels() }, { "b.json", series } } } },
    read_image);
}

TEST(HostileFiles, Environment)
{
  const std::string here = scan_files::folder();
  try_reader({ alone("a.exr", map(here + "a.exr")), alone("a.hdr", map(here + "a.hdr")) },
    read_environment);
}
