// Where two pictures differ, amplified until it can be seen, with the gain stated.
#pragma once

#include "image_errors.h"
#include "picture.h"

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace brume
{

/// What a pixel of a difference picture shows: one number, e = test - truth of the channel whose
/// |e| is the largest of the three.
enum class DifferenceKind
{
  Absolute, ///< |e|, from black (none) to pale yellow (1 / gain and more)
  Signed,   ///< e, from blue (too dark) over pale grey (none) to red (too bright)
};

/// A difference made visible. The end of the colour scale is an error of 1 / gain (of white).
struct DifferencePicture
{
  Bitmap bitmap;
  DifferenceKind kind = DifferenceKind::Absolute;
  double gain = 1.0;
  std::size_t pixels_beyond_scale = 0; ///< finite pixels that the end of the scale cuts off
  std::size_t non_finite_pixels = 0;   ///< drawn in bright green, a colour of neither scale
};

/// The largest power of two, from 1 to 2^30, that keeps the 99.9th percentile of the errors on the
/// colour scale, which then lies in its upper half. Where that percentile is 0 the largest error
/// takes its place. 1 where there is no error at all, or none that is finite.
VTKBRUMEANALYSIS_EXPORT double automatic_gain(const ImageErrors& errors);

/// One gain for pictures that stand side by side: the smallest automatic gain among those with an
/// error that is finite and not 0; 1 if there is none. Pictures at one gain can be compared by eye.
VTKBRUMEANALYSIS_EXPORT double shared_gain(const std::vector<ImageErrors>& errors);

/// The difference of two pictures of one size. gain > 0 is used as given; 0 asks for
/// automatic_gain(). Throws std::invalid_argument as measure() does, and for a negative or
/// non-finite gain.
VTKBRUMEANALYSIS_EXPORT DifferencePicture difference_picture(const Picture& test,
  const Picture& truth, DifferenceKind kind = DifferenceKind::Absolute, double gain = 0.0);

/// The scale in words, e.g. "absolute difference × 64".
VTKBRUMEANALYSIS_EXPORT std::string difference_label(DifferenceKind kind, double gain);

/// A mark on the legend's bar.
struct LegendTick
{
  double position = 0.0; ///< along the bar, in [0, 1]
  std::string text;      ///< the error there, in units of 1/255
};

/// Three to five marks at round errors (1, 2 or 5 times a power of ten).
VTKBRUMEANALYSIS_EXPORT std::vector<LegendTick> legend_ticks(DifferenceKind kind, double gain);

/// The displayed colour at a place along the legend's bar, in [0, 1]: R, G, B bytes.
VTKBRUMEANALYSIS_EXPORT std::array<unsigned char, 3> legend_colour(
  DifferenceKind kind, double position);

/// The picture over a strip with its label, its colour bar and, where it has any, its non-finite
/// pixels: what difference-<mapper>.png holds. A picture narrower than 320 pixels is centred over
/// a strip of that width. Text is drawn without display or GL.
VTKBRUMEANALYSIS_EXPORT Bitmap with_legend(const DifferencePicture& difference);

}
