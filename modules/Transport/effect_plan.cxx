#include "Transport/effect_plan.h"

namespace brume
{

EffectSet EffectPlan::on() const
{
  EffectSet set;
  for (const PlannedEffect& planned : this->effects)
  {
    set.set(planned.effect, planned.on);
  }
  return set;
}

double EffectPlan::error_bound() const
{
  double sum = 0.0;
  for (const PlannedEffect& planned : this->effects)
  {
    sum += planned.error_bound;
  }
  return sum;
}

}
