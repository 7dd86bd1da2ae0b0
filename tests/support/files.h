// What the tests of files share.
#pragma once

#include <cstddef>
#include <filesystem>
#include <stdexcept>
#include <string>

/// The message of the std::runtime_error that the call throws; empty when it throws none.
template <typename Call>
std::string error_of(Call call)
{
  try
  {
    call();
  }
  catch (const std::runtime_error& error)
  {
    return error.what();
  }
  return {};
}

/// How many entries a folder holds.
inline std::size_t files_in(const std::string& path)
{
  std::size_t n = 0;
  for (const auto& entry : std::filesystem::directory_iterator(path))
  {
    (void)entry;
    ++n;
  }
  return n;
}
