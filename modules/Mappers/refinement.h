// Whether a path-traced picture may go on where the last one stopped. Internal to Mappers.
#ifndef refinement_h
#define refinement_h

#include "step_key.h"

#include "Transport/path_tracer.h"
#include "Transport/scene.h"

#include "vtkType.h"

#include <memory>
#include <vector>

namespace brume
{

/// What the last picture was of. Other than SceneKey alone, nothing at all may have changed:
/// neither the camera, nor places, nor the surfaces in front.
class Refinement
{
public:
  /// Whether paths of the last picture are paths of this one, too; takes this one for the last.
  /// `modified`: when the mapper or anything that it holds changed last.
  bool goes_on(const Scene& scene,
    const PathSettings& settings,
    int width,
    int height,
    vtkMTimeType modified);
  /// The next picture begins anew.
  void end() { this->Taken = false; }

private:
  bool Taken = false;
  SceneKey Key;
  std::vector<double> Rest;
  std::vector<float> SurfaceDepth;
  /// Kept, so that no other map can have its address.
  std::shared_ptr<const PlacedEnvironment> Environment;
};

}

#endif
