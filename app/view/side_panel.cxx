#include "side_panel.h"

#include "Analysis/figures.h"
#include "film_io.h"

#include <algorithm>
#include <cmath>

namespace brume::app
{

namespace
{

constexpr const char* page_names[] = { "Light", "Matter", "Look", "Plan" };
constexpr Colour bar_colour{ 48, 52, 61 };
constexpr Colour warm{ 255, 196, 110 };

int head_height(const Metrics& metrics)
{
  return metrics.line + 4 * metrics.margin;
}

/// A row of the panel: a name, a number and a bar, and a swatch where it is a colour's brightness.
struct Row
{
  std::string name;
  std::string number;
  std::optional<double> place; ///< on the bar; none: off
  std::optional<Triple> colour;
  int index = 0; ///< of its hot spots
};

class Pages
{
public:
  Pages(const PanelModel& model, int width, int height, const Metrics& metrics)
    : Model(model)
    , M(metrics)
    , Hint(wrapped(model.hint,
        { metrics.text, false, palette::quiet },
        PanelSheet::inner(width, metrics),
        std::clamp((height - head_height(metrics)) / (4 * metrics.line), 1, 3)))
    , Height(height)
    , Sheet(width,
        height,
        metrics,
        head_height(metrics),
        2 * metrics.margin + metrics.line * std::max(static_cast<int>(this->Hint.size()), 1),
        model.scroll)
  {
  }

  DrawnPanel draw()
  {
    switch (this->Model.page)
    {
      case ControlPage::Light:
        this->ball();
        this->controls_of_page();
        this->figures();
        break;
      case ControlPage::Matter:
        this->controls_of_page();
        this->figures();
        break;
      case ControlPage::Look:
        this->look();
        break;
      case ControlPage::Plan:
        this->plan();
        break;
    }
    this->Sheet.end_page();
    this->tabs();
    int baseline =
      this->Height - this->M.margin - this->M.line * (static_cast<int>(this->Hint.size()) - 1);
    for (const std::string& line : this->Hint)
    {
      this->Sheet.text(this->Sheet.left(), baseline, line, palette::quiet, this->Sheet.inner());
      baseline += this->M.line;
    }
    return this->Sheet.finish();
  }

private:
  Canvas& canvas() { return this->Sheet.canvas(); }

  void tabs()
  {
    const int count = 4;
    const int each = this->Sheet.inner() / count;
    const int height = this->M.line + this->M.margin;
    for (int i = 0; i < count; ++i)
    {
      const Box box{ this->Sheet.left() + i * each, this->M.margin, each, height };
      const bool here = i == static_cast<int>(this->Model.page);
      if (here)
      {
        this->canvas().fill(box.x, box.y + box.height - 2, box.width, 2, palette::accent);
      }
      this->Sheet.text(box.x + each / 2,
        box.y + this->M.line - this->M.margin / 2,
        page_names[i],
        here ? palette::text : palette::quiet,
        each,
        Align::Centre,
        here);
      this->Sheet.spot(HotSpot::Kind::Page, box, i);
    }
  }

  /// A row, and below it the picker of its colour where that is shown.
  void row(const Row& row)
  {
    const std::optional<int> top = this->Sheet.take(this->M.row);
    if (top)
    {
      this->draw_row(row, *top);
    }
    if (row.colour && this->Model.picker == row.index)
    {
      this->picker(row);
    }
  }

  void draw_row(const Row& row, int top)
  {
    const int left = this->Sheet.left();
    const int thick = std::max(3, this->M.text / 4);
    const int swatch = row.colour ? 2 * this->M.text : 0;
    const int width = this->Sheet.inner() - (row.colour ? swatch + this->M.margin : 0);
    this->Sheet.pair(top + this->M.text,
      row.name,
      palette::text,
      row.number,
      row.place ? palette::text : palette::quiet,
      width);
    const int y = top + this->M.line;
    this->canvas().fill(left, y, width, thick, bar_colour);
    if (row.place)
    {
      const int length = static_cast<int>(std::lround(*row.place * width));
      this->canvas().fill(left, y, length, thick, palette::accent);
      const int knob = std::max(4, this->M.text / 3);
      this->canvas().fill(std::clamp(left + length - knob / 2, left, left + width - knob),
        y - thick / 2 - 1,
        knob,
        2 * thick + 2,
        palette::text);
    }
    this->Sheet.spot(HotSpot::Kind::Control, { left, top, width, this->M.row }, row.index);
    if (row.colour)
    {
      const int height = this->M.line + thick - this->M.text / 4;
      const Box box{ this->Sheet.right() - swatch, top + this->M.text / 4, swatch, height };
      const bool open = this->Model.picker == row.index;
      this->canvas().fill(box.x,
        box.y,
        box.width,
        box.height,
        row.place ? shown_colour(*row.colour, this->Model.curve) : palette::page);
      this->Sheet.outline(box, open ? palette::accent : palette::quiet, open ? 2 : 1);
      this->Sheet.spot(HotSpot::Kind::Swatch, box, row.index);
    }
  }

  /// Hue across, saturation down, and the numbers below.
  void picker(const Row& row)
  {
    const int height = 5 * this->M.text;
    const std::optional<int> top = this->Sheet.take(picker_height(this->M));
    if (!top)
    {
      return;
    }
    const Box box{ this->Sheet.left(), *top, this->Sheet.inner(), height };
    for (int y = 0; y < height; ++y)
    {
      for (int x = 0; x < box.width; ++x)
      {
        const Tint tint{ double(x) / (box.width - 1), 1.0 - double(y) / (height - 1), 1.0 };
        this->canvas().fill(
          box.x + x, box.y + y, 1, 1, shown_colour(colour_of(tint), this->Model.curve));
      }
    }
    const Tint now = tint_of(*row.colour);
    const int size = std::max(7, this->M.text / 2);
    const int x = box.x + static_cast<int>(std::lround(now.hue * (box.width - 1)));
    const int y = box.y + static_cast<int>(std::lround((1.0 - now.saturation) * (height - 1)));
    const Box mark{ std::clamp(x - size / 2, box.x, box.x + box.width - size),
      std::clamp(y - size / 2, box.y, box.y + height - size),
      size,
      size };
    this->Sheet.outline(mark, palette::page, 2);
    this->Sheet.outline({ mark.x + 1, mark.y + 1, size - 2, size - 2 }, palette::text);
    this->Sheet.spot(HotSpot::Kind::Picker, box, row.index);
    const Triple& c = *row.colour;
    this->Sheet.pair(*top + height + this->M.text + this->M.margin / 2,
      "red, green, blue",
      palette::quiet,
      figure(c[0]) + ", " + figure(c[1]) + ", " + figure(c[2]),
      palette::quiet);
  }

  /// A white ball in the sun's light, with the sun as a dot.
  void ball()
  {
    const int radius = std::min(4 * this->M.text, this->Sheet.inner() / 3);
    const std::optional<int> top = this->Sheet.take(2 * radius + 2 * this->M.margin);
    if (!top)
    {
      return;
    }
    const int cx = this->Sheet.left() + this->Sheet.inner() / 2;
    const int cy = *top + radius;
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
        this->canvas().fill(cx + x, cy + y, 1, 1, { grey, grey, grey });
      }
    }
    if (shines)
    {
      const int dot = std::max(6, this->M.text / 2);
      const int x = cx + static_cast<int>(std::lround(sun[0] * radius));
      const int y = cy - static_cast<int>(std::lround(sun[1] * radius));
      this->canvas().fill(x - dot / 2 - 1, y - dot / 2 - 1, dot + 2, dot + 2, palette::page);
      this->canvas().fill(
        x - dot / 2, y - dot / 2, dot, dot, sun[2] >= 0.0 ? warm : palette::frame);
    }
    this->Sheet.spot(
      HotSpot::Kind::Ball, { cx - radius, cy - radius, 2 * radius + 1, 2 * radius + 1 });
  }

  std::string unit_of(const Control& control) const
  {
    const std::string unit = control.unit;
    const std::string& length = this->Model.length_unit; // empty where unknown
    const std::string each = "/ " + (length.empty() ? "unit" : length);
    const bool density = this->Model.scene.options->density();
    return unit == "length"            ? (length.empty() ? "units" : length)
           : unit == "per unit length" ? each
           : unit == "emitted"         ? (density ? each : std::string())
                                       : unit;
  }

  void controls_of_page()
  {
    const ControlScene& scene = this->Model.scene;
    for (std::size_t i = 0; i < controls().size(); ++i)
    {
      const Control& control = controls()[i];
      if (control.page != this->Model.page || !control.inapplicable(scene).empty())
      {
        continue;
      }
      Row row;
      row.name = control.name;
      row.index = static_cast<int>(i);
      const std::optional<double> value = control.get(scene);
      row.number = value ? with_unit(*value, this->unit_of(control)) : "off";
      if (value)
      {
        row.place = place_of(control, scene, *value);
      }
      if (control.colour)
      {
        row.colour = control.colour(scene);
      }
      this->row(row);
    }
  }

  void figures()
  {
    this->Sheet.skip(this->M.margin);
    for (const auto& [name, value] : this->Model.figures)
    {
      if (const std::optional<int> top = this->Sheet.take(this->M.line))
      {
        this->Sheet.pair(*top + this->M.text, name, palette::quiet, value, palette::text);
      }
    }
  }

  void look()
  {
    if (!this->Model.preset.empty())
    {
      this->preset();
      this->shade();
      draw_transfer_field(this->Sheet, this->Model);
      this->chosen_point();
    }
    this->controls_of_page();
    this->figures();
  }

  void preset()
  {
    const std::optional<int> top = this->Sheet.take(this->M.line + this->M.margin);
    if (!top)
    {
      return;
    }
    const int button = 2 * this->M.text;
    const int baseline = *top + this->M.line - this->M.margin / 2;
    const Box before{ this->Sheet.left(), *top, button, this->M.line };
    const Box next{ this->Sheet.right() - button, *top, button, this->M.line };
    for (const Box& box : { before, next })
    {
      this->canvas().fill(box.x, box.y, box.width, box.height, bar_colour);
    }
    this->Sheet.text(before.x + button / 2, baseline, "<", palette::text, button, Align::Centre);
    this->Sheet.text(next.x + button / 2, baseline, ">", palette::text, button, Align::Centre);
    this->Sheet.text(this->Sheet.left() + this->Sheet.inner() / 2,
      baseline,
      this->Model.preset,
      palette::text,
      this->Sheet.inner() - 2 * button - this->M.margin,
      Align::Centre);
    this->Sheet.spot(HotSpot::Kind::Preset, before, -1);
    this->Sheet.spot(HotSpot::Kind::Preset, next, 1);
  }

  void shade()
  {
    const std::optional<int> top = this->Sheet.take(this->M.line + this->M.margin);
    if (!top)
    {
      return;
    }
    const std::string& now = this->Model.scene.options->shade;
    this->Sheet.pair(*top + this->M.text,
      "gradient shading",
      palette::text,
      now == "preset" ? "as preset" : now,
      palette::text);
    this->Sheet.spot(
      HotSpot::Kind::Shade, { this->Sheet.left(), *top, this->Sheet.inner(), this->M.line });
  }

  /// The colour of the transfer function's point that was chosen.
  void chosen_point()
  {
    const TransferFunction* function = this->Model.function;
    const std::size_t i = static_cast<std::size_t>(this->Model.chosen);
    if (!function || this->Model.chosen < 0 || i >= function->colour.size())
    {
      return;
    }
    const ColourPoint& p = function->colour[i];
    Row row;
    row.colour = Triple{ p.red, p.green, p.blue };
    row.name = "colour at " + with_unit(p.value, this->Model.value_unit);
    row.place = brightness_of(*row.colour);
    row.number = figure(*row.place);
    row.index = HotSpot::chosen_point;
    this->row(row);
  }

  void plan()
  {
    const Shot* shot = this->Model.shot;
    if (!shot || shot->effects.empty())
    {
      if (const std::optional<int> top = this->Sheet.take(this->M.line))
      {
        this->Sheet.text(this->Sheet.left(),
          *top + this->M.text,
          "No plan: VTK's mappers have none.",
          palette::quiet,
          this->Sheet.inner());
      }
      return;
    }
    for (const ShownEffect& effect : shot->effects)
    {
      this->effect(effect);
    }
  }

  /// Its name and cost, and below them the reason, whole.
  void effect(const ShownEffect& effect)
  {
    std::string reason = effect.reason;
    if (!effect.on && effect.error_bound > 0.0)
    {
      reason = "error " + figure(effect.error_bound, 2) + ": " + reason;
    }
    const TextStyle small{ std::max(8, this->M.text - 2), false, palette::quiet };
    const int indent = this->M.text + this->M.margin;
    const std::vector<std::string> lines =
      wrapped(reason, small, std::max(this->Sheet.inner() - indent, 1), 6);
    const int height = (1 + static_cast<int>(lines.size())) * this->M.line;
    const std::optional<int> top = this->Sheet.take(height + this->M.margin / 2);
    if (!top)
    {
      return;
    }
    const std::string cost =
      !this->Model.times || !std::isfinite(effect.milliseconds) || effect.milliseconds <= 0.0
        ? ""
        : figure(effect.milliseconds, 2) + " ms";
    const int baseline = *top + this->M.text;
    const int mark = this->M.text - 3;
    const int left = this->Sheet.left();
    const int inner = this->Sheet.inner();
    const Colour colour = effect.on ? palette::text : palette::quiet;
    this->canvas().fill(left,
      baseline - mark + 1,
      mark,
      mark,
      effect.forced ? warm
      : effect.on   ? palette::accent
                    : bar_colour);
    const int x = left + indent;
    this->Sheet.text(left + inner, baseline, cost, colour, inner, Align::Right);
    this->Sheet.text(x,
      baseline,
      effect.name + (effect.forced ? " (forced)" : ""),
      colour,
      inner - (x - left) - text_width(cost, this->Sheet.style(palette::text)) - this->M.margin);
    int y = baseline + this->M.line - 1;
    for (const std::string& line : lines)
    {
      this->canvas().text(x, y, line, small);
      y += this->M.line;
    }
    this->Sheet.spot(HotSpot::Kind::Effect, { left, *top, inner, height }, 0, effect.name);
  }

  const PanelModel& Model;
  const Metrics& M;
  std::vector<std::string> Hint; ///< in lines
  int Height;
  PanelSheet Sheet;
};

}

DrawnPanel draw_panel(const PanelModel& model, int width, int height, const Metrics& metrics)
{
  DrawnPanel drawn = Pages(model, width, height, metrics).draw();
  if (drawn.scroll <= drawn.most)
  {
    return drawn;
  }
  PanelModel shorter = model; // than it was when it was scrolled
  shorter.scroll = drawn.most;
  return Pages(shorter, width, height, metrics).draw();
}

int picker_height(const Metrics& metrics)
{
  return 5 * metrics.text + metrics.line + metrics.margin;
}

Colour shown_colour(const Triple& colour, Display::Curve curve)
{
  const double over = std::max(brightness_of(colour), 1.0);
  const auto byte = [&](double v) {
    return display_byte(static_cast<float>(v / over), Display{ 0.0, curve });
  };
  return { byte(colour[0]), byte(colour[1]), byte(colour[2]) };
}

std::string with_unit(double value, const std::string& unit)
{
  return figure(value) + (unit.empty() ? "" : " " + unit);
}

}
