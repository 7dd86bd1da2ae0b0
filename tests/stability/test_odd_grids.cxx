// Hard cases of grids and their places: thin ones, tiny and huge spacing, sheared and mirrored
// matrices, far origins.
#include "ray_integrators.h"
#include "ray_mappers.h"

#include "Transport/path_tracer.h"
#include "Transport/reference.h"

#include <gtest/gtest.h>

#include <random>

using namespace stability;
using brume_tests::HardCase;

namespace
{

/// Rays every which way through the box, the same in each run.
template <class Use>
void through_box(RampRay ray, int count, const Use& use)
{
  std::mt19937 random(7);
  std::uniform_real_distribution<double> in(0.05, 0.95);
  std::normal_distribution<double> any;
  for (int i = 0; i < count; ++i)
  {
    glm::dvec3 place(0.0);
    glm::dvec3 way(0.0);
    for (int axis = 0; axis < 3; ++axis)
    {
      place[axis] = ray.lower() + in(random) * (ray.upper(axis) - ray.lower());
      way[axis] = any(random);
    }
    way = glm::normalize(way) * 64.0;
    ray.from = place - way;
    ray.to = place + way;
    ray.name = "ray " + std::to_string(i);
    use(ray);
  }
}

RampRay ramp()
{
  RampRay ray;
  ray.slope = { 0.0625, -0.03125, 0.046875 };
  return ray;
}

/// An extinction such that a voxel diagonal's mean has the depth ¼, whatever the matrix.
void set_extinction(RampRay& ray)
{
  double sum = 0.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    sum += glm::length(glm::dvec3(ray.data_from_index[axis]));
  }
  ray.extinction = 0.375 / sum;
}

}

TEST(OddGrids, OneVoxelThick)
{
  HardCase thin("Rays",
    "volumes one voxel thick",
    "there is no second voxel to interpolate with, and a box of points has no thickness at all",
    "cells: the closed form; points: in the plane the closed form, across it nothing is dimmed");
  for (int axis = 0; axis < 3; ++axis)
  {
    RampRay ray;
    ray.cells = true;
    ray.dims[axis] = 1;
    through_box(ray, 4, [&](const RampRay& one) { measure_ray(thin, one); });
    ray.cells = false;
    through_box(ray, 2, [&](const RampRay& one) { measure_ray(thin, one); });
    // In the plane of points.
    ray.from = glm::dvec3(-20.0, -14.0, -31.0);
    ray.to = glm::dvec3(31.0, 24.0, 45.0);
    ray.from[axis] = ray.to[axis] = 0.0;
    ray.name = "in the plane across " + std::string(1, "xyz"[axis]);
    measure_ray(thin, ray);
  }
}

TEST(OddGrids, Columns)
{
  HardCase column("Rays",
    "columns of 1 × 1 × N voxels, and a single voxel",
    "two axes without a second voxel; the walk is along the third alone",
    "the closed form");
  for (const glm::ivec3& dims :
    { glm::ivec3(1, 1, 24), glm::ivec3(1, 24, 1), glm::ivec3(24, 1, 1), glm::ivec3(1, 1, 1) })
  {
    RampRay ray;
    ray.dims = dims;
    ray.cells = true;
    through_box(ray, 4, [&](const RampRay& one) { measure_ray(column, one); });
    ray.from = { 0.0, 0.0, 0.0 };
    ray.to = glm::dvec3(dims) - 1.0;
    ray.name = "along it";
    if (dims != glm::ivec3(1))
    {
      measure_ray(column, ray);
    }
  }
}

TEST(OddGrids, TinyAndHugeSpacing)
{
  HardCase spacing("Rays",
    "spacing of 1e-6 and 1e6",
    "lengths, extinctions and steps are far from 1; sums of both scales lose one of them",
    "the same picture as with a spacing of 1, but for rounding");
  for (const double edge : { 1e-6, 1e-3, 1e3, 1e6 })
  {
    RampRay ray = ramp();
    ray.data_from_index = placed(glm::dvec3(edge), glm::dvec3(-3.0 * edge));
    set_extinction(ray);
    through_box(ray, 3, [&](const RampRay& one) { measure_ray(spacing, one); });
  }
}

TEST(OddGrids, UnevenSpacing)
{
  HardCase uneven("Rays",
    "spacing uneven by 1e4",
    "a step that is right along one axis is a thousand cells along another",
    "the closed form; reads by the cells on the way");
  for (int axis = 0; axis < 3; ++axis)
  {
    for (const double stretch : { 1e-4, 1e4 })
    {
      RampRay ray = ramp();
      ray.data_from_index[axis][axis] = stretch;
      set_extinction(ray);
      ray.blur_of_nodes =
        0.25; // nodes are as far apart along all axes as voxels are along the longest
      through_box(ray, 4, [&](const RampRay& one) { measure_ray(uneven, one, 2.0); });
    }
  }
}

// The fault that this was: no ray was given more than 2¹⁶ steps of the box's diagonal, so that rays
// across a sheet had fewer steps than it has layers.
TEST(OddGrids, WideSheets)
{
  HardCase sheet("Rays",
    "rays across a sheet that is 1e6 layers wide",
    "how many steps a ray may have is a matter of its own way, not of the box's diagonal",
    "the step that was asked for, and the reference's picture within 2e-3");
  const Voxels<float> voxels(5,
    5,
    33,
    [](int i, int j, int k) { return 100.0 * std::exp(-0.02 * (k - 16) * (k - 16)) + i - j; });
  Scene scene;
  Volume& volume = scene.volumes[0];
  volume.grid = voxels.grid();
  volume.data_from_index = placed(glm::dvec3(2.5e5, 2.5e5, 1.0), glm::dvec3(0.0));
  volume.meaning = ValueMeaning::Classified;
  volume.classification = classify(
    -4.0,
    104.0,
    [](double v) { return 1e-5 * std::max(v, 0.0) * std::max(v, 0.0); },
    [](double v) { return glm::dvec3(0.01 * v, 0.5, 1.0 - 0.01 * v); },
    4097);
  scene.camera = view_of(scene, glm::dvec3(0.3, 0.2, -1.0), true).camera(1.0);
  Film truth(5, 5);
  render_reference(scene, {}, truth);
  for (const std::string& target : targets())
  {
    ASSERT_TRUE(force_simd_target(target));
    for (const StepRule rule : { StepRule::Midpoint, StepRule::Integrated })
    {
      MarchSettings settings;
      settings.rule = rule;
      settings.step = 0.25;
      settings.leave_error = 0.0;
      Film film(5, 5);
      const MarchStatistics statistics = Marcher().render(scene, settings, film);
      sheet.measure(difference(film, truth), 2e-3, "of white", step_rule_name(rule));
      sheet.holds(statistics.step == settings.step, "steps as asked", step_rule_name(rule));
    }
    force_simd_target("");
  }
}

TEST(OddGrids, ShearedAndMirrored)
{
  HardCase sheared("Rays",
    "sheared and mirrored matrices, of the data and of the prop",
    "lengths along a ray are no longer those of index space, and orientation changes its sign",
    "the closed form, lengths in the data's own coordinates");
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(-0.6, 0.6);
  for (int i = 0; i < 10; ++i)
  {
    RampRay ray = ramp();
    for (int column = 0; column < 3; ++column)
    {
      for (int row = 0; row < 3; ++row)
      {
        ray.data_from_index[column][row] =
          (column == row ? (i >> column & 1 ? -1.0 : 1.0) : any(random));
        // Lit media measure angles in the world: there the matrix of the prop only turns and moves.
        ray.world_from_data[column][row] = 0.0;
      }
    }
    const double turn = 3.0 * any(random);
    ray.world_from_data =
      glm::rotate(placed(glm::dvec3(i % 2 ? -1.0 : 1.0, 1.0, 1.0), glm::dvec3(5.0, -7.0, 2.0)),
        turn,
        glm::dvec3(1, 2, 3));
    set_extinction(ray);
    through_box(ray, 1, [&](const RampRay& one) { measure_ray(sheared, one, 2.0); });
  }
}

namespace
{

/// A scene of bumps in lit matter whose world is moved by `away`, scaled in its extents; all that
/// has a place goes along.
struct FarScene
{
  Voxels<float> voxels{ 17, 15, 19, [](int i, int j, int k) {
                         return 1.0 +
                                std::sin(0.7 * i) * std::sin(0.6 * j + 1.0) * std::cos(0.5 * k);
                       } };
  Scene scene;
  View view;

  explicit FarScene(const glm::dvec3& away, double edge = 1.0)
  {
    Volume& volume = scene.volumes[0];
    volume.grid = voxels.grid();
    volume.data_from_index = placed(glm::dvec3(edge), away * edge);
    volume.meaning = ValueMeaning::Density;
    volume.density.extinction = 0.1 / edge;
    volume.medium.lit = true;
    volume.medium.albedo = { 0.9, 0.7, 0.5 };
    volume.medium.lobes = { { PhaseFunction::HenyeyGreenstein, 1.0, 0.4 } };
    Light sun;
    sun.direction = glm::normalize(glm::dvec3(0.3, -0.8, -0.5));
    Light lamp;
    lamp.positional = true;
    lamp.position = (away + glm::dvec3(22.0, 6.0, 8.0)) * edge;
    lamp.attenuation = { 1.0, 0.0, 0.01 / (edge * edge) };
    scene.lights = { sun, lamp };
    view = view_of(scene, glm::dvec3(-0.4, 0.5, -0.8), false);
    scene.camera = view.camera(1.0);
  }
};

}

TEST(OddGrids, FarOrigins)
{
  HardCase far("Rays",
    "origins 1e7 extents away",
    "the matrix holds two numbers that differ by seven digits more than the picture shows; single "
    "precision "
    "would see one voxel",
    "all is moved together, and the picture stays within 2e-5 of white; paths within their noise");
  const FarScene near(glm::dvec3(0.0));
  const auto marched = [&](const Scene& scene, ShadowMethod shadows)
  {
    Film film(16, 16);
    MarchSettings settings;
    settings.step = 0.5;
    settings.leave_error = 0.0;
    settings.shadows = shadows;
    settings.precise_shadows = true;
    Marcher marcher;
    marcher.render(scene, settings, film);
    return film;
  };
  const auto reference = [&](const Scene& scene)
  {
    Film film(8, 8);
    ReferenceSettings settings;
    settings.tolerance = 1e-4;
    render_reference(scene, settings, film);
    return film;
  };
  PathSettings paths;
  paths.samples_per_pixel = 64;
  const auto traced = [&](const Scene& scene)
  {
    Film film(8, 8);
    PathTracer tracer;
    tracer.render(scene, paths, film);
    return film;
  };
  for (const double extents : { 1e3, 1e5, 1e7 })
  {
    const FarScene moved(glm::dvec3(18.0, -18.0, 18.0) * extents);
    for (const std::string& target : targets())
    {
      ASSERT_TRUE(force_simd_target(target));
      for (const ShadowMethod shadows : { ShadowMethod::Rays, ShadowMethod::Volume })
      {
        far.measure(difference(marched(near.scene, shadows), marched(moved.scene, shadows)),
          2e-5,
          "of white",
          std::string("shadow ") + shadow_method_name(shadows));
      }
      force_simd_target("");
    }
    far.measure(
      difference(reference(near.scene), reference(moved.scene)), 2e-5, "of white", "reference");
    const Film a = traced(near.scene);
    const Film b = traced(moved.scene);
    double worst = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i)
    {
      const double error = std::hypot(a.error[i], b.error[i]) / 3.0;
      const double apart = std::abs(a.radiance[0][i] - b.radiance[0][i]);
      worst = std::max(worst, apart / std::max(error, 1e-6));
    }
    far.measure(worst, 4.5, "standard errors of 64 paths", "paths");
    const auto by_march = [](const FarScene& one)
    {
      return MapperScene(new_mappers(0.5)[0].mapper, one.scene, vtk_camera(one.view)).film(16);
    };
    far.measure(
      difference(by_march(near), by_march(moved)), 2e-5, "of white", "vtkBrumeRayMarchMapper");
    // What scatters is random, and the smart mapper's steps are chosen: what passes is neither.
    FarScene dark_near = near;
    FarScene dark_moved = moved;
    dark_near.scene.volumes[0].medium.lit = dark_moved.scene.volumes[0].medium.lit = false;
    for (std::size_t i = 1; i < 3; ++i)
    {
      const auto by = [i](const FarScene& one)
      {
        return MapperScene(new_mappers(0.5)[i].mapper, one.scene, vtk_camera(one.view)).film(16);
      };
      far.measure(
        difference(by(dark_near), by(dark_moved)), 2e-5, "of white", new_mappers(0.5)[i].name);
    }
  }
}
