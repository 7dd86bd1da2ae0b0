// What a hand does to the viewer of `brume view` from press to release: nothing that it did not
// mean is lost, moved or left behind.
#include "panel_support.h"

#include "film_io.h"
#include "private_display.h"

#include "view/view_style.h"

#include "vtkBrumeSky.h"

#include "vtkGenericRenderWindowInteractor.h"
#include "vtkImageData.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"

#include <algorithm>
#include <array>

namespace
{

/// Of a scene file, whatever the order of its keys.
nlohmann::json keys_of(const Viewer& viewer)
{
  return nlohmann::json(viewer.scene());
}

/// All that hangs on another control's value is there, and not as it is by default.
ordered_json dependent_scene()
{
  return { { "input", ball_file() },
    { "quiet", true },
    { "extinction", 0.002 },
    { "sun-direction", { 1.0, -1.0, 1.0 } },
    { "albedo", { 0.9, 0.8, 0.7 } },
    { "phase", "hg:0.8:0.7,hg:-0.4:0.3" },
    { "octaves", 3 },
    { "octave-attenuation", 0.6 },
    { "octave-contribution", 0.55 },
    { "octave-anisotropy", 0.3 },
    { "silver-lining", 0.5 },
    { "silver-lining-spread", 0.3 },
    { "silver-lining-back", 0.2 },
    { "powder", 0.5 },
    { "powder-scale", 3.0 },
    { "fog-extinction", 0.001 },
    { "fog-albedo", { 0.9, 0.8, 0.7 } },
    { "fog-anisotropy", 0.4 },
    { "fog-falloff", 0.01 },
    { "fog-base-height", 2.0 },
    { "tolerance", 0.05 } };
}

Viewer::Settings high_settings()
{
  Viewer::Settings settings = settings_of({ MapperKind::RayMarch });
  settings.window = { 600, 900 };
  return settings;
}

}

TEST(Hand, ABarDraggedToItsEndAndBackLosesNothing)
{
  for (const char* name :
    { "fog extinction", "silver lining", "powder", "second lobe", "octave attenuation", "octaves" })
  {
    SCOPED_TRACE(name);
    Viewer viewer(dependent_scene(), high_settings());
    show_page(viewer, ControlPage::Matter);
    const int index = index_of(name);
    const Place held = scrolled_to(viewer, HotSpot::Kind::Control, index, 0.5);
    const Place end = place_of_spot(viewer, HotSpot::Kind::Control, index, 0.0);
    ASSERT_TRUE(viewer.press(held.x, held.y, false, false));
    const nlohmann::json at_half = keys_of(viewer);
    viewer.drag(end.x - 40, end.y);
    viewer.tiles();
    EXPECT_NE(keys_of(viewer), at_half);
    EXPECT_NO_THROW(const ParsedScene parsed(viewer.scene()));
    viewer.drag(held.x, held.y);
    EXPECT_EQ(keys_of(viewer), at_half);
    // What something else changed meanwhile stays changed.
    viewer.set_key("exposure", 1.5);
    viewer.drag(held.x + 5, held.y);
    EXPECT_EQ(viewer.key_of_scene("exposure"), 1.5);
    const nlohmann::json dragged = keys_of(viewer);
    viewer.key("plus");
    viewer.drag(held.x + 5, held.y);
    EXPECT_GT(viewer.key_of_scene("exposure"), 1.5);
    viewer.set_key("exposure", 1.5);
    EXPECT_EQ(keys_of(viewer), dragged);
    viewer.release();
    // Once it was let go, the end is meant.
    viewer.press(held.x, held.y, false, false);
    viewer.drag(end.x - 40, end.y);
    viewer.release();
    viewer.press(held.x, held.y, false, false);
    viewer.release();
    EXPECT_EQ(viewer.key_of_scene("fog-albedo").is_null(), std::string(name) == "fog extinction");
  }
}

TEST(Hand, ARightClickTakesBackAllThatADragPutIn)
{
  const ordered_json plain{ { "input", ball_file() }, { "quiet", true }, { "extinction", 0.002 } };
  int turned = 0;
  for (const ordered_json& scene : { plain, dependent_scene(), ball_scene() })
  {
    for (std::size_t i = 0; i < controls().size(); ++i)
    {
      const Control& control = controls()[i];
      SCOPED_TRACE(control.name);
      Viewer viewer(scene, high_settings());
      ControlScene now;
      now.options = &viewer.volume_scene().options;
      if (!control.inapplicable(now).empty())
      {
        continue;
      }
      show_page(viewer, control.page);
      const nlohmann::json before = keys_of(viewer);
      for (const double place : { 0.9, 0.1 })
      {
        click(viewer, scrolled_to(viewer, HotSpot::Kind::Control, static_cast<int>(i), place));
        EXPECT_NE(keys_of(viewer), before);
        ++turned;
      }
      click(viewer, scrolled_to(viewer, HotSpot::Kind::Control, static_cast<int>(i)), true);
      EXPECT_EQ(keys_of(viewer), before);
    }
  }
  EXPECT_GT(turned, 80);
}

TEST(Hand, ARightClickLeavesWhatSomebodyElseSet)
{
  Viewer viewer(dependent_scene(), high_settings());
  show_page(viewer, ControlPage::Matter);
  const auto turn = [&](const char* name, double place)
  { click(viewer, scrolled_to(viewer, HotSpot::Kind::Control, index_of(name), place)); };
  const auto take_back = [&](const char* name)
  { click(viewer, scrolled_to(viewer, HotSpot::Kind::Control, index_of(name)), true); };
  // An attenuation takes a contribution that is larger along, which comes back with it.
  turn("octave contribution", 0.5);
  const ordered_json own = viewer.key_of_scene("octave-contribution");
  EXPECT_NE(own, 0.55);
  turn("octave attenuation", 0.9);
  take_back("octave attenuation");
  EXPECT_EQ(viewer.key_of_scene("octave-contribution"), own);
  turn("octave attenuation", 0.2);
  turn("octave attenuation", 0.1);
  EXPECT_LT(viewer.key_of_scene("octave-contribution").get<double>(), own.get<double>());
  take_back("octave attenuation");
  EXPECT_EQ(viewer.key_of_scene("octave-attenuation"), 0.6);
  EXPECT_EQ(viewer.key_of_scene("octave-contribution"), own);
  // Meant for itself since.
  turn("octave attenuation", 0.2);
  turn("octave contribution", 0.3);
  const ordered_json meant = viewer.key_of_scene("octave-contribution");
  take_back("octave attenuation");
  EXPECT_EQ(viewer.key_of_scene("octave-contribution"), meant);
  // The rest of what was is refused together: then both are as at first.
  turn("octave attenuation", 0.9);
  turn("octave contribution", 0.95);
  take_back("octave attenuation");
  EXPECT_EQ(viewer.key_of_scene("octave-attenuation"), 0.6);
  EXPECT_EQ(viewer.key_of_scene("octave-contribution"), 0.55);
  turn("octave attenuation", 0.2);
  take_back("octave contribution");
  EXPECT_EQ(viewer.key_of_scene("octave-attenuation"), 0.6);
  EXPECT_EQ(viewer.key_of_scene("octave-contribution"), 0.55);
  // What all controls took back is nobody's to bring again.
  click(viewer, scrolled_to(viewer, HotSpot::Kind::Control, index_of("fog extinction"), 0.0));
  EXPECT_TRUE(viewer.key_of_scene("fog-albedo").is_null());
  viewer.key("BackSpace");
  viewer.set_key("fog-albedo", nullptr);
  take_back("fog extinction");
  EXPECT_TRUE(viewer.key_of_scene("fog-albedo").is_null());
  viewer.key("BackSpace");
  // A file that is read again leaves what a bar put in that bar's to take out.
  viewer.set_key("sun-direction", nullptr);
  viewer.set_key("sky-radiance", { 0.2, 0.2, 0.2 });
  show_page(viewer, ControlPage::Light);
  turn("sun irradiance", 0.7);
  EXPECT_FALSE(viewer.key_of_scene("sun-direction").is_null());
  viewer.reload();
  take_back("sun irradiance");
  EXPECT_TRUE(viewer.key_of_scene("sun-direction").is_null());
  show_page(viewer, ControlPage::Matter);
  // A sun that the bar did not put in.
  viewer.set_key("sun-direction", nullptr);
  viewer.set_key("sun-direction", { 0.0, 0.0, 1.0 });
  show_page(viewer, ControlPage::Light);
  turn("sun irradiance", 0.7);
  take_back("sun irradiance");
  EXPECT_EQ(viewer.key_of_scene("sun-direction"), ordered_json({ 0.0, 0.0, 1.0 }));
  EXPECT_TRUE(viewer.key_of_scene("sun-irradiance").is_null());
}

TEST(Hand, TheWheelScrollsNothingThatIsHeld)
{
  Viewer::Settings settings = settings_of({ MapperKind::RayMarch });
  settings.scale = 2.0;
  settings.window = { 800, 600 };
  Viewer viewer(dependent_scene(), settings);
  show_page(viewer, ControlPage::Matter);
  const Place bar = place_of_spot(viewer, HotSpot::Kind::Control, index_of("albedo"), 0.4);
  ASSERT_TRUE(viewer.press(bar.x, bar.y, false, false));
  EXPECT_TRUE(viewer.wheel(bar.x, bar.y, -1));
  viewer.tiles();
  EXPECT_EQ(viewer.panel().scroll, 0);
  viewer.release();
  EXPECT_TRUE(viewer.wheel(bar.x, bar.y, -1));
  viewer.tiles();
  EXPECT_GT(viewer.panel().scroll, 0);
}

TEST(Hand, ARowStaysWhereItWasPressed)
{
  Viewer::Settings settings = settings_of({ MapperKind::RayMarch });
  settings.window = { 800, 500 };
  const int upper = index_of("albedo");
  const int lower = index_of("fog albedo");
  for (const bool seen : { true, false })
  {
    SCOPED_TRACE(seen);
    Viewer viewer(dependent_scene(), settings);
    show_page(viewer, ControlPage::Matter);
    click(viewer, scrolled_to(viewer, HotSpot::Kind::Swatch, upper));
    const Box panel = viewer.tiles().back().box;
    Place row = scrolled_to(viewer, HotSpot::Kind::Swatch, lower);
    if (!seen)
    {
      viewer.wheel(panel.x + 5, panel.height / 2, -1000);
      row = place_of_spot(viewer, HotSpot::Kind::Swatch, lower);
      ASSERT_LT(place_of_spot(viewer, HotSpot::Kind::Picker, upper).x, 0)
        << "it is to be out of sight";
    }
    const int scrolled = viewer.panel().scroll;
    const int height = picker_height(Metrics(settings.scale));
    click(viewer, row);
    const Place now = place_of_spot(viewer, HotSpot::Kind::Swatch, lower);
    const Place picker = place_of_spot(viewer, HotSpot::Kind::Picker, lower, 0.5, 1.0);
    ASSERT_GE(picker.x, 0);
    EXPECT_LE(picker.y, panel.height);
    if (scrolled >= height && row.y + height + Metrics(settings.scale).row <
                                viewer.panel().page.y + viewer.panel().page.height)
    {
      EXPECT_EQ(now.y, row.y);
    }
    EXPECT_LE(now.y, row.y); // up at most, where its picker needs the place
    EXPECT_GE(now.y, row.y - height);
  }
}

TEST(Hand, WhatChangesWhileADraftIsDrawnIsDrawnAgain)
{
  Viewer viewer(ball_scene(), settings_of({ MapperKind::RayMarch, MapperKind::RayMarch }));
  EXPECT_TRUE(viewer.stale());
  int shown = 0;
  viewer.draft(go_on,
    [&]
    {
      ++shown;
      viewer.set_key("background", { 1.0, 1.0, 1.0 });
    });
  EXPECT_EQ(shown, 1);
  EXPECT_TRUE(viewer.stale());
  viewer.draft([](double) { return false; });
  EXPECT_TRUE(viewer.stale()); // it was ended
  viewer.draft(go_on);
  EXPECT_FALSE(viewer.stale());
}

TEST(Hand, ASecondButtonDoesNotLeaveTheCameraTurning)
{
  const PrivateDisplay display;
  if (!display.available())
  {
    GTEST_SKIP() << display.reason();
  }
  vtkNew<vtkRenderWindow> window;
  vtkNew<vtkRenderer> renderer;
  vtkNew<vtkGenericRenderWindowInteractor> interactor;
  vtkNew<ViewStyle> style;
  window->SetSize(200, 200);
  window->AddRenderer(renderer);
  interactor->SetRenderWindow(window);
  interactor->EnableRenderOff();
  interactor->SetInteractorStyle(style);
  interactor->Initialize();
  bool takes = false;
  bool held = false;
  int presses = 0;
  style->Press = [&](int, int, bool, bool)
  {
    ++presses;
    held = takes;
    return takes;
  };
  style->Drag = [&](int, int) { return held; };
  style->Release = [&]
  {
    const bool was = held;
    held = false;
    return was;
  };
  style->Done = [] {};
  const auto press = [&](bool right, bool taken)
  {
    takes = taken;
    interactor->SetEventInformation(100, 100);
    right ? interactor->RightButtonPressEvent() : interactor->LeftButtonPressEvent();
  };
  const auto release = [&](bool right)
  { right ? interactor->RightButtonReleaseEvent() : interactor->LeftButtonReleaseEvent(); };
  // Over the picture, then over what takes the mouse.
  for (const bool right : { false, true })
  {
    press(right, false);
    EXPECT_NE(style->GetState(), VTKIS_NONE);
    press(!right, true);
    EXPECT_FALSE(held) << "the hand has the camera";
    release(right);
    EXPECT_EQ(style->GetState(), VTKIS_NONE);
    release(!right);
    EXPECT_EQ(style->GetState(), VTKIS_NONE);
    // The other way round.
    press(right, true);
    EXPECT_TRUE(held);
    presses = 0;
    for (const bool taken : { false, true })
    {
      press(!right, taken);
      interactor->MiddleButtonPressEvent();
      EXPECT_EQ(style->GetState(), VTKIS_NONE);
      interactor->MiddleButtonReleaseEvent();
      release(!right);
      EXPECT_TRUE(held) << "another button let go";
    }
    EXPECT_EQ(presses, 0);
    press(!right, false);
    release(right);
    EXPECT_FALSE(held);
    release(!right);
    EXPECT_EQ(style->GetState(), VTKIS_NONE);
    // A release that nobody told: its button is as good as new.
    press(right, true);
    press(right, true);
    EXPECT_EQ(presses, 2);
    release(right);
    // A tool that takes the mouse hears the release in its place.
    press(right, true);
    style->LetGo();
    EXPECT_FALSE(held);
    press(!right, true);
    EXPECT_TRUE(held);
    release(!right);
    press(!right, false);
    EXPECT_NE(style->GetState(), VTKIS_NONE);
    release(!right);
  }
}

// Pictures of light from all around are large: a bar that turns the light must not read them again.
TEST(Hand, TheEnvironmentIsReadOnce)
{
  const std::string path = BRUME_TEST_OUTPUT "/view-hand.hdr";
  std::vector<float> light(3 * 16 * 8, 0.1f);
  std::fill_n(light.begin() + 3 * 16 * 5, 9, 20.0f); // from a side
  brume::write_hdr(light, 16, 8, path);
  ordered_json scene = ball_scene();
  scene.erase("preset");
  scene["extinction"] = 0.002;
  scene["environment"] = path;
  scene["tolerance"] = 0.02;
  Viewer viewer(scene, high_settings());
  const auto map = [&] { return viewer.volume_scene().sky->GetEnvironmentMap(); };
  vtkImageData* const first = map();
  finish(viewer);
  const brume::Picture before = viewer.shot(0).picture;
  const int index = index_of("environment rotation");
  click(viewer, scrolled_to(viewer, HotSpot::Kind::Control, index, 0.75));
  EXPECT_NEAR(viewer.key_of_scene("environment-rotation").get<double>(), 90.0, 2.0);
  finish(viewer);
  EXPECT_GT(difference(before, viewer.shot(0).picture), 0.05);
  EXPECT_LE(difference(viewer.shot(0).picture, rendered(viewer.scene())), 0.02);
  click(viewer, scrolled_to(viewer, HotSpot::Kind::Control, index_of("sky radiance"), 0.3));
  EXPECT_EQ(map(), first);
  viewer.reload(); // it may be another
  EXPECT_NE(map(), first);
  viewer.set_key("environment", nullptr);
  EXPECT_FALSE(viewer.key_of_scene("environment").is_string());
}
