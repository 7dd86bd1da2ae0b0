// What paths bring that find light, for the error of pixels whose paths found none. Internal to
// Transport.
#pragma once

#include "Transport/path_pixels.h"

#include <cstddef>
#include <vector>

namespace brume
{

/// Paths that are all black tell nothing of their variance: the next one may find light. Of n of
/// them one more than was found may have been due, and would have brought what others bring: the
/// standard error is taken to be at least that over n. What others bring is Σ x² / Σ x, the mean of
/// what is found weighted with itself, over the smallest square of pixels around, of 2, 4, 8… a
/// side, in which any light was found.
class FoundLight
{
public:
  /// Paths of width · height pixels.
  FoundLight(const PathSums& paths, int width, int height);

  /// Per path that finds light, around a pixel; 0 where nothing was found in all of the picture.
  double brought(int x, int y, int channel) const;

private:
  struct Level
  {
    int width;
    int height;
    std::vector<double> sums; ///< Σ x and Σ x² of R, G, B, a square
  };
  std::vector<Level> Levels;
};

}
