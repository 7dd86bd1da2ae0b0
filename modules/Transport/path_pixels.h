// Paths of many pixels, added up. Internal to Transport.
#pragma once

#include "Transport/path_scene.h"
#include "Transport/path_sights.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace brume
{

/// What the paths of each pixel have brought.
struct PathSums
{
  std::vector<double> sums;    ///< R, G, B a pixel, over its paths
  std::vector<double> squares; ///< the same of squares
  /// The same of the squared sums of each RandomStream::strata paths, over their number: these are
  /// independent, and paths among them are not.
  std::vector<double> groups;
  std::vector<double> open; ///< sums over the last paths, which are no whole group yet
  std::vector<int> samples; ///< paths of each pixel

  explicit PathSums(std::size_t pixels = 0)
    : sums(3 * pixels, 0.0)
    , squares(3 * pixels, 0.0)
    , groups(3 * pixels, 0.0)
    , open(3 * pixels, 0.0)
    , samples(pixels, 0)
  {
  }

  /// So many pixels without paths, in the memory that there is. `go` is asked between its parts, as large
  /// films take tens of milliseconds; false where it ended that.
  bool clear(std::size_t pixels, const std::function<bool()>& go);
  /// The next path of a pixel.
  void add(std::size_t pixel, const glm::dvec3& radiance);
  /// The variance of its paths, as that of their mean times their number is: by groups when there
  /// are enough, else by single paths, whose variance is no less.
  double variance(std::size_t pixel, int channel) const;
};

/// How many paths pixels are to have.
struct PathTargets
{
  int all = 0;               ///< the most
  const int* each = nullptr; ///< of each pixel of the picture; null: `all`
  int of(std::size_t pixel) const
  {
    return this->each && this->each[pixel] < this->all ? this->each[pixel] : this->all;
  }
};

/// Brings the pixels [from, to) of the row y to their targets: in packets where the scene
/// allows it, else one by one. The sums do not depend on how pixels and paths are cut into calls.
/// Returns the number of paths traced.
std::uint64_t trace_pixels(const PathScene& scene,
  const PathSights& sights,
  int width,
  int y,
  int from,
  int to,
  const PathTargets& targets,
  std::uint32_t seed,
  PathSums& result,
  PathCounts& counts);

}
