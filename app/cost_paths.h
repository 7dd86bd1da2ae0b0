// The path tracer in a study: as the truth, and as a knob.
#pragma once

#include "cost_setting.h"

#include "Analysis/study.h"
#include "Transport/film.h"

#include "vtkNew.h"

#include <cstdint>

class vtkBrumePathTraceMapper;

namespace brume::app
{

class StudyClock;

/// Why paths do not draw the scene; empty where they do.
std::string not_drawn_by_paths(const VolumeScene& scene);

/// Whether paths are the scene's truth: light is scattered, and by nothing that paths do not know.
bool is_truth_by_paths(const VolumeScene& scene);

/// Traces paths through one scene.
class CostPaths
{
public:
  /// `surfaces`: the scene's. The scene must outlive it.
  CostPaths(const VolumeScene& scene, const SurfacePicture& surfaces);
  ~CostPaths();

  /// Two halves of a truth, in `seconds` of tracing altogether, and with no more than the user's
  /// --samples-per-pixel. The film has their mean radiance. Throws Failure.
  StudyTruth truth(double seconds, StudyClock& clock, Film& film);

  /// A picture of so many paths a pixel, other ones each time it is called.
  CostRender draw(int samples_per_pixel, const Watch& watch);

private:
  /// One picture; its statistics become `statistics`.
  Film trace(std::uint32_t seed, const Watch& watch, std::string& statistics);

  const VolumeScene& Scene;
  const SurfacePicture& Surfaces;
  std::uint32_t FirstSeed;
  std::uint32_t Drawn = 0; ///< pictures so far, truth's halves among them
  Watch Whole;
  vtkNew<vtkBrumePathTraceMapper> Mapper;
};

}
