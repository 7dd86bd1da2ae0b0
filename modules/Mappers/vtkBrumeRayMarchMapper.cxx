#include "vtkBrumeRayMarchMapper.h"

#include "Transport/marcher.h"
#include "Transport/step_control.h"

#include "vtkObjectFactory.h"

#include <nlohmann/json.hpp>

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <tuple>

namespace
{

/// What the tolerance is spent on: leaving rays early, and steps.
constexpr double LeaveShare = 0.25;
constexpr double StepShare = 0.75;

/// The most memory that the process has held so far.
std::int64_t PeakMemoryBytes()
{
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return std::int64_t{ usage.ru_maxrss } * 1024; // Linux counts in KiB
}

nlohmann::json Effect(const char* name, bool on, const std::string& reason, double bound = 0.0)
{
  return { { "name", name }, { "on", on }, { "reason", reason }, { "error_bound", bound } };
}

nlohmann::json Effects(
  const brume::Scene& scene, const brume::MarchStatistics& march, double leave_error)
{
  const bool gradientOpacity = !scene.volumes[0].classification.gradient_opacity.empty();
  nlohmann::json effects = nlohmann::json::array();
  effects.push_back(Effect("absorption", march.visible_bricks > 0,
    march.visible_bricks > 0 ? "the opacity function is above 0 for values of the data"
                             : "the opacity function is 0 for every value of the data"));
  effects.push_back(Effect("emission", march.visible_bricks > 0,
    "the transfer functions' colour is the source, as in VTK's composite mode"));
  effects.push_back(Effect("scattering", false,
    "a vtkVolumeProperty without a medium has none: VTK's composite mode is emission and "
    "absorption"));
  effects.push_back(Effect("gradient shading", scene.volumes[0].shading.enabled,
    scene.volumes[0].shading.enabled ? "vtkVolumeProperty::Shade is on; not a physical term"
                          : "vtkVolumeProperty::Shade is off"));
  effects.push_back(Effect("gradient opacity", gradientOpacity,
    gradientOpacity ? "the property has a gradient opacity function; not a physical term"
                    : "the property has no gradient opacity function"));
  effects.push_back(Effect("surfaces", !scene.surface_depth.empty(),
    scene.surface_depth.empty() ? "no opaque geometry is shown with the volume"
                                : "rays end at opaque geometry"));
  effects.push_back(Effect("leaving rays early", march.visible_bricks > 0,
    "a ray ends when what is behind cannot change its pixel by more than the bound", leave_error));
  const bool leaps = march.visible_bricks < march.bricks;
  effects.push_back(Effect("space leaping", leaps,
    std::to_string(march.bricks - march.visible_bricks) + " of " + std::to_string(march.bricks) +
      " bricks hold no value that can be seen"));
  return effects;
}

}

struct vtkBrumeRayMarchMapper::Internals
{
  brume::Marcher Marcher;
  using StepKey = std::tuple<std::uint64_t, std::uint64_t, bool, double>;
  StepKey LastStep{ 0, 0, false, -1.0 };
  brume::StepChoice Choice;
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

bool vtkBrumeRayMarchMapper::RenderScene(brume::Scene& scene, brume::Film& film)
{
  double secondsStep = 0.0;
  brume::MarchSettings settings;
  settings.threads = this->NumberOfThreads;
  settings.leave_error = LeaveShare * this->Tolerance;
  if (this->AutoAdjustSampleDistances)
  {
    const Internals::StepKey key{ scene.volumes[0].data_revision, scene.volumes[0].medium_revision,
      scene.volumes[0].shading.enabled, this->Tolerance };
    if (key != this->Internal->LastStep)
    {
      const auto start = std::chrono::steady_clock::now();
      this->Internal->Choice = brume::choose_step(
        scene, std::max(StepShare * this->Tolerance, 1e-9), this->NumberOfThreads);
      this->Internal->LastStep = key;
      secondsStep =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    }
    settings.step = this->Internal->Choice.step;
    settings.step_error = this->Internal->Choice.estimated_error;
  }
  else
  {
    settings.step = this->SampleDistance;
  }

  const brume::MarchStatistics march = this->Internal->Marcher.render(
    scene, settings, film, [this](double fraction) { return this->ReportProgress(fraction); });

  if (march.rays == 0)
  {
    this->Internal->LastStep = Internals::StepKey{ 0, 0, false, -1.0 }; // nothing was measured
  }

  nlohmann::json statistics;
  statistics["mapper"] = "raymarch";
  statistics["seconds"] = march.seconds;
  statistics["seconds_prepare"] = this->SecondsScene + secondsStep + march.seconds_prepare;
  statistics["samples"] = march.samples;
  statistics["rays"] = march.rays;
  statistics["threads"] = march.threads;
  statistics["simd"] = march.simd;
  statistics["step"] = march.step;
  statistics["step_in_voxels"] = march.step / brume::smallest_voxel_edge(scene);
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
    statistics["step_chosen_by"] = "caller";
  }
  statistics["effects"] = Effects(scene, march, settings.leave_error);
  statistics["ignored_settings"] = this->IgnoredSettings;
  statistics["non_finite_voxels"] = march.non_finite_voxels;
  statistics["bricks"] = march.bricks;
  statistics["visible_bricks"] = march.visible_bricks;
  statistics["radiometric"] =
    !scene.volumes[0].shading.enabled && scene.volumes[0].classification.gradient_opacity.empty();
  statistics["peak_memory_bytes"] = PeakMemoryBytes();
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
}
