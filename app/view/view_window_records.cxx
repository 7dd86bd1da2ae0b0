#include "view_window_internals.h"

#include "recording.h"
#include "x_input.h"

#include "command.h"

#include "vtkCamera.h"
#include "vtkUnsignedCharArray.h"

#include <fstream>

namespace brume::app
{

namespace
{

/// Takes Escapes that came too late to end a recording, which are not to close the window.
class LateEscape
{
public:
  explicit LateEscape(vtkRenderWindow* window)
    : Window(window)
  {
  }
  ~LateEscape() { take_escape(this->Window->GetGenericDisplayId()); }
  LateEscape(const LateEscape&) = delete;
  LateEscape& operator=(const LateEscape&) = delete;

private:
  vtkRenderWindow* Window;
};

}

void ViewWindow::Internals::save_screenshot(const std::string& path)
{
  this->show();
  const int* size = this->Window->GetSize();
  vtkNew<vtkUnsignedCharArray> bytes;
  this->Window->GetPixelData(0, 0, size[0] - 1, size[1] - 1, 0, bytes);
  Bitmap bitmap{ size[0], size[1], {} };
  bitmap.rgb.assign(bytes->GetPointer(0), bytes->GetPointer(0) + bytes->GetNumberOfValues());
  save_png(bitmap, path);
}

Bitmap ViewWindow::Internals::pictures()
{
  std::vector<Tile> tiles;
  for (const Tile& tile : this->View.tiles())
  {
    if (tile.picture)
    {
      tiles.push_back(tile);
    }
  }
  return joined(tiles);
}

std::string ViewWindow::Internals::record(const std::string& name,
  int count,
  const std::function<void(int)>& step)
{
  Recording recording(this->Set.folder, name);
  bool ended = false;
  const auto escape = [&]
  {
    ended = take_escape(this->Window->GetGenericDisplayId()) || ended;
    return ended;
  };
  for (int i = 0; i < count && !escape(); ++i)
  {
    step(i);
    const std::string task =
      name + " " + std::to_string(i) + " of " + std::to_string(count) + ", Escape ends it";
    this->View.say(task);
    if (this->settle(escape, task))
    {
      recording.add(this->pictures());
    }
  }
  this->View.say(name + ": making the video");
  this->present();
  return recording.finish();
}

std::string ViewWindow::Internals::turntable(int pictures)
{
  const LateEscape late(this->Window);
  const KeptCamera kept(this->View.camera());
  return this->record("turntable",
    pictures,
    [&](int i)
    {
      if (i > 0)
      {
        this->View.camera()->Azimuth(360.0 / pictures);
        this->View.camera()->OrthogonalizeViewUp();
        this->View.camera_moved();
      }
    });
}

std::string ViewWindow::Internals::series()
{
  const int count = static_cast<int>(this->View.volume_scene().input.times.size());
  if (count < 2)
  {
    throw Failure("series", "the input has one time step", "open a series over time");
  }
  const LateEscape late(this->Window);
  KeptTimeStep kept(this->View);
  const std::string folder =
    this->record("series", count, [this](int i) { this->View.go_to_time(i); });
  kept.go_back();
  return folder;
}

void ViewWindow::save_screenshot(const std::string& path)
{
  this->Internal->save_screenshot(path);
}

std::string ViewWindow::record_turntable(int pictures)
{
  return this->Internal->turntable(pictures);
}

std::string ViewWindow::record_series()
{
  return this->Internal->series();
}

void ViewWindow::play(const std::string& path)
{
  Internals& in = *this->Internal;
  in.Player->KeyPressActivationOff();
  in.Player->SetInteractor(in.Interactor);
  in.Player->SetFileName(path.c_str());
  in.Player->Play();
}

void ViewWindow::record(const std::string& path)
{
  Internals& in = *this->Internal;
  if (!std::ofstream(path))
  {
    throw Failure(
      "--record " + path, "it cannot be written", "name a file in a folder that you may write to");
  }
  in.Recorder->KeyPressActivationOff();
  in.Recorder->SetInteractor(in.Interactor);
  in.Recorder->SetFileName(path.c_str());
  in.Recorder->EnabledOn();
  in.Recorder->Record();
}

}
