// Lamps near and in a homogeneous box: the integrals over the angle, which is where 1/r² is smooth.
#include "../support/lamp_box.h"

#include <iostream>

using namespace lamp_box;

namespace
{

/// Irradiance without the box, as vtkLight has attenuation and cone.
double strength(const Light& light, const glm::dvec3& place)
{
  const glm::dvec3 away = place - light.position;
  const double d = glm::length(away);
  double result =
    1.0 / (light.attenuation.x + light.attenuation.y * d + light.attenuation.z * d * d);
  if (light.cone_angle < 90.0)
  {
    const double cosine = glm::dot(away, light.direction) / d;
    result *=
      cosine < std::cos(light.cone_angle * pi / 180.0) ? 0.0 : std::pow(cosine, light.exponent);
  }
  return pi * result;
}

Truth truth_of(const Box& box, const WorldRay& ray)
{
  const Light& light = box.scene.lights[0];
  const Medium& medium = box.scene.volumes[0].medium;
  double from, to;
  inside(ray.begin, ray.direction, from, to);
  Truth truth{ glm::dvec3(0.0), glm::dvec3(1.0) };
  if (from >= to)
  {
    return truth;
  }
  truth.transmittance = glm::exp(-sigma * (to - from));
  const double foot = glm::dot(light.position - ray.begin, ray.direction);
  const double away =
    std::max(glm::length(ray.begin + foot * ray.direction - light.position), 1e-9);
  for (int c = 0; c < 3; ++c)
  {
    const auto sends = [&](double t)
    {
      const glm::dvec3 place = ray.begin + t * ray.direction;
      const glm::dvec3 to_light = light.position - place;
      const double distance = glm::length(to_light);
      double enters, leaves;
      inside(place, to_light / distance, enters, leaves);
      const double p = phase(medium, glm::dot(to_light / distance, ray.direction));
      return medium.albedo[c] * sigma[c] * light.diffuse[c] * strength(light, place) * p *
             std::exp(-sigma[c] * (t - from + std::min(distance, leaves)));
    };
    // t = foot + away · tan φ takes 1/r² away; the foot is a kink where the ray runs through the
    // light. A cone's ends are found by looking.
    std::vector<double> ends{ std::atan((from - foot) / away), std::atan((to - foot) / away) };
    if (from < foot && foot < to)
    {
      ends.insert(ends.begin() + 1, 0.0);
    }
    const auto angle = [&](double phi) { return foot + away * std::tan(phi); };
    std::vector<double> cuts{ ends.front() };
    for (std::size_t i = 1; i < ends.size(); ++i)
    {
      const int parts = 400;
      for (int k = 1; k <= parts; ++k)
      {
        double a = ends[i - 1] + (ends[i] - ends[i - 1]) * (k - 1) / parts;
        double b = ends[i - 1] + (ends[i] - ends[i - 1]) * k / parts;
        const double next = b;
        const auto lit = [&](double phi)
        { return strength(light, ray.begin + angle(phi) * ray.direction) > 0.0; };
        // Short of the ends: there the place may be the light's own.
        const double inset = 1e-9 * (b - a);
        if (lit(a + inset) != lit(b - inset))
        {
          const bool first = lit(a + inset);
          for (int halving = 0; halving < 60; ++halving)
          {
            const double middle = 0.5 * (a + b);
            (lit(middle) == first ? a : b) = middle;
          }
          cuts.push_back(a);
        }
        if (k % 50 == 0)
        {
          cuts.push_back(next);
        }
      }
    }
    for (std::size_t i = 1; i < cuts.size(); ++i)
    {
      truth.radiance[c] += integral([&](double phi)
        { return sends(angle(phi)) * away / std::pow(std::cos(phi), 2.0); },
        cuts[i - 1],
        cuts[i]);
    }
  }
  return truth;
}

double worst_of(const Draw& draw, const Box& box)
{
  return worst_relative_error(draw(box.scene, edge, edge),
    [&](int x, int y) { return truth_of(box, world_ray(box.view, x, y, edge, edge)); });
}

const Draw reference = by_reference(1e-10, 256);

}

TEST(PointLights, OutsideOfTheMedium)
{
  Box box;
  box.scene.lights = { lamp(lamp_outside, { 0.0, 0.0, 1.0 }) };
  EXPECT_LE(worst_of(reference, box), 1e-5);
  box.scene.lights = { lamp(lamp_beside, { 0.0, 1.0, 0.0 }) };
  EXPECT_LE(worst_of(reference, box), 1e-5);
}

TEST(PointLights, InTheMedium)
{
  Box box;
  for (const glm::dvec3& attenuation : attenuations)
  {
    box.scene.lights = { lamp(lamp_inside, attenuation) };
    EXPECT_LE(worst_of(reference, box), 1e-5) << attenuation.x << attenuation.y << attenuation.z;
  }
}

// A ray as near to the lamp as a millionth of the box, and one right through it where the
// attenuation bounds it.
TEST(PointLights, RaysThroughTheLight)
{
  Box box;
  const glm::dvec3 on_the_ray = place_on_a_ray(box);
  const glm::dvec3 across = across_a_ray(box);
  for (const double away : { 1e-6, 1e-3 })
  {
    box.scene.lights = { lamp(on_the_ray + away * across, { 0.0, 0.0, 1.0 }) };
    EXPECT_LE(worst_of(reference, box), 1e-5) << away;
  }
  box.scene.lights = { lamp(on_the_ray, { 1e-3, 0.0, 1.0 }) };
  EXPECT_LE(worst_of(reference, box), 1e-5);
  box.scene.lights = { lamp(on_the_ray, { 0.2, 0.1, 0.5 }) };
  EXPECT_LE(worst_of(reference, box), 1e-5);
}

TEST(PointLights, Cones)
{
  Box box;
  for (const glm::dvec3& position : spots)
  {
    box.scene.lights = { spot(position) };
    const Film film = reference(box.scene, edge, edge);
    const double error = worst_error(
      film, [&](int x, int y) { return truth_of(box, world_ray(box.view, x, y, edge, edge)); });
    // Attenuation and cone are kept in single precision.
    EXPECT_LE(error, 1e-5);
  }
}

// The marcher averages 1/r² over a step in closed form; angle and shadow are a midpoint's.
TEST(PointLights, Marched)
{
  Box box;
  const auto look = [&](const char* name, double step, double bound)
  {
    const double error = worst_of(by_marcher(ShadowMethod::Rays, step), box);
    EXPECT_LE(error, bound) << name << ", step " << step;
    std::cout << "  " << name << ", step " << step << ": " << error << "\n";
  };
  box.scene.lights = { lamp(lamp_outside, { 0.0, 0.0, 1.0 }) };
  look("outside", 1.0 / 16.0, 1e-2); // of a pixel that sees a corner
  look("outside", 1.0 / 64.0, 1e-3);
  for (const glm::dvec3& attenuation : attenuations)
  {
    box.scene.lights = { lamp(lamp_inside, attenuation) };
    look("inside", 1.0 / 2.0, 1e-3);
    look("inside", 1.0 / 16.0, 1e-5);
    look("inside", 1.0 / 64.0, 1e-5);
    // At the default tolerance, and at a strict one.
    EXPECT_LE(worst_of(by_tolerance(0.004), box), 1e-3);
    EXPECT_LE(worst_of(by_tolerance(1e-5), box), 1e-5);
  }
  const glm::dvec3 on_the_ray = place_on_a_ray(box);
  box.scene.lights = { lamp(on_the_ray, { 0.2, 0.1, 0.5 }) };
  look("on a ray, bounded", 1.0 / 16.0, 1e-3);
  const glm::dvec3 across = across_a_ray(box);
  // A lobe turns by half a circle within a step here.
  box.scene.lights = { lamp(on_the_ray + 1e-3 * across, { 0.0, 0.0, 1.0 }) };
  look("beside a ray", 1.0 / 2.0, 0.1);
  // The closed form bears 1/r² itself, a thousandth of a voxel from the lamp; places in single
  // precision then tell.
  box.scene.volumes[0].medium.lobes.clear();
  box.scene.lights = { lamp(on_the_ray + 1e-3 * across, { 0.0, 0.0, 1.0 }) };
  look("beside a ray, isotropic", 1.0 / 2.0, 2e-3);
  look("beside a ray, isotropic", 1.0 / 16.0, 2e-3);
}

// The light is where it is, however far from the world's origin: nothing of it is single precision.
TEST(PointLights, FarFromTheOrigin)
{
  Box box;
  box.scene.lights = { lamp(lamp_inside, { 0.0, 0.0, 1.0 }) };
  const Film here = reference(box.scene, edge, edge);
  box.move({ 1e5, -2e5, 3e5 });
  EXPECT_LE(difference(reference(box.scene, edge, edge), here), 1e-6);
}
