// Numbered files: the volumes of a series over time, or the slices of a stack. Private to this module.
#pragma once

#include "vtkBrumeIOModule.h" // the export macro alone

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
VTKBRUMEIO_EXPORT bool is_file_pattern(const std::string& path);

/// Whether a name for files that are to be written has such a mark in it: %d, %04d, or two # and more
/// (a single one, or a star, belongs to the name).
VTKBRUMEIO_EXPORT bool has_number_mark(const std::string& path);

/// "smoke_0012.vdb" of "smoke_%04d.vdb", number 12 (from 0 on): at least as many digits as the mark
/// asks for. A path without a mark is returned as it is.
VTKBRUMEIO_EXPORT std::string numbered_name(const std::string& pattern, std::int64_t number);

/// The files that the pattern names, by rising number. Throws fail() where there is none, where two
/// have one number ("a1" and "a01"), or where there are more than 1,000,000.
VTKBRUMEIO_EXPORT std::vector<NumberedFile> numbered_files(const std::string& pattern);

}
