// How far a picture of paths may still be from the truth, pixel by pixel. Internal to Transport.
#pragma once

#include "Transport/film.h"
#include "Transport/path_error.h"
#include "Transport/path_found.h"
#include "Transport/path_pixels.h"

#include <functional>
#include <vector>

namespace brume
{

class PathNoise
{
public:
  /// Of the paths there are; `behind` has the transmittance of each pixel. `go`, if there is one,
  /// is asked now and then from the calling thread; where it says false, or said so before, ended()
  /// is true and the figures mean nothing. What is given must stay.
  PathNoise(const PathSums& paths, const Film& behind, int threads, std::function<bool()> go);

  bool ended() const { return this->Ended; }

  /// Of all pixels; for the same paths the same, bit for bit, whatever the number of threads.
  PathError error() const;

  /// Paths that bring each pixel's standard error down to `cap`, from one pass to the next; at the
  /// least or about.
  void find_targets(double cap, int most, bool at_least, std::vector<int>& targets) const;

  /// The means of the paths, and three standard errors of each.
  void show(Film& film) const;

private:
  /// Of pixels' paths, channel by channel; no less than the mean of the pixels around them, as
  /// samples that are all alike tell little.
  const std::vector<double>& variances() const;
  double unfound_variance(int x, int y, int channel) const;
  /// Calls work(first row, last row) for bands of the picture, on all threads.
  void in_bands(const std::function<void(int, int)>& work) const;

  const PathSums& Paths;
  const Film& Behind;
  int Threads;
  std::function<bool()> Go;
  mutable bool Ended = false;
  FoundLight Found;
  mutable std::vector<double> Variances; ///< of variances(), once they were asked for
};

}
