#include "output_folder.h"

#include "command.h"

#include "atomic_file.h"

#include <system_error>

namespace brume::app
{

namespace fs = std::filesystem;

OutputFolder::OutputFolder(const std::string& path, const std::string& probe)
  : Path(path)
{
  std::error_code error;
  fs::path missing = fs::absolute(path, error);
  while (!missing.empty() && !fs::exists(fs::symlink_status(missing, error)))
  {
    this->Made = missing;
    missing = missing.parent_path();
  }
  fs::create_directories(path, error);
  if (error || !fs::is_directory(path, error))
  {
    this->remove();
    throw Failure(path,
      "the output folder cannot be made (" + (error ? error.message() : std::string("a file is there")) +
        ")",
      "name another with --output");
  }
  try
  {
    AtomicFile tried((fs::path(path) / probe).string());
  }
  catch (const std::runtime_error& failure)
  {
    this->remove();
    throw Failure(failure.what());
  }
}

OutputFolder::~OutputFolder()
{
  if (!this->Kept)
  {
    this->remove();
  }
}

std::string OutputFolder::file(const std::string& name) const
{
  return (fs::path(this->Path) / name).string();
}

void OutputFolder::remove()
{
  std::error_code error;
  if (!this->Made.empty())
  {
    fs::remove_all(this->Made, error);
  }
}

}
