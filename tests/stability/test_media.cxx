// Hard cases of media: a slab whose light is known in closed form, by every integrator and mapper.
#include "hard_case.h"
#include "slabs.h"

#include <functional>

using namespace slabs;
using brume_tests::HardCase;

namespace
{

/// The largest error of any pixel; relative to the truth, or of white.
double error_of(const Film& film, const Truth& truth, bool of_white)
{
  double most = 0.0;
  for (int c = 0; c < 3; ++c)
  {
    for (std::size_t i = 0; i < film.size(); ++i)
    {
      const double white = of_white ? std::max(1.0, truth.radiance[c]) : truth.radiance[c];
      const double off = std::abs(film.radiance[c][i] - truth.radiance[c]);
      const double here = off == 0.0 ? 0.0 : off / white;
      most = here <= most ? most : here;
      // Films are single precision, and hold no more of a transmittance near 1.
      const double passes = std::abs(film.transmittance[c][i] - truth.transmittance[c]);
      most = passes <= most ? most : passes;
    }
  }
  return most;
}

/// How many of its own standard errors the mean of a picture by paths is off.
double deviation(const Film& film, const Truth& truth)
{
  const Mean mean = mean_of(film);
  double most = 0.0;
  for (int c = 0; c < 3; ++c)
  {
    const double off = std::abs(mean.value[c] - truth.radiance[c]);
    // Single precision; and light that hardly any path meets.
    const double least = std::max(1e-6 * truth.radiance[c], 1e-7);
    const double here = off == 0.0 ? 0.0 : off / std::max(mean.error[c], least);
    most = here <= most ? most : here;
  }
  return most;
}

bool in_bounds(const Film& film)
{
  for (int c = 0; c < 3; ++c)
  {
    for (std::size_t i = 0; i < film.size(); ++i)
    {
      const float t = film.transmittance[c][i];
      const float l = film.radiance[c][i];
      if (!(t >= 0.0f && t <= 1.0f && l >= 0.0f && std::isfinite(l)))
      {
        return false;
      }
    }
  }
  return true;
}

/// What is asked of light by lattices of nodes: the truth; that it stays in bounds, where all light
/// is between two nodes; or nothing, as there would be too many of them.
enum class Lattice
{
  Truth,
  Bounds,
  None,
};

/// Holds what a way draws against the closed form.
void expect_truth(HardCase& one,
  const Case& what,
  const Way& way,
  const Truth& truth,
  Lattice lattice)
{
  const std::vector<std::string> names =
    way.packets ? targets() : std::vector<std::string>{ std::string() };
  for (const std::string& target : names)
  {
    if (!target.empty())
    {
      ASSERT_TRUE(force_simd_target(target));
    }
    const Film film = way.draw(what);
    const std::string by = target.empty() ? way.name : way.name + ", " + target;
    one.holds(in_bounds(film), "transmittance in [0, 1] and radiance finite and not negative", by);
    if (way.lattice && lattice == Lattice::Bounds)
    {
      continue;
    }
    if (way.random)
    {
      one.measure(deviation(film, truth), way.bound, "standard errors", by);
    }
    else
    {
      one.measure(
        error_of(film, truth, way.of_white), way.bound, way.of_white ? "of white" : "relative", by);
    }
    force_simd_target("");
  }
}

/// All that scatter once; and all others, if nothing scatters in this case.
void expect_everywhere(HardCase& one,
  const Case& what,
  bool scatters = true,
  Lattice lattice = Lattice::Truth)
{
  const Truth truth = truth_of(what);
  for (const Way& way : ways())
  {
    if ((way.scatters_once || !scatters) && !(way.lattice && lattice == Lattice::None))
    {
      expect_truth(one, what, way, truth, lattice);
    }
  }
}

const char* const promised = "the closed form: shadow rays and the reference within a relative "
                             "1e-5, light volumes and shadow functions "
                             "0.05 apart within 0.02 of white, the mapper within its tolerance of "
                             "0.004, paths within 4.5 standard errors";
const char* const promised_of_deep = "the closed form: shadow rays and the reference within a "
                                     "relative 1e-5, the mapper, which then takes "
                                     "shadow rays, within its tolerance of 0.004, paths within 4.5 "
                                     "standard errors; light volumes, whose nodes are "
                                     "too far apart for it, stay finite and not negative";

}

TEST(Media, AlbedoZero)
{
  HardCase one("Media",
    "albedo 0 under a sun",
    "paths that may not scatter have nothing to choose from; weights are divided by the albedo",
    promised);
  Case what;
  what.albedo = glm::dvec3(0.0);
  what.suns = { { 40.0, 20.0 } };
  expect_everywhere(one, what, false);
}

TEST(Media, AlbedoOne)
{
  HardCase one("Media",
    "albedo 1 under a sun, one scattering",
    "nothing is absorbed: what is not scattered once is scattered again, and must not be counted",
    promised);
  Case what;
  what.suns = { { 40.0, 20.0 } };
  expect_everywhere(one, what);
}

TEST(Media, ThinAsNothing)
{
  HardCase one("Media",
    "an optical depth of 1e-8 across",
    "1 − T is 0 in single precision, and a path collides once in 10⁸ times",
    promised);
  Case what;
  what.depth = glm::dvec3(1e-8);
  what.suns = { { 40.0, 20.0 } };
  expect_everywhere(one, what);
}

TEST(Media, Opaque)
{
  HardCase one("Media",
    "an optical depth of 1e6 across",
    "all light comes from the first millionth: a step is 5·10⁴ deep",
    promised_of_deep);
  Case what;
  what.depth = glm::dvec3(1e6);
  what.suns = { { 40.0, 20.0 } };
  expect_everywhere(one, what, true, Lattice::Bounds);
}

TEST(Media, OpaqueAndClear)
{
  HardCase one("Media",
    "one channel of an optical depth of 1000, one of 1, one clear",
    "three media in one place: one majorant, one step and one early end for all",
    promised_of_deep);
  Case what;
  what.depth = glm::dvec3(1e3, 1.0, 0.0);
  what.albedo = glm::dvec3(0.9, 0.5, 1.0);
  what.suns = { { 40.0, 20.0 } };
  expect_everywhere(one, what, true, Lattice::Bounds);
}

TEST(Media, EmissionAlone)
{
  HardCase one("Media",
    "emission without extinction",
    "S = emission/σt is infinite; where nothing dims, bricks look empty",
    promised);
  Case what;
  what.depth = glm::dvec3(0.0);
  what.emission = { 0.5, 0.25, 2.0 };
  expect_everywhere(one, what, false);
}

TEST(Media, EmissionOfOpaqueMatter)
{
  HardCase one("Media",
    "emission of matter of an optical depth of 1e6",
    "all that is seen is emission/σt of the first millionth",
    promised);
  Case what;
  what.depth = glm::dvec3(1e6);
  what.albedo = glm::dvec3(0.0);
  what.emission = { 5e5, 2.5e5, 0.0 };
  expect_everywhere(one, what, false);
}

TEST(Media, SunInThePlaneOfAFace)
{
  HardCase one("Media",
    "light that grazes: a sun two degrees above the slab, and one behind the eye",
    "shadow rays run nearly in the face; cos θ is −1 to the last digit",
    promised_of_deep);
  Case what;
  what.depth = glm::dvec3(5.0);
  what.anisotropy = 0.7;
  what.suns = { { what.view, 0.0 } };
  expect_everywhere(one, what);
  what.depth = glm::dvec3(2000.0); // the sides, 4 away, are as far as infinity
  what.suns = { { 88.0, 0.0 } };
  expect_everywhere(one, what, true, Lattice::Bounds);
}

TEST(Media, ForwardPeak)
{
  HardCase one("Media",
    "g = 0.9999 under a sun that does not stand behind the matter",
    "nearly all light goes straight on: what is seen is the peak's foot, 10⁻⁵ of it",
    promised);
  Case what;
  what.anisotropy = 0.9999;
  what.suns = { { 40.0, 20.0 } };
  expect_everywhere(one, what);
}

TEST(Media, AThousandSuns)
{
  HardCase one("Media",
    "a thousand lights at infinity",
    "the sum of a thousand small terms; a light volume each would be gigabytes",
    promised_of_deep);
  Case what;
  what.depth = glm::dvec3(2.0);
  for (int i = 0; i < 1000; ++i)
  {
    what.suns.push_back({ 80.0 * std::sqrt((i + 0.5) / 1000.0), 137.508 * i, 1e-3 });
  }
  expect_everywhere(one, what, true, Lattice::None);
}

TEST(Media, WhiteFurnace)
{
  HardCase one("Media",
    "albedo 1 in a white furnace, optical depths of 1e-8, 1 and 30, g = 0 and 0.999",
    "light from everywhere, scattered any number of times: the least loss or gain at a scattering "
    "adds up",
    "matter that absorbs nothing cannot be seen: radiance + transmittance is 1, by paths within "
    "4.5 standard errors, "
    "by the smart mapper within its tolerance of 0.02");
  for (const double depth : { 1e-8, 1.0, 30.0 })
  {
    for (const double g : { 0.0, 0.999 })
    {
      Case what;
      what.depth = glm::dvec3(depth);
      what.anisotropy = g;
      what.sky = 1.0;
      Truth truth = truth_of(what);
      truth.radiance = 1.0 - truth.transmittance;
      PathSettings settings;
      settings.samples_per_pixel = 64;
      for (const std::string& target : targets())
      {
        ASSERT_TRUE(force_simd_target(target));
        const Film film = traced(TransportSlab(what).scene, settings, pixels, pixels);
        one.measure(deviation(film, truth), 4.5, "standard errors", "path tracer, " + target);
        one.holds(in_bounds(film), "in bounds", "path tracer, " + target);
      }
      force_simd_target("");
      vtkNew<vtkBrumePathTraceMapper> paths;
      paths->SetSamplesPerPixel(64);
      paths->SetTolerance(0.0);
      one.measure(deviation(by_mapper(what, paths), truth),
        4.5,
        "standard errors",
        "vtkBrumePathTraceMapper");
      vtkNew<vtkBrumeSmartVolumeMapper> smart;
      smart->SetTolerance(0.02);
      one.measure(error_of(by_mapper(what, smart), truth, true),
        0.02,
        "of white",
        "vtkBrumeSmartVolumeMapper");
    }
  }
}
