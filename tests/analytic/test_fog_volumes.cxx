// Volumes in fog, drawn as one, against quadrature along each ray of all that dims and sends: boxes whose
// densities are linear in space, so that optical depths through them are those of their middles.
#include "../support/fog_worlds.h"

#include "Transport/marcher.h"
#include "Transport/reference.h"

#include <gtest/gtest.h>

using namespace fog_worlds;

namespace
{

TEST(FogAndVolumes, ALitDensityInEvenFog)
{
  World world = density_in_even_fog();
  EXPECT_LT(world.worst(world.march()), 3e-4);
}

TEST(FogAndVolumes, ColouredMatterInColouredLayers)
{
  World world = coloured_in_coloured_layers();
  EXPECT_LT(world.worst(world.march()), 3e-4);
}

TEST(FogAndVolumes, MatterThatSendsItsColour)
{
  World world = colour_in_layers();
  EXPECT_LT(world.worst(world.march()), 3e-4);
}

TEST(FogAndVolumes, ADensityThatIsNotLitShadowsTheFogInIt)
{
  World world = unlit_density_in_fog();
  EXPECT_LT(world.worst(world.march()), 3e-4);
}

TEST(FogAndVolumes, FogFillsTheGapsBetweenVolumes)
{
  for (const dvec3& eye : eyes_on_two)
  {
    World world = two_in_layers(eye);
    EXPECT_LT(world.worst(world.march()), 3e-4) << eye.x;
  }
}

TEST(FogAndVolumes, SurfacesEndBoth)
{
  for (double surface : { 5.0, 14.5, 25.0 })
  {
    World world;
    world.boxes = { cloud() };
    const double n = world.view.near_plane;
    const double f = world.view.far_plane;
    const float depth = surface_at(world, surface);
    world.scene.surface_depth.assign(edge * edge, depth);
    const double exact = 2.0 * f * n / (f + n - double(depth) * (f - n)); // of the rounded depth
    EXPECT_LT(world.worst(world.march(), exact), 3e-4) << surface;
  }
}

TEST(FogAndVolumes, LampsOutsideAndInside)
{
  for (const dvec3& place : lamps_of_world)
  {
    World world = world_with_lamp(place);
    EXPECT_LT(world.worst(world.march()), 1e-3) << place.x;
  }
}

TEST(FogAndVolumes, LightOfTheSky)
{
  for (double falloff : { 0.0, 0.5 })
  {
    World world = world_under_sky(falloff);
    EXPECT_LT(world.worst(world.march(ShadowMethod::Rays)), 4e-3) << falloff;
  }
}

TEST(FogAndVolumes, LightVolumesAndFunctionsOfDepth)
{
  for (ShadowMethod shadows : { ShadowMethod::Volume, ShadowMethod::Functions })
  {
    World world = cloud_in_layers();
    EXPECT_LT(world.worst(world.march(shadows)), shadows == ShadowMethod::Volume ? 3e-3 : 3e-2)
      << shadow_method_name(shadows);
  }
}

TEST(FogAndVolumes, ADirectionalLightUnderTheHorizonLightsNothingInLayers)
{
  World world = sun_under_horizon();
  const Film film = world.march();
  for (int c = 0; c < 3; ++c)
  {
    for (std::size_t i = 0; i < film.size(); ++i)
    {
      ASSERT_EQ(film.radiance[c][i], 0.0f);
    }
  }
}

TEST(FogAndVolumes, DepthIsWhereHalfIsAbsorbed)
{
  World world;
  world.boxes = { cloud() };
  world.boxes[0].density = 0.05;
  world.boxes[0].slope = dvec3(0.0);
  world.scene.fog.extinction = dvec3(0.08);
  const Film film = world.march();
  int in_front = 0;
  int behind = 0;
  world.for_some_pixels(
    [&](std::size_t pixel, int x, int y, int)
    {
      ASSERT_TRUE(std::isfinite(film.depth[pixel])) << film.depth[pixel] << ' ' << film.transmittance[0][pixel];
      const double along = film.depth[pixel]; // from the near plane
      long double near_point[3], far_point[3];
      world.view.ray(x, y, edge, edge, near_point, far_point);
      dvec3 way;
      for (int axis = 0; axis < 3; ++axis)
        way[axis] = static_cast<double>(far_point[axis] - near_point[axis]);
      const dvec3 direction = glm::normalize(way);
      const dvec3 eye = world.view.centre - world.view.forward * world.view.distance;
      const double nearest = world.view.near_plane / glm::dot(direction, world.view.forward);
      const double s = along + nearest;
      const double passes = std::exp(-world.fog(0, eye, direction).depth(0.0, s) -
        world.boxes[0].extinction.x * world.boxes[0].depth(eye, direction, nearest, s));
      ASSERT_NEAR(passes, 0.5, 3e-3) << x << ' ' << y;
      double from = 0.0;
      double to = infinity;
      if (world.boxes[0].inside(eye, direction, from, to))
      {
        in_front += s < from;
        behind += s > to;
      }
    });
  EXPECT_GT(in_front, 0);
}

TEST(FogAndVolumes, TheReferenceDrawsThemToo)
{
  for (int how = 0; how < 2; ++how)
  {
    World world = all_in_fog(how == 0);
    world.make_volumes();
    Film film(edge, edge);
    ReferenceSettings settings;
    settings.tolerance = 1e-6;
    EXPECT_TRUE(render_reference(world.scene, settings, film).completed);
    EXPECT_LT(world.worst(film), 2e-4) << how;
    const Film marched = world.march();
    // The marcher reads the sky's light from a lattice of the volumes' voxels.
    EXPECT_LT(difference(film, marched), 2e-3) << how;
    for (std::size_t i = 0; i < film.size(); ++i)
    {
      ASSERT_NEAR(marched.depth[i], film.depth[i], 0.1); // pieces of the reference
    }
  }
  // Without volumes.
  World world;
  world.scene.volumes.clear();
  Film film(edge, edge);
  EXPECT_TRUE(render_reference(world.scene, {}, film).completed);
  Film marched(edge, edge);
  Marcher().render(world.scene, {}, marched);
  EXPECT_TRUE(same_bits(film, marched));
  EXPECT_LT(world.worst(film), 1e-5);
}

/// Dense fog, far away, steep layers: nothing that is not a number.
TEST(FogAndVolumes, StayFinite)
{
  for (double extinction : { 1e-12, 1.0, 1e20 })
  {
    for (double falloff : { 0.0, 1e-9, 5.0, 1e6 })
    {
      for (double height : { -1e7, 0.0, 1e7 })
      {
        World world;
        world.boxes = { cloud(), tissue() };
        world.scene.fog.extinction = dvec3(extinction, 0.5 * extinction, 0.0);
        world.scene.fog.falloff = falloff;
        world.scene.fog.base_height = height;
        Light lamp;
        lamp.positional = true;
        lamp.position = dvec3(0.0, 0.0, 2.0);
        world.scene.lights.push_back(lamp);
        world.scene.sky.radiance = world.scene.sky.ground = dvec3(1.0);
        const Film film = world.march(ShadowMethod::Volume, 0.3, 0.5);
        ASSERT_TRUE(all_finite(film)) << extinction << ' ' << falloff << ' ' << height;
        for (std::size_t i = 0; i < film.size(); ++i)
        {
          ASSERT_GE(film.transmittance[0][i], 0.0f);
          ASSERT_LE(film.transmittance[0][i], 1.0f);
          ASSERT_GE(film.radiance[0][i], 0.0f);
        }
      }
    }
  }
}

TEST(FogAndVolumes, ThreadsAndTargetsAgree)
{
  World world;
  world.boxes = { cloud(), tissue() };
  world.scene.fog.falloff = 0.2;
  world.make_volumes();
  const Film one = transport_scenes::march(world.scene, edge, edge, 0.1, 0.0, 1);
  const Film many = transport_scenes::march(world.scene, edge, edge, 0.1, 0.0, 5);
  EXPECT_TRUE(same_bits(one, many));
  for (const std::string& target : targets())
  {
    ASSERT_TRUE(force_simd_target(target));
    const Film other = transport_scenes::march(world.scene, edge, edge, 0.1);
    EXPECT_LT(difference(one, other), 1e-5) << target;
  }
  force_simd_target("");
}

}
