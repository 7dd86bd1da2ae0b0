// The path tracer in a comparison: as one of the mappers, and as the truth.
#pragma once

#include "mesh_scene.h"
#include "volume_scene.h"

#include "Transport/film.h"

#include "vtkNew.h"

#include <cstdint>
#include <string>

class vtkBrumePathTraceMapper;

namespace brume::app
{

class ComparePaths
{
public:
  /// `surfaces`: the scene's. Both must outlive it.
  ComparePaths(const VolumeScene& scene, const SurfacePicture& surfaces);
  ~ComparePaths();

  /// The picture that brume render draws, but of other random numbers for each `draw`. Its statistics (JSON)
  /// become `statistics`. Throws Failure.
  Film draw(std::uint32_t draw, std::string& statistics);
  /// With 16 times as many paths as at most for draw(), whatever the tolerance and the time.
  Film truth(std::string& statistics);

private:
  Film trace(std::uint32_t seed, const std::string& task, std::string& statistics);

  const VolumeScene& Scene;
  vtkNew<vtkBrumePathTraceMapper> Mapper;
};

}
