// The window of `brume view`: VTK's, with VTK's interactor; shows what a Viewer draws.
#pragma once

#include "view_times.h"
#include "viewer.h"

#include <chrono>
#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

class vtkRenderWindow;
class vtkRenderWindowInteractor;

namespace brume::app
{

class ViewWindow
{
public:
  struct Settings
  {
    int width = 1280;
    int height = 760;
    std::string title = "Brume";
    std::string folder = "."; ///< where pictures and scenes are saved
    std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
    /// Told of each failure that the window tells its user.
    std::function<void(const std::exception&)> failed;
  };

  /// Keys that the window takes itself, for people, and what they do.
  static std::vector<std::pair<std::string, std::string>> keys();

  /// Needs a display (private_display.h). The viewer must outlive the window.
  ViewWindow(Viewer& viewer, const Settings& settings);
  ~ViewWindow();
  ViewWindow(const ViewWindow&) = delete;
  ViewWindow& operator=(const ViewWindow&) = delete;

  /// Handles events until the user closes the window, or the program is interrupted.
  void run();

  /// Draws what changed, in quick pictures, and shows it.
  void show();
  /// Refines until all pictures are as good as was asked for. Throws Failure where the program is
  /// interrupted, or a picture cannot be drawn.
  void settle();
  /// The window as it is, as a .png file.
  void save_screenshot(const std::string& path);
  /// Pictures of a full turn around the view's up, numbered, in a new folder below
  /// Settings::folder, and a video where ffmpeg is there. Returns the folder. Escape ends it early.
  std::string record_turntable(int pictures = 90);
  /// The same of all time steps.
  std::string record_series();

  /// Events of a file in the format of vtkInteractorEventRecorder.
  ///@{
  void play(const std::string& path);
  void record(const std::string& path);
  ///@}

  vtkRenderWindowInteractor* interactor() const;
  vtkRenderWindow* window() const;
  const ViewTimes& times() const;

private:
  struct Internals;
  std::unique_ptr<Internals> Internal;
};

}
