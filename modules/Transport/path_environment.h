// Light from all around, and directions drawn by how much of it comes from them. Theory:
// docs/theory/paths.md. Internal to Transport.
#pragma once

#include "Transport/environment.h"
#include "Transport/medium.h"
#include "Transport/random_stream.h"

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <memory>
#include <vector>

namespace brume
{

/// Sky, ground and a picture of all around, added up. A picture without light counts as none.
class PathEnvironment
{
public:
  /// `map` may be null. Throws std::invalid_argument for one without pixels or with another number
  /// of values.
  PathEnvironment(const Sky& sky, std::shared_ptr<const PlacedEnvironment> map);

  /// Whether there is any light.
  bool shines() const { return this->Power > 0.0; }
  /// Whether there is a picture, whose light may be anywhere in it.
  bool has_map() const { return this->Map != nullptr; }

  /// Radiance that comes from a direction (a unit vector, toward where it comes from).
  glm::dvec3 radiance(const glm::dvec3& toward) const;
  /// A direction, by a density that is a third of the radiances' sum, divided by its integral. Of
  /// light that shines().
  glm::dvec3 sample(RandomStream& random) const;
  /// That density, 1/sr.
  double density(const glm::dvec3& toward) const;

private:
  glm::dvec3 map_radiance(int x, int y) const;
  void find_pixel(const glm::dvec3& toward, int& x, int& y) const;

  Sky Halves;
  std::shared_ptr<const PlacedEnvironment> Placed;
  const EnvironmentMap* Map = nullptr; ///< of it
  std::vector<double> RowUpTo;         ///< sums of the rows' powers, from the bottom
  std::vector<double> ColumnUpTo;      ///< within each row, sums of the pixels' mean radiances
  double SkyPower = 0.0;               ///< mean radiance times solid angle
  double GroundPower = 0.0;
  double Power = 0.0; ///< of all
};

}
