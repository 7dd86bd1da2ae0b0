// Small tools for headers made of text lines (MetaImage, NRRD). Private to this module.
#pragma once

#include "scan_header.h"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace brume::io
{

/// Lines of a file, whatever its line ends (\n or \r\n), up to 64 KiB each and 1 MiB in all: a
/// header that is longer is not one.
class LineReader
{
public:
  /// Throws as file_length() does.
  explicit LineReader(const std::string& path);
  ~LineReader();
  /// The next line without its end; false when the file has ended. Throws "… is not a text header"
  /// past the limits above and for a line that holds control characters.
  bool next(std::string& line);
  /// Bytes read so far: where the data begins once the header's last line is read.
  std::uint64_t position() const { return position_; }

private:
  std::string path_;
  std::FILE* file_ = nullptr;
  std::uint64_t position_ = 0;
};

std::string trimmed(const std::string& text);
std::string lowered(std::string text);
/// At most 60 characters, for messages.
std::string shortened(const std::string& text);
std::vector<std::string> split_words(const std::string& text);
/// The blank-separated numbers of a text; false when a word is no number.
bool parse_numbers(const std::string& text, std::vector<double>& numbers);
/// A count that was written as a number; −1 when it is not whole or beyond 2^53.
std::int64_t whole_number(double number);
bool machine_is_big_endian();
/// The file names of "FORMAT MIN MAX STEP": FORMAT holds one %d (also %03d and the like). Throws
/// fail() for any other format and for more than 100 000 names.
std::vector<std::string> expand_pattern(
  const std::string& path, const std::vector<std::string>& words);
/// Sets the one data part's offset so that the volume, or the series, is the file's last bytes.
void take_from_end(ScanHeader& header);

}
