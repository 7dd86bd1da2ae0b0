#include "vtkBrumeMedium.h"

#include "checked_values.h"
#include "phase_lobes.h"

#include "Transport/black_body.h"

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkBrumeMedium);

static_assert(static_cast<int>(brume::PhaseFunction::Isotropic) == vtkBrumeMedium::IsotropicLobe &&
                static_cast<int>(brume::PhaseFunction::Rayleigh) == vtkBrumeMedium::RayleighLobe &&
                static_cast<int>(brume::PhaseFunction::HenyeyGreenstein) ==
                  vtkBrumeMedium::HenyeyGreensteinLobe &&
                static_cast<int>(brume::PhaseFunction::Schlick) == vtkBrumeMedium::SchlickLobe,
  "the functions are Transport's");
static_assert(brume::most_octaves == 16, "the range of NumberOfOctaves is Transport's");

struct vtkBrumeMedium::Internals
{
  std::vector<brume::PhaseLobe> Lobes;

  /// The lobe of an index, or one that is nothing.
  brume::PhaseLobe Lobe(int index) const
  {
    brume::PhaseLobe none;
    none.weight = 0.0;
    return index >= 0 && index < static_cast<int>(this->Lobes.size()) ? this->Lobes[index] : none;
  }
};

vtkBrumeMedium::vtkBrumeMedium()
  : Internal(std::make_unique<Internals>())
{
}

vtkBrumeMedium::~vtkBrumeMedium() = default;

void vtkBrumeMedium::SetExtinction(double red, double green, double blue)
{
  brume::set_values(
    this, "Extinction", this->Extinction, { red, green, blue }, 0.0, VTK_DOUBLE_MAX);
}

void vtkBrumeMedium::SetAlbedo(double red, double green, double blue)
{
  brume::set_values(this, "Albedo", this->Albedo, { red, green, blue }, 0.0, 1.0);
}

void vtkBrumeMedium::SetEmission(double red, double green, double blue)
{
  brume::set_values(this, "Emission", this->Emission, { red, green, blue }, 0.0, VTK_DOUBLE_MAX);
}

void vtkBrumeMedium::SetBlackBody(double amount)
{
  brume::set_value(this, "BlackBody", this->BlackBody, amount, 0.0, VTK_DOUBLE_MAX);
}

void vtkBrumeMedium::SetBlackBodyReference(double kelvin)
{
  brume::set_value(this,
    "BlackBodyReference",
    this->BlackBodyReference,
    kelvin,
    brume::coldest_black_body_reference,
    brume::hottest_black_body);
}

void vtkBrumeMedium::SetTemperatureScale(double kelvin)
{
  brume::set_positive(this, "TemperatureScale", this->TemperatureScale, kelvin);
}

void vtkBrumeMedium::AddLobe(int function, double weight, double anisotropy)
{
  const std::string wrong = brume::add_lobe(
    this->Internal->Lobes, static_cast<brume::PhaseFunction>(function), weight, anisotropy);
  if (!wrong.empty())
  {
    vtkWarningMacro(<< wrong << "; no lobe is added for weight " << weight << " and anisotropy "
                    << anisotropy << '.');
    return;
  }
  this->Modified();
}

void vtkBrumeMedium::AddIsotropicLobe(double weight)
{
  this->AddLobe(IsotropicLobe, weight, 0.0);
}

void vtkBrumeMedium::AddRayleighLobe(double weight)
{
  this->AddLobe(RayleighLobe, weight, 0.0);
}

void vtkBrumeMedium::AddHenyeyGreensteinLobe(double weight, double anisotropy)
{
  this->AddLobe(HenyeyGreensteinLobe, weight, anisotropy);
}

void vtkBrumeMedium::AddSchlickLobe(double weight, double anisotropy)
{
  this->AddLobe(SchlickLobe, weight, anisotropy);
}

void vtkBrumeMedium::RemoveAllLobes()
{
  if (!this->Internal->Lobes.empty())
  {
    this->Internal->Lobes.clear();
    this->Modified();
  }
}

int vtkBrumeMedium::GetNumberOfLobes() const
{
  return static_cast<int>(this->Internal->Lobes.size());
}

int vtkBrumeMedium::GetLobeFunction(int index) const
{
  return static_cast<int>(this->Internal->Lobe(index).function);
}

double vtkBrumeMedium::GetLobeWeight(int index) const
{
  return this->Internal->Lobe(index).weight;
}

double vtkBrumeMedium::GetLobeAnisotropy(int index) const
{
  return this->Internal->Lobe(index).anisotropy;
}

void vtkBrumeMedium::SetAnisotropy(double anisotropy)
{
  std::vector<brume::PhaseLobe> lobes;
  const std::string wrong =
    anisotropy == 0.0
      ? std::string()
      : brume::add_lobe(lobes, brume::PhaseFunction::HenyeyGreenstein, 1.0, anisotropy);
  if (!wrong.empty())
  {
    vtkWarningMacro(<< wrong << ", not " << anisotropy << "; the old phase function is kept.");
    return;
  }
  const std::vector<brume::PhaseLobe>& old = this->Internal->Lobes;
  const bool same = lobes.empty() ? old.empty()
                                  : old.size() == 1 && old[0].function == lobes[0].function &&
                                      old[0].anisotropy == lobes[0].anisotropy;
  if (!same)
  {
    this->Internal->Lobes = lobes;
    this->Modified();
  }
}

double vtkBrumeMedium::GetAnisotropy() const
{
  return brume::mean_anisotropy(this->Internal->Lobes);
}

void vtkBrumeMedium::SetOctaveAttenuation(double factor)
{
  brume::set_value(this, "OctaveAttenuation", this->OctaveAttenuation, factor, 0.0, 1.0);
  if (this->OctaveContribution > this->OctaveAttenuation)
  {
    this->OctaveContribution = this->OctaveAttenuation;
  }
}

void vtkBrumeMedium::SetOctaveContribution(double factor)
{
  if (factor > this->OctaveAttenuation)
  {
    vtkWarningMacro("OctaveContribution must not be above OctaveAttenuation, which is "
                    << this->OctaveAttenuation
                    << ": that would make light from nothing. Kept: " << this->OctaveContribution
                    << "; raise OctaveAttenuation first, or take a smaller one than " << factor
                    << '.');
    return;
  }
  brume::set_value(this, "OctaveContribution", this->OctaveContribution, factor, 0.0, 1.0);
}

void vtkBrumeMedium::SetOctaveAnisotropy(double factor)
{
  brume::set_value(this, "OctaveAnisotropy", this->OctaveAnisotropy, factor, 0.0, 1.0);
}

void vtkBrumeMedium::SetSilverLiningStrength(double strength)
{
  brume::set_value(
    this, "SilverLiningStrength", this->SilverLiningStrength, strength, 0.0, VTK_DOUBLE_MAX);
}

void vtkBrumeMedium::SetSilverLiningSpread(double spread)
{
  brume::set_value(this, "SilverLiningSpread", this->SilverLiningSpread, spread, 1e-4, 1.0);
}

void vtkBrumeMedium::SetSilverLiningBack(double back)
{
  brume::set_value(this, "SilverLiningBack", this->SilverLiningBack, back, 0.0, 1.0);
}

void vtkBrumeMedium::SetPowderStrength(double strength)
{
  brume::set_value(this, "PowderStrength", this->PowderStrength, strength, 0.0, 1.0);
}

void vtkBrumeMedium::SetPowderScale(double scale)
{
  brume::set_positive(this, "PowderScale", this->PowderScale, scale);
}

void vtkBrumeMedium::FillMedium(brume::Medium& medium) const
{
  const auto rgb = [](const double(&v)[3]) { return glm::dvec3(v[0], v[1], v[2]); };
  medium.lit = true;
  medium.albedo = rgb(this->Albedo);
  medium.lobes = this->Internal->Lobes;
  medium.octaves.count = this->NumberOfOctaves;
  medium.octaves.attenuation = this->OctaveAttenuation;
  medium.octaves.contribution = this->OctaveContribution;
  medium.octaves.anisotropy = this->OctaveAnisotropy;
  medium.emission = rgb(this->Emission);
  medium.black_body = this->BlackBody;
  medium.black_body_reference = this->BlackBodyReference;
  medium.temperature_scale = this->TemperatureScale;
  medium.silver_lining.enabled = this->SilverLining != 0;
  medium.silver_lining.strength = this->SilverLiningStrength;
  medium.silver_lining.spread = this->SilverLiningSpread;
  medium.silver_lining.back = this->SilverLiningBack;
  medium.powder.enabled = this->Powder != 0;
  medium.powder.strength = this->PowderStrength;
  medium.powder.form = this->PowderForm == HeightPowder ? brume::Powder::Form::Height
                                                        : brume::Powder::Form::Exponential;
  medium.powder.scale = this->PowderScale;
}

void vtkBrumeMedium::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  const auto rgb = [&](const char* name, const double(&v)[3])
  { os << indent << name << ": " << v[0] << ' ' << v[1] << ' ' << v[2] << '\n'; };
  const auto text = [&](const char* name, const std::string& v)
  { os << indent << name << ": " << (v.empty() ? "(none)" : v) << '\n'; };
  rgb("Extinction", this->Extinction);
  rgb("Albedo", this->Albedo);
  text("DensityArrayName", this->DensityArrayName);
  rgb("Emission", this->Emission);
  os << indent << "BlackBody: " << this->BlackBody << '\n';
  os << indent << "BlackBodyReference: " << this->BlackBodyReference << '\n';
  text("TemperatureArrayName", this->TemperatureArrayName);
  os << indent << "TemperatureScale: " << this->TemperatureScale << '\n';
  os << indent << "Lobes: " << (this->Internal->Lobes.empty() ? "(none: isotropic)" : "") << '\n';
  for (const brume::PhaseLobe& lobe : this->Internal->Lobes)
  {
    os << indent.GetNextIndent() << brume::phase_function_name(lobe.function) << ", weight "
       << lobe.weight << ", g " << lobe.anisotropy << '\n';
  }
  os << indent << "Anisotropy: " << this->GetAnisotropy() << '\n';
  os << indent << "NumberOfOctaves: " << this->NumberOfOctaves << '\n';
  os << indent << "OctaveAttenuation: " << this->OctaveAttenuation << '\n';
  os << indent << "OctaveContribution: " << this->OctaveContribution << '\n';
  os << indent << "OctaveAnisotropy: " << this->OctaveAnisotropy << '\n';
  os << indent << "SilverLining: " << (this->SilverLining ? "On" : "Off") << '\n';
  os << indent << "SilverLiningStrength: " << this->SilverLiningStrength << '\n';
  os << indent << "SilverLiningSpread: " << this->SilverLiningSpread << '\n';
  os << indent << "SilverLiningBack: " << this->SilverLiningBack << '\n';
  os << indent << "Powder: " << (this->Powder ? "On" : "Off") << '\n';
  os << indent << "PowderStrength: " << this->PowderStrength << '\n';
  os << indent << "PowderForm: " << (this->PowderForm == HeightPowder ? "height" : "exponential")
     << '\n';
  os << indent << "PowderScale: " << this->PowderScale << '\n';
}
