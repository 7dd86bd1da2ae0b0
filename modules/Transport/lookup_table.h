// Transfer functions as the kernels read them: tables of colour and extinction, and their
// integrals.
#pragma once

#include "Transport/scene.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace brume
{

/// Which values can be seen, answered for whole ranges in constant time.
class VisibleValues
{
public:
  VisibleValues() = default;
  /// `visible[i]` tells of the i-th of at least two nodes at even distances over [lower, upper];
  /// between two nodes a value can be seen when it can at either. Values outside are as the ends.
  VisibleValues(double lower, double upper, const std::vector<bool>& visible);

  /// Whether any value in [lowest, highest] can be seen.
  bool any(double lowest, double highest) const;

private:
  double Lower = 0.0;
  double Scale = 1.0;
  std::vector<int> Before; ///< how many of the nodes before each can be seen
};

/// A node: source colour, and extinction per unit of the data's length.
struct LookupNode
{
  float red;
  float green;
  float blue;
  float extinction;
};

/// The classification sampled at even distances. Between nodes the kernels interpolate.
struct LookupTable
{
  /// Intervals between the nodes, a power of two. The table is one node longer, so that the last
  /// interval has two ends like any other. The fewest that are within a hundredth of the opacity and
  /// the colours at every node of the classification, so that no peak falls between the nodes.
  static constexpr int least_intervals = 4096;
  static constexpr int most_intervals = 65536;
  int intervals = least_intervals;

  /// The nodes of Volume::classification, then those of each of label_classifications.
  std::vector<LookupNode> nodes;
  /// Position in the table = (value − lower) * scale, clamped to [0, intervals].
  float lower = 0.0f;
  float scale = 1.0f;
  /// The largest colour component; a bound of the radiance that matter of any kind here can send.
  float brightest = 0.0f;
  /// The value that stands for empty in place of a non-finite voxel: one of no optical depth where
  /// there is one.
  float empty_value = 0.0f;

  /// Factor on the optical depth by gradient magnitude, same form: gradient_intervals + 1 nodes of
  /// each classification; empty where none has one.
  static constexpr int gradient_intervals = 4096;
  std::vector<float> gradient_factor;
  float gradient_table_scale = 1.0f;

  /// Whether any value in [lowest, highest] has an optical depth.
  bool can_show(float lowest, float highest) const { return this->visible.any(lowest, highest); }
  VisibleValues visible;

  /// For values that run evenly from a to b along a step: the first classification's extinction,
  /// and extinction · colour, summed over the table from its lower end to each node, in intervals.
  /// Their differences divided by b − a are the means over the step (Engel, Kraus, Ertl,
  /// High-quality pre-integrated volume rendering, 2001).
  std::vector<LookupNode> integrals;
  /// The number of the stretch that each interval belongs to, within which extinction and
  /// extinction · colour are as good as linear: between two values of one stretch, the table's
  /// entry half-way is the mean, and no integral is needed.
  std::vector<std::int32_t> stretch;

  /// Classification::value_gradient in single precision: R, G, B and opacity, `rows` rows of
  /// `columns` nodes. `position` in a row as above with `columns` − 1 intervals; the row is
  /// gradient · gradient_table_scale. Empty: none.
  std::vector<float> value_gradient;
  float unit_distance = 1.0f; ///< the length that its opacities speak of
  int columns = 0;
  int rows = 0;
};

/// Builds the table. `labels` are further classifications over the same range of values. Throws
/// std::invalid_argument for tables of fewer than 2 nodes, lower ≥ upper, a unit distance that is
/// not positive, or labels of another range.
LookupTable make_lookup_table(const Classification& classification,
  const std::vector<Classification>& labels = {});

/// Puts the opacities, which are of no length, into a table in place of the extinctions: what all
/// modes but Composite draw. The arguments are those that the table was made of.
void hold_opacities(LookupTable& table,
  const Classification& classification,
  const std::vector<Classification>& labels);

/// Position of `value` among `count` nodes over [lower, upper]: the interval and the fraction in it.
struct TablePosition
{
  std::size_t index;
  double fraction;
};
TablePosition table_position(double value, double lower, double upper, std::size_t count);

/// The piecewise linear function through `count` nodes, `stride` apart, at a position.
inline double interpolate(const double* nodes, TablePosition at, std::size_t stride = 1)
{
  const double a = nodes[at.index * stride];
  const double b = nodes[(at.index + 1) * stride];
  return a + at.fraction * (b - a);
}

}
