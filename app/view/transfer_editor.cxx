#include "transfer_editor.h"

#include "vtkColorTransferFunction.h"
#include "vtkPiecewiseFunction.h"
#include "vtkVolumeProperty.h"

#include <algorithm>
#include <cmath>

namespace brume::app
{

TransferFunction function_of(vtkVolumeProperty* property)
{
  TransferFunction function;
  vtkPiecewiseFunction* opacity = property->GetScalarOpacity();
  for (int i = 0; i < opacity->GetSize(); ++i)
  {
    double node[4];
    opacity->GetNodeValue(i, node);
    function.opacity.push_back({ node[0], node[1] });
  }
  vtkColorTransferFunction* colour = property->GetRGBTransferFunction();
  for (int i = 0; i < colour->GetSize(); ++i)
  {
    double node[6];
    colour->GetNodeValue(i, node);
    function.colour.push_back({ node[0], node[1], node[2], node[3] });
  }
  return function;
}

ColourPoint colour_at(const TransferFunction& function, double value)
{
  const std::vector<ColourPoint>& points = function.colour;
  if (points.empty())
  {
    return { value, 1.0, 1.0, 1.0 };
  }
  const auto next = std::find_if(
    points.begin(), points.end(), [&](const ColourPoint& p) { return p.value >= value; });
  if (next == points.begin() || next == points.end())
  {
    ColourPoint end = next == points.end() ? points.back() : *next;
    end.value = value;
    return end;
  }
  const ColourPoint& a = *(next - 1);
  const ColourPoint& b = *next;
  const double t = (value - a.value) / (b.value - a.value);
  return { value,
    a.red + t * (b.red - a.red),
    a.green + t * (b.green - a.green),
    a.blue + t * (b.blue - a.blue) };
}

int CurveField::x_of(double value) const
{
  const double t = (value - this->lower) / (this->upper - this->lower);
  return this->box.x +
         static_cast<int>(std::lround(std::clamp(t, 0.0, 1.0) * (this->box.width - 1)));
}

int CurveField::y_of(double opacity) const
{
  const double t = std::sqrt(std::clamp(opacity, 0.0, 1.0));
  return this->box.y + static_cast<int>(std::lround((1.0 - t) * (this->box.height - 1)));
}

double CurveField::value_of(int x) const
{
  const double t = double(x - this->box.x) / std::max(this->box.width - 1, 1);
  return this->lower + std::clamp(t, 0.0, 1.0) * (this->upper - this->lower);
}

double CurveField::opacity_of(int y) const
{
  const double t = 1.0 - double(y - this->box.y) / std::max(this->box.height - 1, 1);
  return std::clamp(t, 0.0, 1.0) * std::clamp(t, 0.0, 1.0);
}

int point_at(const TransferFunction& function, const CurveField& field, int x, int y, int reach)
{
  int nearest = -1;
  int least = reach * reach + 1;
  for (std::size_t i = 0; i < function.opacity.size(); ++i)
  {
    const int dx = field.x_of(function.opacity[i].value) - x;
    const int dy = field.y_of(function.opacity[i].opacity) - y;
    if (dx * dx + dy * dy < least)
    {
      least = dx * dx + dy * dy;
      nearest = static_cast<int>(i);
    }
  }
  return nearest;
}

int colour_point_at(const TransferFunction& function, const CurveField& field, int x, int reach)
{
  int nearest = -1;
  int least = reach + 1;
  for (std::size_t i = 0; i < function.colour.size(); ++i)
  {
    const int off = std::abs(field.x_of(function.colour[i].value) - x);
    if (off < least)
    {
      least = off;
      nearest = static_cast<int>(i);
    }
  }
  return nearest;
}

namespace
{

/// In the order of values; takes the place of a point of the same value.
template <class Point>
int insert(std::vector<Point>& points, const Point& point)
{
  const auto next = std::find_if(
    points.begin(), points.end(), [&](const Point& p) { return p.value >= point.value; });
  const int index = static_cast<int>(next - points.begin());
  if (next != points.end() && next->value == point.value)
  {
    *next = point;
    return index;
  }
  points.insert(next, point);
  return index;
}

/// Values must rise; a thousandth of the way to a neighbour stays between them.
template <class Point>
void move(std::vector<Point>& points, std::size_t i, double value)
{
  const double low = i > 0 ? points[i - 1].value : -1e300;
  const double high = i + 1 < points.size() ? points[i + 1].value : 1e300;
  const double room = i > 0 && i + 1 < points.size() ? 1e-3 * (high - low)
                      : i > 0                        ? 1e-6 * (1.0 + std::abs(low))
                      : i + 1 < points.size()        ? 1e-6 * (1.0 + std::abs(high))
                                                     : 0.0;
  points[i].value = std::clamp(value, low + room, high - room);
}

template <class Point>
void remove(std::vector<Point>& points, int index)
{
  if (points.size() > 1)
  {
    points.erase(points.begin() + index);
  }
}

}

int add_point(TransferFunction& function, double value, double opacity)
{
  return insert(function.opacity, OpacityPoint{ value, opacity });
}

int add_colour_point(TransferFunction& function, double value)
{
  return insert(function.colour, colour_at(function, value));
}

void move_point(TransferFunction& function, int index, double value, double opacity)
{
  const std::size_t i = static_cast<std::size_t>(index);
  move(function.opacity, i, value);
  function.opacity[i].opacity = std::clamp(opacity, 0.0, 1.0);
}

void move_colour_point(TransferFunction& function, int index, double value)
{
  move(function.colour, static_cast<std::size_t>(index), value);
}

void remove_point(TransferFunction& function, int index)
{
  remove(function.opacity, index);
}

void remove_colour_point(TransferFunction& function, int index)
{
  remove(function.colour, index);
}

}
