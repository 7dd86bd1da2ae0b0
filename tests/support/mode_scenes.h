// Scenes whose values are known everywhere, for the tests of blend modes, masks and cuts.
#pragma once

#include "transport_scenes.h"

#include "Transport/reference.h"

#include <glm/matrix.hpp>

#include <array>
#include <functional>
#include <utility>

namespace transport_scenes
{

inline Film reference(const Scene& scene, int width, int height, double tolerance = 1e-6)
{
  Film film(width, height);
  ReferenceSettings settings;
  settings.tolerance = tolerance;
  render_reference(scene, settings, film);
  return film;
}

/// (x − a)(y − b)(z − c) of a place in index space: trilinear interpolation keeps it exactly.
struct Product
{
  glm::dvec3 roots{ 3.3, 2.1, 4.7 };
  double operator()(const glm::dvec3& p) const
  {
    return (p.x - roots.x) * (p.y - roots.y) * (p.z - roots.z);
  }
};

/// A grid of floats that holds a function of the place exactly, if the function is trilinear.
template <class Function>
Voxels<float> voxels_of(int nx, int ny, int nz, const Function& f)
{
  return Voxels<float>(nx, ny, nz, [&](int i, int j, int k) { return f(glm::dvec3(i, j, k)); });
}

/// A pixel's ray through one volume's box: index space at both ends, and lengths.
struct Chord
{
  glm::dvec3 begin{ 0.0 };
  glm::dvec3 end{ 0.0 };
  double length = 0.0;    ///< data units; 0 for a miss
  double from_near = 0.0; ///< world units from the near plane to `begin`
  double world = 0.0;     ///< world units from `begin` to `end`
};

inline Chord chord(const View& view, const Volume& volume, int x, int y, int width, int height)
{
  long double b[3], e[3];
  view.ray(x, y, width, height, b, e);
  const glm::dmat4 world_from_index = volume.world_from_data * volume.data_from_index;
  const glm::dmat4 index_from_world = glm::inverse(world_from_index);
  const auto to_index = [&](const long double p[3])
  {
    return glm::dvec3(
      index_from_world *
      glm::dvec4(glm::dvec3(double(p[0]), double(p[1]), double(p[2])) + view.centre, 1.0));
  };
  const glm::dvec3 from = to_index(b);
  const glm::dvec3 along = to_index(e) - from;
  double s0 = 0.0;
  double s1 = 1.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double l = (volume.grid.lower(axis) - from[axis]) / along[axis];
    const double u = (volume.grid.upper(axis) - from[axis]) / along[axis];
    s0 = std::max(s0, std::min(l, u));
    s1 = std::min(s1, std::max(l, u));
  }
  Chord result;
  if (!(s0 < s1))
  {
    return result;
  }
  result.begin = from + along * s0;
  result.end = from + along * s1;
  result.length = glm::length(glm::dmat3(volume.data_from_index) * (along * (s1 - s0)));
  const double whole = glm::length(glm::dmat3(world_from_index) * along);
  result.from_near = s0 * whole;
  result.world = (s1 - s0) * whole;
  return result;
}

/// A box of one classified value: opacity and colour everywhere the same.
struct Block
{
  Voxels<std::uint8_t> voxels;

  explicit Block(int n = 9)
    : voxels(n, n, n, [](int, int, int) { return 100; })
  {
  }

  Volume volume(double opacity, const glm::dvec3& colour, double unit_distance = 1.0) const
  {
    Volume v;
    v.grid = voxels.grid();
    v.classification = classify(
      0.0, 200.0, [=](double) { return opacity; }, [=](double) { return colour; }, 3);
    v.classification.unit_distance = unit_distance;
    return v;
  }
};

/// The middle pixel of a picture with odd edges.
inline std::size_t middle(const Film& film)
{
  return film.size() / 2;
}

}
