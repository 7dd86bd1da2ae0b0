// What a scene holds at the most, looked at by small films: the figures that effects are planned
// by. Internal to Transport. Theory: docs/theory/plan.md.
#pragma once

#include "Transport/marcher.h"
#include "Transport/scene.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace brume
{

/// Numbers that a figure was found by: it holds as long as they stay.
class PlanKey
{
public:
  void add(double value);
  void add(std::uint64_t value) { this->Words.push_back(value); }
  void add(const glm::dvec3& v);
  void add(const glm::dmat4& m);
  bool operator==(const PlanKey& other) const { return this->Words == other.Words; }

private:
  std::vector<std::uint64_t> Words;
};

/// Bounds of what one volume holds.
struct MatterFigures
{
  double extinction = 0.0;  ///< per unit of the data's length, of a channel of 1
  double density = 0.0;     ///< of densities
  double amount = 0.0;      ///< densities: ∫ density ds along any ray
  double opacity = 0.0;     ///< of classified values, over the unit distance
  glm::dvec3 colour{ 1.0 }; ///< of classified values that can be seen
  double kelvin = 0.0;      ///< of Medium::temperature, where it is asked for
};

/// Rays of the camera, spread evenly over the volumes' outline. Distances are world units.
struct ViewFigures
{
  static constexpr int edge = 64; ///< rays along each side
  std::vector<glm::dvec3> origin; ///< on the near plane
  std::vector<glm::dvec3> direction;
  std::vector<double> reach; ///< from the near to the far plane
  /// Optical depth of a channel of 1: an upper bound for the ray and for those between it and its
  /// neighbours.
  std::vector<double> depth;
  double deepest = 0.0; ///< the largest of these
  double angle = 0.0;   ///< half of the angle between rays that are neighbours across a corner
  double width = 0.0;   ///< half of the distance between their origins
  double edge_of_voxel = 0.0; ///< the smallest, in the data's units
};

struct PlanFigures
{
  std::vector<MatterFigures> matter; ///< of each volume
  std::size_t bricks = 0;
  std::size_t visible_bricks = 0;
  ViewFigures view;
  std::vector<double> lights; ///< the largest optical depth toward each light, of a channel of 1
  /// The least distance of each light's place from matter, in the world.
  std::vector<double> clearance;
  double vertical = 0.0; ///< the largest along Sky::up
};

/// Looks at scenes and keeps what it saw for as long as it holds: the ranges of values while
/// data_revision stays, depths toward lights while volumes and lights stay, those of the view while
/// volumes and camera stay. Of volumes without revisions nothing is kept.
class PlanProbe
{
public:
  const PlanFigures& look(Marcher& marcher, const Scene& scene, int threads);

  /// What optical depths hang on but for camera and lights; unlike all others where nothing may be
  /// kept.
  PlanKey matter_key(const Scene& scene);

private:
  void look_at_values(const Scene& scene, int threads);
  void look_at_lights(Marcher& marcher, int threads);
  void look_at_view(Marcher& marcher, int threads);
  std::vector<double> depths(Marcher& marcher,
    const glm::dmat4& clip_from_world,
    int edge,
    double spacing,
    int threads);

  /// The distance in the world from a place to the nearest matter, at the least.
  double clearance(const Scene& scene, const glm::dvec3& place) const;

  struct Values
  {
    PlanKey key;
    std::shared_ptr<const BrickRanges> ranges;
  };
  struct Depth
  {
    PlanKey key;
    double deepest = 0.0;
    double clearance = 0.0;
  };

  std::vector<Values> KeptValues;
  std::vector<Values> KeptTemperatures;
  std::vector<Depth> KeptDepths; ///< of lights, then upward
  PlanKey MatterKey;
  PlanKey ViewKey;
  std::uint64_t Unkept = 0; ///< makes keys of what has no revision unlike all others
  Scene Bare;               ///< the scene without light, its extinction times Scale
  double Scale = 1.0;
  double Hidden = 0.0; ///< optical depth that a film one ray wide might overlook
  PlanFigures Figures;
};

/// A view along `direction` that holds all of a scene's volumes.
glm::dmat4 parallel_view(const Scene& scene, const glm::dvec3& direction);

/// Views from a place that together hold all of a scene's volumes: one from outside, six from
/// inside.
std::vector<glm::dmat4> views_from(const Scene& scene, const glm::dvec3& place);

}
