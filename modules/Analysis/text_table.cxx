#include "text_table.h"

#include "figures.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace brume
{

namespace
{

constexpr std::size_t columns = 8;

struct Line
{
  std::array<std::string, columns> cells;
  std::string remark; ///< takes the place of all cells from the third on
};

const Line head{ { "input", "mapper", "seconds (min–max)", "speed", "mean", "rms", "p99.9", "max" },
  {} };

std::string error_cell(const ImageErrors& errors, double value)
{
  return errors.values == 0 ? "-" : std::isfinite(value) ? in_255ths(value) : "inf";
}

Line line_of(const Comparison& comparison, const ComparisonEntry& entry)
{
  Line line;
  line.cells[0] = valid_utf8(comparison.scene.input);
  line.cells[1] = valid_utf8(entry.mapper);
  std::replace(line.cells[0].begin(), line.cells[0].end(), '\n', ' ');
  if (!entry.skipped.empty())
  {
    line.remark = "skipped: " + valid_utf8(entry.skipped);
    std::replace(line.remark.begin(), line.remark.end(), '\n', ' ');
    return line;
  }
  const Timing& timing = entry.timing;
  line.cells[2] =
    figure(timing.median) + " (" + figure(timing.min) + "–" + figure(timing.max) + ")";
  const ComparisonEntry* reference = find_drawn(comparison, comparison.reference_mapper);
  line.cells[3] = reference && timing.median > 0
    ? figure(reference->timing.median / timing.median) + "×"
    : "-";
  const ImageErrors& errors = entry.against_truth;
  const double values[] = { errors.mean_absolute, errors.rms, errors.percentile_999,
    errors.largest };
  for (std::size_t i = 0; i < 4; ++i)
  {
    line.cells[4 + i] = error_cell(errors, values[i]);
  }
  return line;
}

std::string padding(const std::string& cell, std::size_t width)
{
  return std::string(width - std::min(width, code_points(cell)), ' ');
}

}

std::string to_text_table(const std::vector<Comparison>& comparisons)
{
  if (comparisons.empty())
  {
    return {};
  }
  std::vector<Line> lines{ head };
  for (const Comparison& comparison : comparisons)
  {
    for (const ComparisonEntry& entry : comparison.entries)
    {
      lines.push_back(line_of(comparison, entry));
    }
  }
  std::array<std::size_t, columns> widths{};
  for (const Line& line : lines)
  {
    for (std::size_t i = 0; i < columns; ++i)
    {
      widths[i] = std::max(widths[i], code_points(line.cells[i]));
    }
  }
  std::string text;
  for (const Line& line : lines)
  {
    const std::size_t count = line.remark.empty() ? columns : 2;
    std::string row;
    for (std::size_t i = 0; i < count; ++i)
    {
      const std::string& cell = line.cells[i];
      row += i < 3 ? cell + padding(cell, widths[i]) : padding(cell, widths[i]) + cell;
      row += "  ";
    }
    row += line.remark;
    row.erase(row.find_last_not_of(' ') + 1);
    text += row + "\n";
  }
  text += "errors against the truth, in 1/255 of white, linear RGB\n";
  for (const Comparison& comparison : comparisons)
  {
    for (const ComparisonEntry& entry : comparison.entries)
    {
      if (entry.skipped.empty() && !entry.left_out.empty())
      {
        std::string words =
          valid_utf8(entry.mapper) + " draws it in part: " + valid_utf8(left_out_words(entry));
        std::replace(words.begin(), words.end(), '\n', ' ');
        text += words + "\n";
      }
    }
  }
  return text;
}

}
