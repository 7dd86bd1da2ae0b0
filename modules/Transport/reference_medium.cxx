#include "Transport/reference_medium.h"

#include "Transport/lookup_table.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>

namespace brume
{

ReferenceMedium::ReferenceMedium(const Scene& scene, const Volume& volume)
  : TheVolume(volume)
  , Shade(prepare_shading(scene, volume))
  , Ranges(
      volume.ranges ? volume.ranges : std::make_shared<BrickRanges>(measure_bricks(volume.grid)))
  , WorldFromIndex(volume.world_from_data * volume.data_from_index)
{
  this->WorldFromGradient = glm::transpose(glm::inverse(glm::dmat3(this->WorldFromIndex)));
  if (volume.meaning == ValueMeaning::Classified)
  {
    this->Classes.emplace_back(volume.classification);
    for (const Classification& c : volume.label_classifications)
    {
      this->Classes.emplace_back(c);
    }
    this->EmptyValue = this->Classes.front().empty_value();
  }
  if (scene.blend_mode == BlendMode::MaximumIntensity && this->Ranges->lower <= this->Ranges->upper)
  {
    this->EmptyValue = this->Ranges->lower;
  }
  if (scene.blend_mode == BlendMode::MinimumIntensity && this->Ranges->lower <= this->Ranges->upper)
  {
    this->EmptyValue = this->Ranges->upper;
  }
  this->Values = ReferenceGrid::make(volume.grid, this->EmptyValue);
  this->Bricks = find_visible_bricks(
    *this->Ranges,
    [&](float lower, float upper)
    {
      return this->Classes.empty()
               ? upper > 0.0f
               : std::any_of(this->Classes.begin(),
                   this->Classes.end(),
                   [&](const ReferenceClasses& c) { return c.can_show(lower, upper); });
    },
    static_cast<float>(this->EmptyValue));
}

std::size_t ReferenceMedium::brick(const glm::dvec3& place) const
{
  std::size_t index = 0;
  for (int axis = 2; axis >= 0; --axis)
  {
    // Not a number is in the first brick, what is far away in the last.
    const int voxel = static_cast<int>(std::min(2e9, std::max(0.0, place[axis])));
    const int brick = voxel >> this->Bricks.shift;
    index = index * this->Ranges->dims[axis] + std::min(brick, this->Ranges->dims[axis] - 1);
  }
  return index;
}

bool ReferenceMedium::visible(const glm::dvec3& place) const
{
  return this->Bricks.distance[this->brick(place)] == 0;
}

void ReferenceMedium::range(const glm::dvec3& place, double& lower, double& upper) const
{
  const std::size_t index = this->brick(place);
  lower = this->Ranges->minimum[index];
  upper = this->Ranges->maximum[index];
  if (!this->Ranges->reaches_non_finite.empty() && this->Ranges->reaches_non_finite[index])
  {
    lower = std::min(lower, this->EmptyValue);
    upper = std::max(upper, this->EmptyValue);
  }
}

double ReferenceMedium::value(const glm::dvec3& place) const
{
  return this->Values->value(place, this->TheVolume.grid.component);
}

double ReferenceMedium::grey_value(const glm::dvec3& place) const
{
  const Grid& grid = this->TheVolume.grid;
  return this->Values->value(place, grid.colour == VoxelColour::Value ? grid.component : 0);
}

int ReferenceMedium::label(const glm::dvec3& place) const
{
  const Mask& mask = this->TheVolume.mask;
  if (!mask.labels)
  {
    return 0;
  }
  std::size_t index = 0;
  for (int axis = 2; axis >= 0; --axis)
  {
    const int count = this->TheVolume.grid.dims[axis];
    const double nearest = std::clamp(std::floor(place[axis] + 0.5), 0.0, double(count - 1));
    index = index * count + static_cast<std::size_t>(nearest);
  }
  const std::uint8_t label = mask.classification_of_label[mask.labels[index]];
  return label == Mask::hidden ? -1 : label;
}

double ReferenceMedium::variation(int label, double from, double to) const
{
  return this->Classes.empty() || label < 0 ? 0.0 : this->Classes[label].variation(from, to);
}

glm::dvec3 ReferenceMedium::colour(const ReferenceClasses& c,
  const glm::dvec3& place,
  double value,
  double magnitude) const
{
  switch (this->TheVolume.grid.colour)
  {
    case VoxelColour::Value:
      break;
    case VoxelColour::First:
      return c.colour(this->Values->value(place, 0), magnitude);
    case VoxelColour::RGB:
      return glm::dvec3(this->Values->value(place, 0),
               this->Values->value(place, 1),
               this->Values->value(place, 2)) /
             255.0;
  }
  return c.colour(value, magnitude);
}

glm::dvec3 ReferenceMedium::shaded(const glm::dvec3& place,
  const glm::dvec3& along,
  const glm::dvec3& gradient,
  const glm::dvec3& colour) const
{
  using scalar::Vec3;
  const glm::dvec3 normal = this->WorldFromGradient * gradient;
  const glm::dvec3 view = -glm::normalize(glm::dmat3(this->WorldFromIndex) * along);
  const glm::dvec3 world = glm::dvec3(this->WorldFromIndex * glm::dvec4(place, 1.0));
  const Vec3<double> lit = scalar::shade<double>(this->Shade,
    Vec3<double>{ normal.x, normal.y, normal.z },
    Vec3<double>{ view.x, view.y, view.z },
    Vec3<double>{ world.x, world.y, world.z },
    Vec3<double>{ colour.x, colour.y, colour.z });
  return { lit.x, lit.y, lit.z };
}

void ReferenceMedium::find_extinction(const glm::dvec3& place,
  bool wants_gradient,
  FoundMatter& found) const
{
  found.value = this->value(place);
  if (this->Classes.empty())
  {
    found.extinction = this->TheVolume.density.extinction * std::max(found.value, 0.0);
    return;
  }
  const ReferenceClasses& c = this->Classes[found.label];
  double magnitude = 0.0;
  if (c.two_dimensional())
  {
    found.gradient = this->Values->gradient(place);
    magnitude = c.magnitude(found.gradient);
  }
  found.extinction = c.extinction(found.value, magnitude);
  if (found.extinction > 0.0 && !c.two_dimensional() && (c.needs_gradient() || wants_gradient))
  {
    found.gradient = this->Values->gradient(place);
    found.extinction *= c.gradient_factor(c.magnitude(found.gradient));
  }
}

double ReferenceMedium::extinction(const glm::dvec3& place) const
{
  FoundMatter found;
  found.label = this->label(place);
  if (found.label >= 0)
  {
    this->find_extinction(place, false, found);
  }
  return found.extinction;
}

double ReferenceMedium::largest_extinction(double lower, double upper) const
{
  if (this->Classes.empty())
  {
    return this->TheVolume.density.extinction * std::max(upper, 0.0);
  }
  double largest = 0.0;
  for (const ReferenceClasses& c : this->Classes)
  {
    largest = std::max(largest, c.largest_extinction(lower, upper));
  }
  return largest;
}

FoundMatter ReferenceMedium::matter(const glm::dvec3& place) const
{
  FoundMatter found;
  found.label = this->label(place);
  if (found.label < 0)
  {
    return found;
  }
  this->find_extinction(place, this->Shade.enabled, found);
  if (!this->Classes.empty() && found.extinction > 0.0)
  {
    const ReferenceClasses& c = this->Classes[found.label];
    found.colour = this->colour(
      c, place, found.value, c.two_dimensional() ? c.magnitude(found.gradient) : 0.0);
  }
  return found;
}

Optical ReferenceMedium::at(const glm::dvec3& place, const glm::dvec3& along) const
{
  const FoundMatter found = this->matter(place);
  Optical result;
  result.extinction = found.extinction;
  if (this->Classes.empty() || found.extinction <= 0.0)
  {
    return result;
  }
  result.source = this->Shade.enabled
                    ? this->shaded(place, along, found.gradient, found.colour)
                    : found.colour;
  return result;
}

Tinted ReferenceMedium::surface(int label,
  const glm::dvec3& place,
  const glm::dvec3& along,
  double value) const
{
  const ReferenceClasses& c = this->Classes[label];
  const glm::dvec3 gradient = this->Values->gradient(place);
  const double magnitude = c.magnitude(gradient);
  Tinted result;
  result.opacity = c.opacity(value, magnitude) * c.gradient_factor(magnitude);
  result.colour = this->colour(c, place, value, magnitude);
  if (this->Shade.enabled)
  {
    result.colour = this->shaded(place, along, gradient, result.colour);
  }
  return result;
}

Tinted ReferenceMedium::projected(int label, const glm::dvec3& place, double value) const
{
  const ReferenceClasses& c = this->Classes[label];
  const double magnitude = c.two_dimensional() ? c.magnitude(this->Values->gradient(place)) : 0.0;
  return { c.opacity(value, magnitude), this->colour(c, place, value, magnitude) };
}

double ReferenceMedium::projected_opacity(int label, const glm::dvec3& place) const
{
  const ReferenceClasses& c = this->Classes[label];
  const double magnitude = c.two_dimensional() ? c.magnitude(this->Values->gradient(place)) : 0.0;
  return c.opacity(this->value(place), magnitude);
}

}
