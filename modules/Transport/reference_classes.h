// A classification in double precision. Internal to Transport.
#pragma once

#include "Transport/scene.h"

#include <glm/vec3.hpp>

#include <vector>

namespace brume
{

/// What the transfer functions make of a value and the magnitude of its gradient.
class ReferenceClasses
{
public:
  /// `classification` is kept by reference.
  explicit ReferenceClasses(const Classification& classification);

  /// Whether colour and opacity depend on the gradient, not only a factor on the extinction.
  bool two_dimensional() const { return !this->TheFunctions.value_gradient.empty(); }
  bool needs_gradient() const
  {
    return this->two_dimensional() || !this->TheFunctions.gradient_opacity.empty();
  }

  /// The length of a gradient in index space, as the functions take it.
  double magnitude(const glm::dvec3& gradient) const;

  /// Per unit of the data's length, without the gradient's factor.
  double extinction(double value, double magnitude) const;
  /// Opacity in [0, 1] as the function has it, of no length, without the gradient's factor.
  double opacity(double value, double magnitude) const;
  glm::dvec3 colour(double value, double magnitude) const;
  /// The gradient opacity, in [0, 1]; 1 where there is none.
  double gradient_factor(double magnitude) const;

  /// An upper bound of extinction() over all values of a range and all magnitudes.
  double largest_extinction(double lower, double upper) const;

  /// Whether any value of the range has an opacity.
  bool can_show(float lower, float upper) const;
  /// A value of no opacity, where there is one.
  double empty_value() const { return this->Empty; }

  /// How much the transfer functions go up and down between two values: 1 for a way from nothing to
  /// their largest extinction, or from black to white.
  double variation(double from, double to) const;

private:
  /// Four channels, bilinear.
  double node(double value, double magnitude, int channel) const;
  void add_up_variation();
  void find_largest();

  const Classification& TheFunctions;
  int Columns; ///< nodes along the values
  int Rows;    ///< nodes along the gradient; 1 for functions of the value alone
  double Empty = 0.0;
  std::vector<double> Extinction; ///< at the nodes of the opacity; none for two dimensions
  std::vector<double> Columnwise; ///< the largest extinction of each column
  std::vector<double> Runs;       ///< of each run_length columns the largest
  std::vector<double> Variation;  ///< summed from the first node on
  std::vector<int> Before;        ///< how many of the nodes before each can be seen
};

}
