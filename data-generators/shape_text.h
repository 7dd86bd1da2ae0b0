// Shapes written down: a small language of nested lists.
//
//   (smooth-unite 0.3 (sphere 1) (move 0 0 1.2 (box 0.5 0.5 0.5 0.1)))
//
// A list is a name, its numbers, and the shapes it is made of. A semicolon begins a comment, to the
// end of the line. Numbers are those of C, with a point. What each does, and its ranges: shape.h.
//
//   (sphere RADIUS)                        (box HALF_X HALF_Y HALF_Z [ROUNDING])
//   (torus RING TUBE)                      (capsule AX AY AZ BX BY BZ RADIUS)
//   (cylinder RADIUS HALF_HEIGHT)          (cone BOTTOM TOP HALF_HEIGHT)
//   (ellipsoid RX RY RZ)                   (plane NX NY NZ OFFSET)
//   (unite SHAPE...)                       (intersect SHAPE...)
//   (subtract SHAPE SHAPE...)              (complement SHAPE)
//   (smooth-unite WIDTH SHAPE SHAPE...)    (smooth-intersect WIDTH SHAPE SHAPE...)
//   (smooth-subtract WIDTH SHAPE SHAPE...)
//   (move X Y Z SHAPE)                     (rotate AXIS_X AXIS_Y AXIS_Z DEGREES SHAPE)
//   (scale FACTOR SHAPE)                   (twist DEGREES_A_UNIT SHAPE)
//   (repeat SX SY SZ SHAPE)                (repeat SX SY SZ NX NY NZ SHAPE)
//   (waves AMPLITUDE WAVELENGTH SHAPE)     (noise AMPLITUDE SIZE SEED SHAPE)
//   (grow RADIUS SHAPE)                    (shell THICKNESS SHAPE)
//
// With several shapes, subtract takes all that follow away from the first, and the smooth ones go
// on from left to right.
#pragma once

#include "data-generators/shape.h"

#include <string>

namespace brume
{

/// The shape that a text describes. Throws std::invalid_argument with "line L, column C: what is
/// wrong" for a text that describes none: also for lists nested deeper than 200, and for more than
/// 5000 of them.
Shape shape_from_text(const std::string& text);

}
