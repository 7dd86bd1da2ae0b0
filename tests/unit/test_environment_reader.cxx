// vtkBrumeEnvironmentReader, on files that OpenImageIO writes.
#include "scan_files.h"

#include "vtkBrumeEnvironmentReader.h"

#include "vtkCallbackCommand.h"
#include "vtkCommand.h"
#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkPointData.h"

#include <OpenImageIO/imageio.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

using scan_files::load;
using scan_files::save;

namespace
{

struct Reader
{
  vtkNew<vtkBrumeEnvironmentReader> reader;
  vtkNew<vtkCallbackCommand> ear;
  int errors = 0;

  explicit Reader(const std::string& path)
  {
    ear->SetClientData(&errors);
    ear->SetCallback(
      [](vtkObject*, unsigned long, void* count, void*) { ++*static_cast<int*>(count); });
    reader->AddObserver(vtkCommand::ErrorEvent, ear);
    reader->SetFileName(path.c_str());
    reader->Update();
  }
  vtkImageData* output() { return reader->GetOutput(); }
  std::string error() { return reader->GetErrorMessage(); }
};

/// Values that Radiance's shared exponent can hold: powers of two, of pixels from the top.
float value(int x, int y, int c)
{
  return float(1 << ((x + 2 * y + 3 * c) % 5)) / 4.0f;
}

void write(const std::string& path,
  int width,
  int height,
  const std::vector<std::string>& channels,
  OIIO::TypeDesc type = OIIO::TypeDesc::FLOAT)
{
  OIIO::ImageSpec spec(width, height, int(channels.size()), type);
  spec.channelnames = channels;
  std::vector<float> pixels;
  for (int y = 0; y < height; ++y)
  {
    for (int x = 0; x < width; ++x)
    {
      for (const std::string& channel : channels)
      {
        pixels.push_back(channel == "R"   ? value(x, y, 0)
                         : channel == "G" ? value(x, y, 1)
                         : channel == "B" ? value(x, y, 2)
                                          : -9.0f);
      }
    }
  }
  const auto output = OIIO::ImageOutput::create(path);
  ASSERT_TRUE(output) << OIIO::geterror();
  ASSERT_TRUE(output->open(path, spec)) << output->geterror();
  ASSERT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, pixels.data())) << output->geterror();
  ASSERT_TRUE(output->close());
}

void expect_values(vtkImageData* image, int width, int height)
{
  ASSERT_EQ(image->GetDimensions()[0], width);
  ASSERT_EQ(image->GetDimensions()[1], height);
  ASSERT_EQ(image->GetDimensions()[2], 1);
  vtkDataArray* radiance = image->GetPointData()->GetScalars();
  ASSERT_NE(radiance, nullptr);
  EXPECT_STREQ(radiance->GetName(), "radiance");
  ASSERT_EQ(radiance->GetNumberOfComponents(), 3);
  ASSERT_EQ(radiance->GetDataType(), VTK_FLOAT);
  for (int y = 0; y < height; ++y)
  {
    for (int x = 0; x < width; ++x)
    {
      for (int c = 0; c < 3; ++c)
      {
        ASSERT_EQ(radiance->GetComponent(y * width + x, c), value(x, height - 1 - y, c))
          << x << ' ' << y << ' ' << c;
      }
    }
  }
}

TEST(EnvironmentReader, ReadsOpenExrAndRadianceHdrFromTheBottomUp)
{
  const std::string folder = scan_files::folder();
  write(folder + "sky.hdr", 12, 6, { "R", "G", "B" });
  write(folder + "sky.exr", 12, 6, { "R", "G", "B" });
  write(folder + "half.exr", 12, 6, { "R", "G", "B" }, OIIO::TypeDesc::HALF);
  write(folder + "more.exr", 12, 6, { "A", "B", "G", "R", "Z" });
  for (const char* name : { "sky.hdr", "sky.exr", "half.exr", "more.exr" })
  {
    SCOPED_TRACE(name);
    Reader reader(folder + name);
    EXPECT_EQ(reader.error(), "");
    EXPECT_EQ(reader.errors, 0);
    expect_values(reader.output(), 12, 6);
    // Again, after the output was let go of.
    reader.output()->ReleaseData();
    reader.reader->Modified();
    reader.reader->Update();
    expect_values(reader.output(), 12, 6);
  }
}

TEST(EnvironmentReader, SaysWhatIsWrong)
{
  const std::string folder = scan_files::folder(); // empties it
  write(folder + "small.png", 12, 6, { "R", "G", "B" }, OIIO::TypeDesc::UINT8);
  write(folder + "square.exr", 12, 12, { "R", "G", "B" });
  write(folder + "grey.exr", 12, 6, { "Y" });
  write(folder + "sky.exr", 12, 6, { "R", "G", "B" });
  save(folder + "text.hdr", "no picture at all");
  const std::string whole = load(folder + "sky.exr");
  save(folder + "cut.exr", whole.substr(0, whole.size() / 2));
  const std::pair<const char*, const char*> cases[] = {
    { "none.exr", "no such file" },
    { "small.png", "does not hold linear light" },
    { "square.exr", "12 x 12 pixels: take a latitude-longitude map" },
    { "grey.exr", "has no channel R" },
    { "text.hdr", "cannot be read" },
    { "cut.exr", "cannot be read" },
  };
  for (const auto& [name, words] : cases)
  {
    SCOPED_TRACE(name);
    Reader reader(folder + name);
    EXPECT_EQ(reader.errors, 1);
    EXPECT_EQ(reader.error().find(folder + name + ": "), 0u) << reader.error();
    EXPECT_NE(reader.error().find(words), std::string::npos) << reader.error();
    EXPECT_EQ(reader.error().find('\n'), std::string::npos);
    EXPECT_EQ(reader.output()->GetNumberOfPoints(), 0);
    // And it recovers.
    reader.reader->SetFileName((folder + "sky.exr").c_str());
    reader.reader->Update();
    EXPECT_EQ(reader.error(), "");
    expect_values(reader.output(), 12, 6);
  }
  vtkNew<vtkBrumeEnvironmentReader> nameless;
  nameless->SetGlobalWarningDisplay(0);
  nameless->Update();
  nameless->SetGlobalWarningDisplay(1);
  EXPECT_NE(std::string(nameless->GetErrorMessage()).find("SetFileName"), std::string::npos);
}

}
