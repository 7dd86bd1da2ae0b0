// Blinn and Phong's model where it is plain what it gives: a ramp has one normal everywhere.
#include "../support/transport_scenes.h"

#include "Transport/reference.h"

#include <gtest/gtest.h>

using namespace transport_scenes;

namespace
{

// Values rise along +x, so that the normal is −x, whatever the spacing. The camera looks along −z.
TEST(Shading, OfARampIsTheFormula)
{
  const Voxels<float> voxels(9, 9, 9, [](int i, int, int) { return 10.0f * i; });
  Scene scene;
  scene.volumes[0].grid = voxels.grid();
  scene.volumes[0].data_from_index = placed(glm::dvec3(0.5, 2.0, 1.0), glm::dvec3(0.0));
  scene.volumes[0].classification = classify(
    0.0, 80.0, [](double) { return 0.5; }, [](double) { return glm::dvec3(0.4, 0.8, 1.0); }, 3);
  scene.camera = view_of(scene, glm::dvec3(0, 0, -1), true).camera(1.0);
  scene.volumes[0].shading.enabled = true;
  scene.volumes[0].shading.ambient = 0.15;
  scene.volumes[0].shading.diffuse = 0.6;
  scene.volumes[0].shading.specular = 0.5;
  scene.volumes[0].shading.specular_power = 5.0;
  scene.volumes[0].shading.two_sided = false;
  scene.lights.resize(1);
  const double s = std::sqrt(0.5);
  struct
  {
    glm::dvec3 light; ///< where it goes
    double diffuse;   ///< n · l
  } const cases[] = {
    { { 1, 0, 0 }, 1.0 }, // from −x: faces the normal
    { { -1, 0, 0 }, 0.0 }, // from behind
    { { s, 0, -s }, s },
  };
  for (const auto& c : cases)
  {
    scene.lights[0].direction = c.light;
    // The half-way vector of l = −light and the viewer at +z, by hand.
    const glm::dvec3 half = glm::normalize(-c.light + glm::dvec3(0, 0, 1));
    const double n_dot_h = c.diffuse > 0.0 ? -half.x : 0.0;
    const double highlight = c.diffuse > 0.0 ? 0.5 * std::pow(n_dot_h, 5.0) : 0.0;
    const Film film = march(scene, 3, 3, 0.25);
    Film slow(3, 3);
    render_reference(scene, {}, slow);
    const double colour[3] = { 0.4, 0.8, 1.0 };
    for (int channel = 0; channel < 3; ++channel)
    {
      const double opacity = 1.0 - film.transmittance[channel][4];
      ASSERT_GT(opacity, 0.5);
      const double truth = opacity * (colour[channel] * (0.15 + 0.6 * c.diffuse) + highlight);
      EXPECT_NEAR(film.radiance[channel][4], truth, 2e-5) << c.light.x;
      EXPECT_NEAR(slow.radiance[channel][4], truth, 2e-5) << c.light.x;
    }
  }
  // Two-sided: the camera looks from where the values rise, and the normal is turned to it.
  scene.camera = view_of(scene, glm::dvec3(-1, 0, 0), true).camera(1.0);
  scene.lights[0].direction = { -1, 0, 0 };
  scene.volumes[0].shading.specular = 0.0;
  for (bool two_sided : { false, true })
  {
    scene.volumes[0].shading.two_sided = two_sided;
    const Film film = march(scene, 3, 3, 0.25);
    const double opacity = 1.0 - film.transmittance[2][4];
    EXPECT_NEAR(film.radiance[2][4], opacity * (two_sided ? 0.75 : 0.15), 2e-5);
  }
}

}
