// What the values of a volume are like, in figures.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

class vtkBrumeSparseVolume;
class vtkImageData;

namespace brume::app
{

/// Figures of one component of an image's point scalars. Non-finite values are counted and left out
/// of all the others; where no value is finite, these are 0 and the lists are empty.
struct VolumeSummary
{
  double minimum = 0;
  double maximum = 0;
  double mean = 0;
  double standard_deviation = 0; ///< of all values (divided by their count)
  std::uint64_t finite = 0;
  std::uint64_t non_finite = 0;
  /// Counts in equal bins, the first from `minimum` on; the last includes `maximum`.
  std::vector<std::uint64_t> histogram;
  double bin_width = 0; ///< whole for integers that span less than 65536
  /// The value below which so many percent of the values lie, for percents(). Exact for integers
  /// that span less than 65536; otherwise right to 1/65536 of the range.
  std::vector<double> percentiles;
};
/// 1, 5, 25, 50, 75, 95, 99.
const std::vector<int>& percents();

/// `bins` is the most the histogram may have.
VolumeSummary summarize(vtkImageData* image, int component = 0, int bins = 24);
/// Of all voxels in bricks; each distinct value of a tile counts as one brick.
VolumeSummary summarize(vtkBrumeSparseVolume* volume, int bins = 24);

/// The histogram as lines of text, at most `width` columns wide, longest bar the fullest bin; bars
/// are as long as the logarithm of 1 + the count. `blocks`: bars of UTF-8's blocks, to an eighth of a
/// column, else of "#".
std::string draw_histogram(const VolumeSummary& summary, int width = 72, bool blocks = false);

/// Whether the terminal's language (LC_ALL, LC_CTYPE or LANG, the first that is set) is in UTF-8.
bool terminal_takes_utf8();

}
