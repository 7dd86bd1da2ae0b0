// Phase functions and E₂ as the kernels have them: in packets of single precision.
#pragma once

#include "Transport/phase.h"

#include <cstddef>

/// The phase function at `count` angles, a multiple of 16, with the instruction set that is chosen.
void packet_phase(const brume::PhaseModel& model,
  const float* one_minus_cosine,
  const float* one_plus_cosine,
  std::size_t count,
  float* result);

/// E₂ at `count` places, a multiple of 16.
void packet_second_exponential_integral(const float* x, std::size_t count, float* result);
