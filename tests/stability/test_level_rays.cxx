// Hard cases of single rays: along axes, faces, edges and corners, grazing, touching, hardly
// moving.
#include "ray_integrators.h"
#include "ray_mappers.h"

#include "Transport/reference.h"

#include <gtest/gtest.h>

#include <initializer_list>
#include <limits>

using namespace stability;
using brume_tests::HardCase;

namespace
{

/// A ramp that differs along every axis.
RampRay ramp()
{
  RampRay ray;
  ray.density = 1.0;
  ray.slope = { 0.0625, -0.03125, 0.046875 };
  return ray;
}

/// Both ways along each axis, at a fraction of the other two edges.
template <class Use>
void along_axes(RampRay ray, const glm::dvec2& fraction, const Use& use)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    const int b = (axis + 1) % 3;
    const int c = (axis + 2) % 3;
    for (const bool back : { false, true })
    {
      ray.from[b] = ray.to[b] = ray.lower() + fraction.x * (ray.upper(b) - ray.lower());
      ray.from[c] = ray.to[c] = ray.lower() + fraction.y * (ray.upper(c) - ray.lower());
      ray.from[axis] = back ? 32.0 : -32.0;
      ray.to[axis] = -ray.from[axis];
      ray.name = std::string(back ? "-" : "+") + "xyz"[axis];
      use(ray);
    }
  }
}

}

TEST(LevelRays, ParallelToAnAxis)
{
  HardCase axis("Rays",
    "parallel to an axis",
    "two of three slab tests divide by 0, and a walk from cell to cell never crosses two of three "
    "kinds of "
    "planes",
    "the closed form, and no cell is read more often than any other");
  along_axes(ramp(), { 0.3, 0.7 }, [&](const RampRay& ray) { measure_ray(axis, ray); });
}

TEST(LevelRays, InAPlaneOfVoxels)
{
  HardCase plane("Rays",
    "in a plane of voxels, and along a line of them",
    "a ray that stands on the border of two cells and does not move off it is in both",
    "the closed form, and no cell is read more often than any other");
  // Edges of 8, 6 and 10 cells: halves are voxels, an eighth is none.
  along_axes(ramp(), { 0.5, 0.5 }, [&](const RampRay& ray) { measure_ray(plane, ray); });
  along_axes(ramp(), { 0.5, 0.3 }, [&](const RampRay& ray) { measure_ray(plane, ray); });
}

TEST(LevelRays, InAFace)
{
  HardCase face("Rays",
    "in a face of the box",
    "the box is closed: 0 ≤ 0 must count as inside at its lower and its upper end",
    "all of the way counts as inside, and the closed form holds");
  for (const double side : { 0.0, 1.0 })
  {
    along_axes(ramp(), { side, 0.4 }, [&](const RampRay& ray) { measure_ray(face, ray); });
    along_axes(ramp(), { 0.6, side }, [&](const RampRay& ray) { measure_ray(face, ray); });
  }
}

TEST(LevelRays, AlongAnEdge)
{
  HardCase edge("Rays",
    "along an edge of the box",
    "in two faces at once",
    "all of the way counts as inside, and the closed form holds");
  for (const double first : { 0.0, 1.0 })
  {
    for (const double second : { 0.0, 1.0 })
    {
      along_axes(ramp(), { first, second }, [&](const RampRay& ray) { measure_ray(edge, ray); });
    }
  }
}

TEST(LevelRays, ThroughCorners)
{
  HardCase corner("Rays",
    "from corner to corner",
    "three planes are crossed at once, at both ends and at voxels between",
    "the closed form; no cell is passed over or read again");
  for (const glm::ivec3& dims : { glm::ivec3(9, 9, 9), glm::ivec3(9, 7, 11), glm::ivec3(5, 9, 3) })
  {
    for (int number = 0; number < 8; ++number)
    {
      RampRay ray = ramp();
      ray.dims = dims;
      glm::dvec3 first;
      glm::dvec3 last;
      for (int axis = 0; axis < 3; ++axis)
      {
        const bool up = number >> axis & 1;
        first[axis] = up ? 0.0 : ray.upper(axis);
        last[axis] = up ? ray.upper(axis) : 0.0;
      }
      ray.from = first - (last - first) * 0.5;
      ray.to = last + (last - first) * 0.5;
      ray.name = "diagonal " + std::to_string(number);
      measure_ray(corner, ray);
    }
  }
}

TEST(LevelRays, OnlyTouches)
{
  HardCase touch("Rays",
    "a ray that only touches an edge or a corner, or cuts off a hair",
    "where it enters is where it leaves, or a rounding beyond",
    "what is not on the way does not dim: the closed form of the chord, however short");
  for (const double inward : { 0.0, 1e-15, 1e-12, 1e-9, 1e-6, 1e-3, -1e-15, -1e-12, -1e-9, -1e-3 })
  {
    RampRay ray = ramp();
    ray.name = "edge, " + std::to_string(inward * 1e15) + "e-15 inward";
    // Across the edge x = y = 0 at 45°, `inward` into the box.
    ray.from = { -4.0 + inward, 4.0 + inward, 3.3 };
    ray.to = { 4.0 + inward, -4.0 + inward, 3.3 };
    measure_ray(touch, ray);
    // Across the corner (8, 6, 10).
    ray.name = "corner, " + std::to_string(inward * 1e15) + "e-15 inward";
    const glm::dvec3 corner = glm::dvec3(8.0, 6.0, 10.0) - inward;
    ray.from = corner + glm::dvec3(-4.0, 2.0, 2.0);
    ray.to = corner - glm::dvec3(-4.0, 2.0, 2.0);
    measure_ray(touch, ray);
  }
}

TEST(LevelRays, Grazing)
{
  HardCase grazing("Rays",
    "grazing a face at a slope of 1e-2 to 1e-15",
    "where the ray crosses the face is the ratio of two small numbers",
    "the closed form of the chord; light that comes along within 1e-5 voxels of the face, or of "
    "half a node of a light volume, may have come in it");
  for (double slope = 1e-2; slope > 1e-16; slope *= 0.03)
  {
    for (const bool in : { true, false })
    {
      RampRay ray = ramp();
      ray.blur_of_nodes = 0.1; // they know of the face by a node on either side
      ray.name =
        (in ? "from the face in, " : "from within out, ") + std::to_string(slope * 1e9) + "e-9";
      // Through (4, 0, ·) of the face y = 0: half of the way is outside.
      ray.from = { -12.0, (in ? -16.0 : 16.0) * slope, 4.25 };
      ray.to = { 20.0, (in ? 16.0 : -16.0) * slope, 4.25 };
      if (in)
      {
        // As though the light came in the face from x = 0 on, not 4.
        RampRay face = ray;
        face.from = { 0.0, 0.0, 4.25 };
        face.to = { 4.0, 0.0, 4.25 };
        ray.shade_of_nodes = face.optical_depth();
        ray.shade = slope < 2e-6 ? ray.shade_of_nodes : 0.0;
      }
      measure_ray(grazing, ray);
    }
  }
}

TEST(LevelRays, BesideAPlane)
{
  HardCase beside("Rays",
    "beside a plane of voxels, from 1e-3 to 1e-16 of a voxel away, and at such slopes across it",
    "in single precision the ray is in the plane; it may take one side or the other from cell to "
    "cell",
    "the closed form, and no cell is read more often than any other");
  for (double away = 1e-3; away > 1e-17; away *= 0.01)
  {
    for (const double side : { -1.0, 1.0 })
    {
      RampRay ray = ramp();
      ray.name = std::to_string(side * away * 1e12) + "e-12";
      ray.from = { -32.0, 3.0 + side * away, 4.25 };
      ray.to = { 32.0, 3.0 + side * away, 4.25 };
      measure_ray(beside, ray);
      ray.name += ", across";
      ray.to.y = 3.0 - side * away;
      measure_ray(beside, ray);
    }
  }
}

TEST(LevelRays, NegativeZeros)
{
  HardCase zeros("Rays",
    "−0 among directions and places",
    "1 / −0 is −∞: the near and the far face change places",
    "the same as with +0");
  // Mirrored axes make −0 of 0 in the matrices; cells, so that the plane of zeros is within.
  for (int mirrored = 0; mirrored < 8; ++mirrored)
  {
    RampRay ray;
    ray.cells = true;
    ray.name = "mirrored " + std::to_string(mirrored);
    for (int axis = 0; axis < 3; ++axis)
    {
      ray.data_from_index[axis][axis] = mirrored >> axis & 1 ? -1.0 : 1.0;
    }
    for (int axis = 0; axis < 3; ++axis)
    {
      for (const double zero : { 0.0, -0.0 })
      {
        ray.from = ray.to = glm::dvec3(zero);
        ray.from[axis] = -32.0;
        ray.to[axis] = 32.0;
        measure_ray(zeros, ray);
        std::swap(ray.from, ray.to);
        measure_ray(zeros, ray);
      }
    }
  }
}

TEST(LevelRays, HardlyMoving)
{
  HardCase tiny("Rays",
    "a direction that is near zero or denormal along an axis: 1e-12 to 5e-324 of the way",
    "its inverse overflows single precision, then double",
    "the same as standing still, and as a vtkCamera's unit vectors have it, which keep no less than "
    "1e-16");
  constexpr double least = std::numeric_limits<double>::denorm_min();
  for (const double slope : { 1e-12, 1e-18, 1e-30, 1.1e-38, 1e-42, 1e-45, 1e-300, 1e-310, least })
  {
    for (const double side : { -1.0, 1.0 })
    {
      RampRay ray;
      ray.cells = true; // the plane of zeros, where such a slope survives, is within
      ray.name = std::to_string(std::log10(slope)) + " decades";
      ray.from = { -32.0, 0.0, 0.0 };
      ray.to = { 32.0, side * slope, -side * slope };
      measure_ray(tiny, ray);
      std::swap(ray.from, ray.to);
      measure_ray(tiny, ray);
    }
  }
}

TEST(LevelRays, ShortRays)
{
  HardCase brief("Rays",
    "rays of 1 to 1e-9 voxels between near and far plane, inside matter",
    "the way is the difference of two places that are nearly the same",
    "the closed form of the way between the planes");
  for (double length = 1.0; length > 1e-10; length *= 0.1)
  {
    RampRay ray = ramp();
    ray.name = std::to_string(length * 1e9) + "e-9 voxels";
    ray.from = { 3.1, 4.2, 5.3 };
    ray.to = ray.from + length * glm::normalize(glm::dvec3(1.0, -2.0, 0.5));
    measure_ray(brief, ray);
  }
}

TEST(LevelRays, BetweenNearestVoxels)
{
  // Not a ramp: layers of 1 and 0, nearest voxel, a ray in the plane where the nearest changes.
  HardCase between("Rays",
    "in the plane where the nearest voxel changes",
    "both voxels are as near: rounding decides",
    "one of the two all the way or by parts, never a third value; finite, and not read more often");
  for (const double away : { 0.0, 1e-16, -1e-16, 1e-9, -1e-9 })
  {
    RampRay ray;
    ray.from = { -32.0, 2.5 + away, 4.25 };
    ray.to = { 32.0, 2.5 + away, 4.25 };
    RampScene scene(ray);
    for (int i = 0; i < 9 * 7 * 11; ++i)
    {
      scene.voxels->values[i] = i / 9 % 7 == 3 ? 1.0f : 0.0f;
    }
    scene.scene.volumes[0].grid.linear = false;
    const double full = std::exp(-1.0);
    const auto see = [&](const Film& film, const std::string& by)
    {
      const double t = film.transmittance[0][0];
      between.holds(t >= full - 1e-6 && t <= 1.0, "between the two voxels' pictures", by);
    };
    Film film(1, 1);
    render_reference(scene.scene, {}, film);
    see(film, "reference");
    for (const NamedMapper& one : new_mappers(0.37))
    {
      see(MapperScene(one.mapper, scene.scene, vtk_camera(ray.from, ray.to)).film(1), one.name);
    }
    for (const std::string& target : targets())
    {
      ASSERT_TRUE(force_simd_target(target));
      for (const StepRule rule : { StepRule::Midpoint, StepRule::Cells })
      {
        MarchSettings settings;
        settings.rule = rule;
        settings.step = 0.37;
        settings.leave_error = 0.0;
        Marcher marcher;
        const MarchStatistics statistics = marcher.render(scene.scene, settings, film);
        see(film, step_rule_name(rule));
        between.measure(
          static_cast<double>(statistics.samples), 40.0, "reads", step_rule_name(rule));
      }
      force_simd_target("");
    }
  }
}
