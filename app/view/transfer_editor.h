// A transfer function that is edited over the histogram of the values.
#pragma once

#include "layout.h"
#include "presets.h"

#include <cstdint>
#include <optional>
#include <vector>

class vtkVolumeProperty;

namespace brume::app
{

/// Counts of values in equal bins from `lower` to `upper`.
struct Histogram
{
  double lower = 0.0;
  double upper = 1.0;
  std::vector<std::uint64_t> counts;
};

/// Points by rising values, those of the data.
struct TransferFunction
{
  std::vector<ColourPoint> colour;
  std::vector<OpacityPoint> opacity;
};

/// The function of a property's first component.
TransferFunction function_of(vtkVolumeProperty* property);

/// The colour at a value: linear between points, constant beyond.
ColourPoint colour_at(const TransferFunction& function, double value);

/// Where the opacity's points are in a field of pixels, x by the values of the histogram, y by the
/// opacity, whose square root is shown, as what matters is small.
struct CurveField
{
  Box box;
  double lower = 0.0;
  double upper = 1.0;

  int x_of(double value) const;
  int y_of(double opacity) const;
  double value_of(int x) const;
  double opacity_of(int y) const;
};

/// The point within `reach` pixels of a place; −1 for none.
int point_at(const TransferFunction& function, const CurveField& field, int x, int y, int reach);

/// A new point there, and its index.
int add_point(TransferFunction& function, double value, double opacity);

/// Moves a point, no further than between its neighbours.
void move_point(TransferFunction& function, int index, double value, double opacity);

/// Takes a point out, but never the last.
void remove_point(TransferFunction& function, int index);

}
