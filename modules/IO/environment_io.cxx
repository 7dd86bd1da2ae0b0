#include "environment_io.h"

#include "memory_limit.h"
#include "scan_header.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <memory>

namespace brume::io
{

namespace
{

/// The most pixels along the horizon: 3 floats each of 32768 x 16384 are 6 GiB.
constexpr int widest = 32768;

std::string one_line(std::string text)
{
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text.empty() ? "no reason given" : text;
}

}

EnvironmentPicture read_environment(const std::string& path, std::uint64_t limit)
{
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error))
  {
    fail(path, "no such file", "check the path");
  }
  const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(path);
  if (!input)
  {
    fail(path,
      "cannot be read: " + one_line(OIIO::geterror()),
      "take a whole OpenEXR or Radiance HDR file");
  }
  const OIIO::ImageSpec spec = input->spec();
  const auto type = static_cast<OIIO::TypeDesc::BASETYPE>(spec.format.basetype);
  if (type != OIIO::TypeDesc::FLOAT && type != OIIO::TypeDesc::HALF)
  {
    fail(path,
      "does not hold linear light, but " + std::string(spec.format.c_str()) + " values",
      "take an OpenEXR or Radiance HDR file");
  }
  const std::string size = std::to_string(spec.width) + " x " + std::to_string(spec.height);
  if (spec.width < 2 || spec.width > widest || spec.depth > 1 ||
      std::abs(spec.width - 2 * spec.height) > 1)
  {
    fail(path,
      "is a picture of " + size + " pixels",
      "take a latitude-longitude map, which is twice as wide as high, up to 32768 x 16384");
  }
  const char* const names[3] = { "R", "G", "B" };
  int place[3];
  for (int c = 0; c < 3; ++c)
  {
    place[c] = spec.channelindex(names[c]);
    if (place[c] < 0)
    {
      fail(path, "has no channel " + std::string(names[c]), "take a picture in colour");
    }
  }
  const int first = *std::min_element(place, place + 3);
  const int channels = *std::max_element(place, place + 3) - first + 1;
  if (channels > 1024)
  {
    fail(path, "has its colours among more than 1024 channels", "take R, G and B out of it");
  }
  const std::size_t row_size = static_cast<std::size_t>(spec.width) * channels;
  // All channels from the first colour to the last, the three, and the three in VTK's array.
  check_memory(
    path, 4.0 * (channels + 6.0) * spec.width * spec.height, limit);
  EnvironmentPicture picture;
  picture.width = spec.width;
  picture.height = spec.height;
  std::vector<float> pixels(row_size * spec.height);
  if (!input->read_image(0, 0, first, first + channels, OIIO::TypeDesc::FLOAT, pixels.data()))
  {
    fail(path, "cannot be read: " + one_line(input->geterror()), "check that it is whole");
  }
  picture.rgb.resize(3 * static_cast<std::size_t>(spec.width) * spec.height);
  float* out = picture.rgb.data();
  for (int y = spec.height - 1; y >= 0; --y) // files begin at the top
  {
    const float* in = &pixels[row_size * y];
    for (int x = 0; x < spec.width; ++x, in += channels, out += 3)
    {
      for (int c = 0; c < 3; ++c)
      {
        out[c] = in[place[c] - first];
      }
    }
  }
  return picture;
}

}
