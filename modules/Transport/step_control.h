// Choosing the step of a march from the error that is accepted.
#pragma once

#include "Transport/scene.h"

namespace brume
{

/// A step and what it is expected to cost in accuracy.
struct StepChoice
{
  double step = 1.0;            ///< in the data's units
  double estimated_error = 0.0; ///< largest error of a pixel, as a fraction of white
  bool met = false;             ///< whether the estimate is within the tolerance asked for
};

/// The longest of 2, 1, ½, … and 1/32 of the smallest voxel edge with which the picture's largest
/// error is expected to be within `tolerance` (a fraction of white, > 0); 1/32 where none is.
///
/// The expectation is measured: up to 256 rays spread over the picture of `width` × `height` pixels
/// are integrated in double precision with each step and with half of it. The midpoint rule's error
/// falls with the square of the step, so that 4/3 of the largest change is the error of the longer.
StepChoice choose_step(const Scene& scene, int width, int height, double tolerance);

/// The smallest edge of a voxel, in the data's units.
double smallest_voxel_edge(const Scene& scene);

}
