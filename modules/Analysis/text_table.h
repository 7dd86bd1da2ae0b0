// The table that `brume compare` prints.
#pragma once

#include "comparison.h"

#include <string>
#include <vector>

namespace brume
{

/// One line a mapper, in aligned columns, for a terminal (UTF-8; plain text, no colour):
///
///     input           mapper           seconds (min–max)      speed  mean  rms  p99.9  max
///
/// `speed` is the reference mapper's median divided by this one's ("1.9×", above 1 is faster; "-"
/// without a reference). The errors are against the truth, in 1/255 of white, linear RGB; "inf"
/// where a picture holds non-finite values. A skipped mapper's line holds the reason instead.
/// Below the table a line for each mapper that draws the scene in part tells what it leaves out.
/// The comparisons' lines follow one another under one head. Empty for no comparison.
VTKBRUMEANALYSIS_EXPORT std::string to_text_table(const std::vector<Comparison>& comparisons);

}
