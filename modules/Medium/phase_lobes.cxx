#include "phase_lobes.h"

#include <algorithm>
#include <cmath>

namespace brume
{

std::string add_lobe(std::vector<PhaseLobe>& lobes,
  PhaseFunction function,
  double weight,
  double anisotropy)
{
  if (!(weight > 0.0) || !std::isfinite(weight))
  {
    return "a lobe's weight must be a positive finite number";
  }
  const bool reads =
    function == PhaseFunction::HenyeyGreenstein || function == PhaseFunction::Schlick;
  if (reads && !std::isfinite(anisotropy))
  {
    return "a lobe's anisotropy must be a finite number, between -1 and 1";
  }
  PhaseLobe lobe;
  lobe.function = function;
  lobe.weight = weight;
  lobe.anisotropy = reads ? std::clamp(anisotropy, -0.9999, 0.9999) : 0.0;
  lobes.push_back(lobe);
  return {};
}

double mean_anisotropy(const std::vector<PhaseLobe>& lobes)
{
  double sum = 0.0;
  double weights = 0.0;
  for (const PhaseLobe& lobe : lobes)
  {
    sum += lobe.weight * lobe.anisotropy;
    weights += lobe.weight;
  }
  return weights > 0.0 ? sum / weights : 0.0;
}

const char* phase_function_name(PhaseFunction function)
{
  switch (function)
  {
    case PhaseFunction::Rayleigh:
      return "rayleigh";
    case PhaseFunction::HenyeyGreenstein:
      return "henyey-greenstein";
    case PhaseFunction::Schlick:
      return "schlick";
    default:
      return "isotropic";
  }
}

}
