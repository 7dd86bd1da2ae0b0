#include "volume_output.h"

#include "command.h"
#include "interruption.h"
#include "option_checks.h"
#include "output_check.h"

#include "file_series.h"

#include "vtkBrumeImageWriter.h"
#include "vtkBrumeOpenVDBWriter.h"
#include "vtkBrumeSparseVolume.h"

#include "vtkCallbackCommand.h"
#include "vtkCommand.h"
#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkPointData.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <set>

namespace brume::app
{

namespace
{

using Progress = std::function<void(double)>;

bool ends_with(const std::string& path, const std::string& ending)
{
  return path.size() > ending.size() &&
         std::equal(ending.rbegin(),
           ending.rend(),
           path.rbegin(),
           [](char a, char b) { return a == std::tolower(static_cast<unsigned char>(b)); });
}

/// Hears a writer in place of the standard error stream.
void hear(vtkObject* caller, unsigned long event, void* client, void*)
{
  auto* writer = static_cast<vtkAlgorithm*>(caller);
  const Progress& progress = *static_cast<const Progress*>(client);
  if (event == vtkCommand::ProgressEvent && progress)
  {
    progress(writer->GetProgress());
  }
  if (event == vtkCommand::ProgressEvent && InterruptionWatch::requested())
  {
    writer->AbortExecuteOn();
  }
}

/// Runs a writer, throws what it complains of, and returns what it tells.
template <class Writer>
std::vector<std::string> run(Writer* writer, const std::string& path, const Progress& progress)
{
  vtkNew<vtkCallbackCommand> ear;
  ear->SetClientData(const_cast<Progress*>(&progress));
  ear->SetCallback(hear);
  writer->AddObserver(vtkCommand::ErrorEvent, ear);
  writer->AddObserver(vtkCommand::ProgressEvent, ear);
  writer->SetFileName(path.c_str());
  writer->Write();
  InterruptionWatch::check(path.c_str());
  if (*writer->GetErrorMessage())
  {
    throw Failure(writer->GetErrorMessage());
  }
  std::vector<std::string> messages;
  for (int i = 0; i < writer->GetNumberOfMessages(); ++i)
  {
    messages.push_back(writer->GetMessage(i));
  }
  return messages;
}

/// Why a level set takes no background of the user's.
const char* const level_set = "a level set has the width of its band for a background";

/// What turns out only once the volume is there: the background is the volume's own.
void check_background(const Input& volume, const VolumeOutput& output)
{
  if (!output.background && !(output.tolerance > 0.0))
  {
    return;
  }
  const char* option = output.background ? "--background" : "--background-tolerance";
  if (volume.sparse)
  {
    throw Failure(
      option, volume.name + " is sparse and has a background of its own", "leave it out", BadCall);
  }
  if (volume.signed_distance && output.grid_class == "auto")
  {
    throw Failure(option, level_set, "leave it out", BadCall);
  }
}

}

bool holds_sparse(const std::string& path)
{
  return ends_with(path, ".vdb");
}

namespace
{

/// Where the ending begins.
std::size_t ending_of(const std::string& path)
{
  const std::size_t slash = path.rfind('/');
  const std::size_t from = slash == std::string::npos ? 0 : slash + 1;
  std::size_t dot = path.rfind('.');
  if (ends_with(path, ".nii.gz"))
  {
    dot = path.size() - 7;
  }
  if (dot == std::string::npos || dot <= from)
  {
    dot = path.size();
  }
  return dot;
}

std::string before_ending(const std::string& path, const char* text)
{
  const std::size_t dot = ending_of(path);
  return path.substr(0, dot) + text + path.substr(dot);
}

}

bool names_a_series(const std::string& path)
{
  return io::has_number_mark(path);
}

std::string marked_path(const std::string& path)
{
  return io::has_number_mark(path) ? path : before_ending(path, "_%04d");
}

std::string read_as(const std::string& path)
{
  return io::has_number_mark(path) ? path : before_ending(path, ".%04d");
}

std::string numbered_path(const std::string& path, std::int64_t number)
{
  return io::numbered_name(read_as(path), number);
}

void check_interrupted_series(const std::string& path, std::size_t done, std::size_t count)
{
  if (done > 0 && InterruptionWatch::requested())
  {
    throw Failure(path,
      "interrupted: " + std::to_string(done) + " of " + std::to_string(count) +
        " files are written",
      "run it again to the end");
  }
}

std::string volume_endings()
{
  return ".vdb, .vti, .nrrd, .mha, .nii, .nii.gz, .raw or .tif";
}

void add_volume_output(CLI::App& command, VolumeOutput& output)
{
  command.add_flag("--compress",
    output.compress,
    "Deflate the voxels of a .vti, .nrrd, .mha or .tif: smaller and slower (.nii.gz always does)");
  command.add_flag("--half", output.half, "Write a .vdb in half precision: 11 bits, up to 65504");
  command
    .add_option("--background",
      output.background,
      "Of a .vdb from a dense volume: the value that is not stored, in units of the values [0, or "
      "the kind's own]")
    ->check(number("a number", [](double) { return true; }))
    ->type_name("V");
  command
    .add_option("--background-tolerance",
      output.tolerance,
      "How far from it a value may be to be left out as well [0]")
    ->check(number("a number of 0 or more", [](double v) { return v >= 0; }))
    ->type_name("V");
  command
    .add_option("--grid-class",
      output.grid_class,
      "What a .vdb says that its values are: fog, level-set (distances to a surface, cut to a band "
      "of "
      "three voxels), unknown, or auto, as the volume has it [auto]")
    ->check(one_of({ "auto", "fog", "level-set", "unknown" }))
    ->type_name("CLASS");
}

void check_volume_output(const VolumeOutput& output, const std::string& input)
{
  const std::string remedy = "end it in " + volume_endings();
  if (output.path.empty())
  {
    throw Failure("the output", "it has no name", remedy, BadCall);
  }
  const bool sparse = holds_sparse(output.path);
  if (!sparse && !vtkBrumeImageWriter::CanWriteFile(output.path.c_str()))
  {
    throw Failure(output.path, "its ending names no format that holds a volume", remedy, BadCall);
  }
  const auto refuse = [](const char* option, const char* why)
  { throw Failure(option, why, "leave it out", BadCall); };
  if (output.compress && sparse)
  {
    refuse("--compress", "OpenVDB's files always are compressed");
  }
  if (output.compress && ends_with(output.path, ".raw"))
  {
    refuse("--compress", "raw voxels are stored as they are");
  }
  if (output.compress && (ends_with(output.path, ".nii") || ends_with(output.path, ".nii.gz")))
  {
    throw Failure("--compress",
      "NIfTI says by its name whether it is deflated",
      "leave it out, and write .nii.gz",
      BadCall);
  }
  const char* alone = "a .vdb alone has it";
  if (!sparse && output.half)
  {
    refuse("--half", alone);
  }
  if (!sparse && output.background)
  {
    refuse("--background", alone);
  }
  if (!sparse && output.tolerance > 0.0)
  {
    refuse("--background-tolerance", alone);
  }
  if (!sparse && output.grid_class != "auto")
  {
    refuse("--grid-class", alone);
  }
  if (output.grid_class == "level-set" && output.background)
  {
    refuse("--background", level_set);
  }
  if (output.grid_class == "level-set" && output.tolerance > 0.0)
  {
    refuse("--background-tolerance", level_set);
  }
  check_output(names_a_series(output.path) ? numbered_path(output.path, 0) : output.path, input);
}

void check_apart(const std::vector<std::string>& outputs, const std::string& input)
{
  const auto place = [](const std::string& path)
  {
    std::error_code error;
    return std::filesystem::weakly_canonical(path, error).string();
  };
  std::set<std::string> inputs;
  if (io::is_file_pattern(input))
  {
    for (const io::NumberedFile& file : io::numbered_files(input))
    {
      inputs.insert(place(file.path));
    }
  }
  else
  {
    inputs.insert(place(input));
  }
  for (const std::string& output : outputs)
  {
    if (inputs.count(place(output)) > 0)
    {
      throw Failure(output,
        "it is one of the input's files, which would be lost",
        "name another file",
        BadCall);
    }
  }
}

std::vector<std::string> write_volume(const Input& volume,
  const VolumeOutput& output,
  const Progress& progress)
{
  const auto settle = [&volume](auto* writer)
  {
    writer->SetInputDataObject(volume.data());
    writer->SetLengthUnit(volume.length_unit.c_str());
    writer->SetValueUnit(volume.value_unit.c_str());
    writer->SetPatientAxes(volume.patient_axes);
  };
  if (holds_sparse(output.path))
  {
    check_background(volume, output);
    vtkNew<vtkBrumeOpenVDBWriter> writer;
    settle(writer.Get());
    for (const auto& grid : volume.more_sparse)
    {
      writer->AddInputDataObject(grid);
    }
    writer->SetHalf(output.half);
    writer->SetBackground(output.background.value_or(0.0));
    for (const auto& [array, background] : volume.backgrounds)
    {
      vtkDataArray* scalars = volume.image ? volume.image->GetPointData()->GetScalars() : nullptr;
      const bool chosen =
        output.background && scalars && scalars->GetName() && array == scalars->GetName();
      writer->SetArrayBackground(array.c_str(), chosen ? *output.background : background);
    }
    writer->SetTolerance(output.tolerance);
    writer->SetGridClass(output.grid_class == "fog" ? vtkBrumeOpenVDBWriter::GridClassFogVolume
                         : output.grid_class == "level-set"
                           ? vtkBrumeOpenVDBWriter::GridClassLevelSet
                         : output.grid_class == "unknown" ? vtkBrumeOpenVDBWriter::GridClassUnknown
                         : volume.signed_distance         ? vtkBrumeOpenVDBWriter::GridClassLevelSet
                                                  : vtkBrumeOpenVDBWriter::GridClassAutomatic);
    return run(writer.Get(), output.path, progress);
  }
  if (!volume.image)
  {
    throw Failure(
      output.path, "the volume is sparse, and this format holds dense ones", "write a .vdb");
  }
  vtkNew<vtkBrumeImageWriter> writer;
  settle(writer.Get());
  writer->SetCompress(output.compress);
  return run(writer.Get(), output.path, progress);
}

}
