#include "output_check.h"

#include "command.h"

#include "atomic_file.h"

#include <filesystem>

namespace brume::app
{

namespace fs = std::filesystem;

namespace
{

fs::path place(const std::string& path)
{
  std::error_code error;
  return fs::weakly_canonical(fs::absolute(path, error), error);
}

}

void check_output(
  const std::string& path, const std::string& input, const std::vector<std::string>& others)
{
  if (path.empty())
  {
    return;
  }
  std::error_code error;
  if (fs::equivalent(path, input, error) && fs::is_regular_file(path, error))
  {
    throw Failure(path, "it is the input, which would be lost", "name another file", BadCall);
  }
  for (const std::string& other : others)
  {
    if (!other.empty() && place(path) == place(other))
    {
      throw Failure(path, "two outputs have this name", "name two files", BadCall);
    }
  }
  const fs::file_status status = fs::status(path, error);
  if (fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status))
  {
    return; // a pipe or a device: to open it and close it again may mean something to its reader
  }
  AtomicFile probe(path); // written beside its place, and removed
}

}
