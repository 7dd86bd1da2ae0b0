// The scene options, which are the same for every subcommand that draws.
#pragma once

#include "input.h"
#include "medium_options.h"
#include "mode_options.h"
#include "presets.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace CLI
{
class App;
}

namespace brume::app
{

/// What the user says about the scene. Empty optionals are settled from the volume (volume_scene.h).
/// How paths are traced (--mapper pathtrace, and time and seed for smart); what is not given is the
/// mapper's default.
struct PathOptions
{
  std::optional<int> samples_per_pixel;
  std::optional<int> scatterings; ///< at the most; 0: any number
  std::optional<double> seconds;  ///< at the most
  std::optional<std::uint32_t> seed;

  /// The first option that is given; empty: none.
  std::string given() const;
};

/// Terms of gradient shading in place of the preset's; empty: the preset's.
struct ShadingTerms
{
  std::optional<double> ambient;        ///< in [0, 1]
  std::optional<double> diffuse;        ///< in [0, 1]
  std::optional<double> specular;       ///< in [0, 1]
  std::optional<double> specular_power; ///< in [0, 1e4]

  /// The first option that was given, empty for none.
  std::string given() const;

  bool operator==(const ShadingTerms& other) const
  {
    return this->ambient == other.ambient && this->diffuse == other.diffuse &&
      this->specular == other.specular && this->specular_power == other.specular_power;
  }
};

struct SceneOptions
{
  std::string input;
  InputChoice choice; ///< what of it is taken
  std::string density_array; ///< of the point data; empty: its scalars
  std::vector<std::string> meshes; ///< files
  std::array<int, 2> resolution{ 512, 512 }; ///< pixels
  std::optional<std::array<double, 3>> camera_position;    ///< world units
  std::optional<std::array<double, 3>> camera_focal_point; ///< world units
  std::optional<std::array<double, 3>> camera_view_up;
  double camera_view_angle = 30.0;             ///< degrees
  std::optional<double> camera_parallel_scale; ///< world units; parallel projection when given
  std::optional<std::array<double, 3>> background_choice; ///< linear RGB
  /// The choice; without one black, or white for a density that only absorbs, which darkens what is
  /// behind it. Settled by make_volume_scene().
  std::array<double, 3> background{ 0.0, 0.0, 0.0 };
  /// Per world unit and unit of density, R, G, B; 0, 0, 0: the values are classified.
  Triple extinction{ 0.0, 0.0, 0.0 };
  std::string preset;                          ///< empty: picked from the data
  /// Of a scene file, in place of the preset's; values are the data's own. Empty: the preset's.
  ///@{
  std::vector<ColourPoint> colour;
  std::vector<OpacityPoint> opacity;
  ///@}
  std::optional<double> opacity_unit_distance; ///< world units
  std::optional<double> sample_distance;       ///< world units
  std::string interpolation = "linear";
  std::string shade = "preset"; ///< on, off, or preset: as the preset has it
  ShadingTerms shading;
  ModeOptions modes;
  MediumOptions medium;
  std::optional<double> tolerance_choice;
  /// The choice, if there is one. Settled by make_volume_scene().
  double tolerance = 0.004;
  PathOptions paths;
  int threads = 0;
  bool quiet = false;
  bool verbose = false;

  /// Whether the values are a density.
  bool density() const { return this->extinction != Triple{ 0.0, 0.0, 0.0 }; }
};

/// Declares INPUT and the options that choose a part of it on a subcommand; they are read into `input`
/// and `choice`, which must outlive the parse.
void add_input(CLI::App& command, std::string& input, InputChoice& choice);

/// Declares INPUT, the scene options and --scene, which reads them from a file, on a subcommand; they
/// are read into `options`, which must outlive the parse. `shade` is the subcommand's default for
/// --shade.
void add_scene_options(CLI::App& command, SceneOptions& options, const std::string& shade);

/// What single options cannot tell: throws Failure (BadCall) for those that do not fit together.
void check(const SceneOptions& options);

/// Throws Failure (BadCall) where there is nothing to draw: no INPUT, and no surfaces in fog either.
void refuse_empty(const SceneOptions& options);

/// Throws Failure (BadCall) with this remedy where the scene has what VTK's own mappers do not draw:
/// a density, light in a medium, fog, surfaces, forced effects.
void refuse_beyond_stock_mappers(const SceneOptions& options, const std::string& remedy);

/// Throws Failure (BadCall) where an option was given that the path tracer does not follow.
void refuse_beyond_paths(const SceneOptions& options);

/// Throws Failure (BadCall) where an option was given that vtkBrumeSmartVolumeMapper chooses itself.
void refuse_beyond_smart(const SceneOptions& options);

/// Whether, without --mapper, the picture is the smart mapper's: an error or a time was asked for, and no
/// step or shadow that would be the ray march's.
bool asks_for_smart(const SceneOptions& options);

/// Throws Failure (BadCall) where an option of the path tracer was given to something else.
void refuse_paths(const SceneOptions& options, const std::string& remedy);

}
