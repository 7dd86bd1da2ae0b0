// What the mouse does in the viewer.
#include "viewer.h"

#include <algorithm>
#include <cmath>

namespace brume::app
{

bool Viewer::press(int x, int y, bool right_button, bool twice)
{
  this->Hold = Held::Nothing;
  this->BeforeDrag.reset();
  if (this->Help)
  {
    return this->key("question");
  }
  if (this->Boxes.panel.contains(x, y))
  {
    return this->press_panel(x - this->Boxes.panel.x, y - this->Boxes.panel.y, right_button, twice);
  }
  const Box& picture = this->Boxes.pictures.front();
  if (this->compares() && this->Set.arrangement == Arrangement::Wipe && picture.contains(x, y))
  {
    const int line = picture.x + static_cast<int>(this->Divider * picture.width);
    if (std::abs(x - line) <= Metrics(this->Set.scale).text)
    {
      this->Hold = Held::Divider;
      return true;
    }
  }
  return false;
}

bool Viewer::press_panel(int x, int y, bool right_button, bool twice)
{
  const HotSpot* found = this->Panel.at(x, y);
  if (!found)
  {
    return true;
  }
  const HotSpot spot = *found; // what is pressed may draw the panel anew
  this->HeldSpot = spot;
  const bool of_control = spot.kind == HotSpot::Kind::Control ||
                          spot.kind == HotSpot::Kind::Swatch || spot.kind == HotSpot::Kind::Picker;
  if (of_control && right_button)
  {
    if (spot.index != HotSpot::chosen_point)
    {
      this->restore(controls()[static_cast<std::size_t>(spot.index)]);
    }
    return true;
  }
  switch (spot.kind)
  {
    case HotSpot::Kind::Page:
      this->Page = static_cast<ControlPage>(spot.index);
      this->PanelChanged = true;
      break;
    case HotSpot::Kind::Control:
      this->Hold = Held::Control;
      if (spot.index == HotSpot::chosen_point)
      {
        this->HeldColour = this->chosen_colour();
      }
      this->drag_control(x);
      break;
    case HotSpot::Kind::Swatch:
      this->show_picker(spot);
      break;
    case HotSpot::Kind::Picker:
      this->Hold = Held::Picker;
      this->drag(x + this->Boxes.panel.x, y + this->Boxes.panel.y);
      break;
    case HotSpot::Kind::Ball:
      this->Hold = Held::Ball;
      this->turn_sun(x + this->Boxes.panel.x, y + this->Boxes.panel.y);
      break;
    case HotSpot::Kind::Preset:
      this->step_preset(spot.index);
      break;
    case HotSpot::Kind::Effect:
      this->switch_effect(spot.name);
      break;
    case HotSpot::Kind::Shade:
    {
      const std::string now = this->Volume.options.shade;
      this->set_key("shade", now == "preset" ? "on" : now == "on" ? "off" : "preset");
      break;
    }
    case HotSpot::Kind::Curve:
      this->press_curve(spot, x, right_button, twice, y);
      break;
    case HotSpot::Kind::Colours:
      this->press_colours(spot, x, right_button, twice);
      break;
    case HotSpot::Kind::Scroll:
    {
      const Box& thumb = this->Panel.thumb;
      const bool on_it = y >= thumb.y && y < thumb.y + thumb.height;
      this->HeldOffset = on_it ? y - thumb.y : thumb.height / 2;
      this->Hold = Held::Scroll;
      this->drag(x + this->Boxes.panel.x, y + this->Boxes.panel.y);
      break;
    }
  }
  return true;
}

void Viewer::show_picker(const HotSpot& swatch)
{
  this->PanelChanged = true;
  if (this->Picker == swatch.index)
  {
    this->Picker.reset();
    return;
  }
  const Metrics metrics(this->Set.scale);
  const int height = picker_height(metrics);
  int& scroll = this->Scrolls[static_cast<std::size_t>(this->Page)];
  int bottom = swatch.box.y + metrics.row + height;
  if (this->picker_is_above(swatch.index))
  {
    // One at a time: that one goes, and this row stays under the hand as far as the page allows.
    const int scrolled = std::min(height, scroll);
    scroll -= scrolled;
    bottom += scrolled - height;
  }
  this->Picker = swatch.index;
  const Box& page = this->Panel.page;
  scroll += std::max(bottom - page.y - page.height, 0);
}

bool Viewer::picker_is_above(int index) const
{
  if (!this->Picker || *this->Picker >= index)
  {
    return false;
  }
  if (*this->Picker == HotSpot::chosen_point)
  {
    return this->Page == ControlPage::Look;
  }
  const Control& control = controls()[static_cast<std::size_t>(*this->Picker)];
  return control.page == this->Page && control.inapplicable(this->control_scene()).empty();
}

void Viewer::press_curve(const HotSpot& spot, int x, bool right_button, bool twice, int y)
{
  const CurveField field = curve_field(this->panel_model(), spot.box);
  TransferFunction function = this->Function;
  int index = point_at(function, field, x, y, Metrics(this->Set.scale).text);
  if (right_button && index >= 0)
  {
    remove_point(function, index);
    this->Hand = {};
    this->set_function(function);
    return;
  }
  if (index < 0 && twice)
  {
    index = add_point(function, field.value_of(x), field.opacity_of(y));
    this->set_function(function);
  }
  if (index >= 0 && !right_button)
  {
    this->Hold = Held::Point;
    this->Hand = { FunctionPoint::Kind::Opacity, index };
    this->PanelChanged = true;
  }
  else if (index < 0)
  {
    this->say("double click: a new point; right click: one less");
  }
}

void Viewer::press_colours(const HotSpot& spot, int x, bool right_button, bool twice)
{
  const CurveField field = curve_field(this->panel_model(), spot.box);
  TransferFunction function = this->Function;
  int index = colour_point_at(function, field, x, 2 * Metrics(this->Set.scale).text / 3);
  if (right_button && index >= 0)
  {
    remove_colour_point(function, index);
    this->Hand = {};
    this->choose_point(-1);
    this->set_function(function);
    return;
  }
  if (index < 0 && twice)
  {
    index = add_colour_point(function, field.value_of(x));
    this->set_function(function);
  }
  if (index >= 0 && !right_button)
  {
    this->Hold = Held::Point;
    this->Hand = { FunctionPoint::Kind::Colour, index };
    this->choose_point(index);
  }
  else if (index < 0)
  {
    this->choose_point(-1);
    this->say("double click: a new colour; right click: one less");
  }
}

FunctionPoint Viewer::point_under(int x, int y)
{
  const int px = x - this->Boxes.panel.x;
  const int py = y - this->Boxes.panel.y;
  const HotSpot* spot =
    !this->Help && this->Boxes.panel.contains(x, y) ? this->Panel.at(px, py) : nullptr;
  if (!spot || (spot->kind != HotSpot::Kind::Curve && spot->kind != HotSpot::Kind::Colours))
  {
    return {};
  }
  const CurveField field = curve_field(this->panel_model(), spot->box);
  const int reach = Metrics(this->Set.scale).text;
  const bool colour = spot->kind == HotSpot::Kind::Colours;
  const int index = colour ? colour_point_at(this->Function, field, px, 2 * reach / 3)
                           : point_at(this->Function, field, px, py, reach);
  return index < 0
           ? FunctionPoint{}
           : FunctionPoint{ colour ? FunctionPoint::Kind::Colour : FunctionPoint::Kind::Opacity,
               index };
}

void Viewer::drag_control(int x)
{
  const Box& box = this->HeldSpot.box;
  const double place = double(x - box.x) / std::max(box.width - 1, 1);
  if (this->HeldSpot.index == HotSpot::chosen_point)
  {
    this->set_chosen_colour(with_brightness(this->HeldColour, std::clamp(place, 0.0, 1.0)));
    return;
  }
  this->turn_held(controls()[static_cast<std::size_t>(this->HeldSpot.index)], place);
}

bool Viewer::drag_point(int x, int y)
{
  const PanelModel model = this->panel_model();
  const bool colour = this->Hand.kind == FunctionPoint::Kind::Colour;
  const std::size_t count = colour ? this->Function.colour.size() : this->Function.opacity.size();
  if (!model.function || this->Hand.index < 0 ||
      static_cast<std::size_t>(this->Hand.index) >= count)
  {
    this->Hold = Held::Nothing; // it went under the hand
    return false;
  }
  const CurveField field = curve_field(model, this->HeldSpot.box);
  TransferFunction function = this->Function;
  if (colour)
  {
    move_colour_point(function, this->Hand.index, field.value_of(x));
  }
  else
  {
    move_point(function, this->Hand.index, field.value_of(x), field.opacity_of(y));
  }
  this->set_function(function);
  return true;
}

bool Viewer::drag(int x, int y)
{
  const int px = x - this->Boxes.panel.x;
  const int py = y - this->Boxes.panel.y;
  const Box& box = this->HeldSpot.box;
  switch (this->Hold)
  {
    case Held::Nothing:
    {
      const FunctionPoint under = this->point_under(x, y);
      this->PanelChanged = this->PanelChanged || !(under == this->Hand);
      this->Hand = under;
      return false;
    }
    case Held::Control:
      this->drag_control(px);
      return true;
    case Held::Picker:
      this->tint(this->HeldSpot.index,
        std::clamp(double(px - box.x) / std::max(box.width - 1, 1), 0.0, 0.9999), // 1 is 0 again
        std::clamp(1.0 - double(py - box.y) / std::max(box.height - 1, 1), 0.0, 1.0));
      return true;
    case Held::Scroll:
      this->Scrolls[static_cast<std::size_t>(this->Page)] =
        this->Panel.scroll_at(py - this->HeldOffset);
      this->PanelChanged = true;
      return true;
    case Held::Ball:
      this->turn_sun(x, y);
      return true;
    case Held::Point:
      return this->drag_point(px, py);
    case Held::Divider:
    {
      const Box& picture = this->Boxes.pictures.front();
      this->Divider = std::clamp(double(x - picture.x) / picture.width, 0.0, 1.0);
      this->PicturesChanged = true;
      return true;
    }
  }
  return false;
}

bool Viewer::release()
{
  const bool held = this->Hold != Held::Nothing;
  this->Hold = Held::Nothing;
  this->BeforeDrag.reset();
  this->PanelChanged = this->PanelChanged || held;
  return held;
}

bool Viewer::wheel(int x, int y, int steps)
{
  if (this->Help || !this->Boxes.panel.contains(x, y))
  {
    return this->Help;
  }
  if (this->Hold != Held::Nothing)
  {
    return true; // what is held must not go from under the hand
  }
  int& scroll = this->Scrolls[static_cast<std::size_t>(this->Page)];
  const int by = 3 * Metrics(this->Set.scale).line * steps;
  const int next = std::clamp(scroll - by, 0, this->Panel.most);
  this->PanelChanged = this->PanelChanged || next != scroll;
  scroll = next;
  return true;
}

void Viewer::flick()
{
  if (this->compares() && this->Set.arrangement == Arrangement::Flicker)
  {
    this->SecondShown = !this->SecondShown;
    this->PicturesChanged = true;
  }
}

}
