// Where the puffs of heaped clouds are. Internal to the generators.
#pragma once

#include "data-generators/clouds.h"
#include "data-generators/puffs.h"

#include <vector>

namespace brume
{

/// Buds on a puff, on their sides and tops rather than below, and buds on these: `generations` of
/// them. The puff itself is added, too.
void add_buds(std::vector<Puff>& puffs,
  const Puff& parent,
  int generations,
  RandomSequence& random);

/// Puffs in widths of the box, of a field none nearer to its sides than `border`.
std::vector<Puff> pile_cumulus_field(const CloudOptions& options, double border);
std::vector<Puff> pile_cumulonimbus(const CloudOptions& options);

}
