#include "Transport/mode_tables.h"

#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>

namespace brume
{

std::vector<float> sorted_isosurfaces(const Scene& scene)
{
  std::vector<float> values(scene.isosurfaces.begin(), scene.isosurfaces.end());
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

bool ModeTables::serve(const Scene& scene) const
{
  return this->Ready && this->Mode == scene.blend_mode &&
         std::equal(this->AverageRange, this->AverageRange + 2, scene.average_range) &&
         this->Isosurfaces == scene.isosurfaces;
}

void ModeTables::update(
  const Scene& scene, const Volume& volume, const BrickRanges& ranges, LookupTable& table)
{
  this->Ready = false;
  this->Mode = scene.blend_mode;
  std::copy(scene.average_range, scene.average_range + 2, this->AverageRange);
  this->Isosurfaces = scene.isosurfaces;
  this->Bounds.clear();
  this->Surfaces.clear();
  if (this->Mode != BlendMode::Composite)
  {
    hold_opacities(table, volume.classification, volume.label_classifications);
  }
  if (this->Mode == BlendMode::MaximumIntensity || this->Mode == BlendMode::MinimumIntensity)
  {
    this->find_bounds(ranges, table.empty_value);
  }
  if (this->Mode == BlendMode::Isosurface && volume.classification.value_gradient.empty())
  {
    this->find_surfaces(volume);
  }
  this->Ready = true;
}

void ModeTables::find_bounds(const BrickRanges& ranges, float empty_value)
{
  const bool largest = this->Mode == BlendMode::MaximumIntensity;
  const bool any = ranges.lower <= ranges.upper;
  this->Sign = largest ? 1.0f : -1.0f;
  this->Extreme = !any ? empty_value : largest ? ranges.lower : ranges.upper;
  this->Top = this->Sign * (!any ? empty_value : largest ? ranges.upper : ranges.lower);
  this->Rounding = 1e-6f * std::max(std::abs(ranges.lower), std::abs(ranges.upper));
  std::copy(ranges.dims, ranges.dims + 3, this->BrickDims);
  this->BrickShift = ranges.shift;
  this->Bounds.resize(ranges.size());
  for (std::size_t i = 0; i < ranges.size(); ++i)
  {
    this->Bounds[i] = this->Sign * (largest ? ranges.maximum[i] : ranges.minimum[i]);
    if (!ranges.reaches_non_finite.empty() && ranges.reaches_non_finite[i])
    {
      this->Bounds[i] = std::max(this->Bounds[i], this->Sign * this->Extreme);
    }
  }
}

void ModeTables::find_surfaces(const Volume& volume)
{
  const std::vector<float> values = [&]
  {
    Scene scene;
    scene.isosurfaces = this->Isosurfaces;
    return sorted_isosurfaces(scene);
  }();
  const auto add = [&](const Classification& c)
  {
    for (float value : values)
    {
      const TablePosition at = table_position(value, c.lower, c.upper, c.opacity.size());
      const double opacity = interpolate(c.opacity.data(), at);
      LookupNode node{ 0.0f, 0.0f, 0.0f, static_cast<float>(std::clamp(opacity, 0.0, 1.0)) };
      for (int channel = 0; channel < 3 && !c.rgb.empty(); ++channel)
      {
        (&node.red)[channel] = static_cast<float>(interpolate(c.rgb.data() + channel, at, 3));
      }
      this->Surfaces.push_back(node);
    }
  };
  add(volume.classification);
  for (const Classification& c : volume.label_classifications)
  {
    add(c);
  }
}

bool ModeTables::can_show(const Scene& scene,
  const Volume& volume,
  const LookupTable& table,
  float lower,
  float upper) const
{
  switch (this->Mode)
  {
    case BlendMode::Composite:
      return volume.weight > 0.0 && table.can_show(lower, upper);
    case BlendMode::AverageIntensity:
      // Length counts even where the opacity is 0. Ranges are of the value, not of the colour.
      return volume.grid.colour != VoxelColour::Value ||
             (lower <= scene.average_range[1] && upper >= scene.average_range[0]);
    case BlendMode::Additive:
      return table.can_show(lower, upper);
    case BlendMode::Isosurface:
      return std::any_of(this->Isosurfaces.begin(), this->Isosurfaces.end(),
        [&](double value) { return lower <= value && value <= upper; });
    case BlendMode::MaximumIntensity:
    case BlendMode::MinimumIntensity:
    case BlendMode::Slice:
      break;
  }
  return true;
}

float ModeTables::empty_value(const LookupTable& table) const
{
  return this->Bounds.empty() ? table.empty_value : this->Extreme;
}

void ModeTables::fill(const Scene& scene, const Volume& volume, VolumeTask& task) const
{
  task.sign = this->Sign;
  task.top = this->Top;
  task.rounding = this->Rounding;
  task.bounds = this->Bounds.data();
  std::copy(this->BrickDims, this->BrickDims + 3, task.brick_dims);
  task.brick_shift = this->BrickShift;
  const double span = volume.grey_range[1] - volume.grey_range[0];
  task.black = static_cast<float>(volume.grey_range[0]);
  task.whiten = span > 0.0 ? static_cast<float>(1.0 / span) : 0.0f;
  task.per_unit = static_cast<float>(1.0 / volume.classification.unit_distance);
  task.surfaces = this->Surfaces.empty() ? nullptr : this->Surfaces.data();
  const glm::dvec4 plane =
    glm::transpose(volume.world_from_data * volume.data_from_index) * scene.slice;
  for (int i = 0; i < 4; ++i)
  {
    task.slice[i] = static_cast<float>(plane[i]);
  }
  if (scene.blend_mode == BlendMode::Additive && volume.mask.labels)
  {
    task.bricks = nullptr; // what is leapt over would not be known to be there
  }
}

}
