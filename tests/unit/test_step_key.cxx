// When a choice of steps or effects still holds: not when what it was made for changes, but when
// the camera moves, and when lights come along with it.
#include "../../modules/Mappers/step_key.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <functional>
#include <utility>
#include <vector>

using brume::Scene;
using brume::SceneKey;

namespace
{

void look_from(Scene& scene, const glm::dvec3& from, double near_plane = 1.0, double angle = 0.5)
{
  scene.camera.clip_from_world = glm::perspective(angle, 1.5, near_plane, 100.0) *
                                 glm::lookAt(from, glm::dvec3(0.0), glm::dvec3(0, 1, 0));
  scene.camera.direction = glm::normalize(-from);
}

Scene lit_scene()
{
  Scene scene;
  scene.volumes[0].data_revision = 3;
  scene.volumes[0].medium_revision = 4;
  scene.volumes[0].medium.lit = true;
  scene.lights.resize(2);
  scene.lights[1].positional = true;
  scene.lights[1].position = { 1, 2, 3 };
  look_from(scene, { 10, 3, 20 });
  return scene;
}

bool holds(const Scene& then, const Scene& now)
{
  SceneKey key;
  key.Take(then, { 0.5 });
  EXPECT_TRUE(key.Holds(then, { 0.5 }));
  return key.Holds(now, { 0.5 });
}

TEST(SceneKey, HoldsNothingAtFirst)
{
  SceneKey key;
  const Scene scene = lit_scene();
  EXPECT_FALSE(key.Holds(scene, {}));
  key.Take(scene, { 1.0 });
  EXPECT_TRUE(key.Holds(scene, { 1.0 }));
  EXPECT_FALSE(key.Holds(scene, { 2.0 }));
  key.Clear();
  EXPECT_FALSE(key.Holds(scene, { 1.0 }));
}

TEST(SceneKey, EveryChangeOfLitMatterCounts)
{
  const std::vector<std::pair<const char*, std::function<void(Scene&)>>> changes = {
    { "voxels", [](Scene& s) { s.volumes[0].data_revision = 9; } },
    { "medium", [](Scene& s) { s.volumes[0].medium_revision = 9; } },
    { "shading", [](Scene& s) { s.volumes[0].shading.enabled = true; } },
    { "lit", [](Scene& s) { s.volumes[0].medium.lit = false; } },
    { "albedo", [](Scene& s) { s.volumes[0].medium.albedo.y = 0.5; } },
    { "lobes", [](Scene& s) { s.volumes[0].medium.lobes.resize(1); } },
    { "octaves", [](Scene& s) { s.volumes[0].medium.octaves.count = 2; } },
    { "emission", [](Scene& s) { s.volumes[0].medium.emission.z = 0.5; } },
    { "black body", [](Scene& s) { s.volumes[0].medium.black_body = 0.5; } },
    { "lining", [](Scene& s) { s.volumes[0].medium.silver_lining.enabled = true; } },
    { "lining's spread", [](Scene& s) { s.volumes[0].medium.silver_lining.spread = 0.1; } },
    { "powder", [](Scene& s) { s.volumes[0].medium.powder.enabled = true; } },
    { "powder's form",
      [](Scene& s) { s.volumes[0].medium.powder.form = brume::Powder::Form::Height; } },
    { "a volume more", [](Scene& s) { s.volumes.push_back(s.volumes[0]); } },
    { "mode", [](Scene& s) { s.blend_mode = brume::BlendMode::Additive; } },
    { "sky", [](Scene& s) { s.sky.radiance.x = 0.1; } },
    { "ground", [](Scene& s) { s.sky.ground.x = 0.1; } },
    { "up",
      [](Scene& s) {
        s.sky.up = { 0, 1, 0 };
      } },
    { "fog", [](Scene& s) { s.fog.enabled = true; } },
    { "a light's colour", [](Scene& s) { s.lights[0].diffuse.x = 5.0; } },
    { "attenuation", [](Scene& s) { s.lights[1].attenuation.z = 1.0; } },
    { "cone", [](Scene& s) { s.lights[1].cone_angle = 20.0; } },
    { "a light less", [](Scene& s) { s.lights.pop_back(); } },
    { "a light's direction",
      [](Scene& s) {
        s.lights[0].direction = { 1, 0, 0 };
      } },
    { "a lamp's place", [](Scene& s) { s.lights[1].position.x += 0.1; } },
  };
  for (const auto& [name, change] : changes)
  {
    Scene scene = lit_scene();
    change(scene);
    EXPECT_FALSE(holds(lit_scene(), scene)) << name;
  }
  Scene fog = lit_scene();
  fog.fog.enabled = true;
  Scene denser = fog;
  denser.fog.extinction.x = 1.0;
  EXPECT_FALSE(holds(fog, denser));
}

TEST(SceneKey, TheCameraMayMove)
{
  const Scene then = lit_scene();
  Scene now = then;
  look_from(now, { -5, 8, 12 });
  EXPECT_TRUE(holds(then, now)); // lights of the world stayed
  look_from(now, { -5, 8, 12 }, 3.0, 0.3);
  EXPECT_TRUE(holds(then, now));
}

// Headlights and camera lights turn with the view.
TEST(SceneKey, LightsMayComeAlongWithTheCamera)
{
  const auto light = [](Scene& scene, const glm::dvec3& from)
  {
    look_from(scene, from, glm::length(from) / 50.0);
    const glm::dmat4 world_from_eye =
      glm::inverse(glm::lookAt(from, glm::dvec3(0.0), glm::dvec3(0, 1, 0)));
    scene.lights[0].direction = scene.camera.direction;
    scene.lights[1].position = glm::dvec3(world_from_eye * glm::dvec4(2, 3, -1, 1));
    scene.lights[1].direction = glm::dvec3(world_from_eye * glm::dvec4(0.6, 0, -0.8, 0));
  };
  Scene then = lit_scene();
  light(then, { 10, 3, 20 });
  Scene now = then;
  light(now, { -5, 8, 12 });
  EXPECT_TRUE(holds(then, now));
  now.lights[1].position.y += 0.5;
  EXPECT_FALSE(holds(then, now));
}

// Choices that hold for all directions of light are told so.
TEST(SceneKey, PlacesOfLightsMayBeLeftOut)
{
  Scene then = lit_scene();
  Scene now = then;
  now.lights[0].direction = { 1, 0, 0 };
  now.lights[1].position.x += 5.0;
  SceneKey key;
  key.Take(then, {}, false);
  EXPECT_TRUE(key.Holds(now, {}));
  now.lights[0].diffuse.x = 5.0;
  EXPECT_FALSE(key.Holds(now, {}));
}

TEST(SceneKey, WithoutLitMatterLightsDoNotCount)
{
  Scene then = lit_scene();
  then.volumes[0].medium.lit = false;
  Scene now = then;
  now.lights.clear();
  now.sky.radiance = glm::dvec3(1.0);
  EXPECT_TRUE(holds(then, now));
  EXPECT_FALSE(brume::is_lit(then));
  EXPECT_TRUE(brume::is_lit(lit_scene()));
}

TEST(SceneKey, IsovaluesCountForSurfaces)
{
  Scene then = lit_scene();
  then.blend_mode = brume::BlendMode::Isosurface;
  then.isosurfaces = { 1.0 };
  Scene now = then;
  EXPECT_TRUE(holds(then, now));
  now.isosurfaces = { 2.0 };
  EXPECT_FALSE(holds(then, now));
}

}
