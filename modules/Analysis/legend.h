// The strip that explains a difference picture: its label and its colour bar with marks.
#pragma once

#include "canvas.h"
#include "difference_picture.h"

namespace brume
{

struct LegendLayout
{
  int width = 320; ///< of the strip, pixels
  int size = 12;   ///< of the lettering, pixels
  int margin() const { return size; }
  int bar() const { return size; }
  int height() const { return 2 * margin() + size + size / 2 + bar() + 2 * size; }
};

/// Draws the strip with its upper left corner at (x, y).
void draw_legend(Canvas& canvas, int x, int y, const LegendLayout& layout, DifferenceKind kind,
  double gain, std::size_t non_finite_pixels);

}
