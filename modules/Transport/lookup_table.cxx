#include "Transport/lookup_table.h"

#include "Transport/optics.h"

#include <glm/common.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace brume
{

TablePosition table_position(double value, double lower, double upper, std::size_t count)
{
  const double last = static_cast<double>(count - 1);
  double position = (value - lower) / (upper - lower) * last;
  position = position > 0.0 ? std::min(position, last) : 0.0; // a NaN goes to the first node
  const std::size_t index = std::min(static_cast<std::size_t>(position), count - 2);
  return { index, position - static_cast<double>(index) };
}

namespace
{

/// The largest distance, in opacity or colour, between the nodes of a classification and the
/// straight lines through its values at `intervals` even distances.
double coarseness(const Classification& c, int intervals)
{
  const std::size_t count = c.opacity.size();
  const int channels = c.rgb.empty() ? 1 : 4;
  const auto value = [&](int channel, TablePosition at)
  {
    return channel == 0 ? interpolate(c.opacity.data(), at)
                        : interpolate(c.rgb.data() + channel - 1, at, 3);
  };
  double most = 0.0;
  for (std::size_t i = 0; i < count; ++i)
  {
    const double here = static_cast<double>(i) / (count - 1);
    const double below = std::floor(here * intervals);
    const double fraction = here * intervals - below;
    const TablePosition low = table_position(below / intervals, 0.0, 1.0, count);
    const TablePosition high = table_position((below + 1.0) / intervals, 0.0, 1.0, count);
    for (int channel = 0; channel < channels; ++channel)
    {
      const double exact =
        channel == 0 ? c.opacity[i] : c.rgb[3 * i + static_cast<std::size_t>(channel) - 1];
      const double a = value(channel, low);
      most = std::max(most, std::abs(a + fraction * (value(channel, high) - a) - exact));
    }
  }
  return most;
}

}

namespace
{

void check(const Classification& c)
{
  if (!(c.lower < c.upper))
  {
    throw std::invalid_argument("a transfer function's range must not be empty");
  }
  if (!(c.unit_distance > 0.0))
  {
    throw std::invalid_argument("the opacity unit distance must be positive");
  }
  if (c.opacity.size() < 2 || (!c.rgb.empty() && c.rgb.size() != 3 * c.opacity.size()))
  {
    throw std::invalid_argument("a transfer function needs at least 2 nodes, and as many colours");
  }
}

/// Adds the nodes of one classification to the table.
void add_nodes(const Classification& c, LookupTable& table, std::vector<bool>& visible)
{
  for (int i = 0; i <= table.intervals; ++i)
  {
    const double value = c.lower + (c.upper - c.lower) * i / table.intervals;
    const TablePosition at = table_position(value, c.lower, c.upper, c.opacity.size());
    LookupNode node;
    const double opacity = interpolate(c.opacity.data(), at);
    node.extinction = static_cast<float>(extinction_from_opacity(opacity, c.unit_distance));
    float* colour = &node.red;
    for (int channel = 0; channel < 3; ++channel)
    {
      colour[channel] =
        c.rgb.empty() ? 0.0f : static_cast<float>(interpolate(c.rgb.data() + channel, at, 3));
      table.brightest = std::max(table.brightest, colour[channel]);
    }
    visible[i] = visible[i] || node.extinction > 0.0f;
    table.nodes.push_back(node);
  }
}

/// Extinction, and extinction times colour, at a node.
glm::dvec4 associated(const LookupNode& node)
{
  return glm::dvec4(node.red, node.green, node.blue, 1.0) * double(node.extinction);
}

void add_integrals(LookupTable& table)
{
  table.integrals.resize(table.intervals + 1);
  glm::dvec4 sum(0.0);
  for (int i = 0; i <= table.intervals; ++i)
  {
    if (i > 0)
    {
      sum += 0.5 * (associated(table.nodes[i - 1]) + associated(table.nodes[i]));
    }
    table.integrals[i] = { static_cast<float>(sum.r),
      static_cast<float>(sum.g),
      static_cast<float>(sum.b),
      static_cast<float>(sum.a) };
  }
}

/// Cuts the table into stretches: each as long as all its nodes lie within a three-hundredth of the
/// straight line between its ends, for extinction and for extinction · colour.
void add_stretches(LookupTable& table)
{
  table.stretch.resize(table.intervals);
  const auto straight = [&](int first, int last)
  {
    const glm::dvec4 a = associated(table.nodes[first]);
    const glm::dvec4 b = associated(table.nodes[last]);
    const int count = last - first;
    const int stride = std::max(1, count / 16); // a polyline of few corners: this sees them
    for (int i = first + stride; i < last; i += stride)
    {
      const glm::dvec4 line = a + (b - a) * (double(i - first) / count);
      const glm::dvec4 off = glm::abs(associated(table.nodes[i]) - line);
      const double allowed = line.a / 300.0;
      if (off.r > allowed || off.g > allowed || off.b > allowed || off.a > allowed)
      {
        return false;
      }
    }
    return true;
  };
  int number = 0;
  int first = 0;
  while (first < table.intervals)
  {
    // The longest by doubling, then by halving.
    int reach = 1;
    int step = 1;
    while (first + reach + step <= table.intervals && straight(first, first + reach + step))
    {
      reach += step;
      step *= 2;
    }
    for (; step >= 1; step /= 2)
    {
      if (first + reach + step <= table.intervals && straight(first, first + reach + step))
      {
        reach += step;
      }
    }
    for (int i = 0; i < reach; ++i)
    {
      table.stretch[first + i] = number;
    }
    ++number;
    first += reach;
  }
}

/// Adds the gradient factors of one classification; 1 where it has none.
void add_gradient_factor(const Classification& c, LookupTable& table)
{
  const bool some = !c.gradient_opacity.empty();
  if (some && (c.gradient_opacity.size() < 2 || !(c.gradient_upper > 0.0)))
  {
    throw std::invalid_argument("a gradient opacity needs 2 nodes and a positive range");
  }
  for (int i = 0; i <= LookupTable::gradient_intervals; ++i)
  {
    const double magnitude = c.gradient_upper * i / LookupTable::gradient_intervals;
    const double factor = !some ? 1.0
                                : interpolate(c.gradient_opacity.data(),
                                    table_position(magnitude, 0.0, c.gradient_upper,
                                      c.gradient_opacity.size()));
    table.gradient_factor.push_back(static_cast<float>(std::clamp(factor, 0.0, 1.0)));
  }
  if (some)
  {
    const auto scale = static_cast<float>(LookupTable::gradient_intervals / c.gradient_upper);
    if (table.gradient_table_scale != 1.0f && table.gradient_table_scale != scale)
    {
      throw std::invalid_argument("the labels' gradient opacities have ranges of their own");
    }
    table.gradient_table_scale = scale;
  }
}

/// A function of value and gradient: seen where any gradient makes it seen.
LookupTable make_value_gradient_table(const Classification& c)
{
  if (!(c.lower < c.upper) || !(c.unit_distance > 0.0) || !(c.gradient_upper > 0.0))
  {
    throw std::invalid_argument(
      "a transfer function of value and gradient needs ranges that are not "
      "empty and a positive unit distance");
  }
  LookupTable table;
  table.unit_distance = static_cast<float>(c.unit_distance);
  table.columns = c.value_gradient_width;
  table.rows = static_cast<int>(c.value_gradient.size() / 4 / c.value_gradient_width);
  table.value_gradient.assign(c.value_gradient.begin(), c.value_gradient.end());
  table.intervals = table.columns - 1;
  table.lower = static_cast<float>(c.lower);
  table.scale = static_cast<float>(table.intervals / (c.upper - c.lower));
  table.gradient_table_scale = static_cast<float>((table.rows - 1) / c.gradient_upper);
  std::vector<bool> visible(table.columns);
  for (std::size_t i = 0; i < table.value_gradient.size(); i += 4)
  {
    const float* node = table.value_gradient.data() + i;
    table.brightest = std::max({ table.brightest, node[0], node[1], node[2] });
    const std::size_t column = i / 4 % table.columns;
    visible[column] = visible[column] || node[3] > 0.0f;
  }
  table.visible = VisibleValues(c.lower, c.upper, visible);
  const auto empty = std::find(visible.begin(), visible.end(), false);
  const double column = empty == visible.end() ? 0.0 : double(empty - visible.begin());
  table.empty_value = static_cast<float>(c.lower + column * (c.upper - c.lower) / table.intervals);
  return table;
}

}

LookupTable make_lookup_table(const Classification& c, const std::vector<Classification>& labels)
{
  if (!c.value_gradient.empty())
  {
    return make_value_gradient_table(c);
  }
  check(c);
  LookupTable table;
  for (const Classification& label : labels)
  {
    check(label);
    if (label.lower != c.lower || label.upper != c.upper)
    {
      throw std::invalid_argument("the labels' transfer functions have ranges of their own");
    }
  }
  const auto fine_enough = [&](const Classification& each)
  { return coarseness(each, table.intervals) <= 0.01; };
  while (table.intervals < LookupTable::most_intervals &&
         !(fine_enough(c) && std::all_of(labels.begin(), labels.end(), fine_enough)))
  {
    table.intervals *= 2;
  }
  table.lower = static_cast<float>(c.lower);
  table.scale = static_cast<float>(table.intervals / (c.upper - c.lower));
  std::vector<bool> visible(table.intervals + 1);
  add_nodes(c, table, visible);
  for (const Classification& label : labels)
  {
    add_nodes(label, table, visible);
  }
  table.visible = VisibleValues(c.lower, c.upper, visible);
  const auto empty = std::find(visible.begin(), visible.end(), false);
  table.empty_value =
    empty == visible.end()
      ? table.lower
      : static_cast<float>(
          c.lower + (c.upper - c.lower) * double(empty - visible.begin()) / table.intervals);
  if (c.rgb.empty())
  {
    table.brightest = 1.0f;
  }
  add_integrals(table);
  add_stretches(table);
  const auto by_gradient = [](const Classification& each) { return !each.gradient_opacity.empty(); };
  if (by_gradient(c) || std::any_of(labels.begin(), labels.end(), by_gradient))
  {
    add_gradient_factor(c, table);
    for (const Classification& label : labels)
    {
      add_gradient_factor(label, table);
    }
  }
  return table;
}

void hold_opacities(LookupTable& table,
  const Classification& classification,
  const std::vector<Classification>& labels)
{
  for (std::size_t i = 0; i < table.nodes.size(); ++i)
  {
    const std::size_t per_class = table.intervals + 1;
    const Classification& c =
      i < per_class ? classification : labels[i / per_class - 1];
    const double value =
      c.lower + (c.upper - c.lower) * double(i % per_class) / table.intervals;
    const double opacity = interpolate(
      c.opacity.data(), table_position(value, c.lower, c.upper, c.opacity.size()));
    table.nodes[i].extinction = opacity > 0.0 ? static_cast<float>(std::min(opacity, 1.0)) : 0.0f;
  }
}

VisibleValues::VisibleValues(double lower, double upper, const std::vector<bool>& visible)
  : Lower(lower)
  , Scale((visible.size() - 1) / (upper - lower))
  , Before(visible.size() + 1, 0)
{
  for (std::size_t i = 0; i < visible.size(); ++i)
  {
    this->Before[i + 1] = this->Before[i] + visible[i];
  }
}

bool VisibleValues::any(double lowest, double highest) const
{
  const double last = static_cast<double>(this->Before.size() - 2);
  const double from = std::clamp((lowest - this->Lower) * this->Scale, 0.0, last);
  const double to = std::clamp((highest - this->Lower) * this->Scale, 0.0, last);
  const auto first = static_cast<std::size_t>(std::floor(from));
  const auto end = static_cast<std::size_t>(std::ceil(to)) + 1;
  return this->Before[end] > this->Before[first];
}

}
