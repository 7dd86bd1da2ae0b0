#include "ray_integrators.h"

#include "ray_mappers.h"

#include "Transport/path_tracer.h"
#include "Transport/reference.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace stability
{

namespace
{

constexpr double step = 0.37;
constexpr glm::dvec3 colour{ 0.75, 0.5, 0.25 };
constexpr double glow = 0.4;    ///< radiance that an infinite depth sends
constexpr double albedo = 0.75; ///< of lit matter
constexpr double diffuse = 2.0;
/// Irradiance π · diffuse, isotropic 1/4π: what a sun sends back per unit of optical depth.
constexpr double sent_back = 0.25 * diffuse * albedo;

Pixel pixel_of(const Film& film)
{
  return { film.transmittance[0][0], film.radiance[0][0] };
}

Film marched(const Scene& scene, const MarchSettings& settings, double& reads)
{
  Film film(1, 1);
  Marcher marcher;
  reads = static_cast<double>(marcher.render(scene, settings, film).samples);
  return film;
}

MarchSettings settings_for(const RampRay& ray)
{
  MarchSettings settings;
  settings.step = step * longest_edge(ray);
  settings.leave_error = 0.0;
  settings.threads = 1;
  return settings;
}

/// The density as a classification: opacity 1 − e^(−σ v) of a unit distance, one colour.
void classify_ramp(const RampRay& ray, Scene& scene)
{
  Volume& volume = scene.volumes[0];
  volume.meaning = ValueMeaning::Classified;
  const double unit = 0.5 / ray.extinction; // opacities of some tenths, whatever the units
  volume.classification = classify(
    0.0, 4.0, [&](double v) { return -std::expm1(-0.5 * v); }, [](double) { return colour; }, 4097);
  volume.classification.unit_distance = unit;
}

RayIntegrator by_reference()
{
  RayIntegrator one;
  one.name = "reference";
  one.draw = [](const RampRay& ray, double&)
  {
    const RampScene ramp(ray);
    Film film(1, 1);
    ReferenceSettings settings;
    settings.tolerance = 1e-6;
    settings.threads = 1;
    render_reference(ramp.scene, settings, film);
    return Pixel{ film.transmittance[0][0], NAN };
  };
  one.truth = [](const RampRay& ray) { return Pixel{ std::exp(-ray.optical_depth()), NAN }; };
  return one;
}

RayIntegrator by_lit_reference()
{
  RayIntegrator one;
  one.name = "lit reference";
  one.bound = 1e-5; // its own tolerance
  one.draw = [](const RampRay& ray, double&)
  {
    RampScene ramp(ray);
    light_ramp(ray, ramp.scene, Sends::Both);
    Film film(1, 1);
    ReferenceSettings settings;
    settings.tolerance = 1e-5;
    settings.threads = 1;
    render_reference(ramp.scene, settings, film);
    return pixel_of(film);
  };
  one.truth = [](const RampRay& ray) { return lit_truth(ray, Sends::Both); };
  return one;
}

RayIntegrator by_fixed_steps()
{
  RayIntegrator one;
  one.name = "fixed steps in double";
  one.draw = [](const RampRay& ray, double&)
  {
    const RampScene ramp(ray);
    Film film(1, 1);
    render_fixed_step(ramp.scene, step * longest_edge(ray), SamplePlacement::Middle, 0.0, 1, film);
    return Pixel{ film.transmittance[0][0], NAN };
  };
  one.truth = by_reference().truth;
  return one;
}

RayIntegrator by_rule(StepRule rule)
{
  RayIntegrator one;
  one.name = step_rule_name(rule);
  one.simd = true;
  const bool classified = rule == StepRule::Integrated;
  // A table of 4096 intervals, and its integrals in single precision.
  one.bound = classified ? 1e-5 : 2e-6;
  one.reads_per_cell = rule == StepRule::Midpoint || classified ? 0.0 : 2.0;
  one.draw = [=](const RampRay& ray, double& reads)
  {
    RampScene ramp(ray);
    if (classified)
    {
      classify_ramp(ray, ramp.scene);
    }
    MarchSettings settings = settings_for(ray);
    settings.rule = rule;
    const Film film = marched(ramp.scene, settings, reads);
    return Pixel{ film.transmittance[0][0], classified ? film.radiance[0][0] : NAN };
  };
  one.truth = [=](const RampRay& ray)
  {
    const double passes = std::exp(-ray.optical_depth());
    return Pixel{ passes, classified ? colour.x * (1.0 - passes) : NAN };
  };
  return one;
}

RayIntegrator by_largest_value()
{
  RayIntegrator one;
  one.name = "maximum";
  one.simd = true;
  one.bound = 1e-5; // the table's
  one.by_value = true;
  one.reads_per_cell = 16.0;
  one.draw = [](const RampRay& ray, double& reads)
  {
    RampScene ramp(ray);
    classify_ramp(ray, ramp.scene);
    ramp.scene.blend_mode = BlendMode::MaximumIntensity;
    return pixel_of(marched(ramp.scene, settings_for(ray), reads));
  };
  one.truth = [](const RampRay& ray)
  {
    double begin = 0.0;
    double end = 0.0;
    const double passes =
      ray.chord(begin, end) || std::abs(end - begin) < 1e-9 ? std::exp(-0.5 * ray.largest()) : 1.0;
    return Pixel{ passes, colour.x * (1.0 - passes) };
  };
  return one;
}

RayIntegrator by_surface()
{
  RayIntegrator one;
  one.name = "isosurface";
  one.simd = true;
  one.bound = 1e-5;
  one.by_value = true;
  one.reads_per_cell = 16.0;
  /// Half-way between the values at the ray's ends; NaN where they are too near one another.
  const auto level = [](const RampRay& ray)
  {
    double begin, end;
    if (!ray.chord(begin, end))
    {
      return double(NAN);
    }
    const glm::dvec3 way = ray.to - ray.from;
    const double first = ray.at(ray.from + way * begin);
    const double last = ray.at(ray.from + way * end);
    return std::abs(first - last) > 1e-3 ? 0.5 * (first + last) : double(NAN);
  };
  one.draw = [=](const RampRay& ray, double& reads)
  {
    const double value = level(ray);
    if (std::isnan(value))
    {
      return Pixel{};
    }
    RampScene ramp(ray);
    classify_ramp(ray, ramp.scene);
    ramp.scene.blend_mode = BlendMode::Isosurface;
    ramp.scene.isosurfaces = { value };
    return pixel_of(marched(ramp.scene, settings_for(ray), reads));
  };
  one.truth = [=](const RampRay& ray)
  {
    const double passes = std::exp(-0.5 * level(ray));
    return Pixel{ passes, colour.x * (1.0 - passes) };
  };
  return one;
}

RayIntegrator by_lit_march(ShadowMethod method)
{
  RayIntegrator one;
  one.name = std::string("lit, shadow ") + shadow_method_name(method);
  one.simd = true;
  // Nodes a quarter of a voxel apart do not follow the light around the box's edges.
  one.bound = method == ShadowMethod::Rays ? 5e-6 : 2e-2;
  one.draw = [=](const RampRay& ray, double&)
  {
    RampScene ramp(ray);
    light_ramp(ray, ramp.scene, Sends::Both);
    MarchSettings settings = settings_for(ray);
    settings.shadows = method;
    settings.precise_shadows = true;
    settings.shadow_step = method == ShadowMethod::Volume ? 0.25 * longest_edge(ray) : 0.0;
    double reads = 0.0; // shadow rays' are among them
    return pixel_of(marched(ramp.scene, settings, reads));
  };
  one.truth = [](const RampRay& ray) { return lit_truth(ray, Sends::Both); };
  return one;
}

/// Packets take what is grey and does not glow.
RayIntegrator by_paths(const std::string& name, Sends sends, double blue)
{
  RayIntegrator one;
  one.name = name;
  one.simd = sends == Sends::Sunlight && blue == 1.0;
  one.random = true;
  one.bound = 4.5; // standard errors, of some thousand rays
  one.draw = [=](const RampRay& ray, double& error)
  {
    RampScene ramp(ray);
    light_ramp(ray, ramp.scene, sends);
    ramp.scene.volumes[0].density.channels.z = blue;
    Film film(1, 1);
    PathSettings settings;
    settings.samples_per_pixel = ray_paths;
    settings.most_scatterings = 1;
    settings.threads = 1;
    PathTracer tracer;
    const bool packets = tracer.render(ramp.scene, settings, film).simd != "none";
    EXPECT_EQ(packets, sends == Sends::Sunlight && blue == 1.0);
    error = film.error[0] / 3.0;
    return pixel_of(film);
  };
  one.truth = [=](const RampRay& ray) { return lit_truth(ray, sends); };
  return one;
}

/// How far a value is from what lies between the truth and `other`.
double off(double value, double truth, double other)
{
  return std::isnan(truth)                ? 0.0
         : !std::isfinite(value)          ? double(NAN)
         : value < std::min(truth, other) ? std::min(truth, other) - value
                                          : std::max(value - std::max(truth, other), 0.0);
}

/// What a projection shows of a ray that only touches, by rounding: all or nothing.
bool may_miss(const RampRay& ray)
{
  double begin, end;
  return !ray.chord(begin, end) || end - begin < 1e-9;
}

void measure(brume_tests::HardCase& hard_case,
  const RayIntegrator& one,
  const RampRay& ray,
  double loosen)
{
  double reads = 0.0;
  const Pixel drawn = one.draw(ray, reads);
  const Pixel truth = one.truth(ray);
  if (std::isnan(truth.transmittance))
  {
    return;
  }
  const bool touches = one.by_value && may_miss(ray);
  const double passes =
    off(drawn.transmittance, truth.transmittance, touches ? 1.0 : truth.transmittance);
  const bool coarse = one.bound > 1e-2;
  const double shaded = truth.radiance * std::exp(-(coarse ? ray.shade_of_nodes : ray.shade));
  const double sends = off(drawn.radiance, truth.radiance, touches ? 0.0 : shaded);
  if (one.random)
  {
    hard_case.measure(passes, 2e-6 * loosen, "of white", one.name);
    // A hair of matter is hit by few paths or none, which tell no error: it is no less than by as
    // many hits as are to be expected, and one.
    const double hit = -std::expm1(-ray.optical_depth());
    const double error = std::max(reads, glow * std::sqrt((hit + 1.0 / ray_paths) / ray_paths));
    hard_case.measure(sends / error, one.bound, "standard errors of 1024 paths", one.name);
    return;
  }
  const double worst = std::isnan(passes) || std::isnan(sends) ? NAN : std::max(passes, sends);
  hard_case.measure(worst,
    coarse ? ray.blur_of_nodes : one.bound * loosen,
    coarse ? "of white by light volumes" : "of white",
    one.name);
  if (one.reads_per_cell > 0.0)
  {
    const double cells = std::max(ray.crossings(), 1.0);
    hard_case.measure(reads / cells, one.reads_per_cell, "reads a cell on the way", one.name);
  }
}

}

double longest_edge(const RampRay& ray)
{
  double longest = 0.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    longest = std::max(longest, glm::length(glm::dvec3(ray.data_from_index[axis])));
  }
  return longest;
}

void light_ramp(const RampRay& ray, Scene& scene, Sends sends)
{
  Volume& volume = scene.volumes[0];
  volume.medium.lit = true;
  volume.medium.albedo = glm::dvec3(sends == Sends::Glow ? 0.0 : albedo);
  volume.medium.emission = glm::dvec3(sends == Sends::Sunlight ? 0.0 : glow * ray.extinction);
  if (sends == Sends::Glow)
  {
    return;
  }
  Light sun;
  sun.diffuse = glm::dvec3(diffuse);
  sun.direction = scene.camera.direction;
  scene.lights.push_back(sun);
}

/// A sun behind the camera, whose light comes and goes the same way: the whole box counts, not only
/// what lies before the near plane.
Pixel lit_truth(const RampRay& ray, Sends sends)
{
  const double depth = ray.optical_depth();
  RampRay before = ray;
  before.from = ray.from - glm::normalize(ray.to - ray.from) * 1000.0;
  before.to = ray.from;
  const double above = before.optical_depth();
  const double sunlight = sent_back * 0.5 * std::exp(-above) * -std::expm1(-2.0 * depth);
  const double glows = -glow * std::expm1(-depth);
  return { std::exp(-depth),
    (sends == Sends::Glow ? 0.0 : sunlight) + (sends == Sends::Sunlight ? 0.0 : glows) };
}

const std::vector<RayIntegrator>& ray_integrators()
{
  static const std::vector<RayIntegrator> all = { by_reference(),
    by_lit_reference(),
    by_fixed_steps(),
    by_rule(StepRule::Midpoint),
    by_rule(StepRule::Cells),
    by_rule(StepRule::Integrated),
    by_largest_value(),
    by_surface(),
    by_lit_march(ShadowMethod::Rays),
    by_lit_march(ShadowMethod::Volume),
    by_paths("packets of paths", Sends::Sunlight, 1.0),
    by_paths("paths one by one", Sends::Sunlight, 0.5),
    by_paths("paths through glow", Sends::Glow, 1.0),
    by_march_mapper(),
    by_lit_march_mapper(),
    by_path_mapper(),
    by_lit_path_mapper(),
    by_smart_mapper() };
  return all;
}

void measure_ray(brume_tests::HardCase& hard_case, const RampRay& ray, double loosen)
{
  SCOPED_TRACE(ray.name);
  for (const RayIntegrator& one : ray_integrators())
  {
    if (!one.simd)
    {
      measure(hard_case, one, ray, loosen);
      continue;
    }
    for (const std::string& target : targets())
    {
      SCOPED_TRACE(target);
      ASSERT_TRUE(force_simd_target(target));
      measure(hard_case, one, ray, loosen);
    }
    force_simd_target("");
  }
}

}
