// Boxes whose optical depth has a closed form, drawn by every kernel: the film's transmittance and
// radiance must be the formula's, whatever the step, the spacing, the place and the projection.
#include "../support/transport_scenes.h"

#include "Transport/reference.h"

#include <gtest/gtest.h>

#include <iostream>

using namespace transport_scenes;

namespace
{

constexpr int width = 17;
constexpr int height = 14;

/// The stretch of a pixel's ray inside the scene's box, in the index space of the grid.
struct Stretch
{
  long double length = 0.0L; ///< world units
  long double begin[3], end[3];
};

Stretch stretch(const Scene& scene, const View& view, const glm::dvec3& spacing, int x, int y)
{
  long double from[3], to[3];
  view.ray(x, y, width, height, from, to);
  long double s0 = 0.0L;
  long double s1 = 1.0L;
  Stretch result;
  for (int axis = 0; axis < 3; ++axis)
  {
    const long double half =
      0.5L * (scene.volumes[0].grid.upper(axis) - scene.volumes[0].grid.lower(axis)) *
      spacing[axis];
    const long double d = to[axis] - from[axis];
    if (d == 0.0L)
    {
      if (std::abs(from[axis]) > half)
      {
        return result;
      }
      continue;
    }
    const long double a = (-half - from[axis]) / d;
    const long double b = (half - from[axis]) / d;
    s0 = std::max(s0, std::min(a, b));
    s1 = std::min(s1, std::max(a, b));
  }
  if (s0 >= s1)
  {
    return result;
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    const long double d = to[axis] - from[axis];
    const long double centre =
      0.5L * (scene.volumes[0].grid.upper(axis) + scene.volumes[0].grid.lower(axis));
    result.begin[axis] = centre + (from[axis] + s0 * d) / spacing[axis];
    result.end[axis] = centre + (from[axis] + s1 * d) / spacing[axis];
    result.length += d * (s1 - s0) * d * (s1 - s0);
  }
  result.length = std::sqrt(result.length);
  return result;
}

/// The largest relative error of the film's transmittance against optical_depth(x, y).
template <class OpticalDepth>
double worst_transmittance(const Film& film, const OpticalDepth& optical_depth, int* hits = nullptr)
{
  double worst = 0.0;
  for (int y = 0; y < height; ++y)
  {
    for (int x = 0; x < width; ++x)
    {
      const long double tau = optical_depth(x, y);
      if (hits)
      {
        *hits += tau > 0.0L;
      }
      for (int c = 0; c < 3; ++c)
      {
        const long double got = film.transmittance[c][y * width + x];
        const double error = static_cast<double>(std::abs(got / std::exp(-tau) - 1.0L));
        worst = error <= worst ? worst : error; // a NaN wins
      }
    }
  }
  return worst;
}

const glm::dvec3 oblique(0.61, -0.43, -0.82);

struct Place
{
  glm::dvec3 spacing;
  double origin; ///< in extents
};

const Place places[] = {
  { { 1.0, 1.0, 1.0 }, 0.0 },
  { { 1e-3, 1e-3, 1e-3 }, -1e5 },
  { { 1e3, 1e3, 1e3 }, 1e5 },
  { { 0.3, 1.0, 2.7 }, 0.0 },
  { { 2.7e-3, 0.9e-3, 0.3e-3 }, 1e5 },
  { { 0.3e3, 2.7e3, 1e3 }, -1e5 },
};
const double steps[] = { 0.125, 1.0, 3.3, 8.0 };
const double depths[] = { 1e-6, 1.0, 80.0 };

template <class T>
struct Ramp
{
  int axis; ///< −1: constant
  double first;
  double slope;
  Voxels<T> voxels;

  explicit Ramp(int along)
    : axis(along)
    , first(along < 0 ? (std::is_floating_point_v<T> ? 0.37f : 97) : 0.0)
    , slope(along < 0 ? 0.0 : (std::is_floating_point_v<T> ? 0.25 : 5.0))
    , voxels(19, 16, 23,
        [&](int i, int j, int k)
        {
          const int at[3] = { i, j, k };
          return along < 0 ? first : first + slope * at[along];
        })
  {
  }
};

double diagonal_of(const Scene& scene, const glm::dvec3& spacing)
{
  glm::dvec3 d;
  for (int axis = 0; axis < 3; ++axis)
  {
    d[axis] =
      (scene.volumes[0].grid.upper(axis) - scene.volumes[0].grid.lower(axis)) * spacing[axis];
  }
  return glm::length(d);
}

template <class T>
class DensityBox : public testing::Test
{
};
using Types = testing::Types<std::uint8_t, std::int8_t, std::uint16_t, std::int16_t, float>;
TYPED_TEST_SUITE(DensityBox, Types);

/// Places a scene's grid with its origin as many extents away as the place says.
void put(Scene& scene, const Place& place)
{
  glm::dvec3 origin(0.0);
  for (int axis = 0; axis < 3; ++axis)
  {
    origin[axis] = place.origin * scene.volumes[0].grid.dims[axis] * place.spacing[axis];
  }
  scene.volumes[0].data_from_index = placed(place.spacing, origin);
}

// Transmittance within a relative 1e-5 for every step, spacing, place, projection and depth.
TYPED_TEST(DensityBox, TransmittanceIsBeerLambert)
{
  double worst_of_all = 0.0;
  for (int axis = -1; axis < 3; ++axis)
  {
    const Ramp<TypeParam> ramp(axis);
    Scene scene;
    scene.volumes[0].meaning = ValueMeaning::Density;
    scene.volumes[0].grid = ramp.voxels.grid();
    for (const Place& place : places)
    {
      put(scene, place);
      const double most = // so that no ray's optical depth is more than the one asked for
        axis < 0 ? ramp.first : ramp.first + ramp.slope * (scene.volumes[0].grid.dims[axis] - 1);
      const double voxel = std::min({ place.spacing.x, place.spacing.y, place.spacing.z });
      for (bool parallel : { false, true })
      {
        for (const glm::dvec3& forward : { oblique, glm::dvec3(0, 0, -1), glm::dvec3(1, 0, 0) })
        {
          const View view = view_of(scene, forward, parallel);
          scene.camera = view.camera(double(width) / height);
          for (double depth : depths)
          {
            scene.volumes[0].density.extinction =
              depth / (most * diagonal_of(scene, place.spacing));
            const auto tau = [&](int x, int y) -> long double
            {
              const Stretch s = stretch(scene, view, place.spacing, x, y);
              if (s.length == 0.0L)
              {
                return 0.0L;
              }
              const long double value =
                axis < 0 ? ramp.first : ramp.first + 0.5L * ramp.slope * (s.begin[axis] + s.end[axis]);
              return scene.volumes[0].density.extinction * value * s.length;
            };
            for (double step : steps)
            {
              ++scene.volumes[0].medium_revision;
              int hits = 0;
              const double worst =
                worst_transmittance(march(scene, width, height, step * voxel), tau, &hits);
              EXPECT_GE(hits, 4);
              worst_of_all = worst <= worst_of_all ? worst_of_all : worst;
              ASSERT_LE(worst, 1e-5)
                << "ramp along " << axis << ", spacing " << place.spacing.x << ", origin at "
                << place.origin << " extents, parallel " << parallel << ", optical depth " << depth
                << ", step " << step << " voxels";
            }
          }
        }
      }
    }
  }
  std::cout << "worst relative error of the transmittance: " << worst_of_all << "\n";
}

// A film of 32-bit floats cannot hold 1 − T of a thin box to more digits than T's own: half a unit
// in the last place below 1 is 3e-8. Where that matters, ask for the optical depth in doubles.
TEST(DensityBox, AThinBoxIsRightToTheFilmsLastDigit)
{
  const Ramp<float> ramp(-1);
  Scene scene;
  scene.volumes[0].meaning = ValueMeaning::Density;
  scene.volumes[0].grid = ramp.voxels.grid();
  const View view = view_of(scene, oblique, false);
  scene.camera = view.camera(double(width) / height);
  for (double depth : { 1e-6, 1e-5, 1e-3 })
  {
    scene.volumes[0].density.extinction =
      depth / (ramp.first * diagonal_of(scene, glm::dvec3(1.0)));
    const Film film = march(scene, width, height, 0.5);
    for (int y = 0; y < height; ++y)
    {
      for (int x = 0; x < width; ++x)
      {
        const long double tau = scene.volumes[0].density.extinction * ramp.first *
                                stretch(scene, view, glm::dvec3(1.0), x, y).length;
        EXPECT_NEAR(
          1.0 - film.transmittance[0][y * width + x], static_cast<double>(-std::expm1(-tau)), 3.1e-8);
      }
    }
  }
}

// Cells fill half a voxel more on each side, and hold their value there.
TEST(DensityBox, CellsReachHalfAVoxelFarther)
{
  for (bool linear : { true, false })
  {
    const Ramp<std::uint16_t> ramp(-1);
    Scene scene;
    scene.volumes[0].meaning = ValueMeaning::Density;
    scene.volumes[0].grid = ramp.voxels.grid();
    scene.volumes[0].grid.cell_centred = true;
    scene.volumes[0].grid.linear = linear;
    const glm::dvec3 spacing(0.5, 1.0, 2.0);
    scene.volumes[0].data_from_index = placed(spacing, glm::dvec3(3.0, -7.0, 11.0));
    const View view = view_of(scene, oblique, true);
    scene.camera = view.camera(double(width) / height);
    scene.volumes[0].density.extinction = 5.0 / (ramp.first * diagonal_of(scene, spacing));
    const auto tau = [&](int x, int y)
    {
      return scene.volumes[0].density.extinction * ramp.first *
             stretch(scene, view, spacing, x, y).length;
    };
    for (double step : { 0.1, 0.7, 100.0 })
    {
      EXPECT_LE(worst_transmittance(march(scene, width, height, step), tau), 1e-5) << step;
    }
  }
}

// The sum is compensated: a ray of three million steps, each far below the sum's last digit, loses
// nothing. A plain sum of floats is wrong in the third digit here.
TEST(DensityBox, TheOpticalDepthIsACompensatedSum)
{
  const Voxels<float> voxels(4, 4, 4, [](int, int, int) { return 0.7f; });
  Scene scene;
  scene.volumes[0].meaning = ValueMeaning::Density;
  scene.volumes[0].grid = voxels.grid();
  const View view = view_of(scene, glm::dvec3(0, 0, -1), true);
  scene.camera = view.camera(1.0);
  scene.volumes[0].density.extinction = 10.0 / (0.7f * 3.0);
  Film film(1, 1);
  Marcher marcher;
  MarchSettings settings;
  settings.step = 1e-6;
  marcher.render(scene, settings, film);
  EXPECT_NEAR(film.transmittance[0][0] / std::exp(-10.0), 1.0, 1e-5);
}

// Slow truth, same formula. It stops where less than 1e-9 passes, an optical depth of 20.7.
TEST(Reference, IsBeerLambertForBoxesAndRamps)
{
  for (int axis = -1; axis < 3; ++axis)
  {
    const Ramp<std::int16_t> ramp(axis);
    Scene scene;
    scene.volumes[0].meaning = ValueMeaning::Density;
    scene.volumes[0].grid = ramp.voxels.grid();
    for (const Place& place : places)
    {
      put(scene, place);
      for (bool parallel : { false, true })
      {
        const View view = view_of(scene, oblique, parallel);
        scene.camera = view.camera(double(width) / height);
        for (double depth : { 1e-6, 1.0, 18.0 })
        {
          const double most = axis < 0
                                ? ramp.first
                                : ramp.first + ramp.slope * (scene.volumes[0].grid.dims[axis] - 1);
          scene.volumes[0].density.extinction = depth / (most * diagonal_of(scene, place.spacing));
          const auto tau = [&](int x, int y) -> long double
          {
            const Stretch s = stretch(scene, view, place.spacing, x, y);
            const long double value = axis < 0 || s.length == 0.0L
              ? ramp.first
              : ramp.first + 0.5L * ramp.slope * (s.begin[axis] + s.end[axis]);
            return scene.volumes[0].density.extinction * value * s.length;
          };
          Film film(width, height);
          const ReferenceStatistics statistics = render_reference(scene, {}, film);
          EXPECT_TRUE(statistics.completed);
          EXPECT_EQ(statistics.unsettled_rays, 0u);
          // Half a unit in the last place of a float is a relative 6e-8.
          EXPECT_LE(worst_transmittance(film, tau), 2e-7) << axis << " " << depth;
        }
      }
    }
  }
}

// Emission and absorption in a box of one colour: c (1 − e^(−τ)) and e^(−τ), relative.
TEST(ClassifiedBox, RadianceAndTransmittanceAreClosedForms)
{
  const glm::dvec3 colour(0.9, 0.5, 0.125);
  double worst_radiance = 0.0;
  double worst_transparency = 0.0;
  for (bool cells : { false, true })
  {
    const Ramp<std::uint8_t> ramp(-1);
    Scene scene;
    scene.volumes[0].grid = ramp.voxels.grid();
    scene.volumes[0].grid.cell_centred = cells;
    for (const Place& place : places)
    {
      put(scene, place);
      const double voxel = std::min({ place.spacing.x, place.spacing.y, place.spacing.z });
      for (bool parallel : { false, true })
      {
        const View view = view_of(scene, oblique, parallel);
        scene.camera = view.camera(double(width) / height);
        for (double depth : depths)
        {
          // Opacity ¼ over the distance that gives the box's diagonal this optical depth.
          scene.volumes[0].classification = classify(
            0.0, 255.0, [](double) { return 0.25; }, [&](double) { return colour; }, 3);
          scene.volumes[0].classification.unit_distance =
            -std::log(0.75) * diagonal_of(scene, place.spacing) / depth;
          const auto tau = [&](int x, int y) {
            return depth * stretch(scene, view, place.spacing, x, y).length /
              diagonal_of(scene, place.spacing);
          };
          for (double step : steps)
          {
            const Film film = march(scene, width, height, step * voxel);
            const double transparency = worst_transmittance(film, tau);
            double radiance = 0.0;
            for (int y = 0; y < height; ++y)
            {
              for (int x = 0; x < width; ++x)
              {
                for (int c = 0; c < 3; ++c)
                {
                  const double truth = static_cast<double>(-std::expm1(-tau(x, y))) * colour[c];
                  const double got = film.radiance[c][y * width + x];
                  radiance = std::max(
                    radiance, truth > 0.0 ? std::abs(got / truth - 1.0) : std::abs(got));
                }
              }
            }
            worst_radiance = std::max(worst_radiance, radiance);
            worst_transparency = std::max(worst_transparency, transparency);
            ASSERT_LE(radiance, 1e-5) << depth << " " << step << " cells " << cells;
            ASSERT_LE(transparency, 1e-5) << depth << " " << step << " cells " << cells;
          }
        }
      }
    }
  }
  std::cout << "worst relative error: radiance " << worst_radiance << ", transmittance "
            << worst_transparency << "\n";
}

// A box that a ray crosses in less than a step has one step, cut to its length.
TEST(ClassifiedBox, ABoxThinnerThanAStepKeepsItsDepth)
{
  const Ramp<float> ramp(-1);
  Scene scene;
  scene.volumes[0].grid = ramp.voxels.grid();
  const glm::dvec3 spacing(1.0, 1.0, 1e-3);
  scene.volumes[0].data_from_index = placed(spacing, glm::dvec3(0.0));
  const View view = view_of(scene, glm::dvec3(0.2, 0.1, -1.0), false);
  scene.camera = view.camera(double(width) / height);
  scene.volumes[0].classification = classify(
    0.0, 1.0, [](double) { return 0.5; }, [](double) { return glm::dvec3(1.0); }, 2);
  scene.volumes[0].classification.unit_distance = 0.01;
  const auto tau = [&](int x, int y)
  { return std::log(2.0L) / 0.01L * stretch(scene, view, spacing, x, y).length; };
  EXPECT_LE(worst_transmittance(march(scene, width, height, 1.0), tau), 1e-5);
  EXPECT_LE(worst_transmittance(march(scene, width, height, 0.01), tau), 1e-5);
}

}
