// A trilinear value along a straight ray through one cell: a cubic polynomial, known from four
// values.
#pragma once

#include <algorithm>
#include <cmath>

namespace brume
{

/// A cubic over [0, 1].
class Cubic
{
public:
  /// Through the values at 0, 1/3, 2/3 and 1. Equal values make a constant, without rounding.
  Cubic(double v0, double v1, double v2, double v3)
  {
    // Newton's forward differences in u = 3 t.
    const double d1 = v1 - v0;
    const double d2 = (v2 - v1) - d1;
    const double d3 = ((v3 - v2) - (v2 - v1)) - d2;
    this->A[0] = v0;
    this->A[1] = 3.0 * (d1 - 0.5 * d2 + d3 / 3.0);
    this->A[2] = 4.5 * (d2 - d3);
    this->A[3] = 4.5 * d3;
    this->Last = v3;
  }

  double at(double t) const
  {
    return t == 1.0 ? this->Last
                    : ((this->A[3] * t + this->A[2]) * t + this->A[1]) * t + this->A[0];
  }

  /// The ends of the stretches in which it only rises or only falls: 0, up to two turns, 1.
  /// Returns how many there are, 2 to 4.
  int turns(double t[4]) const
  {
    int count = 0;
    t[count++] = 0.0;
    // A₁ + 2 A₂ t + 3 A₃ t² = 0; the form that does not cancel.
    const double a = 3.0 * this->A[3];
    const double discriminant = this->A[2] * this->A[2] - a * this->A[1];
    if (discriminant >= 0.0)
    {
      const double q = -(this->A[2] + std::copysign(std::sqrt(discriminant), this->A[2]));
      double first = this->A[1] / q; // 0/0 and x/0 are in no interval
      double second = q / a;
      if (first > second)
      {
        std::swap(first, second);
      }
      for (double root : { first, second })
      {
        if (root > t[count - 1] && root < 1.0)
        {
          t[count++] = root;
        }
      }
    }
    t[count++] = 1.0;
    return count;
  }

  /// Where it takes `value` in [from, to], within which it only rises or only falls and at whose
  /// ends it lies on either side of the value, to the last bits.
  double root(double value, double from, double to) const
  {
    const bool rising = this->at(to) > this->at(from);
    for (int i = 0; i < 60 && from < to; ++i)
    {
      const double middle = 0.5 * (from + to);
      ((this->at(middle) < value) == rising ? from : to) = middle;
    }
    return 0.5 * (from + to);
  }

private:
  double A[4];
  double Last;
};

}
