// Slabs under suns and skies, one for each thing that matter does with light.
#pragma once

#include "lit_scenes.h"

#include <glm/ext/matrix_transform.hpp>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace slab_scenes
{

using namespace lit_scenes;

// Of a sun's single scattering.
// --------------------------------------------------------------------

/// Matter of a slab whose single scattering is known in closed form.
struct Case
{
  const char* name;
  glm::dvec3 depth;
  glm::dvec3 albedo;
  std::vector<PhaseLobe> lobes;
};

inline const std::vector<Case> cases = {
  { "thin, isotropic", glm::dvec3(0.05), glm::dvec3(1.0), {} },
  { "coloured, forward",
    { 0.3, 1.0, 2.5 },
    { 0.9, 0.5, 1.0 },
    { { PhaseFunction::HenyeyGreenstein, 1.0, 0.7 } } },
  { "thick, backward",
    glm::dvec3(12.0),
    { 1.0, 0.99, 0.2 },
    { { PhaseFunction::HenyeyGreenstein, 1.0, -0.5 } } },
  { "air", { 0.05, 0.12, 0.3 }, glm::dvec3(1.0), { { PhaseFunction::Rayleigh, 1.0, 0.0 } } },
  { "Schlick and a mixture",
    { 1.0, 1.0, 0.5 },
    glm::dvec3(0.8),
    { { PhaseFunction::Schlick, 2.0, 0.6 },
      { PhaseFunction::HenyeyGreenstein, 1.0, -0.3 },
      { PhaseFunction::Isotropic, 0.5, 0.0 } } },
};

/// Degrees from the zenith.
inline const double suns_of_cases[4] = { 0.0, 35.0, 60.0, 78.0 };
inline const double views_of_cases[5] = { 0.0, 40.0, 65.0, 115.0, 145.0 };

inline Slab slab_of(const Case& c, double sun, const glm::dvec3& diffuse, double width = 256.0)
{
  Slab slab(c.depth, width);
  slab.medium().albedo = c.albedo;
  slab.medium().lobes = c.lobes;
  slab.add_sun(sun, 130.0, diffuse);
  return slab;
}

/// `which`: 1 for the first, 2 for the second, 3 for both.
inline Slab slab_under_two_suns(int which)
{
  Slab slab(glm::dvec3(1.0, 0.7, 0.4));
  if (which & 1)
  {
    slab.add_sun(20.0, 0.0, { 1.0, 0.0, 0.5 });
  }
  if (which & 2)
  {
    slab.add_sun(70.0, 200.0, { 0.2, 2.0, 0.5 });
  }
  return slab;
}

// Of all other light.
// ------------------------------------------------------------------------------

constexpr double width = 16.0;
inline const glm::dvec3 depths(0.4, 1.1, 2.6);
/// The sun of all of them.
inline const glm::dvec3 sun_diffuse(1.0, 2.0, 0.5);
constexpr double sun_zenith = 50.0;

template <class AnySlab>
void add_the_sun(AnySlab& slab)
{
  slab.add_sun(sun_zenith, 40.0, sun_diffuse);
}

/// `side`: 1 where the sky is above, −1 where it is below.
inline Slab slab_under_sky(double side)
{
  Slab slab(depths, width);
  slab.scene.sky.radiance = { 1.0, 0.5, 2.0 };
  slab.scene.sky.ground = { 0.2, 0.7, 0.0 };
  slab.scene.sky.up = { 0.0, 0.0, side };
  slab.medium().albedo = { 0.9, 1.0, 0.6 };
  // Ambient light knows no phase function.
  slab.medium().lobes = { { PhaseFunction::HenyeyGreenstein, 1.0, 0.8 } };
  return slab;
}

inline Slab thin_slab_under_sky()
{
  Slab slab(glm::dvec3(1e-5), width);
  slab.scene.sky.radiance = glm::dvec3(1.0);
  return slab;
}

inline Slab slab_of_octaves()
{
  Slab slab(depths, width);
  add_the_sun(slab);
  slab.medium().albedo = { 1.0, 0.8, 0.9 };
  slab.medium().lobes = { { PhaseFunction::HenyeyGreenstein, 3.0, 0.8 },
    { PhaseFunction::HenyeyGreenstein, 1.0, -0.4 },
    { PhaseFunction::Rayleigh, 1.0, 0.0 } };
  slab.medium().octaves = { 5, 0.6, 0.45, 0.7 };
  return slab;
}

inline Slab slab_with_silver_lining()
{
  Slab slab(depths, width);
  add_the_sun(slab);
  slab.medium().octaves.count = 2;
  slab.medium().silver_lining = { true, 0.7, 0.15, 0.25 };
  return slab;
}

inline Slab slab_of_powder(Powder::Form form)
{
  Slab slab(depths, width);
  add_the_sun(slab);
  slab.scene.sky.radiance = glm::dvec3(1.0);
  slab.medium().emission = glm::dvec3(0.3); // no light of others: powder leaves it
  slab.medium().powder = { true, 0.8, form, 1.5 };
  return slab;
}

/// Temperatures that rise with the height, 800 to 1600 kelvin in two units each.
struct WarmSlab : Slab
{
  Voxels<float> warm{ 3, 3, 5, [](int, int, int k) { return 400.0f + 100.0f * k; } };

  WarmSlab()
    : Slab(depths, width)
  {
    medium().emission = { 0.5, 0.25, 0.0 };
    medium().black_body = 3.0;
    medium().black_body_reference = 1200.0;
    medium().temperature = warm.grid();
    medium().temperature_scale = 2.0;
  }
};

inline Slab glowing_slab_without_extinction()
{
  Slab slab(glm::dvec3(1.0), width);
  slab.scene.volumes[0].density.extinction = 0.0;
  slab.medium().emission = { 0.5, 0.25, 2.0 };
  return slab;
}

/// The slab's voxels, classified by a ramp of the height, with an extinction of 1.3.
struct ClassifiedSlab : Slab
{
  Voxels<float> ramp{ 3, 3, 5, [](int, int, int k) { return 0.25f * k; } };
  static constexpr double sigma = 1.3;
  static glm::dvec3 colour(double z) { return { z, 1.0 - 0.5 * z, 0.5 }; }

  ClassifiedSlab()
    : Slab(glm::dvec3(1.0), width)
  {
    Volume& volume = scene.volumes[0];
    volume.grid = ramp.grid();
    volume.meaning = ValueMeaning::Classified;
    volume.classification = classify(
      0.0,
      1.0,
      [](double) { return -std::expm1(-sigma * 0.1); },
      [](double v) { return colour(v); },
      5);
    volume.classification.unit_distance = 0.1;
  }
};

inline ClassifiedSlab glowing_classified_slab()
{
  ClassifiedSlab slab;
  add_the_sun(slab);
  slab.medium().albedo = { 0.9, 0.8, 1.0 };
  slab.medium().emission = { 0.1, 0.0, 0.4 };
  slab.medium().powder = { true, 0.5, Powder::Form::Exponential, 2.0 };
  slab.scene.volumes[0].weight = 0.75;
  return slab;
}

inline ClassifiedSlab shaded_slab()
{
  ClassifiedSlab slab;
  add_the_sun(slab);
  slab.scene.lights[0].specular = { 0.5, 1.0, 1.5 };
  slab.scene.sky.radiance = { 0.3, 0.2, 0.1 };
  slab.medium().albedo = { 0.9, 0.8, 1.0 };
  slab.medium().octaves.count = 3; // not for shaded matter
  Shading& shading = slab.scene.volumes[0].shading;
  shading.enabled = true;
  shading.ambient_light = { 0.5, 1.0, 0.7 };
  return slab;
}

/// Two densities in one place, of these depths.
inline Slab mixed_slab(const glm::dvec3& first, const glm::dvec3& second, Mixture mixture)
{
  Slab slab(first, width);
  add_the_sun(slab);
  slab.scene.mixture = mixture;
  slab.medium().albedo = { 0.5, 1.0, 0.8 };
  Volume other = Slab(second, width).scene.volumes[0];
  other.grid = slab.scene.volumes[0].grid;
  other.medium.lobes = { { PhaseFunction::HenyeyGreenstein, 1.0, 0.5 } };
  slab.scene.volumes.push_back(other);
  return slab;
}

inline Slab unlit_slab()
{
  Slab slab(depths, width);
  slab.medium().lit = false;
  return slab;
}

/// A prop that is scaled; its middle is at scale.z / 2.
inline Slab scaled_slab(const glm::dvec3& scale)
{
  Slab slab(depths, width);
  add_the_sun(slab);
  slab.medium().lobes = { { PhaseFunction::HenyeyGreenstein, 1.0, 0.6 } };
  slab.scene.volumes[0].world_from_data = glm::scale(glm::dmat4(1.0), scale);
  return slab;
}

/// "cropping", a "clipping plane" or a "mask" hides what is above 0.625.
struct HalfHiddenSlab : ClassifiedSlab
{
  std::vector<std::uint8_t> labels;

  explicit HalfHiddenSlab(const std::string& way)
  {
    add_the_sun(*this);
    Volume& volume = scene.volumes[0];
    if (way == "cropping")
    {
      volume.cropping.enabled = true;
      volume.cropping.upper[0] = volume.cropping.upper[1] = 2.0;
      volume.cropping.upper[2] = 2.5;
    }
    else if (way == "clipping plane")
    {
      volume.clipping_planes.emplace_back(0.0, 0.0, -1.0, 0.625);
    }
    else
    {
      for (int i = 0; i < 45; ++i)
      {
        labels.push_back(i / 9 >= 3);
      }
      volume.mask.labels = labels.data();
      volume.mask.classification_of_label[1] = Mask::hidden;
    }
  }
};

/// `other`: what is off has other settings.
inline Slab slab_with_all_off(bool other)
{
  Slab slab(depths, width);
  add_the_sun(slab);
  slab.scene.sky.radiance = glm::dvec3(0.3);
  slab.medium().lobes = { { PhaseFunction::HenyeyGreenstein, 1.0, 0.6 } };
  if (other)
  {
    slab.medium().octaves = { 1, 0.3, 0.2, 0.1 };
    slab.medium().silver_lining = { false, 5.0, 0.01, 0.9 };
    slab.medium().powder = { false, 1.0, Powder::Form::Height, 3.0 };
    slab.medium().black_body_reference = 3000.0;
    slab.medium().temperature_scale = 50.0;
  }
  return slab;
}

}
