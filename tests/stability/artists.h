// Everything that draws, each with a scene of its own: what tests of machines run alike for all.
#pragma once

#include "ray_truth.h"

#include <functional>
#include <string>
#include <vector>

namespace stability
{

/// One integrator with a scene. Keeps what the integrator keeps between pictures.
struct Artist
{
  std::string name;
  /// Fills the film with a picture that is the same each time. Returns whether it was completed.
  std::function<bool(Film& film, int threads, const Progress& progress)> draw;
  /// Largest difference between SIMD targets, of white; below 0 where there are none, and 0 for
  /// paths, which differ by their noise.
  double apart = 1e-5;
  /// Draws the same scene in double precision, for the error of `draw`, of white; null: none.
  std::function<void(Film& film)> truth;
  double error = 0.0;
};

/// The marcher's kernels, paths in packets and one by one, and the reference, all as new.
std::vector<Artist> artists();

}
