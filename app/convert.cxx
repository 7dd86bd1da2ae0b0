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

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <iostream>
#include <memory>
#include <set>

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

using Progress = std::function<void(double)>;

/// The part from `begin` to `end` of a longer work.
Progress part_of(const Progress& whole, double begin, double end)
{
  return [&whole, begin, end](double done) { whole(begin + (end - begin) * done); };
}

/// Makes a sparse volume dense, for a format that holds nothing else.
void make_dense(Input& volume,
  const Options& options,
  std::vector<std::string>& notes,
  const Progress& progress)
{
  try
  {
    volume.image = brume::make_dense(volume.sparse,
      options.input,
      static_cast<std::uint64_t>(options.choice.max_memory),
      notes,
      [&progress](double done)
      {
        progress(done);
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

/// Writes one volume to `path`. Returns what is to be told of it.
std::vector<std::string> write(Input& volume,
  const Options& options,
  const std::string& path,
  const Progress& progress)
{
  std::vector<std::string> notes = volume.messages;
  VolumeOutput output = options.output;
  output.path = path;
  const bool sparse_out = holds_sparse(path);
  double begun = 0.0;
  if (volume.sparse && (output.background || output.tolerance > 0.0))
  {
    throw Failure(output.background ? "--background" : "--background-tolerance",
      options.input + " is sparse and has a background of its own",
      "leave it out",
      BadCall);
  }
  if (volume.sparse && !sparse_out)
  {
    begun = 0.3;
    make_dense(volume, options, notes, part_of(progress, 0.0, begun));
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
  const std::vector<std::string> losses =
    write_volume(volume, output, part_of(progress, begun, 1.0));
  notes.insert(notes.end(), losses.begin(), losses.end());
  return notes;
}

void tell(const Options& options, const std::string& path, const std::string& note)
{
  if (!options.quiet)
  {
    std::cerr << "brume: " << path << ": " << note << '\n';
  }
}

/// "0.5 to 3.5 s"
std::string spoken_times(const Input& series)
{
  char text[80];
  std::snprintf(text, sizeof(text), "%g to %g", series.times.front(), series.times.back());
  return text + (series.time_unit.empty() ? "" : " " + series.time_unit);
}

/// One volume to one file.
void convert_one(const Options& options, const InputChoice& choice)
{
  Input volume = open_input_with_bar(options.input, choice, options.quiet);
  const std::string& path = options.output.path;
  ProgressBar bar("writing " + path, !options.quiet);
  const std::vector<std::string> notes =
    write(volume, options, path, [&bar](double done) { bar.update(done); });
  bar.clear();
  for (const std::string& note : notes)
  {
    tell(options, path, note);
  }
  if (volume.times.size() > 1)
  {
    tell(options,
      path,
      "the other " + std::to_string(volume.times.size() - 1) +
        " volumes of the series are left out: write " + marked_path(path) + " for all of them");
  }
}

/// The numbers of a series' files: its times, where they are whole and without a unit, as the numbers in
/// the names of the input's files are; else 0, 1, 2, …
std::vector<std::int64_t> numbers_of(const Input& series)
{
  const std::vector<double>& times = series.times;
  const bool whole = series.time_unit.empty() && std::is_sorted(times.begin(), times.end()) &&
                     std::all_of(times.begin(),
                       times.end(),
                       [](double t) { return t >= 0.0 && t <= 1e9 && t == std::floor(t); });
  std::vector<std::int64_t> numbers;
  for (std::size_t i = 0; i < std::max<std::size_t>(times.size(), 1); ++i)
  {
    numbers.push_back(
      static_cast<std::int64_t>(whole && !times.empty() ? times[i] : static_cast<double>(i)));
  }
  return numbers;
}

/// Every volume of a series to a file of its own.
void convert_all(const Options& options, const InputChoice& choice)
{
  if (choice.time || choice.time_step)
  {
    throw Failure(choice.time ? "--time" : "--time-step",
      options.output.path + " names a file for each volume of the series, and this takes one",
      "leave it out, or name one file",
      BadCall);
  }
  ProgressBar bar("writing " + options.output.path, !options.quiet);
  std::size_t done = 0;
  std::size_t count = 1;
  const auto overall = [&](double part)
  { bar.update((static_cast<double>(done) + part) / static_cast<double>(count)); };
  const Progress reading = [&](double part) { overall(0.5 * part); };
  const Progress writing = [&](double part) { overall(0.5 + 0.5 * part); };
  std::vector<std::string> paths;
  std::set<std::string> told; // most is the same for all of a series
  const auto visit = [&](Input& volume)
  {
    if (done == 0)
    {
      count = std::max<std::size_t>(volume.times.size(), 1);
      for (const std::int64_t number : numbers_of(volume))
      {
        paths.push_back(numbered_path(options.output.path, number));
      }
      check_apart(paths, options.input);
    }
    const std::vector<std::string> notes = write(volume, options, paths[done], writing);
    for (const std::string& note : notes)
    {
      const bool of_time = volume.times.size() > 1 && note.compare(0, 12, "a series of ") == 0;
      if (!of_time && told.insert(note).second)
      {
        bar.clear();
        tell(options, paths[done], note);
      }
    }
    ++done;
    if (done < count)
    {
      return;
    }
    bar.clear();
    if (count == 1)
    {
      tell(options, paths[0], options.input + " is one volume, and no series");
      return;
    }
    tell(options,
      paths.front() + " to " + paths.back(),
      std::to_string(count) + " volumes, a file each: read them as " +
        read_as(options.output.path) +
        (volume.time_unit.empty() ? ""
                                  : "; their times, " + spoken_times(volume) +
                                      ", are not in the files, which are numbered"));
  };
  try
  {
    for_each_volume(options.input, reading, choice, visit);
  }
  catch (const Failure&)
  {
    bar.clear();
    check_interrupted_series(done < paths.size() ? paths[done] : options.output.path, done, count);
    throw;
  }
}

void run(const Options& options)
{
  check_volume_output(options.output, options.input);
  if (holds_sparse(options.output.path) && !options.type.empty() && options.type != "float")
  {
    throw Failure(
      "--type " + options.type, "a .vdb holds floats", "leave it out, or give --half", BadCall);
  }
  const InterruptionWatch watch;
  InputChoice choice = options.choice;
  choice.all_grids = holds_sparse(options.output.path);
  if (names_a_series(options.output.path))
  {
    convert_all(options, choice);
  }
  else
  {
    check_apart({ options.output.path }, options.input);
    convert_one(options, choice);
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
      "The file to write; its ending chooses the format: " + volume_endings() +
        ". Of a series over time NAME_%04d.ENDING writes all volumes, a file each")
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
    "          brume convert cloud.vti cloud.vdb --half --background-tolerance 0.001\n"
    "          brume convert heart4d.nii.gz heart_%04d.vdb");
  command->callback([options] { run(*options); });
}

}
