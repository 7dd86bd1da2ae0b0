// Values from users on their way into a setting; for vtkBrumeMedium, vtkBrumeFog and their like.
#ifndef checked_values_h
#define checked_values_h

#include "vtkObject.h"

#include <algorithm>
#include <cmath>

namespace brume
{

/// Puts finite values, clamped to [lower, upper], into a setting and marks its owner as modified
/// where that changes it. Values that are not finite are refused with a warning, all of them.
template <int count>
void set_values(vtkObject* owner,
  const char* name,
  double (&setting)[count],
  const double (&values)[count],
  double lower,
  double upper)
{
  bool changes = false;
  double clamped[count];
  for (int i = 0; i < count; ++i)
  {
    if (!std::isfinite(values[i]))
    {
      vtkWarningWithObjectMacro(
        owner, << name << " must be finite, not " << values[i] << "; the old value is kept.");
      return;
    }
    clamped[i] = std::clamp(values[i], lower, upper);
    changes = changes || clamped[i] != setting[i];
  }
  if (changes)
  {
    std::copy(clamped, clamped + count, setting);
    owner->Modified();
  }
}

inline void set_value(vtkObject* owner,
  const char* name,
  double& setting,
  double value,
  double lower,
  double upper)
{
  double one[1] = { setting };
  set_values(owner, name, one, { value }, lower, upper);
  setting = one[0];
}

/// For settings that must be above 0: others are refused with a warning.
inline void set_positive(vtkObject* owner, const char* name, double& setting, double value)
{
  if (!(value > 0.0) || !std::isfinite(value))
  {
    vtkWarningWithObjectMacro(owner,
      << name << " must be a positive finite number, not " << value << "; kept: " << setting
      << '.');
    return;
  }
  if (value != setting)
  {
    setting = value;
    owner->Modified();
  }
}

}

#endif
