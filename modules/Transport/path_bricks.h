// Bounds of a volume's extinction, brick by brick, and the walk of a ray through them. Internal to
// Transport.
#pragma once

#include "Transport/bricks.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
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

  /// Bricks in which nearly all matter is far thinner than their bound have bounds for each of their
  /// cells: a voxel of a million times the others' density would else make collisions with nothing
  /// all over its brick. For each brick the first of its cells, x fastest, or −1; empty where no brick has.
  std::vector<std::int32_t> first_cell;
  std::vector<double> cell_rate;
  std::vector<double> cell_least;

  bool has_cells() const { return !this->first_cell.empty(); }

  /// Beside a dense voxel matter is thin in most of a cell, too: bounds of a stretch between two places of
  /// one cell. Empty where values do not run as cubic polynomials within cells.
  std::function<void(const glm::dvec3& from, const glm::dvec3& to, double& rate, double& least)>
    along;
};

/// Walks the bricks of a rate above 0 that a ray meets, the cells of those that have any, and in cells that
/// are dense stretches in which there are few collisions or few that are not real, in order.
class BrickWalk
{
public:
  /// The ray's places are begin + t · along, in index space; only t in [from, to] counts. What is
  /// beyond the bricks there belongs to the outermost of them. `scale`: the data's units in one of t; 0:
  /// cells are not parted.
  BrickWalk(const PathBricks& bricks,
    const glm::dvec3& begin,
    const glm::dvec3& along,
    double from,
    double to,
    double scale = 0.0);

  /// Moves to the next brick, cell or stretch; false where there is none. Always ends.
  bool next();

  double rate() const { return this->Rate; }   ///< PathBricks::rate there
  double least() const { return this->Least; } ///< PathBricks::least there
  /// Whether these are bounds of the interpolated density, and single voxels may be beyond.
  bool is_stretch() const { return this->Stretched; }
  double from() const { return this->From; } ///< where the ray enters it
  double to() const { return this->To; }     ///< where the ray leaves it

private:
  bool next_brick();
  void begin_cells();
  bool next_cell();
  bool next_stretch();
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
  double Rate = 0.0;
  double Least = 0.0;
  // Of the cells of a brick.
  double CellAt = 0.0;
  double CellEnd = 0.0; ///< not above CellAt: none are left
  int Cell[3] = { 0, 0, 0 };
  double CellNext[3] = { 0.0, 0.0, 0.0 };
  // Of the stretches of a cell.
  double Scale = 0.0;
  double StretchAt = 0.0;
  double StretchEnd = 0.0; ///< not above StretchAt: none are left
  double StretchLength = 0.0;
  bool Stretched = false;
};

}
