#include "vtkBrumeRayMarchMapper.h"

#include "march_report.h"

#include "Transport/film.h"
#include "Transport/marcher.h"
#include "Transport/step_control.h"

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

/// What the tolerance is spent on: leaving rays early, and steps.
constexpr double LeaveShare = 0.25;
constexpr double StepShare = 0.75;

/// Revisions and whatever else the choice of a step hangs on.
std::vector<double> StepKeyOf(const brume::Scene& scene, double tolerance)
{
  std::vector<double> key{ tolerance, static_cast<double>(scene.blend_mode) };
  for (const brume::Volume& volume : scene.volumes)
  {
    key.push_back(static_cast<double>(volume.data_revision));
    key.push_back(static_cast<double>(volume.medium_revision));
    key.push_back(volume.shading.enabled);
  }
  if (scene.blend_mode == brume::BlendMode::Isosurface)
  {
    key.insert(key.end(), scene.isosurfaces.begin(), scene.isosurfaces.end());
  }
  return key;
}

}

struct vtkBrumeRayMarchMapper::Internals
{
  brume::Marcher Marcher;
  std::vector<double> LastStep;
  brume::StepChoice Choice;
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

bool vtkBrumeRayMarchMapper::RenderScene(brume::Scene& scene, brume::Film& film)
{
  double secondsStep = 0.0;
  brume::MarchSettings settings;
  settings.threads = this->NumberOfThreads;
  settings.leave_error = LeaveShare * this->Tolerance;
  settings.jitter = this->UseJittering != 0;
  if (this->AutoAdjustSampleDistances)
  {
    const std::vector<double> key = StepKeyOf(scene, this->Tolerance);
    if (key != this->Internal->LastStep)
    {
      const auto start = std::chrono::steady_clock::now();
      this->Internal->Choice = brume::choose_step(this->Internal->Marcher, scene,
        std::max(StepShare * this->Tolerance, 1e-9), this->NumberOfThreads);
      this->Internal->LastStep = key;
      secondsStep =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    }
    settings.rule = this->Internal->Choice.rule;
    settings.step = this->Internal->Choice.step;
    settings.refinements = this->Internal->Choice.refinements;
    settings.refine_error = this->Internal->Choice.refine_error;
  }
  else
  {
    settings.step = this->FixedStep();
  }

  const brume::MarchStatistics march = this->Internal->Marcher.render(
    scene, settings, film, [this](double fraction) { return this->TellProgress(fraction); });
  this->SecondsRender = march.seconds;

  if (march.rays == 0)
  {
    this->Internal->LastStep.clear(); // nothing was measured
  }

  const bool window = this->FinalColorWindow != 1.0f || this->FinalColorLevel != 0.5f;
  nlohmann::json statistics;
  statistics["mapper"] = "raymarch";
  statistics["seconds"] = march.seconds;
  statistics["seconds_prepare"] = this->SecondsScene + secondsStep + march.seconds_prepare;
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
    statistics["estimated_error"] =
      this->Internal->Choice.estimated_error + settings.leave_error;
    statistics["tolerance_met"] = this->Internal->Choice.met;
  }
  else
  {
    statistics["step_chosen_by"] =
      this->LockSampleDistanceToInputSpacing ? "input spacing" : "caller";
  }
  statistics["effects"] = brume::effects_of(scene, settings, march, window);
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
  os << indent << "UseJittering: " << (this->UseJittering ? "On" : "Off") << "\n";
}
