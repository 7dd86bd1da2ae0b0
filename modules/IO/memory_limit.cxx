#include "memory_limit.h"

#include "scan_header.h"

#include "vtksys/SystemInformation.hxx"

#include <cstdio>
#include <limits>

namespace brume::io
{

namespace
{

/// "18.6 GB": three digits, in powers of 1000.
std::string spoken(double bytes)
{
  static const char* const units[] = { "kB", "MB", "GB", "TB", "PB" };
  double value = bytes / 1e3;
  int unit = 0;
  while (value >= 999.5 && unit < 4)
  {
    value /= 1000;
    ++unit;
  }
  char text[32];
  std::snprintf(text, sizeof(text), "%.3g %s", value, units[unit]);
  return text;
}

}

std::uint64_t memory_limit(std::uint64_t chosen)
{
  if (chosen > 0)
  {
    return chosen;
  }
  vtksys::SystemInformation machine;
  const std::uint64_t kilobytes = static_cast<std::uint64_t>(machine.GetHostMemoryTotal());
  return kilobytes > 0 ? kilobytes * 768 : std::numeric_limits<std::uint64_t>::max();
}

void check_memory(const std::string& path, double bytes, std::uint64_t limit)
{
  const double most = static_cast<double>(memory_limit(limit));
  if (bytes > most)
  {
    fail(path, "takes " + spoken(bytes) + " of memory, and the limit is " + spoken(most),
      "check that its header is right, take a part of it, or allow more (--max-memory)");
  }
}

}
