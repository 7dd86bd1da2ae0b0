// Small scenes for plans of effects (effect_plan.h): each is about one effect or two.
#pragma once

#include "transport_scenes.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

namespace plan_scenes
{

using namespace transport_scenes;

constexpr int pixels = 56; ///< of pictures whose surfaces are given
constexpr int n = 36;      ///< voxels along each edge

/// A rough ball in [0, 1], 0 toward the faces.
inline double matter(int i, int j, int k)
{
  const auto at = [](int v) { return 2.0 * v / (n - 1) - 1.0; };
  const double x = at(i), y = at(j), z = at(k);
  const double bumps = 0.35 * std::sin(5.0 * x + 1.0) * std::sin(6.0 * y) * std::sin(4.0 * z + 2.0);
  return std::clamp(1.6 * (0.75 - std::sqrt(x * x + y * y + z * z) + bumps), 0.0, 1.0);
}

struct Case
{
  std::string name;
  Scene scene;
  std::shared_ptr<Voxels<float>> voxels;
  std::shared_ptr<Voxels<float>> temperatures;
};

inline void PrintTo(const Case& c, std::ostream* out)
{
  *out << c.name;
}

inline Light sun(const glm::dvec3& direction, const glm::dvec3& colour = glm::dvec3(1.0))
{
  Light light;
  light.direction = glm::normalize(direction);
  light.diffuse = colour;
  light.specular = colour;
  return light;
}

/// A ball of an optical depth of `depth` or so through its middle, a unit cube about the origin.
inline Case lit_ball(const std::string& name, double depth)
{
  static std::uint64_t revision = 1;
  Case c;
  c.name = name;
  c.voxels = std::make_shared<Voxels<float>>(n, n, n, matter);
  Volume& volume = c.scene.volumes[0];
  volume.grid = c.voxels->grid();
  volume.data_from_index = placed(glm::dvec3(1.0 / (n - 1)), glm::dvec3(-0.5));
  volume.meaning = ValueMeaning::Density;
  volume.density.extinction = depth / 0.6;
  volume.medium.lit = true;
  volume.data_revision = ++revision;
  volume.medium_revision = ++revision;
  c.scene.lights = { sun({ 0.3, -1.0, -0.2 }) };
  c.scene.camera = view_of(c.scene, { -0.45, 0.35, -0.82 }, false).camera(1.0);
  return c;
}

inline Case classified_ball(const std::string& name, double opacity)
{
  Case c = lit_ball(name, 1.0);
  Volume& volume = c.scene.volumes[0];
  volume.meaning = ValueMeaning::Classified;
  volume.medium.lit = false;
  volume.classification = classify(
    0.0,
    1.0,
    [=](double v) { return v < 0.2 ? 0.0 : opacity * (v - 0.2); },
    [](double v) { return glm::dvec3(0.9, 0.3 + 0.5 * v, 0.2); },
    1025);
  volume.classification.unit_distance = 0.05;
  return c;
}

inline void give_temperatures(Case& c, double kelvin)
{
  c.temperatures = std::make_shared<Voxels<float>>(
    n, n, n, [=](int i, int j, int k) { return kelvin * std::pow(matter(i, j, k), 0.5); });
  Medium& medium = c.scene.volumes[0].medium;
  medium.temperature = c.temperatures->grid();
  medium.black_body = 1.0;
}

inline std::vector<Case> all_cases()
{
  std::vector<Case> cases;
  const auto add = [&](Case c) -> Scene&
  {
    cases.push_back(std::move(c));
    return cases.back().scene;
  };
  const std::vector<PhaseLobe> forward = { { PhaseFunction::HenyeyGreenstein, 1.0, 0.85 } };
  {
    Scene& s = add(lit_ball("thin", 0.002));
    s.volumes[0].medium.lobes = forward;
    s.sky.radiance = { 0.2, 0.3, 0.5 };
  }
  {
    Scene& s = add(lit_ball("thick", 30.0));
    s.volumes[0].medium.albedo = glm::dvec3(0.9);
    s.volumes[0].medium.octaves.count = 4;
    s.sky.radiance = { 0.01, 0.015, 0.02 };
  }
  {
    Scene& s = add(lit_ball("dark", 2.0));
    s.volumes[0].medium.albedo = glm::dvec3(0.0);
    s.sky.radiance = glm::dvec3(1.0);
  }
  {
    Scene& s = add(lit_ball("white", 4.0));
    s.sky.radiance = glm::dvec3(0.6);
    s.sky.ground = glm::dvec3(0.3, 0.2, 0.1);
    s.lights.push_back(sun({ -1.0, -0.2, 0.4 }, { 0.2, 0.1, 0.4 }));
    s.volumes[0].medium.octaves = { 3, 0.5, 0.4, 0.5 };
  }
  add(lit_ball("isotropic", 1.0));
  {
    Scene& s = add(lit_ball("forward", 1.5));
    s.volumes[0].medium.lobes = { { PhaseFunction::HenyeyGreenstein, 1.0, 0.9 } };
    s.lights[0] = sun({ 0.45, -0.35, 0.82 });
    s.volumes[0].medium.octaves.count = 3;
  }
  {
    // The light shines into the camera through the ball.
    Scene& s = add(lit_ball("lit from behind", 0.3));
    s.volumes[0].medium.lobes = { { PhaseFunction::HenyeyGreenstein, 0.7, 0.8 },
      { PhaseFunction::HenyeyGreenstein, 0.3, -0.3 } };
    s.lights[0] = sun({ 0.5, -0.3, 0.8 });
    s.volumes[0].medium.silver_lining.enabled = true;
    s.volumes[0].medium.silver_lining.strength = 0.5;
  }
  {
    Scene& s = add(lit_ball("no light", 3.0));
    s.lights.clear();
  }
  {
    Scene& s = add(lit_ball("emitting", 0.5));
    s.volumes[0].medium.emission = { 0.8, 0.3, 0.05 };
    s.volumes[0].medium.albedo = glm::dvec3(0.02);
    s.lights[0].diffuse = glm::dvec3(0.3);
  }
  {
    Case c = lit_ball("glowing", 1.0);
    c.scene.lights.clear();
    give_temperatures(c, 1800.0);
    add(std::move(c));
  }
  {
    Scene& s = add(lit_ball("coloured", 2.0));
    s.volumes[0].density.channels = { 1.0, 0.7, 0.4 };
    s.volumes[0].medium.albedo = { 0.9, 0.8, 0.7 };
    s.volumes[0].medium.octaves.count = 2;
    s.sky.radiance = glm::dvec3(0.2);
  }
  {
    Scene& s = add(lit_ball("hardly coloured", 0.4));
    s.volumes[0].density.channels = { 1.0, 0.999, 0.9985 };
  }
  {
    Scene& s = add(lit_ball("empty", 0.0));
    s.sky.radiance = glm::dvec3(1.0);
  }
  {
    Scene& s = add(classified_ball("classified, shaded", 0.5));
    s.volumes[0].shading.enabled = true;
    s.volumes[0].shading.specular = 0.3;
  }
  {
    Scene& s = add(classified_ball("classified, lit", 0.4));
    s.volumes[0].medium.lit = true;
    s.volumes[0].medium.lobes = { { PhaseFunction::Rayleigh, 1.0, 0.0 } };
    s.volumes[0].medium.emission = glm::dvec3(0.002);
    s.volumes[0].medium.powder.enabled = true;
    s.volumes[0].medium.powder.strength = 0.4;
  }
  {
    Scene& s = add(classified_ball("classified, lit and shaded", 0.4));
    s.volumes[0].medium.lit = true;
    s.volumes[0].shading.enabled = true;
    s.lights.push_back(sun({ -0.3, 0.4, -0.9 }, glm::dvec3(0.5)));
  }
  {
    Scene& s = add(lit_ball("point light inside", 0.6));
    s.lights[0].positional = true;
    s.lights[0].position = { 0.06, 0.02, -0.04 };
    s.lights[0].attenuation = { 0.02, 0.0, 1.0 };
    s.lights[0].diffuse = glm::dvec3(0.05);
  }
  {
    Scene& s = add(lit_ball("point light outside", 0.5));
    s.lights[0].positional = true;
    s.lights[0].position = { 0.9, 0.5, -0.4 };
    s.lights[0].attenuation = { 0.0, 0.0, 1.0 };
    s.volumes[0].medium.lobes = forward;
  }
  {
    // Lamps are as far as the world has them, optical depths are the data's.
    Scene& s = add(lit_ball("point light, prop scaled", 0.4));
    s.volumes[0].world_from_data =
      glm::scale(glm::translate(glm::dmat4(1.0), glm::dvec3(30.0, 0.0, 5.0)), glm::dvec3(40.0));
    s.lights[0].positional = true;
    s.lights[0].position = { 49.5, 18.0, 20.0 };
    s.lights[0].attenuation = { 0.0, 0.0, 0.01 };
    s.camera = view_of(s, { -0.45, 0.35, -0.82 }, true).camera(1.0);
    s.sky.radiance = glm::dvec3(0.01);
  }
  {
    Scene& s = add(lit_ball("foggy", 1.0));
    s.fog.enabled = true;
    s.fog.extinction = { 0.2, 0.25, 0.3 };
    s.fog.falloff = 1.5;
    s.fog.lobes = forward;
    s.sky.up = { 0.0, 1.0, 0.0 };
    s.sky.radiance = glm::dvec3(0.3);
    s.volumes[0].medium.octaves.count = 2;
  }
  {
    Scene& s = add(lit_ball("hardly foggy", 0.8));
    s.fog.enabled = true;
    s.fog.extinction = { 1e-4, 1e-4, 1.3e-4 };
    s.fog.falloff = 0.5;
    s.sky.up = { 0.0, 1.0, 0.0 };
  }
  {
    Scene& s = add(lit_ball("sky only", 1.2));
    s.lights.clear();
    s.sky.radiance = { 0.4, 0.6, 1.0 };
    s.sky.ground = glm::dvec3(0.1);
  }
  {
    Scene& s = add(lit_ball("powder and lining", 1.0));
    s.volumes[0].medium.powder = { true, 0.8, Powder::Form::Height, 0.5 };
    s.volumes[0].medium.silver_lining = { true, 0.004, 0.3, 0.2 };
  }
  {
    Case c = lit_ball("surfaces", 0.8);
    c.scene.surface_depth.assign(pixels * pixels, 1.0f);
    const glm::dvec4 middle = c.scene.camera.clip_from_world * glm::dvec4(0.0, 0.0, 0.0, 1.0);
    std::fill(c.scene.surface_depth.begin(),
      c.scene.surface_depth.begin() + pixels * pixels / 2,
      static_cast<float>(middle.z / middle.w));
    add(std::move(c));
  }
  {
    // Two balls that overlap, one of them seen through its own transfer functions.
    Case c = lit_ball("two volumes", 0.7);
    Case other = classified_ball("", 0.3);
    c.scene.volumes[0].medium.lobes = forward;
    c.scene.volumes[0].density.channels = { 0.4, 0.7, 1.0 };
    c.scene.volumes.push_back(other.scene.volumes[0]);
    c.scene.volumes[1].grid = c.scene.volumes[0].grid;
    c.scene.volumes[1].world_from_data = glm::translate(glm::dmat4(1.0), glm::dvec3(0.2, 0.1, 0.0));
    add(std::move(c));
  }
  return cases;
}

inline std::vector<Case> fogs()
{
  std::vector<Case> cases;
  const auto add = [&](const std::string& name) -> Scene&
  {
    Case c = lit_ball(name, 0.0);
    c.scene.volumes.clear();
    c.scene.fog.enabled = true;
    c.scene.fog.extinction = { 0.3, 0.4, 0.6 };
    c.scene.fog.falloff = 2.0;
    c.scene.sky.up = { 0.0, 1.0, 0.0 };
    cases.push_back(std::move(c));
    return cases.back().scene;
  };
  {
    Scene& s = add("layered fog");
    s.fog.lobes = { { PhaseFunction::HenyeyGreenstein, 1.0, 0.7 } };
    s.sky.radiance = { 0.3, 0.4, 0.6 };
  }
  {
    Scene& s = add("even fog");
    s.fog.falloff = 0.0;
    s.fog.albedo = { 0.9, 0.5, 0.3 };
    s.sky.ground = glm::dvec3(0.2);
    s.surface_depth.assign(pixels * pixels, 0.8f);
    s.surface_depth[17] = 0.3f;
  }
  {
    Scene& s = add("thin fog");
    s.fog.extinction = { 1e-4, 1.1e-4, 1.2e-4 };
    s.fog.lobes = { { PhaseFunction::Schlick, 1.0, -0.4 } };
  }
  {
    Scene& s = add("fog around a lamp");
    s.lights[0].positional = true;
    s.lights[0].position = { 0.05, 0.1, 0.0 };
    s.lights[0].attenuation = { 0.01, 0.0, 1.0 };
    s.lights[0].diffuse = glm::dvec3(0.2);
  }
  return cases;
}

}
