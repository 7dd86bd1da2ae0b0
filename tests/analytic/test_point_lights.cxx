// Lamps near and in a homogeneous box: the integrals over the angle, which is where 1/r² is smooth.
#include "../support/lit_scenes.h"

#include <iostream>

using namespace lit_scenes;

namespace
{

constexpr int edge = 6;
const glm::dvec3 half(4.0, 3.0, 2.5);
const glm::dvec3 sigma(0.2, 0.1, 0.4);

struct Box
{
  Voxels<float> voxels{ 9, 7, 6, [](int, int, int) { return 1.0f; } };
  Scene scene;
  View view;

  Box()
  {
    Volume& volume = scene.volumes[0];
    volume.grid = voxels.grid();
    volume.data_from_index = placed(glm::dvec3(1.0), -half);
    volume.meaning = ValueMeaning::Density;
    volume.density.extinction = 0.4;
    volume.density.channels = sigma / 0.4;
    volume.medium.lit = true;
    volume.medium.albedo = { 0.8, 1.0, 0.9 };
    volume.medium.lobes = { { PhaseFunction::HenyeyGreenstein, 1.0, 0.4 } };
    view = view_of(scene, glm::dvec3(0.4, 0.3, -1.0), false);
    scene.camera = view.camera(1.0);
  }
};

/// The stretch of a line p + t d inside the box.
void inside(const glm::dvec3& p, const glm::dvec3& d, double& from, double& to)
{
  from = -1e30;
  to = 1e30;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double a = (-half[axis] - p[axis]) / d[axis];
    const double b = (half[axis] - p[axis]) / d[axis];
    from = std::max(from, std::min(a, b));
    to = std::min(to, std::max(a, b));
  }
}

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

Light lamp(const glm::dvec3& position, const glm::dvec3& attenuation)
{
  Light light;
  light.diffuse = { 1.0, 0.5, 2.0 };
  light.positional = true;
  light.position = position;
  light.attenuation = attenuation;
  return light;
}

const Draw reference = by_reference(1e-10, 256);

}

TEST(PointLights, OutsideOfTheMedium)
{
  Box box;
  box.scene.lights = { lamp({ 6.0, 5.0, 3.0 }, { 0.0, 0.0, 1.0 }) };
  EXPECT_LE(worst_of(reference, box), 1e-5);
  box.scene.lights = { lamp({ -4.2, 0.3, 0.1 }, { 0.0, 1.0, 0.0 }) };
  EXPECT_LE(worst_of(reference, box), 1e-5);
}

TEST(PointLights, InTheMedium)
{
  Box box;
  for (const glm::dvec3& attenuation :
    { glm::dvec3(1.0, 0.0, 0.0), glm::dvec3(0.0, 1.0, 0.0), glm::dvec3(0.0, 0.0, 1.0) })
  {
    box.scene.lights = { lamp({ 0.31, -0.52, 0.73 }, attenuation) };
    EXPECT_LE(worst_of(reference, box), 1e-5) << attenuation.x << attenuation.y << attenuation.z;
  }
}

// A ray as near to the lamp as a millionth of the box, and one right through it where the
// attenuation bounds it.
TEST(PointLights, RaysThroughTheLight)
{
  Box box;
  const WorldRay ray = world_ray(box.view, 2, 3, edge, edge);
  double from, to;
  inside(ray.begin, ray.direction, from, to);
  const glm::dvec3 on_the_ray = ray.begin + (0.3 * from + 0.7 * to) * ray.direction;
  const glm::dvec3 across = glm::normalize(glm::cross(ray.direction, glm::dvec3(0.3, 0.9, 0.1)));
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
  for (const glm::dvec3& position : { glm::dvec3(0.3, -0.5, 2.0), glm::dvec3(1.0, 0.0, 7.0) })
  {
    Light light = lamp(position, { 0.0, 0.0, 1.0 });
    light.direction = glm::normalize(glm::dvec3(-0.2, 0.1, -1.0));
    light.cone_angle = 20.0;
    light.exponent = 4.0;
    box.scene.lights = { light };
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
  box.scene.lights = { lamp({ 6.0, 5.0, 3.0 }, { 0.0, 0.0, 1.0 }) };
  look("outside", 1.0 / 16.0, 1e-2); // of a pixel that sees a corner
  look("outside", 1.0 / 64.0, 1e-3);
  for (const glm::dvec3& attenuation :
    { glm::dvec3(1.0, 0.0, 0.0), glm::dvec3(0.0, 1.0, 0.0), glm::dvec3(0.0, 0.0, 1.0) })
  {
    box.scene.lights = { lamp({ 0.31, -0.52, 0.73 }, attenuation) };
    look("inside", 1.0 / 2.0, 1e-3);
    look("inside", 1.0 / 16.0, 1e-5);
    look("inside", 1.0 / 64.0, 1e-5);
    // At the default tolerance, and at a strict one.
    EXPECT_LE(worst_of(by_tolerance(0.004), box), 1e-3);
    EXPECT_LE(worst_of(by_tolerance(1e-5), box), 1e-5);
  }
  const WorldRay ray = world_ray(box.view, 2, 3, edge, edge);
  double from, to;
  inside(ray.begin, ray.direction, from, to);
  const glm::dvec3 on_the_ray = ray.begin + (0.3 * from + 0.7 * to) * ray.direction;
  box.scene.lights = { lamp(on_the_ray, { 0.2, 0.1, 0.5 }) };
  look("on a ray, bounded", 1.0 / 16.0, 1e-3);
  const glm::dvec3 across = glm::normalize(glm::cross(ray.direction, glm::dvec3(0.3, 0.9, 0.1)));
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
  box.scene.lights = { lamp({ 0.31, -0.52, 0.73 }, { 0.0, 0.0, 1.0 }) };
  const Film here = reference(box.scene, edge, edge);
  const glm::dvec3 far(1e5, -2e5, 3e5);
  box.scene.volumes[0].world_from_data = glm::translate(glm::dmat4(1.0), far);
  box.scene.lights[0].position += far;
  box.view.centre += far;
  box.scene.camera = box.view.camera(1.0);
  EXPECT_LE(difference(reference(box.scene, edge, edge), here), 1e-6);
}
