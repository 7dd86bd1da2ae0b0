#include "vtkBrumePathTraceMapper.h"

#include "march_report.h"
#include "path_report.h"
#include "refinement.h"

#include "Transport/film.h"
#include "Transport/path_tracer.h"

#include "vtkBrumeEffectPlan.h"
#include "vtkBrumeSky.h"
#include "vtkObjectFactory.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"

#include <nlohmann/json.hpp>

#include <algorithm>

struct vtkBrumePathTraceMapper::Internals
{
  brume::PathTracer Tracer;
  brume::Refinement Refinement;
};

vtkStandardNewMacro(vtkBrumePathTraceMapper);

vtkBrumePathTraceMapper::vtkBrumePathTraceMapper()
  : Internal(std::make_unique<Internals>())
{
}

vtkBrumePathTraceMapper::~vtkBrumePathTraceMapper() = default;

void vtkBrumePathTraceMapper::AppendIgnoredSettings(vtkVolume* volume,
  std::vector<std::string>& names)
{
  if (this->GetMedium() && volume->GetProperty()->GetShade())
  {
    names.emplace_back("vtkVolumeProperty::Shade with a Medium");
  }
}

bool vtkBrumePathTraceMapper::RenderScene(brume::Scene& scene, brume::Film& film)
{
  brume::PathSettings settings;
  settings.samples_per_pixel = this->SamplesPerPixel;
  settings.tolerance = this->Tolerance;
  settings.seconds = this->TimeBudget;
  settings.most_scatterings = this->MaximumScatterings;
  settings.seed = this->Seed;
  settings.threads = this->NumberOfThreads;
  if (vtkBrumeSky* sky = this->GetSkyInUse())
  {
    settings.environment = sky->TakeEnvironment(scene.lights);
  }
  brume::Refinement& refinement = this->Internal->Refinement;
  if (this->SamplesPerRender > 0)
  {
    settings.resume =
      refinement.goes_on(scene, settings, film.width, film.height, this->GetMTime());
    const int before = settings.resume ? this->RenderedSamplesPerPixel : 0;
    settings.samples_per_pixel =
      before + std::min(this->SamplesPerRender, std::max(this->SamplesPerPixel - before, 0));
    settings.samples_per_pixel = std::max(settings.samples_per_pixel, 1);
    settings.tolerance = 0.0;
  }
  else
  {
    refinement.end();
  }
  this->RenderedSamplesPerPixel = 0;
  const brume::PathStatistics paths = this->Internal->Tracer.render(
    scene, settings, film, [this](double fraction) { return this->TellProgress(fraction); });
  this->SecondsRender = paths.seconds;
  this->RenderedSamplesPerPixel = paths.samples_per_pixel;

  const brume::EffectPlan plan = brume::plan_of_paths(
    scene, this->MaximumScatterings, settings.environment != nullptr);
  this->GetEffectPlan()->SetPlan(plan);
  const bool window = this->FinalColorWindow != 1.0f || this->FinalColorLevel != 0.5f;
  nlohmann::json statistics = brume::statistics_of(scene, settings, paths, plan, window);
  statistics["mapper"] = "pathtrace";
  statistics["seconds_prepare"] = this->SecondsScene + paths.seconds_prepare;
  statistics["image_sample_distance"] = this->ImageSampleDistanceInUse;
  statistics["tolerance"] = this->Tolerance;
  statistics["tolerance_met"] = paths.estimated_error <= this->Tolerance;
  statistics["ignored_settings"] = this->IgnoredSettings;
  this->Statistics = statistics.dump(2);
  return paths.completed;
}

void vtkBrumePathTraceMapper::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "SamplesPerPixel: " << this->SamplesPerPixel << "\n";
  os << indent << "SamplesPerRender: " << this->SamplesPerRender << "\n";
  os << indent << "RenderedSamplesPerPixel: " << this->RenderedSamplesPerPixel << "\n";
  os << indent << "MaximumScatterings: " << this->MaximumScatterings << "\n";
  os << indent << "TimeBudget: " << this->TimeBudget << "\n";
  os << indent << "Seed: " << this->Seed << "\n";
}
