// Optical properties of one volume at a place, in double precision. Internal to Transport.
#pragma once

#include "Transport/bricks.h"
#include "Transport/reference_classes.h"
#include "Transport/reference_grid.h"
#include "Transport/scene.h"
#include "Transport/shading.h"

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <memory>
#include <vector>

namespace brume
{

/// Extinction and source at a place.
struct Optical
{
  double extinction = 0.0; ///< per unit of the data's length; without Volume::weight
  glm::dvec3 source{ 0.0 };
};

/// What is at a place, before any light.
struct FoundMatter
{
  int label = -1; ///< see ReferenceMedium::label; 0 where there is no mask
  double value = 0.0;
  double extinction = 0.0;     ///< per unit of the data's length; without Volume::weight
  glm::dvec3 colour{ 1.0 };    ///< 1 for densities
  glm::dvec3 gradient{ 0.0 };  ///< index space; where shading or the functions ask for it
};

/// Opacity, of no length, and colour.
struct Tinted
{
  double opacity = 0.0;
  glm::dvec3 colour{ 0.0 };
};

/// All places are in the volume's index space; `along` is the ray's direction there.
class ReferenceMedium
{
public:
  /// Keeps references to both. How a non-finite voxel is read depends on the scene's blend mode.
  ReferenceMedium(const Scene& scene, const Volume& volume);

  const Volume& volume() const { return this->TheVolume; }

  /// Whether anything can be seen in the brick that holds the place. Only a way to save time: what
  /// cannot be seen has no extinction.
  bool visible(const glm::dvec3& place) const;
  const BrickRanges& ranges() const { return *this->Ranges; }
  /// What stands in for voxels that are not finite.
  double empty_value() const { return this->EmptyValue; }
  /// An upper bound of matter().extinction over all places where the value is in a range.
  double largest_extinction(double lower, double upper) const;
  /// Bounds of the values in the brick that holds the place.
  void range(const glm::dvec3& place, double& lower, double& upper) const;

  /// The value at a place, as interpolation gives it.
  double value(const glm::dvec3& place) const;
  /// The value that projections add up: the voxel's first component where its colour is its own.
  double grey_value(const glm::dvec3& place) const;

  /// What the mask has at a place: the number of the classification, or −1 for what it hides.
  int label(const glm::dvec3& place) const;
  /// See ReferenceClasses. 0 for densities.
  double variation(int label, double from, double to) const;

  /// With the gradient's factor. Nothing where the mask hides.
  FoundMatter matter(const glm::dvec3& place) const;
  /// The extinction of matter() alone.
  double extinction(const glm::dvec3& place) const;
  /// With the gradient's factor, and shaded. Nothing where the mask hides.
  Optical at(const glm::dvec3& place, const glm::dvec3& along) const;
  /// What is drawn of a surface through the place where the value is `value`: with the gradient's
  /// factor, and shaded.
  Tinted surface(int label, const glm::dvec3& place, const glm::dvec3& along, double value) const;
  /// What is drawn of the value `value`, found at the place: neither.
  Tinted projected(int label, const glm::dvec3& place, double value) const;
  /// The opacity that projections multiply a value at the place with.
  double projected_opacity(int label, const glm::dvec3& place) const;

  /// Whether the values are a density's.
  bool is_density() const { return this->Classes.empty(); }
  const glm::dmat3& world_from_gradient() const { return this->WorldFromGradient; }
  const ShadeModel& shade() const { return this->Shade; }

private:
  std::size_t brick(const glm::dvec3& place) const;
  /// Of a place that is not hidden: value, extinction, gradient.
  void find_extinction(const glm::dvec3& place, bool wants_gradient, FoundMatter& found) const;
  glm::dvec3 colour(const ReferenceClasses& c,
    const glm::dvec3& place,
    double value,
    double magnitude) const;
  glm::dvec3 shaded(const glm::dvec3& place,
    const glm::dvec3& along,
    const glm::dvec3& gradient,
    const glm::dvec3& colour) const;

  const Volume& TheVolume;
  ShadeModel Shade;
  std::vector<ReferenceClasses> Classes; ///< the volume's, then the labels'; none for a density
  std::shared_ptr<const BrickRanges> Ranges;
  VisibleBricks Bricks;
  std::unique_ptr<ReferenceGrid> Values;
  double EmptyValue = 0.0;
  glm::dmat4 WorldFromIndex{ 1.0 };
  glm::dmat3 WorldFromGradient{ 1.0 };
};

}
