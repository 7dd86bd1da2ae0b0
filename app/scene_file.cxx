#include "scene_file.h"

#include "command.h"
#include "display_options.h"
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
#include <utility>

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

constexpr const char* display_keys[] = { "--exposure", "--display-curve" };
constexpr const char* list_keys[] = { "lights", "lobes", "colour", "opacity" };

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
  SceneKeys(CLI::App& command, SceneOptions& options)
    : Command(command)
    , Options(options)
  {
    add_display_options(this->Shown, this->Display);
    for (CLI::Option* option : command.get_options())
    {
      if (option != command.get_help_ptr() && option->get_name() != "--scene")
      {
        this->Keys.push_back(key_of(*option));
      }
    }
  }

  void read(const std::string& path)
  {
    this->read(read_object(path), path, std::filesystem::path(path).parent_path().string());
  }

  /// `path` is for messages; relative names of files are taken from `folder`.
  void read(const json& object, const std::string& path, const std::string& folder)
  {
    this->add_display_keys();
    for (const auto& [name, value] : object.items())
    {
      this->check_name(path, name);
    }
    this->check_exclusions(path, object);
    // What the command line classifies by takes the place of the file's transfer functions.
    const bool classified = !this->is_told("extinction") && !this->is_told("preset");
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
    this->read_lists(path, object, classified);
  }

  /// What the options were told, by the command line and the file.
  ordered_json told()
  {
    this->add_display_keys();
    ordered_json scene;
    for (const SceneKey& key : this->Keys)
    {
      if (key.option->count() > 0)
      {
        scene[key.name] = value_of(key);
      }
    }
    return scene;
  }

  ordered_json schema()
  {
    this->add_display_keys();
    ordered_json properties;
    properties["$schema"] = { { "type", "string" },
      { "description", "For editors: where this schema is" } };
    for (const SceneKey& key : this->Keys)
    {
      properties[key.name] = schema_of(key);
    }
    properties["lights"] = lights_schema();
    properties["lobes"] = lobes_schema();
    properties["colour"] = colour_schema();
    properties["opacity"] = opacity_schema();
    ordered_json schema;
    schema["$schema"] = "https://json-schema.org/draft/2020-12/schema";
    schema["title"] = "A scene of Brume";
    schema["description"] = "What brume render, compare and plan take with --scene FILE: the options "
                            "of the command line without their dashes, and lists of lights, lobes and "
                            "transfer functions. The command line wins. Defaults stand in brackets.";
    schema["type"] = "object";
    schema["properties"] = properties;
    schema["additionalProperties"] = false;
    return schema;
  }

private:
  /// How pictures of 8 bits show light is a key for all: where the subcommand makes none, it is checked
  /// and means nothing.
  void add_display_keys()
  {
    if (std::exchange(this->HasDisplayKeys, true))
    {
      return;
    }
    for (const char* name : display_keys)
    {
      CLI::Option* own = this->Command.get_option_no_throw(name);
      this->Keys.push_back(key_of(own ? *own : *this->Shown.get_option(name)));
    }
  }

  std::vector<std::string> names() const
  {
    std::vector<std::string> names(std::begin(list_keys), std::end(list_keys));
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
    static const std::pair<const char*, const char*> lists[] = { { "lobes", "phase" },
      { "lobes", "anisotropy" }, { "colour", "extinction" }, { "opacity", "extinction" } };
    for (const auto& [list, name] : lists)
    {
      if (object.contains(list) && object.contains(name))
      {
        refuse(list, name);
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

  void read_lists(const std::string& path, const json& object, bool classified)
  {
    MediumOptions& medium = this->Options.medium;
    if (object.contains("lights"))
    {
      medium.lights = read_lights(object["lights"], path + ": /lights");
    }
    if (object.contains("lobes"))
    {
      const std::vector<LobeChoice> lobes = read_lobes(object["lobes"], path + ": /lobes");
      if (!this->is_told("anisotropy") && !this->is_told("phase"))
      {
        medium.lobes = lobes;
      }
    }
    if (object.contains("colour"))
    {
      const auto colour = read_colour(object["colour"], path + ": /colour");
      this->Options.colour = classified ? colour : decltype(colour){};
    }
    if (object.contains("opacity"))
    {
      const auto opacity = read_opacity(object["opacity"], path + ": /opacity");
      this->Options.opacity = classified ? opacity : decltype(opacity){};
    }
  }

  bool is_told(const std::string& name) const
  {
    return std::any_of(this->Keys.begin(), this->Keys.end(),
      [&](const SceneKey& key) { return key.name == name && key.option->count() > 0; });
  }

  CLI::App& Command;
  SceneOptions& Options;
  std::vector<SceneKey> Keys;
  bool HasDisplayKeys = false;
  CLI::App Shown;         ///< for subcommands without options of display
  DisplayOptions Display; ///< of Shown
};

}

void add_scene_file(CLI::App& command, SceneOptions& options)
{
  const auto keys = std::make_shared<SceneKeys>(command, options);
  command
    .add_option_function<std::string>(
      "--scene", [keys](const std::string& path) { keys->read(path); },
      "Read options from a JSON file, too: their names without dashes, and lists of lights, lobes and "
      "transfer functions; what the command line says wins")
    ->type_name("FILE.json");
}

ordered_json scene_schema()
{
  CLI::App command;
  SceneOptions options;
  add_scene_options(command, options, "preset");
  return SceneKeys(command, options).schema();
}

ordered_json scene_of(CLI::App& command, const SceneOptions& options)
{
  // The subcommand's own options are no part of a scene.
  CLI::App keys;
  SceneOptions unused;
  DisplayOptions unused_too;
  add_scene_options(keys, unused, "preset");
  add_display_options(keys, unused_too);
  const ordered_json told = SceneKeys(command, unused).told();
  ordered_json scene;
  for (const auto& [name, value] : told.items())
  {
    if (name == "input" || keys.get_option_no_throw("--" + name))
    {
      scene[name] = value;
    }
  }
  const CLI::Option* const file = command.get_option_no_throw("--scene");
  if (file && file->count() > 0)
  {
    const json object = read_object(file->results().back());
    for (const char* name : list_keys)
    {
      // What the command line took the place of is empty.
      const std::string list = name;
      const bool silenced = list == "lobes" ? options.medium.lobes.empty()
        : list == "colour"                  ? options.colour.empty()
        : list == "opacity"                 ? options.opacity.empty()
                                            : false;
      if (object.contains(name) && !silenced)
      {
        scene[name] = object[name];
      }
    }
  }
  for (const char* name : { "quiet", "verbose" })
  {
    scene.erase(name);
  }
  return scene;
}

ordered_json read_scene(const std::string& path)
{
  const std::string folder = std::filesystem::absolute(path).parent_path().string();
  const ordered_json object = read_object(path);
  CLI::App command;
  SceneOptions options;
  add_scene_options(command, options, "preset");
  SceneKeys keys(command, options);
  keys.read(object, path, folder);
  ordered_json scene = keys.told();
  for (const char* name : list_keys)
  {
    if (object.contains(name))
    {
      scene[name] = object[name];
    }
  }
  return scene;
}

void drop_orphans(ordered_json& scene)
{
  CLI::App command;
  SceneOptions options;
  add_scene_options(command, options, "preset");
  for (const CLI::Option* option : command.get_options())
  {
    const std::string name = option->get_single_name();
    const auto& needed = option->get_needs();
    const bool orphan = std::any_of(needed.begin(), needed.end(),
      [&](const CLI::Option* other) { return !scene.contains(other->get_single_name()); });
    if (orphan)
    {
      scene.erase(name);
    }
  }
}

struct ParsedScene::Internals
{
  CLI::App Command;
  SceneOptions Options;
  DisplayOptions Display;
};

ParsedScene::ParsedScene(const ordered_json& scene, const std::string& place)
  : Internal(std::make_shared<Internals>())
{
  Internals& in = *this->Internal;
  add_scene_options(in.Command, in.Options, "preset");
  add_display_options(in.Command, in.Display);
  SceneKeys(in.Command, in.Options).read(scene, place, {});
  check(in.Options);
}

const SceneOptions& ParsedScene::options() const
{
  return this->Internal->Options;
}

const DisplayOptions& ParsedScene::display() const
{
  return this->Internal->Display;
}

}
