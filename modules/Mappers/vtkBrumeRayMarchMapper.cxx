#include "vtkBrumeRayMarchMapper.h"

#include "march_report.h"
#include "step_key.h"

#include "Transport/effect_plan.h"
#include "Transport/film.h"
#include "Transport/marcher.h"
#include "Transport/step_control.h"

#include "vtkBrumeEffectPlan.h"
#include "vtkColorTransferFunction.h"
#include "vtkContourValues.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPiecewiseFunction.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace
{

/// What the tolerance is spent on: leaving rays early, and steps; of lit scenes also effects that are
/// left out (plan_effects takes a quarter of what it is given) and shadows.
constexpr double LeaveShare = 0.25;
constexpr double ShadowShare = 0.25;
constexpr double StepShare = 0.75;
constexpr double LitStepShare = 0.25;

std::vector<double> NumbersOf(const brume::EffectSet& effects)
{
  std::vector<double> numbers;
  for (int i = 0; i < brume::effect_count; ++i)
  {
    numbers.push_back(effects.has(static_cast<brume::Effect>(i)));
  }
  return numbers;
}

}

struct vtkBrumeRayMarchMapper::Internals
{
  brume::Marcher Marcher;
  // Steps and shadows hold for all directions of light, nearly; plans do not.
  brume::SceneKey StepKey;
  brume::StepChoice Choice;
  brume::SceneKey ShadowKey;
  brume::ShadowChoice Shadows;
  brume::SceneKey PlanKey;
  brume::EffectPlan Plan;
  vtkNew<vtkContourValues> DepthPassContourValues; ///< kept for callers; nothing reads it
};

vtkStandardNewMacro(vtkBrumeRayMarchMapper);

vtkBrumeRayMarchMapper::vtkBrumeRayMarchMapper()
  : Internal(std::make_unique<Internals>())
{
}

vtkBrumeRayMarchMapper::~vtkBrumeRayMarchMapper() = default;

void vtkBrumeRayMarchMapper::SetSampleDistance(double distance)
{
  if (!(distance > 0.0) || !std::isfinite(distance))
  {
    vtkWarningMacro("SampleDistance must be a positive length, not " << distance
                                                                     << "; kept: "
                                                                     << this->SampleDistance);
    return;
  }
  if (distance != this->SampleDistance)
  {
    this->SampleDistance = distance;
    this->Modified();
  }
}

void vtkBrumeRayMarchMapper::SetShadowSampleDistance(double distance)
{
  if (!(distance >= 0.0) || !std::isfinite(distance))
  {
    vtkWarningMacro("ShadowSampleDistance must be a length, or 0 to have it chosen, not "
      << distance << "; kept: " << this->ShadowSampleDistance);
    return;
  }
  if (distance != this->ShadowSampleDistance)
  {
    this->ShadowSampleDistance = distance;
    this->Modified();
  }
}

vtkContourValues* vtkBrumeRayMarchMapper::GetDepthPassContourValues()
{
  return this->Internal->DepthPassContourValues;
}

void vtkBrumeRayMarchMapper::SetPartitions(unsigned short x, unsigned short y, unsigned short z)
{
  this->Partitions[0] = x;
  this->Partitions[1] = y;
  this->Partitions[2] = z;
}

float vtkBrumeRayMarchMapper::GetEstimatedRenderTime(vtkRenderer* renderer, vtkVolume* volume)
{
  return static_cast<float>(this->GetSecondsOfPicture(renderer, volume));
}

float vtkBrumeRayMarchMapper::ComputeRequiredImageSampleDistance(float desiredTime,
  vtkRenderer* renderer,
  vtkVolume* volume)
{
  const double seconds = this->GetSecondsOfPicture(renderer, volume);
  // Without a picture to go by there is nothing to be coarser than.
  double distance = seconds > 0.0 && desiredTime > 0.0f ? std::sqrt(seconds / desiredTime) : 0.0;
  if (distance > 1.0)
  {
    distance = std::ceil(4.0 * distance) / 4.0; // so that it does not change with every picture
  }
  distance = std::max<double>(distance, this->MinimumImageSampleDistance);
  return static_cast<float>(std::min<double>(distance, this->MaximumImageSampleDistance));
}

double vtkBrumeRayMarchMapper::ChooseImageSampleDistance(vtkRenderer* renderer,
  vtkVolume* volume,
  double allocated)
{
  return this->AutoAdjustSampleDistances
           ? this->ComputeRequiredImageSampleDistance(
               static_cast<float>(std::min(allocated, 1e30)), renderer, volume)
           : this->ImageSampleDistance;
}

void vtkBrumeRayMarchMapper::AppendIgnoredSettings(vtkVolume* volume,
  std::vector<std::string>& names)
{
  const auto ignored = [&names](bool is, const char* setting)
  {
    if (is)
    {
      names.emplace_back(setting);
    }
  };
  ignored(this->InteractiveSampleDistance != 2.0f, "InteractiveSampleDistance");
  ignored(this->UseDepthPass != 0, "UseDepthPass");
  ignored(this->MaxMemoryInBytes != 0, "MaxMemoryInBytes");
  ignored(this->MaxMemoryFraction != 0.75f, "MaxMemoryFraction");
  ignored(this->RenderToImage != 0, "RenderToImage");
  ignored(this->DepthImageScalarType != VTK_FLOAT, "DepthImageScalarType");
  ignored(this->ClampDepthToBackface != 0, "ClampDepthToBackface");
  ignored(!this->Transfer2DYAxisArray.empty(), "Transfer2DYAxisArray");
  ignored(
    this->Partitions[0] > 1 || this->Partitions[1] > 1 || this->Partitions[2] > 1, "Partitions");
  // Functions that keep their end's value beyond their nodes are the same over either range.
  vtkVolumeProperty* property = volume->GetProperty();
  ignored(this->ScalarOpacityRangeType != SCALAR && !property->GetScalarOpacity()->GetClamping(),
    "ScalarOpacityRangeType");
  ignored(this->ColorRangeType != SCALAR && property->GetColorChannels() == 3 &&
            !property->GetRGBTransferFunction()->GetClamping(),
    "ColorRangeType");
  ignored(this->GradientOpacityRangeType != SCALAR, "GradientOpacityRangeType");
}

double vtkBrumeRayMarchMapper::FixedStep()
{
  auto* image = vtkImageData::SafeDownCast(this->GetInput());
  if (!this->LockSampleDistanceToInputSpacing || !image)
  {
    return this->SampleDistance;
  }
  double spacing[3];
  for (int axis = 0; axis < 3; ++axis)
  {
    spacing[axis] = std::abs(image->GetSpacing()[axis]);
  }
  return this->SpacingAdjustedSampleDistance(spacing, image->GetExtent());
}

brume::EffectSet vtkBrumeRayMarchMapper::PlanEffects(const brume::Scene& scene)
{
  // Without a medium pictures are VTK's: nothing that changes one is left out unless it is forced.
  const double tolerance = brume::is_lit(scene) ? this->Tolerance : 0.0;
  const std::map<brume::Effect, bool>& forces = this->GetEffectPlan()->GetForces();
  std::vector<double> key{ tolerance, static_cast<double>(scene.surface_depth.empty()) };
  for (const auto& force : forces)
  {
    key.push_back(static_cast<double>(force.first));
    key.push_back(force.second);
  }
  if (!this->Internal->PlanKey.Holds(scene, key))
  {
    this->Internal->Plan = brume::plan_effects(
      this->Internal->Marcher, scene, tolerance, forces, this->NumberOfThreads);
    this->Internal->PlanKey.Take(scene, key);
  }
  this->GetEffectPlan()->SetPlan(this->Internal->Plan);
  return this->Internal->Plan.on();
}

brume::ShadowChoice vtkBrumeRayMarchMapper::ChooseShadows(const brume::Scene& scene,
  const brume::EffectSet& effects)
{
  brume::ShadowChoice shadows;
  const bool cast = brume::is_lit(scene) && effects.has(brume::Effect::Shadows);
  if (cast && this->ShadowMethod == AutomaticShadows)
  {
    const double tolerance = std::max(ShadowShare * this->Tolerance, 1e-9);
    std::vector<double> key = NumbersOf(effects);
    key.push_back(tolerance);
    if (!this->Internal->ShadowKey.Holds(scene, key))
    {
      this->Internal->Shadows = brume::choose_shadows(
        this->Internal->Marcher, scene, tolerance, this->NumberOfThreads);
      this->Internal->ShadowKey.Take(scene, key, false);
    }
    shadows = this->Internal->Shadows;
  }
  else if (cast)
  {
    const brume::ShadowMethod methods[] = { brume::ShadowMethod::None,
      brume::ShadowMethod::None,
      brume::ShadowMethod::Rays,
      brume::ShadowMethod::Volume,
      brume::ShadowMethod::Functions };
    shadows.method = methods[this->ShadowMethod];
    shadows.precise = this->Tolerance < 1e-3;
  }
  if (this->ShadowSampleDistance > 0.0)
  {
    shadows.step = this->ShadowSampleDistance;
  }
  return shadows;
}

void vtkBrumeRayMarchMapper::ChooseStep(const brume::Scene& scene,
  const brume::EffectSet& effects,
  double tolerance,
  brume::MarchSettings& settings)
{
  if (!this->AutoAdjustSampleDistances)
  {
    settings.step = this->FixedStep();
    return;
  }
  brume::StepChoice& choice = this->Internal->Choice;
  std::vector<double> key = NumbersOf(effects);
  key.insert(key.end(),
    { tolerance, static_cast<double>(settings.shadows), settings.shadow_step });
  if (!this->Internal->StepKey.Holds(scene, key))
  {
    choice = brume::choose_step(this->Internal->Marcher, scene, tolerance, this->NumberOfThreads,
      brume::is_lit(scene) ? settings : brume::MarchSettings());
    this->Internal->StepKey.Take(scene, key, false);
  }
  settings.rule = choice.rule;
  settings.step = choice.step;
  settings.refinements = choice.refinements;
  settings.refine_error = choice.refine_error;
}

bool vtkBrumeRayMarchMapper::RenderScene(brume::Scene& whole, brume::Film& film)
{
  const auto start = std::chrono::steady_clock::now();
  const brume::EffectSet effects = this->PlanEffects(whole);
  // What VTK draws too stays as it is, unless an effect was forced.
  const bool plain = !brume::is_lit(whole) && this->GetEffectPlan()->GetForces().empty();
  const brume::Scene simple = plain ? brume::Scene() : brume::simplified(whole, effects);
  const brume::Scene& scene = plain ? whole : simple;
  brume::MarchSettings settings;
  settings.threads = this->NumberOfThreads;
  settings.leave_error = LeaveShare * this->Tolerance;
  settings.jitter = this->UseJittering != 0;
  const brume::ShadowChoice shadows = this->ChooseShadows(scene, effects);
  settings.shadows = shadows.method;
  settings.shadow_step = shadows.step;
  settings.precise_shadows = shadows.precise;
  if (!plain)
  {
    brume::apply_effects(effects, settings);
  }
  const double share = brume::is_lit(scene) ? LitStepShare : StepShare;
  this->ChooseStep(scene, effects, std::max(share * this->Tolerance, 1e-9), settings);
  const double secondsChoices =
    std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();

  const brume::MarchStatistics march = this->Internal->Marcher.render(
    scene, settings, film, [this](double fraction) { return this->TellProgress(fraction); });
  this->SecondsRender = march.seconds;

  if (march.rays == 0)
  {
    // Nothing was measured.
    this->Internal->StepKey.Clear();
    this->Internal->ShadowKey.Clear();
    this->Internal->PlanKey.Clear();
  }

  const bool window = this->FinalColorWindow != 1.0f || this->FinalColorLevel != 0.5f;
  nlohmann::json statistics;
  statistics["mapper"] = "raymarch";
  statistics["seconds"] = march.seconds;
  statistics["seconds_prepare"] =
    this->SecondsScene + secondsChoices + march.seconds_prepare;
  statistics["samples"] = march.samples;
  statistics["rays"] = march.rays;
  statistics["threads"] = march.threads;
  statistics["simd"] = march.simd;
  statistics["step"] = march.step;
  statistics["step_rule"] = brume::step_rule_name(march.rule);
  statistics["refinements"] = settings.refinements;
  statistics["step_in_voxels"] = march.step / brume::smallest_voxel_edge(scene);
  statistics["image_sample_distance"] = this->ImageSampleDistanceInUse;
  statistics["blend_mode"] = brume::blend_mode_name(scene.blend_mode);
  statistics["volumes"] = scene.volumes.size();
  statistics["tolerance"] = this->Tolerance;
  if (this->AutoAdjustSampleDistances)
  {
    statistics["step_chosen_by"] = "tolerance";
    statistics["estimated_error"] = this->Internal->Choice.estimated_error +
      settings.leave_error + shadows.estimated_error + this->Internal->Plan.error_bound();
    statistics["tolerance_met"] = this->Internal->Choice.met && shadows.met;
  }
  else
  {
    statistics["step_chosen_by"] =
      this->LockSampleDistanceToInputSpacing ? "input spacing" : "caller";
  }
  if (brume::is_lit(scene))
  {
    const bool chosen =
      this->ShadowMethod == AutomaticShadows && !(this->ShadowSampleDistance > 0.0);
    statistics["shadows_chosen_by"] = chosen ? "tolerance" : "caller";
  }
  statistics["shadow_method"] = brume::shadow_method_name(march.shadows);
  statistics["shadow_step"] = march.shadow_step;
  statistics["light_bytes"] = march.light_bytes;
  statistics["seconds_light"] = march.seconds_light;
  statistics["effects"] =
    brume::effects_of(scene, settings, march, this->Internal->Plan, window);
  statistics["effects_error_bound"] = this->Internal->Plan.error_bound();
  statistics["ignored_settings"] = this->IgnoredSettings;
  statistics["non_finite_voxels"] = march.non_finite_voxels;
  statistics["bricks"] = march.bricks;
  statistics["visible_bricks"] = march.visible_bricks;
  statistics["radiometric"] = brume::is_radiometric(scene, window);
  statistics["peak_memory_bytes"] = brume::peak_memory_bytes();
  statistics["completed"] = march.completed;
  this->Statistics = statistics.dump(2);
  return march.completed;
}

void vtkBrumeRayMarchMapper::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "AutoAdjustSampleDistances: "
     << (this->AutoAdjustSampleDistances ? "On" : "Off") << "\n";
  os << indent << "SampleDistance: " << this->SampleDistance << "\n";
  os << indent << "LockSampleDistanceToInputSpacing: "
     << (this->LockSampleDistanceToInputSpacing ? "On" : "Off") << "\n";
  os << indent << "ImageSampleDistance: " << this->ImageSampleDistance << "\n";
  os << indent << "MinimumImageSampleDistance: " << this->MinimumImageSampleDistance << "\n";
  os << indent << "MaximumImageSampleDistance: " << this->MaximumImageSampleDistance << "\n";
  const char* const methods[] = { "automatic", "none", "rays", "volume", "functions" };
  os << indent << "ShadowMethod: " << methods[this->ShadowMethod] << "\n";
  os << indent << "ShadowSampleDistance: " << this->ShadowSampleDistance << "\n";
  os << indent << "UseJittering: " << (this->UseJittering ? "On" : "Off") << "\n";
}
