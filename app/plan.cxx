// brume plan: which effects a picture would simulate, why, and how wrong it is without the others.
#include "command.h"
#include "interruption.h"
#include "mesh_scene.h"
#include "output_check.h"
#include "presets.h"
#include "scene_options.h"
#include "volume_scene.h"

#include "atomic_file.h"

#include "Transport/effect_plan.h"
#include "Transport/effects.h"
#include "Transport/fog.h"
#include "Transport/marcher.h"

#include "vtkBrumeEffectPlan.h"
#include "vtkBrumeRayMarchMapper.h"

#include "vtkCallbackCommand.h"
#include "vtkCamera.h"
#include "vtkCommand.h"
#include "vtkLightCollection.h"
#include "vtkNew.h"
#include "vtkVolume.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <iomanip>
#include <iostream>
#include <memory>
#include <sstream>

namespace brume::app
{

namespace
{

struct Options
{
  SceneOptions scene;
  std::string json;
};

EffectPlan make_plan(const VolumeScene& scene)
{
  vtkNew<vtkBrumeRayMarchMapper> mapper;
  std::string error;
  vtkNew<vtkCallbackCommand> ear; // in place of the standard error stream
  ear->SetClientData(&error);
  ear->SetCallback([](vtkObject*, unsigned long, void* data, void* text)
    { *static_cast<std::string*>(data) = static_cast<const char*>(text); });
  mapper->AddObserver(vtkCommand::ErrorEvent, ear);
  set_up(scene, mapper);
  mapper->SetSurfaceDepth(draw_meshes(scene).depth);
  const Scene* plain = mapper->UpdateScene(
    scene.volume, scene.camera, scene.lights, scene.width(), scene.height());
  if (!plain)
  {
    throw Failure(scene.options.input, "it cannot be drawn", words_of_vtk(error));
  }
  // As the mapper does: of pictures that VTK draws too, nothing that changes a pixel is left out.
  const bool lit = has_fog(*plain) || std::any_of(plain->volumes.begin(), plain->volumes.end(),
                                        [](const Volume& v) { return v.medium.lit; });
  Marcher marcher;
  const EffectPlan plan = plan_effects(marcher, *plain, lit ? scene.options.tolerance : 0.0,
    mapper->GetEffectPlan()->GetForces(), scene.options.threads);
  InterruptionWatch::check(scene.options.input.c_str());
  return plan;
}

std::string bound_text(const PlannedEffect& effect)
{
  if (effect.error_bound == 0.0)
  {
    return "0";
  }
  std::ostringstream out;
  out << std::setprecision(2) << effect.error_bound;
  return out.str();
}

/// What an effect that is on costs, as a part of a picture by emission and absorption; empty where it
/// is off or costs nothing of its own.
std::string cost_text(const PlannedEffect& effect)
{
  const double cost = effect_cost(effect.effect);
  if (!effect.on || cost == 0.0)
  {
    return "-";
  }
  std::ostringstream out;
  out << std::fixed << std::setprecision(2) << cost;
  return out.str();
}

/// A table for people: an effect a line, the reason last.
std::string table(const EffectPlan& plan, double tolerance)
{
  std::ostringstream out;
  const auto line = [&](const std::string& name, const std::string& state, const std::string& bound,
                      const std::string& cost, const std::string& reason)
  {
    out << std::left << std::setw(21) << name << std::setw(13) << state << std::setw(10) << bound
        << std::setw(6) << cost << reason << '\n';
  };
  line("effect", "simulated", "error", "cost", "reason");
  for (const PlannedEffect& effect : plan.effects)
  {
    line(effect_name(effect.effect),
      std::string(effect.on ? "yes" : "no") + (effect.forced ? ", forced" : ""), bound_text(effect),
      cost_text(effect), effect.reason);
  }
  out << std::setprecision(2) << "What is left out changes a pixel by " << plan.error_bound()
      << " of white at the most; tolerance " << tolerance
      << ".\nThe picture is expected to take " << plan.expected_cost()
      << " times as long as by emission and absorption with the same steps.\n";
  return out.str();
}

nlohmann::ordered_json to_json(const EffectPlan& plan, const VolumeScene& scene)
{
  nlohmann::ordered_json effects = nlohmann::ordered_json::array();
  for (const PlannedEffect& effect : plan.effects)
  {
    effects.push_back({ { "name", effect_name(effect.effect) }, { "on", effect.on },
      { "forced", effect.forced }, { "reason", effect.reason },
      { "error_bound", effect.error_bound },
      { "cost", effect.on ? effect_cost(effect.effect) : 0.0 } });
  }
  return { { "format", "brume-plan" }, { "version", 1 }, { "input", scene.options.input },
    { "tolerance", scene.options.tolerance }, { "error_bound", plan.error_bound() },
    { "expected_cost", plan.expected_cost() }, { "effects", effects } };
}

void run(const Options& options)
{
  check(options.scene);
  if (!options.scene.preset.empty())
  {
    find_preset(options.scene.preset);
  }
  refuse_paths(options.scene, "leave it out");
  check_output(options.json, options.scene.input);
  const InterruptionWatch watch;
  const VolumeScene scene = make_volume_scene(options.scene);
  const EffectPlan plan = make_plan(scene);
  if (!options.json.empty())
  {
    write_atomically(options.json, to_json(plan, scene).dump(2) + "\n");
  }
  std::cout << table(plan, scene.options.tolerance);
}

}

void add_plan(CLI::App& program)
{
  auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand("plan",
    "Tell which effects a picture would simulate, why, and how wrong it is without the others");
  add_scene_options(*command, options->scene, "preset");
  command->add_option("--json", options->json, "Write the plan as JSON to FILE, too")
    ->type_name("FILE");
  command->get_option("--sample-distance")
    ->description("Fixed distance between samples, in world units; the plan does not depend on it");
  command->footer("Example: brume plan sample:cloud --extinction 0.05 --sun-direction 1,0,1");
  command->callback([options] { run(*options); });
}

}
