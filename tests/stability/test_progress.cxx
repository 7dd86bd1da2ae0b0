// Hard cases of walks through voxels: that each comes to its end, and that borders of bricks are
// not seen.
#include "property.h"
#include "ray_integrators.h"
#include "ray_mappers.h"

#include "../support/sparse_grids.h"

#include "Transport/path_tracer.h"
#include "Transport/reference.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

using namespace stability;
using brume_tests::HardCase;

namespace
{

MarchSettings by_cells(double step)
{
  MarchSettings settings;
  settings.rule = StepRule::Cells;
  settings.step = step;
  settings.leave_error = 0.0;
  settings.threads = 1;
  return settings;
}

}

// The fault that this was: a ray along which an axis stands still on a plane of voxels, by rounding
// or in truth, went on by the least that a float tells apart.
TEST(Progress, WideGrids)
{
  HardCase wide("Rays",
    "rays in a plane of voxels of a very wide grid: spacing 5e4, 1e-3 off the plane",
    "by single precision they are in the plane, and a walk that looks for the next plane finds the "
    "one that "
    "it stands on",
    "two reads a cell and the closed form");
  for (const double spacing : { 1.0, 5e4, 1e9 })
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      for (const double off : { 0.0, 1e-3, -1e-3 })
      {
        RampRay ray;
        ray.dims = { 7, 7, 7 };
        ray.dims[axis] = 40;
        ray.slope = { 0.0, 0.01, 0.02 };
        ray.data_from_index = placed(glm::dvec3(spacing), glm::dvec3(0.0));
        ray.extinction = 0.03 / spacing;
        ray.from = ray.to = glm::dvec3(3.0 + off / spacing);
        ray.from[axis] = -50.0;
        ray.to[axis] = 90.0;
        ray.name = "spacing " + std::to_string(spacing);
        measure_ray(wide, ray);
      }
    }
  }
}

TEST(Progress, AnyStep)
{
  HardCase steps("Rays",
    "steps of 1e-300 to 1e300, for rays and for their shadows",
    "a step may be too short to move a place, or longer than any number",
    "refused, or at most 2¹⁶ + 4 steps a ray; the closed form within 1e-3 up to a voxel");
  for (const double step : { 1e-300, 1e-30, 1e-9, 1e-3, 0.3, 1.0, 30.0, 1e9, 1e30, 1e300 })
  {
    RampRay ray;
    ray.from = { -3.0, 2.1, 3.3 };
    ray.to = { 20.0, 4.2, 6.1 };
    RampScene ramp(ray);
    for (const bool lit : { false, true })
    {
      ramp.scene.volumes[0].medium.lit = lit;
      ramp.scene.lights.resize(lit ? 1 : 0);
      for (const std::string& target : targets())
      {
        ASSERT_TRUE(force_simd_target(target));
        MarchSettings settings = by_cells(step);
        settings.rule = StepRule::Midpoint;
        settings.shadows = ShadowMethod::Volume;
        settings.shadow_step = std::clamp(step, 0.1, 1e30);
        Film film(1, 1);
        const MarchStatistics statistics = Marcher().render(ramp.scene, settings, film);
        const char* by = lit ? "lit" : "midpoint";
        steps.measure(
          static_cast<double>(statistics.samples), lit ? 2.0 * 65540.0 : 65540.0, "reads", by);
        steps.measure(std::abs(film.transmittance[0][0] - std::exp(-ray.optical_depth())),
          step <= 1.0 ? 1e-3 : 1.0,
          "of white",
          by);
        force_simd_target("");
      }
    }
  }
  RampRay ray;
  ray.from = { -3.0, 2.1, 3.3 };
  ray.to = { 20.0, 4.2, 6.1 };
  const RampScene ramp(ray);
  for (const double step : { 0.0, -1.0, double(NAN), double(INFINITY) })
  {
    std::string message;
    try
    {
      Film film(1, 1);
      Marcher().render(ramp.scene, by_cells(step), film);
    }
    catch (const std::invalid_argument& error)
    {
      message = error.what();
    }
    steps.refuses(message, "step", "marcher");
  }
}

namespace
{

/// Places that are on planes, beside them, or anywhere.
double awkward_place(int upper)
{
  const double plane = *rc::gen::inRange(0, upper + 1);
  const double off = *rc::gen::element(
    0.0, -0.0, 1e-16, -1e-16, 1e-12, -1e-12, 1e-8, -1e-8, 1e-7, -1e-7, 1e-5, -1e-5, 0.25, 0.5, 0.3);
  return plane + off;
}

double awkward_slope()
{
  return *rc::gen::element(0.0,
    -0.0,
    1.0,
    -1.0,
    0.5,
    -0.25,
    1e-3,
    -1e-3,
    1e-6,
    -1e-7,
    1e-9,
    -1e-12,
    1e-16,
    1e-30,
    -1e-38,
    1e-42,
    -1e-300,
    5e-324,
    0.731,
    -0.377);
}

}

TEST(Progress, AwkwardRays)
{
  HardCase awkward("Rays",
    "random rays on, beside and across planes of voxels, of slopes from 1 to 5e-324",
    "any rule that moves from plane to plane has some ray that it does not move",
    "the closed form within 2e-5 of white, and four reads a cell: two, and as many at slivers that rounding makes");
  double worst = 0.0;
  double most_reads = 0.0;
  const std::vector<std::string> all = targets();
  const int tried = brume_tests::expect_property("awkward rays",
    400,
    [&]()
    {
      RampRay ray;
      ray.dims = { *rc::gen::inRange(2, 40), *rc::gen::inRange(2, 20), *rc::gen::inRange(2, 20) };
      ray.slope = { 0.02, -0.01, 0.01 };
      ray.extinction = 0.05;
      glm::dvec3 place(0.0);
      glm::dvec3 way(0.0);
      for (int axis = 0; axis < 3; ++axis)
      {
        place[axis] = awkward_place(ray.dims[axis] - 1);
        way[axis] = awkward_slope();
      }
      RC_PRE(glm::length(way) > 0.1);
      const double scale = *rc::gen::element(1.0, 8.0, 100.0) / glm::length(way);
      const bool through = *rc::gen::arbitrary<bool>();
      ray.from = through ? place - way * scale : place;
      ray.to = place + way * scale;
      RC_ASSERT(force_simd_target(*rc::gen::elementOf(all)));
      // A ray in a face, or beside it by less than rounding, may be on either side.
      const auto depth_in = [&](double wider)
      {
        RampRay other = ray;
        for (int axis = 0; axis < 3; ++axis)
        {
          const double middle = 0.5 * (ray.dims[axis] - 1);
          const auto squeeze = [&](double v) { return middle + (v - middle) * (1.0 - wider); };
          other.from[axis] = squeeze(ray.from[axis]);
          other.to[axis] = squeeze(ray.to[axis]);
        }
        return std::exp(-other.optical_depth());
      };
      const double a = depth_in(1e-9);
      const double b = depth_in(-1e-9);
      const RampScene ramp(ray);
      for (const StepRule rule : { StepRule::Cells, StepRule::Midpoint })
      {
        MarchSettings settings = by_cells(0.37);
        settings.rule = rule;
        Film film(1, 1);
        const MarchStatistics statistics = Marcher().render(ramp.scene, settings, film);
        const double t = film.transmittance[0][0];
        const double off = std::max({ t - std::max(a, b), std::min(a, b) - t, 0.0 });
        worst = off <= worst ? worst : off;
        RC_ASSERT(off <= 2e-5);
        if (rule == StepRule::Cells)
        {
          const double reads =
            static_cast<double>(statistics.samples) / std::max(ray.crossings(), 4.0);
          most_reads = std::max(most_reads, reads);
          RC_ASSERT(reads <= 4.0);
        }
      }
      force_simd_target("");
    });
  force_simd_target("");
  awkward.measure(worst, 2e-5, "of white", "cells");
  awkward.measure(worst, 2e-5, "of white", "midpoint");
  awkward.measure(most_reads, 4.0, "reads a cell on the way", "cells");
  awkward.holds(tried, brume_tests::property_trials(400), "random rays", "cells");
}

namespace
{

/// Matter that begins at a plane of voxels: density max(0, x − 8) of 24³ voxels. Bricks of eight
/// voxels before the plane hold nothing.
double half_density(const glm::dvec3& place)
{
  return std::max(0.0, place.x - 8.0);
}

/// ∫ max(0, x − 8) over a chord on which x runs evenly from a to b, of the chord's length.
double mean_half(double a, double b)
{
  const double low = std::min(a, b) - 8.0;
  const double high = std::max(a, b) - 8.0;
  return high <= 0.0 ? 0.0 : low >= 0.0 ? 0.5 * (low + high) : 0.5 * high * high / (high - low);
}

}

TEST(Progress, BrickBorders)
{
  HardCase borders("Rays",
    "borders of bricks, where what is empty is leapt over",
    "a leap that is a rounding too long loses the first matter behind it, one that is too short "
    "reads for "
    "ever; both show as lines along bricks",
    "the closed form, with leaps and without; no seam");
  const Voxels<float> voxels(
    24, 24, 24, [](int i, int j, int k) { return half_density(glm::dvec3(i, j, k)); });
  std::mt19937 random(11);
  std::uniform_real_distribution<double> in(0.5, 22.5);
  std::normal_distribution<double> any;
  constexpr double sigma = 0.01;
  for (int i = 0; i < 60; ++i)
  {
    RampRay ray;
    ray.dims = { 24, 24, 24 };
    glm::dvec3 place(in(random), in(random), in(random));
    glm::dvec3 way = glm::normalize(glm::dvec3(any(random), any(random), any(random)));
    if (i % 3 == 1)
    {
      place = glm::clamp(glm::round(place / 8.0), 1.0, 2.0) * 8.0; // through a corner of bricks
    }
    else if (i % 3 == 2)
    {
      place.y = place.z = 8.0; // along an edge of bricks, nearly
      way = glm::normalize(glm::dvec3(1.0, 1e-4 * any(random), 1e-7 * any(random)));
    }
    ray.from = place - way * 50.0;
    ray.to = place + way * 50.0;
    double begin = 0.0;
    double end = 0.0;
    ASSERT_TRUE(ray.chord(begin, end));
    const glm::dvec3 first = ray.from + (ray.to - ray.from) * begin;
    const glm::dvec3 last = ray.from + (ray.to - ray.from) * end;
    const double truth = std::exp(-sigma * glm::length(last - first) * mean_half(first.x, last.x));
    RampScene ramp(ray);
    Scene& scene = ramp.scene;
    scene.volumes[0].grid = voxels.grid();
    scene.volumes[0].density.extinction = sigma;
    Scene lit = scene;
    lit.volumes[0].medium.lit = true;
    lit.lights.resize(1);
    const auto off = [&](const Film& film) { return std::abs(film.transmittance[0][0] - truth); };
    Film film(1, 1);
    render_reference(scene, {}, film);
    borders.measure(off(film), 2e-6, "of white", "reference");
    // Paths go cell by cell, the march by the steps it was given, the smart mapper by its own.
    const char* const units[] = { "of white by steps of 1/8", "of white", "of white by a tolerance" };
    const double bounds[] = { 5e-5, 2e-6, 1e-3 };
    const std::vector<NamedMapper> mappers = new_mappers(0.125, 1, 1e-3);
    for (std::size_t k = 0; k < mappers.size(); ++k)
    {
      const Film passes =
        MapperScene(mappers[k].mapper, scene, vtk_camera(ray.from, ray.to)).film(1);
      borders.measure(off(passes), bounds[k], units[k], mappers[k].name);
    }
    for (const std::string& target : targets())
    {
      ASSERT_TRUE(force_simd_target(target));
      Film leapt[3] = { film, film, film };
      for (const bool leaping : { true, false })
      {
        MarchSettings settings = by_cells(0.125);
        settings.leaping = leaping;
        Marcher().render(scene, settings, film);
        borders.measure(off(film), 2e-6, "of white", "cells");
        settings.rule = StepRule::Midpoint;
        Film steps(1, 1);
        Marcher().render(scene, settings, steps);
        // Where the density begins, a step's middle is an eighth of its square off.
        borders.measure(off(steps), 5e-5, "of white by steps of 1/8", "midpoint");
        settings.shadows = ShadowMethod::Rays;
        Film light(1, 1);
        Marcher().render(lit, settings, light);
        borders.measure(off(light), 5e-5, "of white by steps of 1/8", "lit");
        const Film* now[3] = { &film, &steps, &light };
        for (int kind = 0; kind < 3; ++kind)
        {
          if (leaping)
          {
            leapt[kind] = *now[kind];
          }
          else
          {
            borders.measure(difference(leapt[kind], *now[kind]),
              1e-6,
              "of white between leaps and none",
              kind == 0   ? "cells"
              : kind == 1 ? "midpoint"
                          : "lit");
          }
        }
      }
      force_simd_target("");
    }
  }
}

TEST(Progress, SparseBorders)
{
  HardCase sparse("Rays",
    "borders of sparse bricks, where a neighbour is not stored",
    "a cell between a stored brick and none takes half of its voxels from the background",
    "the same as of dense voxels");
  using namespace sparse_grids;
  const auto bumps = [](int i, int j, int k)
  {
    const bool stored = ((i >> 3) + (j >> 3) + (k >> 3)) % 2 == 0;
    return stored && i < 32 && j < 32 && k < 32 && i >= 0 && j >= 0 && k >= 0
             ? 0.5 + 0.1 * ((7 * i + 5 * j + 3 * k) % 10)
             : 0.0;
  };
  const auto thin =
    make_sparse(VoxelType::Float32, { { 0, 0, 0 } }, { { 31, 31, 31 } }, 0.0, bumps);
  const std::vector<float> full = dense_copy(*thin);
  Scene scene;
  Volume& volume = scene.volumes[0];
  volume.grid = thin->grid();
  volume.meaning = ValueMeaning::Density;
  volume.density.extinction = 0.05;
  Scene dense = scene;
  dense.volumes[0].grid = dense_grid(*thin, full);
  for (const glm::dvec3& forward :
    { glm::dvec3(0.0, 0.0, -1.0), glm::dvec3(1.0, 0.0, 0.0), glm::dvec3(-0.4, 0.7, 0.3) })
  {
    const View view = view_of(scene, forward, true);
    scene.camera = dense.camera = view.camera(1.0);
    for (int i = 0; i < 3; ++i)
    {
      const auto drawn = [&](const Scene& one)
      { return MapperScene(new_mappers(0.125)[i].mapper, one, vtk_camera(view)).film(19); };
      sparse.measure(
        difference(drawn(scene), drawn(dense)), 5e-6, "of white", new_mappers(0.125)[i].name);
    }
    Film a(19, 19);
    Film b(19, 19);
    for (const std::string& target : targets())
    {
      ASSERT_TRUE(force_simd_target(target));
      for (const bool lit : { false, true })
      {
        for (Scene* one : { &scene, &dense })
        {
          one->volumes[0].medium.lit = lit;
          one->lights.resize(lit ? 1 : 0);
        }
        MarchSettings settings;
        settings.step = 0.125;
        settings.leave_error = 0.0;
        settings.shadows = ShadowMethod::Rays;
        Marcher().render(scene, settings, a);
        Marcher().render(dense, settings, b);
        sparse.measure(difference(a, b), 5e-6, "of white", lit ? "lit" : "midpoint");
      }
      force_simd_target("");
    }
    scene.volumes[0].medium.lit = dense.volumes[0].medium.lit = false;
    render_reference(scene, {}, a);
    render_reference(dense, {}, b);
    sparse.measure(difference(a, b), 5e-6, "of white", "reference");
  }
}
