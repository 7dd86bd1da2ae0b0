// brume cost: one scene along every knob that trades accuracy for time.
#include "command.h"
#include "cost_measure.h"
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
#include "study_clock.h"
#include "volume_scene.h"

#include "Analysis/study.h"
#include "Analysis/study_chart.h"
#include "Analysis/study_json.h"
#include "Analysis/study_report.h"
#include "Analysis/study_words.h"

#include "atomic_file.h"

#include "vtkBrumeFog.h"
#include "vtkBrumeMedium.h"
#include "vtkBrumeSky.h"
#include "vtkBrumeSparseVolume.h"

#include "vtkCamera.h"
#include "vtkImageData.h"
#include "vtkLightCollection.h"
#include "vtkPolyData.h"
#include "vtkRenderingContext2DModule.h" // so that charts have their OpenGL classes
#include "vtkVolume.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
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
  CostRequest request;
  std::vector<std::string> mappers;
  std::string output;
  std::string command_line;
};

std::string joined(const std::vector<std::string>& names)
{
  std::string list;
  for (const std::string& name : names)
  {
    list += (list.empty() ? "" : ", ") + name;
  }
  return list;
}

/// Throws Failure for a name that is not there or is given twice.
void check_names(const Options& options)
{
  const auto twice = [](const std::vector<std::string>& names, const std::string& option)
  {
    for (std::size_t i = 0; i < names.size(); ++i)
    {
      if (std::find(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(i), names[i]) !=
        names.begin() + static_cast<std::ptrdiff_t>(i))
      {
        throw Failure(option + " " + names[i], "it is named twice", "name each once", BadCall);
      }
    }
  };
  for (const std::string& name : options.mappers)
  {
    find_mapper(name, "--mappers");
  }
  twice(options.mappers, "--mappers");
  for (const std::string& name : options.request.knobs)
  {
    if (std::find(knob_names().begin(), knob_names().end(), name) == knob_names().end())
    {
      throw Failure("--knobs " + name, "there is no such knob",
        "take one of " + joined(knob_names()), BadCall);
    }
  }
  twice(options.request.knobs, "--knobs");
  if (options.scene.paths.seconds)
  {
    throw Failure("--time-budget", "a study has a time of its own", "take --study-seconds", BadCall);
  }
}

double load_of_machine()
{
  double load[1] = { 0.0 };
  return getloadavg(load, 1) == 1 ? load[0] : 0.0;
}

void run(const Options& options)
{
  check_names(options);
  check(options.scene);
  if (!options.scene.preset.empty())
  {
    find_preset(options.scene.preset);
  }
  const InterruptionWatch watch; // first, so that a folder that is made here goes again
  OutputFolder folder(options.output, "cost.json");
  StudyClock clock(options.request.seconds, !options.scene.quiet);
  Study study;
  study.load = load_of_machine();
  const VolumeScene scene = make_volume_scene(options.scene);
  study.scene = describe(scene, 0.0);
  study.command_line = options.command_line;
  study.date = utc_now();
  study.exposure = options.display.exposure;
  study.display_curve =
    options.display.curve == "srgb" ? DisplayCurve::Srgb : DisplayCurve::Identity;
  study.seconds_asked = options.request.seconds;
  CostScene of_cost(scene);
  of_cost.Mappers = options.mappers;
  CostMeasure measure(of_cost, options.request, clock, study);
  measure.measure_truth();
  measure.measure_settings();
  InterruptionWatch::check("cost");
  study.machine = this_machine(of_cost.march().threads(), of_cost.march().simd());
  study.seconds = clock.elapsed();
  std::optional<Bitmap> chart;
  if (of_cost.display().available())
  {
    chart = study_chart(study);
    const std::vector<unsigned char> png = encode_png(*chart);
    write_atomically(folder.file("cost.png"), png.data(), png.size());
  }
  else
  {
    std::cerr << "brume: " << folder.file("cost.png") << ": it is left out, as "
              << of_cost.display().reason() << '\n';
  }
  write_atomically(folder.file("cost.csv"), to_csv(study));
  write_atomically(folder.file("cost.json"), to_json(study));
  write_atomically(folder.file("report.html"), to_html(study, chart ? &*chart : nullptr));
  folder.keep();
  for (const std::string& words : study_words(study))
  {
    std::cout << words << '\n';
  }
  std::cout << "report: " << folder.file("report.html") << '\n';
}

}

void add_cost(CLI::App& program)
{
  auto options = std::make_shared<Options>();
  options->scene.resolution = { 256, 256 };
  CLI::App* command = program.add_subcommand("cost",
    "What accuracy costs in time: a scene along every knob that trades one for the other");
  add_scene_options(*command, options->scene, "off");
  add_display_options(*command, options->display);
  command
    ->add_option("--output,-o", options->output,
      "Folder for cost.csv, cost.json, cost.png and report.html")
    ->required()
    ->type_name("DIR");
  command
    ->add_option("--knobs", options->request.knobs,
      "Which, separated by commas: " + joined(knob_names()) + " [all]")
    ->delimiter(',')
    ->type_name("K[,K]");
  command
    ->add_option("--mappers", options->mappers,
      "Which may take part, separated by commas: " + list_mapper_names() + " [all]")
    ->delimiter(',')
    ->type_name("M[,M]");
  command
    ->add_option("--repetitions", options->request.repetitions,
      "Timed renders of each setting, at the most, after one to warm up [3]")
    ->check(number("a whole number from 1 to 1000",
      [](double v) { return v >= 1 && v <= 1000 && v == std::floor(v); }))
    ->type_name("N");
  command
    ->add_option("--study-seconds", options->request.seconds,
      "What the study may take; what there is no time for is left out and named [240]")
    ->check(number("a number greater than 0", [](double v) { return v > 0.0 && v <= 1e9; }))
    ->type_name("SECONDS");
  command->get_option("--resolution")->description("Size of the picture in pixels [256,256]");
  command->get_option("--sample-distance")
    ->description("Distance between samples while other knobs are turned, in world units [half a voxel]");
  command->get_option("--samples-per-pixel")
    ->description("Paths through each pixel of a truth that is traced, at the most [as many as there is time for]");
  command->footer("Example: brume cost sample:cloud --output cost");
  command->callback(
    [options]
    {
      options->command_line = this_command_line();
      run(*options);
    });
}

}
