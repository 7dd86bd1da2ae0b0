// Which settings nothing beats.
#pragma once

#include "vtkBrumeAnalysisModule.h"

#include <cstddef>
#include <vector>

namespace brume
{

/// What a setting costs and how wrong it is; less is better in both.
struct Cost
{
  double seconds = 0.0;
  double error = 0.0;
};

/// The Pareto front: the indices of the costs that no other one beats, from the cheapest to the most
/// accurate. One cost beats another where it is less in one and no more in the other; of equal ones
/// the first is on the front. Costs that are not finite numbers are never on it.
VTKBRUMEANALYSIS_EXPORT std::vector<std::size_t> pareto_front(const std::vector<Cost>& costs);

}
