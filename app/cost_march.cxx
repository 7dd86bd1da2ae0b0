#include "cost_march.h"

#include "command.h"
#include "interruption.h"

#include "vtkBrumeEffectPlan.h"
#include "vtkBrumeFog.h"
#include "vtkBrumeMedium.h"
#include "vtkBrumeSky.h"
#include "vtkBrumeSparseVolume.h"

#include "vtkCamera.h"
#include "vtkImageData.h"
#include "vtkLightCollection.h"
#include "vtkVolume.h"

#include <nlohmann/json.hpp>

namespace brume::app
{

namespace
{

/// The share of the tolerance that rays may be left early for, as the mapper has it.
constexpr double leaving_share = 0.25;

ShadowMethod transport_method(int method)
{
  switch (method)
  {
    case vtkBrumeRayMarchMapper::NoShadows:
      return ShadowMethod::None;
    case vtkBrumeRayMarchMapper::RayShadows:
      return ShadowMethod::Rays;
    case vtkBrumeRayMarchMapper::FunctionShadows:
      return ShadowMethod::Functions;
    default:
      return ShadowMethod::Volume;
  }
}

}

CostMarch::CostMarch(const VolumeScene& scene)
  : March(scene, "cost")
{
  const SceneOptions& options = scene.options;
  MarchChoice& c = this->Standard;
  c.tolerance = options.tolerance;
  if (options.sample_distance)
  {
    c.step = *options.sample_distance / scene.voxel_edge;
  }
  if (options.medium.shadows != "automatic")
  {
    c.shadows = this->March.mapper()->GetShadowMethod(); // as set_up() gave it
    c.shadow_step = 0.0;
  }
  if (options.medium.shadow_sample_distance > 0.0)
  {
    c.shadow_step = options.medium.shadow_sample_distance / scene.voxel_edge;
  }
  c.octaves = options.medium.octaves;
  c.environment_lights = options.medium.environment_lights;
}

CostMarch::~CostMarch() = default;

void CostMarch::set(const MarchChoice& choice)
{
  vtkBrumeRayMarchMapper* mapper = this->March.mapper();
  const double edge = this->scene().voxel_edge;
  mapper->SetTolerance(choice.tolerance);
  mapper->GetEffectPlan()->ForceNothing();
  apply(this->scene().options.medium, mapper);
  if (!choice.ambient)
  {
    mapper->GetEffectPlan()->Force("ambient", false);
  }
  mapper->SetAutoAdjustSampleDistances(choice.automatic);
  if (!choice.automatic)
  {
    mapper->SetSampleDistance(choice.step * edge);
    mapper->SetShadowMethod(choice.shadows);
    mapper->SetShadowSampleDistance(choice.shadow_step * edge);
  }
  if (vtkBrumeMedium* medium = this->scene().medium)
  {
    medium->SetNumberOfOctaves(choice.octaves);
  }
  if (this->scene().sky && !this->scene().options.medium.environment.empty())
  {
    this->scene().sky->SetNumberOfEnvironmentLights(choice.environment_lights);
  }
  this->March.take_volume();
}

bool CostMarch::follows(StepRule rule)
{
  this->set(this->Standard);
  const VolumeScene& s = this->scene();
  const brume::Scene* plain =
    this->March.mapper()->UpdateScene(s.volume, s.camera, s.lights, s.width(), s.height());
  return plain && follows_rule(*plain, rule);
}

CostRender CostMarch::draw_by_rule(const MarchChoice& choice, const Watch& watch)
{
  const VolumeScene& s = this->scene();
  const brume::Scene* plain =
    this->March.mapper()->UpdateScene(s.volume, s.camera, s.lights, s.width(), s.height());
  if (!plain)
  {
    throw Failure(s.options.input, "it cannot be drawn", "see brume info");
  }
  MarchSettings settings;
  settings.rule = choice.rule;
  settings.step = choice.step * s.voxel_edge;
  settings.leave_error = leaving_share * choice.tolerance;
  settings.shadows = transport_method(choice.shadows);
  settings.shadow_step = choice.shadow_step * s.voxel_edge;
  settings.threads = s.options.threads;
  Film film(s.width(), s.height());
  const MarchStatistics march = this->OfRules.render(*plain, settings, film,
    [&](double done) { return !InterruptionWatch::requested() && (!watch || watch(done)); });
  if (!march.completed)
  {
    InterruptionWatch::check("cost");
    throw SceneMarch::Stopped();
  }
  const nlohmann::json statistics{ { "step_rule", step_rule_name(march.rule) }, { "step", march.step },
    { "samples", march.samples }, { "shadow_method", shadow_method_name(march.shadows) },
    { "shadow_step", march.shadow_step } };
  return { this->March.over(film), march.seconds, march.seconds_prepare, statistics.dump() };
}

CostRender CostMarch::draw(const MarchChoice& choice, const Watch& watch)
{
  this->set(choice);
  if (choice.rule != StepRule::Midpoint)
  {
    return this->draw_by_rule(choice, watch);
  }
  this->March.watch(watch);
  const Film film = this->March.draw();
  this->March.watch({});
  const std::string& text = this->March.mapper()->GetStatistics();
  const nlohmann::json statistics = nlohmann::json::parse(text);
  this->Threads = statistics["threads"];
  this->Simd = statistics["simd"];
  return { this->March.over(film), statistics["seconds"], statistics["seconds_prepare"], text };
}

std::string CostMarch::settings(const MarchChoice& choice) const
{
  const VolumeScene& s = this->scene();
  const char* const methods[] = { "automatic", "none", "rays", "volume", "functions" };
  nlohmann::json json;
  json["resolution"] = { s.width(), s.height() };
  json["tolerance"] = choice.tolerance;
  json["steps_and_shadows"] = choice.automatic ? "by the tolerance" : "fixed";
  if (!choice.automatic)
  {
    json["step_rule"] = step_rule_name(choice.rule);
    json["step_in_voxels"] = choice.step;
  }
  if (s.medium)
  {
    json["octaves"] = choice.octaves;
    json["ambient"] = choice.ambient;
    if (!choice.automatic)
    {
      json["shadow_method"] = methods[choice.shadows];
      json["shadow_step_in_voxels"] = choice.shadow_step;
    }
    if (!s.options.medium.environment.empty())
    {
      json["environment_lights"] = choice.environment_lights;
    }
  }
  return json.dump();
}

}
