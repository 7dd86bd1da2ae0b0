// The kinds of `brume generate`: volumes that are made on the spot.
//
// To add a kind, put a function that makes one into the file of its family and a row into that
// file's table, which is all:
//
//     // app/generate_clouds.cxx
//     Make declare_stratus(CLI::App& command)
//     {
//       auto base = std::make_shared<double>(500.0);
//       command.add_option("--base", *base, "Height of the cloud's base, metres [500]")
//         ->check(number("a height greater than 0", [](double v) { return v > 0.0; }))
//         ->type_name("M");
//       return [base](const GeneratorRequest& request)
//       {
//         vtkNew<vtkBrumeStratusSource> source;
//         source->SetSize(request.size);
//         source->SetSeed(request.seed);
//         source->SetTime(request.time);
//         source->SetBase(*base);
//         Input input = run_source(source, request);
//         input.length_unit = "m";
//         return input;
//       };
//     }
//     …
//     { "stratus", "a layer of cloud, density from 0 to 1", 256, Moves::Yes, declare_stratus },
//
// Where the options are settings of the source, GeneratorSettings (generator_settings.h) declares
// and applies them. Each kind is a subcommand of `brume generate` with the common options
// (--output, --size, --seed,
// --time for what moves, --quiet, and those of the writers) beside its own, and `sample:KIND` is
// the same volume with all options at their defaults. An option's description says its unit, its
// range where that is not obvious, and its default in brackets; its values are checked when they
// are parsed (option_checks.h). What the options cannot tell one by one, the made function may
// refuse with a Failure of status BadCall.
#pragma once

#include "input.h"

#include <functional>
#include <string>
#include <vector>

class vtkAlgorithm;

namespace CLI
{
class App;
}

namespace brume::app
{

/// What every kind is asked for.
struct GeneratorRequest
{
  int size = 256;    ///< voxels along the longest side, 2 to 4096
  int seed = 1;      ///< any value
  double time = 0.0; ///< seconds; 0 for kinds that do not move
  /// The output is of a format that holds sparse voxels. A kind that can make them without a dense
  /// volume first gives Input::sparse then; others give Input::image, which the writer makes
  /// sparse.
  bool sparse = false;
  /// That file may hold a level set, cut to a narrow band, where the volume is a signed distance.
  bool level_set = false;
  std::function<void(double)>
    progress; ///< called with the part that is done, in [0, 1]; may be empty
};

/// Makes the volume: Input::image or Input::sparse (with further grids in more_sparse), its units,
/// patient_axes, signed_distance for distances to a surface, and the backgrounds of arrays whose
/// "nothing" is not 0; name and format are set by the caller. Called once for each time of a
/// series. Throws Failure.
using Make = std::function<Input(const GeneratorRequest&)>;

enum class Moves
{
  No,
  Yes ///< time changes it, so that it has --time
};

struct Generator
{
  std::string name;    ///< in lower case with hyphens: "head-ct"
  std::string summary; ///< one line: what it is, the unit of its values and their range
  int default_size = 256;
  Moves moves = Moves::No;
  /// Declares the kind's own options on its subcommand; what it returns reads them when it is
  /// called and keeps them alive (a shared_ptr in the lambda). `command` may be gone by then.
  Make (*declare)(CLI::App& command);
  double default_time = 0.0; ///< seconds; of what moves
  bool seeded = true;        ///< whether there is more than one of its kind, so that it has --seed
};

/// Every kind, in the order in which they are listed.
const std::vector<Generator>& generators();

/// A shorter name of a kind, for `generate` and for `sample:NAME`; empty for most.
std::string short_name(const Generator& generator);

// The tables of the families; a file each.
std::vector<Generator> cloud_generators(); ///< generate_clouds.cxx: clouds and fog
std::vector<Generator>
shape_generators(); ///< generate_shapes.cxx: phantoms, shapes, particles, smoke

/// Brings a source up to date and hands out what it made: an image or a sparse volume, whichever
/// its output is. Progress goes to the request, Ctrl-C to the source; what the source complains of
/// (vtkErrorMacro) is thrown as a Failure.
Input run_source(vtkAlgorithm* source, const GeneratorRequest& request);

}
