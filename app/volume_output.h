// Volumes to files: what `brume generate` and `brume convert` share.
#pragma once

#include "input.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace CLI
{
class App;
}

namespace brume::app
{

/// How a volume is written.
struct VolumeOutput
{
  std::string path;                 ///< its ending chooses the format
  bool compress = false;            ///< deflated, where the format leaves the choice
  bool half = false;                ///< OpenVDB: in half precision
  std::optional<double> background; ///< OpenVDB: the value of what is not stored [0]
  double tolerance = 0.0;           ///< OpenVDB: how far from it a voxel may be to be left out
  std::string grid_class = "auto";  ///< OpenVDB: auto, fog, level-set or unknown
};

/// Declares the options of the writers on a subcommand; they are read into `output`, which must
/// outlive the parse. Where the file is named is the subcommand's affair.
void add_volume_output(CLI::App& command, VolumeOutput& output);

/// The endings of all formats, for messages and help: ".vti, .nrrd, …".
std::string volume_endings();

/// What names all files of the series that numbered_path() makes of `path`, as an input does.
std::string read_as(const std::string& path);

/// Where Ctrl-C was pressed after `done` of the `count` files of a series were written, throws a Failure
/// that says so, in place of one that says that nothing was.
void check_interrupted_series(const std::string& path, std::size_t done, std::size_t count);

/// Throws Failure (BadCall) for an ending that names no format, for options that the format does
/// not have, and as check_output() does for a place that cannot be written.
void check_volume_output(const VolumeOutput& output, const std::string& input);

/// Throws Failure (BadCall) where one of the outputs is the input, or one of the files that the input
/// names by a pattern.
void check_apart(const std::vector<std::string>& outputs, const std::string& input);

/// Whether the format holds sparse voxels: OpenVDB.
bool holds_sparse(const std::string& path);

/// The file of a series: "cloud_0003.vdb" of "cloud_%04d.vdb", number 3, where the name has a mark that
/// stands for a number (%d, %04d, ####); else "cloud.0003.vdb" of "cloud.vdb": four digits or more
/// before the ending. ".nii.gz" is one ending. Numbers are from 0 on.
std::string numbered_path(const std::string& path, std::int64_t number);

/// Whether a name has such a mark: it stands for the files of a series.
bool names_a_series(const std::string& path);

/// The mark of numbered_path() in front of the ending, for what people are told: "cloud_%04d.vdb" of
/// "cloud.vdb".
std::string marked_path(const std::string& path);

/// Writes the volume, whole or not at all. Returns what the format could not hold, a line each.
/// Throws Failure.
std::vector<std::string> write_volume(const Input& volume,
  const VolumeOutput& output,
  const std::function<void(double)>& progress = {});

}
