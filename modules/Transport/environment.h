// Pictures of light from all around, and directional lights in their place.
#pragma once

#include "Transport/scene.h"

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <vector>

namespace brume
{

/// Radiance from all directions as a latitude–longitude picture. In the map's own frame z is up:
/// the last row is around +z, the first around −z; the middle column lies toward +y, what is right
/// of it toward +x, as one sees it from inside.
struct EnvironmentMap
{
  int width = 0;  ///< pixels round the horizon
  int height = 0; ///< pixels from pole to pole
  /// R, G, B, linear, rows from the bottom up; 3 · width · height. Values that are negative or not
  /// finite count as 0.
  std::vector<float> rgb;
};

/// A map and its frame in the world, a rotation.
struct PlacedEnvironment
{
  EnvironmentMap map;
  glm::dmat3 world_from_map{ 1.0 };
};

/// The direction from the scene toward a place of the picture, in the map's frame: a unit vector.
/// x from 0 at the left edge to `width`, y from 0 at the lower edge to `height`; a pixel's middle
/// is at its number + ½.
glm::dvec3 environment_direction(double x, double y, int width, int height);

/// The solid angle of a pixel of a row, in steradian: 2π / width · (sin of the upper edge's
/// latitude − sin of the lower's). All pixels together are 4π.
double environment_solid_angle(int row, int width, int height);

/// The map's frame in the world: its z along `up` (a unit vector) by the shortest turn from z,
/// after a turn by `degrees` about z by the right hand.
glm::dmat3 world_from_environment(const glm::dvec3& up, double degrees);

/// At most `count` directional lights that together have all the map's irradiance Σ L Δω, channel
/// by channel. The picture is cut in two where both parts have the same energy (luminance times
/// solid angle), across its longer side on the sphere; then the part of most energy likewise, until
/// there are `count`. Each becomes a light from the middle of its energy. Parts without light (less
/// than 10⁻¹² of all) give none. Source: Debevec, A median cut algorithm for light probe sampling,
/// SIGGRAPH posters 2005; there all parts are cut the same number of times, which gives powers of
/// two.
///
/// Throws std::invalid_argument for a map without pixels or with another number of values, and for
/// a count below 1.
std::vector<Light> environment_lights(const EnvironmentMap& map,
  int count,
  const glm::dmat3& world_from_environment = glm::dmat3(1.0));

}
