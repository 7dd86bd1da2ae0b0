#include "orientation.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace brume
{

namespace
{
using Matrix = std::array<double, 9>;

double determinant(const Matrix& m)
{
  return m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) +
    m[2] * (m[3] * m[7] - m[4] * m[6]);
}

/// The inverse, transposed.
Matrix inverse_transpose(const Matrix& m)
{
  const double d = determinant(m);
  return { { (m[4] * m[8] - m[5] * m[7]) / d, (m[5] * m[6] - m[3] * m[8]) / d,
    (m[3] * m[7] - m[4] * m[6]) / d, (m[2] * m[7] - m[1] * m[8]) / d,
    (m[0] * m[8] - m[2] * m[6]) / d, (m[1] * m[6] - m[0] * m[7]) / d,
    (m[1] * m[5] - m[2] * m[4]) / d, (m[2] * m[3] - m[0] * m[5]) / d,
    (m[0] * m[4] - m[1] * m[3]) / d } };
}
}

GridFrame frame_of_affine(
  const std::array<double, 12>& affine, const std::array<long long, 3>& dimensions)
{
  for (double a : affine)
  {
    if (!std::isfinite(a))
    {
      throw std::invalid_argument("the orientation holds a number that is not finite");
    }
  }
  GridFrame frame;
  Matrix unit{}; // the columns of the affine, each of length 1
  for (int axis = 0; axis < 3; ++axis)
  {
    const double length = std::hypot(affine[axis], affine[4 + axis], affine[8 + axis]);
    if (!(length > 1e-30) || !(length < 1e30))
    {
      throw std::invalid_argument("the spacing along axis " + std::to_string(axis + 1) +
        " is zero or beyond all measure");
    }
    frame.spacing[axis] = length;
    for (int row = 0; row < 3; ++row)
    {
      unit[3 * row + axis] = affine[4 * row + axis] / length;
    }
  }
  if (std::abs(determinant(unit)) < 1e-4)
  {
    throw std::invalid_argument("two axes of the volume lie in one line or all three in one plane");
  }

  // Newton's iteration for the orthonormal factor; it converges quadratically.
  Matrix turn = unit;
  for (int round = 0; round < 60; ++round)
  {
    const Matrix other = inverse_transpose(turn);
    double change = 0;
    for (int i = 0; i < 9; ++i)
    {
      const double next = 0.5 * (turn[i] + other[i]);
      change = std::max(change, std::abs(next - turn[i]));
      turn[i] = next;
    }
    if (change < 1e-15)
    {
      break;
    }
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    // The length of the difference, rather than acos of a product that is close to 1.
    const double chord = std::hypot(turn[axis] - unit[axis], turn[3 + axis] - unit[3 + axis],
      turn[6 + axis] - unit[6 + axis]);
    const double degrees = 2 * std::asin(std::min(1.0, chord / 2)) * 180 / M_PI;
    frame.shear_degrees = std::max(frame.shear_degrees, degrees);
  }
  // Headers hold float32: a hundredth of a degree is their rounding, not a shear.
  if (frame.shear_degrees < 0.01)
  {
    frame.shear_degrees = 0;
  }
  // −0 and dust of the last bits would only make reports ugly.
  for (double& t : turn)
  {
    t = std::abs(t) < 1e-7 ? 0.0 : t;
    t = std::abs(std::abs(t) - 1) < 1e-12 ? std::copysign(1.0, t) : t;
  }

  if (determinant(turn) < 0)
  {
    frame.reversed_axis = 0;
    for (int axis = 1; axis < 3; ++axis)
    {
      if (turn[4 * axis] < turn[4 * frame.reversed_axis])
      {
        frame.reversed_axis = axis;
      }
    }
  }
  for (int row = 0; row < 3; ++row)
  {
    // The centre stays where the affine puts it; with no shear so does every voxel.
    double place = affine[4 * row + 3];
    for (int axis = 0; axis < 3; ++axis)
    {
      const double last = static_cast<double>(dimensions[axis] - 1);
      const double sign = axis == frame.reversed_axis ? -1 : 1;
      const double d = sign * turn[3 * row + axis];
      frame.direction[3 * row + axis] = d == 0 ? 0.0 : d;
      if (frame.shear_degrees > 0)
      {
        place += 0.5 * last * (affine[4 * row + axis] - d * frame.spacing[axis]);
      }
      else if (sign < 0)
      {
        place += last * affine[4 * row + axis];
      }
    }
    frame.origin[row] = place == 0 ? 0.0 : place;
  }
  return frame;
}

std::string anatomical_code(const std::array<double, 9>& direction)
{
  static const char* const letters[3] = { "LR", "PA", "IS" };
  std::string code = "???";
  bool row_taken[3] = { false, false, false };
  bool axis_taken[3] = { false, false, false };
  for (int round = 0; round < 3; ++round)
  {
    int best_row = -1;
    int best_axis = -1;
    for (int row = 0; row < 3; ++row)
    {
      for (int axis = 0; axis < 3; ++axis)
      {
        if (!row_taken[row] && !axis_taken[axis] &&
          (best_row < 0 ||
            std::abs(direction[3 * row + axis]) > std::abs(direction[3 * best_row + best_axis])))
        {
          best_row = row;
          best_axis = axis;
        }
      }
    }
    row_taken[best_row] = true;
    axis_taken[best_axis] = true;
    code[best_axis] = letters[best_row][direction[3 * best_row + best_axis] > 0 ? 1 : 0];
  }
  return code;
}

}
