#include "option_checks.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace brume::app
{

namespace
{

/// A whole text as a finite number; false where it is none.
bool read_number(const std::string& text, double& value)
{
  char* end = nullptr;
  value = std::strtod(text.c_str(), &end);
  return end != text.c_str() && *end == '\0' && std::isfinite(value);
}

/// How many letters must be put in, left out, exchanged or swapped with their neighbour to make one
/// word of the other.
std::size_t edits(const std::string& a, const std::string& b)
{
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i)
  {
    for (std::size_t j = 0; j <= b.size(); ++j)
    {
      if (i == 0 || j == 0)
      {
        d[i][j] = i + j;
        continue;
      }
      d[i][j] = std::min({ d[i - 1][j] + 1, d[i][j - 1] + 1,
        d[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1) });
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
      {
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
      }
    }
  }
  return d[a.size()][b.size()];
}

}

// A description would appear in --help beside the option's name, so there is none.

CLI::Validator number(const std::string& what, bool (*good)(double))
{
  return CLI::Validator(
    [what, good](std::string& text) -> std::string
    {
      double value = 0.0;
      if (!read_number(text, value) || !good(value))
      {
        return "'" + text + "' is not " + what;
      }
      return {};
    },
    "", "number");
}

CLI::Validator one_of(const std::vector<std::string>& words)
{
  return CLI::Validator(
    [words](std::string& text) -> std::string
    {
      if (std::find(words.begin(), words.end(), text) != words.end())
      {
        return {};
      }
      return "'" + text + "' is not one of " + listed(words);
    },
    "", "word:" + listed(words, ","));
}

CLI::Validator numbers(const std::string& what, std::initializer_list<int> counts, bool (*good)(double))
{
  const std::vector<int> allowed(counts);
  std::string name;
  for (int count : allowed)
  {
    name += (name.empty() ? "numbers:" : ",") + std::to_string(count);
  }
  return CLI::Validator(
    [what, good, allowed](std::string& text) -> std::string
    {
      const std::vector<double> values = split_numbers(text);
      const bool count = std::find(allowed.begin(), allowed.end(), int(values.size())) != allowed.end();
      if (!count || !std::all_of(values.begin(), values.end(), good))
      {
        return "'" + text + "' is not " + what;
      }
      return {};
    },
    "", name);
}

CLI::Validator switch_of(const std::vector<std::string>& names)
{
  return CLI::Validator(
    [names](std::string& text) -> std::string
    {
      const std::size_t equal = text.find('=');
      const std::string name = text.substr(0, equal);
      const std::string state = equal == std::string::npos ? "" : text.substr(equal + 1);
      if (std::find(names.begin(), names.end(), name) == names.end())
      {
        return "'" + name + "' is not one of " + listed(names);
      }
      return state == "on" || state == "off" ? std::string()
                                             : "'" + text + "' is neither " + name + "=on nor " +
            name + "=off";
    },
    "", "switch:" + listed(names, ","));
}

std::vector<double> split_numbers(const std::string& text)
{
  std::vector<double> values;
  for (std::size_t begin = 0; begin <= text.size();)
  {
    const std::size_t comma = std::min(text.find(',', begin), text.size());
    double value = 0.0;
    if (!read_number(text.substr(begin, comma - begin), value))
    {
      return {};
    }
    values.push_back(value);
    begin = comma + 1;
  }
  return values;
}

std::array<double, 3> three_of(const std::vector<double>& v)
{
  return v.size() == 3 ? std::array<double, 3>{ v[0], v[1], v[2] }
                       : std::array<double, 3>{ v.at(0), v.at(0), v.at(0) };
}

std::string nearest_name(const std::string& name, const std::vector<std::string>& names)
{
  std::string nearest;
  std::size_t least = std::min<std::size_t>(name.size() / 3 + 1, 4) + 1;
  for (const std::string& other : names)
  {
    const std::size_t count = name.size() < 64 ? edits(name, other) : least;
    if (count < least)
    {
      least = count;
      nearest = other;
    }
  }
  const std::size_t dashes = std::min(name.find_first_not_of('-'), name.size());
  if (nearest.empty() && name.size() - dashes >= 3)
  {
    const auto longer = std::find_if(names.begin(), names.end(),
      [&](const std::string& other) { return other.compare(0, name.size(), name) == 0; });
    nearest = longer == names.end() ? "" : *longer;
  }
  return nearest;
}

std::string listed(const std::vector<std::string>& words, const char* separator)
{
  std::string list;
  for (const std::string& word : words)
  {
    list += (list.empty() ? "" : separator) + word;
  }
  return list;
}

}
