// The panel of `brume view`: that all of it can be reached, and what its colours, lobes and points
// set.
#include "panel_support.h"

#include "private_display.h"

#include "view/controls.h"
#include "view/cutting_tools.h"
#include "view/side_panel.h"
#include "view/tint.h"
#include "view/transfer_editor.h"

#include "vtkGenericRenderWindowInteractor.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkVolumeProperty.h"

#include <algorithm>
#include <map>
#include <random>
#include <set>

TEST(Tint, IsTheColourAgain)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<double> part(0.0, 1.0);
  for (int i = 0; i < 2000; ++i)
  {
    const Tint tint{ 0.999 * part(random), 0.01 + 0.99 * part(random), 0.01 + 20.0 * part(random) };
    const Tint again = tint_of(colour_of(tint));
    EXPECT_NEAR(again.hue, tint.hue, 1e-9);
    EXPECT_NEAR(again.saturation, tint.saturation, 1e-9);
    EXPECT_NEAR(again.brightness, tint.brightness, 1e-9);
    const Triple colour = colour_of(tint);
    EXPECT_NEAR(brightness_of(with_brightness(colour, 3.0)), 3.0, 1e-12);
    EXPECT_NEAR(tint_of(with_brightness(colour, 3.0)).hue, tint.hue, 1e-9);
  }
  EXPECT_EQ(colour_of({ 1.0 / 3.0, 1.0, 2.0 }), (Triple{ 0.0, 2.0, 0.0 }));
  EXPECT_EQ(colour_of({ 0.7, 0.0, 0.5 }), (Triple{ 0.5, 0.5, 0.5 }));
  EXPECT_EQ(tint_of({ 0.0, 0.0, 0.0 }).brightness, 0.0);
  EXPECT_EQ(with_brightness({ 0.0, 0.0, 0.0 }, 0.5), (Triple{ 0.5, 0.5, 0.5 }));
}

// On every page, in every window that has a panel: nothing overlaps, and by scrolling each control
// comes to stand where all of it can be seen and pressed.
TEST(Panel, AllOfItIsReachedAndNothingOverlaps)
{
  const std::pair<int, int> sizes[] = { { 800, 600 }, { 800, 300 }, { 2560, 1440 } };
  Viewer viewer(rich_scene(), settings_of({ MapperKind::RayMarch }));
  for (const double scale : { 1.0, 2.0 })
    for (const auto& size : sizes)
      for (const int picker : { -2, index_of("sun irradiance"), index_of("fog albedo") })
        for (const ControlPage page :
          { ControlPage::Light, ControlPage::Matter, ControlPage::Look })
        {
          if (picker >= 0 && controls()[static_cast<std::size_t>(picker)].page != page)
          {
            continue;
          }
          const Metrics metrics(scale);
          const Box box = lay_out(size.first, size.second, metrics, 1, true).panel;
          ASSERT_FALSE(box.empty());
          PanelModel model;
          model.page = page;
          model.scene.options = &viewer.volume_scene().options;
          model.hint =
            "what was done, in more words than there is room for in one line of the panel";
          if (picker >= 0)
          {
            model.picker = picker;
          }
          std::set<int> reached;
          std::set<int> swatches;
          bool picked = false;
          const int step = size.second < 400 ? metrics.margin : 3 * metrics.line;
          for (model.scroll = 0;; model.scroll += step)
          {
            const DrawnPanel drawn = draw_panel(model, box.width, box.height, metrics);
            for (std::size_t i = 0; i < drawn.spots.size(); ++i)
            {
              const HotSpot& spot = drawn.spots[i];
              ASSERT_TRUE(spot.shown.x >= 0 && spot.shown.y >= 0);
              ASSERT_LE(spot.shown.x + spot.shown.width, box.width);
              ASSERT_LE(spot.shown.y + spot.shown.height, box.height);
              for (std::size_t j = i + 1; j < drawn.spots.size(); ++j)
              {
                ASSERT_FALSE(overlap(spot.shown, drawn.spots[j].shown)) << int(spot.kind);
              }
              const bool whole = spot.shown.height == spot.box.height;
              if (whole && spot.kind == HotSpot::Kind::Control)
              {
                reached.insert(spot.index);
              }
              else if (whole && spot.kind == HotSpot::Kind::Swatch)
              {
                swatches.insert(spot.index);
              }
              picked =
                picked || (whole && spot.kind == HotSpot::Kind::Picker && spot.index == picker);
            }
            EXPECT_EQ(drawn.track.empty(), drawn.most == 0);
            if (model.scroll >= drawn.most)
            {
              EXPECT_EQ(drawn.scroll, drawn.most);
              break;
            }
            EXPECT_EQ(drawn.scroll_at(drawn.track.y - 99), 0);
            EXPECT_EQ(drawn.scroll_at(drawn.track.y + drawn.track.height), drawn.most);
            EXPECT_NEAR(drawn.scroll_at(drawn.thumb.y),
              model.scroll,
              1.0 + double(drawn.most) / (drawn.track.height - drawn.thumb.height));
          }
          for (std::size_t i = 0; i < controls().size(); ++i)
          {
            const Control& control = controls()[i];
            const bool here = control.page == page && control.inapplicable(model.scene).empty();
            EXPECT_EQ(reached.count(static_cast<int>(i)), here ? 1u : 0u)
              << control.name << " at " << size.first << " x " << size.second << ", " << scale;
            EXPECT_EQ(swatches.count(static_cast<int>(i)), here && control.colour ? 1u : 0u)
              << control.name;
          }
          EXPECT_EQ(picked, picker >= 0);
        }
}

TEST(Panel, ThePlanTellsAllReasonsWhole)
{
  const Metrics metrics(2.0);
  const Box box = lay_out(800, 600, metrics, 1, true).panel;
  Viewer viewer(ball_scene(), settings_of({ MapperKind::RayMarch }));
  Shot shot;
  PanelModel model;
  model.page = ControlPage::Plan;
  model.scene.options = &viewer.volume_scene().options;
  model.shot = &shot;
  const auto height_of = [&](const std::string& reason)
  {
    shot.effects.assign(1, {});
    shot.effects[0].name = "first";
    shot.effects[0].reason = reason;
    return draw_panel(model, box.width, box.height, metrics).spots.front().box.height;
  };
  EXPECT_GE(
    height_of("optical depth along the view is at most 170: without it pixels could change by 220"),
    height_of("few words") + metrics.line);
  shot.effects.resize(18);
  std::set<std::string> seen;
  for (std::size_t i = 0; i < shot.effects.size(); ++i)
  {
    shot.effects[i].name = "effect " + std::to_string(i);
    shot.effects[i].reason =
      "optical depth along the view is at most 170: without it pixels could change";
  }
  for (model.scroll = 0;; model.scroll += 2 * metrics.line)
  {
    const DrawnPanel drawn = draw_panel(model, box.width, box.height, metrics);
    for (const HotSpot& spot : drawn.spots)
    {
      if (spot.kind == HotSpot::Kind::Effect && spot.shown.height == spot.box.height)
      {
        seen.insert(spot.name);
      }
    }
    if (model.scroll >= drawn.most)
    {
      break;
    }
  }
  EXPECT_EQ(seen.size(), 18u);
}

// What is scrolled out of sight is not seen through tabs and hint.
TEST(Panel, TabsAndHintStayWhenThePageIsScrolled)
{
  const Metrics metrics(2.0);
  const Box box = lay_out(800, 600, metrics, 1, true).panel;
  Viewer viewer(rich_scene(), settings_of({ MapperKind::RayMarch }));
  PanelModel model;
  model.page = ControlPage::Matter;
  model.scene.options = &viewer.volume_scene().options;
  model.hint = "hint";
  const DrawnPanel first = draw_panel(model, box.width, box.height, metrics);
  ASSERT_GT(first.most, 100);
  model.scroll = 77;
  const DrawnPanel second = draw_panel(model, box.width, box.height, metrics);
  const auto row = [&](const DrawnPanel& drawn, int y)
  {
    const auto begin = drawn.bitmap.rgb.begin() +
                       static_cast<std::ptrdiff_t>(
                         std::size_t{ 3 } * drawn.bitmap.width * (drawn.bitmap.height - 1 - y));
    return std::vector<unsigned char>(begin, begin + 3 * drawn.bitmap.width);
  };
  int differ = 0;
  for (int y = 0; y < box.height; ++y)
  {
    const bool inside = y >= first.page.y && y < first.page.y + first.page.height;
    const bool same = row(first, y) == row(second, y);
    EXPECT_TRUE(inside || same) << y;
    differ += !same;
  }
  EXPECT_GT(differ, first.page.height / 2);
}

TEST(Panel, WheelAndBarScrollIt)
{
  Viewer::Settings settings = settings_of({ MapperKind::RayMarch });
  settings.scale = 2.0;
  Viewer viewer(rich_scene(), settings);
  viewer.resize(800, 600);
  show_page(viewer, ControlPage::Matter);
  const Box panel = viewer.tiles().back().box;
  EXPECT_FALSE(viewer.wheel(10, 10, -1)); // the camera's
  EXPECT_EQ(viewer.panel().scroll, 0);
  ASSERT_GT(viewer.panel().most, 0);
  EXPECT_TRUE(viewer.wheel(panel.x + 10, 300, -1));
  viewer.tiles();
  const int once = viewer.panel().scroll;
  EXPECT_GT(once, 0);
  EXPECT_TRUE(viewer.wheel(panel.x + 10, 300, -1000));
  viewer.tiles();
  EXPECT_EQ(viewer.panel().scroll, viewer.panel().most);
  // The last control, which did not fit, is turned where it stands now.
  EXPECT_TRUE(viewer.key_of_scene("fog-base-height").is_null());
  click(viewer, place_of_spot(viewer, HotSpot::Kind::Control, index_of("fog base height"), 1.0));
  EXPECT_GT(viewer.key_of_scene("fog-base-height").get<double>(), 20.0);
  // The bar, from its end to its beginning; the hand may leave it.
  const Box thumb = viewer.panel().thumb;
  const int x = panel.x + thumb.x + thumb.width / 2;
  EXPECT_TRUE(viewer.press(x, thumb.y + thumb.height - 2, false, false));
  viewer.tiles();
  EXPECT_EQ(viewer.panel().scroll, viewer.panel().most); // a press alone moves nothing
  EXPECT_TRUE(viewer.drag(x - 300, -500));
  viewer.release();
  viewer.tiles();
  EXPECT_EQ(viewer.panel().scroll, 0);
  // Wherever the thumb is taken, it does not jump.
  viewer.wheel(panel.x + 10, 300, -2);
  viewer.tiles();
  const int between = viewer.panel().scroll;
  ASSERT_TRUE(between > 0 && between < viewer.panel().most);
  const Box now = viewer.panel().thumb;
  EXPECT_TRUE(viewer.press(x, now.y + now.height - 2, false, false));
  viewer.release();
  viewer.tiles();
  EXPECT_NEAR(viewer.panel().scroll, between, 4);
  viewer.wheel(panel.x + 10, 300, 1000);
  viewer.tiles();
  // Another page begins at its top, and this one stays.
  viewer.wheel(panel.x + 10, 300, -1);
  show_page(viewer, ControlPage::Light);
  EXPECT_EQ(viewer.panel().scroll, 0);
  show_page(viewer, ControlPage::Matter);
  EXPECT_EQ(viewer.panel().scroll, once);
}

// One idiom for all colours: a swatch shows a picker, which sets hue and saturation and leaves the
// brightness; what is saved draws the same.
TEST(Panel, EveryColourIsPickedTheSameWay)
{
  for (std::size_t i = 0; i < controls().size(); ++i)
  {
    const Control& control = controls()[i];
    if (!control.colour)
    {
      continue;
    }
    SCOPED_TRACE(control.name);
    Viewer viewer(rich_scene(), settings_of({ MapperKind::RayMarch }));
    viewer.resize(420, 400);
    const int index = static_cast<int>(i);
    show_page(viewer, control.page);
    const auto colour = [&]
    {
      ControlScene scene;
      scene.options = &viewer.volume_scene().options;
      return control.colour(scene);
    };
    click(viewer, scrolled_to(viewer, HotSpot::Kind::Swatch, index));
    const Place picker = place_of_spot(viewer, HotSpot::Kind::Picker, index, 0.6, 0.25);
    ASSERT_GE(picker.x, 0);
    EXPECT_LT(picker.y, 400); // it was scrolled to
    const double before = brightness_of(colour());
    click(viewer, picker);
    const Tint tint = tint_of(colour());
    if (control.name == std::string("background")) // black has no hue: the bar first
    {
      click(viewer, place_of_spot(viewer, HotSpot::Kind::Control, index, 0.5));
      click(viewer, picker);
    }
    const Tint now = tint_of(colour());
    EXPECT_NEAR(now.hue, 0.6, 0.02);
    EXPECT_NEAR(now.saturation, 0.75, 0.03);
    EXPECT_GT(now.brightness, 0.0);
    if (before > 0.0)
    {
      EXPECT_NEAR(tint.brightness, before, 1e-9);
    }
    // The hue is not lost when the brightness is dragged to nothing and back.
    const Place low = scrolled_to(viewer, HotSpot::Kind::Control, index, 0.0);
    const Place half = place_of_spot(viewer, HotSpot::Kind::Control, index, 0.5);
    EXPECT_TRUE(viewer.press(half.x, half.y, false, false));
    viewer.drag(low.x - 50, low.y);
    EXPECT_LE(brightness_of(colour()), 0.0);
    viewer.drag(half.x, half.y);
    viewer.release();
    EXPECT_NEAR(tint_of(colour()).hue, 0.6, 0.02);
    finish(viewer);
    EXPECT_LE(difference(viewer.shot(0).picture, rendered(viewer.scene())), 0.004);
    // A right click brings back what was.
    click(viewer, scrolled_to(viewer, HotSpot::Kind::Control, index), true);
    EXPECT_EQ(viewer.key_of_scene(control.keys.front()),
      rich_scene().value(control.keys.front(), ordered_json()));
    // The swatch hides its picker.
    click(viewer, scrolled_to(viewer, HotSpot::Kind::Swatch, index));
    EXPECT_LT(place_of_spot(viewer, HotSpot::Kind::Picker, index).x, 0);
  }
}

TEST(Controls, TwoLobesAreOnePhaseFunction)
{
  ordered_json keys{ { "input", "sample:cloud" }, { "extinction", 0.1 }, { "anisotropy", 0.6 } };
  const auto turn = [&](const char* name, double value)
  {
    const ParsedScene parsed(keys);
    ControlScene scene;
    scene.options = &parsed.options();
    const Control& control = controls()[static_cast<std::size_t>(index_of(name))];
    ASSERT_EQ(control.inapplicable(scene), "");
    control.set(keys, scene, value);
    const ParsedScene after(keys);
    ControlScene then;
    then.options = &after.options();
    EXPECT_NEAR(control.get(then).value_or(0.0), value, 1e-12);
  };
  const auto lobes = [&] { return lobes_of(ParsedScene(keys).options().medium); };
  turn("second lobe", 0.25);
  ASSERT_EQ(lobes().size(), 2u);
  EXPECT_FALSE(keys.contains("anisotropy"));
  EXPECT_EQ(lobes()[0].anisotropy, 0.6);
  EXPECT_NEAR(lobes()[0].weight, 0.75, 1e-12);
  turn("its anisotropy", -0.4);
  turn("anisotropy", 0.9);
  EXPECT_EQ(lobes()[1].anisotropy, -0.4);
  EXPECT_NEAR(lobes()[1].weight, 0.25, 1e-12);
  turn("second lobe", 0.5);
  turn("second lobe", 0.0);
  EXPECT_EQ(keys["anisotropy"], 0.9);
  EXPECT_FALSE(keys.contains("lobes"));
  // Those of a file's words stay what they are; a third lobe keeps its part of what is left.
  keys.erase("anisotropy");
  keys["phase"] = "rayleigh:2,schlick:0.5:1,isotropic:1";
  turn("second lobe", 0.5);
  ASSERT_EQ(lobes().size(), 3u);
  EXPECT_EQ(lobes()[0].function, LobeChoice::Function::Rayleigh);
  EXPECT_EQ(lobes()[1].function, LobeChoice::Function::Schlick);
  EXPECT_NEAR(lobes()[0].weight / lobes()[2].weight, 2.0, 1e-12);
  turn("its anisotropy", 0.7);
  EXPECT_EQ(lobes()[1].function, LobeChoice::Function::Schlick);
  turn("anisotropy", 0.3); // Rayleigh's has no direction to turn
  EXPECT_EQ(lobes()[0].function, LobeChoice::Function::HenyeyGreenstein);
}

TEST(Controls, TermsOfShadingAreThePresetsUntilTheyAreDragged)
{
  ordered_json scene = ball_scene();
  scene["preset"] = "mr-default"; // shaded
  scene["tolerance"] = 0.05;
  Viewer::Settings settings = settings_of({ MapperKind::RayMarch });
  settings.window = { 450, 700 };
  Viewer viewer(scene, settings);
  show_page(viewer, ControlPage::Look);
  const auto terms = [&]
  {
    vtkVolumeProperty* const property = viewer.volume_scene().volume->GetProperty();
    return std::map<std::string, double>{ { "ambient", property->GetAmbient() },
      { "diffuse", property->GetDiffuse() },
      { "specular", property->GetSpecular() },
      { "specular-power", property->GetSpecularPower() } };
  };
  finish(viewer);
  const brume::Picture first = viewer.shot(0).picture;
  const std::map<std::string, double> presets = terms();
  ControlScene any;
  for (const char* name : { "ambient", "diffuse", "specular", "specular power" })
  {
    SCOPED_TRACE(name);
    const int index = index_of(name);
    const Control& control = controls()[static_cast<std::size_t>(index)];
    const std::string& key = control.keys.front();
    const Place bar = scrolled_to(viewer, HotSpot::Kind::Control, index, 0.95);
    click(viewer, bar);
    std::map<std::string, double> expected = presets;
    expected[key] = viewer.key_of_scene(key).get<double>();
    EXPECT_NEAR(place_of(control, any, expected[key]), 0.95, 0.01);
    EXPECT_EQ(terms(), expected); // this one, and none besides
    finish(viewer);
    EXPECT_GT(difference(first, viewer.shot(0).picture), 0.01);
    EXPECT_LE(difference(viewer.shot(0).picture, rendered(viewer.scene())), 0.004);
    click(viewer, bar, true);
    EXPECT_EQ(terms(), presets);
    finish(viewer);
    EXPECT_LE(difference(first, viewer.shot(0).picture), 1e-6);
  }
  viewer.set_key("specular", 1.0);
  click(viewer, place_of_spot(viewer, HotSpot::Kind::Preset, 1));
  EXPECT_TRUE(viewer.key_of_scene("specular").is_null()) << "a preset is taken whole";
  for (const auto& [key, value] :
    { std::pair("shade", "off"), std::pair("shade", "on"), std::pair("blend-mode", "mip") })
  {
    viewer.set_key(key, value);
    const bool shaded = std::string(value) == "on";
    EXPECT_EQ(
      place_of_spot(viewer, HotSpot::Kind::Control, index_of("specular")).x >= 0, shaded);
  }
}

TEST(Viewer, ColoursOfTheTransferFunctionAreDragged)
{
  Viewer viewer(ball_scene(), settings_of({ MapperKind::RayMarch }));
  viewer.resize(700, 500);
  show_page(viewer, ControlPage::Look);
  const std::size_t first = function_of(viewer.volume_scene().volume->GetProperty()).colour.size();
  const auto at = [&](double across)
  { return place_of_spot(viewer, HotSpot::Kind::Colours, 0, across); };
  const auto colour = [&](std::size_t i) { return viewer.key_of_scene("colour").at(i); };
  // A new point has the colour that was there: the picture stays.
  finish(viewer);
  const brume::Picture before = viewer.shot(0).picture;
  click(viewer, at(0.55), false, true);
  ASSERT_EQ(viewer.key_of_scene("colour").size(), first + 1);
  finish(viewer);
  EXPECT_LE(difference(before, viewer.shot(0).picture), 0.004);
  std::size_t mine = 0; // the values end at 205
  while (mine < first && std::abs(colour(mine)[0].get<double>() - 0.55 * 205.0) > 2.0)
  {
    ++mine;
  }
  const double value = colour(mine)[0];
  EXPECT_NEAR(value, 0.55 * 205.0, 2.0);
  // It is chosen: its picker is there, and sets its colour alone.
  const Place picker =
    place_of_spot(viewer, HotSpot::Kind::Picker, HotSpot::chosen_point, 0.0, 0.0);
  ASSERT_GE(picker.x, 0);
  const ordered_json list = viewer.key_of_scene("colour");
  click(viewer, picker); // red
  EXPECT_GT(colour(mine)[1].get<double>(), 0.1);
  EXPECT_LT(colour(mine)[2].get<double>(), 1e-3);
  for (std::size_t i = 0; i < list.size(); ++i)
  {
    EXPECT_TRUE(i == mine || colour(i) == list[i]);
  }
  finish(viewer);
  EXPECT_GT(difference(before, viewer.shot(0).picture), 0.02);
  EXPECT_LE(difference(viewer.shot(0).picture, rendered(viewer.scene())), 0.004);
  // Its brightness, too.
  click(viewer, place_of_spot(viewer, HotSpot::Kind::Control, HotSpot::chosen_point, 0.5));
  EXPECT_NEAR(colour(mine)[1].get<double>(), 0.5, 0.02);
  // The mouse over it tells of it, dragged it moves, and a right click takes it out.
  const Place start = at(0.55);
  EXPECT_FALSE(viewer.drag(10, 10));
  const unsigned version = viewer.tiles().back().version;
  EXPECT_FALSE(viewer.drag(start.x, start.y));
  EXPECT_GT(viewer.tiles().back().version, version);
  EXPECT_TRUE(viewer.press(start.x, start.y, false, false));
  EXPECT_TRUE(viewer.drag(start.x + 20, start.y + 40));
  viewer.release();
  EXPECT_GT(colour(mine)[0].get<double>(), value + 5.0);
  click(viewer, { start.x + 20, start.y }, true);
  EXPECT_EQ(viewer.key_of_scene("colour").size(), first);
  EXPECT_LT(place_of_spot(viewer, HotSpot::Kind::Picker, HotSpot::chosen_point).x, 0);
  // A click beside all points chooses none.
  click(viewer, at(0.55), false, true);
  click(viewer, at(0.8));
  EXPECT_LT(place_of_spot(viewer, HotSpot::Kind::Picker, HotSpot::chosen_point).x, 0);
}

TEST(TransferEditor, ColourPointsMoveBetweenTheirNeighbours)
{
  TransferFunction function;
  function.colour = { { 0.0, 0.0, 0.0, 0.0 }, { 10.0, 1.0, 0.5, 0.0 } };
  EXPECT_EQ(add_colour_point(function, 5.0), 1);
  EXPECT_EQ(function.colour[1].red, 0.5);
  EXPECT_EQ(function.colour[1].green, 0.25);
  move_colour_point(function, 1, 99.0);
  EXPECT_GT(function.colour[1].value, 9.0);
  EXPECT_LT(function.colour[1].value, 10.0);
  EXPECT_EQ(function.colour[1].red, 0.5); // its colour goes with it
  CurveField field;
  field.box = { 0, 0, 101, 20 };
  field.upper = 10.0;
  EXPECT_EQ(colour_point_at(function, field, 2, 5), 0);
  EXPECT_EQ(colour_point_at(function, field, 50, 5), -1);
  remove_colour_point(function, 0);
  remove_colour_point(function, 0);
  remove_colour_point(function, 0);
  EXPECT_EQ(function.colour.size(), 1u);
}

// What is shown goes along with the volume, and with what was set elsewhere.
TEST(CuttingTools, FollowTheVolume)
{
  const PrivateDisplay display;
  if (!display.available())
  {
    GTEST_SKIP() << display.reason();
  }
  vtkNew<vtkRenderWindow> window;
  vtkNew<vtkRenderer> renderer;
  vtkNew<vtkGenericRenderWindowInteractor> interactor;
  window->AddRenderer(renderer);
  interactor->SetRenderWindow(window);
  interactor->EnableRenderOff();
  CuttingTools tools;
  int boxed = 0;
  std::vector<CuttingTools::Plane> planes;
  tools.Boxed = [&](const CuttingTools::Bounds&) { ++boxed; };
  tools.Planed = [&](const CuttingTools::Plane& plane) { planes.push_back(plane); };
  const CuttingTools::Bounds first{ 0, 10, 0, 20, 0, 30 };
  const CuttingTools::Bounds second{ -5, 5, 10, 40, 0, 12 };
  const CuttingTools::Bounds cut{ 1, 4, 12, 30, 2, 9 };
  tools.follow(first, first, true); // hidden: nothing
  EXPECT_FALSE(tools.box() || tools.plane());
  const auto near =
    [](const std::optional<CuttingTools::Bounds>& box, const CuttingTools::Bounds& is)
  {
    ASSERT_TRUE(box);
    for (std::size_t i = 0; i < 6; ++i)
    {
      EXPECT_NEAR((*box)[i], is[i], 1e-9);
    }
  };
  tools.switch_box(interactor, renderer, first, first);
  near(tools.box(), first);
  tools.follow(second, second, true);
  near(tools.box(), second);
  tools.follow(second, cut, true);
  near(tools.box(), cut);
  EXPECT_EQ(boxed, 0); // the hand tells, not this
  tools.switch_box(interactor, renderer, second, cut);
  EXPECT_FALSE(tools.box());

  renderer->GetActiveCamera()->SetPosition(0, -1, 0); // along y
  tools.switch_plane(interactor, renderer, first);
  ASSERT_EQ(planes.size(), 1u);
  const CuttingTools::Plane middle{ 0, 1, 0, -10 };
  EXPECT_EQ(planes[0], middle);
  const CuttingTools::Bounds wider{ -100, 10, -50, 90, 0, 3 };
  tools.follow(wider, wider, true);
  ASSERT_TRUE(tools.plane());
  for (std::size_t i = 0; i < 4; ++i)
  {
    EXPECT_NEAR((*tools.plane())[i], middle[i], 1e-9);
  }
  EXPECT_EQ(planes.size(), 1u); // it cuts as before
  const CuttingTools::Bounds beyond{ 0, 10, 30, 50, 0, 30 };
  tools.follow(beyond, beyond, true);
  ASSERT_EQ(planes.size(), 2u); // it had missed the volume
  EXPECT_NEAR(planes[1][3], -30.0, 1e-6);
  tools.follow(beyond, beyond, false); // it was taken out of the scene
  EXPECT_FALSE(tools.plane());
  tools.switch_plane(interactor, renderer, beyond);
  EXPECT_TRUE(tools.plane());
  tools.hide();
  EXPECT_FALSE(tools.plane());
}
