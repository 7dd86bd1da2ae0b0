#include "machine.h"

#include "vtkVersion.h"

#include <sys/resource.h>
#include <sys/utsname.h>

#include <ctime>
#include <fstream>
#include <iterator>

namespace brume::app
{

namespace
{

/// What follows "KEY : " or "KEY=" on the first line that begins with the key.
std::string value_in_file(const char* path, const std::string& key)
{
  std::ifstream file(path);
  std::string line;
  while (std::getline(file, line))
  {
    if (line.compare(0, key.size(), key) == 0)
    {
      const std::size_t begin = line.find_first_not_of("\t :=\"", key.size());
      const std::size_t end = line.find_last_not_of("\"\n");
      return begin == std::string::npos ? "" : line.substr(begin, end - begin + 1);
    }
  }
  return {};
}

}

std::string shell_word(const std::string& word)
{
  const char* plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./:,@%";
  if (!word.empty() && word.find_first_not_of(plain) == std::string::npos)
  {
    return word;
  }
  std::string result = "'";
  for (char c : word)
  {
    result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  }
  return result + "'";
}

std::int64_t peak_memory_bytes()
{
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return std::int64_t{ usage.ru_maxrss } * 1024; // Linux counts in KiB
}

Machine this_machine(int threads, const std::string& simd)
{
  Machine machine;
  machine.cpu = value_in_file("/proc/cpuinfo", "model name");
  machine.threads = threads;
  machine.simd = simd;
  machine.os = value_in_file("/etc/os-release", "PRETTY_NAME");
  utsname name{};
  if (uname(&name) == 0)
  {
    machine.os += std::string(machine.os.empty() ? "" : ", ") + name.sysname + " " + name.release +
      ", " + name.machine;
  }
  machine.brume_version = BRUME_VERSION;
  machine.vtk_version = vtkVersion::GetVTKVersion();
  return machine;
}

std::string this_command_line()
{
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  const std::string all{ std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>() };
  std::string line;
  for (std::size_t at = 0; at < all.size();)
  {
    const std::size_t end = std::min(all.find('\0', at), all.size());
    std::string word = all.substr(at, end - at);
    if (at == 0)
    {
      word = "brume"; // wherever it lies
    }
    line += (line.empty() ? "" : " ") + shell_word(word);
    at = end + 1;
  }
  return line;
}

std::string utc_now()
{
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  char buffer[32];
  std::strftime(buffer, sizeof(buffer), "%Y-%m-%d %H:%M UTC", &utc);
  return buffer;
}

}
