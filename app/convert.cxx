// brume convert IN OUT: a volume from one format to another.
#include "command.h"
#include "input.h"
#include "interruption.h"
#include "option_checks.h"
#include "progress.h"
#include "scalar_types.h"
#include "scene_options.h"
#include "volume_output.h"

#include "dense_volume.h"

#include "vtkBrumeSparseVolume.h"

#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkPointData.h"

#include <CLI/CLI.hpp>

#include <cstdio>
#include <iostream>
#include <memory>

namespace brume::app
{

namespace
{

struct Options
{
  std::string input;
  InputChoice choice;
  VolumeOutput output;
  std::string type;
  bool quiet = false;
};

/// What is nothing in a dense volume, where the user does not say: 0, or, where values are
/// negative, the least of them, as air is in a CT.
double background_of(vtkDataArray* array)
{
  double range[2];
  array->GetFiniteRange(range, 0);
  return range[0] < 0.0 ? range[0] : 0.0;
}

/// Makes a sparse volume dense, for a format that holds nothing else.
void make_dense(Input& volume, const Options& options, std::vector<std::string>& notes)
{
  ProgressBar bar("making it dense", !options.quiet);
  try
  {
    volume.image = brume::make_dense(volume.sparse,
      options.input,
      static_cast<std::uint64_t>(options.choice.max_memory),
      notes,
      [&bar](double done)
      {
        bar.update(done);
        return !InterruptionWatch::requested();
      });
  }
  catch (const std::runtime_error& error)
  {
    InterruptionWatch::check(options.input.c_str());
    throw Failure(error.what());
  }
  notes.push_back(
    "the sparse volume becomes dense: the box around what is stored, and its background "
    "within it");
  volume.sparse = nullptr;
}

void run(const Options& options)
{
  check_volume_output(options.output, options.input);
  const bool sparse_out = holds_sparse(options.output.path);
  if (sparse_out && !options.type.empty() && options.type != "float")
  {
    throw Failure(
      "--type " + options.type, "a .vdb holds floats", "leave it out, or give --half", BadCall);
  }
  const InterruptionWatch watch;
  InputChoice choice = options.choice;
  choice.all_grids = sparse_out;
  Input volume = open_input_with_bar(options.input, choice, options.quiet);
  std::vector<std::string> notes = volume.messages;
  VolumeOutput output = options.output;
  if (volume.sparse && (output.background || output.tolerance > 0.0))
  {
    throw Failure(output.background ? "--background" : "--background-tolerance",
      options.input + " is sparse and has a background of its own",
      "leave it out",
      BadCall);
  }
  if (volume.sparse && !sparse_out)
  {
    make_dense(volume, options, notes);
  }
  if (volume.image && !options.type.empty())
  {
    const std::vector<std::string> losses = convert_scalars(volume.image, options.type);
    notes.insert(notes.end(), losses.begin(), losses.end());
  }
  vtkPointData* points = volume.image && sparse_out ? volume.image->GetPointData() : nullptr;
  for (int i = 0; points && i < points->GetNumberOfArrays(); ++i)
  {
    vtkDataArray* array = points->GetArray(i);
    if (array && array->GetName() && array != points->GetScalars())
    {
      volume.backgrounds[array->GetName()] = background_of(array);
    }
  }
  if (points && !output.background && output.grid_class != "level-set" && !volume.signed_distance)
  {
    output.background = background_of(points->GetScalars());
    char text[64];
    std::snprintf(text, sizeof(text), "%.9g", *output.background);
    notes.push_back(std::string("the background, which is not stored, is ") + text +
                    " (--background chooses another)");
  }
  ProgressBar bar("writing " + output.path, !options.quiet);
  const std::vector<std::string> losses =
    write_volume(volume, output, [&bar](double done) { bar.update(done); });
  bar.clear();
  notes.insert(notes.end(), losses.begin(), losses.end());
  for (const std::string& note : notes)
  {
    if (!options.quiet)
    {
      std::cerr << "brume: " << output.path << ": " << note << '\n';
    }
  }
}

}

void add_convert(CLI::App& program)
{
  auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand(
    "convert", "Write a volume in another format, and tell what that format cannot hold");
  options->choice.level_set = "distance";
  add_input(*command, options->input, options->choice);
  command
    ->add_option("OUT",
      options->output.path,
      "The file to write; its ending chooses the format: " + volume_endings())
    ->required();
  command
    ->add_option("--type",
      options->type,
      "Write the values as " + listed(scalar_types()) +
        ": whole numbers are rounded and held to the type's range [as they are]")
    ->check(one_of(scalar_types()))
    ->type_name("TYPE");
  add_volume_output(*command, options->output);
  command->get_option("--background")
    ->description(
      "Of a .vdb from a dense volume: the value that is not stored [0, or the least value "
      "where some are negative]");
  command->add_flag("--quiet", options->quiet, "No progress bar, no notes");
  command->footer(
    "Examples: brume convert scan.nii.gz scan.nrrd --type int16\n"
    "          brume convert cloud.vti cloud.vdb --half --background-tolerance 0.001");
  command->callback([options] { run(*options); });
}

}
