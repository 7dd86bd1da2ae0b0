// brume render: one picture of one volume.
#include "command.h"
#include "display_options.h"
#include "interruption.h"
#include "machine.h"
#include "mapper_names.h"
#include "mesh_scene.h"
#include "option_checks.h"
#include "output_check.h"
#include "presets.h"
#include "private_display.h"
#include "progress.h"
#include "scene_options.h"
#include "stock_renderer.h"
#include "volume_scene.h"

#include "atomic_file.h"
#include "film_io.h"
#include "Transport/film.h"

#include "vtkBrumeFog.h"
#include "vtkBrumePathTraceMapper.h"
#include "vtkBrumeRayMarchMapper.h"
#include "vtkBrumeSmartVolumeMapper.h"
#include "vtkBrumeSparseVolume.h"

#include "vtkCallbackCommand.h"
#include "vtkCamera.h"
#include "vtkCommand.h"
#include "vtkImageData.h"
#include "vtkLightCollection.h"
#include "vtkNew.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <sstream>
#include <memory>
#include <thread>

namespace brume::app
{

namespace
{

struct Options
{
  SceneOptions scene;
  std::string output;
  std::string mapper; ///< empty: by what is asked for
  std::string stats;
  DisplayOptions display;
};

bool ends_with(const std::string& path, const std::string& ending)
{
  return path.size() > ending.size() &&
    CLI::detail::to_lower(path.substr(path.size() - ending.size())) == ending;
}

/// An error in words.
std::string describe(double error)
{
  std::ostringstream words;
  words << error << " of white";
  return words.str();
}

struct Drawn
{
  Film film;
  SurfacePicture surfaces; ///< behind the volume
  std::string statistics; ///< JSON
};

/// By one of Brume's own mappers.
template <class Mapper>
Drawn draw_own(const VolumeScene& scene)
{
  vtkNew<Mapper> mapper;
  set_up(scene, mapper);
  Drawn drawn;
  drawn.surfaces = draw_meshes(scene);
  mapper->SetSurfaceDepth(drawn.surfaces.depth);

  struct Watch
  {
    ProgressBar bar;
    std::string error;
  } watch{ ProgressBar("rendering", !scene.options.quiet), {} };
  vtkNew<vtkCallbackCommand> observer;
  observer->SetClientData(&watch);
  observer->SetCallback(
    [](vtkObject* caller, unsigned long event, void* data, void* text)
    {
      auto& w = *static_cast<Watch*>(data);
      auto* algorithm = static_cast<vtkAlgorithm*>(caller);
      if (event == vtkCommand::ErrorEvent)
      {
        w.error = static_cast<const char*>(text);
        return;
      }
      w.bar.update(algorithm->GetProgress());
      if (InterruptionWatch::requested())
      {
        algorithm->AbortExecuteOn();
      }
    });
  mapper->AddObserver(vtkCommand::ProgressEvent, observer);
  mapper->AddObserver(vtkCommand::ErrorEvent, observer);
  drawn.film = Film(scene.width(), scene.height());
  const bool completed =
    mapper->RenderFilm(scene.volume, scene.camera, scene.lights, drawn.film);
  watch.bar.clear();
  InterruptionWatch::check(scene.options.input.c_str());
  if (!completed)
  {
    throw Failure(scene.options.input, "it cannot be drawn", watch.error);
  }
  drawn.statistics = mapper->GetStatistics();
  return drawn;
}

/// An effect as the statistics name it. How far VTK's mappers are off is not known beforehand.
nlohmann::json effect(const char* name, bool on, const char* reason)
{
  return { { "name", name }, { "on", on }, { "reason", reason }, { "error_bound", nullptr } };
}

/// Surfaces in fog, without a volume.
Drawn draw_fog(const VolumeScene& scene)
{
  fit_clipping_range(scene);
  Drawn drawn;
  drawn.surfaces = draw_meshes(scene);
  drawn.film = Film(scene.width(), scene.height());
  scene.fog->SetNumberOfThreads(scene.options.threads);
  std::string error;
  vtkNew<vtkCallbackCommand> ear;
  ear->SetClientData(&error);
  ear->SetCallback([](vtkObject*, unsigned long, void* data, void* text)
    { *static_cast<std::string*>(data) = static_cast<const char*>(text); });
  scene.fog->AddObserver(vtkCommand::ErrorEvent, ear);
  const auto start = std::chrono::steady_clock::now();
  if (!scene.fog->RenderFilm(scene.camera, scene.lights, drawn.film, drawn.surfaces.depth))
  {
    throw Failure("--fog-extinction", "the fog cannot be drawn", words_of_vtk(error));
  }
  nlohmann::json statistics;
  statistics["mapper"] = "fog";
  statistics["seconds"] =
    std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  statistics["seconds_prepare"] = 0.0;
  statistics["samples"] = 0; // the fog comes in closed form
  statistics["rays"] = drawn.film.size();
  statistics["threads"] = scene.options.threads > 0
    ? scene.options.threads
    : static_cast<int>(std::thread::hardware_concurrency());
  statistics["simd"] = "none";
  nlohmann::json fog = effect("fog", true, "the scene has fog; no volume was named");
  fog["error_bound"] = 0.0;
  statistics["effects"] = { fog };
  statistics["non_finite_voxels"] = 0;
  statistics["radiometric"] = true;
  statistics["peak_memory_bytes"] = peak_memory_bytes();
  drawn.statistics = statistics.dump(2);
  return drawn;
}

Drawn draw_stock(const VolumeScene& scene, const MapperName& mapper)
{
  if (scene.input.sparse)
  {
    throw Failure("--mapper " + std::string(mapper.name),
      "VTK's own mappers would need " + scene.options.input + " dense", "take --mapper raymarch");
  }
  const PrivateDisplay display;
  if (!display.available())
  {
    throw Failure("--mapper " + std::string(mapper.name), display.reason(),
      "or take --mapper raymarch, which needs no display");
  }
  // What VTK's own mappers take by default when nobody tells them: half a voxel here, as compare.
  const double step = scene.options.sample_distance.value_or(0.5 * scene.voxel_edge);
  fit_clipping_range(scene);
  StockRenderer renderer(scene, mapper.kind, step);
  Drawn drawn;
  // The first render also builds tables and uploads textures.
  const double first = renderer.render();
  const double seconds = renderer.render();
  const bool shaded = scene.volume->GetProperty()->GetShade() != 0;
  const nlohmann::json not_told = nullptr; // VTK's mappers do not count these
  nlohmann::json statistics;
  statistics["mapper"] = mapper.name;
  statistics["seconds"] = seconds;
  statistics["seconds_prepare"] = std::max(0.0, first - seconds);
  statistics["samples"] = not_told;
  statistics["rays"] = not_told;
  statistics["threads"] = renderer.threads();
  statistics["simd"] = not_told;
  statistics["effects"] = { effect("absorption", true, "VTK's composite mode"),
    effect("emission", true, "VTK's composite mode"),
    effect("scattering", false, "VTK's composite mode has none"),
    effect("gradient shading", shaded,
      shaded ? "vtkVolumeProperty::Shade is on; not a physical term"
             : "vtkVolumeProperty::Shade is off") };
  statistics["non_finite_voxels"] = not_told;
  statistics["step"] = step;
  statistics["step_chosen_by"] = scene.options.sample_distance ? "caller" : "half a voxel";
  statistics["device"] = renderer.device();
  statistics["radiometric"] = false;
  statistics["peak_memory_bytes"] = peak_memory_bytes();
  drawn.statistics = statistics.dump(2);
  drawn.film = renderer.film();
  return drawn;
}

void run(const Options& options)
{
  if (options.output.empty())
  {
    throw Failure("--output", "it names no file", "name one that ends in .png, .exr or .hdr", BadCall);
  }
  try
  {
    check_picture_path(options.output);
  }
  catch (const std::runtime_error& error)
  {
    throw Failure(error.what(), BadCall);
  }
  if (!ends_with(options.output, ".png") && options.display.changes_light())
  {
    throw Failure(options.display.exposure != 0.0 ? "--exposure" : "--display-curve",
      "EXR and HDR hold linear light as it is", "leave it out, or write a .png", BadCall);
  }
  const bool smart = asks_for_smart(options.scene) && !options.scene.input.empty();
  const MapperName& mapper = find_mapper(
    !options.mapper.empty() ? options.mapper : smart ? "smart" : "raymarch", "--mapper");
  check(options.scene);
  const std::string cannot = not_drawn_by(options.scene.modes, mapper.kind);
  if (!cannot.empty())
  {
    throw Failure("--mapper " + std::string(mapper.name), cannot, "take --mapper raymarch", BadCall);
  }
  if (mapper.kind == MapperKind::PathTrace)
  {
    refuse_beyond_paths(options.scene);
  }
  else if (mapper.kind == MapperKind::Smart)
  {
    refuse_beyond_smart(options.scene);
  }
  else
  {
    refuse_paths(options.scene, "add --mapper pathtrace, or leave it out");
  }
  if (!is_own(mapper.kind))
  {
    refuse_beyond_stock_mappers(options.scene, "take --mapper raymarch, or leave it out");
  }
  refuse_empty(options.scene);
  if (!options.scene.preset.empty())
  {
    find_preset(options.scene.preset);
  }
  check_output(options.output, options.scene.input);
  check_output(options.stats, options.scene.input, { options.output });
  const InterruptionWatch watch;
  const VolumeScene scene = make_volume_scene(options.scene);
  const Drawn drawn = !scene.volume        ? draw_fog(scene)
    : mapper.kind == MapperKind::RayMarch  ? draw_own<vtkBrumeRayMarchMapper>(scene)
    : mapper.kind == MapperKind::PathTrace ? draw_own<vtkBrumePathTraceMapper>(scene)
    : mapper.kind == MapperKind::Smart     ? draw_own<vtkBrumeSmartVolumeMapper>(scene)
                                           : draw_stock(scene, mapper);
  InterruptionWatch::check(options.scene.input.c_str());

  nlohmann::json statistics = nlohmann::json::parse(drawn.statistics);
  statistics["exposure"] = options.display.exposure;
  statistics["display_curve"] = options.display.curve;
  const Film& film = drawn.film;
  if (ends_with(options.output, ".exr"))
  {
    write_exr(film, options.output,
      { { "brume:input", options.scene.input }, { "brume:mapper", mapper.name },
        { "brume:preset", options.scene.preset } });
  }
  else
  {
    const std::vector<float> picture = over_scene(film, scene, drawn.surfaces);
    if (ends_with(options.output, ".hdr"))
    {
      write_hdr(picture, film.width, film.height, options.output);
    }
    else
    {
      write_png(picture, film.width, film.height, options.output, options.display.display());
    }
  }
  if (!options.stats.empty())
  {
    write_atomically(options.stats, statistics.dump(2) + "\n");
  }
  if (!options.scene.quiet)
  {
    const nlohmann::json& count = statistics["non_finite_voxels"];
    const std::size_t voxels = count.is_null() ? 0 : count.get<std::size_t>();
    if (voxels > 0)
    {
      std::cerr << "brume: " << options.scene.input << ": " << voxels
                << " voxels are not finite and are drawn as empty\n";
    }
    const bool asked = mapper.kind != MapperKind::Smart || options.scene.tolerance_choice.has_value();
    if (asked && !statistics.value("tolerance_met", true))
    {
      const nlohmann::json& error = statistics["estimated_error"];
      const char* const remedy = mapper.kind == MapperKind::PathTrace ? "give more --samples-per-pixel"
        : mapper.kind == MapperKind::RayMarch                         ? "give a smaller --sample-distance"
        : options.scene.paths.seconds ? "give a longer --time-budget"
                                      : "see what --verbose tells of the method";
      std::cerr << "brume: " << options.scene.input << ": the estimated error, "
                << (error.is_null() ? "not known yet" : describe(error.get<double>()))
                << ", is over the tolerance: " << remedy << ", or a larger --tolerance\n";
    }
  }
  if (options.scene.verbose)
  {
    std::cerr << statistics.dump(2) << '\n';
  }
}

}

void add_render(CLI::App& program)
{
  auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand(
    "render", "Draw one picture of a volume; needs no window and no display");
  add_scene_options(*command, options->scene, "preset");
  command->get_option("INPUT")->required(false);
  command
    ->add_option("--output,-o", options->output,
      "The picture: .png as a screen shows it, .exr with linear radiance, transmittance and "
      "depth, or .hdr with linear light over the background")
    ->required()
    ->type_name("FILE");
  command
    ->add_option("--mapper", options->mapper,
      "What draws it: " + list_mapper_names() + " [raymarch; smart where --tolerance or --time-budget is "
      "given]")
    ->type_name("M");
  add_display_options(*command, options->display);
  command->add_option("--stats", options->stats, "Write what it took, as JSON, to FILE")
    ->type_name("FILE");
  command->get_option("--sample-distance")
    ->description("Fixed distance between samples, in world units [chosen by the tolerance]");
  command->footer("Example: brume render scan.nii.gz --output scan.png --preset ct-bone");
  command->callback([options] { run(*options); });
}

}
