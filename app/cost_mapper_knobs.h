// The knobs of mappers other than the ray march, and figures as their settings' names have them.
#pragma once

#include "cost_knobs.h"

#include <string>

namespace brume::app
{

/// Paths through each pixel of the path tracer.
CostKnob path_knob(CostScene& scene);
/// What is chosen for an error or a time.
CostKnob smart_knob(CostScene& scene);
/// VTK's own mappers.
CostKnob stock_knob(CostScene& scene);

/// "1/8", "1/2", "1", "4".
std::string part(double value);
/// "0.064".
std::string decimal(double value);

}
