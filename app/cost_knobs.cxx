#include "cost_knobs.h"
#include "cost_mapper_knobs.h"

#include "Analysis/image_filters.h"

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

#include <algorithm>

namespace brume::app
{

namespace
{

using Json = nlohmann::json;

CostSetting march_setting(const std::string& knob,
  const std::string& words,
  double effort,
  CostMarch& march,
  const MarchChoice& choice)
{
  CostSetting setting;
  setting.point.knob = knob;
  setting.point.setting = words;
  setting.point.settings = march.settings(choice);
  setting.point.mapper = "raymarch";
  setting.effort = effort;
  setting.draw = [&march, choice](const Watch& watch) { return march.draw(choice, watch); };
  return setting;
}

/// A picture of fewer pixels, brought to the study's size.
CostSetting smaller_setting(const std::string& knob,
  const std::string& words,
  double effort,
  CostScene& scene,
  int divisor,
  const MarchChoice& choice)
{
  CostMarch& march = scene.smaller(divisor);
  CostSetting setting = march_setting(knob, words, effort, march, choice);
  const int width = scene.scene().width();
  const int height = scene.scene().height();
  setting.draw = [&march, choice, width, height](const Watch& watch)
  {
    CostRender render = march.draw(choice, watch);
    render.picture = scaled(render.picture, width, height);
    return render;
  };
  return setting;
}

bool is_lit(const CostScene& scene)
{
  return scene.scene().medium != nullptr;
}

CostKnob step_knob(CostScene& scene)
{
  CostKnob knob;
  knob.knob = { "step", "step",
    "The rule and the length of steps along rays, in voxels; shadows, octaves and all else stand still.",
    "" };
  CostMarch& march = scene.march();
  MarchChoice choice = march.standard();
  const auto add = [&](StepRule rule, const std::vector<double>& steps, double effort)
  {
    choice.rule = rule;
    for (const double step : steps)
    {
      choice.step = step;
      knob.settings.push_back(march_setting("step",
        std::string(step_rule_name(rule)) + " " + part(step) + (step > 1.0 ? " voxels" : " voxel"),
        effort / step, march, choice));
    }
  };
  add(StepRule::Midpoint, { 4.0, 2.0, 1.0, 0.5, 0.25, 0.125 }, 1.0);
  if (march.follows(StepRule::Integrated))
  {
    add(StepRule::Integrated, { 4.0, 2.0, 1.0, 0.5 }, 1.5);
  }
  if (march.follows(StepRule::Cells))
  {
    add(StepRule::Cells, { 4.0, 1.0 }, 1.5);
  }
  return knob;
}

CostKnob tolerance_knob(CostScene& scene)
{
  CostKnob knob;
  knob.knob = { "tolerance", "tolerance",
    "The ray march chooses steps and shadows, and leaves effects out, by the tolerance.", "" };
  MarchChoice choice = scene.march().standard();
  choice.automatic = true;
  double effort = 1.0;
  for (const double tolerance : { 0.064, 0.016, 0.004, 0.001 })
  {
    choice.tolerance = tolerance;
    knob.settings.push_back(
      march_setting("tolerance", decimal(tolerance), effort, scene.march(), choice));
    effort *= 2.0;
  }
  return knob;
}

CostKnob voxel_knob(CostScene& scene)
{
  CostKnob knob;
  knob.knob = { "precision", "voxels",
    "What a voxel is stored in; steps and all else stand still. Integers are spread over the range of the "
    "values.",
    "" };
  std::string reasons;
  for (const VoxelStore store :
    { VoxelStore::UInt8, VoxelStore::UInt16, VoxelStore::Half, VoxelStore::Float })
  {
    std::string reason;
    if (CostMarch* march = scene.stored(store, reason))
    {
      CostSetting setting =
        march_setting("precision", voxel_store_name(store), 1.0, *march, march->standard());
      Json settings = Json::parse(setting.point.settings);
      settings["voxels"] = voxel_store_name(store);
      setting.point.settings = settings.dump();
      knob.settings.push_back(setting);
      continue;
    }
    CostSetting skipped;
    skipped.point.knob = "precision";
    skipped.point.setting = voxel_store_name(store);
    skipped.point.mapper = "raymarch";
    skipped.point.skipped = reason;
    knob.settings.push_back(skipped);
  }
  CostSetting given = march_setting("precision", "as given", 1.0, scene.march(), scene.march().standard());
  knob.settings.push_back(given);
  return knob;
}

CostKnob shadow_knob(CostScene& scene)
{
  CostKnob knob;
  knob.knob = { "shadows", "shadows",
    "How light that reaches a place is found to be dimmed, and the distance between the nodes of a volume or a "
    "map, or the step of a ray, in voxels; steps, octaves and all else stand still.",
    "" };
  if (!is_lit(scene))
  {
    knob.knob.skipped = "the scene has no medium that light shines on";
    return knob;
  }
  CostMarch& march = scene.march();
  MarchChoice choice = march.standard();
  const auto add = [&](const char* words, int method, const std::vector<double>& steps, double effort)
  {
    choice.shadows = method;
    for (const double step : steps)
    {
      choice.shadow_step = step;
      const std::string length = step > 0.0 ? " " + part(step) + (step > 1.0 ? " voxels" : " voxel") : "";
      knob.settings.push_back(march_setting("shadows", words + length, effort, march, choice));
    }
  };
  add("none", vtkBrumeRayMarchMapper::NoShadows, { 0.0 }, 1.0);
  add("functions", vtkBrumeRayMarchMapper::FunctionShadows, { 4.0, 1.0 }, 2.0);
  add("volume", vtkBrumeRayMarchMapper::VolumeShadows, { 8.0, 4.0, 2.0, 1.0, 0.5 }, 2.0);
  add("rays", vtkBrumeRayMarchMapper::RayShadows, { 8.0 }, 15.0);
  add("rays", vtkBrumeRayMarchMapper::RayShadows, { 2.0 }, 40.0);
  add("rays, exact", vtkBrumeRayMarchMapper::RayShadows, { 0.0 }, 80.0);
  return knob;
}

CostKnob octave_knob(CostScene& scene)
{
  CostKnob knob;
  knob.knob = { "octaves", "octaves",
    "Light scattered more than once, approximated by octaves of single scattering; steps, shadows and all "
    "else stand still.",
    "" };
  knob.has_finest = false; // more of them are not nearer to the truth
  if (!scene.TruthByPaths)
  {
    knob.knob.skipped = is_lit(scene)
      ? "the truth of this scene holds one scattering alone"
      : "the scene has no medium that light shines on";
    return knob;
  }
  MarchChoice choice = scene.march().standard();
  for (const int octaves : { 1, 2, 3, 4, 6, 8 })
  {
    choice.octaves = octaves;
    knob.settings.push_back(
      march_setting("octaves", std::to_string(octaves), 1.0 + 0.3 * octaves, scene.march(), choice));
  }
  return knob;
}

CostKnob ambient_knob(CostScene& scene)
{
  CostKnob knob;
  knob.knob = { "ambient", "ambient light",
    "Light of the sky and of an environment; steps, shadows and all else stand still.", "" };
  const MediumOptions& medium = scene.scene().options.medium;
  const Triple none{ 0.0, 0.0, 0.0 };
  const bool sky = medium.sky_radiance != none || medium.ground_radiance != none;
  if (!is_lit(scene) || (!sky && medium.environment.empty()))
  {
    knob.knob.skipped = "the scene has neither sky nor environment that shines on a medium";
    return knob;
  }
  CostMarch& march = scene.march();
  MarchChoice choice = march.standard();
  if (sky)
  {
    choice.ambient = false;
    knob.settings.push_back(march_setting("ambient", "without sky", 1.0, march, choice));
    choice.ambient = true;
  }
  if (!medium.environment.empty())
  {
    for (const int lights : { 1, 4, 16, 64 })
    {
      choice.environment_lights = lights;
      knob.settings.push_back(march_setting("ambient",
        std::to_string(lights) + (lights > 1 ? " lights of the map" : " light of the map"), 2.0 + lights,
        march, choice));
    }
    return knob;
  }
  knob.settings.push_back(march_setting("ambient", "with sky", 2.0, march, choice));
  return knob;
}

CostKnob resolution_knob(CostScene& scene)
{
  CostKnob knob;
  knob.knob = { "resolution", "resolution",
    "Pictures of fewer pixels, brought to the study's size by linear interpolation; steps, shadows and all "
    "else stand still.",
    "" };
  const MarchChoice& choice = scene.march().standard();
  for (const int divisor : { 8, 4, 2 })
  {
    if (std::min(scene.scene().width(), scene.scene().height()) / divisor < 2)
    {
      continue;
    }
    knob.settings.push_back(smaller_setting(
      "resolution", "1/" + std::to_string(divisor), 1.0 / (divisor * divisor), scene, divisor, choice));
  }
  knob.settings.push_back(march_setting("resolution", "whole", 1.0, scene.march(), choice));
  return knob;
}

struct NamedKnob
{
  const char* name;
  bool of_march; ///< whether the ray march draws it
  CostKnob (*make)(CostScene&);
};

const std::vector<NamedKnob>& named_knobs()
{
  static const std::vector<NamedKnob> knobs{ { "step", true, step_knob },
    { "tolerance", true, tolerance_knob }, { "precision", true, voxel_knob },
    { "shadows", true, shadow_knob }, { "octaves", true, octave_knob },
    { "ambient", true, ambient_knob }, { "resolution", true, resolution_knob },
    { "paths", false, path_knob }, { "smart", false, smart_knob }, { "stock", false, stock_knob } };
  return knobs;
}

}

const std::vector<std::string>& knob_names()
{
  static const std::vector<std::string> names = []
  {
    std::vector<std::string> list;
    for (const NamedKnob& knob : named_knobs())
    {
      list.emplace_back(knob.name);
    }
    list.emplace_back("combined");
    return list;
  }();
  return names;
}

CostKnob make_knob(const std::string& name, CostScene& scene)
{
  for (const NamedKnob& knob : named_knobs())
  {
    if (name == knob.name)
    {
      if (knob.of_march && !scene.wants("raymarch"))
      {
        CostKnob skipped;
        skipped.knob = { name, name, "", "raymarch is not among --mappers" };
        return skipped;
      }
      return knob.make(scene);
    }
  }
  return {};
}

CostKnob make_combined_knob(CostScene& scene, StepRule rule, int octaves)
{
  CostKnob knob;
  knob.knob = { "combined", "combined",
    "Several knobs at once, from coarse to fine: resolution, step, " +
      std::string(is_lit(scene) ? "the distance between the nodes of the shadow volume, and " +
            std::to_string(octaves) + (octaves > 1 ? " octaves" : " octave") +
            ", the rule of steps that erred least"
                                : std::string("the rule of steps that erred least")) +
      ".",
    "" };
  knob.has_finest = false;
  if (!scene.wants("raymarch"))
  {
    knob.knob.skipped = "raymarch is not among --mappers";
    return knob;
  }
  struct Combination
  {
    int divisor;
    double step;
  };
  MarchChoice choice = scene.march().standard();
  choice.octaves = octaves;
  choice.rule = rule;
  for (const Combination& c : { Combination{ 4, 4.0 }, Combination{ 2, 4.0 }, Combination{ 2, 2.0 },
         Combination{ 1, 4.0 }, Combination{ 1, 2.0 }, Combination{ 1, 1.0 } })
  {
    if (std::min(scene.scene().width(), scene.scene().height()) / c.divisor < 2)
    {
      continue;
    }
    choice.step = c.step;
    choice.shadow_step = std::max(c.step, 1.0);
    const std::string words = (c.divisor > 1 ? "1/" + std::to_string(c.divisor) + " size, " : "") +
      "steps " + part(c.step);
    const double effort = 1.0 / (c.divisor * c.divisor * c.step);
    knob.settings.push_back(c.divisor > 1
        ? smaller_setting("combined", words, effort, scene, c.divisor, choice)
        : march_setting("combined", words, effort, scene.march(), choice));
  }
  return knob;
}

}
