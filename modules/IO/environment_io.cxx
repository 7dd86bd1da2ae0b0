#include "environment_io.h"

#include "guarded_process.h"
#include "memory_limit.h"
#include "picture_threads.h"
#include "scan_header.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <new>

namespace brume::io
{

namespace
{

/// The most pixels along the horizon: 3 floats each of 32768 x 16384 are 6 GiB.
constexpr int widest = 32768;

/// What a file says of itself, in memory that is shared with the process that reads it.
struct Found
{
  int width, height, depth;
  int first, last; ///< the channels from the first colour to the last
  int place[3];    ///< of R, G and B; below 0: not there
  bool linear;     ///< floats or halves
  char type[64];
  char problem[512]; ///< OpenImageIO's words; empty: it could be opened
};

template <std::size_t Size>
void put(char (&to)[Size], const std::string& text)
{
  const std::string told = text.empty() ? "no reason given" : text;
  const std::size_t length = std::min(told.size(), Size - 1); // the rest is 0
  std::replace_copy(told.begin(), told.begin() + static_cast<std::ptrdiff_t>(length), to, '\n', ' ');
}

/// What the first process does: opens the file.
int look(const std::string& path, Found& found)
{
  const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(path);
  if (!input)
  {
    put(found.problem, OIIO::geterror());
    return 0;
  }
  const OIIO::ImageSpec spec = input->spec();
  const auto type = static_cast<OIIO::TypeDesc::BASETYPE>(spec.format.basetype);
  found.linear = type == OIIO::TypeDesc::FLOAT || type == OIIO::TypeDesc::HALF;
  put(found.type, spec.format.c_str());
  found.width = spec.width;
  found.height = spec.height;
  found.depth = spec.depth;
  const char* const names[3] = { "R", "G", "B" };
  for (int c = 0; c < 3; ++c)
  {
    found.place[c] = spec.channelindex(names[c]);
  }
  found.first = *std::min_element(found.place, found.place + 3);
  found.last = *std::max_element(found.place, found.place + 3);
  return 0;
}

/// What the second does: the channels from the first colour to the last.
int read(const std::string& path, Found& found, float* pixels)
{
  const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(path);
  if (!input || input->spec().width != found.width || input->spec().height != found.height ||
      input->spec().nchannels <= found.last)
  {
    put(found.problem, input ? "it changed meanwhile" : OIIO::geterror());
  }
  else if (!input->read_image(0, 0, found.first, found.last + 1, OIIO::TypeDesc::FLOAT, pixels))
  {
    put(found.problem, input->geterror());
  }
  return 0;
}

/// OpenImageIO's readers believe what a damaged file promises: they work in a process of their own.
void run(const std::string& path, const std::function<int()>& work, double seconds, double bytes, Found& found,
  const char* remedy)
{
  keep_picture_threads_out();
  const GuardResult result = run_guarded(work, seconds, bytes);
  if (result.end != GuardEnd::Finished || result.status != 0)
  {
    fail(path, spoken_end(result.end), "check that it is whole");
  }
  if (found.problem[0])
  {
    fail(path, std::string("cannot be read: ") + found.problem, remedy);
  }
}

}

EnvironmentPicture read_environment(const std::string& path, std::uint64_t limit)
{
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error))
  {
    fail(path, "no such file", "check the path");
  }
  const SharedMemory page(sizeof(Found));
  Found& found = *new (page.data()) Found();
  const double length = static_cast<double>(std::filesystem::file_size(path, error));
  run(path, [&] { return look(path, found); }, 1 + length / 2e7, 256 << 20, found,
    "take a whole OpenEXR or Radiance HDR file");
  if (!found.linear)
  {
    fail(path,
      "does not hold linear light, but " + std::string(found.type) + " values",
      "take an OpenEXR or Radiance HDR file");
  }
  if (found.width < 2 || found.width > widest || found.depth > 1 || found.height < 1 ||
      found.height > widest || std::abs(found.width - 2 * found.height) > 1)
  {
    fail(path,
      "is a picture of " + std::to_string(found.width) + " x " + std::to_string(found.height) + " pixels",
      "take a latitude-longitude map, which is twice as wide as high, up to 32768 x 16384");
  }
  const char names[3] = { 'R', 'G', 'B' };
  for (int c = 0; c < 3; ++c)
  {
    if (found.place[c] < 0)
    {
      fail(path, std::string("has no channel ") + names[c], "take a picture in colour");
    }
  }
  const int channels = found.last - found.first + 1;
  if (channels > 1024)
  {
    fail(path, "has its colours among more than 1024 channels", "take R, G and B out of it");
  }
  // All channels from the first colour to the last, in two processes; the three; and VTK's array of them.
  const double numbers = static_cast<double>(found.width) * found.height;
  check_memory(path, 4.0 * (2 * channels + 6.0) * numbers, limit);
  EnvironmentPicture picture;
  picture.width = found.width;
  picture.height = found.height;
  const std::size_t row_size = static_cast<std::size_t>(found.width) * channels;
  const SharedMemory shared(sizeof(float) * row_size * found.height);
  float* const pixels = static_cast<float*>(shared.data());
  run(path, [&] { return read(path, found, pixels); }, 1 + channels * numbers / 1e6,
    4.0 * channels * numbers + (256 << 20), found, "check that it is whole");
  picture.rgb.resize(3 * static_cast<std::size_t>(found.width) * found.height);
  float* out = picture.rgb.data();
  for (int y = found.height - 1; y >= 0; --y) // files begin at the top
  {
    const float* in = &pixels[row_size * y];
    for (int x = 0; x < found.width; ++x, in += channels, out += 3)
    {
      for (int c = 0; c < 3; ++c)
      {
        out[c] = in[found.place[c] - found.first];
      }
    }
  }
  return picture;
}

}
