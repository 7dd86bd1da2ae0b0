// Scene files: the options of a scene, and lists that a command line is clumsy for, as JSON.
// docs/user/scene-files.md is for users, docs/user/scene.schema.json for editors.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace CLI
{
class App;
}

namespace brume::app
{

struct MediumOptions;

/// Declares --scene FILE on a subcommand, whose options so far are the keys that a file may hold;
/// to be called after the scene options and before those of the subcommand alone. What the file says is
/// given to the options as though the command line had said it, where the command line says nothing;
/// "lights" and "lobes" go to `options`, which must outlive the parse. An option of the command line
/// also silences those of the file that it excludes.
///
/// The parse throws Failure (BadCall), "FILE: /KEY: what is wrong: what to do" (the place as a JSON
/// pointer), for what the file may not say, and Failed for a file that cannot be read.
void add_scene_file(CLI::App& command, MediumOptions& options);

/// The JSON schema of scene files, with the options' own descriptions: what
/// docs/user/scene.schema.json holds.
nlohmann::ordered_json scene_schema();

}
