// Bounds of a volume's extinction, brick by brick, and the walk of a ray through them. Internal to
// Transport.
#pragma once

#include "Transport/bricks.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace brume
{

/// What null-collision tracking needs to know of each brick (BrickRanges), per unit of the data's
/// length.
struct PathBricks
{
  int shift = 3;
  int dims[3] = { 0, 0, 0 };
  /// The rate of tentative collisions: no less than the extinction of any channel anywhere in the
  /// brick. 0 where there is nothing to collide with.
  std::vector<double> rate;
  /// No more than the density anywhere in the brick (PathMatter::density).
  std::vector<double> least;
  /// How far the next brick of a rate above 0 is (VisibleBricks::distance).
  std::vector<std::int32_t> distance;
};

/// Walks the bricks of a rate above 0 that a ray meets, in order.
class BrickWalk
{
public:
  /// The ray's places are begin + t · along, in index space; only t in [from, to] counts. What is
  /// beyond the bricks there belongs to the outermost of them.
  BrickWalk(const PathBricks& bricks,
    const glm::dvec3& begin,
    const glm::dvec3& along,
    double from,
    double to);

  /// Moves to the next brick; false where there is none. Always ends.
  bool next();

  std::size_t brick() const { return this->Brick; }
  double from() const { return this->From; } ///< where the ray enters it
  double to() const { return this->To; }     ///< where the ray leaves it

private:
  void settle(double t, bool first);
  std::size_t index() const;
  double border(int axis, int side_brick) const;

  const PathBricks* Bricks;
  glm::dvec3 Begin;
  glm::dvec3 Along;
  glm::dvec3 Inverse;
  double At;
  double End;
  int Place[3];
  double Next[3]; ///< where the ray leaves the brick along each axis
  std::size_t Brick = 0;
  double From = 0.0;
  double To = 0.0;
};

}
