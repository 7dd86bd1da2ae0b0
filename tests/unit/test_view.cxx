// What `brume view` is without its window: layout, controls, scenes that are saved, pictures.
#include "view_support.h"

#include "display_options.h"
#include "mesh_scene.h"
#include "private_display.h"

#include "vtkBrumeFog.h"

#include "view/compose.h"
#include "view/controls.h"
#include "view/layout.h"
#include "view/recording.h"
#include "view/side_panel.h"
#include "view/transfer_editor.h"

#include "display_table.h"

#include <CLI/CLI.hpp>

#include <limits>
#include <random>

TEST(Layout, NothingOverlapsAndNothingIsLost)
{
  const int sizes[][2] = { { 200, 200 }, { 800, 600 }, { 1280, 760 }, { 2560, 1440 }, { 600, 1600 },
    { 641, 1 } };
  for (const auto& size : sizes)
    for (const double scale : { 1.0, 2.0 })
      for (int pictures = 1; pictures <= 4; ++pictures)
        for (const bool panel : { false, true })
        {
          const Layout layout = lay_out(size[0], size[1], Metrics(scale), pictures, panel);
          std::vector<Box> all = layout.pictures;
          ASSERT_EQ(all.size(), static_cast<std::size_t>(pictures));
          all.insert(all.end(), layout.captions.begin(), layout.captions.end());
          for (const Box& picture : layout.pictures)
          {
            EXPECT_FALSE(picture.empty());
            EXPECT_EQ(picture.width, layout.pictures[0].width);
            EXPECT_EQ(picture.height, layout.pictures[0].height);
          }
          if (!layout.panel.empty())
          {
            EXPECT_TRUE(panel);
            all.push_back(layout.panel);
          }
          for (std::size_t i = 0; i < all.size(); ++i)
          {
            EXPECT_GE(all[i].x, 0);
            EXPECT_GE(all[i].y, 0);
            EXPECT_LE(all[i].x + all[i].width, size[0]);
            if (size[1] >= 200)
            {
              EXPECT_LE(all[i].y + all[i].height, size[1]);
            }
            for (std::size_t j = i + 1; j < all.size(); ++j)
            {
              EXPECT_FALSE(!all[i].empty() && !all[j].empty() && overlap(all[i], all[j]))
                << size[0] << " x " << size[1] << ", " << pictures;
            }
          }
        }
  EXPECT_FALSE(lay_out(800, 600, Metrics(1.0), 1, true).panel.empty());
  EXPECT_FALSE(lay_out(2560, 1440, Metrics(2.0), 2, true).panel.empty());
  EXPECT_FALSE(lay_out(800, 600, Metrics(2.0), 1, true).panel.empty());
  EXPECT_TRUE(lay_out(400, 600, Metrics(2.0), 1, true).panel.empty());
  EXPECT_THROW(lay_out(0, 100, Metrics(1.0), 1, true), std::invalid_argument);
}

TEST(DisplayTable, IsDisplayByteForEveryValue)
{
  std::mt19937 random(7);
  std::uniform_int_distribution<std::uint32_t> any_bits;
  std::uniform_real_distribution<float> near_one(-0.1f, 1.2f);
  for (const auto curve : { brume::Display::Curve::None, brume::Display::Curve::SRGB })
    for (const double exposure : { 0.0, 3.0, -7.5, 64.0, -64.0 })
    {
      const brume::Display display{ exposure, curve };
      const brume::DisplayTable table(display);
      const auto check = [&](float value)
      { ASSERT_EQ(int(table(value)), int(brume::display_byte(value, display))) << value; };
      for (const float value : { 0.0f, -0.0f, 1.0f, -1.0f, std::nextafter(1.0f, 0.0f), 1e-45f, 3e38f,
             std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity(),
             std::numeric_limits<float>::quiet_NaN() })
      {
        check(value);
      }
      for (int i = 0; i < 20000; ++i)
      {
        check(near_one(random));
        const std::uint32_t bits = any_bits(random);
        float value;
        static_assert(sizeof value == sizeof bits);
        std::memcpy(&value, &bits, sizeof value);
        check(value);
      }
    }
}

TEST(Controls, PlacesAndValuesAreInverse)
{
  SceneOptions options;
  ControlScene scene;
  scene.options = &options;
  scene.size = 200.0;
  for (const Control& control : controls())
  {
    EXPECT_DOUBLE_EQ(value_at(control, scene, -1.0), control.lower(scene)) << control.name;
    EXPECT_NEAR(value_at(control, scene, 2.0) / control.upper(scene), 1.0, 1e-12) << control.name;
    for (const double place : { 0.0, 0.25, 0.5, 1.0 })
    {
      const double value = value_at(control, scene, place);
      const double off = control.scale == ControlScale::Whole ? 0.5 / 15.0 : 1e-9;
      EXPECT_NEAR(place_of(control, scene, value), place, off) << control.name;
    }
  }
}

// Whatever a control sets is what it then tells, through the keys of the scene file and their checks.
TEST(Controls, WhatIsSetIsWhatIsRead)
{
  for (const bool density : { false, true })
  {
    ordered_json keys{ { "input", "sample:cloud" }, { "phase", "hg:0.5:1" } };
    if (density)
    {
      keys["extinction"] = { 0.1, 0.2, 0.05 };
    }
    for (const Control& control : controls())
    {
      ordered_json scene = keys;
      const ParsedScene before(scene);
      ControlScene now;
      now.options = &before.options();
      now.size = 100.0;
      if (!control.inapplicable(now).empty())
      {
        continue;
      }
      // An opacity distance of its own is the mapper's to tell.
      if (control.name == std::string("opacity distance"))
      {
        continue;
      }
      for (const double place : { 0.3, 0.9 })
      {
        const double value = value_at(control, now, place);
        control.set(scene, now, value);
        const ParsedScene after(scene);
        ControlScene then;
        then.options = &after.options();
        then.exposure = after.display().exposure;
        then.size = 100.0;
        std::optional<double> read = control.get(then);
        if (control.name == std::string("tolerance"))
        {
          read = after.options().tolerance_choice; // settled later, as the next
        }
        else if (control.name == std::string("background"))
        {
          read = brightness_of(after.options().background_choice.value());
        }
        ASSERT_TRUE(read) << control.name;
        EXPECT_NEAR(*read, value, 1e-9 * (1.0 + std::abs(value))) << control.name;
      }
    }
  }
}

TEST(Controls, TheSunIsWhereItsAnglesSay)
{
  for (const Triple& up : { Triple{ 0, 0, 1 }, Triple{ 0, 1, 0 }, Triple{ 1, 0, 0 }, Triple{ 1, 2, -3 } })
    for (const double azimuth : { -170.0, -20.0, 0.0, 95.0 })
      for (const double elevation : { -60.0, 0.0, 45.0, 89.0 })
      {
        const SunAngles angles = sun_angles(sun_direction({ azimuth, elevation }, up), up);
        EXPECT_NEAR(angles.azimuth, azimuth, 1e-9);
        EXPECT_NEAR(angles.elevation, elevation, 1e-9);
      }
  const Triple zenith = sun_direction({ 0.0, 90.0 }, { 0, 0, 2 });
  EXPECT_GT(zenith[2], 0.999);
}

TEST(Scenes, ACommandLineAndAFileAreOneScene)
{
  const std::string path = BRUME_TEST_OUTPUT "/view-scene.json";
  std::ofstream(path) << R"({ "input": "view-ball.nrrd", "preset": "grey", "exposure": 1.5,
    "opacity": [[0, 0], [100, 0.5]], "colour": [[0, 1, 0, 0], [200, 0, 0.25, 1]],
    "lights": [{ "type": "headlight", "intensity": 0.5 }], "sun-direction": [1, 0, 1] })";
  ball_file();
  CLI::App command;
  SceneOptions options;
  DisplayOptions display;
  std::string own;
  add_scene_options(command, options, "preset");
  add_display_options(command, display);
  command.add_option("--mappers", own); // a subcommand's own is no part of a scene
  command.get_option("INPUT")->required(false);
  command.parse(
    "--scene " + path + " --mappers raymarch --albedo 0.5,0.25,1 --clipping-plane 1,0,0,-7 "
    "--force shadows=off --quiet --sun-direction 0,1,1");
  const ordered_json scene = scene_of(command, options);
  EXPECT_EQ(scene["input"], BRUME_TEST_OUTPUT "/view-ball.nrrd");
  EXPECT_EQ(scene["albedo"], ordered_json({ 0.5, 0.25, 1.0 }));
  EXPECT_EQ(scene["clipping-plane"], ordered_json::parse("[[1.0, 0.0, 0.0, -7.0]]"));
  EXPECT_EQ(scene["force"], ordered_json({ { "shadows", false } }));
  EXPECT_EQ(scene["sun-direction"], ordered_json({ 0.0, 1.0, 1.0 })); // the command line wins
  EXPECT_EQ(scene["exposure"], 1.5);
  EXPECT_FALSE(scene.contains("quiet"));
  EXPECT_FALSE(scene.contains("mappers"));

  // The options that the JSON stands for are those that were parsed.
  const ParsedScene parsed(scene);
  EXPECT_EQ(parsed.options().medium.albedo, options.medium.albedo);
  EXPECT_EQ(parsed.options().modes.clipping_planes, options.modes.clipping_planes);
  EXPECT_EQ(parsed.options().medium.forces, options.medium.forces);
  EXPECT_EQ(parsed.options().medium.lights.size(), 1u);
  EXPECT_EQ(parsed.display().exposure, 1.5);
  ASSERT_EQ(parsed.options().opacity.size(), 2u);
  EXPECT_EQ(parsed.options().opacity[1].opacity, 0.5);
  ASSERT_EQ(parsed.options().colour.size(), 2u);
  EXPECT_EQ(parsed.options().colour[1].green, 0.25);
  // Read from the file, it is the same scene but for the command line's part.
  const ordered_json read = read_scene(path);
  EXPECT_EQ(read["opacity"], scene["opacity"]);
  EXPECT_EQ(read["input"], scene["input"]);
}

TEST(Scenes, TransferFunctionsAreChecked)
{
  const auto refused = [](const char* list)
  {
    ordered_json scene = ball_scene();
    scene["opacity"] = ordered_json::parse(list);
    try
    {
      const ParsedScene parsed(scene);
      return std::string();
    }
    catch (const Failure& failure)
    {
      EXPECT_EQ(failure.Status, BadCall);
      return std::string(failure.what());
    }
  };
  EXPECT_NE(refused("[]").find("/opacity: it has no points"), std::string::npos);
  EXPECT_NE(refused("[[0, 0], [0, 1]]").find("/opacity/1"), std::string::npos);
  EXPECT_NE(refused("[[0, 0], [1, 1.5]]").find("/opacity/1/1"), std::string::npos);
  EXPECT_NE(refused("[[0]]").find("/opacity/0"), std::string::npos);
  EXPECT_NE(refused("3").find("/opacity"), std::string::npos);
  EXPECT_EQ(refused("[[0, 0.25]]"), "");
}

TEST(TransferEditor, PointsMoveBetweenTheirNeighbours)
{
  TransferFunction function;
  function.opacity = { { 0.0, 0.0 }, { 10.0, 0.5 }, { 20.0, 1.0 } };
  move_point(function, 1, 50.0, 2.0);
  EXPECT_GT(function.opacity[1].value, 19.0);
  EXPECT_LT(function.opacity[1].value, 20.0);
  EXPECT_EQ(function.opacity[1].opacity, 1.0);
  move_point(function, 2, -5.0, 0.25);
  EXPECT_GT(function.opacity[2].value, function.opacity[1].value);
  EXPECT_EQ(add_point(function, 5.0, 0.1), 1);
  EXPECT_EQ(function.opacity[1].value, 5.0);
  EXPECT_EQ(add_point(function, 5.0, 0.2), 1); // one point a value
  EXPECT_EQ(function.opacity.size(), 4u);
  remove_point(function, 1);
  EXPECT_EQ(function.opacity.size(), 3u);
  function.opacity.resize(1);
  remove_point(function, 0);
  EXPECT_EQ(function.opacity.size(), 1u);

  CurveField field;
  field.box = { 10, 20, 101, 51 };
  field.lower = -100.0;
  field.upper = 100.0;
  for (const double value : { -100.0, 0.0, 100.0 })
  {
    EXPECT_NEAR(field.value_of(field.x_of(value)), value, 1.0);
  }
  for (const double opacity : { 0.0, 0.25, 1.0 })
  {
    EXPECT_NEAR(field.opacity_of(field.y_of(opacity)), opacity, 0.02);
  }
  EXPECT_EQ(point_at(function, field, field.x_of(0.0) + 2, field.y_of(0.0) - 2, 5), 0);
  EXPECT_EQ(point_at(function, field, 10, 20, 5), -1);
}

TEST(Viewer, StillPicturesAreThoseOfRender)
{
  Viewer viewer(ball_scene(), settings_of({ MapperKind::RayMarch }));
  viewer.resize(300, 120);
  viewer.camera()->Azimuth(33.0);
  viewer.camera_moved();
  finish(viewer);
  const Shot& shot = viewer.shot(0);
  EXPECT_TRUE(shot.whole);
  EXPECT_EQ(shot.failure, "");
  const brume::Picture still = shot.picture;
  const ordered_json scene = viewer.scene();
  EXPECT_EQ(scene["resolution"], ordered_json({ still.width, still.height }));
  EXPECT_LE(difference(still, rendered(scene)), 0.004);
  // It does show something, and another view is another picture.
  ordered_json other = scene;
  other["camera-position"] = { 0.0, -100.0, 90.0 };
  EXPECT_GT(difference(still, rendered(other)), 0.05);
}

TEST(Viewer, KeysChangeTheSceneThatIsSaved)
{
  Viewer viewer(ball_scene(), settings_of({ MapperKind::RayMarch }));
  viewer.resize(200, 100);
  finish(viewer);
  const brume::Picture before = viewer.shot(0).picture;
  EXPECT_TRUE(viewer.key("l")); // a sun
  EXPECT_TRUE(viewer.stale());
  EXPECT_TRUE(viewer.key("Left"));
  EXPECT_TRUE(viewer.key("g"));
  EXPECT_TRUE(viewer.key("b"));
  EXPECT_FALSE(viewer.key("F35"));
  finish(viewer);
  EXPECT_GT(difference(before, viewer.shot(0).picture), 0.1);
  const ordered_json scene = viewer.scene();
  EXPECT_TRUE(scene.contains("sun-direction"));
  EXPECT_NEAR(scene["anisotropy"].get<double>(), -1.9 / 40.0, 1e-12);
  EXPECT_LE(difference(viewer.shot(0).picture, rendered(scene)), 0.004);
  EXPECT_TRUE(viewer.key("BackSpace"));
  EXPECT_FALSE(viewer.scene().contains("sun-direction"));
  finish(viewer);
  EXPECT_LE(difference(before, viewer.shot(0).picture), 1e-6);
}

// What a mapper was once told must not stay when the scene no longer has it.
TEST(Viewer, WhatIsTakenOutOfTheSceneIsGone)
{
  Viewer viewer(ball_scene(), settings_of({ MapperKind::RayMarch }));
  viewer.resize(160, 120);
  finish(viewer);
  const brume::Picture before = viewer.shot(0).picture;
  const std::pair<const char*, ordered_json> cuts[] = {
    { "clipping-plane", ordered_json::parse("[[1, 0, 0, -12]]") },
    { "cropping", ordered_json::parse("[0, 12, 0, 23, 0, 23]") },
    { "force", ordered_json::parse(R"({"absorption": false})") },
    { "blend-mode", "mip" },
    { "opacity", ordered_json::parse("[[50, 0], [250, 0.02]]") },
  };
  for (const auto& [key, value] : cuts)
  {
    viewer.set_key(key, value);
    finish(viewer);
    EXPECT_GT(difference(before, viewer.shot(0).picture), 0.05) << key;
    EXPECT_EQ(viewer.key_of_scene(key), value);
    viewer.set_key(key, nullptr);
    finish(viewer);
    EXPECT_LE(difference(before, viewer.shot(0).picture), 1e-6) << key;
  }
  // Two planes, one after another: the second alone cuts.
  viewer.set_key("clipping-plane", ordered_json::parse("[[1, 0, 0, -12]]"));
  viewer.set_key("clipping-plane", ordered_json::parse("[[-1, 0, 0, 12]]"));
  finish(viewer);
  EXPECT_LE(difference(viewer.shot(0).picture, rendered(viewer.scene())), 0.004);
}

// Keys that others need are saved with them, or not at all: --scene would refuse the file.
TEST(Viewer, SavedScenesAreReadAgain)
{
  ordered_json scene = ball_scene();
  scene["silver-lining"] = 1.0;
  scene["silver-lining-spread"] = 0.3;
  scene["sun-direction"] = { 0.0, 0.0, 1.0 };
  scene["sun-irradiance"] = { 1.0, 2.0, 3.0 };
  Viewer viewer(scene, settings_of({ MapperKind::RayMarch }));
  const auto reads = [&]
  {
    const std::string path = BRUME_TEST_OUTPUT "/view-saved.json";
    std::ofstream(path) << viewer.scene().dump();
    CLI::App command;
    SceneOptions options;
    add_scene_options(command, options, "preset");
    command.get_option("INPUT")->required(false);
    EXPECT_NO_THROW(command.parse("--scene " + path)) << viewer.scene().dump(2);
  };
  reads();
  viewer.set_key("silver-lining", nullptr);
  EXPECT_TRUE(viewer.key_of_scene("silver-lining-spread").is_null());
  reads();
  viewer.key("l");
  reads();
  viewer.key("BackSpace");
  EXPECT_EQ(viewer.key_of_scene("silver-lining"), 1.0);
  reads();
}

TEST(Viewer, DraftsAreCoarseWhereTimeIsShortAndNothingIsLostWhenTheyEnd)
{
  Viewer viewer(ball_scene(), settings_of({ MapperKind::RayMarch }));
  viewer.resize(600, 400);
  viewer.draft(go_on);
  EXPECT_LT(viewer.shot(0).picture.width, 600); // the first, of which nothing is known
  EXPECT_FALSE(viewer.stale());
  finish(viewer);
  const brume::Picture whole = viewer.shot(0).picture;
  // Ended at once: the picture stays.
  viewer.camera()->Azimuth(10.0);
  viewer.camera_moved();
  viewer.draft([](double) { return false; });
  EXPECT_TRUE(viewer.stale());
  EXPECT_EQ(viewer.shot(0).picture.rgb, whole.rgb);
  viewer.draft(go_on);
  EXPECT_FALSE(viewer.refine([](double) { return false; }));
  EXPECT_FALSE(viewer.finished());
  finish(viewer);
  EXPECT_LE(difference(viewer.shot(0).picture, rendered(viewer.scene())), 0.004);
}

TEST(Viewer, PathsAreAddedUntilTheToleranceIsMet)
{
  ordered_json scene = ball_scene();
  scene.erase("preset");
  scene["extinction"] = 0.0005;
  scene["sun-direction"] = { 1.0, -1.0, 1.0 };
  scene["tolerance"] = 0.05;
  Viewer viewer(scene, settings_of({ MapperKind::PathTrace }));
  viewer.resize(64, 64);
  viewer.draft(go_on);
  ASSERT_TRUE(viewer.refine(go_on)); // the march
  const brume::Picture march = viewer.shot(0).picture;
  finish(viewer);
  const Shot& shot = viewer.shot(0);
  ASSERT_TRUE(shot.error);
  EXPECT_LE(*shot.error, 0.05);
  EXPECT_NE(shot.state.find("paths a pixel"), std::string::npos);
  EXPECT_GT(difference(march, shot.picture), 1e-4); // several scatterings
  EXPECT_LT(difference(march, shot.picture), 0.5);
}

TEST(Viewer, TheMouseTurnsWhatItIsOn)
{
  Viewer viewer(ball_scene(), settings_of({ MapperKind::RayMarch, MapperKind::Smart }));
  viewer.resize(1000, 700);
  viewer.key("l");
  viewer.draft(go_on);
  const std::vector<Tile>& tiles = viewer.tiles();
  const Box panel = tiles.back().box;
  ASSERT_FALSE(tiles.back().picture);
  ASSERT_EQ(panel.x + panel.width, 1000);
  // The camera's.
  EXPECT_FALSE(viewer.press(10, 10, false, false));
  EXPECT_FALSE(viewer.drag(20, 20));
  // A page, and all that it holds, by pressing everywhere: whatever is set can be drawn and saved.
  for (int page = 0; page < 4; ++page)
  {
    viewer.tiles();
    for (int y = panel.y + 30; y < panel.height; y += 7)
    {
      for (const double part : { 0.05, 0.5, 0.9 })
      {
        const int x = panel.x + static_cast<int>(part * panel.width);
        EXPECT_TRUE(viewer.press(x, y, false, false));
        viewer.drag(x + 15, y + 3);
        viewer.release();
        viewer.tiles();
      }
    }
    EXPECT_NO_THROW(const ParsedScene parsed(viewer.scene()));
    viewer.key("n");
  }
  // The line of a wipe.
  viewer.key("w");
  viewer.draft(go_on);
  const Box picture = viewer.tiles().front().box;
  EXPECT_TRUE(viewer.press(picture.x + picture.width / 2, 50, false, false));
  EXPECT_TRUE(viewer.drag(picture.x + 20, 50));
  EXPECT_TRUE(viewer.release());
  EXPECT_TRUE(viewer.press(picture.x + 20, 50, false, false));
  viewer.release();
}

TEST(Viewer, ASceneThatCannotBeLeavesTheOneBefore)
{
  Viewer viewer(ball_scene(), settings_of({ MapperKind::RayMarch }));
  viewer.resize(200, 100);
  const ordered_json before = viewer.scene();
  EXPECT_THROW(viewer.open({ { "input", "/no/such/file.nrrd" } }), Failure);
  EXPECT_EQ(viewer.scene(), before);
  EXPECT_THROW(viewer.open({ { "input", ball_file() }, { "albedo", 7 } }), Failure);
  EXPECT_EQ(viewer.scene(), before);
  finish(viewer);
  // A mapper that cannot draw the scene says so in its viewport, and the rest goes on.
  ordered_json scene = ball_scene();
  scene["blend-mode"] = "mip";
  scene["sun-direction"] = { 0.0, 0.0, 1.0 };
  EXPECT_THROW(viewer.open(scene), Failure);
}

// As `brume render` has it: surfaces in fog need no volume, and anything less is refused.
TEST(Viewer, SurfacesInFogNeedNoVolume)
{
#if defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "OpenGL's driver keeps memory, and is unloaded before anyone could tell that it is its";
#endif
  const PrivateDisplay display;
  if (!display.available())
  {
    GTEST_SKIP() << display.reason();
  }
  const std::string mesh = BRUME_TEST_OUTPUT "/view-tent.ply";
  std::ofstream(mesh) << "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
                         "property float z\nelement face 2\nproperty list uchar int vertex_indices\n"
                         "end_header\n0 0 0\n20 0 0\n10 5 15\n10 30 0\n3 0 1 2\n3 1 3 2\n";
  ordered_json scene{ { "mesh", mesh }, { "quiet", true }, { "fog-extinction", 0.005 },
    { "sun-direction", { 1.0, -1.0, 1.0 } } };
  Viewer viewer(scene, settings_of({ MapperKind::RayMarch, MapperKind::FixedPoint }));
  viewer.resize(900, 300);
  const auto expected = [&]
  {
    const ParsedScene parsed(viewer.scene());
    const VolumeScene drawn = make_volume_scene(parsed.options());
    fit_clipping_range(drawn);
    const SurfacePicture surfaces = draw_meshes(drawn);
    brume::Film film(drawn.width(), drawn.height());
    EXPECT_TRUE(drawn.fog->RenderFilm(drawn.camera, drawn.lights, film, surfaces.depth));
    return brume::Picture{ film.width, film.height, over_scene(film, drawn, surfaces) };
  };
  finish(viewer);
  const brume::Picture before = viewer.shot(0).picture;
  EXPECT_TRUE(viewer.shot(1).picture.rgb.empty()); // VTK's mappers say why instead
  EXPECT_LE(difference(before, expected()), 1e-3);
  // Whoever does something ends it within a picture.
  viewer.camera_moved();
  viewer.draft(go_on);
  EXPECT_FALSE(viewer.refine([](double done) { return done <= 0.0; }));
  EXPECT_FALSE(viewer.finished());
  EXPECT_TRUE(viewer.refine(go_on));
  // All that is pressed and keyed does something or nothing, and the fog stays.
  const Box panel = viewer.tiles().back().box;
  for (int page = 0; page < 4; ++page)
  {
    for (int y = 0; y < panel.height; y += 9)
    {
      EXPECT_TRUE(viewer.press(panel.x + panel.width / 2, y, y % 2 == 0, false));
      viewer.drag(panel.x + 20, y + 5);
      viewer.release();
      viewer.tiles();
    }
    viewer.key("n");
  }
  for (const auto& [name, meaning] : Viewer::keys())
  {
    viewer.key(name);
  }
  viewer.key("BackSpace");
  viewer.pause(false);
  viewer.reset_camera();
  finish(viewer);
  const brume::Picture thin = viewer.shot(0).picture;
  viewer.set_key("fog-extinction", 0.05);
  finish(viewer);
  EXPECT_GT(difference(thin, viewer.shot(0).picture), 0.05);
  EXPECT_LE(difference(viewer.shot(0).picture, expected()), 1e-3);
  viewer.set_key("fog-extinction", nullptr); // would leave nothing
  EXPECT_EQ(viewer.key_of_scene("fog-extinction"), 0.05);
  // To a volume and back.
  viewer.open(ball_scene());
  finish(viewer);
  viewer.open(scene);
  finish(viewer);
  scene.erase("mesh");
  EXPECT_THROW(viewer.open(scene), Failure);
}

TEST(Viewer, TilesNeverOverlap)
{
  Viewer viewer(ball_scene(), settings_of({ MapperKind::RayMarch, MapperKind::Smart }));
  for (const char* key : { "s", "w", "f", "x", "question", "question", "Tab", "1" })
  {
    viewer.key(key);
    for (const auto& size : { std::pair<int, int>(800, 600), std::pair<int, int>(300, 200) })
    {
      viewer.resize(size.first, size.second);
      viewer.draft(go_on);
      const std::vector<Tile>& tiles = viewer.tiles();
      ASSERT_FALSE(tiles.empty()) << key;
      for (std::size_t i = 0; i < tiles.size(); ++i)
      {
        EXPECT_EQ(tiles[i].bitmap.rgb.size(),
          std::size_t{ 3 } * tiles[i].bitmap.width * tiles[i].bitmap.height);
        for (std::size_t j = i + 1; j < tiles.size(); ++j)
        {
          EXPECT_FALSE(overlap(tiles[i].box, tiles[j].box)) << key;
        }
      }
    }
  }
}

TEST(Compose, PicturesKeepTheirMeanAndPlace)
{
  brume::Picture ramp{ 8, 4, {} };
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 8; ++x)
      for (int c = 0; c < 3; ++c)
        ramp.rgb.push_back(static_cast<float>(x + 10 * y + 100 * c));
  const brume::Picture large = resized(ramp, 24, 12);
  for (int y = 2; y < 10; ++y)
    for (int x = 2; x < 22; ++x)
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(large.rgb[3 * (24 * y + x) + c], (x + 0.5) / 3.0 - 0.5 + 10.0 * ((y + 0.5) / 3.0 - 0.5) + 100.0 * c,
          1e-4);
  EXPECT_EQ(resized(ramp, 8, 4).rgb, ramp.rgb);

  const brume::Bitmap black{ 6, 2, std::vector<unsigned char>(36, 0) };
  const brume::Bitmap white{ 6, 2, std::vector<unsigned char>(36, 255) };
  const brume::Bitmap both = wiped(black, white, 3);
  EXPECT_EQ(both.rgb[0], 0);
  EXPECT_EQ(both.rgb[3 * 5], 255);
}

TEST(Recording, NumbersAreNotTakenTwice)
{
  const std::string folder = BRUME_TEST_OUTPUT;
  const std::string first = free_name(folder, "view-number", ".png");
  std::ofstream(first) << "x";
  EXPECT_NE(free_name(folder, "view-number", ".png"), first);
  Recording one(folder, "view-recording");
  Recording two(folder, "view-recording");
  const brume::Bitmap dot{ 2, 2, std::vector<unsigned char>(12, 128) };
  one.add(dot);
  one.add(dot);
  EXPECT_TRUE(std::ifstream(one.finish() + "/0001.png").good());
  EXPECT_FALSE(std::ifstream(two.finish() + "/0000.png").good());
}
