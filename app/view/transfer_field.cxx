// The transfer function on the panel.
#include "side_panel.h"

#include "Analysis/figures.h"

#include <algorithm>
#include <cmath>

namespace brume::app
{

namespace
{

constexpr Colour field_colour{ 15, 16, 20 };
constexpr Colour held_colour{ 255, 196, 110 };

/// Counts as bars, by their logarithm.
void draw_histogram(Canvas& canvas, const Box& box, const Histogram& histogram)
{
  if (histogram.counts.empty())
  {
    return;
  }
  const auto most = *std::max_element(histogram.counts.begin(), histogram.counts.end());
  const double longest = std::log1p(double(std::max<std::uint64_t>(most, 1)));
  for (int x = 0; x < box.width; ++x)
  {
    const std::size_t bin =
      static_cast<std::size_t>(x) * histogram.counts.size() / static_cast<std::size_t>(box.width);
    const double share = std::log1p(double(histogram.counts[bin])) / longest;
    const int bar = static_cast<int>(std::lround(share * (box.height - 1)));
    canvas.fill(box.x + x, box.y + box.height - bar, 1, bar, palette::frame);
  }
}

/// The opacity over the field, with its points.
void draw_opacities(PanelSheet& sheet, const PanelModel& model, const CurveField& field)
{
  const std::vector<OpacityPoint>& points = model.function->opacity;
  if (points.empty())
  {
    return;
  }
  std::size_t next = 0;
  int last = -1;
  for (int x = field.box.x; x < field.box.x + field.box.width; ++x)
  {
    const double value = field.value_of(x);
    while (next < points.size() && points[next].value < value)
    {
      ++next;
    }
    double opacity = next == 0 ? points.front().opacity : points.back().opacity;
    if (next > 0 && next < points.size())
    {
      const OpacityPoint& a = points[next - 1];
      const OpacityPoint& b = points[next];
      opacity = a.opacity + (b.opacity - a.opacity) * (value - a.value) / (b.value - a.value);
    }
    const int y = field.y_of(opacity);
    const int top = last < 0 ? y : std::min(y, last);
    const int bottom = last < 0 ? y : std::max(y, last);
    sheet.canvas().fill(x, top, 1, bottom - top + 2, palette::accent);
    last = y;
  }
  const int size = std::max(5, sheet.metrics().text / 2);
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    const bool held = model.hand.is(FunctionPoint::Kind::Opacity, static_cast<int>(i));
    sheet.canvas().fill(field.x_of(points[i].value) - size / 2,
      field.y_of(points[i].opacity) - size / 2,
      size,
      size,
      held ? held_colour : palette::text);
  }
}

/// A pointer to a place of the strip above it, filled with the colour there.
void draw_pointer(Canvas& canvas, int x, int y, int height, Colour rim, Colour inside)
{
  const int half = std::max(3, height / 2);
  for (int row = 0; row < height; ++row)
  {
    const int reach = std::min(row, half);
    canvas.fill(x - reach, y + row, 2 * reach + 1, 1, rim);
    if (reach >= 2 && row + 1 < height)
    {
      canvas.fill(x - reach + 1, y + row, 2 * reach - 1, 1, inside);
    }
  }
}

void draw_colours(PanelSheet& sheet,
  const PanelModel& model,
  const CurveField& field,
  const Box& strip,
  int knob)
{
  const TransferFunction& function = *model.function;
  for (int x = strip.x; x < strip.x + strip.width; ++x)
  {
    const ColourPoint p = colour_at(function, field.value_of(x));
    sheet.canvas().fill(
      x, strip.y, 1, strip.height, shown_colour({ p.red, p.green, p.blue }, model.curve));
  }
  const auto pointer = [&](std::size_t i)
  {
    const ColourPoint& p = function.colour[i];
    const int index = static_cast<int>(i);
    const bool held = model.hand.is(FunctionPoint::Kind::Colour, index);
    draw_pointer(sheet.canvas(),
      field.x_of(p.value),
      strip.y + strip.height,
      knob,
      held                    ? held_colour
      : index == model.chosen ? palette::accent
                              : palette::text,
      shown_colour({ p.red, p.green, p.blue }, model.curve));
  };
  for (std::size_t i = 0; i < function.colour.size(); ++i)
  {
    pointer(i);
  }
  if (model.chosen >= 0 && model.chosen < static_cast<int>(function.colour.size()))
  {
    pointer(static_cast<std::size_t>(model.chosen)); // over its neighbours
  }
}

/// Of the point under the hand, what it says; empty where there is none.
std::string words_of_point(const PanelModel& model)
{
  const std::size_t i = static_cast<std::size_t>(model.hand.index);
  if (model.hand.kind == FunctionPoint::Kind::Opacity && i < model.function->opacity.size())
  {
    const OpacityPoint& p = model.function->opacity[i];
    return with_unit(p.value, model.value_unit) + ": opacity " + figure(p.opacity);
  }
  if (model.hand.kind == FunctionPoint::Kind::Colour && i < model.function->colour.size())
  {
    const ColourPoint& p = model.function->colour[i];
    return with_unit(p.value, model.value_unit) + ": " + figure(p.red, 2) + ", " +
           figure(p.green, 2) + ", " + figure(p.blue, 2);
  }
  return {};
}

}

CurveField curve_field(const PanelModel& model, const Box& box)
{
  CurveField field;
  field.box = box;
  const std::vector<OpacityPoint>& points = model.function->opacity;
  if (model.histogram && !model.histogram->counts.empty())
  {
    field.lower = model.histogram->lower;
    field.upper = model.histogram->upper;
  }
  else if (points.size() > 1)
  {
    field.lower = points.front().value;
    field.upper = points.back().value;
  }
  return field;
}

void draw_transfer_field(PanelSheet& sheet, const PanelModel& model)
{
  const Metrics& m = sheet.metrics();
  const int gap = 2;
  const int height = 9 * m.text;
  const int knob = std::max(9, m.text - 2);
  if (!model.function)
  {
    return;
  }
  const std::optional<int> top = sheet.take(height + gap + m.text + knob + m.line + 2 * m.margin);
  if (!top)
  {
    return;
  }
  const Box box{ sheet.left(), *top, sheet.inner(), height };
  sheet.canvas().fill(box.x, box.y, box.width, box.height, field_colour);
  const CurveField field = curve_field(model, box);
  if (model.histogram)
  {
    draw_histogram(sheet.canvas(), box, *model.histogram);
  }
  draw_opacities(sheet, model, field);
  sheet.spot(HotSpot::Kind::Curve, box);

  const Box strip{ box.x, box.y + height + gap, box.width, m.text };
  draw_colours(sheet, model, field, strip, knob);
  sheet.spot(HotSpot::Kind::Colours, { strip.x, strip.y, strip.width, strip.height + knob });

  const int baseline = strip.y + strip.height + knob + m.line - 1;
  const std::string words = words_of_point(model);
  if (!words.empty())
  {
    sheet.text(box.x + box.width / 2, baseline, words, palette::text, box.width, Align::Centre);
    return;
  }
  sheet.pair(baseline,
    with_unit(field.lower, model.value_unit),
    palette::quiet,
    with_unit(field.upper, model.value_unit),
    palette::quiet);
}

}
