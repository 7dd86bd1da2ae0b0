#include "dicom_decode.h"

#include "scan_header.h"

#include <gdcmImageReader.h>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstring>
#include <set>
#include <thread>

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

/// What the process of its own does. Never returns.
[[noreturn]] void decode_and_exit(
  const std::string& path, void* out, std::uint64_t bytes, int scalar_size, std::uint64_t frames)
{
  const int nowhere = open("/dev/null", O_WRONLY);
  dup2(nowhere, 1);
  dup2(nowhere, 2); // GDCM tells the standard error stream of all that it doubts
  const rlimit none{ 0, 0 };
  setrlimit(RLIMIT_CORE, &none);
  int outcome = Refused;
  try
  {
    gdcm::ImageReader reader;
    reader.SetFileName(path.c_str());
    if (reader.Read())
    {
      const gdcm::Image& image = reader.GetImage();
      const unsigned int depth = image.GetNumberOfDimensions() > 2 ? image.GetDimension(2) : 1;
      outcome = OtherSize;
      if (image.GetBufferLength() == bytes && depth == frames &&
        image.GetPixelFormat().GetPixelSize() % scalar_size == 0)
      {
        outcome = image.GetBuffer(static_cast<char*>(out)) ? Decoded : Refused;
      }
    }
  }
  catch (...)
  {
  }
  _exit(outcome);
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
  std::uint64_t bytes, int scalar_size, std::uint64_t frames)
{
  const char* const remedy = "decompress it first (gdcmconv --raw IN OUT)";
  const std::string place = owner == path ? owner : owner + ": " + path;
  std::vector<unsigned char> pixels(bytes);
  void* shared =
    mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (shared == MAP_FAILED)
  {
    throw std::bad_alloc();
  }
  const pid_t child = fork();
  if (child == 0)
  {
    decode_and_exit(path, shared, bytes, scalar_size, frames);
  }
  int status = 0;
  bool late = false;
  if (child > 0)
  {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(10 + bytes / 4000000);
    auto pause = std::chrono::microseconds(200);
    while (waitpid(child, &status, WNOHANG) == 0)
    {
      if (!late && std::chrono::steady_clock::now() > end)
      {
        late = true;
        kill(child, SIGKILL);
      }
      std::this_thread::sleep_for(pause);
      pause = std::min(2 * pause, std::chrono::microseconds(20000));
    }
  }
  const bool done = child > 0 && WIFEXITED(status) && WEXITSTATUS(status) == Decoded;
  if (done)
  {
    std::memcpy(pixels.data(), shared, bytes);
  }
  munmap(shared, bytes);
  if (child < 0)
  {
    fail(place, "no process can be started to decode it", remedy);
  }
  if (!done)
  {
    const bool other = WIFEXITED(status) && WEXITSTATUS(status) == OtherSize;
    fail(place,
      late      ? "its compressed pixels take too long to decode"
        : other ? "its compressed pixels are not of the size and type that its header gives"
                : "its compressed pixels cannot be decoded",
      remedy);
  }
  return pixels;
}

}
