#include "scene_file.h"

#include "command.h"
#include "medium_options.h"
#include "option_checks.h"
#include "scene_keys.h"
#include "scene_lists.h"
#include "scene_options.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <set>
#include <sstream>

namespace brume::app
{

namespace
{

using nlohmann::json;
using nlohmann::ordered_json;

constexpr std::size_t most_bytes = 16u << 20;

std::string read_text(const std::string& path)
{
  std::error_code error;
  if (std::filesystem::is_directory(path, error))
  {
    throw Failure(path, "it is a folder", "name a scene file");
  }
  std::ifstream file(path, std::ios::binary);
  if (!file)
  {
    throw Failure(path, std::string("it cannot be read (") + std::strerror(errno) + ")",
      "name a scene file");
  }
  std::string text(most_bytes + 1, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(file.gcount()));
  if (file.bad() || text.size() > most_bytes)
  {
    throw Failure(path, "it is no scene file: it cannot be read, or is over 16 MB",
      "name a scene file");
  }
  return text;
}

/// The object in a file; a key that is given twice is refused, as it would silently count once.
json read_object(const std::string& path)
{
  std::vector<std::set<std::string>> seen;
  std::string twice;
  const auto watch = [&](int, json::parse_event_t event, json& value)
  {
    if (event == json::parse_event_t::object_start)
    {
      seen.emplace_back();
    }
    else if (event == json::parse_event_t::object_end)
    {
      seen.pop_back();
    }
    else if (event == json::parse_event_t::key && !seen.back().insert(value).second && twice.empty())
    {
      twice = value.get<std::string>();
    }
    return true;
  };
  json object;
  const std::string text = read_text(path);
  try
  {
    object = json::parse(text, watch);
  }
  catch (const json::exception& error)
  {
    // "[json.exception.parse_error.101] parse error at line 1, column 2: …"
    const std::string what = error.what();
    const std::size_t end = what.find("] ");
    throw Failure(path, end == std::string::npos ? what : what.substr(end + 2), "mend the JSON", BadCall);
  }
  if (!object.is_object())
  {
    throw Failure(path, "it holds no JSON object", "see docs/user/scene-files.md", BadCall);
  }
  if (!twice.empty())
  {
    throw Failure(path, "the key \"" + twice + "\" is given twice", "leave one out", BadCall);
  }
  return object;
}

/// The text of a parse error without the option's name before it.
std::string without_name(const std::string& message, const CLI::Option& option)
{
  const std::string name = option.get_name() + ": ";
  return message.compare(0, name.size(), name) == 0 ? message.substr(name.size()) : message;
}

/// The keys of a subcommand, and how a file fills them.
class SceneKeys
{
public:
  SceneKeys(CLI::App& command, MediumOptions& medium)
    : Medium(medium)
  {
    for (CLI::Option* option : command.get_options())
    {
      if (option != command.get_help_ptr() && option->get_name() != "--scene")
      {
        this->Keys.push_back(key_of(*option));
      }
    }
  }

  void read(const std::string& path) const
  {
    const json object = read_object(path);
    const std::string folder = std::filesystem::path(path).parent_path().string();
    for (const auto& [name, value] : object.items())
    {
      this->check_name(path, name);
    }
    this->check_exclusions(path, object);
    std::vector<const SceneKey*> told; // by the file alone
    for (const SceneKey& key : this->Keys)
    {
      if (object.contains(key.name))
      {
        const std::string place = path + ": /" + key.name;
        const std::vector<std::string> words = words_of(key, object[key.name], place, folder);
        if (!this->silenced(key) && !words.empty())
        {
          key.option->add_result(words);
          told.push_back(&key);
        }
      }
    }
    for (const SceneKey* key : told)
    {
      run(*key, path + ": /" + key->name);
    }
    this->read_lists(path, object);
  }

  ordered_json schema() const
  {
    ordered_json properties;
    properties["$schema"] = { { "type", "string" },
      { "description", "For editors: where this schema is" } };
    for (const SceneKey& key : this->Keys)
    {
      properties[key.name] = schema_of(key);
    }
    properties["lights"] = lights_schema();
    properties["lobes"] = lobes_schema();
    ordered_json schema;
    schema["$schema"] = "https://json-schema.org/draft/2020-12/schema";
    schema["title"] = "A scene of Brume";
    schema["description"] = "What brume render, compare and plan take with --scene FILE: the options "
                            "of the command line without their dashes, and lists of lights and lobes. "
                            "The command line wins. Defaults stand in brackets.";
    schema["type"] = "object";
    schema["properties"] = properties;
    schema["additionalProperties"] = false;
    return schema;
  }

private:
  std::vector<std::string> names() const
  {
    std::vector<std::string> names{ "lights", "lobes" };
    for (const SceneKey& key : this->Keys)
    {
      names.push_back(key.name);
    }
    return names;
  }

  void check_name(const std::string& path, const std::string& name) const
  {
    const std::vector<std::string> known = this->names();
    if (name == "$schema" || std::find(known.begin(), known.end(), name) != known.end())
    {
      return;
    }
    const std::string nearest = nearest_name(name, known);
    throw Failure(path + ": /" + escaped(name), "there is no such key",
      nearest.empty() ? "see docs/user/scene-files.md" : "did you mean \"" + nearest + "\"?", BadCall);
  }

  /// Whether the command line says something of the option, or of one that it excludes.
  static bool silenced(const SceneKey& key)
  {
    for (const CLI::Option* other : key.option->get_excludes())
    {
      if (other->count() > 0)
      {
        return true;
      }
    }
    return key.option->count() > 0;
  }

  void check_exclusions(const std::string& path, const json& object) const
  {
    const auto refuse = [&](const std::string& one, const std::string& other)
    {
      throw Failure(
        path + ": /" + one, "it excludes \"" + other + "\"", "leave one of them out", BadCall);
    };
    for (const SceneKey& key : this->Keys)
    {
      for (const SceneKey& other : this->Keys)
      {
        if (key.option->get_excludes().count(other.option) && object.contains(key.name) &&
          object.contains(other.name) && object[key.name] != false && object[other.name] != false)
        {
          refuse(key.name, other.name);
        }
      }
    }
    for (const char* name : { "phase", "anisotropy" })
    {
      if (object.contains("lobes") && object.contains(name))
      {
        refuse("lobes", name);
      }
    }
  }

  static void run(const SceneKey& key, const std::string& place)
  {
    try
    {
      key.option->run_callback();
    }
    catch (const CLI::ParseError& error)
    {
      throw Failure(place, without_name(error.what(), *key.option), "see docs/user/scene-files.md",
        BadCall);
    }
  }

  void read_lists(const std::string& path, const json& object) const
  {
    if (object.contains("lights"))
    {
      this->Medium.lights = read_lights(object["lights"], path + ": /lights");
    }
    if (object.contains("lobes"))
    {
      const std::vector<LobeChoice> lobes = read_lobes(object["lobes"], path + ": /lobes");
      if (!this->is_told("anisotropy") && !this->is_told("phase"))
      {
        this->Medium.lobes = lobes;
      }
    }
  }

  bool is_told(const std::string& name) const
  {
    return std::any_of(this->Keys.begin(), this->Keys.end(),
      [&](const SceneKey& key) { return key.name == name && key.option->count() > 0; });
  }

  MediumOptions& Medium;
  std::vector<SceneKey> Keys;
};

}

void add_scene_file(CLI::App& command, MediumOptions& options)
{
  const auto keys = std::make_shared<SceneKeys>(command, options);
  command
    .add_option_function<std::string>(
      "--scene", [keys](const std::string& path) { keys->read(path); },
      "Read options from a JSON file, too: their names without dashes, and lists of lights and lobes; "
      "what the command line says wins")
    ->type_name("FILE.json");
}

ordered_json scene_schema()
{
  CLI::App command;
  SceneOptions options;
  add_scene_options(command, options, "preset");
  return SceneKeys(command, options.medium).schema();
}

}
