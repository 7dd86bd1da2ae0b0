#include "hard_case.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <utility>

namespace brume_tests
{

namespace
{

/// All cases of this program that have ended, in their order.
nlohmann::ordered_json& cases()
{
  static nlohmann::ordered_json all = nlohmann::ordered_json::array();
  return all;
}

void write_cases()
{
  const char* folder = std::getenv("BRUME_HARD_CASES");
  if (!folder || !*folder)
  {
    return;
  }
  const std::filesystem::path path =
    std::filesystem::path(folder) / (std::string(program_invocation_short_name) + ".json");
  std::filesystem::create_directories(folder);
  std::ofstream file(path);
  file << cases().dump(2) << '\n';
  EXPECT_TRUE(file.flush().good()) << path << ": cannot be written";
}

/// How near a figure is to what is not allowed; NaN is farthest.
double strain(double value, double bound)
{
  if (std::isnan(value) || std::isnan(bound))
  {
    return INFINITY;
  }
  return bound > 0.0 ? value / bound : (value > 0.0 ? INFINITY : 0.0);
}

}

HardCase::HardCase(std::string group, std::string name, std::string why, std::string promise)
  : Group(std::move(group))
  , Name(std::move(name))
  , Why(std::move(why))
  , Promise(std::move(promise))
{
}

HardCase::~HardCase()
{
  EXPECT_FALSE(this->Figures.empty()) << this->Name << ": nothing was measured";
  for (const auto& other : cases())
  {
    if (other.contains("introduction"))
    {
      continue;
    }
    EXPECT_FALSE(other["group"] == this->Group && other["name"] == this->Name)
      << this->Name << ": two cases of this name";
  }
  nlohmann::ordered_json one = { { "group", this->Group },
    { "name", this->Name },
    { "why", this->Why },
    { "promise", this->Promise },
    { "measured", nlohmann::ordered_json::array() },
    { "by", this->By } };
  for (const Measured& figure : this->Figures)
  {
    // JSON has no NaN and no infinity: null, which the page shows as it is.
    one["measured"].push_back({ { "unit", figure.unit },
      { "value", figure.value },
      { "bound", figure.bound },
      { "counted", figure.counted } });
  }
  for (const Told& other : this->Others)
  {
    nlohmann::ordered_json figures = nlohmann::ordered_json::array();
    for (const Measured& figure : other.figures)
    {
      figures.push_back({ { "unit", figure.unit }, { "value", figure.value } });
    }
    one["others"].push_back(
      { { "by", other.by }, { "told", figures }, { "words", other.words } });
  }
  cases().push_back(std::move(one));
  write_cases();
}

void introduce_group(const std::string& group, const std::string& text)
{
  cases().push_back({ { "group", group }, { "introduction", text } });
  write_cases();
}

void HardCase::ran(const std::string& by)
{
  for (std::size_t at = 0; at < by.size();)
  {
    const std::size_t end = std::min(by.find(", ", at), by.size());
    const std::string one = by.substr(at, end - at);
    if (std::find(this->By.begin(), this->By.end(), one) == this->By.end())
    {
      this->By.push_back(one);
    }
    at = end + 2;
  }
}

HardCase& HardCase::measure(double value,
  double bound,
  const std::string& unit,
  const std::string& by)
{
  EXPECT_LE(value, bound) << this->Name << ": " << unit << ", " << by;
  EXPECT_GE(value, 0.0) << this->Name << ": " << unit << ", " << by;
  this->ran(by);
  for (Measured& known : this->Figures)
  {
    if (!known.counted && known.unit == unit)
    {
      if (strain(value, bound) >= strain(known.value, known.bound))
      {
        known.value = value;
        known.bound = bound;
      }
      return *this;
    }
  }
  this->Figures.push_back({ unit, value, bound, false });
  return *this;
}

HardCase& HardCase::holds(bool held, const std::string& what, const std::string& by)
{
  return this->holds(held ? 1 : 0, 1, what, by);
}

HardCase& HardCase::holds(int held, int tried, const std::string& what, const std::string& by)
{
  EXPECT_EQ(held, tried) << this->Name << ": " << what << ", " << by;
  this->ran(by);
  for (Measured& known : this->Figures)
  {
    if (known.counted && known.unit == what)
    {
      known.value += held;
      known.bound += tried;
      return *this;
    }
  }
  this->Figures.push_back({ what, double(held), double(tried), true });
  return *this;
}

HardCase& HardCase::refuses(const std::string& message,
  const std::string& part,
  const std::string& by)
{
  const bool named = !message.empty() && message.find(part) != std::string::npos;
  EXPECT_TRUE(named) << this->Name << ", " << by << ": \"" << message << "\" does not name \""
                     << part << '"';
  return this->holds(named, "refused, with the reason", by);
}

HardCase::Told& HardCase::told_by(const std::string& by)
{
  for (Told& known : this->Others)
  {
    if (known.by == by)
    {
      return known;
    }
  }
  this->Others.push_back({ by, {}, {} });
  return this->Others.back();
}

HardCase& HardCase::tell(double value, const std::string& unit, const std::string& by)
{
  for (Measured& known : this->told_by(by).figures)
  {
    if (known.unit == unit)
    {
      known.value = value <= known.value ? known.value : value; // a NaN wins
      return *this;
    }
  }
  this->told_by(by).figures.push_back({ unit, value, 0.0, false });
  return *this;
}

HardCase& HardCase::tell(const std::string& words, const std::string& by)
{
  this->told_by(by).words = words;
  return *this;
}

}
