#include "view_window_internals.h"

#include "recording.h"

#include "command.h"
#include "interruption.h"

#include "vtkCamera.h"

namespace brume::app
{

namespace
{

using Clock = std::chrono::steady_clock;

constexpr unsigned long tick = 10;  ///< milliseconds between looks at what is left to do
constexpr unsigned long rest = 200; ///< the same where nothing is, for Ctrl-C
constexpr double flicker_seconds = 0.5;
constexpr double told_every = 0.25; ///< seconds between figures of progress, for each of which all is shown anew
constexpr double look_every = 2e-3; ///< seconds between looks for input, which cost some microseconds each
/// While events come faster than pictures, a picture is due after so many seconds all the same.
constexpr double longest_wait = 0.05;
/// A hand that turns the camera rests when it has done nothing for so many seconds.
constexpr double still_seconds = 0.1;

}

void ViewWindow::Internals::want_picture(bool always)
{
  if (this->View.camera()->GetMTime() != this->CameraTime)
  {
    this->View.camera_moved();
  }
  this->Event.came();
  this->start_timer();
  // Several moves in a row make one picture.
  if (!this->input_waits() || this->Event.age() > longest_wait)
  {
    this->show(always);
  }
}

void ViewWindow::Internals::show(bool always)
{
  const bool drew = this->View.stale();
  if (drew)
  {
    this->View.draft(
      [](double) { return !InterruptionWatch::requested(); }, [this] { this->present(); });
    this->CameraTime = this->View.camera()->GetMTime();
  }
  this->present(always);
  if (this->Event.waits() && drew)
  {
    this->Times.responses.push_back(this->Event.age());
    this->LastAnswer = Clock::now();
  }
  this->Event.answered();
}

void ViewWindow::Internals::present(bool always)
{
  if (this->Presenting)
  {
    return;
  }
  this->Presenting = true;
  struct Guard
  {
    bool& flag;
    ~Guard() { flag = false; }
  } const guard{ this->Presenting };
  const VolumeScene& scene = this->View.volume_scene();
  const bool cuts =
    this->OwnPlane && *this->OwnPlane < scene.options.modes.clipping_planes.size();
  if (!cuts)
  {
    this->OwnPlane.reset(); // it was taken out of the scene
  }
  this->Tools.follow(
    scene.bounds(), scene.options.modes.cropping.value_or(scene.bounds()), cuts);
  // Until other mappers have a picture the window keeps the one before.
  if (this->View.has_pictures() || !this->View.stale())
  {
    const bool changed = this->Tiles.take(this->View.tiles(), this->View.camera());
    if (!changed && !always)
    {
      return; // the window shows it
    }
  }
  this->Window->Render();
  if (this->Times.first_picture == 0.0 && this->View.has_pictures())
  {
    this->Times.first_picture = seconds_since(this->Set.start);
  }
}

void ViewWindow::Internals::set_timer(bool resting)
{
  if (this->Timer >= 0 && this->Resting != resting)
  {
    this->Interactor->DestroyTimer(this->Timer);
    this->Timer = -1;
  }
  if (this->Timer < 0)
  {
    this->Timer = this->Interactor->CreateRepeatingTimer(resting ? rest : tick);
    this->Resting = resting;
  }
}

bool ViewWindow::Internals::flickers() const
{
  return this->View.settings().arrangement == Arrangement::Flicker;
}

void ViewWindow::Internals::on_timer()
{
  if (InterruptionWatch::requested())
  {
    this->Interactor->TerminateApp();
    return;
  }
  if (this->Event.waits() || this->View.stale())
  {
    this->show();
    return;
  }
  if (this->flickers() && seconds_since(this->LastFlick) > flicker_seconds)
  {
    this->LastFlick = Clock::now();
    this->View.flick();
    this->present();
  }
  if (!this->View.finished())
  {
    if (this->Style->GetState() == VTKIS_NONE || seconds_since(this->LastAnswer) > still_seconds)
    {
      this->refine_once([this] { return this->input_waits(); });
    }
  }
  else if (!this->flickers())
  {
    this->set_timer(true);
  }
}

bool ViewWindow::Internals::refine_once(
  const std::function<bool()>& ends, const std::string& task)
{
  RefinementWatch watch;
  const KeepGoing go = [&](double done)
  {
    if (watch.since_look() < look_every)
    {
      return !watch.asked_to_end();
    }
    watch.look((ends && ends()) || InterruptionWatch::requested());
    // VTK's mappers tell nothing, and another window must not be drawn while they draw.
    if (!watch.asked_to_end() && done > 0.0 && watch.age() > 0.3 &&
        seconds_since(this->LastTold) > told_every)
    {
      this->LastTold = Clock::now();
      this->View.tell_progress(
        task + ": " + std::to_string(static_cast<int>(100.0 * done)) + " %");
      this->present();
    }
    return !watch.asked_to_end();
  };
  const bool better = this->View.refine(go);
  watch.ended(this->Times);
  this->View.tell_progress("");
  if (better || this->View.finished())
  {
    this->present();
  }
  return better;
}

bool ViewWindow::Internals::settle(const std::function<bool()>& ends, const std::string& task)
{
  const NoPause no_pause(this->View);
  this->show();
  while (!this->View.finished())
  {
    const bool better = this->refine_once(ends, task);
    InterruptionWatch::check("view");
    if (ends && ends())
    {
      return false;
    }
    if (!better && !this->View.finished())
    {
      throw Failure("view", "a picture could not be finished", "see its viewport");
    }
  }
  return true;
}

void ViewWindow::show()
{
  this->Internal->show();
}

void ViewWindow::settle()
{
  this->Internal->settle();
}

}
