#include "vtkBrumePathTraceMapper.h"

#include "march_report.h"
#include "path_report.h"

#include "Transport/film.h"
#include "Transport/path_tracer.h"

#include "vtkBrumeEffectPlan.h"
#include "vtkObjectFactory.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"

#include <nlohmann/json.hpp>

struct vtkBrumePathTraceMapper::Internals
{
  brume::PathTracer Tracer;
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
  const brume::PathStatistics paths = this->Internal->Tracer.render(
    scene, settings, film, [this](double fraction) { return this->TellProgress(fraction); });
  this->SecondsRender = paths.seconds;

  const brume::EffectPlan plan = brume::plan_of_paths(scene, this->MaximumScatterings);
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
  os << indent << "MaximumScatterings: " << this->MaximumScatterings << "\n";
  os << indent << "TimeBudget: " << this->TimeBudget << "\n";
  os << indent << "Seed: " << this->Seed << "\n";
}
