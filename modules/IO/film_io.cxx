#include "film_io.h"

#include "atomic_file.h"
#include "picture_threads.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <stdexcept>

namespace brume
{

namespace
{

constexpr int ChannelCount = 9;
const char* const Channels[ChannelCount] = { "R", "G", "B", "A", "transmittance.R", "transmittance.G",
  "transmittance.B", "Z", "error" };

[[noreturn]] void fail(const std::string& path, const std::string& wrong, const std::string& remedy)
{
  throw std::runtime_error(path + ": " + wrong + ": " + remedy);
}

std::string ending_of(const std::string& path)
{
  std::string ending = std::filesystem::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), ::tolower);
  return ending;
}

void want_ending(const std::string& path, const std::string& ending)
{
  check_picture_path(path);
  if (ending_of(path) != ending)
  {
    fail(path, "does not end in " + ending, "name a file that does");
  }
}

void check_size(const std::string& path, int width, int height, bool right)
{
  if (width < 1 || height < 1 || !right)
  {
    fail(path, "the picture has no pixels, or planes of the wrong size", "render it first");
  }
}

void check_interleaved(const std::string& path, const std::vector<float>& rgb, int width, int height)
{
  check_size(path, width, height,
    width > 0 && height > 0 && rgb.size() == 3 * static_cast<std::size_t>(width) * height);
}

/// One line: what a library says may have several.
std::string one_line(std::string text)
{
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text.empty() ? "no reason given" : text;
}

/// Encodes in memory, so that all that can fail on a disk fails in AtomicFile.
std::vector<unsigned char> encode(const std::string& path, const std::string& format,
  const OIIO::ImageSpec& spec, OIIO::TypeDesc type, const void* pixels)
{
  io::keep_picture_threads_out();
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(format, &memory);
  if (!output)
  {
    fail(path, "cannot be encoded: " + one_line(OIIO::geterror()), "install OpenImageIO's plugins");
  }
  const bool done = output->open("memory." + format, spec) && output->write_image(type, pixels) &&
    output->close();
  if (!done)
  {
    fail(path, "cannot be encoded: " + one_line(output->geterror()), "take a smaller picture");
  }
  return bytes;
}

}

void check_picture_path(const std::string& path)
{
  const std::string ending = ending_of(path);
  if (ending != ".png" && ending != ".exr" && ending != ".hdr")
  {
    fail(path, ending.empty() ? "has no ending that names a format"
                              : "its ending " + ending + " is no format that Brume writes",
      "name a file that ends in .png, .exr or .hdr");
  }
}

unsigned char display_byte(float value, const Display& display)
{
  double v = static_cast<double>(value) * std::exp2(display.exposure);
  if (!(v > 0)) // NaN too
  {
    return 0;
  }
  v = std::min(v, 1.0);
  if (display.curve == Display::Curve::SRGB)
  {
    v = v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
  }
  return static_cast<unsigned char>(std::floor(std::min(v, 1.0) * 255 + 0.5));
}

void write_exr(const Film& film, const std::string& path,
  const std::map<std::string, std::string>& metadata)
{
  want_ending(path, ".exr");
  const std::size_t count =
    film.width > 0 && film.height > 0 ? film.size() : 0;
  bool right = film.depth.size() == count && film.error.size() == count;
  for (int c = 0; c < 3; ++c)
  {
    right = right && film.radiance[c].size() == count && film.transmittance[c].size() == count;
  }
  check_size(path, film.width, film.height, right);

  OIIO::ImageSpec spec(film.width, film.height, ChannelCount, OIIO::TypeDesc::FLOAT);
  spec.channelnames.assign(Channels, Channels + ChannelCount);
  spec.alpha_channel = 3;
  spec.z_channel = 7;
  spec.attribute("compression", "zip");
  spec.attribute("oiio:ColorSpace", "Linear");
  spec.attribute("Software", "Brume " BRUME_VERSION);
  for (const auto& [key, value] : metadata)
  {
    spec.attribute(key, value);
  }
  std::vector<float> pixels(ChannelCount * count);
  float* out = pixels.data();
  for (int row = film.height - 1; row >= 0; --row) // EXR begins at the top
  {
    for (std::size_t i = static_cast<std::size_t>(row) * film.width, end = i + film.width; i < end;
         ++i, out += ChannelCount)
    {
      double passed = 0;
      for (int c = 0; c < 3; ++c)
      {
        out[c] = film.radiance[c][i];
        out[4 + c] = film.transmittance[c][i];
        passed += film.transmittance[c][i];
      }
      out[3] = static_cast<float>(1 - passed / 3);
      out[7] = film.depth[i];
      out[8] = film.error[i];
    }
  }
  const std::vector<unsigned char> bytes =
    encode(path, "exr", spec, OIIO::TypeDesc::FLOAT, pixels.data());
  write_atomically(path, bytes.data(), bytes.size());
}

Film read_exr(const std::string& path)
{
  want_ending(path, ".exr");
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error))
  {
    fail(path, "no such file", "check the path");
  }
  io::keep_picture_threads_out();
  const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(path);
  if (!input)
  {
    fail(path, "cannot be read: " + one_line(OIIO::geterror()), "check that it is OpenEXR and whole");
  }
  const OIIO::ImageSpec spec = input->spec();
  const int channels = spec.nchannels;
  if (spec.width < 1 || spec.height < 1 || spec.depth > 1 || channels > 1024)
  {
    fail(path, "is not a picture of two dimensions", "check that it is what it should be");
  }
  int place[ChannelCount];
  for (int c = 0; c < ChannelCount; ++c)
  {
    place[c] = spec.channelindex(Channels[c]);
  }
  if (place[0] < 0 || place[1] < 0 || place[2] < 0)
  {
    fail(path, "has no channels R, G and B", "name a picture in colour");
  }
  std::vector<float> pixels(static_cast<std::size_t>(spec.width) * spec.height * channels);
  if (!input->read_image(0, 0, 0, channels, OIIO::TypeDesc::FLOAT, pixels.data()))
  {
    fail(path, "cannot be read: " + one_line(input->geterror()), "check that it is whole");
  }
  Film film(spec.width, spec.height);
  for (int y = 0; y < spec.height; ++y)
  {
    for (int x = 0; x < spec.width; ++x)
    {
      const float* in = &pixels[(static_cast<std::size_t>(y) * spec.width + x) * channels];
      const std::size_t i = static_cast<std::size_t>(spec.height - 1 - y) * spec.width + x;
      for (int c = 0; c < 3; ++c)
      {
        film.radiance[c][i] = in[place[c]];
        film.transmittance[c][i] = place[4 + c] >= 0 ? in[place[4 + c]]
          : place[3] >= 0                            ? 1 - in[place[3]]
                                                     : 0;
      }
      film.depth[i] = place[7] >= 0 ? in[place[7]] : std::numeric_limits<float>::infinity();
      film.error[i] = place[8] >= 0 ? in[place[8]] : 0.f;
    }
  }
  return film;
}

void write_png(const std::vector<float>& rgb, int width, int height, const std::string& path,
  const Display& display)
{
  want_ending(path, ".png");
  check_interleaved(path, rgb, width, height);
  const std::size_t row_size = 3 * static_cast<std::size_t>(width);
  if (!std::isfinite(display.exposure))
  {
    fail(path, "the exposure is not a finite number", "give it in stops, such as 0 or -1.5");
  }
  std::vector<unsigned char> pixels(rgb.size());
  for (int row = 0; row < height; ++row) // PNG begins at the top
  {
    const float* in = rgb.data() + row_size * (height - 1 - row);
    std::transform(in, in + row_size, pixels.data() + row_size * row,
      [&](float v) { return display_byte(v, display); });
  }
  OIIO::ImageSpec spec(width, height, 3, OIIO::TypeDesc::UINT8);
  spec.attribute("Software", "Brume " BRUME_VERSION);
  const std::vector<unsigned char> bytes =
    encode(path, "png", spec, OIIO::TypeDesc::UINT8, pixels.data());
  write_atomically(path, bytes.data(), bytes.size());
}

void write_png(const Film& film, const double background[3], const std::string& path,
  const Display& display)
{
  write_png(over_background(film, background), film.width, film.height, path, display);
}

void write_hdr(
  const std::vector<float>& rgb, int width, int height, const std::string& path)
{
  want_ending(path, ".hdr");
  check_interleaved(path, rgb, width, height);
  const std::size_t row_size = 3 * static_cast<std::size_t>(width);
  std::vector<float> pixels(rgb.size());
  for (int row = 0; row < height; ++row) // the file begins at the top
  {
    // The format has no signs, infinities or NaN; its largest number is below 2^127.
    std::transform(rgb.begin() + static_cast<std::ptrdiff_t>(row_size * (height - 1 - row)),
      rgb.begin() + static_cast<std::ptrdiff_t>(row_size * (height - row)),
      pixels.begin() + static_cast<std::ptrdiff_t>(row_size * row),
      [](float v) { return v > 0 ? std::min(v, 1.6e38f) : 0.0f; });
  }
  OIIO::ImageSpec spec(width, height, 3, OIIO::TypeDesc::FLOAT);
  spec.attribute("Software", "Brume " BRUME_VERSION);
  const std::vector<unsigned char> bytes =
    encode(path, "hdr", spec, OIIO::TypeDesc::FLOAT, pixels.data());
  write_atomically(path, bytes.data(), bytes.size());
}

}
