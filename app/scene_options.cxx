#include "scene_options.h"

#include "command.h"
#include "input.h"
#include "option_checks.h"
#include "presets.h"
#include "scene_file.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

namespace brume::app
{

namespace
{

const CLI::Validator& any()
{
  static const CLI::Validator check = number("a number from -1e30 to 1e30",
    [](double v) { return std::abs(v) <= 1e30; });
  return check;
}

const CLI::Validator& positive()
{
  static const CLI::Validator check =
    number("a number greater than 0", [](double v) { return v > 0.0; });
  return check;
}

const CLI::Validator& fraction()
{
  static const CLI::Validator check =
    number("a number from 0 to 1", [](double v) { return v >= 0.0 && v <= 1.0; });
  return check;
}

/// "8G" in bytes; 0 for what is no size from 1 byte to 8 EB.
std::int64_t bytes_of(const std::string& text)
{
  double value = 0.0;
  const std::from_chars_result result =
    std::from_chars(text.data(), text.data() + text.size(), value);
  std::string unit(static_cast<const char*>(result.ptr), text.data() + text.size());
  std::transform(unit.begin(), unit.end(), unit.begin(),
    [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (!unit.empty() && unit.back() == 'b')
  {
    unit.pop_back();
  }
  const bool binary = unit.size() == 2 && unit[1] == 'i';
  const std::string letters = "kmgt";
  const std::size_t power = unit.empty() ? 0 : letters.find(unit[0]) + 1;
  if (result.ec != std::errc() || (!unit.empty() && power == 0) || unit.size() > (binary ? 2u : 1u))
  {
    return 0;
  }
  value *= std::pow(binary ? 1024.0 : 1000.0, static_cast<double>(power));
  return value >= 1.0 && value < 8e18 ? static_cast<std::int64_t>(value) : 0;
}

std::string preset_names()
{
  std::string names;
  for (const Preset& preset : presets())
  {
    names += (names.empty() ? "" : ", ") + preset.name;
  }
  return names;
}

}

void add_input(CLI::App& command, std::string& input, InputChoice& choice)
{
  command
    .add_option("INPUT", input,
      "A file (DICOM, .tiff, .nii, .nii.gz, .mha, .mhd, .nrrd, .nhdr, .vti, .vtk, .vdb; .raw with NAME.raw.json "
      "beside it: {\"dimensions\": [X, Y, Z], \"type\": \"uint16\", \"byte_order\": \"little\", "
      "\"spacing\": [1, 1, 1]}), numbered files of a series "
      "(NAME%04d.EXT), a folder of DICOM or of TIFF or PNG slices, or a volume made on the spot "
      "(sample:cloud, sample:fog, sample:head-ct, sample:smoke, and every kind of brume generate --list)")
    ->required();
  command
    .add_option("--grid", choice.grid, "Which grid of an OpenVDB file [the first that can be read]")
    ->type_name("NAME");
  command
    .add_option("--level-set", choice.chosen_level_set,
      "What becomes of an OpenVDB file's level set: fog (a density, 0 at the surface, 1 from the band's "
      "depth on) or distance (as it is) [" + choice.level_set + "]")
    ->check(one_of({ "fog", "distance" }))
    ->type_name("HOW");
  command
    .add_option("--series", choice.series,
      "Which series of a DICOM folder: its number in the list that the error without a choice gives, "
      "or its UID [the only one]")
    ->type_name("N|UID");
  CLI::Option* step = command
    .add_option("--time-step", choice.time_step,
      "Which volume of a series over time, counted from 0 (info tells how many there are) [0]")
    ->type_name("N")
    ->check(number("a whole number of 0 or more",
      [](double v) { return v >= 0 && v <= 1e9 && v == std::floor(v); }));
  command
    .add_option("--time", choice.time,
      "The same by its time, in the series' unit; of numbered files (smoke_%04d.vdb) by their "
      "numbers: the nearest [the first]")
    ->type_name("T")
    ->check(any())
    ->excludes(step);
  command
    .add_option_function<std::string>("--max-memory",
      [&choice](const std::string& text) { choice.max_memory = bytes_of(text); },
      "The most memory that the volume may take: 8G, 500M or a number of bytes; K, M, G, T count "
      "thousands, Ki, Mi, Gi, Ti 1024s [three quarters of the machine's]")
    ->type_name("SIZE")
    ->check(CLI::Validator(
      [](std::string& text)
      {
        return bytes_of(text) > 0
          ? std::string()
          : "'" + text + "' is not a size in bytes, such as 8G, 500M or 2Gi";
      },
      "", ""));
}

void add_scene_options(CLI::App& command, SceneOptions& o, const std::string& shade)
{
  o.shade = shade;
  add_input(command, o.input, o.choice);

  const char* camera = "Camera";
  const char* look = "Look";
  const char* cost = "Accuracy and cost";
  command.add_option("--resolution", o.resolution, "Size of the picture in pixels [512,512]")
    ->delimiter(',')
    ->type_name("W,H")
    ->check(number("a whole number of pixels from 1 to 16384",
      [](double v) { return v >= 1 && v <= 16384 && v == std::floor(v); }))
    ->group(camera);
  command
    .add_option("--camera-position", o.camera_position,
      "Where the eye is, in world units [so that all that can be seen is in the picture]")
    ->delimiter(',')
    ->type_name("X,Y,Z")
    ->check(any())
    ->group(camera);
  command
    .add_option("--camera-focal-point", o.camera_focal_point,
      "What it looks at, in world units [the middle of what can be seen]")
    ->delimiter(',')
    ->type_name("X,Y,Z")
    ->check(any())
    ->group(camera);
  command
    .add_option("--camera-view-up", o.camera_view_up, "Which way is up in the picture [0,0,1]")
    ->delimiter(',')
    ->type_name("X,Y,Z")
    ->check(any())
    ->group(camera);
  command
    .add_option("--camera-view-angle", o.camera_view_angle,
      "Angle between the picture's lower and upper edge, in degrees [30]")
    ->type_name("DEG")
    ->check(number("an angle between 0 and 180 degrees",
      [](double v) { return v > 0.0 && v < 180.0; }))
    ->group(camera);
  command
    .add_option("--camera-parallel-scale", o.camera_parallel_scale,
      "Parallel projection: half the height that is seen, in world units [perspective]")
    ->type_name("S")
    ->check(positive())
    ->group(camera);

  command
    .add_option("--background", o.background_choice,
      "Colour behind the volume, linear, 1 is white [0,0,0; with --extinction and no light 1,1,1]")
    ->delimiter(',')
    ->type_name("R,G,B")
    ->check(number("a number of 0 or more", [](double v) { return v >= 0.0; }))
    ->group(look);
  CLI::Option* preset = command
    .add_option("--preset", o.preset,
      "Transfer functions: " + preset_names() + " [picked from the data]")
    ->type_name("NAME")
    ->group(look);
  command
    .add_option_function<std::string>(
      "--extinction", [&o](const std::string& t) { o.extinction = three_of(split_numbers(t)); },
      "The values are a density: extinction per world unit and unit of density, greater than 0; one "
      "number or R, G and B. By itself it absorbs; with options of light or matter it scatters [the "
      "values are classified by the preset]")
    ->type_name("S[,S,S]")
    ->check(numbers("one or three numbers greater than 0", { 1, 3 },
      [](double v) { return v > 0.0 && v <= 1e30; }))
    ->excludes(preset)
    ->group(look);
  command
    .add_option("--density-array", o.density_array,
      "The array of INPUT that holds the values, of a file of several [its scalars]")
    ->type_name("NAME")
    ->group(look);
  command
    .add_option("--opacity-unit-distance", o.opacity_unit_distance,
      "Length that the preset's opacities speak of, in world units [the preset's]")
    ->type_name("D")
    ->check(positive())
    ->group(look);
  command
    .add_option("--shade", o.shade,
      "Light the volume like a surface by its gradient: on, off, or preset (as the preset has it) [" +
        shade + "]")
    ->type_name("WHEN")
    ->check(one_of({ "on", "off", "preset" }))
    ->group(look);
  command
    .add_option("--ambient", o.shading.ambient,
      "Of gradient shading, the part of a colour that is sent whatever the light's direction [the "
      "preset's]")
    ->type_name("A")
    ->check(fraction())
    ->group(look);
  command
    .add_option("--diffuse", o.shading.diffuse,
      "Of gradient shading, the part of a colour that a surface facing the light sends [the preset's]")
    ->type_name("D")
    ->check(fraction())
    ->group(look);
  command
    .add_option("--specular", o.shading.specular,
      "Of gradient shading, the highlight's part of the light's colour [the preset's]")
    ->type_name("S")
    ->check(fraction())
    ->group(look);
  command
    .add_option("--specular-power", o.shading.specular_power,
      "Of gradient shading, the highlight's exponent: larger is smaller and sharper [the preset's]")
    ->type_name("N")
    ->check(number("a number from 0 to 10000", [](double v) { return v >= 0.0 && v <= 1e4; }))
    ->group(look);
  command
    .add_option("--interpolation", o.interpolation, "Between voxels: linear or nearest [linear]")
    ->type_name("HOW")
    ->check(one_of({ "linear", "nearest" }))
    ->group(look);

  command
    .add_option("--mesh", o.meshes,
      "A surface that VTK draws where the volume is, and that hides what is behind it (.vtp, .ply, "
      ".stl, .obj); may be given several times")
    ->allow_extra_args(false)
    ->type_name("FILE")
    ->group(look);

  add_mode_options(command, o.modes);
  add_medium_options(command, o.medium);

  command
    .add_option("--sample-distance", o.sample_distance,
      "Fixed distance between samples, in world units")
    ->type_name("D")
    ->check(positive())
    ->group(cost);
  command
    .add_option("--tolerance", o.tolerance_choice,
      "Error that is accepted for speed, as a fraction of white: of 99.9 % of the pixels against the "
      "truth, light scattered any number of times, by --mapper smart, which render takes where this is "
      "given; the ray march counts the largest error that its steps make [0.004]")
    ->type_name("T")
    ->check(fraction())
    ->group(cost);
  command
    .add_option("--samples-per-pixel", o.paths.samples_per_pixel,
      "Paths through each pixel, at the most; four times as many halve the noise "
      "(--mapper pathtrace) [64]")
    ->type_name("N")
    ->check(number("a whole number from 1 to 2147483647",
      [](double v) { return v >= 1 && v <= 2147483647.0 && v == std::floor(v); }))
    ->group(cost);
  command
    .add_option("--maximum-scatterings", o.paths.scatterings,
      "Scatterings of a path, at the most (--mapper pathtrace) [0: any number]")
    ->type_name("N")
    ->check(number("a whole number from 0 to 2147483647",
      [](double v) { return v >= 0 && v <= 2147483647.0 && v == std::floor(v); }))
    ->group(cost);
  command
    .add_option("--time-budget", o.paths.seconds,
      "Seconds that the picture may take, reading INPUT not counted: the best of that time by --mapper "
      "smart, which render takes where this is given; of --mapper pathtrace the paths alone [no limit]")
    ->type_name("SECONDS")
    ->check(positive())
    ->group(cost);
  command
    .add_option("--seed", o.paths.seed,
      "Which of all pictures of the same noise: a whole number of 32 bits (--mapper pathtrace, smart) [1]")
    ->type_name("S")
    ->check(number("a whole number from 0 to 4294967295",
      [](double v) { return v >= 0 && v <= 4294967295.0 && v == std::floor(v); }))
    ->group(cost);
  command.add_option("--threads", o.threads, "Threads that render [as many as processors]")
    ->type_name("N")
    ->check(number("a whole number from 1 to 1024",
      [](double v) { return v >= 1 && v <= 1024 && v == std::floor(v); }))
    ->group(cost);

  command.add_flag("--quiet", o.quiet, "No progress bar and no remarks");
  command.add_flag("--verbose", o.verbose, "Say more of what is done, and why")
    ->excludes("--quiet");
  add_scene_file(command, o);
}

void check(const SceneOptions& options)
{
  check(options.modes);
  check(options.medium);
  const bool composite = options.modes.blend_mode == "composite";
  if (!composite && (options.medium.has_medium() || options.medium.has_fog()))
  {
    throw Failure("--blend-mode " + options.modes.blend_mode, "light in media is composite mode's alone",
      "leave it out, or the options of light, matter and fog", BadCall);
  }
}

void refuse_empty(const SceneOptions& options)
{
  if (options.input.empty() && (options.meshes.empty() || !options.medium.has_fog()))
  {
    throw Failure("INPUT", "it is missing",
      "name a volume; only surfaces in fog (--mesh, --fog-extinction) need none", BadCall);
  }
}

void refuse_beyond_stock_mappers(const SceneOptions& options, const std::string& remedy)
{
  if (options.density())
  {
    throw Failure("--extinction", "VTK's own mappers do not draw densities", remedy, BadCall);
  }
  const std::string name = options.medium.beyond_stock_mappers();
  if (!name.empty())
  {
    throw Failure(
      name, "VTK's own mappers know neither light in media nor fog nor effects", remedy, BadCall);
  }
  if (!options.meshes.empty())
  {
    throw Failure("--mesh", "surfaces are drawn with Brume's volumes alone", remedy, BadCall);
  }
}

std::string ShadingTerms::given() const
{
  return this->ambient     ? "--ambient"
    : this->diffuse        ? "--diffuse"
    : this->specular       ? "--specular"
    : this->specular_power ? "--specular-power"
                           : "";
}

std::string PathOptions::given() const
{
  return this->samples_per_pixel ? "--samples-per-pixel"
    : this->scatterings          ? "--maximum-scatterings"
    : this->seconds              ? "--time-budget"
    : this->seed                 ? "--seed"
                                 : "";
}

void refuse_beyond_paths(const SceneOptions& options)
{
  const char* const remedy = "leave it out, or take --mapper raymarch";
  if (options.sample_distance)
  {
    throw Failure("--sample-distance", "paths take no steps", remedy, BadCall);
  }
  if (options.medium.shadows != "automatic" || options.medium.shadow_sample_distance > 0.0)
  {
    throw Failure(options.medium.shadows != "automatic" ? "--shadows" : "--shadow-sample-distance",
      "paths know all shadows", remedy, BadCall);
  }
  if (!options.medium.forces.empty())
  {
    throw Failure("--force", "paths simulate what they simulate", remedy, BadCall);
  }
}

namespace
{

/// The first option of steps or shadows that is given; empty: none.
std::string march_option(const SceneOptions& options)
{
  return options.sample_distance                        ? "--sample-distance"
    : options.medium.shadows != "automatic"             ? "--shadows"
    : options.medium.shadow_sample_distance > 0.0       ? "--shadow-sample-distance"
                                                        : "";
}

}

void refuse_beyond_smart(const SceneOptions& options)
{
  if (const std::string option = march_option(options); !option.empty())
  {
    throw Failure(option, "--mapper smart chooses it by the error or the time",
      "leave it out, or take --mapper raymarch", BadCall);
  }
  if (options.paths.samples_per_pixel || options.paths.scatterings)
  {
    throw Failure(options.paths.samples_per_pixel ? "--samples-per-pixel" : "--maximum-scatterings",
      "it is the path tracer's", "add --mapper pathtrace, or leave it out", BadCall);
  }
}

bool asks_for_smart(const SceneOptions& options)
{
  return options.paths.seconds || (options.tolerance_choice && march_option(options).empty());
}

void refuse_paths(const SceneOptions& options, const std::string& remedy)
{
  if (const std::string option = options.paths.given(); !option.empty())
  {
    throw Failure(option, "it is the path tracer's", remedy, BadCall);
  }
}

}
