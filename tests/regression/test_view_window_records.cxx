// What the window of `brume view` writes to files is of the scene as it is, drawn with care; and
// that nothing else is another afterwards.
#include "../support/view_windows.h"

#include "scene_file.h"
#include "volume_scene.h"

#include "film_io.h"
#include "vtkBrumeRayMarchMapper.h"

#include "vtkCallbackCommand.h"
#include "vtkCamera.h"
#include "vtkCommand.h"
#include "vtkLightCollection.h"
#include "vtkNew.h"
#include "vtkVolume.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>

using namespace brume::app;
using namespace view_windows;

namespace
{

namespace fs = std::filesystem;

/// A small window whose files go to an empty folder; what fails is kept.
class RecordingWindow
{
public:
  RecordingWindow(const ordered_json& scene,
    const std::string& name,
    const std::vector<MapperKind>& mappers = { MapperKind::RayMarch })
    : Folder(std::string(BRUME_TEST_OUTPUT "/") + name)
    , TheViewer(scene, patient(mappers))
    , Window(this->TheViewer, this->place())
    , TheHand(this->Window.interactor())
  {
    this->Window.show();
  }

  std::vector<fs::path> files(const std::string& ending) const
  {
    std::vector<fs::path> found;
    for (const auto& entry : fs::recursive_directory_iterator(this->Folder))
    {
      if (entry.path().extension() == ending)
      {
        found.push_back(entry.path());
      }
    }
    return found;
  }

  std::string Folder;
  std::string Failed;
  Viewer TheViewer;
  ViewWindow Window;
  Hand TheHand;

private:
  /// Drafts are whole from the second on, however slow the machine is.
  static Viewer::Settings patient(const std::vector<MapperKind>& mappers)
  {
    Viewer::Settings settings;
    settings.mappers = mappers;
    settings.draft_seconds = 30.0;
    return settings;
  }
  ViewWindow::Settings place()
  {
    fs::remove_all(this->Folder);
    fs::create_directories(this->Folder);
    ViewWindow::Settings place;
    place.width = 460;
    place.height = 200;
    place.folder = this->Folder;
    place.failed = [this](const std::exception& error) { this->Failed += error.what(); };
    return place;
  }
};

/// A ball in the sun, thick enough for drafts to be off.
ordered_json lit_scene()
{
  return { { "input", ball_file(BRUME_TEST_OUTPUT "/view-window-records.nrrd") },
    { "quiet", true },
    { "extinction", 0.01 },
    { "sun-direction", { 1.0, -1.0, 1.0 } },
    { "tolerance", 0.004 } };
}

/// Takes the first of the series' three files away as soon as the last one is shown.
void forget_first_step(vtkObject*, unsigned long, void* viewer, void*)
{
  if (static_cast<Viewer*>(viewer)->volume_scene().input.time_step == 2)
  {
    fs::remove(BRUME_TEST_OUTPUT "/view-window-series-0.raw");
  }
}

/// Three time steps in files of their own.
ordered_json series_scene()
{
  const std::string place = BRUME_TEST_OUTPUT "/view-window-series";
  std::string names;
  for (int step = 0; step < 3; ++step)
  {
    const std::string name = "view-window-series-" + std::to_string(step) + ".raw";
    std::ofstream file(std::string(BRUME_TEST_OUTPUT "/") + name, std::ios::binary);
    for (int i = 0; i < 8 * 8 * 8; ++i)
    {
      const std::int16_t value = static_cast<std::int16_t>(100 * (step + 1) + i % 8);
      file.write(reinterpret_cast<const char*>(&value), sizeof value);
    }
    names += name + "\n";
  }
  std::ofstream(place + ".mhd") << "ObjectType = Image\nNDims = 4\nDimSize = 8 8 8 3\n"
                                   "ElementSpacing = 1 1 1 1\nElementType = MET_SHORT\n"
                                   "ElementDataFile = LIST\n"
                                << names;
  return {
    { "input", place + ".mhd" }, { "quiet", true }, { "preset", "grey" }, { "tolerance", 0.05 }
  };
}

/// Of light, between a film and what `brume render` draws of a scene.
double off_render(const brume::Film& film, const ordered_json& scene)
{
  const ParsedScene parsed(scene);
  const VolumeScene volume = make_volume_scene(parsed.options());
  vtkNew<vtkBrumeRayMarchMapper> mapper;
  set_up(volume, mapper);
  brume::Film whole(volume.width(), volume.height());
  EXPECT_TRUE(mapper->RenderFilm(volume.volume, volume.camera, volume.lights, whole));
  EXPECT_EQ(film.width, whole.width);
  EXPECT_EQ(film.height, whole.height);
  double most = 0.0;
  for (int c = 0; c < 3; ++c)
  {
    for (std::size_t i = 0; i < std::min(film.size(), whole.size()); ++i)
    {
      most = std::max(most, double(std::abs(film.radiance[c][i] - whole.radiance[c][i])));
    }
  }
  return most;
}

}

TEST(ViewWindowRecords, AnEXRIsNoDraftAndNotOfTheSceneBefore)
{
  RecordingWindow window(lit_scene(), "view-window-exr");
  Viewer& viewer = window.TheViewer;
  viewer.camera_moved();
  window.Window.show();
  ASSERT_TRUE(viewer.shot(0).whole && viewer.shot(0).draft);
  ASSERT_GT(off_render(*viewer.shot(0).film, viewer.scene()), 0.008) << "no draft to tell from it";
  window.TheHand.key("space"); // also where refinement is paused
  window.TheHand.key("F3");
  ASSERT_EQ(window.files(".exr").size(), 1u) << window.Failed;
  EXPECT_LT(off_render(brume::read_exr(window.files(".exr")[0].string()), viewer.scene()), 0.004);
  EXPECT_TRUE(viewer.paused());
  // A change that is not drawn yet.
  viewer.set_key("sun-irradiance", { 0.5, 1.0, 2.0 });
  ASSERT_TRUE(viewer.stale());
  window.TheHand.key("F3");
  std::vector<fs::path> films = window.files(".exr");
  std::sort(films.begin(), films.end());
  ASSERT_EQ(films.size(), 2u) << window.Failed;
  EXPECT_LT(off_render(brume::read_exr(films[1].string()), viewer.scene()), 0.004);
  EXPECT_EQ(window.Failed, "");
}

TEST(ViewWindowRecords, AnEXRIsNotOfASceneThatWasNotDrawn)
{
  RecordingWindow window(lit_scene(), "view-window-exr-failed");
  Viewer& viewer = window.TheViewer;
  window.TheHand.key("F3");
  ASSERT_EQ(window.files(".exr").size(), 1u) << window.Failed;
  viewer.set_key("sun-direction", nullptr);
  viewer.set_key("blend-mode", "mip"); // of densities there are no projections
  window.TheHand.key("F3");
  ASSERT_NE(viewer.failure(0), "");
  EXPECT_EQ(window.files(".exr").size(), 1u);
  EXPECT_NE(window.Failed, "");
}

// Another viewport may take minutes, and does not help.
TEST(ViewWindowRecords, AnEXRThatCannotBeIsRefusedAtOnce)
{
  RecordingWindow window({ { "input", ball_file(BRUME_TEST_OUTPUT "/view-window-records.nrrd") },
                           { "quiet", true },
                           { "preset", "grey" },
                           { "blend-mode", "mip" } },
    "view-window-exr-refused",
    { MapperKind::PathTrace, MapperKind::Smart });
  Viewer& viewer = window.TheViewer;
  while (viewer.failure(0).empty() && viewer.refine([](double) { return true; }))
  {
  }
  ASSERT_NE(viewer.failure(0), ""); // paths draw no projections
  ASSERT_FALSE(viewer.finished());
  window.TheHand.key("F3");
  EXPECT_TRUE(window.files(".exr").empty());
  EXPECT_NE(window.Failed, "");
  EXPECT_FALSE(viewer.finished());
}

TEST(ViewWindowRecords, AScreenshotIsNotOfTheSceneBefore)
{
  RecordingWindow window(lit_scene(), "view-window-screenshot");
  const brume::Bitmap before = pixels_of(window.Window.window());
  window.TheViewer.set_key("background", { 1.0, 1.0, 1.0 });
  ASSERT_TRUE(window.TheViewer.stale());
  window.Window.save_screenshot(window.Folder + "/now.png");
  EXPECT_FALSE(window.TheViewer.stale());
  EXPECT_NE(before.rgb, pixels_of(window.Window.window()).rgb);
}

TEST(ViewWindowRecords, ATurnLeavesAllAsItWas)
{
  RecordingWindow window(series_scene(), "view-window-turn");
  Viewer& viewer = window.TheViewer;
  viewer.key("space");
  const ordered_json before = viewer.scene();
  window.Window.record_turntable(3);
  EXPECT_EQ(window.files(".png").size(), 3u);
  EXPECT_TRUE(viewer.paused());
  EXPECT_EQ(viewer.scene(), before);
  viewer.pause(false);
  window.Window.record_turntable(1);
  EXPECT_FALSE(viewer.paused());
}

TEST(ViewWindowRecords, ASeriesGoesBackToItsTimeStepAlsoWhereOneIsBroken)
{
  RecordingWindow window(series_scene(), "view-window-steps");
  Viewer& viewer = window.TheViewer;
  viewer.go_to_time(1);
  viewer.key("space");
  window.TheHand.key("F6");
  EXPECT_EQ(window.files(".png").size(), 3u) << window.Failed;
  EXPECT_EQ(viewer.volume_scene().input.time_step, 1);
  EXPECT_TRUE(viewer.paused());
  fs::remove(BRUME_TEST_OUTPUT "/view-window-series-2.raw");
  window.TheHand.key("F6");
  EXPECT_NE(window.Failed, "");
  EXPECT_EQ(window.files(".png").size(), 5u);
  EXPECT_EQ(viewer.volume_scene().input.time_step, 1);
  EXPECT_TRUE(viewer.paused());
}

TEST(ViewWindowRecords, ASeriesThatCannotGoBackSaysSo)
{
  RecordingWindow window(series_scene(), "view-window-no-way-back");
  Viewer& viewer = window.TheViewer;
  // Gone once it was recorded.
  vtkNew<vtkCallbackCommand> shown;
  shown->SetClientData(&viewer);
  shown->SetCallback(forget_first_step);
  window.Window.window()->AddObserver(vtkCommand::EndEvent, shown);
  window.TheHand.key("F6");
  EXPECT_EQ(window.files(".png").size(), 3u);
  EXPECT_NE(window.Failed, "");
  EXPECT_NE(viewer.volume_scene().input.time_step, 0);
}

TEST(ViewWindowRecords, APlaneThatIsTakenOutOfTheSceneIsNotShown)
{
  RecordingWindow window(lit_scene(), "view-window-plane");
  Viewer& viewer = window.TheViewer;
  const auto frame = [&]
  {
    window.Window.settle();
    return pixels_of(window.Window.window()).rgb;
  };
  viewer.say("");
  const std::vector<unsigned char> plain = frame();
  window.TheHand.key("k");
  ASSERT_TRUE(viewer.key_of_scene("clipping-plane").is_array());
  EXPECT_NE(frame(), plain);
  window.TheHand.key("BackSpace");
  EXPECT_TRUE(viewer.key_of_scene("clipping-plane").is_null());
  window.Window.show();
  window.TheHand.key("k"); // shows it anew, and does not hide it
  EXPECT_TRUE(viewer.key_of_scene("clipping-plane").is_array());
}
