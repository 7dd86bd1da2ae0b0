// Fog in closed form against adaptive quadrature by Boost.Math of the integrals that define it.
#include "../support/fog_scenes.h"
#include "../support/fog_truth.h"

#include "Transport/exponential_integral.h"
#include "Transport/fog.h"

#include <boost/math/special_functions/expint.hpp>

#include <glm/geometric.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <vector>

using namespace brume;
using namespace fog_scenes;
using namespace fog_truth;

namespace
{

const double slopes[] = { 0.0, 1e-300, 4e-320, 1e-12, -1e-12, 1e-5, -1e-5, 0.02, -0.02, 0.5, -0.5,
  0.96, -0.96, 1.0, -1.0 };

TEST(Fog, OpticalDepthIsTheIntegralOfTheExtinction)
{
  for (double falloff : { 0.0, 1e-12, 1e-4, 0.05, 1.0 })
  {
    const Scene scene = scene_of(falloff);
    const FogModel fog(scene);
    for (double slope : slopes)
    {
      const FogRay ray = fog.ray(dvec3(3.0, -1.0, 4.0), direction_of(slope));
      const Matter matter{ 0.4, falloff, 2.0, slope };
      for (double from : { 0.0, 3.0 })
      {
        for (double length : { 1e-6, 1.0, 30.0, 1e3 })
        {
          const double to = from + length;
          const double truth = integral([&](double s) { return matter.at(s); }, from, to);
          if (truth < 1e200)
          {
            ASSERT_NEAR(fog.optical_depth(ray, from, to).y / truth, 1.0, 1e-9)
              << falloff << ' ' << slope << ' ' << from << ' ' << length;
          }
        }
      }
    }
  }
}

TEST(Fog, TransmittancesOfStretchesMultiply)
{
  const Scene scene = scene_of(0.3, dvec3(0.1, 0.2, 0.4));
  const FogModel fog(scene);
  for (double slope : slopes)
  {
    const FogRay ray = fog.ray(dvec3(0.0, 0.0, 3.0), direction_of(slope));
    const dvec3 both = fog.transmittance(ray, 1.0, 2.0) * fog.transmittance(ray, 2.0, 6.0);
    const dvec3 whole = fog.transmittance(ray, 1.0, 6.0);
    for (int c = 0; c < 3; ++c)
    {
      ASSERT_NEAR(both[c], whole[c], 1e-14) << slope;
    }
    const dvec3 parts = fog.radiance(ray, 1.0, 2.0) +
                        fog.transmittance(ray, 1.0, 2.0) * fog.radiance(ray, 2.0, infinity);
    const dvec3 all = fog.radiance(ray, 1.0, infinity);
    for (int c = 0; c < 3; ++c)
    {
      ASSERT_NEAR(parts[c], all[c], 1e-6) << slope;
    }
  }
}

TEST(Fog, ColumnsAreFoundAgain)
{
  for (double falloff : { 0.0, 1e-300, 1e-9, 0.05, 3.0 })
  {
    const FogModel fog(scene_of(falloff));
    for (double slope : slopes)
    {
      for (double height : { 2.0, 300.0 })
      {
        const FogRay ray = fog.ray(dvec3(0.0, 0.0, height), direction_of(slope));
        for (double to : { 0.01, 2.0, 40.0 })
        {
          const double column = fog.column(ray, 0.5, 0.5 + to);
          if (column > 1e-200 && column < 1e200 &&
              column < (1.0 - 1e-6) * fog.column(ray, 0.5, infinity))
          {
            const double found = fog.place_of_column(ray, 0.5, column);
            ASSERT_NEAR(fog.column(ray, 0.5, found) / column, 1.0, 1e-9)
              << falloff << ' ' << slope << ' ' << height << ' ' << to;
          }
        }
      }
    }
  }
  // From so high that the fog is 0 in the computer, down into it: f = 1 at the height 0.
  Scene scene = scene_of(1.0);
  scene.fog.base_height = 0.0;
  const FogModel fog(scene);
  const FogRay ray = fog.ray(dvec3(0.0, 0.0, 1e5), dvec3(0.0, 0.0, -1.0));
  EXPECT_EQ(fog.profile(ray, 0.0), 0.0);
  EXPECT_NEAR(fog.place_of_column(ray, 0.0, 1.0), 1e5, 1e-6);
  EXPECT_NEAR(fog.column(ray, 0.0, 1e5), 1.0, 1e-9);
}

TEST(Fog, SunlightIsTheIntegralAlongTheRay)
{
  for (double falloff : { 0.0, 1e-4, 0.05, 1.0 })
  {
    for (double rise : { 1.0, 0.5, 0.02 })
    {
      Scene scene = scene_of(falloff, dvec3(0.4, 0.1, 0.02));
      const Light sun = sun_of(rise);
      scene.lights = { sun };
      const FogModel fog(scene);
      for (double slope : slopes)
      {
        for (double height : { -6.0, 2.0, 30.0 })
        {
          for (double to : { 0.5, 40.0, infinity })
          {
            const dvec3 direction = direction_of(slope);
            const FogRay ray = fog.ray(dvec3(0.0, 0.0, height), direction);
            const dvec3 found = fog.lit_by(0, ray, 0.25, to);
            const double p = henyey_greenstein(0.7, -glm::dot(sun.direction, direction));
            for (int c = 0; c < 3; ++c)
            {
              const Matter matter{ scene.fog.extinction[c], falloff, height - 2.0, slope };
              const double truth = scene.fog.albedo[c] * pi * sun.diffuse[c] * p *
                integral(
                  [&](double s)
                  {
                    const double up = falloff > 0.0 ? matter.at(s) / (falloff * rise) : 0.0;
                    const double passes = std::exp(-matter.depth(0.25, s) - up);
                    return passes > 0.0 ? matter.at(s) * passes : 0.0;
                  },
                  0.25, to, { place_of_depth_one(matter, 0.25) });
              ASSERT_NEAR(found[c], truth, 1e-9 * truth + 1e-15)
                << falloff << ' ' << rise << ' ' << slope << ' ' << height << ' ' << to;
            }
          }
        }
      }
    }
  }
}

TEST(Fog, ASunUnderTheHorizonLightsNoLayers)
{
  Light sun;
  sun.direction = -direction_of(-0.1);
  Scene scene = scene_of(0.1);
  scene.lights = { sun, sun };
  scene.lights[1].direction = dvec3(1.0, 0.0, 0.0); // on it
  const FogModel fog(scene);
  const FogRay ray = fog.ray(dvec3(0.0), direction_of(0.3));
  EXPECT_EQ(fog.lit_by(0, ray, 0.0, infinity), dvec3(0.0));
  EXPECT_EQ(fog.lit_by(1, ray, 0.0, infinity), dvec3(0.0));
  EXPECT_EQ(fog.light_transmittance(0, dvec3(0.0)), dvec3(0.0));
  // Without layers there is no horizon.
  scene.fog.falloff = 0.0;
  const FogModel even(scene);
  EXPECT_GT(even.lit_by(0, even.ray(dvec3(0.0), direction_of(0.3)), 0.0, infinity).x, 0.0);
  EXPECT_EQ(even.light_transmittance(0, dvec3(0.0)), dvec3(1.0));
}

TEST(Fog, QuickExponentialIntegralAgreesWithBoost)
{
  EXPECT_EQ(quick_exponential_integral_2(0.0), 1.0);
  EXPECT_EQ(quick_exponential_integral_2(infinity), 0.0);
  for (double x = 1e-12; x < 650.0; x *= 1.07)
  {
    ASSERT_NEAR(quick_exponential_integral_2(x) / boost::math::expint(2, x), 1.0, 1e-9) << x;
  }
}

TEST(Fog, LightOfTheSkyIsTheIntegralAlongTheRay)
{
  double worst = 0.0;
  for (double falloff : { 0.0, 1e-3, 0.05, 1.0 })
  {
    const Scene scene = scene_under_sky(falloff);
    const FogModel fog(scene);
    for (double slope : slopes)
    {
      for (double height : { -2.0, 2.0, 12.0, 200.0 })
      {
        for (double to : { 0.5, 40.0, 1e4, infinity })
        {
          const FogRay ray = fog.ray(dvec3(0.0, 0.0, height), direction_of(slope));
          const dvec3 found = fog.ambient(ray, 0.25, to);
          for (int c = 0; c < 3; ++c)
          {
            const Matter matter{ scene.fog.extinction[c], falloff, height - 2.0, slope };
            const double truth = scene.fog.albedo[c] *
              integral(
                [&](double s)
                {
                  const double passes = std::exp(-matter.depth(0.25, s));
                  if (!(passes > 0.0))
                  {
                    return 0.0;
                  }
                  const double light = falloff > 0.0
                    ? scene.sky.radiance[c] * boost::math::expint(2, matter.at(s) / falloff)
                    : scene.sky.radiance[c] + scene.sky.ground[c];
                  return 0.5 * light * matter.at(s) * passes;
                },
                0.25, to, { place_of_depth_one(matter, 0.25) });
            if (truth > 1e-6)
            {
              worst = std::max(worst, std::abs(found[c] / truth - 1.0));
            }
            ASSERT_NEAR(found[c], truth, 2e-6 * truth + 1e-12)
              << falloff << ' ' << slope << ' ' << height << ' ' << to << ' ' << c;
          }
        }
      }
    }
  }
  RecordProperty("worst", std::to_string(worst));
  EXPECT_LT(worst, 1e-6);
}

/// What a lamp's light comes to, by its definition.
double lamp_truth(const Scene& scene, int c, const dvec3& origin, const dvec3& direction, double to)
{
  const Light& lamp = scene.lights[0];
  const double falloff = scene.fog.falloff;
  const Matter matter{ scene.fog.extinction[c], falloff, origin.z - scene.fog.base_height,
    direction.z };
  const double cone = std::cos(lamp.cone_angle * pi / 180.0);
  const auto sent = [&](double s)
  {
    const dvec3 way = origin + direction * s - lamp.position;
    const double d = glm::length(way);
    const Matter between{ matter.k, falloff, lamp.position.z - scene.fog.base_height, way.z / d };
    const double cosine = glm::dot(way, lamp.direction) / d;
    const double spot = lamp.cone_angle >= 90.0 ? 1.0
                        : cosine >= cone        ? std::pow(cosine, lamp.exponent)
                                                : 0.0;
    const double passes = std::exp(-matter.depth(0.0, s) - between.depth(0.0, d));
    return passes > 0.0 ? matter.at(s) * passes * spot *
                            henyey_greenstein(0.7, -glm::dot(way, direction) / d) /
                            (lamp.attenuation.x + lamp.attenuation.y * d + lamp.attenuation.z * d * d)
                        : 0.0;
  };
  const double nearest = glm::dot(lamp.position - origin, direction);
  std::vector<double> places{ nearest };
  if (lamp.cone_angle < 90.0)
  {
    // The edges of the cone, by bisection between places on both sides.
    std::vector<double> samples;
    for (double away = 1e-9; away < 1e5; away *= 1.2)
    {
      samples.push_back(nearest - away);
      samples.push_back(nearest + away);
    }
    std::sort(samples.begin(), samples.end());
    double before = samples.front();
    for (double s : samples)
    {
      if ((sent(s) > 0.0) != (sent(before) > 0.0))
      {
        double a = before;
        double b = s;
        for (int i = 0; i < 80; ++i)
        {
          const double m = 0.5 * (a + b);
          ((sent(m) > 0.0) == (sent(a) > 0.0) ? a : b) = m;
        }
        places.push_back(a);
      }
      before = s;
    }
  }
  return scene.fog.albedo[c] * pi * lamp.diffuse[c] * integral(sent, 0.0, to, places);
}

TEST(Fog, LampsAreTheIntegralAlongTheRay)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-8.0, 8.0);
  std::uniform_real_distribution<double> cosine(-1.0, 1.0);
  double worst = 0.0;
  int lit = 0;
  for (double falloff : { 0.0, 0.05, 1.0 })
  {
    for (const dvec3& attenuation : lamp_attenuations)
    {
      for (double cone : { 180.0, 25.0 })
      {
        for (int trial = 0; trial < 12; ++trial)
        {
          Scene scene = scene_of(falloff, dvec3(2.0, 0.1, 0.001));
          const dvec3 position(place(random), place(random), place(random));
          scene.lights = { lamp_of(position, direction_of(cosine(random), place(random)), attenuation, cone) };
          const Light& lamp = scene.lights[0];
          const FogModel fog(scene);
          const dvec3 origin(place(random), place(random), place(random));
          // Past the lamp at some distance, or at next to none.
          dvec3 direction = direction_of(trial == 0 ? 0.0 : cosine(random), place(random));
          if (trial >= 8)
          {
            direction = glm::normalize(lamp.position - origin +
              dvec3(trial < 10 ? 1e-3 : 1e-6, 0.0, trial < 10 ? 0.0 : 2e-6));
          }
          const double to = trial % 3 == 0 ? infinity : trial % 3 == 1 ? 6.0 : 100.0;
          const dvec3 found = fog.lit_by(0, fog.ray(origin, direction), 0.0, to);
          for (int c = 0; c < 3; ++c)
          {
            const double truth = lamp_truth(scene, c, origin, direction, to);
            lit += truth > 1e-8;
            if (truth > 1e-8) // darker is as good as black
            {
              worst = std::max(worst, std::abs(found[c] / truth - 1.0));
            }
            EXPECT_NEAR(found[c], truth, 1e-5 * truth + 1e-10)
              << falloff << ' ' << attenuation.z << ' ' << cone << ' ' << trial << ' ' << c;
          }
        }
      }
    }
  }
  RecordProperty("worst", std::to_string(worst));
  EXPECT_GT(lit, 300);
}

TEST(Fog, ARayThroughALampIsTheLimitOfRaysPastIt)
{
  Scene scene = scene_of(0.1);
  Light lamp;
  lamp.positional = true;
  lamp.position = dvec3(5.0, 0.0, 3.0);
  lamp.attenuation = dvec3(1.0, 0.0, 0.5);
  scene.lights = { lamp };
  const FogModel fog(scene);
  const auto seen = [&](double aside, double spread)
  {
    const dvec3 direction(1.0, 0.0, 0.0);
    return fog.lit_by(0, fog.ray(dvec3(0.0, aside, 3.0), direction, spread), 0.0, infinity).x;
  };
  const double limit = seen(0.0, 0.0);
  EXPECT_TRUE(std::isfinite(limit));
  for (double aside : { 1e-30, 1e-12, 1e-9, 1e-7 })
  {
    EXPECT_NEAR(seen(aside, 0.0) / limit, 1.0, 1e-5) << aside;
  }
  // Light that falls off with the square of the distance alone has no limit: the width of a pixel
  // gives it one.
  lamp.attenuation = dvec3(0.0, 0.0, 1.0);
  scene.lights = { lamp };
  const FogModel bare(scene);
  const auto through = [&](double aside, double spread)
  {
    return bare
      .lit_by(0, bare.ray(dvec3(0.0, aside, 3.0), dvec3(1.0, 0.0, 0.0), spread), 0.0, infinity)
      .x;
  };
  EXPECT_TRUE(std::isfinite(through(0.0, 0.0)));
  EXPECT_NEAR(through(0.0, 1e-4) / through(5e-4, 0.0), 1.0, 1e-6);
  // The ray begins in the lamp.
  EXPECT_TRUE(std::isfinite(fog.lit_by(0, fog.ray(lamp.position, dvec3(0, 0, 1)), 0.0, 9.0).x));
}

/// Neither NaN nor light from nothing, wherever the ray runs.
TEST(Fog, StaysFiniteEverywhere)
{
  const double most = std::numeric_limits<double>::max();
  int dark = 0;
  for (double falloff : { 0.0, 4e-320, 1e-300, 1e-12, 0.1, 30.0, 1e100 })
  {
    for (double k : { 1e-300, 1e-6, 1.0, 1e6, 1e300 })
    {
      Scene scene = scene_of(falloff, dvec3(k, 0.5 * k, 0.0));
      Light lamp;
      lamp.positional = true;
      lamp.position = dvec3(1.0, 2.0, 3.0);
      Light spot = lamp;
      spot.cone_angle = 30.0;
      spot.direction = dvec3(1.0, 0.0, 0.0);
      Light sun;
      sun.direction = -direction_of(0.3);
      Light low = sun;
      low.direction = -direction_of(1e-310);
      scene.lights = { lamp, spot, sun, low };
      scene.sky.radiance = scene.sky.ground = dvec3(1.0);
      const FogModel fog(scene);
      for (double slope : slopes)
      {
        for (double height : { -1e30, -1e7, -1e3, 0.0, 2.0, 1e3, 1e7, 1e30 })
        {
          const FogRay ray = fog.ray(dvec3(-1e3, 0.0, height), direction_of(slope));
          for (double to : { 0.0, 4e-320, 1e-9, 1.0, 1e7, 1e300, infinity })
          {
            const dvec3 t = fog.transmittance(ray, 0.0, to);
            for (int c = 0; c < 3; ++c)
            {
              ASSERT_TRUE(t[c] >= 0.0 && t[c] <= 1.0)
                << falloff << ' ' << k << ' ' << slope << ' ' << height << ' ' << to;
            }
            ASSERT_EQ(t[2], 1.0);
            // Ambient light of 1 from all around never makes more than its albedo.
            const dvec3 sky = fog.ambient(ray, 0.0, to);
            for (int c = 0; c < 3; ++c)
            {
              ASSERT_TRUE(
                sky[c] >= 0.0 && sky[c] <= (1.0 - t[c]) * scene.fog.albedo[c] + 1e-15)
                << falloff << ' ' << k << ' ' << slope << ' ' << height << ' ' << to << ' ' << sky[c];
            }
            for (int i = 0; i < 4; ++i)
            {
              const dvec3 sent = fog.lit_by(i, ray, 0.0, to);
              const double brightest = pi * henyey_greenstein(0.7, 1.0);
              for (int c = 0; c < 3; ++c)
              {
                ASSERT_TRUE(sent[c] >= 0.0 &&
                  sent[c] <= (1.0 + 1e-5) * (1.0 - t[c]) * scene.fog.albedo[c] * brightest + 1e-15)
                  << i << ' ' << falloff << ' ' << k << ' ' << slope << ' ' << height << ' ' << to
                  << ' ' << sent[c];
              }
              dark += sent[0] == 0.0;
            }
            ASSERT_TRUE(fog.profile(ray, to) <= most || falloff > 0.0);
          }
        }
      }
    }
  }
  EXPECT_GT(dark, 100);
}

TEST(Fog, RefusesWhatItCannotBe)
{
  const auto wrong = [](const std::function<void(Scene&)>& spoil)
  {
    Scene scene = scene_of(0.1);
    spoil(scene);
    EXPECT_THROW(FogModel{ scene }, std::invalid_argument);
  };
  wrong([](Scene& s) { s.fog.extinction.y = -1.0; });
  wrong([](Scene& s) { s.fog.extinction.x = std::nan(""); });
  wrong([](Scene& s) { s.fog.albedo.z = 1.5; });
  wrong([](Scene& s) { s.fog.falloff = -0.1; });
  wrong([](Scene& s) { s.fog.falloff = infinity; });
  wrong([](Scene& s) { s.fog.base_height = infinity; });
  wrong([](Scene& s) { s.sky.radiance.x = -1.0; });
  wrong([](Scene& s) { s.sky.up = dvec3(0.0, 0.0, 2.0); });
}

}
