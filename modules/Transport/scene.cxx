#include "Transport/scene.h"

#include "Transport/fog.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace brume
{

namespace
{

void require(bool condition, const char* otherwise)
{
  if (!condition)
  {
    throw std::invalid_argument(otherwise);
  }
}

/// Whether all numbers of a matrix and of its inverse are finite, with room for their products: a
/// singular one has no inverse.
bool is_invertible(const glm::dmat4& m)
{
  constexpr double most = 1e60;
  const glm::dmat4 inverse = glm::inverse(m);
  for (int column = 0; column < 4; ++column)
  {
    for (int row = 0; row < 4; ++row)
    {
      if (!(std::abs(m[column][row]) < most && std::abs(inverse[column][row]) < most))
      {
        return false;
      }
    }
  }
  return glm::determinant(m) != 0.0;
}

void validate(const Classification& c, const Grid& grid)
{
  if (!c.value_gradient.empty())
  {
    require(
      c.value_gradient_width >= 2 &&
        c.value_gradient.size() % (4 * static_cast<std::size_t>(c.value_gradient_width)) == 0 &&
        c.value_gradient.size() >= 8 * static_cast<std::size_t>(c.value_gradient_width),
      "a transfer function of value and gradient needs whole rows of 2 nodes and more, and 2 rows");
    require(c.opacity.empty() && c.rgb.empty() && c.gradient_opacity.empty(),
      "a transfer function of value and gradient takes the place of the others");
    require(c.lower < c.upper, "a transfer function's range must not be empty");
    require(c.unit_distance > 0.0, "the opacity unit distance must be positive");
    require(c.gradient_upper > 0.0, "the largest gradient of a transfer function must be positive");
    require(grid.colour == VoxelColour::Value,
      "a transfer function of value and gradient gives the colour: the voxels cannot have theirs");
    return;
  }
  require(c.opacity.size() >= 2 &&
            (grid.colour == VoxelColour::RGB || c.rgb.size() == 3 * c.opacity.size()),
    "a transfer function needs at least 2 nodes, and as many colours");
}

void validate(const Medium& medium, const Grid& grid)
{
  const auto fraction = [](double v) { return v >= 0.0 && v <= 1.0; };
  const auto finite = [](double v) { return v >= 0.0 && std::isfinite(v); };
  const Octaves& octaves = medium.octaves;
  require(octaves.count >= 1 && octaves.count <= most_octaves, "a medium has 1 to 16 octaves");
  require(fraction(octaves.attenuation) && fraction(octaves.contribution) &&
      fraction(octaves.anisotropy) && octaves.contribution <= octaves.attenuation,
    "octaves need an attenuation, contribution and anisotropy from 0 to 1, and a contribution of no "
    "more than the attenuation: more would make light from nothing");
  for (int c = 0; c < 3; ++c)
  {
    require(fraction(medium.albedo[c]), "an albedo must be from 0 to 1");
    require(finite(medium.emission[c]), "emission must be finite and not negative");
  }
  for (const PhaseLobe& lobe : medium.lobes)
  {
    require(finite(lobe.weight), "a lobe's weight must be finite and not negative");
  }
  require(finite(medium.black_body), "the scale of black bodies must be finite and not negative");
  const Grid& temperature = medium.temperature;
  if (medium.black_body > 0.0 && temperature.voxels)
  {
    temperature.validate();
    require(!grid.sparse && temperature.type != VoxelType::Float16 &&
        std::equal(grid.dims, grid.dims + 3, temperature.dims),
      "temperatures must be a dense grid of the same size as their volume's");
  }
}

void validate(const Volume& volume)
{
  volume.grid.validate();
  if (volume.medium.lit)
  {
    validate(volume.medium, volume.grid);
  }
  require(volume.weight >= 0.0 && std::isfinite(volume.weight),
    "a volume's weight must be finite and not negative");
  if (volume.meaning == ValueMeaning::Density)
  {
    require(volume.grid.components == 1, "a density is a grid of one component");
    require(volume.density.extinction >= 0.0 && std::isfinite(volume.density.extinction),
      "the extinction must be finite and not negative");
    for (int c = 0; c < 3; ++c)
    {
      require(volume.density.channels[c] >= 0.0 && volume.density.channels[c] <= 1.0,
        "each channel of a density has from 0 to 1 of the extinction");
    }
    return;
  }
  validate(volume.classification, volume.grid);
  for (const Classification& c : volume.label_classifications)
  {
    validate(c, volume.grid);
  }
  if (volume.mask.labels)
  {
    require(!volume.grid.sparse, "a sparse grid cannot have a mask");
    for (std::uint8_t n : volume.mask.classification_of_label)
    {
      require(n == Mask::hidden || n <= volume.label_classifications.size(),
        "a label of the mask is drawn with a classification that is not there");
    }
  }
}

}

void Scene::validate() const
{
  require(
    !this->volumes.empty() || has_fog(*this), "a scene needs a volume, or fog in composite mode");
  require(is_invertible(this->camera.clip_from_world),
    "the camera's matrix must be finite and invertible, its numbers below 1e60: place the camera apart from its focal point, and "
    "the near plane before the far one");
  for (const Volume& volume : this->volumes)
  {
    brume::validate(volume);
    const glm::dmat4 world_from_index = volume.world_from_data * volume.data_from_index;
    require(is_invertible(volume.data_from_index) && is_invertible(world_from_index) &&
        is_invertible(this->camera.clip_from_world * world_from_index),
      "the matrices of a volume must be finite and invertible, their numbers below 1e60: its spacing and the scale of its prop "
      "must not be 0");
    require(this->blend_mode == BlendMode::Composite || volume.meaning == ValueMeaning::Classified,
      "a density can only be drawn by emission and absorption: classify it");
  }
  for (double value : this->isosurfaces)
  {
    require(std::isfinite(value), "the value of an isosurface must be finite");
  }
  require(this->blend_mode != BlendMode::Slice ||
            (glm::dot(glm::dvec3(this->slice), glm::dvec3(this->slice)) > 0.0 &&
              std::isfinite(glm::dot(this->slice, this->slice))),
    "the plane of a slice needs a normal and finite numbers");
}
bool Cropping::draws(const glm::dvec3& place) const
{
  int region = 0;
  for (int axis = 2; axis >= 0; --axis)
  {
    const int side = place[axis] < this->lower[axis] ? 0 : place[axis] > this->upper[axis] ? 2 : 1;
    region = 3 * region + side;
  }
  return (this->regions >> region & 1u) != 0;
}

}
