// Pictures of fog without volumes: rays from pixels, surfaces, threads, and the time that they take.
#include "../support/transport_scenes.h"

#include "Transport/fog_film.h"

#include <gtest/gtest.h>

#include <chrono>
#include <limits>

using namespace transport_scenes;

namespace
{

constexpr double infinity = std::numeric_limits<double>::infinity();

Scene foggy_scene(const View& view)
{
  Scene scene;
  scene.volumes.clear();
  scene.fog.enabled = true;
  scene.fog.extinction = glm::dvec3(0.02, 0.03, 0.05);
  scene.fog.falloff = 0.2;
  PhaseLobe lobe;
  lobe.function = PhaseFunction::HenyeyGreenstein;
  lobe.anisotropy = 0.6;
  scene.fog.lobes = { lobe };
  Light sun;
  sun.diffuse = glm::dvec3(1.0, 0.9, 0.8);
  sun.direction = glm::normalize(glm::dvec3(0.3, -0.5, -0.4));
  scene.lights = { sun };
  scene.sky.radiance = glm::dvec3(0.1, 0.2, 0.4);
  scene.camera = view.camera(1.0);
  return scene;
}

View view_from(const glm::dvec3& eye, bool parallel)
{
  View view;
  view.forward = glm::normalize(glm::dvec3(0.2, 1.0, -0.1));
  view.up = glm::dvec3(0.0, 0.0, 1.0);
  view.distance = 10.0;
  view.centre = eye + view.forward * view.distance;
  view.half_height = 6.0;
  view.parallel = parallel;
  view.near_plane = 0.5;
  view.far_plane = 60.0;
  return view;
}

/// Normalised device depth of a place that is `distance` in front of the eye.
float depth_of(const View& view, double distance)
{
  const double n = view.near_plane;
  const double f = view.far_plane;
  return static_cast<float>(view.parallel ? (2.0 * distance - n - f) / (f - n)
                                          : (f + n - 2.0 * f * n / distance) / (f - n));
}

TEST(FogFilm, PixelsAreTheFogAlongTheirRays)
{
  const int width = 12;
  const int height = 8;
  for (bool parallel : { false, true })
  {
    for (double away : { 0.0, 1e6 }) // far from the origin, nothing else changes
    {
      const View view = view_from(glm::dvec3(away, -away, 3.0), parallel);
      Scene scene = foggy_scene(view);
      scene.camera = view.camera(double(width) / height);
      scene.surface_depth.assign(static_cast<std::size_t>(width) * height, 1.0f);
      for (int x = 0; x < width; ++x)
      {
        for (int y = 0; y < height; ++y)
        {
          scene.surface_depth[static_cast<std::size_t>(y) * width + x] =
            x % 3 == 0 ? 1.0f : x % 3 == 1 ? depth_of(view, 20.0) : depth_of(view, 2.0);
        }
      }
      Film film(width, height);
      ASSERT_TRUE(render_fog(scene, film));
      const FogModel fog(scene);
      for (int y = 0; y < height; ++y)
      {
        for (int x = 0; x < width; ++x)
        {
          long double near_point[3], far_point[3];
          view.ray(x, y, width, height, near_point, far_point);
          glm::dvec3 begin, way;
          for (int axis = 0; axis < 3; ++axis)
          {
            begin[axis] = static_cast<double>(near_point[axis]);
            way[axis] = static_cast<double>(far_point[axis] - near_point[axis]);
          }
          const double along = glm::dot(way, view.forward) / glm::length(way);
          const glm::dvec3 eye = parallel ? view.centre + begin
                                          : view.centre - view.forward * view.distance;
          const double surface = x % 3 == 1 ? 20.0 : 2.0;
          const double end = x % 3 == 0 ? infinity
                             : parallel ? surface - view.near_plane
                                        : surface / along;
          const FogRay ray = fog.ray(eye, glm::normalize(way));
          const glm::dvec3 t = fog.transmittance(ray, 0.0, end);
          const glm::dvec3 l = fog.radiance(ray, 0.0, end);
          const std::size_t pixel = static_cast<std::size_t>(y) * width + x;
          // A surface's depth is in single precision, and the far origin loses digits.
          const double loose = away > 0.0 ? 2e-4 : 2e-5;
          for (int c = 0; c < 3; ++c)
          {
            ASSERT_NEAR(film.transmittance[c][pixel], t[c], loose) << parallel << ' ' << x;
            ASSERT_NEAR(film.radiance[c][pixel], l[c], loose * (0.1 + l[c])) << parallel << ' ' << x;
          }
          // Half is absorbed where the film says, from the near plane on.
          const double near_plane = parallel ? 0.0 : view.near_plane / along;
          if (std::isfinite(film.depth[pixel]))
          {
            const glm::dvec3 half = fog.transmittance(ray, 0.0, film.depth[pixel] + near_plane);
            ASSERT_NEAR(std::max({ half.x, half.y, half.z }), 0.5, loose);
          }
          else
          {
            ASSERT_GE(std::max({ t.x, t.y, t.z }), 0.5 - 1e-6);
          }
        }
      }
    }
  }
}

TEST(FogFilm, IsTheSameForAnyNumberOfThreads)
{
  const View view = view_from(glm::dvec3(0.0, 0.0, 3.0), false);
  Scene scene = foggy_scene(view);
  Light lamp;
  lamp.positional = true;
  lamp.position = glm::dvec3(1.0, 8.0, 2.5);
  scene.lights.push_back(lamp);
  Film one(40, 30);
  Film many(40, 30);
  ASSERT_TRUE(render_fog(scene, one, 1));
  ASSERT_TRUE(render_fog(scene, many, 7));
  EXPECT_TRUE(same_bits(one, many));
  EXPECT_TRUE(all_finite(one));
}

TEST(FogFilm, WithoutFogIsEmpty)
{
  const View view = view_from(glm::dvec3(0.0, 0.0, 3.0), false);
  Scene scene = foggy_scene(view);
  Film empty(9, 7);
  for (int how = 0; how < 2; ++how)
  {
    Scene none = scene;
    how == 0 ? none.fog.enabled = false : (none.fog.extinction = glm::dvec3(0.0), true);
    Film film(9, 7);
    ASSERT_TRUE(render_fog(none, film));
    EXPECT_TRUE(same_bits(film, empty));
  }
}

TEST(FogFilm, StopsWhenItIsTold)
{
  const Scene scene = foggy_scene(view_from(glm::dvec3(0.0, 0.0, 3.0), false));
  Film film(64, 64);
  int calls = 0;
  EXPECT_FALSE(render_fog(scene, film, 1, [&](double) { return ++calls < 3; }));
  EXPECT_EQ(calls, 3);
  EXPECT_EQ(film.transmittance[0].back(), 1.0f);
}

TEST(FogFilm, RefusesSurfacesOfAnotherSize)
{
  Scene scene = foggy_scene(view_from(glm::dvec3(0.0, 0.0, 3.0), false));
  scene.surface_depth.assign(10, 0.0f);
  Film film(64, 64);
  EXPECT_THROW(render_fog(scene, film), std::invalid_argument);
}

TEST(FogFilm, TakesLittleTime)
{
  const Scene with_sky = foggy_scene(view_from(glm::dvec3(0.0, 0.0, 3.0), false));
  Scene scene = with_sky;
  const auto seconds = [&](const Scene& drawn)
  {
    const int edge = 256;
    Film film(edge, edge);
    double best = infinity;
    for (int i = 0; i < 3; ++i)
    {
      const auto start = std::chrono::steady_clock::now();
      render_fog(drawn, film);
      const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
      best = std::min(best, taken.count());
    }
    return 4.0 * best; // for 512²
  };
  scene.sky.radiance = glm::dvec3(0.0);
  const double sun = seconds(scene);
  const double all = seconds(with_sky);
  std::printf("seconds for 512²: sun %.3f, sun and sky in coloured fog %.3f\n", sun, all);
  // Generous bounds: machines differ, and others may use this one.
  EXPECT_LT(sun, 1.0);
  EXPECT_LT(all, 10.0);
}

}
