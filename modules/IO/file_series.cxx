#include "file_series.h"

#include "scan_header.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

namespace brume::io
{

namespace fs = std::filesystem;

namespace
{

bool is_digit(char c)
{
  return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

/// A name with the place of a number in it.
struct Pattern
{
  std::string before;
  std::string after;
  std::size_t digits = 1; ///< at least
  char mark = 0;          ///< the character that it begins with
  bool found = false;
};

Pattern parse(const std::string& name)
{
  Pattern p;
  std::size_t begin = name.find_first_of("%#*");
  for (; begin != std::string::npos && !p.found; begin = name.find_first_of("%#*", begin + 1))
  {
    std::size_t end = begin + 1;
    std::size_t digits = 1;
    if (name[begin] == '#')
    {
      end = std::min(name.find_first_not_of('#', begin), name.size());
      digits = end - begin;
    }
    else if (name[begin] == '%')
    {
      digits = 0;
      while (end < name.size() && is_digit(name[end]) && digits < 100)
      {
        digits = 10 * digits + static_cast<std::size_t>(name[end++] - '0');
      }
      if (end >= name.size() || (name[end] != 'd' && name[end] != 'i'))
      {
        continue;
      }
      ++end;
    }
    p = { name.substr(0, begin), name.substr(end), std::max<std::size_t>(digits, 1), name[begin], true };
  }
  return p;
}

}

bool is_file_pattern(const std::string& path)
{
  std::error_code error;
  return !path.empty() && !fs::exists(path, error) && !error &&
    parse(fs::path(path).filename().string()).found;
}

bool has_number_mark(const std::string& path)
{
  const std::string name = fs::path(path).filename().string();
  const Pattern p = parse(name);
  return p.found && (p.mark == '%' || (p.mark == '#' && p.digits > 1));
}

std::string numbered_name(const std::string& pattern, std::int64_t number)
{
  const fs::path path(pattern);
  if (!has_number_mark(pattern))
  {
    return pattern;
  }
  const Pattern p = parse(path.filename().string());
  std::string digits = std::to_string(number);
  digits.insert(0, p.digits - std::min(p.digits, digits.size()), '0');
  return (path.parent_path() / (p.before + digits + p.after)).string();
}

std::vector<NumberedFile> numbered_files(const std::string& pattern)
{
  const fs::path path(pattern);
  const Pattern p = parse(path.filename().string());
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  std::error_code error;
  std::vector<NumberedFile> files;
  fs::directory_iterator entry(folder, error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error))
  {
    const std::string name = entry->path().filename().string();
    const std::size_t around = p.before.size() + p.after.size();
    if (name.size() < around + p.digits || name.size() > around + 15 ||
      name.compare(0, p.before.size(), p.before) != 0 ||
      name.compare(name.size() - p.after.size(), p.after.size(), p.after) != 0)
    {
      continue;
    }
    const std::string number = name.substr(p.before.size(), name.size() - around);
    if (std::all_of(number.begin(), number.end(), is_digit))
    {
      files.push_back({ std::stoll(number), (path.parent_path() / name).string() });
    }
    if (files.size() > 1000000)
    {
      fail(pattern, "stands for more than 1,000,000 files", "name fewer");
    }
  }
  if (error)
  {
    fail(pattern, "its folder cannot be read: " + error.message(), "check the path");
  }
  if (files.empty())
  {
    fail(pattern, "no such file, and none with digits in place of the mark", "check the path");
  }
  std::sort(files.begin(), files.end(),
    [](const NumberedFile& a, const NumberedFile& b)
    { return a.number != b.number ? a.number < b.number : a.path < b.path; });
  const auto twins = std::adjacent_find(files.begin(), files.end(),
    [](const NumberedFile& a, const NumberedFile& b) { return a.number == b.number; });
  if (twins != files.end())
  {
    fail(pattern, "two files have the number " + std::to_string(twins->number),
      "move one of them away");
  }
  return files;
}

}
