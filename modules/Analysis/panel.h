// The side-by-side picture of a comparison: what each mapper drew, and below it how far it is from
// the truth.
#pragma once

#include "comparison.h"
#include "picture.h"

namespace brume
{

/// The panel of a comparison, ready for encode_png().
///
/// The head names the input, its voxels and the step. Each mapper that was drawn has a column: its
/// title, a line of figures (median seconds; mean and largest error in 1/255 of white), its picture
/// through the comparison's display curve, and its absolute difference from the truth. All
/// differences share one gain (shared_gain()), which the legend at the foot states, so they can be
/// compared by eye. The last column is the truth, if its picture is there, and states the truth's
/// own remaining error. The foot names mappers that were skipped and what others leave out.
///
/// A picture narrower than 320 pixels is enlarged by a whole factor (each pixel stays a square), one
/// wider than 640 is reduced to that, so 1 to 5 mappers give a panel of 400 to 4000 pixels' width.
/// Titles that do not fit are cut with an ellipsis. Text needs neither display nor GL.
///
/// Throws std::invalid_argument when nothing was drawn, or when pictures differ in size.
VTKBRUMEANALYSIS_EXPORT Bitmap panel(const Comparison& comparison);

}
