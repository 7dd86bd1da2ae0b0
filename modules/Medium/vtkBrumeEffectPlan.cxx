#include "vtkBrumeEffectPlan.h"

#include "Transport/effect_plan.h"

#include "vtkObjectFactory.h"

#include <cctype>
#include <string>

vtkStandardNewMacro(vtkBrumeEffectPlan);

struct vtkBrumeEffectPlan::Internals
{
  std::map<brume::Effect, bool> Forces;
  brume::EffectPlan Plan;

  const brume::PlannedEffect* Effect(int index) const
  {
    return index >= 0 && index < brume::effect_count ? &this->Plan.effects[index] : nullptr;
  }
};

vtkBrumeEffectPlan::vtkBrumeEffectPlan()
  : Internal(std::make_unique<Internals>())
{
  for (int i = 0; i < brume::effect_count; ++i)
  {
    this->Internal->Plan.effects[i].effect = static_cast<brume::Effect>(i);
  }
}

vtkBrumeEffectPlan::~vtkBrumeEffectPlan() = default;

int vtkBrumeEffectPlan::GetNumberOfEffects()
{
  return brume::effect_count;
}

const char* vtkBrumeEffectPlan::GetEffectName(int index)
{
  return index >= 0 && index < brume::effect_count
           ? brume::effect_name(static_cast<brume::Effect>(index))
           : nullptr;
}

int vtkBrumeEffectPlan::GetEffectIndex(const char* name)
{
  std::string wanted = name ? name : "";
  for (char& c : wanted)
  {
    c = c == '-' || c == '_' ? ' ' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  for (int i = 0; i < brume::effect_count; ++i)
  {
    if (wanted == brume::effect_name(static_cast<brume::Effect>(i)))
    {
      return i;
    }
  }
  return -1;
}

bool vtkBrumeEffectPlan::GetEffectOn(int index) const
{
  const brume::PlannedEffect* effect = this->Internal->Effect(index);
  return effect && effect->on;
}

bool vtkBrumeEffectPlan::GetEffectOn(const char* name) const
{
  return this->GetEffectOn(GetEffectIndex(name));
}

const char* vtkBrumeEffectPlan::GetEffectReason(int index) const
{
  const brume::PlannedEffect* effect = this->Internal->Effect(index);
  return effect ? effect->reason.c_str() : "";
}

const char* vtkBrumeEffectPlan::GetEffectReason(const char* name) const
{
  return this->GetEffectReason(GetEffectIndex(name));
}

double vtkBrumeEffectPlan::GetEffectErrorBound(int index) const
{
  const brume::PlannedEffect* effect = this->Internal->Effect(index);
  return effect ? effect->error_bound : 0.0;
}

double vtkBrumeEffectPlan::GetEffectErrorBound(const char* name) const
{
  return this->GetEffectErrorBound(GetEffectIndex(name));
}

bool vtkBrumeEffectPlan::GetEffectForced(int index) const
{
  const brume::PlannedEffect* effect = this->Internal->Effect(index);
  return effect && effect->forced;
}

bool vtkBrumeEffectPlan::GetEffectForced(const char* name) const
{
  return this->GetEffectForced(GetEffectIndex(name));
}

double vtkBrumeEffectPlan::GetErrorBound() const
{
  return this->Internal->Plan.error_bound();
}

bool vtkBrumeEffectPlan::Force(const char* name, bool on)
{
  const int index = GetEffectIndex(name);
  if (index < 0)
  {
    std::string names;
    for (int i = 0; i < brume::effect_count; ++i)
    {
      names += (i > 0 ? ", " : "") + std::string(GetEffectName(i));
    }
    vtkWarningMacro("There is no effect '" << (name ? name : "") << "' to be forced: name one of "
                                           << names << '.');
    return false;
  }
  const auto effect = static_cast<brume::Effect>(index);
  const auto known = this->Internal->Forces.find(effect);
  if (known == this->Internal->Forces.end() || known->second != on)
  {
    this->Internal->Forces[effect] = on;
    this->Modified();
  }
  return true;
}

void vtkBrumeEffectPlan::ForceNothing()
{
  if (!this->Internal->Forces.empty())
  {
    this->Internal->Forces.clear();
    this->Modified();
  }
}

const std::map<brume::Effect, bool>& vtkBrumeEffectPlan::GetForces() const
{
  return this->Internal->Forces;
}

void vtkBrumeEffectPlan::SetPlan(const brume::EffectPlan& plan)
{
  this->Internal->Plan = plan;
  this->Planned = true;
}

const brume::EffectPlan& vtkBrumeEffectPlan::GetPlan() const
{
  return this->Internal->Plan;
}

void vtkBrumeEffectPlan::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Planned: " << (this->Planned ? "Yes" : "No") << '\n';
  os << indent << "Forces: " << (this->Internal->Forces.empty() ? "(none)" : "") << '\n';
  for (const auto& force : this->Internal->Forces)
  {
    os << indent.GetNextIndent() << brume::effect_name(force.first) << ": "
       << (force.second ? "On" : "Off") << '\n';
  }
  os << indent << "ErrorBound: " << this->GetErrorBound() << '\n';
  os << indent << "Effects:\n";
  for (const brume::PlannedEffect& effect : this->Internal->Plan.effects)
  {
    os << indent.GetNextIndent() << brume::effect_name(effect.effect) << ": "
       << (effect.on ? "On" : "Off") << (effect.forced ? " (forced)" : "") << ", at most "
       << effect.error_bound << ": " << effect.reason << '\n';
  }
}
