// Formulas of optics as the kernels have them: in packets of single precision, with the instruction
// set that is chosen (force_simd_target).
#pragma once

#include "Transport/black_body.h"
#include "Transport/medium.h"
#include "Transport/phase.h"

#include <vector>

namespace optics_packets
{

enum class Formula
{
  Opacity,
  MeanTransmittance,
  Phase,
  ExponentialIntegral,
  FogColumn,
  PowderFactor,
  BlackBodyRed,
  ReciprocalRoot,
};

/// Each takes vectors of one length and gives one number for each place.
using Numbers = std::vector<float>;

Numbers opacity(const Numbers& optical_depth);
/// (1 − e^(−x)) / x
Numbers mean_transmittance(const Numbers& x);
Numbers phase(const brume::PhaseModel& model,
  const Numbers& one_minus_cosine,
  const Numbers& one_plus_cosine);
Numbers second_exponential_integral(const Numbers& x);
/// ∫ f ds of fog, see fog-inl.h.
Numbers fog_column(const Numbers& begin,
  const Numbers& end,
  const Numbers& fall,
  const Numbers& length);
Numbers powder(const brume::Powder& powder, const Numbers& value, const Numbers& height);
/// R of a black body.
Numbers black_body(const brume::BlackBodyTable& table, const Numbers& kelvin);
Numbers reciprocal_square_root(const Numbers& x);

}
