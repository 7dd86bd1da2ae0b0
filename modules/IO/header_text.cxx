#include "header_text.h"

#include "file_access.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>

namespace brume::io
{

LineReader::LineReader(const std::string& path)
  : path_(path)
{
  file_length(path, path);
  file_ = std::fopen(path.c_str(), "rb");
  if (!file_)
  {
    fail(path, std::string("cannot be opened: ") + std::strerror(errno), "check its permissions");
  }
}

LineReader::~LineReader()
{
  if (file_)
  {
    std::fclose(file_);
  }
}

bool LineReader::next(std::string& line)
{
  line.clear();
  int c = 0;
  while ((c = std::fgetc(file_)) != EOF)
  {
    ++position_;
    if (c == '\n')
    {
      break;
    }
    const bool control = c < 32 && c != '\t' && c != '\r';
    if (control || line.size() > 65536 || position_ > (1u << 20))
    {
      fail(path_, "its header is not text", "check that the file is whole");
    }
    line.push_back(static_cast<char>(c));
  }
  if (c == EOF && line.empty())
  {
    return false;
  }
  if (!line.empty() && line.back() == '\r')
  {
    line.pop_back();
  }
  return true;
}

std::string trimmed(const std::string& text)
{
  const char* blanks = " \t\r\n";
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string::npos)
  {
    return {};
  }
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::string lowered(std::string text)
{
  std::transform(text.begin(), text.end(), text.begin(),
    [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

std::string shortened(const std::string& text)
{
  return text.size() <= 60 ? text : text.substr(0, 57) + "...";
}

std::vector<std::string> split_words(const std::string& text)
{
  std::vector<std::string> words;
  std::size_t at = 0;
  while ((at = text.find_first_not_of(" \t", at)) != std::string::npos)
  {
    const std::size_t end = std::min(text.find_first_of(" \t", at), text.size());
    words.push_back(text.substr(at, end - at));
    at = end;
  }
  return words;
}

bool parse_numbers(const std::string& text, std::vector<double>& numbers)
{
  for (const std::string& word : split_words(text))
  {
    const char* begin = word.data() + (word[0] == '+' ? 1 : 0);
    const char* end = word.data() + word.size();
    double number = 0;
    const std::from_chars_result result = std::from_chars(begin, end, number);
    if (result.ec != std::errc() || result.ptr != end)
    {
      return false;
    }
    numbers.push_back(number);
  }
  return true;
}

std::int64_t whole_number(double number)
{
  return number >= 0 && number <= 9007199254740992.0 && number == std::floor(number)
    ? static_cast<std::int64_t>(number)
    : -1;
}

bool machine_is_big_endian()
{
  const std::uint16_t one = 1;
  unsigned char first = 0;
  std::memcpy(&first, &one, 1);
  return first == 0;
}

std::vector<std::string> expand_pattern(
  const std::string& path, const std::vector<std::string>& words)
{
  const std::string& format = words[0];
  const std::size_t percent = format.find('%');
  std::size_t end = percent + 1;
  int width = 0;
  const bool zeros = end < format.size() && format[end] == '0';
  while (end < format.size() && std::isdigit(static_cast<unsigned char>(format[end])) && width < 100)
  {
    width = 10 * width + (format[end++] - '0');
  }
  std::vector<double> range;
  const bool known = end < format.size() && (format[end] == 'd' || format[end] == 'i') &&
    width < 20 && format.find('%', end) == std::string::npos;
  if (!known || !parse_numbers(words[1] + " " + words[2] + " " + words[3], range) ||
    whole_number(range[0]) < 0 || whole_number(range[1]) < 0 || whole_number(range[2]) < 1 ||
    (range[1] - range[0]) / range[2] > 100000)
  {
    fail(path, "the header's pattern of data files is not \"NAME%03d.raw MIN MAX STEP\"",
      "list the files one a line, or join them in one");
  }
  std::vector<std::string> names;
  for (std::int64_t i = whole_number(range[0]); i <= whole_number(range[1]);
       i += whole_number(range[2]))
  {
    std::string number = std::to_string(i);
    if (number.size() < static_cast<std::size_t>(width))
    {
      number.insert(0, width - number.size(), zeros ? '0' : ' ');
    }
    names.push_back(format.substr(0, percent) + number + format.substr(end + 1));
  }
  return names;
}

void take_from_end(ScanHeader& header)
{
  check_header(header); // the size cannot wrap around below
  const std::uint64_t length = file_length(header.path, header.parts[0].path);
  const std::uint64_t volumes = std::max<std::uint64_t>(header.times.size(), 1);
  header.parts[0].offset =
    length / volumes >= header.bytes() ? length - volumes * header.bytes() : 0;
}

}
