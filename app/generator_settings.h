// Options of a kind that are settings of its source: what the user gives goes to the source, and
// the source's own default stands where nothing is given.
#pragma once

#include "option_checks.h"

#include <CLI/CLI.hpp>

#include <cstdio>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace brume::app
{

/// The options of one kind; copies share what the user gave.
template <class Source>
class GeneratorSettings
{
public:
  /// An option of one number. `description` is told with the default, `standard`, in brackets;
  /// `what` completes "'X' is not …".
  void add(CLI::App& command,
    const std::string& name,
    const std::string& description,
    double standard,
    const char* unit,
    const std::string& what,
    bool (*good)(double),
    std::function<void(Source*, double)> set)
  {
    auto value = std::make_shared<std::optional<double>>();
    char text[32];
    std::snprintf(text, sizeof(text), " [%g]", standard);
    command.add_option(name, *value, description + text)
      ->check(number(what, good))
      ->type_name(unit);
    m_setters.push_back(
      [value, set](Source* source)
      {
        if (*value)
        {
          set(source, **value);
        }
      });
  }

  /// An option of three numbers.
  void add_vector(CLI::App& command,
    const std::string& name,
    const std::string& description,
    const std::string& what,
    std::function<void(Source*, const double*)> set)
  {
    auto value = std::make_shared<std::string>();
    command.add_option(name, *value, description)
      ->check(numbers(what, { 3 }, [](double v) { return v >= -1e6 && v <= 1e6; }))
      ->type_name("X,Y,Z");
    m_setters.push_back(
      [value, set](Source* source)
      {
        if (!value->empty())
        {
          set(source, split_numbers(*value).data());
        }
      });
  }

  void apply(Source* source) const
  {
    for (const auto& setter : m_setters)
    {
      setter(source);
    }
  }

private:
  std::vector<std::function<void(Source*)>> m_setters;
};

// What options ask for, in the same words everywhere.
inline bool any_height(double v)
{
  return v >= -1e6 && v <= 1e6;
}
inline bool positive_length(double v)
{
  return v >= 0.1 && v <= 1e6;
}
inline bool fraction(double v)
{
  return v >= 0.0 && v <= 1.0;
}
inline bool one_to_eight(double v)
{
  return v >= 1.0 && v <= 8.0 && v == static_cast<int>(v);
}

}
