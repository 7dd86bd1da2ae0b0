// The panel beside the viewports: controls, transfer function, plan.
#pragma once

#include "controls.h"
#include "layout.h"
#include "painter.h"
#include "transfer_editor.h"

#include "Analysis/picture.h"

#include <string>
#include <utility>
#include <vector>

namespace brume::app
{

/// What the panel shows.
struct PanelModel
{
  ControlPage page = ControlPage::Light;
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
  int point = -1;                  ///< of the function, that is held
  /// Toward the sun as the camera sees it: x to the right, y up, z toward the eye; 0, 0, 0 for none.
  Triple sun_seen{ 0.0, 0.0, 0.0 };
};

/// A place of the panel that does something.
struct HotSpot
{
  enum class Kind
  {
    Page,    ///< index: of ControlPage
    Control, ///< index: of controls(); dragged along its box
    Preset,  ///< index: -1 the one before, 1 the next
    Effect,  ///< name: of the effect whose force is switched
    Curve,   ///< the transfer function's field
    Shade,   ///< gradient shading on or off
    Ball,    ///< the sun's direction, dragged over a ball in its light
  };
  Kind kind;
  Box box; ///< in pixels of the panel
  int index = 0;
  std::string name;
};

struct DrawnPanel
{
  Bitmap bitmap;
  std::vector<HotSpot> spots;

  /// What is at a place of the panel; null for nothing.
  const HotSpot* at(int x, int y) const;
};

/// The transfer function's field in a box: its values are the histogram's, or the points' own.
CurveField curve_field(const PanelModel& model, const Box& box);

/// Draws the panel, `width` by `height` pixels. Text that does not fit is cut with an ellipsis, and what
/// does not fit below is left out, so that nothing overlaps.
DrawnPanel draw_panel(const PanelModel& model, int width, int height, const Metrics& metrics);

/// A value with its unit, as the panel writes it: "33.3 mm".
std::string with_unit(double value, const std::string& unit);

}
