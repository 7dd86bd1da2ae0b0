#include "voxel_reader.h"

#include "file_access.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <type_traits>

namespace brume::io
{

namespace
{

[[noreturn]] void cut_short(const ScanHeader& header, const std::string& part)
{
  fail(part == header.path ? part : header.path + ": " + part,
    "the file is cut short: it holds fewer voxels than its header promises",
    "copy or download it again");
}

void report(const ScanHeader& header, const Progress& progress, double done)
{
  if (progress && !progress(done))
  {
    fail(header.path, "reading was interrupted", "run it again");
  }
}

void swap(unsigned char* bytes, std::size_t count, int size)
{
  for (std::size_t i = 0; i < count; i += size)
  {
    std::reverse(bytes + i, bytes + i + size);
  }
}

void read_binary(const ScanHeader& header, unsigned char* out, const Progress& progress)
{
  const std::uint64_t total = header.bytes();
  const std::uint64_t each = total / header.parts.size();
  const int size = scalar_size(header.scalar);
  constexpr std::size_t Piece = 4 << 20; // a multiple of every scalar size
  std::uint64_t done = 0;
  for (const DataPart& part : header.parts)
  {
    const bool inflate = header.encoding == Encoding::Deflated;
    ByteStream stream(header.path, part.path,
      header.offset_is_inflated ? 0 : part.offset + (inflate ? 0 : part.skip),
      inflate ? ByteStream::Inflate : ByteStream::Plain);
    if (!stream.skip((header.offset_is_inflated ? part.offset : 0) + (inflate ? part.skip : 0)))
    {
      cut_short(header, part.path);
    }
    for (std::uint64_t at = 0; at < each;)
    {
      report(header, progress, static_cast<double>(done) / total);
      const std::size_t count = static_cast<std::size_t>(std::min<std::uint64_t>(Piece, each - at));
      if (stream.read(out + done, count) != count)
      {
        cut_short(header, part.path);
      }
      if (header.swap_bytes)
      {
        swap(out + done, count, size);
      }
      at += count;
      done += count;
    }
    if (inflate && !header.more_follows)
    {
      // The checksum stands behind the last byte: going there is what finds damaged voxels.
      stream.skip(64 << 20);
    }
  }
}

/// Decimal numbers between blanks, commas or line ends.
class Words
{
public:
  explicit Words(ByteStream& stream)
    : stream_(stream)
  {
  }
  /// The next word; empty at the stream's end.
  const std::string& next()
  {
    word_.clear();
    for (;;)
    {
      if (at_ == count_)
      {
        count_ = stream_.read(buffer_, sizeof(buffer_));
        at_ = 0;
        if (count_ == 0)
        {
          return word_;
        }
      }
      const char c = buffer_[at_++];
      const bool blank = c == ' ' || c == '\n' || c == '\r' || c == '\t' || c == ',';
      if (!blank && word_.size() < 64)
      {
        word_.push_back(c);
      }
      else if (!word_.empty())
      {
        return word_;
      }
    }
  }

private:
  ByteStream& stream_;
  char buffer_[1 << 16];
  std::size_t at_ = 0;
  std::size_t count_ = 0;
  std::string word_;
};

template <typename T>
void read_text(const ScanHeader& header, T* out, const Progress& progress)
{
  const std::uint64_t total = header.voxels() * header.components;
  const std::uint64_t each = total / header.parts.size();
  for (const DataPart& part : header.parts)
  {
    ByteStream stream(header.path, part.path, part.offset, ByteStream::Plain);
    const auto words = std::make_unique<Words>(stream);
    for (std::uint64_t i = part.skip / sizeof(T); i > 0; --i)
    {
      if (words->next().empty())
      {
        cut_short(header, part.path);
      }
    }
    for (std::uint64_t i = 0; i < each; ++i)
    {
      if (i % (1 << 20) == 0)
      {
        report(header, progress, static_cast<double>(i) / total);
      }
      const std::string& word = words->next();
      if (word.empty())
      {
        cut_short(header, part.path);
      }
      const char* begin = word.data() + (word[0] == '+' ? 1 : 0);
      const char* end = word.data() + word.size();
      T value{};
      std::from_chars_result result = std::from_chars(begin, end, value);
      if (std::is_integral<T>::value && (result.ec != std::errc() || result.ptr != end))
      {
        // "7.0" and "1e3" are whole numbers too.
        double real = 0;
        result = std::from_chars(begin, end, real);
        if (real == std::floor(real) && real >= static_cast<double>(std::numeric_limits<T>::lowest()) &&
          real < static_cast<double>(std::numeric_limits<T>::max()))
        {
          value = static_cast<T>(real);
        }
        else
        {
          result.ec = std::errc::invalid_argument;
        }
      }
      // A float beyond its range is what its digits say: infinite or zero; only a non-number is bad.
      if (result.ptr != end || (result.ec != std::errc() && std::is_integral<T>::value))
      {
        fail(header.path, "\"" + word + "\" among the voxels is not a number of their type",
          "check that the file is whole");
      }
      if (result.ec == std::errc::result_out_of_range)
      {
        value = static_cast<T>(std::strtod(word.c_str(), nullptr));
      }
      *out++ = value;
    }
  }
}

void read_numbers_of_text(const ScanHeader& header, void* out, const Progress& progress)
{
  switch (header.scalar)
  {
    case Scalar::Int8:
      return read_text(header, static_cast<std::int8_t*>(out), progress);
    case Scalar::UInt8:
      return read_text(header, static_cast<std::uint8_t*>(out), progress);
    case Scalar::Int16:
      return read_text(header, static_cast<std::int16_t*>(out), progress);
    case Scalar::UInt16:
      return read_text(header, static_cast<std::uint16_t*>(out), progress);
    case Scalar::Int32:
      return read_text(header, static_cast<std::int32_t*>(out), progress);
    case Scalar::UInt32:
      return read_text(header, static_cast<std::uint32_t*>(out), progress);
    case Scalar::Int64:
      return read_text(header, static_cast<std::int64_t*>(out), progress);
    case Scalar::UInt64:
      return read_text(header, static_cast<std::uint64_t*>(out), progress);
    case Scalar::Float32:
      return read_text(header, static_cast<float*>(out), progress);
    case Scalar::Float64:
      return read_text(header, static_cast<double*>(out), progress);
  }
}

}

void read_voxels(const ScanHeader& header, void* out, const Progress& progress)
{
  unsigned char* bytes = static_cast<unsigned char*>(out);
  std::vector<unsigned char> planes;
  const bool interleave = header.planar && header.components > 1;
  if (interleave)
  {
    planes.resize(header.bytes());
  }
  if (header.encoding == Encoding::Text)
  {
    read_numbers_of_text(header, interleave ? planes.data() : out, progress);
  }
  else
  {
    read_binary(header, interleave ? planes.data() : bytes, progress);
  }
  if (interleave)
  {
    const std::size_t size = scalar_size(header.scalar);
    const std::size_t voxels = header.voxels();
    const std::size_t components = header.components;
    for (std::size_t c = 0; c < components; ++c)
    {
      for (std::size_t i = 0; i < voxels; ++i)
      {
        std::memcpy(bytes + (i * components + c) * size, planes.data() + (c * voxels + i) * size, size);
      }
    }
  }
}

void reverse_axis(
  void* voxels, const std::array<std::int64_t, 3>& dimensions, std::size_t voxel_bytes, int axis)
{
  // Seen from one axis, the volume is `outer` blocks of `count` runs of `run` bytes.
  std::size_t run = voxel_bytes;
  for (int a = 0; a < axis; ++a)
  {
    run *= dimensions[a];
  }
  const std::size_t count = dimensions[axis];
  std::size_t outer = 1;
  for (int a = axis + 1; a < 3; ++a)
  {
    outer *= dimensions[a];
  }
  unsigned char* block = static_cast<unsigned char*>(voxels);
  for (std::size_t o = 0; o < outer; ++o, block += count * run)
  {
    for (std::size_t i = 0; i < count / 2; ++i)
    {
      unsigned char* a = block + i * run;
      std::swap_ranges(a, a + run, block + (count - 1 - i) * run);
    }
  }
}

}
