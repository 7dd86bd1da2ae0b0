#include "option_checks.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace brume::app
{

// A description would appear in --help beside the option's name, so there is none.

CLI::Validator number(const std::string& what, bool (*good)(double))
{
  return CLI::Validator(
    [what, good](std::string& text) -> std::string
    {
      char* end = nullptr;
      const double value = std::strtod(text.c_str(), &end);
      if (end == text.c_str() || *end != '\0' || !std::isfinite(value) || !good(value))
      {
        return "'" + text + "' is not " + what;
      }
      return {};
    },
    "");
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
      std::string list;
      for (const std::string& word : words)
      {
        list += (list.empty() ? "" : ", ") + word;
      }
      return "'" + text + "' is not one of " + list;
    },
    "");
}

}
