// How a grid of voxels lies in the world.
#pragma once

#include "vtkBrumeIOModule.h" // the export macro alone

#include <array>
#include <string>

namespace brume
{

/// A grid as vtkImageData has it: world = origin + direction · (spacing ∘ index).
struct GridFrame
{
  std::array<double, 3> origin{ { 0, 0, 0 } };  ///< world place of voxel (0, 0, 0)
  std::array<double, 3> spacing{ { 1, 1, 1 } }; ///< world units a voxel, > 0
  /// Row-major, orthonormal, determinant +1; column a is the world direction of index axis a.
  std::array<double, 9> direction{ { 1, 0, 0, 0, 1, 0, 0, 0, 1 } };
  /// The index axis whose voxels must be stored in reverse for this frame to hold; −1 for none.
  int reversed_axis = -1;
  /// The largest angle, in degrees, by which an axis was turned to make the axes perpendicular; 0
  /// for an affine that is rotation and scaling alone.
  double shear_degrees = 0;
};

/// The frame of an affine map from voxel index to world (row-major 3 × 4) for a grid of
/// `dimensions` voxels.
///
/// Spacing is the length of each column. A left-handed affine has one index axis reversed, the one
/// that brings the direction closest to the identity, so that the direction is always a rotation.
/// An affine that shears is replaced by the closest orthonormal frame (the polar decomposition:
/// N. Higham, "Computing the polar decomposition", SIAM J. Sci. Stat. Comput. 7, 1986), which keeps
/// the place of the grid's centre.
/// Throws std::invalid_argument for a value that is not finite or a column that is zero or lies in
/// the plane of the two others.
VTKBRUMEIO_EXPORT GridFrame frame_of_affine(
  const std::array<double, 12>& affine, const std::array<long long, 3>& dimensions);

/// Three letters that name, for each index axis, the anatomical direction in which it grows, in a
/// RAS+ world: L or R, P or A, I or S. "RAS" is the identity. Oblique axes are named by the closest
/// direction, no direction twice.
/// direction: row-major 3 × 3, as in GridFrame.
VTKBRUMEIO_EXPORT std::string anatomical_code(const std::array<double, 9>& direction);

}
