#include "Transport/lookup_table.h"

#include "Transport/optics.h"

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

LookupTable make_lookup_table(const Classification& c, double step)
{
  if (c.opacity.size() < 2 || (!c.rgb.empty() && c.rgb.size() != 3 * c.opacity.size()))
  {
    throw std::invalid_argument("a transfer function needs at least 2 nodes, and as many colours");
  }
  if (!(c.lower < c.upper))
  {
    throw std::invalid_argument("a transfer function's range must not be empty");
  }
  if (!(c.unit_distance > 0.0))
  {
    throw std::invalid_argument("the opacity unit distance must be positive");
  }
  LookupTable table;
  while (table.intervals < LookupTable::most_intervals && coarseness(c, table.intervals) > 0.01)
  {
    table.intervals *= 2;
  }
  const int count = table.intervals + 1;
  table.lower = static_cast<float>(c.lower);
  table.scale = static_cast<float>(table.intervals / (c.upper - c.lower));
  table.nodes.resize(count);
  std::vector<bool> visible(count);
  bool found_empty = false;
  for (int i = 0; i < count; ++i)
  {
    const double value = c.lower + (c.upper - c.lower) * i / table.intervals;
    const TablePosition at = table_position(value, c.lower, c.upper, c.opacity.size());
    LookupNode& node = table.nodes[i];
    const double opacity = interpolate(c.opacity.data(), at);
    node.optical_depth =
      static_cast<float>(extinction_from_opacity(opacity, c.unit_distance) * step);
    float* colour = &node.red;
    for (int channel = 0; channel < 3; ++channel)
    {
      colour[channel] =
        c.rgb.empty() ? 0.0f : static_cast<float>(interpolate(c.rgb.data() + channel, at, 3));
      table.brightest = std::max(table.brightest, colour[channel]);
    }
    visible[i] = node.optical_depth > 0.0f;
    if (!found_empty && node.optical_depth == 0.0f)
    {
      table.empty_value = static_cast<float>(value);
      found_empty = true;
    }
  }
  table.visible = VisibleValues(c.lower, c.upper, visible);
  if (!found_empty)
  {
    table.empty_value = table.lower;
  }
  if (c.rgb.empty())
  {
    table.brightest = 1.0f;
  }
  if (!c.gradient_opacity.empty())
  {
    if (c.gradient_opacity.size() < 2 || !(c.gradient_upper > 0.0))
    {
      throw std::invalid_argument("a gradient opacity needs 2 nodes and a positive range");
    }
    table.gradient_factor.resize(LookupTable::gradient_intervals + 1);
    for (int i = 0; i <= LookupTable::gradient_intervals; ++i)
    {
      const double magnitude = c.gradient_upper * i / LookupTable::gradient_intervals;
      const double factor = interpolate(c.gradient_opacity.data(),
        table_position(magnitude, 0.0, c.gradient_upper, c.gradient_opacity.size()));
      table.gradient_factor[i] = static_cast<float>(std::clamp(factor, 0.0, 1.0));
    }
    table.gradient_table_scale =
      static_cast<float>(LookupTable::gradient_intervals / c.gradient_upper);
  }
  return table;
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
