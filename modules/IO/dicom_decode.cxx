#include "dicom_decode.h"

#include "guarded_process.h"
#include "scan_header.h"

#include <gdcmImageReader.h>

#include <cstring>
#include <new>
#include <set>

namespace brume::io
{

namespace
{

enum Outcome
{
  Decoded = 0,
  Refused = 10,   ///< the decoder says no
  OtherSize = 11, ///< it gives other pixels than the header promises
};

/// What the decoder takes: the packed pixels, those of a picture in 32 bits, and what is made of all.
double decoder_memory(double bytes)
{
  return 4 * bytes;
}

/// And what GDCM may take that does not grow with the pixels: headers, tables, the heap's own share.
constexpr double Headroom = 64 << 20;

/// What the process of its own does.
int decode(
  const std::string& path, void* out, std::uint64_t bytes, int scalar_size, std::uint64_t frames)
{
  gdcm::ImageReader reader;
  reader.SetFileName(path.c_str());
  if (!reader.Read())
  {
    return Refused;
  }
  const gdcm::Image& image = reader.GetImage();
  const unsigned int depth = image.GetNumberOfDimensions() > 2 ? image.GetDimension(2) : 1;
  if (image.GetBufferLength() != bytes || depth != frames ||
    image.GetPixelFormat().GetPixelSize() % scalar_size != 0)
  {
    return OtherSize;
  }
  return image.GetBuffer(static_cast<char*>(out)) ? Decoded : Refused;
}

}

bool can_decode(const std::string& transfer_syntax)
{
  static const std::set<std::string> known{ "1.2.840.10008.1.2.5", "1.2.840.10008.1.2.4.50",
    "1.2.840.10008.1.2.4.51", "1.2.840.10008.1.2.4.57", "1.2.840.10008.1.2.4.70",
    "1.2.840.10008.1.2.4.80", "1.2.840.10008.1.2.4.81", "1.2.840.10008.1.2.4.90",
    "1.2.840.10008.1.2.4.91" };
  return known.count(transfer_syntax) > 0;
}

std::vector<unsigned char> decode_dicom(const std::string& owner, const std::string& path,
  std::uint64_t bytes, int scalar_size, std::uint64_t frames, const Progress& progress)
{
  const char* const remedy = "decompress it first (gdcmconv --raw IN OUT)";
  const std::string place = owner == path ? owner : owner + ": " + path;
  std::vector<unsigned char> pixels(bytes);
  const SharedMemory shared(bytes);
  const GuardResult result = run_guarded([&] { return decode(path, shared.data(), bytes, scalar_size, frames); },
    1 + static_cast<double>(bytes) / 4e6, decoder_memory(static_cast<double>(bytes)) + Headroom, progress);
  const bool done = result.end == GuardEnd::Finished && result.status == Decoded;
  if (done)
  {
    std::memcpy(pixels.data(), shared.data(), bytes);
  }
  if (!done)
  {
    const bool finished = result.end == GuardEnd::Finished;
    fail(place,
      !finished                      ? spoken_end(result.end)
        : result.status == OtherSize ? "its compressed pixels are not of the size and type that its header gives"
                                     : "its compressed pixels cannot be decoded",
      result.end == GuardEnd::Stopped ? "run it again" : remedy);
  }
  return pixels;
}

double decoding_need(double bytes)
{
  return 2 * bytes + decoder_memory(bytes); // what both processes share, and the copy of it
}

}
