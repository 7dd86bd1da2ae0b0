// A sheet of pixels to lay out pictures and lettering on, without display or GL.
#pragma once

#include "colour_map.h"
#include "picture.h"

#include <string>
#include <vector>

namespace brume
{

/// The colours of panels and strips: light lettering on a dark page, which leaves the eye to the
/// pictures. Contrast to the page: text 14:1, quiet 7:1.
namespace palette
{
constexpr Colour page{ 22, 24, 29 };
constexpr Colour text{ 235, 237, 240 };
constexpr Colour quiet{ 165, 172, 182 };
constexpr Colour accent{ 118, 190, 255 };
constexpr Colour frame{ 58, 63, 72 };
}

enum class Align
{
  Left,
  Centre,
  Right,
};

struct TextStyle
{
  int size = 14; ///< pixels, of the em square
  bool bold = false;
  Colour colour = palette::text;
};

/// Places are in pixels from the upper left corner, y downward; what falls outside is cut off.
class VTKBRUMEANALYSIS_EXPORT Canvas
{
public:
  /// Throws std::invalid_argument for a width or height that is not positive.
  Canvas(int width, int height, Colour page);

  void fill(int x, int y, int width, int height, Colour colour);

  /// The bitmap scaled to width x height: the nearest pixel where it grows, the mean of those
  /// covered where it shrinks.
  void draw(const Bitmap& bitmap, int x, int y, int width, int height);

  /// One line, anti-aliased, in the sans-serif font that is compiled into VTK; `baseline` is where
  /// the letters stand. That font holds ASCII alone: "×" becomes "x", "…" three points and so on,
  /// and a sign without such a form a question mark.
  void text(int x, int baseline, const std::string& line, const TextStyle& style,
    Align align = Align::Left);

  /// The finished sheet, rows from the bottom up.
  Bitmap bitmap() const;

private:
  unsigned char* at(int x, int y);

  Bitmap Sheet;
};

/// Width in pixels that Canvas::text takes.
VTKBRUMEANALYSIS_EXPORT int text_width(const std::string& line, const TextStyle& style);

/// The line, or as much of its beginning as fits with an ellipsis behind it.
VTKBRUMEANALYSIS_EXPORT std::string fitted(const std::string& line, const TextStyle& style, int width);

/// The text broken between words into at most `lines` lines of that width, the last one fitted.
VTKBRUMEANALYSIS_EXPORT std::vector<std::string> wrapped(
  const std::string& text, const TextStyle& style, int width, int lines);

}
