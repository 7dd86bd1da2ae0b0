// Hard cases of optics in double precision: opacities, black bodies.
#include "hard_case.h"
#include "property.h"

#include "Transport/black_body.h"
#include "Transport/optics.h"

#include <glm/geometric.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace brume;
using namespace brume_tests;

// −ln(1 − α) and 1 − e^(−τ) are inverses; long double is the truth. Opacities near 1 have lost
// their digits before they come here, so the bound is on the transmittance that is left.
TEST(OpticsEnds, OpacityAndExtinction)
{
  HardCase both("Optics",
    "opacity to extinction and back, α from 1e-30 to 1",
    "`log(1 − α)` and `1 − e^(−τ)` lose every digit where α is small; α = 1 is infinitely dense",
    "α comes back within a relative 4e-16 up to ½, and within 2e-16 absolute above; α = 1 and "
    "beyond "
    "count as 1 − 1e-16, NaN and below 0 as 0");
  double relative = 0.0;
  double absolute = 0.0;
  const auto there_and_back = [&](double alpha)
  {
    const double back = opacity_from_optical_depth(extinction_from_opacity(alpha, 1.0));
    if (alpha <= 0.5)
    {
      relative = std::max(relative, std::abs(back - alpha) / alpha);
    }
    absolute = std::max(absolute, std::abs(back - alpha));
  };
  for (double alpha = 1e-30; alpha < 1.0; alpha *= 1.37)
  {
    there_and_back(alpha);
  }
  expect_property("opacities come back",
    1000,
    [&]()
    {
      const double alpha = *rc::gen::inRange(0, 1000000) * 1e-6;
      there_and_back(std::max(alpha, 1e-12));
      RC_ASSERT(relative <= 4e-16);
    });
  both.measure(relative, 4e-16, "relative", "double");
  both.measure(absolute, 2e-16, "absolute", "double");
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double alpha : { 1.0, 1.5, double(INFINITY) })
  {
    both.holds(std::abs(extinction_from_opacity(alpha, 2.0) * 2.0 + std::log(1e-16)) < 0.2,
      "the ends are as promised",
      "double");
  }
  for (const double alpha : { 0.0, -0.0, -1.0, nan, -double(INFINITY) })
  {
    both.holds(extinction_from_opacity(alpha, 2.0) == 0.0, "the ends are as promised", "double");
  }
}

TEST(OpticsEnds, BlackBody)
{
  HardCase body("Optics",
    "a black body from 0 K to 1e5 K",
    "Planck's `e^(hc/λkT) − 1` overflows where it is cold and cancels where it is hot; its visible "
    "radiance spans 300 decades",
    "the luminance within a relative 1e-3 of its integral; finite, never negative, 0 at 0 K, grows "
    "with the temperature in every channel from the "
    "reference on; "
    "beyond 1e5 K as at 1e5 K");
  double fall = 0.0;
  bool finite = true;
  glm::dvec3 last(0.0);
  for (double kelvin = 0.0; kelvin <= 1e5; kelvin = kelvin * 1.02 + 0.1)
  {
    const glm::dvec3 now = black_body_radiance(kelvin, 800.0);
    for (int c = 0; c < 3; ++c)
    {
      finite = finite && std::isfinite(now[c]) && now[c] >= 0.0;
      if (kelvin > 800.0)
      {
        fall = std::max(fall, (last[c] - now[c]) / now[c]);
      }
    }
    last = now;
  }
  // The integral over the visible, in long double.
  double off = 0.0;
  for (const double kelvin : { 300.0, 1000.0, 5000.0, 30000.0, 1e5 })
  {
    const auto lobe = [](long double nm, long double middle, long double below, long double above)
    { return std::exp(-0.5L * std::pow((nm - middle) / (nm < middle ? below : above), 2.0L)); };
    long double sum = 0.0L;
    for (long double nm = 360.25L; nm < 830.0L; nm += 0.5L)
    {
      const long double y =
        0.821L * lobe(nm, 568.8L, 46.9L, 40.5L) + 0.286L * lobe(nm, 530.9L, 16.3L, 31.1L);
      sum += y * 1.191042972e-16L / std::pow(nm * 1e-9L, 5.0L) /
             std::expm1(0.01438776877L / (nm * 1e-9L * kelvin)) * 0.5e-9L;
    }
    off = std::max(off, static_cast<double>(std::abs(black_body_xyz(kelvin).y / sum - 1.0L)));
  }
  body.measure(off, 1e-3, "relative of the luminance", "double");
  body.measure(
    std::max(fall, 0.0), 0.0, "relative fall from one temperature to a hotter one", "double");
  body.holds(finite, "finite and not negative", "double");
  body.holds(black_body_radiance(0.0, 1500.0) == glm::dvec3(0.0), "0 K is black", "double");
  for (const double kelvin : { 1e-300, 1e-3, 1.0 })
  {
    body.holds(glm::length(black_body_radiance(kelvin, 1500.0)) < 1e-300,
      "colder than 1 K is black",
      "double");
  }
  body.holds(black_body_radiance(1e300, 1500.0) == black_body_radiance(1e5, 1500.0),
    "beyond the end as at it",
    "double");
}
