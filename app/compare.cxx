// brume compare: the same scene by several mappers, timed and measured against the truth.
#include "command.h"
#include "compare_measure.h"
#include "interruption.h"
#include "machine.h"
#include "mapper_names.h"
#include "option_checks.h"
#include "presets.h"
#include "private_display.h"
#include "scene_options.h"
#include "volume_scene.h"

#include "Analysis/comparison.h"
#include "Analysis/comparison_json.h"
#include "Analysis/difference_picture.h"
#include "Analysis/image_errors.h"
#include "Analysis/panel.h"
#include "Analysis/report_html.h"
#include "Analysis/text_table.h"

#include "atomic_file.h"
#include "film_io.h"

#include "Transport/sparse_voxels.h"

#include "vtkBrumeSparseVolume.h"

#include "vtkCamera.h"
#include "vtkImageData.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>

namespace brume::app
{

namespace
{

namespace fs = std::filesystem;

struct Options
{
  SceneOptions scene;
  std::string output;
  std::vector<std::string> mappers;
  int repetitions = 5;
  std::string command_line;
};

std::string text(double value)
{
  std::ostringstream out;
  out << value;
  return out.str();
}

std::string length(double value, const std::string& unit)
{
  return text(value) + (unit.empty() ? "" : " " + unit);
}

/// The folder is made before the work, so that a place that cannot be written is told at once.
/// Folders that were made here go again when the work fails.
class OutputFolder
{
public:
  explicit OutputFolder(const std::string& path)
    : Path(path)
  {
    std::error_code error;
    fs::path missing = fs::absolute(path, error);
    while (!missing.empty() && !fs::exists(fs::symlink_status(missing, error)))
    {
      this->Made = missing;
      missing = missing.parent_path();
    }
    fs::create_directories(path, error);
    if (error || !fs::is_directory(path, error))
    {
      this->remove();
      throw Failure(path, "the output folder cannot be made (" +
          (error ? error.message() : std::string("a file is there")) + ")",
        "name another with --output");
    }
    try
    {
      // Tries to write, and takes it back.
      AtomicFile probe((fs::path(path) / "compare.json").string());
    }
    catch (const std::runtime_error& failure)
    {
      this->remove();
      throw Failure(failure.what());
    }
  }
  ~OutputFolder()
  {
    if (!this->Kept)
    {
      this->remove();
    }
  }
  void keep() { this->Kept = true; }
  std::string file(const std::string& name) const { return (fs::path(this->Path) / name).string(); }

private:
  void remove()
  {
    std::error_code error;
    if (!this->Made.empty())
    {
      fs::remove_all(this->Made, error);
    }
  }

  std::string Path;
  fs::path Made; ///< the topmost folder that was not there before; empty when all were
  bool Kept = false;
};

SceneDescription describe(const VolumeScene& scene, double step)
{
  SceneDescription d;
  const std::string& unit = scene.input.length_unit;
  vtkVolumeProperty* property = scene.volume->GetProperty();
  d.input = scene.input.name;
  if (vtkBrumeSparseVolume* sparse = scene.input.sparse)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      d.dimensions[axis] = sparse->GetVoxels()->dims()[axis] - sparse->GetVoxels()->first()[axis];
    }
    sparse->GetSpacing(d.spacing.data());
  }
  else
  {
    scene.input.image->GetDimensions(d.dimensions.data());
    scene.input.image->GetSpacing(d.spacing.data());
  }
  d.unit = unit;
  d.preset = scene.preset->name;
  d.width = scene.width();
  d.height = scene.height();
  d.step = step;
  d.step_voxels = step / scene.voxel_edge;
  d.opacity_unit_distance = scene.opacity_unit_distance;
  scene.camera->GetPosition(d.camera.position.data());
  scene.camera->GetFocalPoint(d.camera.focal_point.data());
  scene.camera->GetViewUp(d.camera.view_up.data());
  d.camera.view_angle = scene.camera->GetViewAngle();
  d.camera.parallel = scene.camera->GetParallelProjection() != 0;
  d.camera.parallel_scale = scene.camera->GetParallelScale();
  d.background = scene.options.background;
  d.shading = property->GetShade() != 0;
  d.interpolation = scene.options.interpolation;
  d.lights = { "headlight, white, intensity 1, with white ambient light" };
  const std::string all = "all mappers";
  d.matched = {
    { "transfer functions", scene.preset->title + " (" + scene.preset->name + ")", all },
    { "opacity unit distance", length(scene.opacity_unit_distance, unit), all },
    { "sample distance", length(step, unit) + " (" + text(d.step_voxels) + " voxel)", all },
    { "interpolation", d.interpolation, all },
    { "blend mode", scene.options.modes.blend_mode, all },
    { "shading", d.shading ? "on" : "off", all },
    { "camera", d.camera.parallel ? "parallel" : "perspective", all },
    { "resolution", std::to_string(d.width) + " x " + std::to_string(d.height), all },
    { "jitter", "off", "vtk-gpu" },
    { "automatic sample distance", "off", all },
    { "what is timed",
      "the ray casting alone, tables and uploads of the warm-up left out; vtk-gpu: the whole frame",
      all },
    { "threads",
      scene.options.threads ? std::to_string(scene.options.threads) : "all processors",
      "raymarch, vtk-fixed-point" },
  };
  return d;
}

/// The mappers that are to be drawn; those that need a display and have none are skipped.
std::vector<MapperName> wanted_mappers(const Options& options)
{
  std::vector<MapperName> wanted;
  for (const std::string& name : options.mappers)
  {
    const MapperName& mapper = find_mapper(name, "--mappers");
    if (std::any_of(wanted.begin(), wanted.end(),
          [&](const MapperName& other) { return other.kind == mapper.kind; }))
    {
      throw Failure("--mappers " + name, "it is named twice", "name each once", BadCall);
    }
    wanted.push_back(mapper);
  }
  return wanted.empty() ? mapper_names() : wanted;
}

void write_outputs(const OutputFolder& folder, const Comparison& comparison,
  const std::map<std::string, Film>& films)
{
  const auto write_bitmap = [&](const std::string& name, const Bitmap& bitmap)
  {
    const std::vector<unsigned char> png = encode_png(bitmap);
    write_atomically(folder.file(name), png.data(), png.size());
  };
  std::vector<ImageErrors> errors;
  for (const ComparisonEntry& entry : comparison.entries)
  {
    if (entry.skipped.empty())
    {
      errors.push_back(entry.against_truth);
    }
  }
  for (const ComparisonEntry& entry : comparison.entries)
  {
    if (!entry.skipped.empty())
    {
      continue;
    }
    write_exr(films.at(entry.mapper), folder.file(entry.mapper + ".exr"),
      { { "brume:input", comparison.scene.input }, { "brume:mapper", entry.mapper } });
    write_bitmap(entry.mapper + ".png", to_bitmap(entry.picture));
    write_bitmap("difference-" + entry.mapper + ".png",
      with_legend(difference_picture(entry.picture, comparison.truth.picture,
        DifferenceKind::Absolute, shared_gain(errors))));
  }
  write_bitmap("truth.png", to_bitmap(comparison.truth.picture));
  write_bitmap("panel.png", panel(comparison));
  write_atomically(folder.file("compare.json"), to_json(comparison));
  write_atomically(folder.file("report.html"), to_html(comparison));
}

void run(const Options& options)
{
  const std::vector<MapperName> wanted = wanted_mappers(options);
  check(options.scene);
  refuse_beyond_stock_mappers(options.scene, "leave it out, or use brume render");
  if (!options.scene.preset.empty())
  {
    find_preset(options.scene.preset);
  }
  const InterruptionWatch watch; // first, so that a folder that is made here goes again
  OutputFolder folder(options.output);
  const VolumeScene scene = make_volume_scene(options.scene);
  const double step = options.scene.sample_distance.value_or(0.5 * scene.voxel_edge);

  Comparison comparison;
  comparison.command_line = options.command_line;
  comparison.scene = describe(scene, step);
  comparison.date = utc_now();
  ComparisonMeasure measure(scene, step, options.repetitions);
  comparison.truth = measure.measure_truth();

  std::optional<PrivateDisplay> display;
  for (const MapperName& mapper : wanted)
  {
    InterruptionWatch::check("compare");
    std::string cannot = not_drawn_by(options.scene.modes, mapper.kind);
    if (cannot.empty() && mapper.kind != MapperKind::RayMarch)
    {
      if (scene.input.sparse)
      {
        cannot = "it would need the volume dense";
      }
      else if (!display)
      {
        display.emplace();
      }
      if (cannot.empty() && display && !display->available())
      {
        cannot = display->reason();
      }
    }
    if (!cannot.empty())
    {
      ComparisonEntry skipped;
      skipped.mapper = mapper.name;
      skipped.title = mapper.title;
      skipped.class_name = mapper.class_name;
      skipped.skipped = cannot;
      comparison.entries.push_back(skipped);
      continue;
    }
    if (options.scene.verbose)
    {
      std::cerr << "brume: " << options.scene.input << ": drawing with " << mapper.name << '\n';
    }
    comparison.entries.push_back(measure.measure(mapper));
  }
  InterruptionWatch::check("compare");

  if (const ComparisonEntry* reference = find_drawn(comparison, comparison.reference_mapper))
  {
    const Picture picture = reference->picture;
    for (ComparisonEntry& entry : comparison.entries)
    {
      if (entry.skipped.empty() && entry.mapper != comparison.reference_mapper)
      {
        entry.against_reference = brume::measure(entry.picture, picture);
      }
    }
  }
  comparison.machine = this_machine(measure.threads(), measure.simd());
  write_outputs(folder, comparison, measure.films());
  folder.keep();
  std::cout << to_text_table({ comparison }) << "report: " << folder.file("report.html") << '\n';
}

}

void add_compare(CLI::App& program)
{
  auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand("compare",
    "Draw a volume with several mappers, time each, and measure each against the truth");
  add_scene_options(*command, options->scene, "off");
  command
    ->add_option("--output,-o", options->output,
      "Folder for panel.png, a picture and a difference of each mapper, compare.json, report.html")
    ->required()
    ->type_name("DIR");
  command
    ->add_option("--mappers", options->mappers,
      "Which, separated by commas: " + list_mapper_names() + " [all]")
    ->delimiter(',')
    ->type_name("M[,M]");
  command
    ->add_option("--repetitions", options->repetitions,
      "Timed renders of each mapper, after one to warm up [5]")
    ->check(number("a whole number from 1 to 1000",
      [](double v) { return v >= 1 && v <= 1000 && v == std::floor(v); }))
    ->type_name("N");
  command->get_option("--sample-distance")
    ->description("Distance between samples for all mappers, in world units [half a voxel]");
  command->footer("Example: brume compare scan.nii.gz --output comparison");
  command->callback(
    [options]
    {
      options->command_line = this_command_line();
      run(*options);
    });
}

}
