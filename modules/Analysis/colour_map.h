// The colours of a difference picture.
#pragma once

#include <array>

namespace brume
{

using Colour = std::array<unsigned char, 3>; ///< R, G, B bytes as displayed

/// Black over purple and orange to pale yellow, its lightness rising evenly with t and readable
/// without colour vision: "inferno" of Matplotlib (N. Smith and S. van der Walt, 2015, CC0), by the
/// polynomial fit of degree 6 of M. Zucker (CC0). t is clamped to [0, 1].
Colour inferno(double t);

/// Blue over pale grey (t = 0) to red, both arms of even and equal lightness: the diverging map of
/// K. Moreland, "Diverging Color Maps for Scientific Visualization", 2009. t is clamped to [-1, 1].
Colour cool_warm(double t);

/// What marks a non-finite pixel in a difference picture: a green that neither map holds.
constexpr Colour non_finite_colour{ 0, 255, 64 };

}
