#include "classification_from_vtk.h"

#include "grid_from_vtk.h"

#include "vtkColorTransferFunction.h"
#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkPiecewiseFunction.h"
#include "vtkPointData.h"
#include "vtkVolumeProperty.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace brume
{

namespace
{

/// Nodes of the transfer functions' tables: fine enough to be the truth's.
constexpr int table_nodes = 65537;

/// The functions that classify, any of the colours null.
struct Functions
{
  vtkPiecewiseFunction* opacity = nullptr;
  vtkPiecewiseFunction* gray = nullptr;
  vtkColorTransferFunction* rgb = nullptr;

  bool Clamps() const
  {
    return opacity->GetClamping() && (!gray || gray->GetClamping()) && (!rgb || rgb->GetClamping());
  }
};

/// The values that a table must tell apart.
struct Span
{
  double lower = std::numeric_limits<double>::infinity();
  double upper = -std::numeric_limits<double>::infinity();

  void Add(double l, double u)
  {
    lower = std::min(lower, l);
    upper = std::max(upper, u);
  }
  /// The part of the data's range that the function's nodes cover: where functions are constant
  /// beyond their end nodes, the table need not go there, and its nodes are better spent between.
  template <class Function>
  void Add(Function* function, const double range[2])
  {
    if (function && function->GetSize() > 0)
    {
      double ends[2];
      function->GetRange(ends);
      Add(std::max(range[0], ends[0]), std::min(range[1], ends[1]));
    }
  }
};

/// The range of a table: of values, and of those that are coloured; `whole`: all of the data's.
void set_range(Classification& c,
  const Functions& f,
  const double values[2],
  const double coloured[2],
  bool whole)
{
  Span all;
  all.Add(values[0], values[1]);
  if (f.gray || f.rgb)
  {
    all.Add(coloured[0], coloured[1]);
  }
  if (!whole && f.Clamps() && f.opacity->GetSize() > 0)
  {
    Span needed;
    needed.Add(f.opacity, values);
    needed.Add(f.gray, coloured);
    needed.Add(f.rgb, coloured);
    if (needed.lower < needed.upper)
    {
      all = needed;
    }
  }
  c.lower = all.lower;
  c.upper = all.upper;
  if (!(c.lower < c.upper))
  {
    // A constant volume: any range around the value will do.
    const double margin = std::max(1.0, std::abs(c.lower)) * 1e-3;
    c.lower -= margin;
    c.upper += margin;
  }
}

void fill(Classification& c, const Functions& f, int nodes)
{
  c.opacity.resize(nodes);
  f.opacity->GetTable(c.lower, c.upper, nodes, c.opacity.data());
  if (f.gray)
  {
    std::vector<double> values(nodes);
    f.gray->GetTable(c.lower, c.upper, nodes, values.data());
    c.rgb.resize(3 * static_cast<std::size_t>(nodes));
    for (std::size_t i = 0; i < c.rgb.size(); ++i)
    {
      c.rgb[i] = values[i / 3];
    }
  }
  else if (f.rgb)
  {
    c.rgb.resize(3 * static_cast<std::size_t>(nodes));
    f.rgb->GetTable(c.lower, c.upper, nodes, c.rgb.data());
    if (f.rgb->GetSize() == 1 && f.rgb->GetClamping())
    {
      // VTK's table is black where it hits the place of a single point.
      double node[6];
      f.rgb->GetNodeValue(0, node);
      for (std::size_t i = 0; i < c.rgb.size(); ++i)
      {
        c.rgb[i] = node[1 + i % 3];
      }
    }
  }
}

/// Magnitudes as VTK counts them: a central difference over two mean voxels.
void set_gradient_scale(Classification& c, const GridFromVTK& grid, double upper)
{
  const double mean = (grid.Spacing[0] + grid.Spacing[1] + grid.Spacing[2]) / 3.0;
  c.gradient_scale =
    glm::dvec3(grid.Spacing[0] / mean, grid.Spacing[1] / mean, grid.Spacing[2] / mean);
  c.gradient_upper = std::max(upper, 1e-30);
}

void fill_gradient_opacity(Classification& c,
  const GridFromVTK& grid,
  const double range[2],
  vtkPiecewiseFunction* function,
  int nodes)
{
  // A central difference is at most half the range of values along each axis.
  const double steepest = 0.5 * (range[1] - range[0]) * std::sqrt(3.0);
  const double mean = (grid.Spacing[0] + grid.Spacing[1] + grid.Spacing[2]) / 3.0;
  const double finest = *std::min_element(grid.Spacing, grid.Spacing + 3);
  set_gradient_scale(c, grid, steepest * mean / finest);
  c.gradient_opacity.assign(nodes, 1.0);
  if (function)
  {
    function->GetTable(0.0, c.gradient_upper, nodes, c.gradient_opacity.data());
  }
}

/// VTK's default function is 1 everywhere: no gradient opacity at all.
void drop_if_one(std::vector<double>& factors)
{
  if (std::all_of(factors.begin(), factors.end(), [](double factor) { return factor >= 1.0; }))
  {
    factors.clear();
  }
}

/// Whether all of a function's nodes are finite numbers. VTK sorts them by their places, and NaN has
/// none.
template <class Function>
bool is_finite(Function* function)
{
  double node[6] = { 0, 0, 0, 0, 0, 0 }; // the longer of vtkPiecewiseFunction's and the colours'
  for (int i = 0; function && i < function->GetSize(); ++i)
  {
    function->GetNodeValue(i, node);
    if (!std::all_of(node, node + 6, [](double v) { return std::isfinite(v); }))
    {
      return false;
    }
  }
  return true;
}

/// What is wrong with the functions that a property classifies a volume and its labels with.
std::string what_is_not_finite(vtkVolumeProperty* property, const Functions& f, int volume)
{
  const auto wrong = [](const char* name)
  {
    return std::string("the ") + name +
           " function has a node that is not finite: remove it, or build the function anew";
  };
  if (!is_finite(f.opacity))
  {
    return wrong("scalar opacity");
  }
  if (!is_finite(f.gray) || !is_finite(f.rgb))
  {
    return wrong("colour");
  }
  if (!property->GetDisableGradientOpacity(volume) &&
      !is_finite(property->GetStoredGradientOpacity(volume)))
  {
    return wrong("gradient opacity");
  }
  for (int label : property->GetLabelMapLabels())
  {
    if (!is_finite(property->GetLabelScalarOpacity(label)) ||
        !is_finite(property->GetLabelColor(label)) ||
        !is_finite(property->GetLabelGradientOpacity(label)))
    {
      return wrong(("label " + std::to_string(label) + "'s").c_str());
    }
  }
  return {};
}

Functions functions_of(vtkVolumeProperty* property, int index, bool coloured)
{
  Functions f;
  f.opacity = property->GetScalarOpacity(index);
  if (coloured)
  {
    const bool gray = property->GetColorChannels(index) == 1;
    f.gray = gray ? property->GetGrayTransferFunction(index) : nullptr;
    f.rgb = gray ? nullptr : property->GetRGBTransferFunction(index);
  }
  return f;
}

vtkPiecewiseFunction* gradient_function_of(vtkVolumeProperty* property, int index)
{
  // Asked through the 1D mode alone: in the other HasGradientOpacity always says yes.
  const bool has = property->GetTransferFunctionMode() == vtkVolumeProperty::TF_1D &&
                   !property->GetDisableGradientOpacity(index) &&
                   property->HasGradientOpacity(index);
  return has ? property->GetGradientOpacity(index) : nullptr;
}

/// A 2D function as VTK's GPU mapper reads it: the image is stretched over the range of values and
/// over gradient magnitudes up to a quarter of that, its pixels at the middles of their cells.
std::string fill_2d(Classification& c,
  vtkVolumeProperty* property,
  const GridFromVTK& grid,
  int index)
{
  vtkImageData* image = property->GetTransferFunction2D(index);
  vtkDataArray* colours = image ? image->GetPointData()->GetScalars() : nullptr;
  int dims[3] = { 0, 0, 0 };
  if (image)
  {
    image->GetDimensions(dims);
  }
  if (!colours || colours->GetNumberOfComponents() != 4 || dims[0] < 1 || dims[1] < 1 ||
      colours->GetNumberOfTuples() < static_cast<vtkIdType>(dims[0]) * dims[1])
  {
    return "TransferFunctionMode is TF_2D and component " + std::to_string(index) +
           " has no image of 4 components: set it with vtkVolumeProperty::SetTransferFunction2D";
  }
  const double* range = grid.GetRange(index);
  const double width = range[1] > range[0] ? range[1] - range[0] : 1.0;
  set_gradient_scale(c, grid, 0.25 * width);
  // Along values the nodes are the pixels. An image one pixel wide is the same everywhere.
  const int nodes = std::max(dims[0], 2);
  c.lower = range[0] + width * 0.5 / dims[0];
  c.upper = range[0] + width * (dims[0] > 1 ? 1.0 - 0.5 / dims[0] : 1.0);
  // Along gradients, where the table must begin at 0, there are nodes on the pixels' edges too.
  const int rows = 2 * dims[1] + 1;
  c.value_gradient_width = nodes;
  c.value_gradient.resize(4 * static_cast<std::size_t>(nodes) * rows);
  auto* out = c.value_gradient.data();
  for (int row = 0; row < rows; ++row)
  {
    const int last = dims[1] - 1;
    const int a = std::min(std::max((row - 1) / 2, 0), last);
    const int b = row % 2 || row == 0 ? a : std::min(row / 2, last);
    for (int node = 0; node < nodes; ++node)
    {
      const vtkIdType x = std::min(node, dims[0] - 1);
      for (int channel = 0; channel < 4; ++channel)
      {
        *out++ = 0.5 * (colours->GetComponent(static_cast<vtkIdType>(a) * dims[0] + x, channel) +
                         colours->GetComponent(static_cast<vtkIdType>(b) * dims[0] + x, channel));
      }
    }
  }
  if (!std::all_of(c.value_gradient.begin(),
        c.value_gradient.end(),
        [](double v) { return std::isfinite(v); }))
  {
    return "the 2D transfer function has a pixel that is not finite: give it numbers";
  }
  return {};
}

}

std::string classification_from_vtk(vtkVolumeProperty* property,
  const GridFromVTK& grid,
  int volume,
  bool whole,
  Classification& c)
{
  c = Classification();
  c.unit_distance = property->GetScalarOpacityUnitDistance(volume);
  if (!(c.unit_distance > 0.0))
  {
    return "the scalar opacity unit distance must be positive: set it with "
           "vtkVolumeProperty::SetScalarOpacityUnitDistance";
  }
  const Grid shape = grid.GetGrid(volume);
  if (property->GetTransferFunctionMode() == vtkVolumeProperty::TF_2D &&
      shape.colour == VoxelColour::Value)
  {
    return fill_2d(c, property, grid, volume);
  }
  const Functions f = functions_of(property, volume, shape.colour != VoxelColour::RGB);
  const std::string wrong = what_is_not_finite(property, f, volume);
  if (!wrong.empty())
  {
    return wrong;
  }
  const double* range = grid.GetRange(shape.component);
  set_range(c, f, range, shape.colour == VoxelColour::First ? grid.GetRange(0) : range, whole);
  fill(c, f, table_nodes);
  if (vtkPiecewiseFunction* gradient = gradient_function_of(property, volume))
  {
    fill_gradient_opacity(c, grid, range, gradient, table_nodes);
    drop_if_one(c.gradient_opacity);
  }
  return {};
}

Classification label_classification_from_vtk(vtkVolumeProperty* property,
  const GridFromVTK& grid,
  int label,
  double factor,
  int nodes)
{
  const Grid shape = grid.GetGrid(0);
  const Functions plain = functions_of(property, 0, shape.colour != VoxelColour::RGB);
  Functions own = plain;
  if (vtkPiecewiseFunction* opacity = property->GetLabelScalarOpacity(label))
  {
    own.opacity = opacity;
  }
  vtkColorTransferFunction* colour = property->GetLabelColor(label);
  if (colour && shape.colour != VoxelColour::RGB)
  {
    own.gray = nullptr;
    own.rgb = colour;
  }
  const double* range = grid.GetRange(shape.component);
  const double* coloured = shape.colour == VoxelColour::First ? grid.GetRange(0) : range;
  Classification c;
  c.unit_distance = property->GetScalarOpacityUnitDistance(0);
  set_range(c, own, range, coloured, true);
  fill(c, own, nodes);
  vtkPiecewiseFunction* gradient = property->GetLabelGradientOpacity(label);
  if (gradient)
  {
    fill_gradient_opacity(c, grid, range, gradient, nodes);
  }
  if (factor < 1.0)
  {
    // Opacities and colours are mixed each for itself, as VTK's GPU mapper does, and likewise the
    // colour of what is not seen without the label counts as black.
    Classification other;
    other.lower = c.lower;
    other.upper = c.upper;
    fill(other, plain, nodes);
    for (int i = 0; i < nodes; ++i)
    {
      for (int channel = 0; channel < 3 && !c.rgb.empty(); ++channel)
      {
        const double seen = other.opacity[i] > 0.0 ? other.rgb[3 * i + channel] : 0.0;
        c.rgb[3 * i + channel] = factor * c.rgb[3 * i + channel] + (1.0 - factor) * seen;
      }
      c.opacity[i] = factor * c.opacity[i] + (1.0 - factor) * other.opacity[i];
    }
    if (vtkPiecewiseFunction* plainGradient = gradient_function_of(property, 0))
    {
      if (!gradient)
      {
        fill_gradient_opacity(c, grid, range, nullptr, nodes);
      }
      fill_gradient_opacity(other, grid, range, plainGradient, nodes);
      for (int i = 0; i < nodes; ++i)
      {
        c.gradient_opacity[i] =
          factor * c.gradient_opacity[i] + (1.0 - factor) * other.gradient_opacity[i];
      }
    }
    else if (gradient)
    {
      for (double& g : c.gradient_opacity)
      {
        g = factor * g + (1.0 - factor);
      }
    }
  }
  drop_if_one(c.gradient_opacity);
  return c;
}

unsigned long label_functions_time(vtkVolumeProperty* property)
{
  vtkMTimeType latest = 0;
  const auto see = [&latest](vtkObject* function)
  {
    if (function)
    {
      latest = std::max(latest, function->GetMTime());
    }
  };
  for (int label : property->GetLabelMapLabels())
  {
    see(property->GetLabelColor(label));
    see(property->GetLabelScalarOpacity(label));
    see(property->GetLabelGradientOpacity(label));
  }
  return static_cast<unsigned long>(latest);
}

}
