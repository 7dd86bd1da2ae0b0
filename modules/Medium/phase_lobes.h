// Lists of lobes as users make them, checked; for vtkBrumeMedium and others with a phase function.
#ifndef phase_lobes_h
#define phase_lobes_h

#include "vtkBrumeMediumModule.h" // the export macro alone

#include "Transport/medium.h"

#include <string>
#include <vector>

namespace brume
{

/// Adds a lobe. g is cut to ±0.9999, and not kept for functions without one. Returns an empty
/// string, or what is wrong, and adds nothing: a weight that is not positive or not finite, a g
/// that is not finite.
VTKBRUMEMEDIUM_EXPORT std::string add_lobe(std::vector<PhaseLobe>& lobes,
  PhaseFunction function,
  double weight,
  double anisotropy = 0.0);

/// The mean of the lobes' anisotropies by weight, which is the mean cosine of the mixture; 0 for
/// none.
VTKBRUMEMEDIUM_EXPORT double mean_anisotropy(const std::vector<PhaseLobe>& lobes);

/// "isotropic", "rayleigh", "henyey-greenstein" or "schlick".
VTKBRUMEMEDIUM_EXPORT const char* phase_function_name(PhaseFunction function);

}

#endif
