// Where things stand in the window of `brume view`.
#pragma once

#include <vector>

namespace brume::app
{

/// A rectangle in pixels from the window's upper left corner, y downward.
struct Box
{
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;

  bool empty() const { return this->width <= 0 || this->height <= 0; }
  bool contains(int px, int py) const
  {
    return px >= this->x && py >= this->y && px < this->x + this->width &&
      py < this->y + this->height;
  }
  /// The same without so many pixels along each side.
  Box inset(int by) const
  {
    return { this->x + by, this->y + by, this->width - 2 * by, this->height - 2 * by };
  }
};

struct Layout
{
  std::vector<Box> pictures; ///< one for each viewport, all of one size
  std::vector<Box> captions; ///< a line below each
  Box panel;                 ///< to the right; empty where there is none
};

/// Lengths of the interface in pixels; `scale` is 1 for 96 dots an inch.
struct Metrics
{
  explicit Metrics(double scale);

  int text;    ///< size of the lettering
  int line;    ///< from one line of text to the next
  int margin;  ///< between things
  int row;     ///< a control: its name and value, and its bar below
  int panel;   ///< width of the panel
  int caption; ///< height of a caption
};

/// Divides a window of that size among `pictures` viewports, from 1 to 4, and the panel. Viewports stand
/// in the rows and columns that make their shorter edge longest. Of a window that is too narrow for both the panel
/// goes, so that viewports are never empty. Throws std::invalid_argument for sizes below 1.
Layout lay_out(int width, int height, const Metrics& metrics, int pictures, bool panel);

}
