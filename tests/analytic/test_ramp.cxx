// A classified ramp, whose picture is an integral along the ray, against quadrature of its own: how
// fast the fixed step converges, and what the reference reaches.
#include "../support/transport_scenes.h"

#include "Transport/reference.h"
#include "Transport/step_control.h"

#include <boost/math/quadrature/gauss_kronrod.hpp>

#include <gtest/gtest.h>

using namespace transport_scenes;

namespace
{

constexpr double colour_scale = 0.8;
double opacity_of(double v)
{
  return 0.02 + 0.3 * std::exp(-std::pow((v - 40.0) / 12.0, 2)); // a smooth bump
}
double colour_of(double v)
{
  return colour_scale * v / 90.0;
}

/// A ramp along z, looked at along z: every ray sees v from 90 down to 0 over 30 voxels.
struct RampAlongZ
{
  Voxels<std::uint8_t> voxels{ 8, 8, 31, [](int, int, int k) { return 3 * k; } };
  Scene scene;

  RampAlongZ()
  {
    scene.volumes[0].grid = voxels.grid();
    scene.volumes[0].data_from_index =
      placed(glm::dvec3(1.0, 1.0, 0.5), glm::dvec3(-5.0, 2.0, 40.0));
    scene.volumes[0].classification =
      classify(0.0, 90.0, opacity_of, [](double v) { return glm::dvec3(colour_of(v), 1.0, 0.25); });
    scene.volumes[0].classification.unit_distance = 1.7;
    View view = view_of(scene, glm::dvec3(0, 0, -1), true);
    view.half_height = 2.0;
    scene.camera = view.camera(1.0);
  }
};

struct Truth
{
  double transmittance;
  double radiance; ///< of the red channel
};

/// Boost.Math: τ(s) = ∫ σt, L = ∫ c σt e^(−τ(s)) ds, s from the far face's value down.
Truth truth_by_quadrature()
{
  using boost::math::quadrature::gauss_kronrod;
  const auto sigma = [](double s) { return -std::log1p(-opacity_of(90.0 - 6.0 * s)) / 1.7; };
  const auto tau = [&](double s)
  { return s > 0.0 ? gauss_kronrod<double, 61>::integrate(sigma, 0.0, s, 10, 1e-13) : 0.0; };
  Truth truth;
  truth.transmittance = std::exp(-tau(15.0));
  truth.radiance = gauss_kronrod<double, 61>::integrate(
    [&](double s) { return colour_of(90.0 - 6.0 * s) * sigma(s) * std::exp(-tau(s)); }, 0.0, 15.0,
    5, 1e-10);
  return truth;
}

TEST(ClassifiedRamp, TheReferenceAgreesWithQuadrature)
{
  const RampAlongZ ramp;
  const Truth truth = truth_by_quadrature();
  Film film(3, 3);
  ReferenceSettings settings;
  settings.tolerance = 1e-7;
  const ReferenceStatistics statistics = render_reference(ramp.scene, settings, film);
  EXPECT_LE(statistics.largest_change, 2e-5);
  EXPECT_NEAR(film.transmittance[0][4] / truth.transmittance, 1.0, 2e-6);
  EXPECT_NEAR(film.radiance[0][4] / truth.radiance, 1.0, 2e-6);
}

// The midpoint rule is of second order: half the step, a quarter of the error.
TEST(ClassifiedRamp, HalvingTheStepQuartersTheError)
{
  const RampAlongZ ramp;
  const Truth truth = truth_by_quadrature();
  double last_transmittance = 0.0;
  double last_radiance = 0.0;
  for (double step : { 1.0, 0.5, 0.25, 0.125 }) // 15 long: no partial step
  {
    const Film film = march(ramp.scene, 3, 3, step);
    const double transmittance = std::abs(film.transmittance[0][4] - truth.transmittance);
    const double radiance = std::abs(film.radiance[0][4] - truth.radiance);
    if (last_radiance > 0.0 && radiance > 2e-5) // the table's and float's own errors are below
    {
      EXPECT_GT(last_radiance / radiance, 3.3) << step;
      EXPECT_LT(last_radiance / radiance, 4.8) << step;
    }
    if (last_transmittance > 0.0 && transmittance > 2e-5)
    {
      EXPECT_GT(last_transmittance / transmittance, 3.3) << step;
    }
    last_transmittance = transmittance;
    last_radiance = radiance;
  }
  EXPECT_LT(last_radiance, 1e-4);
}

// The march is what a fixed step makes in double precision, and no more than rounding from it.
TEST(ClassifiedRamp, TheMarchIsTheFixedStepOfTheReference)
{
  const RampAlongZ ramp;
  for (double step : { 4.0, 0.7, 0.125 })
  {
    Film slow(5, 5);
    ASSERT_TRUE(render_fixed_step(ramp.scene, step, SamplePlacement::Middle, 0.0, 1, slow));
    EXPECT_LE(difference(slow, march(ramp.scene, 5, 5, step)), 1e-5) << step;
  }
}

// Where the other placements put their samples: n whole steps, the first on the grid's face (from
// entry) or on the next whole multiple of the step from the near plane.
TEST(FixedStep, PlacementsCountWholeSteps)
{
  const Voxels<float> voxels(4, 4, 11, [](int, int, int) { return 1.0f; });
  Scene scene;
  scene.volumes[0].meaning = ValueMeaning::Density;
  scene.volumes[0].density.extinction = 0.1;
  scene.volumes[0].grid = voxels.grid();
  View view = view_of(scene, glm::dvec3(0, 0, -1), true);
  view.near_plane = view.distance - 5.0 - 0.75; // the grid begins 0.75 behind the near plane
  scene.camera = view.camera(1.0);
  Film film(1, 1);
  const auto tau = [&](double step, SamplePlacement placement)
  {
    render_fixed_step(scene, step, placement, 0.0, 1, film);
    return -std::log(double(film.transmittance[0][0]));
  };
  EXPECT_NEAR(tau(4.0, SamplePlacement::Middle), 1.0, 1e-6);
  EXPECT_NEAR(tau(4.0, SamplePlacement::FromEntry), 0.1 * 12.0, 1e-6);     // at 0, 4, 8
  EXPECT_NEAR(tau(4.0, SamplePlacement::FromNearPlane), 0.1 * 8.0, 1e-6);  // at 3.25, 7.25
  EXPECT_NEAR(tau(2.0, SamplePlacement::FromNearPlane), 0.1 * 10.0, 1e-6); // 1.25, 3.25 … 9.25
}

}
