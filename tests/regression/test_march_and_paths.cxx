// Path tracing with one scattering and the ray march draw every scene of the tests of light in the
// medium, and must agree: each checks the other.
#include "../support/fog_scenes.h"
#include "../support/fog_worlds.h"
#include "../support/lamp_box.h"
#include "../support/lit_props.h"
#include "../support/march_and_paths.h"
#include "../support/plan_scenes.h"
#include "../support/slab_scenes.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <random>

using namespace march_and_paths;

namespace
{

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr std::size_t every = 8; // pictures take many times as long
#else
constexpr std::size_t every = 1;
#endif

/// With the environment variable BRUME_PATHS=1, sixteen times the paths.
double effort()
{
  return std::getenv("BRUME_PATHS") ? 16.0 : 1.0;
}

using Pictures = std::vector<Picture>;

/// A picture of something that owns its voxels and has a `scene`.
template <class Owner>
Scene& add(Pictures& all, const std::string& name, std::shared_ptr<Owner> owner, int edge = 8)
{
  all.push_back({ name, owner, owner->scene, edge });
  return all.back().scene;
}

template <class T>
std::shared_ptr<T> keep(T&& value)
{
  return std::make_shared<T>(std::move(value));
}

// tests/analytic/test_single_scattering.cxx
Pictures slabs_of_cases()
{
  using namespace slab_scenes;
  Pictures all;
  for (const Case& c : cases)
  {
    for (const double sun : suns_of_cases)
    {
      const auto slab = keep(slab_of(c, sun, { 1.0, 0.8, 3.0 }));
      for (const double zenith : views_of_cases)
      {
        Scene& scene = add(all,
          std::string("slab, ") + c.name + ", sun " + std::to_string(int(sun)) + ", view " +
            std::to_string(int(zenith)),
          slab,
          4);
        scene.camera = slab->look(zenith).camera(1.0);
        if (c.depth.x > 6.0 && zenith > 90.0)
        {
          scene.volumes[0].density.extinction /= 10.0; // hardly a path would come through
        }
      }
    }
  }
  for (const int which : { 1, 2, 3 })
  {
    const auto slab = keep(slab_under_two_suns(which));
    add(all, "slab, suns " + std::to_string(which), slab, 4).camera = slab->look(30.0).camera(1.0);
  }
  return all;
}

// tests/analytic/test_lit_media.cxx
Pictures slabs()
{
  using namespace slab_scenes;
  Pictures all;
  const auto from_both_sides = [&](const std::string& name, const auto& slab)
  {
    for (const double zenith : { 25.0, 120.0 })
    {
      add(all, "slab, " + name + ", view " + std::to_string(int(zenith)), slab, 6).camera =
        slab->look(zenith, 1.0).camera(1.0);
      all.back().parts_of_voxel = name == "mask" ? 64.0 : name == "warm" ? 8.0 : 2.0;
      all.back().parts_of_sky = 400;
      all.back().noise = name == "warm" ? 0.04 : all.back().noise; // black bodies are dear
    }
  };
  for (const double side : { 1.0, -1.0 })
  {
    from_both_sides(side > 0.0 ? "sky" : "sky below", keep(slab_under_sky(side)));
  }
  {
    // A path in a hundred thousand would meet it.
    const auto slab = keep(thin_slab_under_sky());
    slab->scene.volumes[0].density.extinction *= 1000.0;
    from_both_sides("a thousand times the thin one", slab);
  }
  from_both_sides("octaves", keep(slab_of_octaves()));
  from_both_sides("silver lining", keep(slab_with_silver_lining()));
  from_both_sides("powder", keep(slab_of_powder(Powder::Form::Exponential)));
  from_both_sides("powder by height", keep(slab_of_powder(Powder::Form::Height)));
  from_both_sides("warm", keep(WarmSlab()));
  from_both_sides("glow without extinction", keep(glowing_slab_without_extinction()));
  from_both_sides("classified", keep(glowing_classified_slab()));
  from_both_sides("shaded", keep(shaded_slab()));
  for (const Mixture mixture : { Mixture::Sum, Mixture::Components })
  {
    from_both_sides(mixture == Mixture::Sum ? "sum" : "components",
      keep(mixed_slab({ 0.4, 1.0, 0.2 }, { 1.5, 0.3, 0.3 }, mixture)));
  }
  from_both_sides("unlit", keep(unlit_slab()));
  {
    const auto slab = keep(scaled_slab({ 3.0, 0.5, 2.0 }));
    View view = slab->look(30.0, 1.0);
    view.centre.z = 1.0;
    add(all, "slab, scaled", slab).camera = view.camera(1.0);
  }
  for (const char* way : { "cropping", "clipping plane", "mask" })
  {
    from_both_sides(way, std::make_shared<HalfHiddenSlab>(way));
  }
  from_both_sides("all off", keep(slab_with_all_off(false)));
  return all;
}

// tests/analytic/test_lit_ball.cxx
Pictures balls()
{
  using lit_scenes::LitBall;
  Pictures all;
  add(all, "ball of 14", std::make_shared<LitBall>(14, 5.2, 0.5), 12);
  add(all, "ball of 32", std::make_shared<LitBall>(32, 13.0, 4.0 / 13.0), 12);
  add(all, "ball of 62", std::make_shared<LitBall>(62, 26.0, 4.0 / 26.0), 12);
  return all;
}

// tests/analytic/test_point_lights.cxx
Pictures lamps()
{
  using namespace lamp_box;
  Pictures all;
  const auto box = std::make_shared<Box>();
  const auto lit_by = [&](const std::string& name, const Light& light) -> Scene&
  {
    Scene& scene = add(all, "lamp, " + name, box, lamp_box::edge);
    scene.lights = { light };
    all.back().parts_of_voxel = 64.0;
    return scene;
  };
  const glm::dvec3 square(0.0, 0.0, 1.0);
  lit_by("outside", lamp(lamp_outside, square));
  lit_by("beside", lamp(lamp_beside, { 0.0, 1.0, 0.0 }));
  for (const glm::dvec3& attenuation : attenuations)
  {
    lit_by("inside", lamp(lamp_inside, attenuation));
  }
  const glm::dvec3 place = place_on_a_ray(*box);
  for (const double away : { 1e-6, 1e-3 })
  {
    // The light turns round within a step of the march, however short.
    lit_by("beside a ray", lamp(place + away * across_a_ray(*box), square));
    all.back().by_reference = true;
  }
  lit_by("on a ray, all but unbounded", lamp(place, { 1e-3, 0.0, 1.0 }));
  all.back().by_reference = true;
  lit_by("on a ray, bounded", lamp(place, { 0.2, 0.1, 0.5 }));
  lit_by("beside a ray, isotropic", lamp(place + 1e-3 * across_a_ray(*box), square))
    .volumes[0]
    .medium.lobes.clear();
  for (const glm::dvec3& position : spots)
  {
    lit_by("spot", spot(position));
  }
  const auto far = std::make_shared<Box>();
  far->scene.lights = { lamp(lamp_inside, square) };
  far->move({ 1e5, -2e5, 3e5 });
  add(all, "lamp, far from the origin", far, lamp_box::edge);
  return all;
}

// tests/analytic/test_fog.cxx, which looks along single rays
Pictures fogs()
{
  using namespace fog_scenes;
  Pictures all;
  View view;
  view.forward = glm::normalize(glm::dvec3(0.2, 0.9, -0.15));
  view.up = glm::dvec3(0.0, 0.0, 1.0);
  view.centre = glm::dvec3(0.0, 0.0, 3.0);
  view.distance = 8.0;
  view.half_height = 5.0;
  view.far_plane = 40.0;
  const auto put = [&](const std::string& name, Scene scene, double falloff)
  {
    scene.camera = view.camera(1.0);
    char text[32];
    std::snprintf(text, sizeof(text), ", falloff %g", falloff);
    all.push_back({ "fog, " + name + text, nullptr, scene, 6 });
    all.back().parts_of_sky = 800;
  };
  for (const double falloff : { 0.0, 1e-4, 0.05, 1.0 })
  {
    for (const double rise : { 1.0, 0.5, 0.02 })
    {
      Scene scene = scene_of(falloff, dvec3(0.4, 0.1, 0.02));
      scene.lights = { sun_of(rise) };
      put("sun", scene, falloff);
    }
    put("sky", scene_under_sky(falloff), falloff);
  }
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(-3.0, 3.0);
  for (const double falloff : { 0.0, 0.05, 1.0 })
  {
    for (const dvec3& attenuation : lamp_attenuations)
    {
      for (const double cone : { 180.0, 25.0 })
      {
        Scene scene = scene_of(falloff, dvec3(2.0, 0.1, 0.001));
        const double x = place(random);
        const double z = place(random);
        scene.lights = { lamp_of({ x, 0.0, 3.0 + z }, direction_of(-0.6, 1.2), attenuation, cone) };
        const char* const kinds[2][4] = { { "even lamp", "lamp 1 / d", "lamp 1 / d²", "dark lamp" },
          { "even spot", "spot 1 / d", "spot 1 / d²", "dark spot" } };
        put(kinds[cone < 90.0][&attenuation - lamp_attenuations], scene, falloff);
      }
    }
  }
  return all;
}

// tests/analytic/test_fog_volumes.cxx
Pictures worlds()
{
  using namespace fog_worlds;
  Pictures all;
  const auto put = [&](const std::string& name, World made, double ends_at = 26.0)
  {
    const auto world = keep(std::move(made));
    world->make_volumes();
    Scene& scene = add(all, "world, " + name, world, 6);
    // Something opaque, so that nothing is seen behind what the march is told of.
    scene.surface_depth.assign(36, surface_at(*world, ends_at));
    all.back().parts_of_voxel = 0.5;
  };
  put("density in even fog", density_in_even_fog());
  put("coloured", coloured_in_coloured_layers());
  put("colour", colour_in_layers());
  put("unlit density", unlit_density_in_fog());
  for (const dvec3& eye : eyes_on_two)
  {
    put("two volumes", two_in_layers(eye));
  }
  for (const double surface : { 5.0, 14.5, 25.0 })
  {
    World world;
    world.boxes = { cloud() };
    put("surfaces", world, surface);
  }
  for (const dvec3& place : lamps_of_world)
  {
    put("lamp", world_with_lamp(place));
  }
  for (const double falloff : { 0.0, 0.5 })
  {
    put("sky", world_under_sky(falloff));
  }
  put("layers", cloud_in_layers());
  put("sun under the horizon", sun_under_horizon());
  for (const bool layers : { true, false })
  {
    put("all", all_in_fog(layers));
  }
  return all;
}

// tests/regression/test_effect_plan.cxx
Pictures planned()
{
  Pictures all;
  auto cases = plan_scenes::all_cases();
  for (plan_scenes::Case& fog : plan_scenes::fogs())
  {
    cases.push_back(std::move(fog));
  }
  for (plan_scenes::Case& c : cases)
  {
    const auto kept = keep(std::move(c));
    Scene& scene = add(all, "plan, " + kept->name, kept);
    if (kept->name == "glowing")
    {
      all.back().noise = 0.04; // black bodies are dear
    }
    if (kept->name == "thin")
    {
      scene.volumes[0].density.extinction *= 100.0; // a path in a thousand would meet it
      all.back().parts_of_sky = 60;
    }
    if (!scene.surface_depth.empty())
    {
      std::vector<float> fewer;
      for (int i = 0; i < 64; ++i)
      {
        const int step = plan_scenes::pixels / 8;
        fewer.push_back(scene.surface_depth[(i / 8 * plan_scenes::pixels + i % 8) * step]);
      }
      scene.surface_depth = fewer;
    }
    if (scene.volumes.empty())
    {
      all.back().parts_of_sky = 800;
    }
    else if (scene.fog.enabled)
    {
      scene.surface_depth.assign(64, 0.999f); // as in worlds()
      all.back().parts_of_voxel = 0.5;
    }
    if (kept->name == "foggy")
    {
      // Its fog scatters all but straight on, which takes more lights in place of a sky than there
      // is time for: the lights, and then the sky on fog that scatters evenly.
      Picture sky = all.back();
      sky.name += ", its sky";
      sky.scene.lights.clear();
      sky.scene.fog.lobes.clear();
      scene.sky.radiance = glm::dvec3(0.0);
      all.push_back(sky);
    }
  }
  return all;
}

/// The scene that a mapper makes for a picture of this size.
template <class Prop>
const Scene& scene_of_prop(const std::shared_ptr<Prop>& prop, int edge)
{
  const Scene* scene =
    prop->mapper->UpdateScene(prop->volume, prop->camera, prop->lights, edge, edge);
  EXPECT_NE(scene, nullptr);
  return *scene;
}

// tests/regression/test_lit_window.cxx
Pictures props()
{
  using namespace lit_props;
  Pictures all;
  const auto together = std::make_shared<LitProp>();
  const auto put = [&](const std::string& name, const std::shared_ptr<LitProp>& prop)
  {
    all.push_back({ "prop, " + name, prop, scene_of_prop(prop, 8) });
    all.back().parts_of_sky = 150;
  };
  for (const auto& [name, add_light] : kinds_of_light)
  {
    const auto prop = std::make_shared<LitProp>();
    add_light(*prop);
    add_light(*together);
    put(name, prop);
    prop->camera->Azimuth(50);
    put(name + std::string(", from elsewhere"), prop);
  }
  put("all lights", together);
  const auto prop = std::make_shared<LitProp>();
  prop->put_under_sky();
  put("sky", prop);
  prop->sky->SetEnvironmentMap(two_grey_map());
  put("sky and map", prop);
  return all;
}

// tests/regression/test_medium.cxx
Pictures cubes()
{
  using namespace lit_props;
  Pictures all;
  const auto put = [&](const std::string& name, const std::shared_ptr<Cube>& cube) {
    all.push_back({ "cube, " + name, cube, scene_of_prop(cube, 8), 8 });
  };
  const auto fresh = [] { return std::make_shared<Cube>(); };
  auto cube = fresh();
  const auto light = cube->light_from_the_front();
  put("light from the front", cube);
  light->SetLightTypeToHeadlight();
  put("headlight", cube);
  put_at_the_camera(light);
  put("camera light", cube);
  cube = fresh();
  cube->light_from_three_sides(0.05);
  put("three lights", cube);
  cube->medium->SetAnisotropy(0.5);
  put("three lights, anisotropic", cube);
  // In the test's own matter a path in ten thousand would meet any.
  constexpr double thin = 1e-3;
  cube = fresh();
  cube->medium->SetExtinction(thin);
  const auto lamp = cube->add_lamp();
  put("lamp", cube);
  make_spot(lamp);
  put("spot", cube);
  cube = fresh();
  cube->medium->SetExtinction(thin);
  cube->put_under_sky();
  put("sky", cube);
  cube->put_under_a_map(0.75);
  put("map", cube);
  cube = fresh();
  cube->glow(0.1);
  put("glow", cube);
  cube->glow_of_heat();
  put("heat", cube);
  cube = fresh();
  cube->classify();
  put("classified", cube);
  cube = fresh();
  cube->light_aslant();
  put("light aslant", cube);
  cube->sky->SetSkyRadiance(0.1, 0.2, 0.3);
  put("light and sky", cube);
  cube = fresh();
  cube->light_from_behind();
  put("light from behind", cube);
  // Two of them.
  for (const double shift : { 20.0, -20.0, 0.0 })
  {
    const bool under_sky = shift == 0.0;
    const auto two = std::make_shared<TwoCubes>(under_sky ? thin : 0.05);
    if (under_sky)
    {
      two->first.mapper->SetSky(two->first.sky);
      two->first.sky->SetSkyRadiance(1.0, 1.0, 1.0);
    }
    else
    {
      two->second.volume->SetPosition(shift, 0.0, 0.0);
      two->first.add_light(90.0, lit_props::edge / 2, lit_props::edge / 2);
    }
    const std::shared_ptr<Cube> first(two, &two->first);
    const std::shared_ptr<Cube> second(two, &two->second);
    Scene scene = scene_of_prop(first, 8);
    scene.volumes.push_back(scene_of_prop(second, 8).volumes[0]);
    all.push_back({ "cubes, two", two, scene, 8 });
  }
  return all;
}

void expect_agreement(const Pictures& pictures)
{
  double worst = 0.0;
  int drawn = 0;
  for (std::size_t i = 0; i < pictures.size(); i += every)
  {
    Picture picture = pictures[i];
    leave_out_what_paths_do_not_know(picture.scene);
    for (const Picture& part : parts_of(picture))
    {
      const Truth truth = find_truth(part);
      const Agreement a = agreement(traced(part, effort(), ++drawn), truth);
      std::printf("%-48s %5.2f standard errors off, mean square %4.2f of %3d pixels; noise %.4f, "
                  "the march's error %.5f\n",
        part.name.c_str(),
        a.sum,
        a.square,
        a.count,
        a.noise,
        a.stated);
      EXPECT_LE(a.sum, 4.5) << part.name;
      EXPECT_LE(a.square, 2.3 + 6.0 / std::sqrt(std::max(a.count, 1))) << part.name;
      EXPECT_EQ(a.lost, 0) << part.name;
      EXPECT_LE(a.noise, 0.1) << part.name;
      EXPECT_LE(a.stated, 0.01) << part.name;
      worst = std::max(worst, a.sum);
    }
  }
  std::printf("%d pictures, at most %.2f standard errors off\n", drawn, worst);
}

}

TEST(MarchAndPaths, SlabsUnderASun)
{
  expect_agreement(slabs_of_cases());
}
TEST(MarchAndPaths, SlabsInAllLight)
{
  expect_agreement(slabs());
}
TEST(MarchAndPaths, Balls)
{
  expect_agreement(balls());
}
TEST(MarchAndPaths, Lamps)
{
  expect_agreement(lamps());
}
TEST(MarchAndPaths, Fog)
{
  expect_agreement(fogs());
}
TEST(MarchAndPaths, VolumesInFog)
{
  expect_agreement(worlds());
}
TEST(MarchAndPaths, PlannedScenes)
{
  expect_agreement(planned());
}
TEST(MarchAndPaths, Props)
{
  expect_agreement(props());
}
TEST(MarchAndPaths, Cubes)
{
  expect_agreement(cubes());
}
