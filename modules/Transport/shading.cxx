#include "Transport/shading.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>

namespace brume
{

ShadeLight prepare_light(const Light& light, double diffuse, double specular)
{
  ShadeLight l{};
  for (int c = 0; c < 3; ++c)
  {
    l.diffuse[c] = static_cast<float>(diffuse * light.diffuse[c]);
    l.specular[c] = static_cast<float>(specular * light.specular[c]);
    l.direction[c] = static_cast<float>(light.direction[c]);
    l.position[c] = static_cast<float>(light.position[c]);
    l.attenuation[c] = static_cast<float>(light.attenuation[c]);
  }
  const double degree = 3.14159265358979323846 / 180.0;
  l.cone_cosine =
    light.cone_angle >= 90.0 ? -2.0f : static_cast<float>(std::cos(light.cone_angle * degree));
  l.exponent = static_cast<float>(light.exponent);
  l.positional = light.positional;
  return l;
}

ShadeModel prepare_shading(const Scene& scene, const Volume& volume)
{
  ShadeModel model;
  const Shading& shading = volume.shading;
  model.enabled = shading.enabled;
  model.two_sided = shading.two_sided;
  model.specular_power = static_cast<float>(shading.specular_power);
  double brightest_diffuse = 0.0;
  double brightest_specular = 0.0;
  for (int c = 0; c < 3; ++c)
  {
    model.ambient[c] = static_cast<float>(shading.ambient * shading.ambient_light[c]);
    brightest_diffuse = std::max(brightest_diffuse, double(model.ambient[c]));
  }
  for (const Light& light : scene.lights)
  {
    const ShadeLight l = prepare_light(light, shading.diffuse, shading.specular);
    model.specular =
      model.specular || std::any_of(l.specular, l.specular + 3, [](float v) { return v > 0.0f; });
    model.needs_place = model.needs_place || l.positional;
    // A lamp is strongest at no distance: 1 / a, which may be infinite.
    const double strongest = l.positional ? 1.0 / std::max(0.0f, l.attenuation[0]) : 1.0;
    brightest_diffuse += strongest * *std::max_element(l.diffuse, l.diffuse + 3);
    brightest_specular += strongest * *std::max_element(l.specular, l.specular + 3);
    model.lights.push_back(l);
  }
  model.brightest = shading.enabled ? brightest_diffuse + brightest_specular : 1.0;

  // A gradient is a covector: it goes to the world by the inverse transpose.
  const glm::dmat4 world_from_index = volume.world_from_data * volume.data_from_index;
  const glm::dmat3 covector = glm::transpose(glm::inverse(glm::dmat3(world_from_index)));
  // Only its direction counts. Its length is brought near 1, or its square would leave the range of
  // single precision for values or spacings that are very large or small.
  double largest = 0.0;
  for (int column = 0; column < 3; ++column)
  {
    largest = std::max(largest, glm::length(covector[column]));
  }
  const double values = volume.classification.upper - volume.classification.lower;
  const double to_unit = 1.0 / (largest * (values > 0.0 ? values : 1.0));
  for (int row = 0; row < 3; ++row)
  {
    for (int column = 0; column < 3; ++column)
    {
      model.world_from_gradient[3 * row + column] =
        static_cast<float>(covector[column][row] * to_unit);
    }
    for (int column = 0; column < 4; ++column)
    {
      model.world_from_index[4 * row + column] =
        static_cast<float>(world_from_index[column][row]);
    }
  }
  return model;
}

}
