// A hand on the panel of `brume view`.
#pragma once

#include "view_support.h"

#include "view/controls.h"
#include "view/side_panel.h"

#include <cmath>
#include <string>

/// A density with all that has controls of its own.
inline ordered_json rich_scene()
{
  return { { "input", ball_file() },
    { "quiet", true },
    { "extinction", 0.002 },
    { "sun-direction", { 1.0, -1.0, 1.0 } },
    { "phase", "hg:0.8:0.7,hg:-0.2:0.3" },
    { "octaves", 3 },
    { "silver-lining", 0.5 },
    { "powder", 0.5 },
    { "fog-extinction", 0.001 },
    { "tolerance", 0.05 } };
}

/// The first place of that kind on the panel as it is shown, in the window; −1, −1 where there is
/// none.
struct Place
{
  int x = -1;
  int y = -1;
};
inline Place place_of_spot(Viewer& viewer,
  HotSpot::Kind kind,
  int index,
  double across = 0.5,
  double down = 0.5)
{
  viewer.tiles();
  const Box panel = viewer.tiles().back().box;
  for (const HotSpot& spot : viewer.panel().spots)
  {
    if (spot.kind == kind && spot.index == index)
    {
      return { panel.x + spot.box.x + static_cast<int>(std::lround(across * (spot.box.width - 1))),
        panel.y + spot.box.y + static_cast<int>(std::lround(down * (spot.box.height - 1))) };
    }
  }
  return {};
}

inline void click(Viewer& viewer, const Place& place, bool right = false, bool twice = false)
{
  ASSERT_GE(place.x, 0);
  EXPECT_TRUE(viewer.press(place.x, place.y, right, twice));
  viewer.release();
  viewer.tiles();
}

inline int index_of(const std::string& name)
{
  for (std::size_t i = 0; i < controls().size(); ++i)
  {
    if (name == controls()[i].name)
    {
      return static_cast<int>(i);
    }
  }
  ADD_FAILURE() << name;
  return 0;
}

inline void show_page(Viewer& viewer, ControlPage page)
{
  click(viewer, place_of_spot(viewer, HotSpot::Kind::Page, static_cast<int>(page)));
}

/// Turns the wheel until the place can be pressed.
inline Place scrolled_to(Viewer& viewer,
  HotSpot::Kind kind,
  int index,
  double across = 0.5,
  double down = 0.5)
{
  const Box panel = viewer.tiles().back().box;
  viewer.wheel(panel.x + 5, panel.height / 2, 1000);
  for (int i = 0; i < 200; ++i)
  {
    const Place place = place_of_spot(viewer, kind, index, across, down);
    const HotSpot* at =
      place.x < 0 ? nullptr : viewer.panel().at(place.x - panel.x, place.y - panel.y);
    if (at && at->kind == kind && at->index == index)
    {
      return place;
    }
    viewer.wheel(panel.x + 5, panel.height / 2, -1);
  }
  ADD_FAILURE() << "not reached: " << static_cast<int>(kind) << ", " << index;
  return {};
}
