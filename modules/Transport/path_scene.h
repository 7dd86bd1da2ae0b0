// Light followed through a scene, one path at a time. Theory: docs/theory/paths.md. Internal to
// Transport.
#pragma once

#include "Transport/lamp.h"
#include "Transport/path_matter.h"
#include "Transport/path_packets.h"
#include "Transport/random_stream.h"
#include "Transport/reference_medium.h"
#include "Transport/scene.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace brume
{

/// What following paths took.
struct PathCounts
{
  std::uint64_t collisions = 0;  ///< tentative ones: places at which matter was read
  std::uint64_t scatterings = 0; ///< real ones that sent light on
  std::uint64_t shadow_rays = 0;
};

/// A scene prepared for paths.
class PathScene
{
public:
  /// Keeps a reference to the scene. Throws std::invalid_argument for what cannot be traced:
  /// another blend mode than composite.
  explicit PathScene(const Scene& scene);

  /// An estimate of the radiance that arrives at `begin` from the direction `along` (a unit vector
  /// of the world), from no farther than `length`; light from behind that was not scattered does
  /// not count. Unbiased: its expectation is the solution of the radiative transfer equation with
  /// up to `most_scatterings` scatterings (0: any number).
  glm::dvec3 radiance(const glm::dvec3& begin,
    const glm::dvec3& along,
    double length,
    int most_scatterings,
    RandomStream& random,
    PathCounts& counts) const;

  /// What trace_paths() needs; null for a scene that it does not know.
  const PathPacketScene* packets() const { return this->Packets.get(); }
  /// A path of radiance() as trace_paths() takes it, but for its pixel; false where it meets
  /// nothing.
  bool find_start(const glm::dvec3& begin,
    const glm::dvec3& along,
    double length,
    PathStart& start) const;

  /// Whether any ray can meet matter that sends light.
  bool can_send() const;

  std::size_t non_finite_voxels() const;

  /// Whether a density falls below 0 somewhere, where it counts as 0: the extinction then has a
  /// kink inside a cell.
  bool has_kinks() const;

private:
  struct Path;
  struct Collision;
  class Tracker;

  bool collide(const glm::dvec3& begin,
    const glm::dvec3& along,
    double length,
    Path& path,
    Collision& found) const;
  /// What the lamps send on to `toward` from a place where light was scattered.
  glm::dvec3 lit(const glm::dvec3& place,
    const glm::dvec3& along,
    const PhaseSampler& phase,
    Path& path) const;
  /// An estimate of the transmittance of all matter between two places.
  glm::dvec3 transmittance(const glm::dvec3& begin,
    const glm::dvec3& along,
    double length,
    Path& path) const;
  glm::dvec3 sky(const glm::dvec3& direction) const;
  void find_packets();

  const Scene& TheScene;
  std::vector<ReferenceMedium> Media;
  std::vector<std::unique_ptr<PathMatter>> Matter;
  std::unique_ptr<PathPacketScene> Packets;
  std::vector<Lamp> Lamps;
  std::vector<double> LampUpTo; ///< sums of the chances to be taken; the last is 1
  bool Glows = false;           ///< light comes from elsewhere than lamps: sky, ground, matter
  bool Coloured = false;        ///< some extinction differs between R, G and B
};

}
