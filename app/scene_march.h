// Brume's ray march of a scene, watched: what compare and cost draw with.
#pragma once

#include "mesh_scene.h"
#include "volume_scene.h"

#include "Analysis/picture.h"
#include "Transport/film.h"

#include "vtkNew.h"

#include <functional>

class vtkAlgorithm;
class vtkBrumeRayMarchMapper;
class vtkBrumeVolumeMapper;

namespace brume::app
{

/// Told the part of a render that is done, in [0, 1]; returns false to stop it.
using Watch = std::function<bool(double)>;

/// Lets `watch` see a mapper's progress and stop it. It must outlive the mapper's renders; an empty one
/// sees nothing.
void observe(vtkAlgorithm* mapper, const Watch& watch);

/// The film of a scene drawn by a mapper that has all of it and whose renders `whole` observes; `watch` is
/// asked on the way. `command` is who says that a render was interrupted. Throws Failure, and
/// SceneMarch::Stopped where `watch` stopped it.
Film draw_watched(const VolumeScene& scene,
  vtkBrumeVolumeMapper* mapper,
  Watch& whole,
  const Watch& watch,
  const char* command);

/// A mapper that has all of a scene, and its surfaces.
class SceneMarch
{
public:
  /// Draws the scene's surfaces. `command` is who says that a render was interrupted. The scene must
  /// outlive it. Of several for one scene, the last one made has its volume until another takes it.
  SceneMarch(const VolumeScene& scene, const char* command);
  ~SceneMarch();

  vtkBrumeRayMarchMapper* mapper() { return this->Mapper; }
  const VolumeScene& scene() const { return this->Scene; }
  const SurfacePicture& surfaces() const { return this->Surfaces; }
  const char* command() const { return this->Command; }

  /// Gives the scene's volume to this mapper.
  void take_volume();

  /// Who sees progress. Without one a render goes on until the user interrupts it.
  void watch(Watch watch) { this->Watching = std::move(watch); }

  /// The film, of the scene's own size or of another (without surfaces then). Throws Failure where the
  /// scene cannot be drawn or the user interrupted, Stopped where the watch stopped it.
  ///@{
  Film draw();
  Film draw(int width, int height);
  ///@}

  /// The film over the surfaces or the scene's background.
  Picture over(const Film& film) const;

  /// What draw() throws where its watch, rather than the user, stopped it.
  struct Stopped
  {
  };

private:
  const VolumeScene& Scene;
  SurfacePicture Surfaces;
  const char* Command;
  Watch Watching;
  Watch Whole; ///< Watching, and the user
  vtkNew<vtkBrumeRayMarchMapper> Mapper;
};

}
