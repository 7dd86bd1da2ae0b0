#include "scene_keys.h"

#include "command.h"
#include "option_checks.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>

namespace brume::app
{

namespace
{

using nlohmann::json;
using nlohmann::ordered_json;

/// The words after a validator's "name:", and whether it has that name.
bool named(const std::string& text, const std::string& name, std::vector<std::string>& words)
{
  if (text.compare(0, name.size() + 1, name + ":") != 0)
  {
    return false;
  }
  std::istringstream in(text.substr(name.size() + 1));
  for (std::string word; std::getline(in, word, ',');)
  {
    words.push_back(word);
  }
  return true;
}

/// Names of the option's checks.
std::vector<std::string> checks_of(CLI::Option& option)
{
  std::vector<std::string> names;
  try
  {
    for (int i = 0;; ++i)
    {
      names.push_back(option.get_validator(i)->get_name());
    }
  }
  catch (const CLI::OptionNotFound&) // the end
  {
  }
  return names;
}

/// A number as the options read it: whole ones without a fraction.
std::string number_text(const json& value)
{
  const double number = value.get<double>();
  if (number == std::floor(number) && std::abs(number) < 9e15)
  {
    return std::to_string(static_cast<long long>(number));
  }
  return value.dump();
}

[[noreturn]] void refuse(const std::string& place, const json& value, const std::string& expected)
{
  std::string found = value.dump();
  if (found.size() > 60)
  {
    found = found.substr(0, 60) + "…";
  }
  throw Failure(place, found + " is not " + expected, "see docs/user/scene-files.md", BadCall);
}

/// Numbers with commas between.
std::string row_text(const json& list, const SceneKey& key, const std::string& place,
  const std::string& expected)
{
  const auto allowed = [&](std::size_t count)
  {
    return key.counts.empty() ||
      std::find(key.counts.begin(), key.counts.end(), int(count)) != key.counts.end();
  };
  if (list.is_number() && allowed(1))
  {
    return number_text(list);
  }
  if (!list.is_array() || list.empty() || !allowed(list.size()))
  {
    refuse(place, list, expected);
  }
  std::string text;
  for (std::size_t i = 0; i < list.size(); ++i)
  {
    if (!list[i].is_number())
    {
      refuse(place + "/" + std::to_string(i), list[i], "a number");
    }
    text += (i ? "," : "") + number_text(list[i]);
  }
  return text;
}

std::string path_text(const json& value, const std::string& place, const std::string& folder)
{
  if (!value.is_string())
  {
    refuse(place, value, "the name of a file");
  }
  const std::filesystem::path path = value.get<std::string>();
  return path.empty() || path.is_absolute() ? path.string()
                                            : (std::filesystem::path(folder) / path).string();
}

/// The value, or each element of a list of values.
template <class Text>
std::vector<std::string> one_or_more(const json& value, const std::string& place, const Text& text)
{
  if (!value.is_array())
  {
    return { text(value, place) };
  }
  std::vector<std::string> words;
  for (std::size_t i = 0; i < value.size(); ++i)
  {
    words.push_back(text(value[i], place + "/" + std::to_string(i)));
  }
  return words;
}

std::string count_text(const std::vector<int>& counts)
{
  std::string text;
  for (int count : counts)
  {
    text += (text.empty() ? "" : " or ") + std::to_string(count);
  }
  return text + (text.empty() ? "numbers" : " numbers");
}

ordered_json list_of(const ordered_json& items, const std::vector<int>& counts)
{
  ordered_json schema{ { "type", "array" }, { "items", items } };
  schema["minItems"] = counts.empty() ? 1 : counts.front();
  if (!counts.empty())
  {
    schema["maxItems"] = counts.back();
  }
  return schema;
}

ordered_json any_of(const ordered_json& first, const ordered_json& second)
{
  return { { "anyOf", ordered_json::array({ first, second }) } };
}

}

SceneKey key_of(CLI::Option& option)
{
  SceneKey key;
  key.option = &option;
  key.name = option.get_single_name();
  std::transform(key.name.begin(), key.name.end(), key.name.begin(),
    [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const bool many = option.get_expected_max() > 1;
  const std::string type = option.get_type_name();
  std::vector<std::string> words;
  if (option.get_expected_min() == 0) // takes no value
  {
    key.kind = KeyKind::Flag;
    return key;
  }
  for (const std::string& check : checks_of(option))
  {
    if (check == "number")
    {
      const int count = option.get_type_size();
      key.kind = many || count > 1 ? KeyKind::Numbers : KeyKind::Number;
      key.counts = many ? std::vector<int>{} : std::vector<int>{ count };
      return key;
    }
    if (named(check, "numbers", words))
    {
      key.kind = many ? KeyKind::Rows : KeyKind::Numbers;
      for (const std::string& word : words)
      {
        key.counts.push_back(std::stoi(word));
      }
      return key;
    }
    if (named(check, "word", key.words))
    {
      key.kind = KeyKind::Word;
      return key;
    }
    if (named(check, "switch", key.words))
    {
      key.kind = KeyKind::Switches;
      return key;
    }
  }
  key.kind = option.get_positional() ? KeyKind::Input
    : type == "FILE"                 ? (many ? KeyKind::Files : KeyKind::File)
    : many                           ? KeyKind::Texts
                                     : KeyKind::Text;
  return key;
}

std::string expected_of(const SceneKey& key)
{
  const bool single = std::find(key.counts.begin(), key.counts.end(), 1) != key.counts.end();
  switch (key.kind)
  {
    case KeyKind::Flag:
      return "true or false";
    case KeyKind::Number:
      return "a number";
    case KeyKind::Numbers:
      return key.counts == std::vector<int>{ 1, 3 } ? "a number or a list of 3"
        : single                                    ? "a list of " + count_text(key.counts)
        : key.counts.empty()                        ? "a number or a list of numbers"
                                                    : "a list of " + count_text(key.counts);
    case KeyKind::Rows:
      return "a list of lists of " + count_text(key.counts);
    case KeyKind::Word:
      return "one of " + listed(key.words);
    case KeyKind::Text:
      return "a text";
    case KeyKind::Texts:
      return "a text or a list of texts";
    case KeyKind::File:
      return "the name of a file";
    case KeyKind::Files:
      return "the name of a file, or a list of names";
    case KeyKind::Input:
      return "the name of a file or of a sample";
    case KeyKind::Switches:
      return "an object of true and false";
  }
  return {};
}

std::vector<std::string> words_of(const SceneKey& key, const json& value, const std::string& place,
  const std::string& folder)
{
  const std::string expected = expected_of(key);
  const auto text = [&](const json& v, const std::string& at)
  {
    if (!v.is_string())
    {
      refuse(at, v, key.kind == KeyKind::Word ? expected : "a text");
    }
    return v.get<std::string>();
  };
  switch (key.kind)
  {
    case KeyKind::Flag:
      if (!value.is_boolean())
      {
        refuse(place, value, expected);
      }
      return value.get<bool>() ? std::vector<std::string>{ "true" } : std::vector<std::string>{};
    case KeyKind::Number:
      if (!value.is_number())
      {
        refuse(place, value, expected);
      }
      return { number_text(value) };
    case KeyKind::Numbers:
      return { row_text(value, key, place, expected) };
    case KeyKind::Rows:
      if (!value.is_array())
      {
        refuse(place, value, expected);
      }
      return one_or_more(value, place,
        [&](const json& v, const std::string& at)
        { return row_text(v, key, at, "a list of " + count_text(key.counts)); });
    case KeyKind::Word:
    case KeyKind::Text:
      return { text(value, place) };
    case KeyKind::Texts:
      return one_or_more(value, place, text);
    case KeyKind::File:
      return { path_text(value, place, folder) };
    case KeyKind::Files:
      return one_or_more(value, place,
        [&](const json& v, const std::string& at) { return path_text(v, at, folder); });
    case KeyKind::Input:
      return { value.is_string() && value.get<std::string>().rfind("sample:", 0) == 0
          ? value.get<std::string>()
          : path_text(value, place, folder) };
    case KeyKind::Switches:
    {
      if (!value.is_object())
      {
        refuse(place, value, expected);
      }
      std::vector<std::string> words;
      for (const auto& [name, on] : value.items())
      {
        if (!on.is_boolean())
        {
          refuse(place + "/" + name, on, "true or false");
        }
        words.push_back(name + (on.get<bool>() ? "=on" : "=off"));
      }
      return words;
    }
  }
  return {};
}

ordered_json value_of(const SceneKey& key)
{
  const std::vector<std::string> words = key.option->results();
  const auto numbers_of = [](const std::vector<std::string>& texts)
  {
    ordered_json list = ordered_json::array();
    for (const std::string& text : texts)
    {
      for (const double number : split_numbers(text))
      {
        list.push_back(number);
      }
    }
    return list;
  };
  const auto absolute = [](const std::string& path)
  { return path.empty() ? path : std::filesystem::absolute(path).lexically_normal().string(); };
  switch (key.kind)
  {
    case KeyKind::Flag:
      return true;
    case KeyKind::Number:
      return numbers_of(words).at(0);
    case KeyKind::Numbers:
    {
      const ordered_json list = numbers_of(words);
      return list.size() == 1 ? list.at(0) : list;
    }
    case KeyKind::Rows:
    {
      ordered_json rows = ordered_json::array();
      for (const std::string& word : words)
      {
        rows.push_back(numbers_of({ word }));
      }
      return rows;
    }
    case KeyKind::Word:
    case KeyKind::Text:
      return words.back();
    case KeyKind::Input:
      return words.back().rfind("sample:", 0) == 0 ? words.back() : absolute(words.back());
    case KeyKind::File:
      return absolute(words.back());
    case KeyKind::Texts:
      return words;
    case KeyKind::Files:
    {
      ordered_json paths = ordered_json::array();
      for (const std::string& word : words)
      {
        paths.push_back(absolute(word));
      }
      return paths;
    }
    case KeyKind::Switches:
    {
      ordered_json switches = ordered_json::object();
      for (const std::string& word : words)
      {
        const std::size_t at = word.rfind('=');
        switches[word.substr(0, at)] = word.substr(at) == "=on";
      }
      return switches;
    }
  }
  return {};
}

ordered_json schema_of(const SceneKey& key)
{
  const ordered_json number{ { "type", "number" } };
  const ordered_json string{ { "type", "string" } };
  ordered_json schema;
  switch (key.kind)
  {
    case KeyKind::Flag:
      schema = { { "type", "boolean" } };
      break;
    case KeyKind::Number:
      schema = number;
      break;
    case KeyKind::Numbers:
    {
      std::vector<int> counts = key.counts;
      const bool single = counts.empty() || counts.front() == 1;
      if (counts.size() > 1 && single)
      {
        counts.erase(counts.begin());
      }
      schema = single ? any_of(number, list_of(number, counts)) : list_of(number, counts);
      break;
    }
    case KeyKind::Rows:
      schema = list_of(list_of(number, key.counts), {});
      break;
    case KeyKind::Word:
      schema = { { "enum", key.words } };
      break;
    case KeyKind::Text:
    case KeyKind::File:
    case KeyKind::Input:
      schema = string;
      break;
    case KeyKind::Texts:
    case KeyKind::Files:
      schema = any_of(string, list_of(string, {}));
      break;
    case KeyKind::Switches:
    {
      ordered_json properties = ordered_json::object();
      for (const std::string& word : key.words)
      {
        properties[word] = { { "type", "boolean" } };
      }
      schema = { { "type", "object" }, { "properties", properties },
        { "additionalProperties", false } };
      break;
    }
  }
  schema["description"] = key.option->get_description();
  return schema;
}

}
