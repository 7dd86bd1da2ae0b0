// What pictures of a scene are measured against.
#pragma once

#include "scene_march.h"

#include "Analysis/comparison.h"
#include "Analysis/image_errors.h"
#include "Transport/film.h"
#include "Transport/reference.h"

#include <string>

class vtkBrumeVolumeMapper;

namespace brume::app
{

/// A true picture, and the film that it was made of.
struct SceneTruth
{
  Truth truth;
  Film film;
};

/// Whether the scene only absorbs and emits, which double precision computes for all pixels.
bool only_absorbs(const VolumeScene& scene);

/// What double precision finds.
struct QuadratureFilm
{
  Film film;
  ReferenceStatistics statistics;
  double tolerance = 0.0;    ///< at which rays settle
  int refinement_levels = 0; ///< halvings that were allowed
};

/// The scene as this mapper has it, in double precision. `task` is what the bar says, `command` who was
/// interrupted. `watch` sees progress in place of a bar, if it is not empty.
QuadratureFilm quadrature(const VolumeScene& scene,
  vtkBrumeVolumeMapper* mapper,
  vtkVolume* volume,
  const std::string& task,
  const char* command,
  const Watch& watch = {});

/// The truth of a scene that only absorbs and emits: double precision.
SceneTruth truth_by_quadrature(SceneMarch& march, const Watch& watch = {});

/// The truth of lit media, scattered once: the ray march with shadow rays, its steps halved from `step`
/// (world units) on until the picture stands still, and checked by double precision at some pixels.
/// The mapper's settings are afterwards what simulate_as_asked() makes of them.
SceneTruth truth_by_march(SceneMarch& march, double step, const Watch& watch = {});

/// Sets the mapper to what the user asked for, its steps fixed (world units).
void simulate_as_asked(SceneMarch& march, double step);

}
