// The options that choose among the mappers' modes, and what is cut away; the same for every
// subcommand that draws.
#pragma once

#include "mapper_names.h"

#include "Transport/scene.h"

#include "vtkSmartPointer.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

class vtkImageData;
class vtkVolumeMapper;
class vtkVolumeProperty;

namespace CLI
{
class App;
}

namespace brume::app
{

/// What the user says of modes.
struct ModeOptions
{
  std::string blend_mode = "composite";
  std::vector<double> isovalues;                       ///< for "isosurface"
  std::optional<std::array<double, 2>> average_range;  ///< for "average"
  std::optional<std::array<double, 6>> cropping;       ///< x0, x1, y0, y1, z0, z1, world units
  std::string cropping_flags = "subvolume";            ///< a name, or 27 bits
  std::vector<std::string> clipping_planes;            ///< "NX,NY,NZ,D" each
  std::string mask;                                    ///< a file; empty for none
};

/// Declares them on a subcommand; they are read into `options`, which must outlive the parse.
void add_mode_options(CLI::App& command, ModeOptions& options);

/// What single options cannot tell: throws Failure (BadCall) for those that do not fit together.
void check(const ModeOptions& options);

/// The mask file on the input's voxels, 0 or 1, or null without one. Throws Failure for one that
/// cannot be read or is of other dimensions than the input.
vtkSmartPointer<vtkImageData> open_mask(
  const ModeOptions& options, vtkImageData* input, const std::string& input_name,
  std::int64_t max_memory, bool quiet);

/// Blend mode, ranges, cropping and clipping planes as the options have them; isovalues go to the
/// property. The mask is the caller's.
void apply(const ModeOptions& options, vtkVolumeMapper* mapper, vtkVolumeProperty* property);

/// The same cropping for an image of which neither origin nor direction is known to the mapper:
/// planes as multiples of its spacing.
void apply_cropping_of_voxels(const Cropping& cropping, vtkImageData* image, vtkVolumeMapper* mapper);

/// Why a mapper cannot draw what the options ask for; empty where it can.
std::string not_drawn_by(const ModeOptions& options, MapperKind mapper);

}
