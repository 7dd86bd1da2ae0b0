#include "phase_words.h"

#include "option_checks.h"

#include <algorithm>
#include <sstream>

namespace brume::app
{

const std::vector<std::pair<const char*, LobeChoice::Function>>& lobe_functions()
{
  static const std::vector<std::pair<const char*, LobeChoice::Function>> names{
    { "isotropic", LobeChoice::Function::Isotropic },
    { "rayleigh", LobeChoice::Function::Rayleigh },
    { "hg", LobeChoice::Function::HenyeyGreenstein },
    { "henyey-greenstein", LobeChoice::Function::HenyeyGreenstein },
    { "schlick", LobeChoice::Function::Schlick },
  };
  return names;
}

namespace
{

/// One lobe; what is wrong with it, or an empty text.
std::string read_lobe(const std::string& text, LobeChoice& lobe)
{
  std::vector<std::string> parts;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, ':');)
  {
    parts.push_back(part);
  }
  const auto& known = lobe_functions();
  const auto function = std::find_if(known.begin(), known.end(),
    [&](const auto& entry) { return !parts.empty() && parts[0] == entry.first; });
  if (function == known.end())
  {
    return "'" + (parts.empty() ? text : parts[0]) + "' is not one of isotropic, rayleigh, hg, schlick";
  }
  lobe.function = function->second;
  const bool has_g = lobe.function == LobeChoice::Function::HenyeyGreenstein ||
    lobe.function == LobeChoice::Function::Schlick;
  std::vector<double> values;
  for (std::size_t i = 1; i < parts.size(); ++i)
  {
    const std::vector<double> value = split_numbers(parts[i]);
    if (value.size() != 1)
    {
      return "'" + parts[i] + "' in '" + text + "' is not a number";
    }
    values.push_back(value[0]);
  }
  if (text.empty() || text.back() == ':' || values.size() > (has_g ? 2 : 1) ||
    (has_g && values.empty()))
  {
    return "'" + text + "' is not " + parts[0] + (has_g ? ":G or " + parts[0] + ":G:WEIGHT"
                                                       : " or " + parts[0] + ":WEIGHT");
  }
  if (has_g)
  {
    lobe.anisotropy = values[0];
    values.erase(values.begin());
    if (!(lobe.anisotropy > -1.0 && lobe.anisotropy < 1.0))
    {
      return "G in '" + text + "' is not between -1 and 1";
    }
  }
  lobe.weight = values.empty() ? 1.0 : values[0];
  return lobe.weight > 0.0 ? std::string() : "the weight in '" + text + "' is not greater than 0";
}

}

std::vector<LobeChoice> read_lobes(const std::string& text, std::string& wrong)
{
  std::vector<LobeChoice> lobes;
  for (std::size_t begin = 0; begin <= text.size();)
  {
    const std::size_t comma = std::min(text.find(',', begin), text.size());
    LobeChoice lobe;
    wrong = read_lobe(text.substr(begin, comma - begin), lobe);
    if (!wrong.empty())
    {
      return {};
    }
    lobes.push_back(lobe);
    begin = comma + 1;
  }
  return lobes;
}

CLI::Validator phase_words()
{
  return CLI::Validator(
    [](std::string& text) -> std::string
    {
      std::string wrong;
      read_lobes(text, wrong);
      return wrong;
    },
    "", "phase");
}

CLI::Validator irradiance_of_point()
{
  return CLI::Validator(
    [](std::string& text) -> std::string
    {
      const std::vector<double> v = split_numbers(text);
      return v.size() == 6 && !(v[3] >= 0.0 && v[4] >= 0.0 && v[5] >= 0.0)
        ? "the irradiance in '" + text + "' is not 0 or more"
        : std::string();
    },
    "", "irradiance");
}

}
