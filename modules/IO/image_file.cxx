#include "image_file.h"

#include "atomic_file.h"
#include "header_text.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <stdexcept>

#include <zlib.h>

namespace brume::io
{

namespace
{

constexpr std::size_t Chunk = std::size_t(1) << 20;

/// Hands the voxels out piece by piece.
void for_each_chunk(const ImageFile& image,
  bool planar,
  const std::function<void(const void*, std::size_t)>& take)
{
  const std::uint64_t all = image.bytes();
  const auto* bytes = static_cast<const char*>(image.voxels);
  const std::size_t size = static_cast<std::size_t>(scalar_size(image.scalar));
  std::vector<char> gathered;
  for (std::uint64_t done = 0; done < all;)
  {
    if (image.progress && !image.progress(static_cast<double>(done) / static_cast<double>(all)))
    {
      throw std::runtime_error("interrupted"); // the program has its own words for it
    }
    const std::size_t count = static_cast<std::size_t>(std::min<std::uint64_t>(Chunk, all - done));
    if (!planar || image.components == 1)
    {
      take(bytes + done, count);
    }
    else
    {
      // The plane's n-th number is the n-th voxel's component.
      gathered.resize(count);
      const std::uint64_t voxels = all / size / static_cast<std::uint64_t>(image.components);
      for (std::size_t at = 0; at < count; at += size)
      {
        const std::uint64_t number = (done + at) / size;
        const std::uint64_t from =
          number % voxels * static_cast<std::uint64_t>(image.components) + number / voxels;
        std::memcpy(gathered.data() + at, bytes + from * size, size);
      }
      take(gathered.data(), count);
    }
    done += count;
  }
}

/// A zlib or gzip stream into a function.
class Deflater
{
public:
  Deflater(bool gzip, std::function<void(const void*, std::size_t)> sink)
    : sink_(std::move(sink))
    , buffer_(Chunk)
  {
    // Level 4: on noise and on scans within some per cent of the default's size, at twice its
    // speed.
    if (deflateInit2(&stream_, 4, Z_DEFLATED, gzip ? 15 + 16 : 15, 8, Z_DEFAULT_STRATEGY) != Z_OK)
    {
      throw std::bad_alloc();
    }
  }
  ~Deflater() { deflateEnd(&stream_); }
  Deflater(const Deflater&) = delete;
  Deflater& operator=(const Deflater&) = delete;

  void write(const void* bytes, std::size_t count) { run(bytes, count, Z_NO_FLUSH); }
  void finish() { run(nullptr, 0, Z_FINISH); }

private:
  void run(const void* bytes, std::size_t count, int flush)
  {
    stream_.next_in = static_cast<Bytef*>(const_cast<void*>(bytes));
    stream_.avail_in = static_cast<uInt>(count);
    do
    {
      stream_.next_out = reinterpret_cast<Bytef*>(buffer_.data());
      stream_.avail_out = static_cast<uInt>(buffer_.size());
      deflate(&stream_, flush);
      sink_(buffer_.data(), buffer_.size() - stream_.avail_out);
    } while (stream_.avail_out == 0);
  }

  std::function<void(const void*, std::size_t)> sink_;
  std::vector<char> buffer_;
  z_stream stream_{};
};

}

std::uint64_t ImageFile::values() const
{
  return static_cast<std::uint64_t>(dimensions[0]) * static_cast<std::uint64_t>(dimensions[1]) *
         static_cast<std::uint64_t>(dimensions[2]) * static_cast<std::uint64_t>(components);
}

std::uint64_t ImageFile::bytes() const
{
  return values() * static_cast<std::uint64_t>(scalar_size(scalar));
}

std::array<double, 3> ImageFile::spacing() const
{
  std::array<double, 3> lengths;
  for (int axis = 0; axis < 3; ++axis)
  {
    lengths[axis] = std::hypot(affine[axis], affine[4 + axis], affine[8 + axis]);
  }
  return lengths;
}

std::array<double, 9> ImageFile::direction() const
{
  const std::array<double, 3> lengths = spacing();
  std::array<double, 9> turn;
  for (int row = 0; row < 3; ++row)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      turn[3 * row + axis] = affine[4 * row + axis] / lengths[axis];
    }
  }
  return turn;
}

std::string exact(double number)
{
  char text[40];
  for (int digits = 6; digits <= 17; ++digits)
  {
    std::snprintf(text, sizeof(text), "%.*g", digits, number);
    if (std::strtod(text, nullptr) == number)
    {
      break;
    }
  }
  return text;
}

std::string write_mark(const ImageFile& image, bool length_fits)
{
  // A unit with a blank or a line end in it would not come back as one word.
  const auto word = [](const std::string& text)
  {
    return !text.empty() && text.size() <= 16 &&
           std::all_of(
             text.begin(), text.end(), [](unsigned char c) { return c > ' ' && c != 0x7f; });
  };
  std::string mark;
  mark += image.patient ? "" : " axes=world";
  mark += !length_fits && word(image.length_unit) ? " length=" + image.length_unit : "";
  mark += word(image.value_unit) ? " values=" + image.value_unit : "";
  return mark.empty() ? mark : "brume:" + mark;
}

bool read_mark(const std::string& text,
  bool& world_axes,
  std::string& length_unit,
  std::string& value_unit)
{
  const std::vector<std::string> words = split_words(text);
  if (words.empty() || words[0] != "brume:")
  {
    return false;
  }
  for (const std::string& word : words)
  {
    const std::size_t equals = word.find('=');
    const std::string key = word.substr(0, equals);
    const std::string value = equals == std::string::npos ? "" : word.substr(equals + 1);
    world_axes = world_axes || (key == "axes" && value == "world");
    length_unit = key == "length" ? value : length_unit;
    value_unit = key == "values" ? value : value_unit;
  }
  return true;
}

void write_plain(AtomicFile& file, const ImageFile& image, bool planar)
{
  for_each_chunk(
    image, planar, [&](const void* bytes, std::size_t count) { file.write(bytes, count); });
}

void write_gzip(AtomicFile& file, const ImageFile& image, const std::string& head, bool planar)
{
  Deflater stream(true, [&](const void* bytes, std::size_t count) { file.write(bytes, count); });
  stream.write(head.data(), head.size());
  for_each_chunk(
    image, planar, [&](const void* bytes, std::size_t count) { stream.write(bytes, count); });
  stream.finish();
}

std::string zlib_stream(const ImageFile& image)
{
  std::string out;
  Deflater stream(false,
    [&](const void* bytes, std::size_t count)
    { out.append(static_cast<const char*>(bytes), count); });
  for_each_chunk(
    image, false, [&](const void* bytes, std::size_t count) { stream.write(bytes, count); });
  stream.finish();
  return out;
}

}
