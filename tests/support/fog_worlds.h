// Boxes of linear densities in fog, and what they send along a ray, by quadrature.
#pragma once

#include "fog_truth.h"
#include "transport_scenes.h"

#include <boost/math/special_functions/expint.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <list>
#include <vector>

namespace fog_worlds
{

using namespace transport_scenes;
using namespace fog_truth;

constexpr int edge = 9; // pixels

/// A box of the world with matter in it.
struct Box
{
  dvec3 lower;
  dvec3 upper;
  double density = 1.0; ///< at `lower`
  dvec3 slope{ 0.0 };   ///< of the density
  dvec3 extinction{ 0.1 };
  bool lit = true;
  dvec3 albedo{ 0.9 };
  double g = 0.0;
  int octaves = 1;
  dvec3 colour{ 0.0 }; ///< what it sends where it is not lit
  bool classified = false;

  double at(const dvec3& p) const { return density + glm::dot(slope, p - lower); }

  /// The part of a ray that is inside, cut to [from, to].
  bool inside(const dvec3& origin, const dvec3& direction, double& from, double& to) const
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      const double a = (lower[axis] - origin[axis]) / direction[axis];
      const double b = (upper[axis] - origin[axis]) / direction[axis];
      from = std::max(from, std::min(a, b));
      to = std::min(to, std::max(a, b));
    }
    return from < to;
  }
  /// The depth along a ray of a channel whose extinction is 1.
  double depth(const dvec3& origin, const dvec3& direction, double from, double to) const
  {
    return inside(origin, direction, from, to)
      ? at(origin + direction * (0.5 * (from + to))) * (to - from)
      : 0.0;
  }
  bool holds(const dvec3& p) const
  {
    return p.x >= lower.x && p.y >= lower.y && p.z >= lower.z && p.x <= upper.x && p.y <= upper.y &&
      p.z <= upper.z;
  }
};

struct World
{
  std::vector<Box> boxes;
  Scene scene; ///< its fog, lights, sky and camera; its volumes are made of the boxes
  View view;
  double fog_g = 0.0;
  std::list<Voxels<float>> voxels;
  std::list<Voxels<std::uint8_t>> bytes;

  World()
  {
    scene.volumes.clear();
    scene.fog.enabled = true;
    scene.fog.extinction = dvec3(0.05);
    scene.fog.albedo = dvec3(0.9, 0.8, 0.7);
    scene.fog.base_height = -1.0;
    Light sun;
    sun.diffuse = dvec3(1.0, 0.9, 0.8);
    sun.direction = glm::normalize(dvec3(0.3, 0.4, -0.8));
    scene.lights = { sun };
    view.up = dvec3(0.0, 0.0, 1.0);
    look(dvec3(-9.0, -12.0, 4.0), dvec3(0.0));
  }

  void look(const dvec3& eye, const dvec3& centre, double half_height = 3.5)
  {
    view.centre = centre;
    view.forward = glm::normalize(centre - eye);
    view.distance = glm::length(centre - eye);
    view.half_height = half_height;
    view.near_plane = 0.05;
    view.far_plane = 60.0;
    scene.camera = view.camera(1.0);
  }

  Film march(
    ShadowMethod shadows = ShadowMethod::Rays, double step = 0.02, double shadow_step = 0.04)
  {
    make_volumes();
    Film film(edge, edge);
    Marcher marcher;
    MarchSettings settings;
    settings.step = step;
    settings.leave_error = 0.0;
    settings.shadows = shadows;
    settings.shadow_step = shadows == ShadowMethod::Rays ? 0.0 : shadow_step;
    settings.precise_shadows = true;
    marcher.render(scene, settings, film);
    return film;
  }

  void make_volumes()
  {
    scene.volumes.clear();
    for (const Box& box : boxes)
    {
      Volume volume;
      constexpr int n = 9;
      const dvec3 spacing = (box.upper - box.lower) / double(n - 1);
      volume.data_from_index = placed(spacing, box.lower);
      if (box.classified)
      {
        bytes.emplace_back(n, n, n, [](int, int, int) { return 1; });
        volume.grid = bytes.back().grid();
        volume.classification = classify(
          0.0, 2.0, [&](double) { return -std::expm1(-box.density * box.extinction.x); },
          [&](double) { return box.colour; }, 5);
      }
      else
      {
        voxels.emplace_back(n, n, n, [&](int i, int j, int k)
          { return box.at(box.lower + spacing * dvec3(i, j, k)); });
        volume.grid = voxels.back().grid();
        volume.meaning = ValueMeaning::Density;
        const double largest = std::max({ box.extinction.x, box.extinction.y, box.extinction.z });
        volume.density.extinction = largest;
        volume.density.channels = box.extinction / largest;
      }
      volume.medium.lit = box.lit;
      volume.medium.albedo = box.albedo;
      volume.medium.octaves.count = box.octaves;
      if (box.g != 0.0)
      {
        PhaseLobe lobe;
        lobe.function = PhaseFunction::HenyeyGreenstein;
        lobe.anisotropy = box.g;
        volume.medium.lobes = { lobe };
      }
      scene.volumes.push_back(volume);
    }
    scene.fog.lobes.clear();
    if (fog_g != 0.0)
    {
      PhaseLobe lobe;
      lobe.function = PhaseFunction::HenyeyGreenstein;
      lobe.anisotropy = fog_g;
      scene.fog.lobes = { lobe };
    }
  }

  Matter fog(int c, const dvec3& origin, const dvec3& direction) const
  {
    return { scene.fog.extinction[c], scene.fog.falloff, origin.z - scene.fog.base_height,
      direction.z };
  }

  /// Where shadows of volumes count: inside of their boxes.
  bool in_box(const dvec3& p) const
  {
    return std::any_of(boxes.begin(), boxes.end(), [&](const Box& box) { return box.holds(p); });
  }

  /// What is sent at p along a ray's way back, by unit of length. Volumes begin at the near plane.
  double sent(int c, const dvec3& p, const dvec3& direction, bool behind_near_plane) const
  {
    const double fog_here = fog(c, p, direction).at(0.0);
    const bool shaded = behind_near_plane && in_box(p);
    const double falloff = scene.fog.falloff;
    double sum = 0.0;
    const auto volume_depth = [&](const dvec3& way, double to)
    {
      double depth = 0.0;
      for (const Box& box : boxes)
      {
        depth += shaded ? box.extinction[c] * box.depth(p, way, 0.0, to) : 0.0;
      }
      return depth;
    };
    for (const Light& light : scene.lights)
    {
      dvec3 travel = light.direction;
      double to = infinity;
      double strength = 1.0;
      double dimmed = 0.0;
      if (light.positional)
      {
        to = glm::length(p - light.position);
        travel = (p - light.position) / to;
        strength =
          1.0 / (light.attenuation.x + light.attenuation.y * to + light.attenuation.z * to * to);
        dimmed = fog(c, p, -travel).depth(0.0, to);
      }
      else if (falloff > 0.0)
      {
        dimmed = fog(c, p, -travel).depth(0.0, infinity);
      }
      const double matter = volume_depth(-travel, to);
      const double cosine = -glm::dot(travel, direction);
      const double irradiance = pi * light.diffuse[c] * strength * std::exp(-dimmed);
      sum += fog_here * scene.fog.albedo[c] * irradiance * henyey_greenstein(fog_g, cosine) *
        std::exp(-matter);
      for (const Box& box : boxes)
      {
        for (int m = 0; m < box.octaves && box.lit && shaded && box.holds(p); ++m)
        {
          const double thinner = std::pow(0.5, m);
          sum += box.extinction[c] * box.at(p) * box.albedo[c] * irradiance * thinner *
            henyey_greenstein(box.g * thinner, cosine) * std::exp(-thinner * matter);
        }
      }
    }
    // The sky.
    const double upward =
      volume_depth(dvec3(1e-14, 1e-14, 1.0), infinity) + (falloff > 0.0 ? fog_here / falloff : 0.0);
    const double downward = volume_depth(dvec3(1e-14, 1e-14, -1.0), infinity);
    double around = 0.0;
    if (scene.sky.radiance[c] > 0.0)
    {
      around += 0.5 * scene.sky.radiance[c] * boost::math::expint(2, upward);
    }
    if (scene.sky.ground[c] > 0.0 && falloff == 0.0)
    {
      around += 0.5 * scene.sky.ground[c] * boost::math::expint(2, downward);
    }
    sum += fog_here * scene.fog.albedo[c] * around;
    for (const Box& box : boxes)
    {
      if (shaded && box.holds(p))
      {
        sum += box.extinction[c] * box.at(p) * (box.lit ? box.albedo[c] * around : box.colour[c]);
      }
    }
    return sum;
  }

  /// Radiance and transmittance of a pixel's ray.
  std::array<double, 2> truth(int c, int x, int y, double surface = infinity) const
  {
    long double near_point[3], far_point[3];
    view.ray(x, y, edge, edge, near_point, far_point);
    dvec3 way;
    for (int axis = 0; axis < 3; ++axis)
    {
      way[axis] = static_cast<double>(far_point[axis] - near_point[axis]);
    }
    const dvec3 direction = glm::normalize(way);
    const dvec3 eye = view.centre - view.forward * view.distance;
    const double end = surface / glm::dot(direction, view.forward);
    // Volumes begin behind the near plane.
    const double nearest = view.near_plane / glm::dot(direction, view.forward);
    const auto depth = [&](double s)
    {
      double sum = fog(c, eye, direction).depth(0.0, s);
      for (const Box& box : boxes)
      {
        sum += box.extinction[c] * box.depth(eye, direction, nearest, s);
      }
      return sum;
    };
    std::vector<double> places{ nearest };
    for (const Box& box : boxes)
    {
      double from = nearest;
      double to = end;
      if (box.inside(eye, direction, from, to))
      {
        places.push_back(from);
        places.push_back(to);
      }
    }
    for (const Light& light : scene.lights)
    {
      places.push_back(glm::dot(light.position - eye, direction));
    }
    const double radiance = integral(
      [&](double s)
      {
        const double passes = std::exp(-depth(s));
        return passes > 1e-12 ? passes * sent(c, eye + direction * s, direction, s > nearest) : 0.0;
      },
      0.0, end, places);
    return { radiance, std::exp(-depth(end)) };
  }

  /// Pixels that are compared: all over the picture, a few.
  template <class Check>
  void for_some_pixels(const Check& check) const
  {
    for (int y = 1; y < edge; y += 3)
    {
      for (int x = y % 2; x < edge; x += 2)
      {
        for (int c = 0; c < 3; ++c)
        {
          check(static_cast<std::size_t>(y) * edge + x, x, y, c);
        }
      }
    }
  }

  /// The largest difference of a film from the truth, as a fraction of the picture's brightest pixel.
  double worst(const Film& film, double surface = infinity) const
  {
    double most = 0.0;
    double brightest = 0.0;
    for_some_pixels(
      [&](std::size_t pixel, int x, int y, int c)
      {
        const auto [radiance, transmittance] = truth(c, x, y, surface);
        EXPECT_TRUE(std::isfinite(film.radiance[c][pixel]));
        EXPECT_NEAR(film.transmittance[c][pixel], transmittance, 2e-5) << x << ' ' << y << ' ' << c;
        most = std::max(most, std::abs(film.radiance[c][pixel] - radiance));
        brightest = std::max(brightest, radiance);
      });
    EXPECT_GT(brightest, 1e-3);
    return most / brightest;
  }
};

inline Box cloud()
{
  Box box;
  box.lower = dvec3(-2.0, -1.5, -1.0);
  box.upper = dvec3(1.0, 2.0, 1.5);
  box.density = 0.5;
  box.slope = dvec3(0.4, 0.1, 0.3);
  box.extinction = dvec3(0.3);
  return box;
}

inline Box tissue()
{
  Box box;
  box.lower = dvec3(1.5, -1.0, -1.2);
  box.upper = dvec3(3.0, 1.0, 1.0);
  box.density = 0.7;
  box.extinction = dvec3(0.5);
  box.lit = false;
  box.classified = true;
  box.colour = dvec3(0.9, 0.3, 0.1);
  return box;
}

// The worlds of the tests. -----------------------------------------------------------------------

inline World density_in_even_fog()
{
  World world;
  world.boxes = { cloud() };
  world.fog_g = 0.5;
  world.boxes[0].g = 0.7;
  return world;
}

inline World coloured_in_coloured_layers()
{
  World world;
  world.boxes = { cloud() };
  world.boxes[0].extinction = dvec3(0.3, 0.2, 0.1);
  world.boxes[0].octaves = 3;
  world.scene.fog.extinction = dvec3(0.05, 0.1, 0.2);
  world.scene.fog.falloff = 0.7;
  world.fog_g = 0.6;
  return world;
}

inline World colour_in_layers()
{
  World world;
  world.boxes = { tissue() };
  world.scene.fog.falloff = 0.3;
  return world;
}

inline World unlit_density_in_fog()
{
  World world;
  world.boxes = { cloud() };
  world.boxes[0].lit = false;
  return world;
}

/// From outside, from beside and from between the two.
inline const dvec3 eyes_on_two[3] = { { -9.0, -12.0, 4.0 }, { 12.0, 1.0, 0.5 }, { -0.5, 0.3, 0.2 } };

inline World two_in_layers(const dvec3& eye)
{
  World world;
  world.boxes = { cloud(), tissue() };
  world.scene.fog.falloff = 0.2;
  world.look(eye, dvec3(0.6, 0.1, 0.0));
  return world;
}

/// A device depth so far from the eye.
inline float surface_at(const World& world, double away)
{
  const double n = world.view.near_plane;
  const double f = world.view.far_plane;
  return static_cast<float>((f + n - 2.0 * f * n / away) / (f - n));
}

inline const dvec3 lamps_of_world[2] = { { -3.0, -4.0, 3.0 }, { -0.2, 0.4, 0.3 } };

inline World world_with_lamp(const dvec3& place)
{
  World world;
  world.boxes = { cloud() };
  world.scene.fog.falloff = 0.4;
  Light lamp;
  lamp.positional = true;
  lamp.position = place;
  lamp.attenuation = dvec3(0.5, 0.0, 0.5);
  world.scene.lights = { lamp };
  return world;
}

inline World world_under_sky(double falloff)
{
  World world;
  world.boxes = { cloud() };
  world.scene.lights.clear();
  world.scene.sky.radiance = dvec3(0.5, 0.7, 1.0);
  world.scene.sky.ground = dvec3(0.3, 0.2, 0.1);
  world.scene.fog.falloff = falloff;
  world.scene.fog.extinction = dvec3(0.05, 0.05, 0.15);
  return world;
}

inline World cloud_in_layers()
{
  World world;
  world.boxes = { cloud() };
  world.scene.fog.falloff = 0.3;
  return world;
}

inline World sun_under_horizon()
{
  World world = cloud_in_layers();
  world.scene.lights[0].direction = glm::normalize(dvec3(0.3, 0.4, 0.1));
  return world;
}

inline World all_in_fog(bool layers)
{
  World world;
  world.boxes = { cloud(), tissue() };
  world.boxes[0].octaves = 2;
  world.scene.fog.extinction = dvec3(0.05, 0.07, 0.1);
  world.scene.fog.falloff = layers ? 0.3 : 0.0;
  world.scene.fog.base_height = layers ? -3.0 : 0.0;
  world.scene.sky.radiance = dvec3(0.2);
  world.scene.sky.ground = dvec3(0.1);
  return world;
}

}
