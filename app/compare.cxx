// brume compare: the same scene by several mappers, timed and measured against the truth.
#include "command.h"
#include "compare_measure.h"
#include "display_options.h"
#include "interruption.h"
#include "machine.h"
#include "mapper_names.h"
#include "option_checks.h"
#include "output_folder.h"
#include "presets.h"
#include "private_display.h"
#include "scene_description.h"
#include "scene_options.h"
#include "stock_scene.h"
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

#include "vtkBrumeSparseVolume.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <optional>

namespace brume::app
{

namespace
{

struct Options
{
  SceneOptions scene;
  DisplayOptions display;
  std::string output;
  std::vector<std::string> mappers;
  int repetitions = 5;
  std::string command_line;
};

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
    if (mapper.kind == MapperKind::Smart)
    {
      throw Failure("--mappers " + name, "compare does not measure it yet",
        "draw it with brume render --mapper " + name, BadCall);
    }
    wanted.push_back(mapper);
  }
  for (const MapperName& mapper : mapper_names())
  {
    if (options.mappers.empty() && mapper.kind != MapperKind::PathTrace &&
      mapper.kind != MapperKind::Smart)
    {
      wanted.push_back(mapper);
    }
  }
  return wanted;
}

void write_outputs(const OutputFolder& folder, const Comparison& comparison,
  const std::map<std::string, Film>& films)
{
  const auto write_bitmap = [&](const std::string& name, const Bitmap& bitmap)
  {
    const std::vector<unsigned char> png = encode_png(bitmap);
    write_atomically(folder.file(name), png.data(), png.size());
  };
  const auto shown = [&](const Picture& picture)
  { return to_bitmap(picture, comparison.display_curve, comparison.exposure); };
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
    write_bitmap(entry.mapper + ".png", shown(entry.picture));
    write_bitmap("difference-" + entry.mapper + ".png",
      with_legend(difference_picture(entry.picture, comparison.truth.picture,
        DifferenceKind::Absolute, shared_gain(errors))));
  }
  write_bitmap("truth.png", shown(comparison.truth.picture));
  write_bitmap("panel.png", panel(comparison));
  write_atomically(folder.file("compare.json"), to_json(comparison));
  write_atomically(folder.file("report.html"), to_html(comparison));
}

void run(const Options& options)
{
  const std::vector<MapperName> wanted = wanted_mappers(options);
  check(options.scene);
  const bool paths = std::any_of(wanted.begin(), wanted.end(),
    [](const MapperName& mapper) { return mapper.kind == MapperKind::PathTrace; });
  if (!paths)
  {
    refuse_paths(options.scene, "add pathtrace to --mappers, or leave it out");
  }
  if (!options.scene.preset.empty())
  {
    find_preset(options.scene.preset);
  }
  const InterruptionWatch watch; // first, so that a folder that is made here goes again
  OutputFolder folder(options.output, "compare.json");
  const VolumeScene scene = make_volume_scene(options.scene);
  const double step = options.scene.sample_distance.value_or(0.5 * scene.voxel_edge);

  Comparison comparison;
  comparison.command_line = options.command_line;
  comparison.scene = describe(scene, step);
  comparison.date = utc_now();
  comparison.exposure = options.display.exposure;
  comparison.display_curve =
    options.display.curve == "srgb" ? DisplayCurve::Srgb : DisplayCurve::Identity;
  ComparisonMeasure measure(scene, step, options.repetitions,
    paths && not_drawn_by(options.scene.modes, MapperKind::PathTrace).empty());
  comparison.truth = measure.measure_truth();

  std::optional<PrivateDisplay> display;
  for (const MapperName& mapper : wanted)
  {
    InterruptionWatch::check("compare");
    std::string cannot = not_drawn_by(options.scene.modes, mapper.kind);
    if (cannot.empty() && !is_own(mapper.kind))
    {
      cannot = not_drawn_by_stock(options.scene, scene.input);
      if (cannot.empty() && !display)
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
  add_display_options(*command, options->display);
  command
    ->add_option("--output,-o", options->output,
      "Folder for panel.png, a picture and a difference of each mapper, compare.json, report.html")
    ->required()
    ->type_name("DIR");
  command
    ->add_option("--mappers", options->mappers,
      "Which, separated by commas: raymarch, vtk-fixed-point, vtk-gpu, pathtrace [all but pathtrace]")
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
