// What the parts of ViewWindow share: view_window.cxx opens the window and takes VTK's events,
// view_window_pictures.cxx shows and refines pictures, view_window_keys.cxx has the window's own
// keys, view_window_records.cxx writes screenshots, turntables and series.
#pragma once

#include "view_window.h"

#include "cutting_tools.h"
#include "view_style.h"
#include "window_tiles.h"

#include "Analysis/picture.h"

#include "vtkCallbackCommand.h"
#include "vtkInteractorEventRecorder.h"
#include "vtkNew.h"
#include "vtkRenderWindow.h"
#include "vtkRenderWindowInteractor.h"
#include "vtkRenderer.h"

#include <chrono>
#include <exception>
#include <functional>
#include <optional>
#include <string>

namespace brume::app
{

struct ViewWindow::Internals
{
  Internals(Viewer& viewer, const Settings& settings);

  Viewer& View;
  Settings Set;
  vtkNew<vtkRenderWindow> Window;
  vtkNew<vtkRenderWindowInteractor> Interactor;
  vtkNew<ViewStyle> Style;
  vtkNew<vtkCallbackCommand> Ear;
  vtkNew<vtkCallbackCommand> DropEar;
  vtkNew<vtkInteractorEventRecorder> Recorder;
  vtkNew<vtkInteractorEventRecorder> Player;
  vtkNew<vtkRenderer> Page; ///< what no tile covers
  WindowTiles Tiles;
  CuttingTools Tools;
  std::optional<std::size_t> OwnPlane; ///< which of the scene's planes is the tool's
  ViewTimes Times;
  UnansweredEvent Event;
  std::chrono::steady_clock::time_point LastFlick = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point LastTold = LastFlick;
  std::chrono::steady_clock::time_point LastAnswer = LastFlick;
  vtkMTimeType CameraTime = 0;
  int Timer = -1;
  bool Resting = false; ///< the timer's pace
  bool Presenting = false;

  /// What failed is told in the window; it goes on.
  template <class Work>
  void try_to(const Work& work)
  {
    try
    {
      work();
    }
    catch (const std::exception& error)
    {
      this->View.say(error.what());
      if (this->Set.failed)
      {
        this->Set.failed(error);
      }
    }
  }

  // Events
  void observe();
  void on_event(unsigned long event, void* call);
  void set_plane(const CuttingTools::Plane& plane);
  void open(const std::string& path);
  bool input_waits();

  // Pictures
  /// Something may have changed: soon there is a picture of it.
  void want_picture(bool always = true);
  void show(bool always = true);
  /// `always`: draws the window though no tile is another, as the cutting tools may be.
  void present(bool always = true);
  void set_timer(bool resting);
  void start_timer() { this->set_timer(false); }
  bool flickers() const;
  void on_timer();
  /// One better picture, unless the program is interrupted or `ends` says so, which is asked every
  /// few milliseconds; `task`: what is told to be under way. Whether there was one.
  bool refine_once(const std::function<bool()>& ends, const std::string& task = "refining");
  /// Refines all, also what is paused, whatever the user does but Ctrl-C, or until `ends` says so.
  /// False where it did. Throws Failure where a picture cannot be drawn.
  bool settle(const std::function<bool()>& ends = {}, const std::string& task = "refining");

  // Keys
  void key(const std::string& symbol, bool control);

  // Records
  void save_screenshot(const std::string& path);
  /// Shows what `step` sets, for each of its numbers below `count`, whole, and adds it to the recording;
  /// Escape ends that, and not the window, too. Returns the recording's folder.
  std::string record(const std::string& name, int count, const std::function<void(int)>& step);
  /// The pictures alone, without captions and panel.
  Bitmap pictures();
  std::string turntable(int pictures);
  std::string series();
};

}
