#include "legend.h"

#include <algorithm>
#include <cmath>

namespace brume
{

void draw_legend(Canvas& canvas, int x, int y, const LegendLayout& layout, DifferenceKind kind,
  double gain, std::size_t non_finite_pixels)
{
  const TextStyle label{ layout.size, false, palette::text };
  const TextStyle mark{ layout.size - 1, false, palette::quiet };
  const int left = x + layout.margin();
  const int width = layout.width - 2 * layout.margin();

  int baseline = y + layout.margin() + layout.size - 2;
  int label_width = width;
  if (non_finite_pixels > 0)
  {
    const std::string note = std::to_string(non_finite_pixels) + " not finite";
    const int swatch = layout.size;
    canvas.text(left + width, baseline, note, label, Align::Right);
    const int note_left = left + width - text_width(note, label) - swatch - 5;
    canvas.fill(note_left, baseline - swatch + 2, swatch, swatch, non_finite_colour);
    label_width = note_left - left - layout.size;
  }
  canvas.text(left, baseline, fitted(difference_label(kind, gain), label, label_width), label);

  const std::string unit = "in 1/255";
  const int unit_width = text_width(unit, mark) + layout.size;
  const int bar_width = width - unit_width;
  const int bar_top = baseline + layout.size / 2 + 2;
  canvas.fill(left - 1, bar_top - 1, bar_width + 2, layout.bar() + 2, palette::frame);
  for (int column = 0; column < bar_width; ++column)
  {
    canvas.fill(left + column, bar_top, 1, layout.bar(),
      legend_colour(kind, (column + 0.5) / bar_width));
  }
  baseline = bar_top + layout.bar() + layout.size + layout.size / 2;
  for (const LegendTick& tick : legend_ticks(kind, gain))
  {
    const int at = left + static_cast<int>(std::lround(tick.position * (bar_width - 1)));
    canvas.fill(at, bar_top + layout.bar() + 1, 1, 3, palette::quiet);
    const int half = text_width(tick.text, mark) / 2;
    canvas.text(std::max(at, left + half), baseline, tick.text, mark, Align::Centre);
  }
  canvas.text(left + width, bar_top + layout.bar() - 2, unit, mark, Align::Right);
}

}
