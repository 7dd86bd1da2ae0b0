// A light as a place in a medium has it, in double precision. Internal to Transport.
#pragma once

#include "Transport/scene.h"
#include "Transport/shading.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>

namespace brume
{

class Lamp
{
public:
  /// The light is kept by reference.
  explicit Lamp(const Light& light)
    : TheLight(&light)
    , AtOrigin(prepare_light(light))
  {
    std::fill(this->AtOrigin.position, this->AtOrigin.position + 3, 0.0f);
  }

  const Light& light() const { return *this->TheLight; }
  bool is_positional() const { return this->TheLight->positional; }

  /// A place of the world as the following take it: single precision there does not blur the light's
  /// place.
  glm::dvec3 offset(const glm::dvec3& world) const
  {
    return this->is_positional() ? world - this->TheLight->position : world;
  }
  /// Along which light travels there: a unit vector, or 0 in the lamp itself.
  glm::dvec3 travel(const glm::dvec3& offset) const
  {
    const glm::dvec3 along = this->is_positional() ? offset : this->TheLight->direction;
    const double length = glm::length(along);
    return length > 0.0 ? along / length : glm::dvec3(0.0);
  }
  /// Unshadowed, on a plane that faces the light.
  glm::dvec3 irradiance(const glm::dvec3& offset) const
  {
    constexpr double pi = 3.14159265358979323846;
    const double strength =
      scalar::incidence<double>(this->AtOrigin, { offset.x, offset.y, offset.z }).strength;
    return pi * strength * this->TheLight->diffuse;
  }

private:
  const Light* TheLight;
  ShadeLight AtOrigin;
};

}
