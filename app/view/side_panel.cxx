#include "side_panel.h"

#include "Analysis/canvas.h"
#include "Analysis/figures.h"

#include <algorithm>
#include <cmath>

namespace brume::app
{

namespace
{

constexpr const char* page_names[] = { "Light", "Matter", "Look", "Plan" };
constexpr Colour bar_colour{ 48, 52, 61 };
constexpr Colour warm{ 255, 196, 110 };

Colour colour_of(const ColourPoint& p)
{
  const auto byte = [](double v)
  { return static_cast<unsigned char>(std::lround(255.0 * std::clamp(v, 0.0, 1.0))); };
  return { byte(p.red), byte(p.green), byte(p.blue) };
}

/// Draws from the top down, and leaves out what no longer fits.
class Column
{
public:
  Column(const PanelModel& model, int width, int height, const Metrics& metrics)
    : Model(model)
    , M(metrics)
    , Width(width)
    , Height(height)
    , Sheet(width, height, palette::page)
    , Left(metrics.margin)
    , Inner(std::max(width - 2 * metrics.margin, 1))
  {
    this->Sheet.fill(0, 0, 1, height, palette::frame);
  }

  DrawnPanel draw()
  {
    this->Bottom = this->Height - this->M.margin - this->M.line;
    this->tabs();
    switch (this->Model.page)
    {
      case ControlPage::Light:
        this->ball();
        this->sliders();
        this->figures();
        break;
      case ControlPage::Matter:
        this->sliders();
        this->figures();
        break;
      case ControlPage::Look:
        this->look();
        break;
      case ControlPage::Plan:
        this->plan();
        break;
    }
    this->text(this->Left, this->Height - this->M.margin, this->Model.hint, palette::quiet, this->Inner);
    this->Drawn.bitmap = this->Sheet.bitmap();
    return std::move(this->Drawn);
  }

private:
  TextStyle style(Colour colour, bool bold = false) const { return { this->M.text, bold, colour }; }

  void text(int x, int baseline, const std::string& line, Colour colour, int width, Align align = Align::Left,
    bool bold = false)
  {
    const TextStyle s = this->style(colour, bold);
    this->Sheet.text(x, baseline, fitted(line, s, width), s, align);
  }

  bool fits(int height) const { return this->Y + height <= this->Bottom; }

  void spot(HotSpot::Kind kind, const Box& box, int index, const std::string& name = {})
  {
    this->Drawn.spots.push_back({ kind, box, index, name });
  }

  void tabs()
  {
    const int count = 4;
    const int each = this->Inner / count;
    const int height = this->M.line + this->M.margin;
    for (int i = 0; i < count; ++i)
    {
      const Box box{ this->Left + i * each, this->M.margin, each, height };
      const bool here = i == static_cast<int>(this->Model.page);
      if (here)
      {
        this->Sheet.fill(box.x, box.y + box.height - 2, box.width, 2, palette::accent);
      }
      this->text(box.x + each / 2, box.y + this->M.line - this->M.margin / 2, page_names[i],
        here ? palette::text : palette::quiet, each, Align::Centre, here);
      this->spot(HotSpot::Kind::Page, box, i);
    }
    this->Y = 2 * this->M.margin + height + this->M.margin;
  }

  void slider(int index)
  {
    const Control& control = controls()[static_cast<std::size_t>(index)];
    const ControlScene& scene = this->Model.scene;
    if (!this->fits(this->M.row))
    {
      return;
    }
    const bool means = control.inapplicable(scene).empty();
    std::optional<double> value;
    if (means)
    {
      value = control.get(scene);
    }
    const std::string number = !means ? "-" : value ? with_unit(*value, this->unit_of(control)) : "off";
    const int baseline = this->Y + this->M.text;
    const int room = text_width(number, this->style(palette::text));
    this->text(this->Left + this->Inner, baseline, number, value ? palette::text : palette::quiet,
      this->Inner, Align::Right);
    this->text(this->Left, baseline, control.name, means ? palette::text : palette::quiet,
      std::max(this->Inner - room - this->M.margin, 0));
    const int thick = std::max(3, this->M.text / 4);
    const int y = this->Y + this->M.line;
    this->Sheet.fill(this->Left, y, this->Inner, thick, bar_colour);
    if (value)
    {
      const int length =
        static_cast<int>(std::lround(place_of(control, scene, *value) * this->Inner));
      this->Sheet.fill(this->Left, y, length, thick, palette::accent);
      const int knob = std::max(4, this->M.text / 3);
      this->Sheet.fill(std::clamp(this->Left + length - knob / 2, this->Left,
                         this->Left + this->Inner - knob),
        y - thick / 2 - 1, knob, 2 * thick + 2, palette::text);
    }
    if (means)
    {
      this->spot(HotSpot::Kind::Control, { this->Left, this->Y, this->Inner, this->M.row }, index);
    }
    this->Y += this->M.row;
  }

  /// A white ball in the sun's light, with the sun as a dot.
  void ball()
  {
    const int radius = std::min(4 * this->M.text, this->Inner / 3);
    if (!this->fits(2 * radius + this->M.margin))
    {
      return;
    }
    const int cx = this->Left + this->Inner / 2;
    const int cy = this->Y + radius;
    const Triple& sun = this->Model.sun_seen;
    const bool shines = sun != Triple{ 0.0, 0.0, 0.0 };
    for (int y = -radius; y <= radius; ++y)
    {
      for (int x = -radius; x <= radius; ++x)
      {
        const double u = double(x) / radius;
        const double v = -double(y) / radius;
        const double rest = 1.0 - u * u - v * v;
        if (rest < 0.0)
        {
          continue;
        }
        const double cosine = u * sun[0] + v * sun[1] + std::sqrt(rest) * sun[2];
        const double light = shines ? 0.12 + 0.78 * std::sqrt(std::max(cosine, 0.0)) : 0.2;
        const auto grey = static_cast<unsigned char>(std::lround(255.0 * light));
        this->Sheet.fill(cx + x, cy + y, 1, 1, { grey, grey, grey });
      }
    }
    if (shines)
    {
      const int dot = std::max(6, this->M.text / 2);
      const int x = cx + static_cast<int>(std::lround(sun[0] * radius));
      const int y = cy - static_cast<int>(std::lround(sun[1] * radius));
      this->Sheet.fill(x - dot / 2 - 1, y - dot / 2 - 1, dot + 2, dot + 2, palette::page);
      this->Sheet.fill(x - dot / 2, y - dot / 2, dot, dot, sun[2] >= 0.0 ? warm : palette::frame);
    }
    this->spot(HotSpot::Kind::Ball, { cx - radius, cy - radius, 2 * radius + 1, 2 * radius + 1 }, 0);
    this->Y += 2 * radius + 2 * this->M.margin;
  }

  std::string unit_of(const Control& control) const
  {
    const std::string unit = control.unit;
    const std::string length = this->Model.length_unit.empty() ? "units" : this->Model.length_unit;
    return unit == "length"          ? length
      : unit == "per unit length"    ? "/ " + length
                                     : unit;
  }

  void sliders()
  {
    for (std::size_t i = 0; i < controls().size(); ++i)
    {
      if (controls()[i].page == this->Model.page)
      {
        this->slider(static_cast<int>(i));
      }
    }
  }

  void figures()
  {
    this->Y += this->M.margin;
    for (const auto& [name, value] : this->Model.figures)
    {
      if (!this->fits(this->M.line))
      {
        return;
      }
      const int baseline = this->Y + this->M.text;
      const int room = text_width(value, this->style(palette::text));
      this->text(this->Left + this->Inner, baseline, value, palette::text, this->Inner, Align::Right);
      this->text(this->Left, baseline, name, palette::quiet,
        std::max(this->Inner - room - this->M.margin, 0));
      this->Y += this->M.line;
    }
  }

  void look()
  {
    const int height = this->M.line + this->M.margin;
    if (!this->Model.preset.empty() && this->fits(height))
    {
      const int button = 2 * this->M.text;
      const int baseline = this->Y + this->M.line - this->M.margin / 2;
      const Box before{ this->Left, this->Y, button, this->M.line };
      const Box next{ this->Left + this->Inner - button, this->Y, button, this->M.line };
      for (const Box& box : { before, next })
      {
        this->Sheet.fill(box.x, box.y, box.width, box.height, bar_colour);
      }
      this->text(before.x + button / 2, baseline, "<", palette::text, button, Align::Centre);
      this->text(next.x + button / 2, baseline, ">", palette::text, button, Align::Centre);
      this->text(this->Left + this->Inner / 2, baseline, this->Model.preset, palette::text,
        this->Inner - 2 * button - this->M.margin, Align::Centre);
      this->spot(HotSpot::Kind::Preset, before, -1);
      this->spot(HotSpot::Kind::Preset, next, 1);
      this->Y += height;
      if (this->fits(height))
      {
        const bool on = this->Model.scene.options->shade == "on";
        const bool off = this->Model.scene.options->shade == "off";
        const Box box{ this->Left, this->Y, this->Inner, this->M.line };
        const std::string state = on ? "on" : off ? "off" : "as preset";
        const int room = text_width(state, this->style(palette::text));
        this->text(this->Left + this->Inner, this->Y + this->M.text, state, palette::text, this->Inner,
          Align::Right);
        this->text(this->Left, this->Y + this->M.text, "gradient shading", palette::text,
          std::max(this->Inner - room - this->M.margin, 0));
        this->spot(HotSpot::Kind::Shade, box, 0);
        this->Y += height;
      }
      this->curve();
    }
    this->sliders();
    this->figures();
  }

  void curve()
  {
    const int height = 9 * this->M.text;
    const int strip = this->M.text;
    if (!this->Model.function || !this->fits(height + strip + this->M.line + this->M.margin))
    {
      return;
    }
    const Box box{ this->Left, this->Y, this->Inner, height };
    this->Sheet.fill(box.x, box.y, box.width, box.height, { 15, 16, 20 });
    const CurveField field = curve_field(this->Model, box);
    const TransferFunction& function = *this->Model.function;
    const Histogram* histogram = this->Model.histogram;
    if (histogram && !histogram->counts.empty())
    {
      const auto most = *std::max_element(histogram->counts.begin(), histogram->counts.end());
      for (int x = 0; x < box.width; ++x)
      {
        const std::size_t bin = static_cast<std::size_t>(x) * histogram->counts.size() /
          static_cast<std::size_t>(box.width);
        const double share =
          std::log1p(double(histogram->counts[bin])) / std::log1p(double(std::max<std::uint64_t>(most, 1)));
        const int bar = static_cast<int>(std::lround(share * (height - 1)));
        this->Sheet.fill(box.x + x, box.y + height - bar, 1, bar, palette::frame);
      }
    }
    this->polyline(field, function);
    for (int x = 0; x < box.width; ++x)
    {
      this->Sheet.fill(box.x + x, box.y + height + 2, 1, strip,
        colour_of(colour_at(function, field.value_of(box.x + x))));
    }
    const int baseline = box.y + height + strip + this->M.line;
    const std::string& unit = this->Model.value_unit;
    this->text(box.x, baseline, with_unit(field.lower, unit), palette::quiet, box.width / 2);
    this->text(box.x + box.width, baseline, with_unit(field.upper, unit), palette::quiet,
      box.width / 2, Align::Right);
    this->spot(HotSpot::Kind::Curve, box, 0);
    this->Y = baseline + 2 * this->M.margin;
  }

  /// The opacity over the field, with its points.
  void polyline(const CurveField& field, const TransferFunction& function)
  {
    const std::vector<OpacityPoint>& points = function.opacity;
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
      this->Sheet.fill(x, top, 1, bottom - top + 2, palette::accent);
      last = y;
    }
    const int size = std::max(5, this->M.text / 2);
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      const bool held = static_cast<int>(i) == this->Model.point;
      this->Sheet.fill(field.x_of(points[i].value) - size / 2, field.y_of(points[i].opacity) - size / 2,
        size, size, held ? warm : palette::text);
    }
  }

  void plan()
  {
    const Shot* shot = this->Model.shot;
    if (!shot || shot->effects.empty())
    {
      this->text(this->Left, this->Y + this->M.text, "No plan: VTK's mappers have none.",
        palette::quiet, this->Inner);
      return;
    }
    for (const ShownEffect& effect : shot->effects)
    {
      if (!this->fits(2 * this->M.line + this->M.margin / 2))
      {
        return;
      }
      const std::string cost = !this->Model.times || !std::isfinite(effect.milliseconds) ||
          effect.milliseconds <= 0.0
        ? ""
        : figure(effect.milliseconds, 2) + " ms";
      const int baseline = this->Y + this->M.text;
      const int mark = this->M.text - 3;
      this->Sheet.fill(this->Left, baseline - mark + 1, mark, mark,
        effect.forced ? warm : effect.on ? palette::accent : bar_colour);
      const int x = this->Left + this->M.text + this->M.margin;
      this->text(this->Left + this->Inner, baseline, cost, effect.on ? palette::text : palette::quiet,
        this->Inner, Align::Right);
      this->text(x, baseline, effect.name + (effect.forced ? " (forced)" : ""),
        effect.on ? palette::text : palette::quiet,
        this->Inner - (x - this->Left) - text_width(cost, this->style(palette::text)) - this->M.margin);
      std::string reason = effect.reason;
      if (!effect.on && effect.error_bound > 0.0)
      {
        reason = "error " + figure(effect.error_bound, 2) + ": " + reason;
      }
      const TextStyle small{ std::max(8, this->M.text - 2), false, palette::quiet };
      this->Sheet.text(x, baseline + this->M.line - 1,
        fitted(reason, small, this->Left + this->Inner - x), small);
      this->spot(HotSpot::Kind::Effect,
        { this->Left, this->Y, this->Inner, 2 * this->M.line }, 0, effect.name);
      this->Y += 2 * this->M.line + this->M.margin / 2;
    }
  }

  const PanelModel& Model;
  const Metrics& M;
  int Width;
  int Height;
  Canvas Sheet;
  int Left;
  int Inner;
  int Y = 0;
  int Bottom = 0;
  DrawnPanel Drawn;
};

}

const HotSpot* DrawnPanel::at(int x, int y) const
{
  const auto found = std::find_if(this->spots.begin(), this->spots.end(),
    [&](const HotSpot& spot) { return spot.box.contains(x, y); });
  return found == this->spots.end() ? nullptr : &*found;
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

DrawnPanel draw_panel(const PanelModel& model, int width, int height, const Metrics& metrics)
{
  return Column(model, width, height, metrics).draw();
}

std::string with_unit(double value, const std::string& unit)
{
  return figure(value) + (unit.empty() ? "" : " " + unit);
}

}
