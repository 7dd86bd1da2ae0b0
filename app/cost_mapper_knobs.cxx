#include "cost_mapper_knobs.h"

#include "mapper_names.h"
#include "private_display.h"
#include "stock_renderer.h"
#include "stock_scene.h"

#include "vtkBrumeFog.h"
#include "vtkBrumeMedium.h"
#include "vtkBrumePathTraceMapper.h"
#include "vtkBrumeSky.h"
#include "vtkBrumeSmartVolumeMapper.h"
#include "vtkBrumeSparseVolume.h"

#include "vtkCamera.h"
#include "vtkImageData.h"
#include "vtkLightCollection.h"
#include "vtkPolyData.h"
#include "vtkVolume.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <sstream>

namespace brume::app
{

using Json = nlohmann::json;

std::string part(double value)
{
  std::ostringstream out;
  const double inverse = 1.0 / value;
  if (value < 1.0 && std::abs(inverse - std::round(inverse)) < 1e-9)
  {
    out << "1/" << std::lround(inverse);
  }
  else
  {
    out << value;
  }
  return out.str();
}

std::string decimal(double value)
{
  std::ostringstream out;
  out << value;
  return out.str();
}

CostKnob path_knob(CostScene& scene)
{
  CostKnob knob;
  knob.knob = { "paths", "paths",
    "Paths through each pixel of the path tracer: noise, and no other error.", "" };
  knob.has_finest = false;
  knob.knob.skipped = !scene.wants("pathtrace") ? "pathtrace is not among --mappers"
                                                : not_drawn_by_paths(scene.scene());
  if (knob.knob.skipped.empty() && scene.scene().medium && !scene.TruthByPaths)
  {
    knob.knob.skipped = "the truth of this scene holds one scattering alone, and paths hold all";
  }
  if (!knob.knob.skipped.empty())
  {
    return knob;
  }
  for (const int paths : { 1, 4, 16, 64, 256 })
  {
    CostSetting setting;
    setting.point.knob = "paths";
    setting.point.setting = std::to_string(paths);
    setting.point.settings = Json{ { "samples_per_pixel", paths } }.dump();
    setting.point.mapper = "pathtrace";
    setting.point.by_chance = true;
    setting.effort = paths;
    setting.draw = [&scene, paths](const Watch& watch) { return scene.paths().draw(paths, watch); };
    knob.settings.push_back(setting);
  }
  return knob;
}

CostKnob smart_knob(CostScene& scene)
{
  CostKnob knob;
  knob.knob = { "smart", "chosen for",
    "Method and settings chosen by vtkBrumeSmartVolumeMapper for an error of 99.9 % of the pixels, or for a time "
    "(preparations counted).",
    "" };
  knob.has_finest = false;
  knob.knob.skipped = scene.wants("smart") ? not_drawn_by(scene.scene().options.modes, MapperKind::Smart)
                                           : "smart is not among --mappers";
  if (!knob.knob.skipped.empty())
  {
    return knob;
  }
  const auto add = [&](const std::string& words, double tolerance, double seconds)
  {
    CostSetting setting;
    setting.point.knob = "smart";
    setting.point.setting = words;
    setting.point.settings =
      Json{ { "tolerance", tolerance }, { "time_budget", seconds } }.dump();
    setting.point.mapper = "smart";
    setting.point.by_chance = scene.TruthByPaths;
    setting.point.asked_tolerance = tolerance;
    setting.point.asked_seconds = seconds;
    setting.effort = tolerance > 0.0 ? std::sqrt(1.0 / tolerance) : seconds;
    setting.draw = [&scene, tolerance, seconds](const Watch& watch)
    {
      return tolerance > 0.0 ? scene.smart().within(tolerance, watch)
                             : scene.smart().of_time(seconds, watch);
    };
    knob.settings.push_back(setting);
  };
  for (const double seconds : { 0.2, 1.0, 5.0 })
  {
    add(decimal(seconds) + " s", 0.0, seconds);
  }
  for (const double tolerance : study_tolerances)
  {
    add("tolerance " + decimal(tolerance), tolerance, 0.0);
  }
  return knob;
}

CostKnob stock_knob(CostScene& scene)
{
  CostKnob knob;
  knob.knob = { "stock", "VTK",
    "VTK's own mappers on what they know of the scene, by the distance between samples in voxels.", "" };
  knob.has_finest = false;
  const VolumeScene& whole = scene.scene();
  knob.knob.skipped = not_drawn_by_stock(whole.options, whole.input);
  if (knob.knob.skipped.empty() && (scene.wants("vtk-fixed-point") || scene.wants("vtk-gpu")) &&
    !scene.display().available())
  {
    knob.knob.skipped = scene.display().reason();
  }
  if (!knob.knob.skipped.empty())
  {
    return knob;
  }
  for (const MapperName& mapper : mapper_names())
  {
    if (is_own(mapper.kind) || !scene.wants(mapper.name))
    {
      continue;
    }
    const std::string cannot = not_drawn_by(whole.options.modes, mapper.kind);
    const bool fixed = mapper.kind == MapperKind::FixedPoint;
    for (const double step : { 2.0, 1.0, 0.5, 0.25 })
    {
      CostSetting setting;
      setting.point.knob = "stock";
      setting.point.setting =
        std::string(fixed ? "CPU " : "GPU ") + part(step) + (step > 1.0 ? " voxels" : " voxel");
      setting.point.settings = Json{ { "step_in_voxels", step } }.dump();
      setting.point.mapper = mapper.name;
      setting.point.stock = true;
      setting.point.left_out = left_out_by_stock(whole.options);
      setting.point.skipped = cannot;
      setting.effort = 1.0 / step;
      const MapperKind kind = mapper.kind;
      auto renderer = std::make_shared<std::unique_ptr<StockRenderer>>();
      setting.draw = [&scene, step, kind, fixed, renderer](const Watch&)
      {
        if (!*renderer)
        {
          *renderer = std::make_unique<StockRenderer>(
            scene.stock(), kind, step * scene.scene().voxel_edge);
        }
        CostRender render;
        render.seconds = (*renderer)->render();
        if (fixed)
        {
          const Film film = (*renderer)->film();
          render.picture = { film.width, film.height,
            over_scene(film, scene.stock(), scene.stock_surfaces()) };
        }
        else
        {
          render.picture = (*renderer)->picture();
        }
        render.statistics = Json{ { "device", (*renderer)->device() } }.dump();
        return render;
      };
      knob.settings.push_back(setting);
    }
  }
  if (knob.settings.empty())
  {
    knob.knob.skipped = "none of VTK's mappers is among --mappers";
  }
  return knob;
}

}
