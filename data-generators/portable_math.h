// Sine and cosine with the same bits on every machine: of floating point only what IEEE 754 rounds
// exactly (+ - * / and floor), no libm.
#pragma once

#include <cmath>

namespace brume
{

constexpr double pi = 3.14159265358979323846;

/// Sine and cosine of one angle.
struct SineCosine
{
  double sine;
  double cosine;
};

/// Of an angle in radians, within 4e-16 for |angle| up to 1e6 and within 1e-13 up to 1e9; beyond
/// that, and for what is not finite, sine 0 and cosine 1. The angle less the nearest multiple
/// of pi/2 (taken away in two parts, the first short enough for exact products), then both Taylor
/// series, which on [-pi/4, pi/4] end below 2^-53 with the terms of degree 17 and 16.
inline SineCosine portable_sincos(double angle)
{
  if (!(std::fabs(angle) <= 1e9))
  {
    return { 0.0, 1.0 };
  }
  constexpr double half_pi_head = 1.570796012878418;       // the first 22 bits
  constexpr double half_pi_middle = 3.139164786504813e-07; // and the next 53
  const double quarters = std::floor(angle * (2.0 / pi) + 0.5);
  const double x = (angle - quarters * half_pi_head) - quarters * half_pi_middle;
  const double s = x * x;
  double sine = 0.0;
  double cosine = 0.0;
  for (int n = 16; n >= 2; n -= 2)
  {
    sine = (1.0 + sine) * (-s / (n * (n + 1.0)));
    cosine = (1.0 + cosine) * (-s / ((n - 1.0) * n));
  }
  sine = x + x * sine;
  cosine = 1.0 + cosine;
  const double turn = quarters - 4.0 * std::floor(0.25 * quarters);
  return turn == 0.0   ? SineCosine{ sine, cosine }
         : turn == 1.0 ? SineCosine{ cosine, -sine }
         : turn == 2.0 ? SineCosine{ -sine, -cosine }
                       : SineCosine{ -cosine, sine };
}

}
