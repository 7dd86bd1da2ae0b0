// Hard cases of fog in closed form: in double precision, and the one formula that packets share.
#include "hard_case.h"
#include "optics_packets.h"
#include "property.h"

#include "Transport/fog.h"
#include "Transport/marcher.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

using namespace brume;
using namespace brume_tests;

namespace
{

Scene scene_of(double falloff, double extinction)
{
  Scene scene;
  scene.volumes.clear();
  scene.fog.enabled = true;
  scene.fog.extinction = glm::dvec3(extinction, 0.5 * extinction, 0.0);
  scene.fog.falloff = falloff;
  Light sun;
  sun.direction = -glm::normalize(glm::dvec3(1.0, 0.0, 0.4));
  Light lamp;
  lamp.positional = true;
  lamp.position = glm::dvec3(3.0, 0.0, 1.0);
  lamp.attenuation = glm::dvec3(0.0, 0.0, 1.0);
  scene.lights = { sun, lamp };
  scene.sky.radiance = glm::dvec3(1.0);
  return scene;
}

glm::dvec3 rising(double slope)
{
  return { std::sqrt(std::max(0.0, 1.0 - slope * slope)), 0.0, slope };
}

/// ∫ e^(−h (z + slope s)) ds from 0 to `length`, in long double from the end where the fog is
/// denser.
long double column(long double h, long double z, long double slope, long double length)
{
  const long double fall = h * slope * length;
  const long double densest = std::exp(-h * z + std::max(0.0L, -fall));
  const long double size = std::abs(fall);
  return densest * length * (size > 0.0L ? -std::expm1(-size) / size : 1.0L);
}

struct Slopes
{
  const char* name;
  const char* why;
  std::vector<double> slopes;
  double falloff;
  double height;
  double length;
};

const Slopes stretches[] = {
  { "height fog, level rays",
    "t = h Δy is 0: (1 − e^(−t))/t is 0/0",
    { 0.0, -0.0, 1e-300, -1e-300, 1e-17, -1e-17, 1e-9, -1e-9 },
    0.1,
    2.0,
    50.0 },
  { "height fog, rising and falling rays",
    "e^(−t) cancels for small t and overflows for t ≪ 0",
    { 0.3, -0.3, 0.02, -0.02, 0.9, -0.9 },
    0.1,
    2.0,
    80.0 },
  { "height fog, steep layers",
    "the layer is a ninetieth of the ray: the integral is all at one end",
    { 1.0, -1.0, 0.999999, -0.999999 },
    30.0,
    1.0,
    3.0 },
  { "height fog, far below the ground",
    "e^(−h y) is 1e26 at y₀ = −200",
    { 0.0, 0.5, -0.5, 1.0, -1.0 },
    0.3,
    -200.0,
    30.0 },
  { "height fog, rays 1e7 long",
    "one ray sees all densities between 1 and e^(−10000)",
    { 0.0, 1e-6, -1e-6, 0.01, 1.0 },
    0.001,
    2.0,
    1e7 },
};

}

TEST(OpticsFog, ColumnsOfEveryStretch)
{
  for (const Slopes& each : stretches)
  {
    HardCase one("Optics",
      each.name,
      each.why,
      "the optical depth is within a relative 1e-12 of long double, 2e-6 in packets of single "
      "precision; halves add up to the whole within 1e-12");
    const Scene scene = scene_of(each.falloff, 1.0);
    const FogModel fog(scene);
    for (const double slope : each.slopes)
    {
      const FogRay ray = fog.ray(glm::dvec3(0.0, 0.0, each.height), rising(slope));
      const long double truth = column(each.falloff, each.height, ray.slope, each.length);
      one.measure(static_cast<double>(std::abs(fog.column(ray, 0.0, each.length) / truth - 1.0L)),
        1e-12,
        "relative",
        "double");
      const double middle = 0.375 * each.length;
      const double halves = fog.column(ray, 0.0, middle) + fog.column(ray, middle, each.length);
      one.measure(std::abs(halves / fog.column(ray, 0.0, each.length) - 1.0),
        1e-12,
        "relative of the halves",
        "double");
      // Packets hold profiles up to e^80: the same numbers as they would have them.
      const float begin = static_cast<float>(std::exp(-each.falloff * each.height));
      const float end =
        static_cast<float>(std::exp(-each.falloff * (each.height + ray.slope * each.length)));
      const float fall = static_cast<float>(std::abs(each.falloff * ray.slope * each.length));
      std::istringstream targets(simd_targets());
      for (std::string target; targets >> target;)
      {
        ASSERT_TRUE(force_simd_target(target));
        const float got = optics_packets::fog_column(
          { begin }, { end }, { fall }, { static_cast<float>(each.length) })[0];
        one.measure(
          static_cast<double>(std::abs(got / truth - 1.0L)), 2e-6, "relative in packets", target);
      }
      force_simd_target("");
    }
  }
}

TEST(OpticsFog, StaysInBounds)
{
  HardCase one("Optics",
    "any fog, any ray, any stretch: densities to 1e300, heights to ±1e30, lengths to infinity",
    "every exponential of the closed forms overflows somewhere, and ∞ · 0 is NaN",
    "transmittance in [0, 1]; radiance of sky and sun finite, never negative, never more than what "
    "the fog hides can send; never clearer further on; all of a rising ray as its closed form, "
    "within 1e-9");
  const double infinity = std::numeric_limits<double>::infinity();
  const int held = expect_property("fog in bounds",
    2000,
    [&]()
    {
      const double falloff = *rc::gen::element(0.0, 4e-320, 1e-12, 1e-3, 0.1, 30.0, 1e100);
      const double density = *rc::gen::element(1e-300, 1e-6, 1.0, 1e6, 1e300);
      const double height = *rc::gen::element(-1e30, -1e7, -1e3, -1.0, 0.0, 1.0, 1e3, 1e7, 1e30);
      const double slope =
        *rc::gen::element(0.0, 1e-300, -1e-300, 1e-12, -1e-12, 0.02, -0.5, 0.7, 1.0, -1.0);
      const double to = *rc::gen::element(0.0, 4e-320, 1e-9, 1.0, 1e4, 1e7, 1e300, infinity);
      const Scene scene = scene_of(falloff, density);
      const FogModel fog(scene);
      const FogRay ray = fog.ray(glm::dvec3(-10.0, 0.0, height), rising(slope));
      const glm::dvec3 through = fog.transmittance(ray, 0.0, to);
      const glm::dvec3 sky = fog.ambient(ray, 0.0, to);
      const glm::dvec3 sun = fog.lit_by(0, ray, 0.0, to);
      const glm::dvec3 lamp = fog.lit_by(1, ray, 0.0, to);
      for (int c = 0; c < 3; ++c)
      {
        RC_ASSERT(through[c] >= 0.0 && through[c] <= 1.0);
        RC_ASSERT(sky[c] >= 0.0 && sky[c] <= (1.0 - through[c]) + 1e-15);
        RC_ASSERT(sun[c] >= 0.0 && sun[c] <= 0.25 * (1.0 - through[c]) * (1.0 + 1e-9) + 1e-15);
        RC_ASSERT(std::isfinite(lamp[c]) && lamp[c] >= 0.0);
      }
      RC_ASSERT(through[2] == 1.0 && sky[2] == 0.0 && sun[2] == 0.0);
      // Further on it is never clearer.
      RC_ASSERT(through[0] <= fog.transmittance(ray, 0.0, 0.25 * to)[0] * (1.0 + 1e-12));
      // All of a rising ray has a closed form: the densest layer's, a falloff deep.
      const double steep = falloff * ray.slope;
      const double whole = density * std::exp(-falloff * ray.height) / steep;
      if (steep > 1e-200 && steep * to > 1e3 && std::isfinite(whole))
      {
        RC_ASSERT(std::abs(through[0] - std::exp(-whole)) <= 1e-9);
      }
    });
  for (const double slope : { 0.02, 0.7, 1.0 })
  {
    const Scene scene = scene_of(1e100, 3e99); // falloff times length overflows
    const FogModel fog(scene);
    const FogRay ray = fog.ray(glm::dvec3(0.0), rising(slope));
    one.measure(std::abs(fog.transmittance(ray, 0.0, 1e300)[0] - std::exp(-0.3 / ray.slope)),
      1e-12,
      "of the transmittance of layers 1e-100 thick",
      "double");
  }
  one.holds(held, property_trials(2000), "random stretches in bounds", "double");
}
