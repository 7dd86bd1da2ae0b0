// What a subcommand's INPUT stands for: a file, or a sample that is made on the spot.
#pragma once

#include "vtkSmartPointer.h"

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

class vtkBrumeSparseVolume;
class vtkDataObject;
class vtkImageData;

namespace brume::app
{

/// A volume, and what is known of it.
struct Input
{
  vtkSmartPointer<vtkImageData> image; ///< with point scalars; at least one voxel
  vtkSmartPointer<vtkBrumeSparseVolume> sparse; ///< in place of the image, which is null then
  /// Further grids on the sparse volume's lattice, such as a temperature; only files take them.
  std::vector<vtkSmartPointer<vtkBrumeSparseVolume>> more_sparse;
  /// The values of "nothing" by array, where it is not 0: what a .vdb need not store.
  std::map<std::string, double> backgrounds;
  bool signed_distance = false; ///< the values are distances to a surface, negative within
  std::vector<std::string> grids; ///< of a file of several, as people read them; else empty
  std::string name;        ///< for people: the file's name without its folder, or the sample's
  std::string format;      ///< "NIfTI-1 (gzip)", "sample", …
  std::string length_unit; ///< of spacing and origin: "mm", …; empty where unknown
  std::string value_unit;  ///< "HU", …; empty where unknown
  bool patient_axes = false; ///< the world is RAS+: x to the patient's right, y front, z up
  std::vector<std::string> messages; ///< what the reader settled by itself, one line each
  std::vector<double> times;         ///< of a series over time, one for each volume; else empty
  std::string time_unit;             ///< of these: "s", …; empty where unknown
  int time_step = 0;                 ///< which of them this volume is, from 0 on

  vtkDataObject* data() const; ///< the image or the sparse volume
};

/// What of INPUT is taken, where it holds several things, and how much memory that may take.
struct InputChoice
{
  std::string grid;             ///< of an OpenVDB file; empty: the first that can be read
  std::string series;           ///< of a DICOM folder, by number or UID; empty: the only one
  std::optional<int> time_step; ///< of a series over time, from 0 on; empty: the first
  std::optional<double> time;   ///< the same by its time: the nearest
  std::int64_t max_memory = 0;  ///< bytes; 0: three quarters of the machine's
  std::string level_set = "fog"; ///< of an OpenVDB file: "fog" (a density) or "distance" (as it is)
  std::optional<std::string> chosen_level_set; ///< the same where the user says it, which files of
                                               ///< other formats refuse; empty: level_set
  bool all_grids = false; ///< without a grid by name, the others too, into Input::more_sparse
};

/// Opens INPUT as the user wrote it: `sample:NAME`, or a file, or a folder of DICOM, of which `choice`
/// names a part. `progress` is called now and then with the part that is done, in
/// [0, 1]. Throws Failure: with status BadCall for a sample that does not exist and for a choice that
/// the input does not have, Failed for a file that cannot be read.
Input open_input(const std::string& spec, const std::function<void(double)>& progress = {},
  const InputChoice& choice = {});

/// Opens INPUT and hands out all its volumes over time, one after another, the only one where it is no
/// series: the header is read once. `visit` may take the volume's data over. What `choice` says of time
/// is not looked at. Throws as open_input(), and what `visit` throws.
void for_each_volume(const std::string& spec,
  const std::function<void(double)>& progress,
  const InputChoice& choice,
  const std::function<void(Input&)>& visit);

/// The same as open_input() with a bar on the terminal for what takes over a second, unless `quiet`.
Input open_input_with_bar(const std::string& spec, const InputChoice& choice, bool quiet);

/// A sample: what `sample:NAME` makes. Each kind of `brume generate` is one (generators.h).
struct Sample
{
  std::string name;
  std::string summary; ///< one line
  std::function<Input(const std::function<void(double)>& progress)> make;
};
/// Every sample, in the order in which they are listed.
const std::vector<Sample>& samples();

}
