// Volumes to files: what `brume generate` and `brume convert` share.
#pragma once

#include "input.h"

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

/// Throws Failure (BadCall) for an ending that names no format, for options that the format does
/// not have, and as check_output() does for a place that cannot be written.
void check_volume_output(const VolumeOutput& output, const std::string& input);

/// Whether the format holds sparse voxels: OpenVDB.
bool holds_sparse(const std::string& path);

/// "cloud.0003.vdb" of "cloud.vdb", number 3: four digits or more. ".nii.gz" is one ending.
std::string numbered_path(const std::string& path, int number);

/// Writes the volume, whole or not at all. Returns what the format could not hold, a line each.
/// Throws Failure.
std::vector<std::string> write_volume(const Input& volume,
  const VolumeOutput& output,
  const std::function<void(double)>& progress = {});

}
