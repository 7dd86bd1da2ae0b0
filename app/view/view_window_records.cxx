#include "view_window_internals.h"

#include "recording.h"
#include "x_input.h"

#include "command.h"

#include "vtkCamera.h"
#include "vtkUnsignedCharArray.h"

#include <fstream>

namespace brume::app
{

void ViewWindow::Internals::save_screenshot(const std::string& path)
{
  this->present();
  const int* size = this->Window->GetSize();
  vtkNew<vtkUnsignedCharArray> bytes;
  this->Window->GetPixelData(0, 0, size[0] - 1, size[1] - 1, 0, bytes);
  Bitmap bitmap{ size[0], size[1], {} };
  bitmap.rgb.assign(bytes->GetPointer(0), bytes->GetPointer(0) + bytes->GetNumberOfValues());
  save_png(bitmap, path);
}

bool ViewWindow::Internals::take_escape()
{
  return brume::app::take_escape(this->Window->GetGenericDisplayId());
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

std::string ViewWindow::Internals::turntable(int pictures)
{
  Recording recording(this->Set.folder, "turntable");
  const KeptCamera kept(this->View.camera());
  for (int i = 0; i < pictures && !this->take_escape(); ++i)
  {
    this->View.say(
      "turntable: " + std::to_string(i) + " of " + std::to_string(pictures) + ", Escape ends it");
    this->settle();
    recording.add(this->pictures());
    this->View.camera()->Azimuth(360.0 / pictures);
    this->View.camera()->OrthogonalizeViewUp();
    this->View.camera_moved();
  }
  this->take_escape(); // it came too late, and is not to close the window
  return recording.finish();
}

std::string ViewWindow::Internals::series()
{
  const int count = static_cast<int>(this->View.volume_scene().input.times.size());
  if (count < 2)
  {
    throw Failure("series", "the input has one time step", "open a series over time");
  }
  const int before = this->View.volume_scene().input.time_step;
  Recording recording(this->Set.folder, "series");
  for (int i = 0; i < count && !this->take_escape(); ++i)
  {
    this->View.go_to_time(i);
    this->View.say(
      "series: " + std::to_string(i) + " of " + std::to_string(count) + ", Escape ends it");
    this->settle();
    recording.add(this->pictures());
  }
  this->View.go_to_time(before);
  this->take_escape(); // it came too late, and is not to close the window
  return recording.finish();
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
