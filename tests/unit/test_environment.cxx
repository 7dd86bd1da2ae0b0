// Environment maps: directions, solid angles, and lights that carry all of the map's irradiance.
#include "Transport/environment.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/matrix.hpp>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

using brume::EnvironmentMap;
using brume::Light;

namespace
{

constexpr double pi = glm::pi<double>();

EnvironmentMap constant(int width, int height, float r, float g, float b)
{
  EnvironmentMap map;
  map.width = width;
  map.height = height;
  for (int i = 0; i < width * height; ++i)
  {
    map.rgb.insert(map.rgb.end(), { r, g, b });
  }
  return map;
}

/// A sky that is brighter above, with a small sun that has most of the energy.
EnvironmentMap sky_with_sun(int width, int height)
{
  EnvironmentMap map = constant(width, height, 0, 0, 0);
  std::mt19937 random(7);
  std::uniform_real_distribution<float> noise(0.0f, 1.0f);
  for (int y = 0; y < height; ++y)
  {
    for (int x = 0; x < width; ++x)
    {
      float* pixel = &map.rgb[3 * (y * width + x)];
      const float up = float(y) / float(height);
      pixel[0] = up * (0.2f + 0.1f * noise(random));
      pixel[1] = up * (0.4f + 0.1f * noise(random));
      pixel[2] = up * (0.9f + 0.1f * noise(random));
      if (std::abs(x - width / 3) < 3 && std::abs(y - 2 * height / 3) < 3)
      {
        pixel[0] = 4e4f;
        pixel[1] = 3e4f;
        pixel[2] = 2e4f;
      }
    }
  }
  return map;
}

/// Σ L Δω, summed here by the sines of the pixels' edges.
glm::dvec3 irradiance_of(const EnvironmentMap& map)
{
  glm::dvec3 sum(0.0);
  for (int y = 0; y < map.height; ++y)
  {
    const double lower = std::sin(pi * (double(y) / map.height - 0.5));
    const double upper = std::sin(pi * (double(y + 1) / map.height - 0.5));
    for (int x = 0; x < map.width; ++x)
    {
      for (int c = 0; c < 3; ++c)
      {
        const double value = map.rgb[3 * (y * map.width + x) + c];
        sum[c] += value > 0.0 && std::isfinite(value)
                    ? value * (upper - lower) * 2.0 * pi / map.width
                    : 0.0;
      }
    }
  }
  return sum;
}

glm::dvec3 irradiance_of(const std::vector<Light>& lights)
{
  glm::dvec3 sum(0.0);
  for (const Light& light : lights)
  {
    sum += pi * light.diffuse; // what Light::diffuse means
  }
  return sum;
}

void expect_same(const glm::dvec3& a, const glm::dvec3& b, double relative)
{
  for (int c = 0; c < 3; ++c)
  {
    EXPECT_NEAR(a[c], b[c], relative * std::abs(b[c])) << c;
  }
}

TEST(Environment, PixelsCoverTheSphereOnce)
{
  for (const auto& [width, height] : { std::pair(2, 1), std::pair(64, 32), std::pair(1000, 333) })
  {
    double sum = 0.0;
    for (int y = 0; y < height; ++y)
    {
      sum += width * brume::environment_solid_angle(y, width, height);
    }
    EXPECT_NEAR(sum, 4.0 * pi, 1e-12 * 4.0 * pi);
    // The cap around a pole: 2π (1 − cos of the row's opening).
    const double cap = 2.0 * pi * (1.0 - std::cos(pi / height));
    EXPECT_NEAR(width * brume::environment_solid_angle(height - 1, width, height), cap, 1e-9 * cap);
  }
}

TEST(Environment, DirectionsAreSeenFromInside)
{
  const auto at = [](double x, double y) { return brume::environment_direction(x, y, 64, 32); };
  const auto expect = [](const glm::dvec3& a, const glm::dvec3& b)
  { EXPECT_LT(glm::length(a - b), 1e-12) << a.x << ' ' << a.y << ' ' << a.z; };
  expect(at(32, 16), { 0, 1, 0 });
  expect(at(48, 16), { 1, 0, 0 }); // to the right when one looks along +y with z up
  expect(at(16, 16), { -1, 0, 0 });
  expect(at(0, 16), { 0, -1, 0 });
  expect(at(5, 32), { 0, 0, 1 });
  expect(at(5, 0), { 0, 0, -1 });
  EXPECT_NEAR(glm::length(at(11.5, 20.5)), 1.0, 1e-15);
}

TEST(Environment, FramesAreRotationsThatRaiseZToUp)
{
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  std::vector<glm::dvec3> ups = {
    { 0, 0, 1 }, { 0, 0, -1 }, { 0, 1, 0 }, { -1, 0, 0 }, { 1e-9, 0, -1 }, { 3e-5, -4e-5, -1 }
  };
  for (int i = 0; i < 50; ++i)
  {
    ups.push_back({ normal(random), normal(random), normal(random) });
  }
  for (glm::dvec3 up : ups)
  {
    up = glm::normalize(up);
    for (double degrees : { 0.0, 30.0, -200.0, 1e6 })
    {
      const glm::dmat3 m = brume::world_from_environment(up, degrees);
      EXPECT_LT(glm::length(m * glm::dvec3(0, 0, 1) - up), 1e-12);
      const glm::dmat3 one = glm::transpose(m) * m;
      for (int c = 0; c < 3; ++c)
      {
        for (int r = 0; r < 3; ++r)
        {
          EXPECT_NEAR(one[c][r], c == r, 1e-12) << up.x << ' ' << up.y << ' ' << up.z;
        }
      }
      EXPECT_NEAR(glm::determinant(m), 1.0, 1e-12);
    }
  }
  const auto expect = [](const glm::dvec3& a, const glm::dvec3& b)
  { EXPECT_LT(glm::length(a - b), 1e-12) << a.x << ' ' << a.y << ' ' << a.z; };
  // What the header promises of the usual two.
  const glm::dvec3 middle(0, 1, 0);
  const glm::dvec3 right(1, 0, 0);
  expect(brume::world_from_environment({ 0, 1, 0 }, 0.0) * middle, { 0, 0, -1 });
  expect(brume::world_from_environment({ 0, 1, 0 }, 0.0) * right, { 1, 0, 0 });
  expect(brume::world_from_environment({ 0, 0, 1 }, 90.0) * right, { 0, 1, 0 });
}

TEST(Environment, LightsCarryAllTheIrradiance)
{
  for (const EnvironmentMap& map : { constant(128, 64, 1.0f, 0.5f, 0.25f),
         sky_with_sun(256, 128),
         constant(7, 3, 0.1f, 2.0f, 0.0f) })
  {
    for (int count : { 1, 2, 3, 16, 100 })
    {
      const std::vector<Light> lights = brume::environment_lights(map, count);
      EXPECT_LE(int(lights.size()), count);
      expect_same(irradiance_of(lights), irradiance_of(map), 1e-6);
      for (const Light& light : lights)
      {
        EXPECT_NEAR(glm::length(light.direction), 1.0, 1e-12);
        EXPECT_FALSE(light.positional);
        EXPECT_EQ(light.specular, light.diffuse);
      }
    }
  }
}

// Of a constant map the parts are alike in energy, and their lights add up to no direction.
TEST(Environment, AConstantMapIsLitEvenlyFromAllAround)
{
  const EnvironmentMap map = constant(256, 128, 1.0f, 1.0f, 1.0f);
  const std::vector<Light> lights = brume::environment_lights(map, 64);
  ASSERT_EQ(lights.size(), 64u);
  glm::dvec3 flow(0.0);
  for (const Light& light : lights)
  {
    EXPECT_NEAR(pi * light.diffuse.x, 4.0 * pi / 64, 0.15 * 4.0 * pi / 64);
    flow += pi * light.diffuse.x * light.direction;
  }
  EXPECT_LT(glm::length(flow), 0.02 * 4.0 * pi);
  // What a facing surface gets of them is near the sky's π.
  for (const glm::dvec3& normal :
    { glm::dvec3(0, 0, 1), glm::dvec3(1, 0, 0), glm::normalize(glm::dvec3(1, -2, 0.5)) })
  {
    double sum = 0.0;
    for (const Light& light : lights)
    {
      sum += pi * light.diffuse.x * std::max(0.0, -glm::dot(normal, light.direction));
    }
    EXPECT_NEAR(sum, pi, 0.03 * pi);
  }
}

TEST(Environment, ASingleBrightPixelIsOneLightFromThere)
{
  EnvironmentMap map = constant(64, 32, 0.0f, 0.0f, 0.0f);
  const int x = 50;
  const int y = 20;
  float* pixel = &map.rgb[3 * (y * map.width + x)];
  pixel[0] = 100.0f;
  pixel[1] = 10.0f;
  const glm::dmat3 frame = brume::world_from_environment(glm::normalize(glm::dvec3(1, 2, 3)), 40.0);
  const std::vector<Light> lights = brume::environment_lights(map, 16, frame);
  ASSERT_EQ(lights.size(), 1u);
  const glm::dvec3 toward = frame * brume::environment_direction(x + 0.5, y + 0.5, 64, 32);
  EXPECT_LT(glm::length(lights[0].direction + toward), 1e-12);
  const double solid_angle = brume::environment_solid_angle(y, 64, 32);
  expect_same(pi * lights[0].diffuse, { 100.0 * solid_angle, 10.0 * solid_angle, 0.0 }, 1e-7);
}

TEST(Environment, TheSunIsFoundAmongTheSky)
{
  const EnvironmentMap map = sky_with_sun(256, 128);
  const glm::dvec3 sun = brume::environment_direction(256 / 3 + 0.5, 2 * 128 / 3 + 0.5, 256, 128);
  double near_sun = 0.0;
  for (const Light& light : brume::environment_lights(map, 16))
  {
    near_sun += glm::dot(-light.direction, sun) > std::cos(0.1) ? light.diffuse.x : 0.0;
  }
  double exact = 0.0;
  for (int y = 0; y < map.height; ++y)
  {
    for (int x = 0; x < map.width; ++x)
    {
      const float red = map.rgb[3 * (y * map.width + x)];
      exact += red > 100.0f ? red * brume::environment_solid_angle(y, 256, 128) / pi : 0.0;
    }
  }
  EXPECT_NEAR(near_sun, exact, 0.01 * exact);
}

TEST(Environment, WhatIsNoLightCountsAsDark)
{
  EnvironmentMap map = constant(8, 4, 1.0f, 1.0f, 1.0f);
  map.rgb[0] = std::numeric_limits<float>::quiet_NaN();
  map.rgb[4] = std::numeric_limits<float>::infinity();
  map.rgb[8] = -5.0f;
  expect_same(irradiance_of(brume::environment_lights(map, 5)), irradiance_of(map), 1e-6);
  EXPECT_TRUE(brume::environment_lights(constant(8, 4, 0, -1, 0), 5).empty());
}

TEST(Environment, RefusesWhatIsNoMap)
{
  EnvironmentMap map = constant(8, 4, 1, 1, 1);
  EXPECT_THROW(brume::environment_lights(map, 0), std::invalid_argument);
  map.rgb.pop_back();
  EXPECT_THROW(brume::environment_lights(map, 1), std::invalid_argument);
  EXPECT_THROW(brume::environment_lights(EnvironmentMap(), 1), std::invalid_argument);
}

}
