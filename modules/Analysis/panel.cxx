#include "panel.h"

#include "canvas.h"
#include "difference_picture.h"
#include "figures.h"
#include "legend.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace brume
{

namespace
{

/// One column: two lines above the picture, and a difference or a note below it.
struct Column
{
  std::string title;
  std::string figures;
  Bitmap picture;
  std::optional<DifferencePicture> difference;
  std::string note; ///< in the place of the difference
};

/// All measures in pixels, from the size of a cell.
struct Layout
{
  int columns = 1;
  int cell_width = 0;
  int cell_height = 0;
  int size = 14; ///< of plain lettering
  bool differences = false;

  int margin() const { return 2 * size; }
  int gap() const { return size; }
  int head() const { return margin() + 5 * size; }
  int titles() const { return 3 * size + size / 2; }
  int width() const
  {
    return std::max(
      2 * margin() + columns * cell_width + (columns - 1) * gap(), 2 * margin() + 26 * size);
  }
  int column(int i) const { return margin() + i * (cell_width + gap()); }
  int picture_top() const { return head() + titles(); }
  int difference_top() const { return picture_top() + cell_height + gap(); }
  int foot_top() const
  {
    return differences ? difference_top() + cell_height : picture_top() + cell_height;
  }
};

Layout layout_for(const Bitmap& picture, int columns, bool differences)
{
  Layout layout;
  layout.columns = columns;
  layout.differences = differences;
  double scale = 1.0;
  if (picture.width < 320)
  {
    scale = std::ceil(320.0 / picture.width);
  }
  else if (picture.width > 640)
  {
    scale = 640.0 / picture.width;
  }
  layout.cell_width = static_cast<int>(std::lround(picture.width * scale));
  layout.cell_height = std::max(1, static_cast<int>(std::lround(picture.height * scale)));
  layout.size = std::clamp(layout.cell_width / 28, 12, 18);
  return layout;
}

std::string join(const std::vector<std::string>& parts, const std::string& separator)
{
  std::string text;
  for (const std::string& part : parts)
  {
    if (!part.empty())
    {
      text += (text.empty() ? "" : separator) + part;
    }
  }
  return text;
}

std::string figures_line(const ComparisonEntry& entry)
{
  std::string text = seconds_text(entry.timing.median);
  if (entry.against_truth.values > 0)
  {
    text += ", mean error " + over_255(entry.against_truth.mean_absolute) + ", largest " +
      over_255(entry.against_truth.largest);
  }
  return text;
}

std::vector<Column> columns_of(const Comparison& comparison, double gain)
{
  const Picture& truth = comparison.truth.picture;
  const bool has_truth = !truth.rgb.empty();
  std::vector<Column> columns;
  for (const ComparisonEntry& entry : comparison.entries)
  {
    if (!entry.skipped.empty())
    {
      continue;
    }
    Column column;
    column.title = entry.title.empty() ? entry.mapper : entry.title;
    column.figures = figures_line(entry);
    column.picture = to_bitmap(entry.picture, comparison.display_curve, comparison.exposure);
    if (has_truth)
    {
      column.difference =
        difference_picture(entry.picture, truth, DifferenceKind::Absolute, gain);
    }
    columns.push_back(std::move(column));
  }
  if (columns.empty())
  {
    throw std::invalid_argument("panel: no mapper drew a picture: nothing can be laid out");
  }
  if (has_truth)
  {
    Column column;
    column.title = "Truth";
    column.figures = seconds_text(comparison.truth.seconds);
    column.picture = to_bitmap(truth, comparison.display_curve, comparison.exposure);
    column.note = "On the left, each picture's " +
      difference_label(DifferenceKind::Absolute, gain) +
      ": how far it is from this one. The truth's own remaining error is estimated at " +
      over_255(comparison.truth.remaining_mean) + " in the mean and " +
      over_255(comparison.truth.remaining_largest) + " at the largest.";
    columns.push_back(std::move(column));
  }
  for (const Column& column : columns)
  {
    if (column.picture.width != columns[0].picture.width ||
      column.picture.height != columns[0].picture.height)
    {
      throw std::invalid_argument(
        "panel: " + column.title + " differs in size from " + columns[0].title);
    }
  }
  return columns;
}

void draw_head(Canvas& canvas, const Layout& layout, const Comparison& comparison)
{
  const TextStyle title{ layout.size + layout.size / 2, true, palette::text };
  const TextStyle quiet{ layout.size, false, palette::quiet };
  const int width = layout.width() - 2 * layout.margin();
  const SceneDescription& scene = comparison.scene;
  int baseline = layout.margin() + layout.size;
  canvas.text(layout.margin(), baseline, fitted(scene.input, title, width), title);
  baseline += 2 * layout.size;
  const std::string step = step_text(scene.step, scene.step_voxels, scene.unit);
  const std::string line = join({ voxels_text(scene.dimensions.data(), scene.spacing.data(), scene.unit),
                                  scene.preset.empty() ? "" : "preset " + scene.preset,
                                  step.empty() ? "" : "step " + step },
    ",  ");
  canvas.text(layout.margin(), baseline, fitted(line, quiet, width), quiet);
}

void draw_column(Canvas& canvas, const Layout& layout, int index, const Column& column)
{
  const TextStyle title{ layout.size + layout.size / 5, true, palette::text };
  const TextStyle quiet{ layout.size, false, palette::quiet };
  const int x = layout.column(index);
  canvas.text(
    x, layout.head() + layout.size, fitted(column.title, title, layout.cell_width), title);
  canvas.text(x, layout.head() + layout.size * 5 / 2 + layout.size / 3,
    fitted(column.figures, quiet, layout.cell_width), quiet);
  const auto framed = [&](int y, const Bitmap& bitmap) {
    canvas.fill(x - 1, y - 1, layout.cell_width + 2, layout.cell_height + 2, palette::frame);
    canvas.draw(bitmap, x, y, layout.cell_width, layout.cell_height);
  };
  framed(layout.picture_top(), column.picture);
  if (column.difference)
  {
    framed(layout.difference_top(), column.difference->bitmap);
  }
  int baseline = layout.difference_top() + 2 * layout.size;
  for (const std::string& line :
    wrapped(column.note, quiet, layout.cell_width - layout.size, 6))
  {
    if (baseline < layout.foot_top())
    {
      canvas.text(x, baseline, line, quiet);
    }
    baseline += layout.size + layout.size / 2;
  }
}

std::vector<std::string> lines_of_the_foot(const Comparison& comparison, const TextStyle& style, int width)
{
  std::vector<std::string> lines;
  for (const ComparisonEntry& entry : comparison.entries)
  {
    const bool skipped = !entry.skipped.empty();
    if (skipped || !entry.left_out.empty())
    {
      for (const std::string& line :
        wrapped((skipped ? "Not drawn: " : "Drawn in part: ") +
            (entry.title.empty() ? entry.mapper : entry.title) + ": " +
            (skipped ? entry.skipped : left_out_words(entry)),
          style, width, 2))
      {
        lines.push_back(line);
      }
    }
  }
  return lines;
}

}

Bitmap panel(const Comparison& comparison)
{
  std::vector<ImageErrors> errors;
  for (const ComparisonEntry& entry : comparison.entries)
  {
    if (entry.skipped.empty())
    {
      errors.push_back(entry.against_truth);
    }
  }
  const double gain = shared_gain(errors);
  const std::vector<Column> columns = columns_of(comparison, gain);
  const Layout layout = layout_for(columns[0].picture, static_cast<int>(columns.size()),
    !comparison.truth.picture.rgb.empty());

  const TextStyle quiet{ layout.size, false, palette::quiet };
  const int line_height = layout.size + layout.size / 2;
  const std::vector<std::string> remarks =
    lines_of_the_foot(comparison, quiet, layout.width() - 2 * layout.margin());
  const LegendLayout legend{ std::min(layout.width() - 2 * layout.margin(), 48 * layout.size) +
      2 * layout.size, layout.size };
  const int foot = (layout.differences ? legend.height() : layout.size) +
    static_cast<int>(remarks.size()) * line_height + layout.size;

  Canvas canvas(layout.width(), layout.foot_top() + foot, palette::page);
  draw_head(canvas, layout, comparison);
  std::size_t non_finite = 0;
  for (std::size_t i = 0; i < columns.size(); ++i)
  {
    draw_column(canvas, layout, static_cast<int>(i), columns[i]);
    non_finite += columns[i].difference ? columns[i].difference->non_finite_pixels : 0;
  }
  int y = layout.foot_top();
  if (layout.differences)
  {
    draw_legend(canvas, layout.margin() - legend.margin(), y, legend, DifferenceKind::Absolute,
      gain, non_finite);
    y += legend.height();
  }
  for (const std::string& line : remarks)
  {
    y += line_height;
    canvas.text(layout.margin(), y - layout.size / 2, line, quiet);
  }
  return canvas.bitmap();
}

}
