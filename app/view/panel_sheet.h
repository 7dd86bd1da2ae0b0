// The sheet that the panel is drawn on, from the top down; what does not fit below is scrolled to.
#pragma once

#include "layout.h"
#include "tint.h"

#include "Analysis/canvas.h"
#include "Analysis/picture.h"

#include <optional>
#include <string>
#include <vector>

namespace brume::app
{

/// A place of the panel that does something.
struct HotSpot
{
  enum class Kind
  {
    Page,    ///< index: of ControlPage
    Control, ///< index: of controls(), or chosen_point; dragged along its box
    Swatch,  ///< the same: shows its picker of colours, or no longer
    Picker,  ///< the same: hue across, saturation down; dragged
    Preset,  ///< index: -1 the one before, 1 the next
    Effect,  ///< name: of the effect whose force is switched
    Curve,   ///< the transfer function's opacities
    Colours, ///< the transfer function's colours
    Shade,   ///< gradient shading on or off
    Ball,    ///< the sun's direction, dragged over a ball in its light
    Scroll,  ///< the scroll bar, dragged along its box
  };
  /// In place of a control's index: the colour of the transfer function's chosen point.
  static constexpr int chosen_point = -1;

  Kind kind = Kind::Page;
  Box box; ///< in pixels of the panel; may go on out of sight
  int index = 0;
  std::string name;
  Box shown; ///< of the box, what can be seen
};

struct DrawnPanel
{
  Bitmap bitmap;
  std::vector<HotSpot> spots;
  Box page;       ///< what is between the tabs and the hint
  int scroll = 0; ///< pixels of the page above what is seen
  int most = 0;   ///< what `scroll` may be; 0: all is seen
  Box track;      ///< of the scroll bar; empty where there is none
  Box thumb;      ///< its part that stands for what is seen

  /// What is at a place of the panel; null for nothing.
  const HotSpot* at(int x, int y) const;
  /// The scroll that puts the thumb's upper edge there.
  int scroll_at(int y) const;
};

/// Tabs above and a hint below stay; what is between is scrolled.
class PanelSheet
{
public:
  /// `head` and `foot`: heights of what stays above and below.
  PanelSheet(int width, int height, const Metrics& metrics, int head, int foot, int scroll);
  /// Width of what is drawn on a panel of that width.
  static int inner(int width, const Metrics& metrics);

  const Metrics& metrics() const { return this->M; }
  int left() const { return this->Left; }
  int inner() const { return this->Inner; } ///< width of what is drawn
  int right() const { return this->Left + this->Inner; }
  Canvas& canvas() { return this->Sheet; }

  /// The upper edge of the next so many pixels; none where nothing of them is seen, and then
  /// nothing of them is to be drawn.
  std::optional<int> take(int height);
  void skip(int height) { this->Y += height; }

  TextStyle style(Colour colour, bool bold = false) const { return { this->M.text, bold, colour }; }
  /// One line, cut with an ellipsis where it is longer than `width`.
  void text(int x,
    int baseline,
    const std::string& line,
    Colour colour,
    int width,
    Align align = Align::Left,
    bool bold = false);
  /// A name to the left and what it is to the right, in `width` pixels from the left edge on.
  void pair(int baseline,
    const std::string& name,
    Colour name_colour,
    const std::string& value,
    Colour value_colour,
    int width);
  void pair(int baseline,
    const std::string& name,
    Colour name_colour,
    const std::string& value,
    Colour value_colour)
  {
    this->pair(baseline, name, name_colour, value, value_colour, this->Inner);
  }
  /// The outline of a box.
  void outline(const Box& box, Colour colour, int thick = 1);
  void spot(HotSpot::Kind kind, const Box& box, int index = 0, const std::string& name = {});

  /// To be called when all of the page is drawn: covers what ran over into head and foot, which are
  /// then drawn by who calls, and draws the scroll bar.
  void end_page();
  DrawnPanel finish();

private:
  const Metrics& M;
  int Height;
  Canvas Sheet;
  int Width;
  int Left;
  int Inner;
  Box Seen; ///< what is between head and foot
  int Y;
  bool PageEnded = false;
  DrawnPanel Drawn;
};

}
