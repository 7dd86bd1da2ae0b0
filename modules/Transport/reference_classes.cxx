#include "Transport/reference_classes.h"

#include "Transport/lookup_table.h"
#include "Transport/optics.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace brume
{

ReferenceClasses::ReferenceClasses(const Classification& classification)
  : TheFunctions(classification)
{
  const Classification& c = classification;
  std::vector<bool> seen;
  if (this->two_dimensional())
  {
    this->Columns = c.value_gradient_width;
    this->Rows = static_cast<int>(c.value_gradient.size() / (4 * c.value_gradient_width));
    seen.assign(this->Columns, false);
    for (std::size_t i = 3; i < c.value_gradient.size(); i += 4)
    {
      const std::size_t column = i / 4 % this->Columns;
      seen[column] = seen[column] || c.value_gradient[i] > 0.0;
    }
    const auto hidden = std::find(seen.begin(), seen.end(), false);
    const auto index = hidden == seen.end() ? 0 : hidden - seen.begin();
    this->Empty = c.lower + (c.upper - c.lower) * double(index) / (this->Columns - 1);
  }
  else
  {
    // What a non-finite voxel stands for is settled in one place, with the marcher's table.
    this->Empty = make_lookup_table(c).empty_value;
    this->Columns = static_cast<int>(c.opacity.size());
    this->Rows = 1;
    for (double opacity : c.opacity)
    {
      this->Extinction.push_back(extinction_from_opacity(opacity, c.unit_distance));
      seen.push_back(this->Extinction.back() > 0.0);
    }
  }
  this->Before.assign(seen.size() + 1, 0);
  for (std::size_t i = 0; i < seen.size(); ++i)
  {
    this->Before[i + 1] = this->Before[i] + seen[i];
  }
  this->add_up_variation();
  this->find_largest();
}

void ReferenceClasses::add_up_variation()
{
  const Classification& c = this->TheFunctions;
  double most = 1e-300;
  const auto extinction = [&](int column, int row)
  {
    return this->Rows == 1
             ? this->Extinction[column]
             : extinction_from_opacity(
                 c.value_gradient[4 * (std::size_t(row) * this->Columns + column) + 3],
                 c.unit_distance);
  };
  const auto colour = [&](int column, int row, int channel)
  {
    return this->Rows == 1
             ? (c.rgb.empty() ? 0.0 : c.rgb[3 * column + channel])
             : c.value_gradient[4 * (std::size_t(row) * this->Columns + column) + channel];
  };
  for (int row = 0; row < this->Rows; ++row)
  {
    for (int column = 0; column < this->Columns; ++column)
    {
      most = std::max(most, extinction(column, row));
    }
  }
  this->Variation.assign(this->Columns, 0.0);
  for (int i = 1; i < this->Columns; ++i)
  {
    double step = 0.0;
    for (int row = 0; row < this->Rows; ++row)
    {
      step = std::max(step, std::abs(extinction(i, row) - extinction(i - 1, row)) / most);
      for (int channel = 0; channel < 3; ++channel)
      {
        step = std::max(step, std::abs(colour(i, row, channel) - colour(i - 1, row, channel)));
      }
    }
    this->Variation[i] = this->Variation[i - 1] + step;
  }
}

namespace
{
constexpr std::size_t run_length = 64;
}

void ReferenceClasses::find_largest()
{
  const Classification& c = this->TheFunctions;
  this->Columnwise = this->Extinction;
  if (this->Rows > 1)
  {
    this->Columnwise.assign(this->Columns, 0.0);
    for (std::size_t i = 3; i < c.value_gradient.size(); i += 4)
    {
      double& largest = this->Columnwise[i / 4 % this->Columns];
      largest = std::max(largest, extinction_from_opacity(c.value_gradient[i], c.unit_distance));
    }
  }
  this->Runs.assign(this->Columnwise.size() / run_length + 1, 0.0);
  for (std::size_t i = 0; i < this->Columnwise.size(); ++i)
  {
    double& largest = this->Runs[i / run_length];
    largest = std::max(largest, this->Columnwise[i]);
  }
}

double ReferenceClasses::largest_extinction(double lower, double upper) const
{
  const Classification& c = this->TheFunctions;
  const double last = this->Columns - 1;
  const auto position = [&](double value)
  { return std::clamp((value - c.lower) / (c.upper - c.lower) * last, 0.0, last); };
  std::size_t at = static_cast<std::size_t>(std::floor(position(lower)));
  const std::size_t end = static_cast<std::size_t>(std::ceil(position(upper))) + 1;
  double largest = 0.0;
  while (at < end)
  {
    const bool run = at % run_length == 0 && at + run_length <= end;
    largest = std::max(largest, run ? this->Runs[at / run_length] : this->Columnwise[at]);
    at += run ? run_length : 1;
  }
  return largest;
}

double ReferenceClasses::variation(double from, double to) const
{
  const Classification& c = this->TheFunctions;
  const std::size_t count = this->Variation.size();
  return std::abs(
    interpolate(this->Variation.data(), table_position(to, c.lower, c.upper, count)) -
    interpolate(this->Variation.data(), table_position(from, c.lower, c.upper, count)));
}

double ReferenceClasses::magnitude(const glm::dvec3& gradient) const
{
  return glm::length(gradient / this->TheFunctions.gradient_scale);
}

double ReferenceClasses::node(double value, double magnitude, int channel) const
{
  const Classification& c = this->TheFunctions;
  const TablePosition x = table_position(value, c.lower, c.upper, this->Columns);
  const TablePosition y = table_position(magnitude, 0.0, c.gradient_upper, this->Rows);
  const double* row = c.value_gradient.data() + 4 * y.index * this->Columns + channel;
  const double a = interpolate(row, x, 4);
  const double b = interpolate(row + 4 * this->Columns, x, 4);
  return a + y.fraction * (b - a);
}

double ReferenceClasses::extinction(double value, double magnitude) const
{
  const Classification& c = this->TheFunctions;
  if (this->two_dimensional())
  {
    return extinction_from_opacity(this->node(value, magnitude, 3), c.unit_distance);
  }
  const TablePosition at = table_position(value, c.lower, c.upper, this->Columns);
  // It is the opacity that is linear between nodes. Nodes as close as these spare the logarithm.
  return this->Columns > LookupTable::most_intervals
           ? interpolate(this->Extinction.data(), at)
           : extinction_from_opacity(interpolate(c.opacity.data(), at), c.unit_distance);
}

double ReferenceClasses::opacity(double value, double magnitude) const
{
  const Classification& c = this->TheFunctions;
  const double opacity =
    this->two_dimensional()
      ? this->node(value, magnitude, 3)
      : interpolate(c.opacity.data(), table_position(value, c.lower, c.upper, this->Columns));
  return opacity > 0.0 ? std::min(opacity, 1.0) : 0.0;
}

glm::dvec3 ReferenceClasses::colour(double value, double magnitude) const
{
  const Classification& c = this->TheFunctions;
  glm::dvec3 result(0.0);
  for (int channel = 0; channel < 3; ++channel)
  {
    result[channel] =
      this->two_dimensional()
        ? this->node(value, magnitude, channel)
        : interpolate(
            c.rgb.data() + channel, table_position(value, c.lower, c.upper, this->Columns), 3);
  }
  return result;
}

double ReferenceClasses::gradient_factor(double magnitude) const
{
  const Classification& c = this->TheFunctions;
  if (c.gradient_opacity.empty())
  {
    return 1.0;
  }
  const double factor = interpolate(c.gradient_opacity.data(),
    table_position(magnitude, 0.0, c.gradient_upper, c.gradient_opacity.size()));
  return std::clamp(factor, 0.0, 1.0);
}

bool ReferenceClasses::can_show(float lower, float upper) const
{
  const Classification& c = this->TheFunctions;
  const double last = this->Columns - 1;
  const auto position = [&](double value)
  { return std::clamp((value - c.lower) / (c.upper - c.lower) * last, 0.0, last); };
  const auto first = static_cast<std::size_t>(std::floor(position(lower)));
  const auto end = static_cast<std::size_t>(std::ceil(position(upper))) + 1;
  return this->Before[end] > this->Before[first];
}

}
