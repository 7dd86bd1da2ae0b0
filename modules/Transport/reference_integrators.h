// The truth along one ray, a kind for each blend mode. Internal to Transport.
#pragma once

#include "Transport/reference_lighting.h"
#include "Transport/reference_medium.h"
#include "Transport/reference_ray.h"

#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

namespace brume
{

/// A scene as the reference reads it.
struct ReferenceScene
{
  explicit ReferenceScene(const Scene& the_scene)
    : scene(the_scene)
  {
    this->media.reserve(the_scene.volumes.size());
    for (const Volume& volume : the_scene.volumes)
    {
      this->media.emplace_back(the_scene, volume);
    }
    if (needs_lighting(the_scene))
    {
      this->lighting = std::make_unique<ReferenceLighting>(the_scene, this->media);
    }
  }

  const Scene& scene;
  std::vector<ReferenceMedium> media;
  std::unique_ptr<ReferenceLighting> lighting; ///< of lit media and coloured extinction; else null
};

struct RayResult
{
  glm::dvec3 radiance{ 0.0 };
  glm::dvec3 transmittance{ 1.0 };
  double half_way = std::numeric_limits<double>::infinity(); ///< s; see Film::depth
  std::uint64_t samples = 0;

  /// The transmittance of the clearest channel.
  double passes() const
  {
    return std::max({ this->transmittance.x, this->transmittance.y, this->transmittance.z });
  }
  double change_from(const RayResult& other) const
  {
    const glm::dvec3 d = glm::max(glm::abs(this->radiance - other.radiance),
      glm::abs(this->transmittance - other.transmittance));
    return std::max({ d.x, d.y, d.z });
  }
  /// To be called at each s in order: fills in half_way.
  void passed(double s)
  {
    if (std::isinf(this->half_way) && this->passes() < 0.5)
    {
      this->half_way = s;
    }
  }
};

class RayIntegral
{
public:
  virtual ~RayIntegral() = default;
  /// With so many pieces in each stretch between cell borders.
  virtual RayResult integrate(int pieces) const = 0;
  /// Whether the result does not depend on the pieces.
  virtual bool exact() const { return false; }
};

/// The integral of the scene's blend mode; keeps references to both.
std::unique_ptr<RayIntegral> make_ray_integral(const ReferenceScene& scene, const PixelRay& ray);

/// One place s of a composite, which stands for a stretch of `width`, both in parts of the ray.
void pass_sample(const ReferenceScene& scene,
  const PixelRay& ray,
  const int* volumes,
  std::size_t count,
  double s,
  double width,
  RayResult& result);

/// Further pieces of a stretch for each whole rise or fall of a transfer function in it, and their
/// bound: so that two coarse results do not agree on having missed a peak.
inline int extra_pieces(double variation)
{
  constexpr double pieces_across = 8.0;
  constexpr int most_factor = 63;
  return 1 + static_cast<int>(std::min(pieces_across * variation, double(most_factor)));
}

/// Below this transmittance nothing can be seen in a float picture.
constexpr double nothing_passes = 1e-9;

std::unique_ptr<RayIntegral> make_composite(const ReferenceScene& scene, const PixelRay& ray);
/// Composite with ReferenceScene::lighting.
std::unique_ptr<RayIntegral> make_lit(const ReferenceScene& scene, const PixelRay& ray);
std::unique_ptr<RayIntegral> make_extreme(const ReferenceScene& scene, const PixelRay& ray);
std::unique_ptr<RayIntegral> make_grey(const ReferenceScene& scene, const PixelRay& ray);
std::unique_ptr<RayIntegral> make_isosurface(const ReferenceScene& scene, const PixelRay& ray);
std::unique_ptr<RayIntegral> make_slice(const ReferenceScene& scene, const PixelRay& ray);

}
