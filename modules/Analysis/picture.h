// The two kinds of picture that an analysis handles: linear light, which is measured, and bytes,
// which are looked at.
#pragma once

#include "vtkBrumeAnalysisModule.h"

#include <vector>

namespace brume
{

/// A finished picture as numbers: linear RGB, where 1 is white.
///
/// `rgb` is interleaved R, G, B, 3 * width * height floats, rows from the bottom of the picture to
/// its top as in VTK; values are not clamped and may be non-finite (measure() counts those).
/// A Film becomes one by Picture{ film.width, film.height, over_background(film, background) }.
struct Picture
{
  int width = 0;  ///< pixels
  int height = 0; ///< pixels
  std::vector<float> rgb;
};

/// A picture as a display takes it: interleaved R, G, B bytes, 3 * width * height, rows from the
/// bottom up.
struct Bitmap
{
  int width = 0;  ///< pixels
  int height = 0; ///< pixels
  std::vector<unsigned char> rgb;
};

/// How linear values become bytes.
enum class DisplayCurve
{
  Identity, ///< byte = round(255 v): what a VTK render window shows for the same numbers
  Srgb,     ///< the curve of IEC 61966-2-1, for light that is radiometric
};

/// The picture as bytes: each value is multiplied by 2^exposure (stops), clamped to [0, 1], passed
/// through the curve and rounded.
/// A pixel with a non-finite channel becomes magenta (255, 0, 255), so that nobody overlooks it.
/// Throws std::invalid_argument where check_shape() does.
VTKBRUMEANALYSIS_EXPORT Bitmap to_bitmap(
  const Picture& picture, DisplayCurve curve = DisplayCurve::Identity, double exposure = 0.0);

/// The bytes of a PNG file (8 bits a channel, no alpha) that holds the bitmap.
/// Throws std::invalid_argument for an empty or wrongly sized bitmap and std::runtime_error when
/// the encoder fails.
VTKBRUMEANALYSIS_EXPORT std::vector<unsigned char> encode_png(const Bitmap& bitmap);

/// Throws std::invalid_argument unless width and height are positive and rgb holds 3 values a
/// pixel. `what` names the picture in the message.
VTKBRUMEANALYSIS_EXPORT void check_shape(const Picture& picture, const char* what);
VTKBRUMEANALYSIS_EXPORT void check_shape(const Bitmap& bitmap, const char* what);

}
