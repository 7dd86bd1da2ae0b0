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

/// A point of the function, of which kind.
struct FunctionPoint
{
  enum class Kind
  {
    None,
    Opacity,
    Colour,
  };
  Kind kind = Kind::None;
  int index = -1;

  bool is(Kind k, int i) const { return this->kind == k && this->index == i; }
  bool operator==(const FunctionPoint& other) const { return other.is(this->kind, this->index); }
};

/// The point of opacity within `reach` pixels of a place; −1 for none.
int point_at(const TransferFunction& function, const CurveField& field, int x, int y, int reach);

/// The point of colour within `reach` pixels of a column; −1 for none.
int colour_point_at(const TransferFunction& function, const CurveField& field, int x, int reach);

/// A new point there, and its index. Of colours one of the colour that is there.
///@{
int add_point(TransferFunction& function, double value, double opacity);
int add_colour_point(TransferFunction& function, double value);
///@}

/// Moves a point, no further than between its neighbours.
///@{
void move_point(TransferFunction& function, int index, double value, double opacity);
void move_colour_point(TransferFunction& function, int index, double value);
///@}

/// Takes a point out, but never the last.
///@{
void remove_point(TransferFunction& function, int index);
void remove_colour_point(TransferFunction& function, int index);
///@}

}
