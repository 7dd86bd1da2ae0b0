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

/// Pixels of lettering below which a caption is rather cut.
constexpr int smallest_caption = 10;

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

Bitmap page_of(const std::vector<std::string>& paragraphs,
  int width,
  int height,
  const Metrics& metrics)
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

namespace
{

using Rows = std::vector<std::pair<std::string, std::string>>;

/// Lettering and columns of a table.
struct TableShape
{
  Metrics metrics;
  int columns = 1;
  int each = 1;  ///< rows of a column
  int first = 0; ///< width of the left part
  int width = 0; ///< that a column takes where nothing is cut
};

/// As many columns as the height takes with this lettering.
TableShape shape_of(const Rows& rows, int height, const Metrics& metrics)
{
  TableShape shape{ metrics };
  int second = 0;
  for (const auto& [name, meaning] : rows)
  {
    shape.first =
      std::max(shape.first, text_width(name, text_style(metrics, palette::accent, true)));
    second = std::max(second, text_width(meaning, text_style(metrics)));
  }
  shape.first += 2 * metrics.margin;
  shape.width = shape.first + second + 3 * metrics.margin;
  const int count = std::max(static_cast<int>(rows.size()), 1);
  const int room = std::max((height - 2 * metrics.margin) / metrics.line, 1);
  shape.columns = (count + room - 1) / room;
  shape.each = (count + shape.columns - 1) / shape.columns;
  return shape;
}

/// The largest lettering up to `metrics` with which nothing is cut, or else the smallest.
TableShape fitting_shape(const Rows& rows, int width, int height, const Metrics& metrics)
{
  TableShape shape = shape_of(rows, height, metrics);
  for (double scale = metrics.text / 13.0;
       shape.columns * shape.width > width && shape.metrics.text > 8;)
  {
    scale = std::max(scale - 1.0 / 13.0, 0.5);
    shape = shape_of(rows, height, Metrics(scale));
  }
  return shape;
}

}

Bitmap table_of(const Rows& rows, int width, int height, const Metrics& metrics)
{
  Canvas canvas(width, height, palette::page);
  const TableShape shape = fitting_shape(rows, width, height, metrics);
  const Metrics& m = shape.metrics;
  const int wide = width / shape.columns;
  const int room = std::max(wide - shape.first - 2 * m.margin, 0);
  for (int i = 0; i < static_cast<int>(rows.size()); ++i)
  {
    const auto& [name, meaning] = rows[static_cast<std::size_t>(i)];
    const int x = i / shape.each * wide + m.margin;
    const int y = m.margin + m.text + i % shape.each * m.line;
    canvas.text(x, y, name, text_style(m, palette::accent, true));
    canvas.text(x + shape.first, y, fitted(meaning, text_style(m), room), text_style(m));
  }
  return canvas.bitmap();
}

namespace
{

struct CaptionStyles
{
  TextStyle left;
  TextStyle right;
  CaptionStyles(const Metrics& metrics, int size)
    : left(text_style(metrics, palette::text, true))
    , right(text_style(metrics, palette::quiet))
  {
    this->left.size = this->right.size = size;
  }
};

}

int caption_size(const Caption& caption, int width, const Metrics& metrics)
{
  const int inner = width - 2 * metrics.margin;
  for (int size = metrics.text; size >= std::max(smallest_caption, metrics.text / 2); --size)
  {
    const CaptionStyles styles(metrics, size);
    if (text_width(caption.left, styles.left) + 2 * metrics.margin +
          text_width(caption.right, styles.right) <=
        inner)
    {
      return size;
    }
  }
  return 0;
}

Bitmap caption_of(const Caption& caption, int size, int width, int height, const Metrics& metrics)
{
  Canvas canvas(width, height, palette::page);
  const int inner = std::max(width - 2 * metrics.margin, 0);
  const CaptionStyles styles(metrics, size);
  const int baseline = (height + size) / 2 - size / 8;
  const std::string title = fitted(caption.left, styles.left, inner);
  canvas.text(metrics.margin, baseline, title, styles.left);
  const int room = inner - text_width(title, styles.left) - 2 * metrics.margin;
  if (room > 4 * metrics.text || text_width(caption.right, styles.right) <= room)
  {
    canvas.text(width - metrics.margin,
      baseline,
      fitted(caption.right, styles.right, room),
      styles.right,
      Align::Right);
  }
  return canvas.bitmap();
}

}
