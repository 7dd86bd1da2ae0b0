// The generators' kernels for the SIMD target of the machine. Internal to the generators.
#pragma once

#include "data-generators/field.h"
#include "data-generators/noise_field.h"

namespace brume
{

/// The noise at all places of a block: what NoiseField::value() gives, to the bit.
void noise_packets(const NoiseOptions& options, const PlaceBlock& places, float* out);

}
