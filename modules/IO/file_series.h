// Numbered files: the volumes of a series over time, or the slices of a stack. Private to this module.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace brume::io
{

struct NumberedFile
{
  std::int64_t number = 0;
  std::string path;
};

/// Whether a path is no file and its name has a mark that stands for a number: %d, %04d (at least
/// four digits), ####, or *. Throws nothing.
bool is_file_pattern(const std::string& path);

/// The files that the pattern names, by rising number. Throws fail() where there is none, where two
/// have one number ("a1" and "a01"), or where there are more than 1,000,000.
std::vector<NumberedFile> numbered_files(const std::string& pattern);

}
