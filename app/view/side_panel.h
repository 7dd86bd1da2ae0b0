// The panel beside the viewports: controls, transfer function, plan.
#pragma once

#include "controls.h"
#include "layout.h"
#include "painter.h"
#include "panel_sheet.h"
#include "transfer_editor.h"

#include "display_table.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace brume::app
{

/// What the panel shows.
struct PanelModel
{
  ControlPage page = ControlPage::Light;
  int scroll = 0; ///< pixels of the page above what is seen; cut off at the page's end
  ControlScene scene;
  const Shot* shot = nullptr;      ///< of the viewport whose plan is shown; null for none
  bool times = true;               ///< whether the plan tells what effects cost
  std::string title;               ///< the input's name
  std::string preset;              ///< "mr-brain", or empty for a density
  std::string length_unit;         ///< "mm"; empty where unknown
  std::string value_unit;          ///< "HU"; empty where unknown
  const TransferFunction* function = nullptr; ///< null for a density
  const Histogram* histogram = nullptr;       ///< null where it is not known yet
  std::vector<std::pair<std::string, std::string>> figures; ///< names and values, at the page's end
  std::string hint;                ///< a line at the foot
  FunctionPoint hand;              ///< of the function: held, or under the mouse
  int chosen = -1;                 ///< the point of colour that can be given another; -1: none
  /// Whose picker of colours is shown: an index of controls(), or HotSpot::chosen_point.
  std::optional<int> picker;
  Display::Curve curve = Display::Curve::None; ///< by which colours are shown as pictures are
  /// Toward the sun as the camera sees it: x to the right, y up, z toward the eye; 0, 0, 0 for none.
  Triple sun_seen{ 0.0, 0.0, 0.0 };
};

/// The transfer function's field in a box: its values are the histogram's, or the points' own.
CurveField curve_field(const PanelModel& model, const Box& box);

/// Opacities over the histogram, the colours below with their points, and the ends of the values or those
/// of the point under the hand. What the page Look shows above its controls.
void draw_transfer_field(PanelSheet& sheet, const PanelModel& model);

/// Draws the panel, `width` by `height` pixels. Text that does not fit is cut with an ellipsis; what does
/// not fit below is scrolled to. Nothing overlaps.
DrawnPanel draw_panel(const PanelModel& model, int width, int height, const Metrics& metrics);

/// Pixels that a picker takes below its row.
int picker_height(const Metrics& metrics);

/// Numbers of linear light as a sign on the screen has them; beyond white with the same hue.
Colour shown_colour(const Triple& colour, Display::Curve curve);

/// A value with its unit, as the panel writes it: "33.3 mm".
std::string with_unit(double value, const std::string& unit);

}
