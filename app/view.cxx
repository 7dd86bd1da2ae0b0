// brume view: a window on a scene.
#include "command.h"
#include "display_options.h"
#include "interruption.h"
#include "mapper_names.h"
#include "option_checks.h"
#include "output_check.h"
#include "private_display.h"
#include "scene_file.h"
#include "scene_options.h"
#include "stock_renderer.h"

#include "view/recording.h"
#include "view/view_window.h"
#include "view/viewer.h"
#include "view/x_input.h"

#include "atomic_file.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <iostream>
#include <memory>

namespace brume::app
{

namespace
{

struct Options
{
  SceneOptions scene; ///< the viewer reads scene_of()
  DisplayOptions display;
  std::array<int, 2> window{ 1280, 760 };
  std::string mappers;
  std::string arrangement = "side-by-side";
  std::optional<double> scale;
  bool no_panel = false;
  std::string screenshot;
  std::string record;
  std::string play;
  std::string times;
  std::string folder = ".";
};

const std::vector<std::pair<std::string, Arrangement>>& arrangements()
{
  static const std::vector<std::pair<std::string, Arrangement>> all{
    { "side-by-side", Arrangement::SideBySide },
    { "wipe", Arrangement::Wipe },
    { "flicker", Arrangement::Flicker },
    { "difference", Arrangement::Difference },
  };
  return all;
}

Arrangement arrangement_of(const std::string& name)
{
  const auto found = std::find_if(arrangements().begin(), arrangements().end(),
    [&](const auto& entry) { return entry.first == name; });
  return found->second;
}

std::vector<MapperKind> mappers_of(const std::string& names)
{
  std::vector<MapperKind> kinds;
  for (const std::string& name : CLI::detail::split(names, ','))
  {
    kinds.push_back(find_mapper(name, "--mappers").kind);
  }
  if (kinds.empty() || kinds.size() > 4)
  {
    throw Failure("--mappers", "there is room for one to four", "name as many", BadCall);
  }
  return kinds;
}

/// Brume beside the better of VTK's mappers that runs here; Brume alone for what those cannot draw.
std::vector<MapperKind> default_mappers(const SceneOptions& options)
{
  const Triple& e = options.extinction;
  const bool sparse = options.input.size() > 4 &&
    options.input.compare(options.input.size() - 4, 4, ".vdb") == 0;
  if (options.input.empty() || sparse || e[0] != e[1] || e[0] != e[2])
  {
    return { MapperKind::RayMarch };
  }
  return { MapperKind::RayMarch,
    opengl_is_fast() ? MapperKind::Gpu : MapperKind::FixedPoint };
}

void run(const Options& options, CLI::App& command)
{
  const auto start = std::chrono::steady_clock::now();
  const bool alone = !options.screenshot.empty() || !options.play.empty(); // nobody needs to look
  refuse_empty(options.scene);
  check(options.scene);
  const std::vector<MapperKind> named =
    options.mappers.empty() ? std::vector<MapperKind>{} : mappers_of(options.mappers);
  if (!options.screenshot.empty())
  {
    check_output(options.screenshot, options.scene.input);
  }
  if (!alone && !display_opens())
  {
    throw Failure("view", "there is no display for a window (DISPLAY)",
      "start it on a desktop or with ssh -X, or draw without a window: brume render " +
        options.scene.input + " --output picture.png");
  }
  const PrivateDisplay display;
  if (!display.available())
  {
    throw Failure("view", display.reason(), "or draw without a window: brume render");
  }
  const InterruptionWatch watch;
  Viewer::Settings settings;
  settings.mappers = !named.empty() ? named : default_mappers(options.scene);
  settings.arrangement = arrangement_of(options.arrangement);
  settings.scale = options.scale ? *options.scale : scale_of_display();
  settings.panel = !options.no_panel;
  settings.more_keys = ViewWindow::keys();
  nlohmann::ordered_json scene = scene_of(command, options.scene);
  if (options.scene.quiet)
  {
    scene["quiet"] = true;
  }
  settings.window = options.window;
  Viewer viewer(scene, settings);

  ViewWindow::Settings place;
  place.width = options.window[0];
  place.height = options.window[1];
  const std::string& name = viewer.volume_scene().input.name;
  place.title = (name.empty() ? "" : name + " - ") + "Brume";
  place.folder = options.folder;
  place.start = start;
  ViewWindow window(viewer, place);
  if (!options.record.empty())
  {
    window.record(options.record);
  }
  if (!options.play.empty())
  {
    window.play(options.play);
  }
  if (!options.screenshot.empty())
  {
    window.settle();
    InterruptionWatch::check("view");
    window.save_screenshot(options.screenshot);
  }
  if (!alone)
  {
    window.run();
  }
  if (!options.times.empty())
  {
    const nlohmann::ordered_json times = summary_of(window.times());
    write_atomically(options.times, times.dump(2) + "\n");
  }
}

}

void add_view(CLI::App& program)
{
  auto options = std::make_shared<Options>();
  CLI::App* command =
    program.add_subcommand("view", "Look at a volume in a window: turn it, light it, compare mappers");
  add_scene_options(*command, options->scene, "preset");
  command->get_option("INPUT")->required(false);
  add_display_options(*command, options->display);
  const char* group = "Window";
  command
    ->add_option("--mappers", options->mappers,
      "One to four of " + list_mapper_names() +
        " with commas between, a viewport each [raymarch and the better one of VTK's that runs here]")
    ->type_name("M,M")
    ->group(group);
  std::vector<std::string> names;
  for (const auto& entry : arrangements())
  {
    names.push_back(entry.first);
  }
  command
    ->add_option("--arrangement", options->arrangement,
      "How they are compared: " + listed(names) + " [side-by-side]")
    ->check(one_of(names))
    ->type_name("HOW")
    ->group(group);
  command->add_option("--window", options->window, "Size of the window in pixels [1280,760]")
    ->delimiter(',')
    ->type_name("W,H")
    ->check(number("a whole number of pixels from 200 to 16384",
      [](double v) { return v >= 200 && v <= 16384 && v == std::floor(v); }))
    ->group(group);
  command
    ->add_option("--scale", options->scale,
      "Size of lettering and panel, 0.5 to 4; 2 for a display of twice the density [the display's]")
    ->type_name("S")
    ->check(number("a number from 0.5 to 4", [](double v) { return v >= 0.5 && v <= 4.0; }))
    ->group(group);
  command->add_flag("--no-panel", options->no_panel, "Without the panel at first (Tab brings it)")
    ->group(group);
  command
    ->add_option("--folder", options->folder,
      "Where pictures, scenes and recordings are saved [the current folder]")
    ->type_name("DIR")
    ->group(group);
  command
    ->add_option("--screenshot", options->screenshot,
      "Draw until all pictures are finished, write the window to a .png and end; needs no one to look, "
      "and no display of one's own")
    ->type_name("FILE")
    ->group(group);
  command
    ->add_option("--record", options->record,
      "Write what the mouse and keys do to FILE, in the format of vtkInteractorEventRecorder")
    ->type_name("FILE")
    ->group(group);
  command
    ->add_option("--play", options->play,
      "Do what such a FILE says, as fast as pictures are drawn, and end (after --screenshot)")
    ->type_name("FILE")
    ->check(CLI::ExistingFile)
    ->group(group);
  command
    ->add_option("--times", options->times,
      "Write at the end how long the window took to answer, as JSON, to FILE")
    ->type_name("FILE")
    ->group(group);
  command->footer("In the window, ? shows all keys. Example: brume view scan.nii.gz --preset ct-bone");
  command->callback([options, command] { run(*options, *command); });
}

}
