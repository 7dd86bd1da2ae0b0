#include "vtkBrumeRayMarchMapper.h"

#include "march_choices.h"
#include "march_report.h"

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

struct vtkBrumeRayMarchMapper::Internals
{
  brume::Marcher Marcher;
  brume::MarchChoices Choices;
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

bool vtkBrumeRayMarchMapper::RenderScene(brume::Scene& whole, brume::Film& film)
{
  const auto start = std::chrono::steady_clock::now();
  const brume::ShadowMethod methods[] = { brume::ShadowMethod::Volume, // in place of a choice
    brume::ShadowMethod::None,
    brume::ShadowMethod::Rays,
    brume::ShadowMethod::Volume,
    brume::ShadowMethod::Functions };
  brume::ChoiceSettings wanted;
  wanted.tolerance = this->Tolerance;
  wanted.forces = this->GetEffectPlan()->GetForces();
  wanted.choose_shadows = this->ShadowMethod == AutomaticShadows;
  wanted.shadows = methods[this->ShadowMethod];
  wanted.shadow_step = this->ShadowSampleDistance;
  wanted.choose_step = this->AutoAdjustSampleDistances != 0;
  wanted.step = this->FixedStep();
  wanted.jitter = this->UseJittering != 0;
  wanted.coarse = this->ReusePlan || this->ImageSampleDistanceInUse > 1.0;
  wanted.threads = this->NumberOfThreads;
  brume::MarchChoices& choices = this->Internal->Choices;
  // Choices are made by many small renders, and may take longer than the picture.
  this->Internal->Marcher.set_watch([this] { return this->TellProgress(0.0); });
  choices.Update(this->Internal->Marcher, whole, wanted);
  this->GetEffectPlan()->SetPlan(choices.GetPlan());
  const brume::Scene& scene = choices.GetScene();
  const brume::MarchSettings& settings = choices.GetSettings();
  const double secondsChoices =
    std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();

  const brume::MarchStatistics march = this->Internal->Marcher.render(
    scene, settings, film, [this](double fraction) { return this->TellProgress(fraction); });
  this->SecondsRender = march.seconds;

  if (march.rays == 0)
  {
    choices.Forget(); // nothing was measured
  }

  const bool window = this->FinalColorWindow != 1.0f || this->FinalColorLevel != 0.5f;
  nlohmann::json statistics =
    brume::statistics_of(scene, settings, march, choices.GetPlan(), window);
  statistics["mapper"] = "raymarch";
  statistics["seconds_prepare"] =
    this->SecondsScene + secondsChoices + march.seconds_prepare;
  statistics["image_sample_distance"] = this->ImageSampleDistanceInUse;
  statistics["tolerance"] = this->Tolerance;
  if (this->AutoAdjustSampleDistances)
  {
    statistics["step_chosen_by"] = "tolerance";
    statistics["estimated_error"] = choices.GetEstimatedError();
    statistics["tolerance_met"] = choices.IsToleranceMet();
  }
  else
  {
    statistics["step_chosen_by"] =
      this->LockSampleDistanceToInputSpacing ? "input spacing" : "caller";
  }
  if (brume::is_lit(scene))
  {
    statistics["shadows_chosen_by"] = choices.HasChosenShadows() ? "tolerance" : "caller";
  }
  statistics["ignored_settings"] = this->IgnoredSettings;
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
  os << indent << "ReusePlan: " << (this->ReusePlan ? "On" : "Off") << "\n";
  os << indent << "UseJittering: " << (this->UseJittering ? "On" : "Off") << "\n";
}
