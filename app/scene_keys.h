// What the keys of a scene file hold: found from the options of the command line.
#pragma once

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace CLI
{
class App;
class Option;
}

namespace brume::app
{

/// What the value of a key looks like in JSON.
enum class KeyKind
{
  Flag,     ///< true or false
  Number,   ///< a number
  Numbers,  ///< a list of numbers, of one of `counts` (any where that is empty); where 1 is one of
            ///< them, a number too
  Rows,     ///< a list of such lists
  Word,     ///< one of `words`
  Text,     ///< any text
  Texts,    ///< a text, or a list of texts
  File,     ///< a path, relative to the scene file
  Files,    ///< a path, or a list of paths
  Input,    ///< a path or "sample:NAME"
  Switches, ///< an object of true and false, its keys among `words`
};

/// A key of scene files that is an option, too.
struct SceneKey
{
  std::string name;
  CLI::Option* option = nullptr;
  KeyKind kind = KeyKind::Text;
  std::vector<int> counts;
  std::vector<std::string> words;
};

/// The option's key: its name without dashes, in small letters.
SceneKey key_of(CLI::Option& option);

/// What a value of this kind must be, as a noun: "a list of 3 numbers".
std::string expected_of(const SceneKey& key);

/// The value as the words of the command line. Throws Failure (BadCall) with `place` (the file and
/// the JSON pointer of the value) where it is of another kind; relative paths are taken from
/// `folder`.
std::vector<std::string> words_of(const SceneKey& key, const nlohmann::json& value,
  const std::string& place, const std::string& folder);

/// What the key's option was told, as words_of() takes it; names of files are absolute. To be called for
/// an option that was told something.
nlohmann::ordered_json value_of(const SceneKey& key);

/// The key's part of the JSON schema.
nlohmann::ordered_json schema_of(const SceneKey& key);

}
