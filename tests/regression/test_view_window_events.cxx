// Events of the X server to the window of `brume view` while it draws, sent by another thread over
// a connection of its own: how soon they are heard, and what is shown then.
#include "../support/view_windows.h"
#include "../support/x_events.h"

#include "vtkCallbackCommand.h"
#include "vtkCamera.h"
#include "vtkCommand.h"
#include "vtkNew.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <mutex>
#include <thread>

using namespace brume::app;
using namespace view_windows;

namespace
{

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

double seconds_between(Clock::time_point from, Clock::time_point to)
{
  return std::chrono::duration<double>(to - from).count();
}

void sleep(double seconds)
{
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
}

/// A window, and a thread that acts on it while it runs.
class RunningWindow
{
public:
  RunningWindow(const ordered_json& scene, int width, int height, const std::string& folder = ".")
    : TheViewer(scene, settings(width, height))
    , Window(this->TheViewer, place(width, height, folder))
  {
    vtkNew<vtkCallbackCommand> ear;
    ear->SetClientData(this);
    ear->SetPassiveObserver(1); // hears what the camera's style keeps to itself
    ear->SetCallback([](vtkObject*, unsigned long event, void* self, void*)
      { static_cast<RunningWindow*>(self)->heard(event); });
    this->Window.interactor()->AddObserver(
      vtkCommand::MouseMoveEvent, ear, 10.0f); // before all others
    this->Window.window()->AddObserver(vtkCommand::EndEvent, ear);
  }

  /// Until `act`, in a thread of its own, is through and has pressed `q`.
  void run(const std::function<void(x_events::Sender&)>& act)
  {
    std::thread hand(
      [&]
      {
        x_events::Sender x(this->Window.window()->GetGenericWindowId());
        try
        {
          act(x);
        }
        catch (const std::exception& error)
        {
          this->Failure = error.what();
        }
        this->Quitting = true;
        x.key("q");
      });
    this->Window.run();
    const bool asked = this->Quitting;
    hand.join();
    EXPECT_EQ(this->Failure, "");
    EXPECT_TRUE(asked) << "the window closed by itself";
  }

  struct Frame
  {
    Clock::time_point time;
    bool draft = false;
    std::array<double, 3> camera{};
    std::string cropping; ///< of the scene
  };
  /// What is shown once `wanted` holds, or a last frame that does not fit after so many seconds.
  Frame wait_for(const std::function<bool(const Frame&)>& wanted, double seconds = 60.0)
  {
    std::unique_lock<std::mutex> lock(this->Lock);
    this->News.wait_for(lock,
      std::chrono::duration<double>(seconds),
      [&] { return this->Frames > 0 && wanted(this->Shown); });
    return this->Shown;
  }
  Clock::time_point told()
  {
    const std::lock_guard<std::mutex> lock(this->Lock);
    return this->Told;
  }
  int frames()
  {
    const std::lock_guard<std::mutex> lock(this->Lock);
    return this->Frames;
  }

  Viewer TheViewer;
  ViewWindow Window;

private:
  static Viewer::Settings settings(int width, int height)
  {
    Viewer::Settings settings;
    settings.window = { width, height };
    return settings;
  }
  static ViewWindow::Settings place(int width, int height, const std::string& folder)
  {
    ViewWindow::Settings place;
    place.width = width;
    place.height = height;
    place.folder = folder;
    return place;
  }

  void heard(unsigned long event)
  {
    const std::lock_guard<std::mutex> lock(this->Lock);
    if (event == vtkCommand::MouseMoveEvent)
    {
      this->Told = Clock::now();
      return;
    }
    ++this->Frames;
    this->Shown.time = Clock::now();
    this->Shown.draft = this->TheViewer.shot(0).state.rfind("draft", 0) == 0;
    this->TheViewer.camera()->GetPosition(this->Shown.camera.data());
    this->Shown.cropping = this->TheViewer.key_of_scene("cropping").dump();
    this->News.notify_all();
  }

  std::mutex Lock;
  std::condition_variable News;
  Frame Shown;
  int Frames = 0;
  Clock::time_point Told;
  std::atomic<bool> Quitting{ false };
  std::string Failure;
};

/// A shell script that is found in place of a program of that name.
class FakeProgram
{
public:
  FakeProgram(const std::string& folder, const std::string& name, const std::string& script)
    : Path(std::getenv("PATH"))
  {
    fs::create_directories(folder);
    const fs::path file = fs::absolute(folder) / name;
    std::ofstream(file) << "#!/bin/sh\n" << script << "\n";
    fs::permissions(file, fs::perms::owner_all);
    setenv("PATH", (file.parent_path().string() + ":" + this->Path).c_str(), 1);
  }
  ~FakeProgram() { setenv("PATH", this->Path.c_str(), 1); }
  FakeProgram(const FakeProgram&) = delete;
  FakeProgram& operator=(const FakeProgram&) = delete;

private:
  std::string Path;
};

/// Thick matter in the sun: a whole picture of 640² takes many seconds.
ordered_json slow_scene()
{
  return { { "input", "sample:cloud" },
    { "quiet", true },
    { "extinction", 0.05 },
    { "sun-direction", { -1, -0.4, 0.6 } } };
}

ordered_json quick_scene()
{
  return { { "input", ball_file(BRUME_TEST_OUTPUT "/view-window-events.nrrd") },
    { "quiet", true },
    { "preset", "grey" },
    { "tolerance", 0.05 } };
}

std::string figures(std::vector<double> seconds)
{
  if (seconds.empty())
  {
    return "none";
  }
  std::sort(seconds.begin(), seconds.end());
  char text[100];
  std::snprintf(text,
    sizeof text,
    "median %.1f ms, largest %.1f ms",
    1e3 * seconds[seconds.size() / 2],
    1e3 * seconds.back());
  return text;
}

// Machines that do other things, too, take their time; what hangs takes seconds.
constexpr double soon = 2.0;

}

TEST(ViewWindowEvents, ARefinementEndsWhenTheMouseMoves)
{
  RunningWindow running(slow_scene(), 900, 664);
  constexpr int trials = 12;
  std::vector<double> to_end;
  std::vector<double> to_draft;
  running.run(
    [&](x_events::Sender& x)
    {
      RunningWindow::Frame before = running.wait_for([](const auto&) { return true; });
      x.press(1, 300, 300);
      for (int i = 0; i < trials; ++i)
      {
        sleep(0.3 + 0.05 * i); // the refinement is under way
        const Clock::time_point sent = Clock::now();
        x.move(300 + 4 * i + 4, 300 + 2 * i);
        const RunningWindow::Frame after = running.wait_for([&](const auto& frame)
          { return frame.time > sent && frame.camera != before.camera; },
          5.0 * soon);
        ASSERT_NE(after.camera, before.camera) << "no picture of the new camera";
        EXPECT_TRUE(after.draft);
        to_end.push_back(seconds_between(sent, running.told()));
        to_draft.push_back(seconds_between(sent, after.time));
        before = after;
      }
      x.release(1, 300, 300);
    });
  const ViewTimes& times = running.Window.times();
  // Else nothing was refined when the mouse moved, and nothing is tested.
  EXPECT_GE(times.interruptions.size(), trials / 2u);
  std::cout << "from a move to the refinement's end: " << figures(to_end)
            << "\nfrom a move to its draft on the window: " << figures(to_draft)
            << "\nfrom a look that found it to the end: " << figures(times.interruptions)
            << "\nlongest without a look, of each refinement: " << figures(times.longest_deaf)
            << '\n';
  EXPECT_LT(*std::max_element(to_end.begin(), to_end.end()), soon);
  EXPECT_LT(*std::max_element(to_draft.begin(), to_draft.end()), soon);
}

TEST(ViewWindowEvents, AQuickHandIsNotFollowedLate)
{
  RunningWindow running(slow_scene(), 660, 424);
  constexpr int moves = 150;
  double late = 0.0;
  int pictures = 0;
  running.run(
    [&](x_events::Sender& x)
    {
      running.wait_for([](const auto&) { return true; });
      x.press(1, 200, 200);
      const int before = running.frames();
      Clock::time_point sent;
      for (int i = 0; i < moves; ++i)
      {
        sleep(0.008); // 125 moves a second, as mice have them
        sent = Clock::now();
        x.move(200 + i, 200 + i / 3);
      }
      // The camera rests where the last move has left it.
      RunningWindow::Frame last =
        running.wait_for([&](const auto& frame) { return frame.time > sent; });
      for (;;)
      {
        const RunningWindow::Frame next =
          running.wait_for([&](const auto& frame) { return frame.camera != last.camera; }, 0.5);
        if (next.camera == last.camera)
        {
          break;
        }
        last = next;
      }
      late = seconds_between(sent, last.time);
      pictures = running.frames() - before;
      x.release(1, 200, 200);
    });
  std::cout << moves << " moves in " << 8e-3 * moves << " s made " << pictures
            << " pictures; the last was " << 1e3 * late << " ms after its move\n";
  EXPECT_GT(pictures, 3) << "the window stood still";
  EXPECT_LT(late, soon);
}

TEST(ViewWindowEvents, APictureFollowsTheBoxThatIsDragged)
{
  RunningWindow running(quick_scene(), 660, 424);
  int followed = 0;
  running.run(
    [&](x_events::Sender& x)
    {
      running.wait_for([](const auto&) { return true; });
      x.key("c");
      sleep(0.5);
      x.move(200, 200); // the middle of the picture: the handle of the face toward the eye
      x.press(1, 200, 200);
      std::string before = "null";
      for (int i = 1; i <= 10; ++i)
      {
        x.move(200 + 3 * i, 200 + 2 * i);
        const RunningWindow::Frame after =
          running.wait_for([&](const auto& frame) { return frame.cropping != before; }, soon);
        followed += after.cropping != before;
        before = after.cropping;
      }
      x.release(1, 230, 220);
    });
  EXPECT_GE(followed, 8) << "pictures came when the button was up, or the box was not dragged";
}

TEST(ViewWindowEvents, ASizeIsTakenWhileItRefines)
{
  RunningWindow running(slow_scene(), 900, 664);
  running.run(
    [&](x_events::Sender& x)
    {
      running.wait_for([](const auto&) { return true; });
      sleep(0.4);
      const Clock::time_point sent = Clock::now();
      x.resize(640, 420);
      running.wait_for([&](const auto& frame) { return frame.time > sent; });
      sleep(0.5);
    });
  int right = 0;
  int bottom = 0;
  for (const Tile& tile : running.TheViewer.tiles())
  {
    right = std::max(right, tile.box.x + tile.box.width);
    bottom = std::max(bottom, tile.box.y + tile.box.height);
  }
  EXPECT_EQ(right, 640);
  EXPECT_EQ(bottom, 420);
}

TEST(ViewWindowEvents, EscapeEndsATurntableAndNotTheWindow)
{
  const std::string folder = BRUME_TEST_OUTPUT "/view-window-turntable";
  fs::remove_all(folder);
  fs::create_directories(folder);
  const FakeProgram video(folder + "/bin", "ffmpeg", "touch " + folder + "/begun; i=0; while [ ! -e " + folder + "/go ] && [ $((i+=1)) -lt 600 ]; do sleep 0.1; done");
  RunningWindow running(quick_scene(), 660, 424, folder);
  const auto pictures = [&]
  {
    std::size_t count = 0;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
    {
      count += entry.path().extension() == ".png";
    }
    return count;
  };
  running.run(
    [&](x_events::Sender& x)
    {
      running.wait_for([](const auto&) { return true; });
      x.key("F4");
      for (int i = 0; i < 3000 && pictures() < 2; ++i)
      {
        sleep(0.01);
      }
      x.key("Escape");
      for (int i = 0; i < 3000 && !fs::exists(folder + "/begun"); ++i)
      {
        sleep(0.01);
      }
      x.key("Escape"); // of a hand that has not seen yet that it is over
      x.key("Escape");
      std::ofstream(folder + "/go") << "\n";
      sleep(1.5);
    });
  EXPECT_TRUE(fs::exists(folder + "/begun"));
  EXPECT_GE(pictures(), 2u);
  EXPECT_LT(pictures(), 90u);
}

// Also in the middle of a picture that would take minutes.
TEST(ViewWindowEvents, EscapeEndsATurntableWithinAPicture)
{
  const std::string folder = BRUME_TEST_OUTPUT "/view-window-long-turntable";
  fs::remove_all(folder);
  fs::create_directories(folder);
  ordered_json scene = slow_scene();
  scene["tolerance"] = 1e-4;
  RunningWindow running(scene, 660, 424, folder);
  running.TheViewer.key("p"); // path tracing
  Clock::time_point pressed;
  running.run(
    [&](x_events::Sender& x)
    {
      running.wait_for([](const auto&) { return true; });
      x.key("F4");
      sleep(3.0);
      pressed = Clock::now();
      x.key("Escape");
      sleep(0.3);
    });
  EXPECT_LT(seconds_between(pressed, Clock::now()), 0.3 + soon);
  ASSERT_FALSE(fs::is_empty(folder)) << "the turntable was not begun";
  for (const auto& entry : fs::recursive_directory_iterator(folder))
  {
    EXPECT_NE(entry.path().extension(), ".png") << "a picture that is not whole was kept";
  }
}
