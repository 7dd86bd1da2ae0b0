// Pictures of light from all around, from files. Internal to IO.
#ifndef environment_io_h
#define environment_io_h

#include <cstdint>
#include <string>
#include <vector>

namespace brume::io
{

struct EnvironmentPicture
{
  int width = 0;
  int height = 0;
  std::vector<float> rgb; ///< R, G, B, linear, rows from the bottom up
};

/// Reads a latitude–longitude picture of linear light (OpenEXR, Radiance HDR, or what else
/// OpenImageIO reads as floating point). Throws std::runtime_error, "PATH: what is wrong: what to
/// do": no such file, no picture, 8 or 16 bits a channel, no R, G, B, not twice as wide as high, more memory than `limit` (memory_limit.h).
EnvironmentPicture read_environment(const std::string& path, std::uint64_t limit);

}

#endif
