// What choices for a picture hang on: the step, the effects. Internal to Mappers.
#ifndef step_key_h
#define step_key_h

#include "Transport/scene.h"

#include <glm/vec3.hpp>

#include <vector>

namespace brume
{

/// Whether the scene has what lights shine through: a lit medium, or fog.
bool is_lit(const Scene& scene);

/// Whether a choice that was made for a scene still holds for another.
///
/// It does while voxels, classification, media, blend mode, shading, sky, fog and the colours of
/// the lights of lit scenes stay. The camera may move, and lights with it: a light counts as moved
/// when it has changed its place in the world and before the camera as well. Of scenes without lit
/// media and fog the lights do not count at all.
class SceneKey
{
public:
  /// `more`: whatever else the choice hangs on.
  bool Holds(const Scene& scene, const std::vector<double>& more) const;
  /// `places`: whether lights that move end the choice.
  void Take(const Scene& scene, const std::vector<double>& more, bool places = true);
  void Clear();

private:
  /// A light's position and direction in the world, and where the camera has them in its picture.
  struct Place
  {
    glm::dvec3 world[2];
    glm::dvec3 seen[2];
  };
  static std::vector<double> NumbersOf(const Scene& scene, const std::vector<double>& more);
  static std::vector<Place> PlacesOf(const Scene& scene);

  std::vector<double> Numbers;
  std::vector<Place> Places;
};

}

#endif
