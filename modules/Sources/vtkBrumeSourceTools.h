// What the sources of this module share: how a brume::Lattice is told to VTK. Not installed.
#ifndef vtkBrumeSourceTools_h
#define vtkBrumeSourceTools_h

#include "data-generators/sampling.h"

#include "vtkAlgorithm.h"
#include "vtkDataObject.h"
#include "vtkInformation.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <cmath>
#include <stdexcept>
#include <vector>

namespace brume
{

/// Tells the pipeline the whole extent, origin, spacing and type of a grid's one scalar.
inline void describe_grid(const Lattice& grid, int scalar_type, vtkInformation* info)
{
  const int extent[6] = {
    0, grid.dimensions.x - 1, 0, grid.dimensions.y - 1, 0, grid.dimensions.z - 1
  };
  info->Set(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), extent, 6);
  info->Set(vtkDataObject::ORIGIN(), grid.origin.x, grid.origin.y, grid.origin.z);
  info->Set(vtkDataObject::SPACING(), grid.spacing.x, grid.spacing.y, grid.spacing.z);
  vtkDataObject::SetPointDataActiveScalarInfo(info, scalar_type, 1);
  info->Set(vtkAlgorithm::CAN_PRODUCE_SUB_EXTENT(), 1);
}

/// Tells the pipeline that any moment can be had, and which ones to ask for: `steps` of them, evenly
/// from the first to the last; the first alone where the last is not after it. Throws
/// std::invalid_argument where either is not finite.
inline void describe_time(double first, double last, int steps, vtkInformation* info)
{
  if (!std::isfinite(first) || !std::isfinite(last))
  {
    throw std::invalid_argument("StartTime and EndTime must be finite");
  }
  std::vector<double> times(1, first);
  for (int n = 1; n < steps && last > first; ++n)
  {
    times.push_back(n == steps - 1 ? last : first + n * ((last - first) / (steps - 1)));
  }
  const double range[2] = { times.front(), times.back() };
  info->Set(vtkStreamingDemandDrivenPipeline::TIME_STEPS(),
    times.data(),
    static_cast<int>(times.size()));
  info->Set(vtkStreamingDemandDrivenPipeline::TIME_RANGE(), range, 2);
}

/// The moment that the pipeline asks for, or the source's own.
inline double requested_time(vtkInformation* info, double own)
{
  return info->Has(vtkStreamingDemandDrivenPipeline::UPDATE_TIME_STEP())
           ? info->Get(vtkStreamingDemandDrivenPipeline::UPDATE_TIME_STEP())
           : own;
}

/// VTK's six numbers as first and last voxel.
inline Extent extent_of(const int e[6])
{
  return { { e[0], e[2], e[4] }, { e[1], e[3], e[5] } };
}

/// Passes progress to VTK's observers, as the part of the work from `from` to `to`, and their wish to
/// abort back.
inline Progress progress_of(vtkAlgorithm* algorithm, double from = 0.0, double to = 1.0)
{
  return [algorithm, from, to](double done)
  {
    algorithm->UpdateProgress(from + (to - from) * done);
    return !algorithm->GetAbortExecute();
  };
}

}

#endif
