#include "compose.h"

#include "Analysis/canvas.h"

#include <algorithm>
#include <cmath>

namespace brume::app
{

namespace
{

/// The two pixels around a place along an edge, and how far it is from the first to the second.
struct Between
{
  int first;
  int second;
  float part;
};
std::vector<Between> places(int from, int to)
{
  std::vector<Between> all;
  for (int i = 0; i < to; ++i)
  {
    const double at = std::clamp((i + 0.5) * from / to - 0.5, 0.0, double(from - 1));
    const int first = static_cast<int>(at);
    all.push_back({ first, std::min(first + 1, from - 1), static_cast<float>(at - first) });
  }
  return all;
}

TextStyle text_style(const Metrics& metrics, Colour colour = palette::text, bool bold = false)
{
  return { metrics.text, bold, colour };
}

}

Picture resized(const Picture& picture, int width, int height)
{
  if (picture.width == width && picture.height == height)
  {
    return picture;
  }
  check_shape(picture, "picture to resize");
  Picture result{ width, height, {} };
  result.rgb.reserve(std::size_t{ 3 } * width * height);
  const std::vector<Between> columns = places(picture.width, width);
  for (const Between& row : places(picture.height, height))
  {
    const float* low = &picture.rgb[std::size_t{ 3 } * row.first * picture.width];
    const float* high = &picture.rgb[std::size_t{ 3 } * row.second * picture.width];
    for (const Between& column : columns)
    {
      for (int c = 0; c < 3; ++c)
      {
        const int a = 3 * column.first + c;
        const int b = 3 * column.second + c;
        const float below = low[a] + column.part * (low[b] - low[a]);
        const float above = high[a] + column.part * (high[b] - high[a]);
        result.rgb.push_back(below + row.part * (above - below));
      }
    }
  }
  return result;
}

Bitmap wiped(const Bitmap& left, const Bitmap& right, int divider)
{
  Bitmap both = left;
  const int width = left.width;
  divider = std::clamp(divider, 0, width - 1);
  for (int y = 0; y < left.height; ++y)
  {
    const std::size_t row = std::size_t{ 3 } * y * width;
    std::copy(right.rgb.begin() + static_cast<std::ptrdiff_t>(row + 3 * divider),
      right.rgb.begin() + static_cast<std::ptrdiff_t>(row + 3 * width),
      both.rgb.begin() + static_cast<std::ptrdiff_t>(row + 3 * divider));
    // A light line with dark neighbours stands out on any picture.
    for (int x = std::max(divider - 1, 0); x <= std::min(divider + 1, width - 1); ++x)
    {
      const Colour& colour = x == divider ? palette::text : palette::page;
      std::copy(colour.begin(), colour.end(), &both.rgb[row + 3 * x]);
    }
  }
  return both;
}

Bitmap page_of(
  const std::vector<std::string>& paragraphs, int width, int height, const Metrics& metrics)
{
  Canvas canvas(width, height, palette::page);
  const int inner = std::max(width - 4 * metrics.margin, 1);
  int y = 2 * metrics.margin + metrics.text;
  for (const std::string& paragraph : paragraphs)
  {
    const int lines = std::max((height - y) / metrics.line, 1);
    for (const std::string& line : wrapped(paragraph, text_style(metrics), inner, lines))
    {
      if (y < height)
      {
        canvas.text(2 * metrics.margin, y, line, text_style(metrics));
      }
      y += metrics.line;
    }
    y += metrics.margin;
  }
  return canvas.bitmap();
}

Bitmap table_of(const std::vector<std::pair<std::string, std::string>>& rows, int width, int height,
  const Metrics& metrics)
{
  Canvas canvas(width, height, palette::page);
  int first = 0;
  int second = 0;
  for (const auto& [name, meaning] : rows)
  {
    first = std::max(first, text_width(name, text_style(metrics)));
    second = std::max(second, text_width(meaning, text_style(metrics)));
  }
  first += 2 * metrics.margin;
  // As many columns as it takes, if there is room for them.
  const int least = first + std::min(second, 13 * metrics.text) + 2 * metrics.margin;
  const int per_column = std::max((height - 2 * metrics.margin) / metrics.line, 1);
  const int needed = (static_cast<int>(rows.size()) + per_column - 1) / per_column;
  const int columns = std::clamp(needed, 1, std::max(width / std::max(least, 1), 1));
  const int wide = width / columns;
  const int each = (static_cast<int>(rows.size()) + columns - 1) / columns;
  for (std::size_t i = 0; i < rows.size(); ++i)
  {
    const int x = static_cast<int>(i) / each * wide + metrics.margin;
    const int y = metrics.margin + metrics.text + static_cast<int>(i) % each * metrics.line;
    if (y > height)
    {
      continue;
    }
    canvas.text(x, y, rows[i].first, text_style(metrics, palette::accent, true));
    const int room = wide - first - 2 * metrics.margin;
    canvas.text(x + first, y, fitted(rows[i].second, text_style(metrics), std::max(room, 0)),
      text_style(metrics));
  }
  return canvas.bitmap();
}

Bitmap caption_of(
  const std::string& left, const std::string& right, int width, int height, const Metrics& metrics)
{
  Canvas canvas(width, height, palette::page);
  const int baseline = (height + metrics.text) / 2 - metrics.text / 8;
  const int inner = std::max(width - 2 * metrics.margin, 0);
  const TextStyle name = text_style(metrics, palette::text, true);
  const TextStyle rest = text_style(metrics, palette::quiet);
  const std::string title = fitted(left, name, inner);
  canvas.text(metrics.margin, baseline, title, name);
  const int room = inner - text_width(title, name) - 2 * metrics.margin;
  if (room > 4 * metrics.text)
  {
    canvas.text(width - metrics.margin, baseline, fitted(right, rest, room), rest, Align::Right);
  }
  return canvas.bitmap();
}

}
