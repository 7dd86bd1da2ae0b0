#include "voxel_reader.h"

#include "dicom_decode.h"
#include "file_access.h"
#include "picture_stack.h"

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

/// Pictures that a decoder makes, a file at a time.
void read_dicom(const ScanHeader& header, unsigned char* out, const Progress& progress)
{
  const std::uint64_t each = header.bytes() / header.parts.size();
  std::vector<unsigned char> pictures;
  std::string path;
  std::uint64_t done = 0;
  for (const DataPart& part : header.parts)
  {
    report(header, progress, static_cast<double>(done) / header.parts.size());
    if (part.path != path)
    {
      pictures.clear();
      pictures.shrink_to_fit();
      path = part.path;
      pictures = decode_dicom(header.path, path, each * part.frames, scalar_size(header.scalar),
        part.frames,
        [&](double)
        { return !progress || progress(static_cast<double>(done) / static_cast<double>(header.parts.size())); });
    }
    std::memcpy(out + done * each, pictures.data() + part.frame * each, each);
    ++done;
  }
}

/// Components that lie plane after plane, put together number by number.
void interleave(unsigned char* out, const unsigned char* planes, std::size_t voxels,
  std::size_t components, std::size_t size)
{
  for (std::size_t c = 0; c < components; ++c)
  {
    for (std::size_t i = 0; i < voxels; ++i)
    {
      std::memcpy(out + (i * components + c) * size, planes + (c * voxels + i) * size, size);
    }
  }
}

/// Numbers of which only the lowest bits count take the sign from the highest of these.
template <typename T>
void extend_sign(T* numbers, std::size_t count, int bits)
{
  using Bits = std::make_unsigned_t<T>;
  const int shift = static_cast<int>(8 * sizeof(T)) - bits;
  for (std::size_t i = 0; i < count; ++i)
  {
    numbers[i] = static_cast<T>(static_cast<T>(static_cast<Bits>(numbers[i]) << shift) >> shift);
  }
}

/// The bits above those that count may hold anything: they become 0.
template <typename T>
void mask_bits(T* numbers, std::size_t count, int bits)
{
  const T mask = static_cast<T>((std::uint64_t(1) << bits) - 1);
  for (std::size_t i = 0; i < count; ++i)
  {
    numbers[i] &= mask;
  }
}

void keep_stored_bits(const ScanHeader& header, void* out)
{
  const std::size_t count = header.voxels() * header.components;
  if (header.stored_bits < 1 || header.stored_bits >= 8 * scalar_size(header.scalar))
  {
    return;
  }
  switch (header.scalar)
  {
    case Scalar::Int8:
      return extend_sign(static_cast<std::int8_t*>(out), count, header.stored_bits);
    case Scalar::Int16:
      return extend_sign(static_cast<std::int16_t*>(out), count, header.stored_bits);
    case Scalar::Int32:
      return extend_sign(static_cast<std::int32_t*>(out), count, header.stored_bits);
    case Scalar::UInt8:
      return mask_bits(static_cast<std::uint8_t*>(out), count, header.stored_bits);
    case Scalar::UInt16:
      return mask_bits(static_cast<std::uint16_t*>(out), count, header.stored_bits);
    case Scalar::UInt32:
      return mask_bits(static_cast<std::uint32_t*>(out), count, header.stored_bits);
    default:
      return;
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
  const bool planar = (header.planar || header.part_planar) && header.components > 1;
  if (planar)
  {
    planes.resize(header.bytes());
  }
  unsigned char* const stored = planar ? planes.data() : bytes;
  if (header.encoding == Encoding::Text)
  {
    read_numbers_of_text(header, stored, progress);
  }
  else if (header.encoding == Encoding::Dicom)
  {
    read_dicom(header, stored, progress);
  }
  else if (header.encoding == Encoding::Pictures)
  {
    read_pictures(header, stored, progress);
  }
  else
  {
    read_binary(header, stored, progress);
  }
  if (planar)
  {
    const std::size_t slices =
      header.part_planar ? static_cast<std::size_t>(header.dimensions[2]) : 1;
    const std::size_t each = header.bytes() / slices;
    for (std::size_t slice = 0; slice < slices; ++slice)
    {
      interleave(bytes + slice * each, planes.data() + slice * each, header.voxels() / slices,
        header.components, scalar_size(header.scalar));
    }
  }
  keep_stored_bits(header, out);
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
