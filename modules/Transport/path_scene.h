// Light followed through a scene, one path at a time. Theory: docs/theory/paths.md. Internal to
// Transport.
#pragma once

#include "Transport/lamp.h"
#include "Transport/path_environment.h"
#include "Transport/path_fog.h"
#include "Transport/path_lamps.h"
#include "Transport/path_matter.h"
#include "Transport/path_packets.h"
#include "Transport/random_stream.h"
#include "Transport/reference_medium.h"
#include "Transport/scene.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
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

  /// Called once in some ten thousand collisions: a path may be long. Throws PathsStopped where the
  /// paths in hand are no longer wanted. Empty: they always are.
  std::function<void()> look_up;
  static constexpr std::uint64_t between_looks = 1 << 15;

  void collide()
  {
    if (++this->collisions % between_looks == 0 && this->look_up)
    {
      this->look_up();
    }
  }
  void scatter()
  {
    if (++this->scatterings % between_looks == 0 && this->look_up)
    {
      this->look_up();
    }
  }
};

struct PathsStopped
{
};

/// A ray that light is looked for on. Of the camera's, volumes and fog may begin and end apart.
struct Sight
{
  glm::dvec3 begin{ 0.0 };                                 ///< in the world
  glm::dvec3 along{ 0.0 };                                 ///< a unit vector
  double length = std::numeric_limits<double>::infinity(); ///< up to which there are volumes
  double fog_before = 0.0; ///< how far before `begin` the fog begins; may be negative
  double fog_length = std::numeric_limits<double>::infinity(); ///< from `begin` to its end
  bool fog_undrawn =
    false; ///< no collisions with the fog; it dims what is sent in it, and not the sky
};

/// A scene prepared for paths.
class PathScene
{
public:
  /// Keeps a reference to the scene. `environment`, which may be null, is light from all around
  /// beside the scene's sky. Throws std::invalid_argument for what cannot be traced: another blend
  /// mode than composite, and what PathFog and PathEnvironment refuse.
  PathScene(const Scene& scene,
    int most_scatterings,
    std::shared_ptr<const PlacedEnvironment> environment = nullptr);

  /// An estimate of the radiance that arrives at `from` from the direction it looks along; light
  /// from behind that was not scattered does not count. Unbiased: its expectation is the solution
  /// of the radiative transfer equation with up to so many scatterings (0: any number).
  glm::dvec3 radiance(const Sight& from, RandomStream& random, PathCounts& counts) const;

  /// What trace_paths() needs; null for a scene that it does not know.
  const PathPacketScene* packets() const { return this->Packets.get(); }
  /// A path of radiance() as trace_paths() takes it, but for its pixel; false where it meets
  /// nothing.
  bool find_start(const Sight& sight, PathStart& start) const;
  int most_scatterings() const { return this->MostScatterings; }

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
  /// An estimate of the transmittance of all volumes between two places.
  glm::dvec3 transmittance(const glm::dvec3& begin,
    const glm::dvec3& along,
    double length,
    Path& path) const;

  // path_light.cxx
  bool meet(const Sight& sight, double floor, Path& path, Collision& found) const;
  glm::dvec3 clearance(const glm::dvec3& begin,
    const glm::dvec3& along,
    double length,
    Path& path) const;
  glm::dvec3 scattered(const glm::dvec3& place,
    const glm::dvec3& along,
    const glm::dvec3& toward,
    bool with_volumes,
    Path& path) const;
  double near_radius(const Lamp& lamp) const;
  glm::dvec3 lit_at(
    const NearLamp& near, const LampPlace& at, bool with_volumes, Path& path) const;
  glm::dvec3 near_on_ray(const Sight& sight, Path& path) const;
  glm::dvec3 near_from(const glm::dvec3& place,
    const glm::dvec3& along,
    const PhaseSampler& phase,
    Path& path) const;
  /// What the lamps send on to `toward` from a place where light was scattered.
  glm::dvec3 lit(const glm::dvec3& place,
    const glm::dvec3& along,
    const PhaseSampler& phase,
    Path& path) const;
  glm::dvec3 lit_from_around(const glm::dvec3& place,
    const glm::dvec3& along,
    const PhaseSampler& phase,
    Path& path) const;
  glm::dvec3 sky(const glm::dvec3& toward, double phase) const;
  void find_packets();

  const Scene& TheScene;
  std::vector<ReferenceMedium> Media;
  std::vector<std::unique_ptr<PathMatter>> Matter;
  std::unique_ptr<PathPacketScene> Packets;
  std::vector<Lamp> Lamps;
  std::vector<double> LampUpTo; ///< sums of the chances to be taken; the last is 1
  /// Of each lamp: within it, it is one of NearLamps; 0: nowhere.
  std::vector<double> NearRadius;
  std::vector<NearLamp> NearLamps;
  std::unique_ptr<PathFog> Fog; ///< null where there is none
  PathEnvironment Around;
  bool AroundIsSought = false; ///< at scatterings, and not only where paths leave
  int MostScatterings;
  bool Glows = false;    ///< light comes from elsewhere than lamps: sky, ground, map, matter
  bool Coloured = false; ///< some extinction differs between R, G and B
};

}
