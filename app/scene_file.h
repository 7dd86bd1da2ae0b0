// Scene files: the options of a scene, and lists that a command line is clumsy for, as JSON.
// docs/user/scene-files.md is for users, docs/user/scene.schema.json for editors.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <memory>
#include <string>

namespace CLI
{
class App;
}

namespace brume::app
{

struct DisplayOptions;
struct SceneOptions;

/// Declares --scene FILE on a subcommand, whose options so far are the keys that a file may hold;
/// to be called after the scene options and before those of the subcommand alone. What the file says is
/// given to the options as though the command line had said it, where the command line says nothing;
/// the lists ("lights", "lobes", "colour", "opacity") go to `options`, which must outlive the parse. An option of the command line
/// also silences those of the file that it excludes.
///
/// The parse throws Failure (BadCall), "FILE: /KEY: what is wrong: what to do" (the place as a JSON
/// pointer), for what the file may not say, and Failed for a file that cannot be read.
void add_scene_file(CLI::App& command, SceneOptions& options);

/// The JSON schema of scene files, with the options' own descriptions: what
/// docs/user/scene.schema.json holds.
nlohmann::ordered_json scene_schema();

/// What a subcommand with scene options was told, by its command line and its scene file, as a scene
/// file of its own; names of files are absolute. To be called after the parse, with the options that it
/// filled. Without "quiet" and
/// "verbose", which are no part of a scene.
nlohmann::ordered_json scene_of(CLI::App& command, const SceneOptions& options);

/// A scene file with absolute names of files, checked. Throws Failure as the parse of --scene does.
nlohmann::ordered_json read_scene(const std::string& path);

/// Takes out of a scene file's object what needs keys that are not there ("silver-lining-spread" without
/// "silver-lining"), which --scene would refuse.
void drop_orphans(nlohmann::ordered_json& scene);

/// The options that a scene file's object stands for; copies share them.
class ParsedScene
{
public:
  /// `place` stands before the JSON pointer in messages; relative names of files are taken from the
  /// current folder. Throws Failure as the parse of --scene does, and for options that do not fit
  /// together.
  explicit ParsedScene(const nlohmann::ordered_json& scene, const std::string& place = "scene");

  const SceneOptions& options() const;
  const DisplayOptions& display() const;

private:
  struct Internals;
  std::shared_ptr<Internals> Internal;
};

}
