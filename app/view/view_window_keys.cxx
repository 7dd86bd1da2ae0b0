#include "view_window_internals.h"

#include "recording.h"

#include "atomic_file.h"
#include "command.h"
#include "film_io.h"

namespace brume::app
{

std::vector<std::pair<std::string, std::string>> ViewWindow::keys()
{
  return { { "Ctrl s", "save the scene, as brume render takes it" },
    { "F2", "save the window as PNG" },
    { "F3", "save the first viewport's light as EXR" },
    { "F4", "record a turn" },
    { "F5", "read the input again" },
    { "F6", "record all time steps" },
    { "c", "a box to crop with" },
    { "k", "a plane to cut with" },
    { "q", "quit" },
    { "Mouse", "left turns, middle shifts, right or wheel comes nearer" },
    { "Panel", "drag a bar; right click: as at first; the wheel scrolls" } };
}

void ViewWindow::Internals::key(const std::string& symbol, bool control)
{
  if (symbol == "q" || symbol == "Escape")
  {
    this->Interactor->TerminateApp();
  }
  else if (control && symbol == "s")
  {
    this->try_to(
      [&]
      {
        const std::string path = free_name(this->Set.folder, "view", ".json");
        write_atomically(path, this->View.scene().dump(2) + "\n");
        this->View.say("saved " + path);
      });
  }
  else if (symbol == "F2")
  {
    this->try_to(
      [&]
      {
        const std::string path = free_name(this->Set.folder, "view", ".png");
        this->save_screenshot(path);
        this->View.say("saved " + path);
      });
  }
  else if (symbol == "F3")
  {
    this->try_to(
      [&]
      {
        this->show(); // what is there may be of the scene before
        const Shot& shot = this->View.shot(0);
        if (!shot.film)
        {
          throw Failure("EXR", "VTK's mappers make no film", "show one of Brume's first");
        }
        const NoPause no_pause(this->View);
        const auto failed = [&] { return !this->View.failure(0).empty(); }; // the film is of before
        const auto good = [&] { return shot.whole && !shot.draft && !failed(); };
        while (!good() && !failed() && this->refine_once({}))
        {
        }
        if (!good())
        {
          throw Failure("EXR", "there is no whole picture", "see the viewport");
        }
        const std::string path = free_name(this->Set.folder, "view", ".exr");
        write_exr(*shot.film, path);
        this->View.say("saved " + path);
      });
  }
  else if (symbol == "F4" || symbol == "F6")
  {
    this->try_to(
      [&]
      {
        const std::string folder = symbol == "F4" ? this->turntable(90) : this->series();
        this->View.camera_moved();
        this->View.say("recorded " + folder);
      });
  }
  else if (symbol == "F5")
  {
    this->View.reload();
    this->View.say("read again");
  }
  else if (symbol == "c")
  {
    const VolumeScene& scene = this->View.volume_scene();
    this->Tools.switch_box(this->Interactor,
      this->Tiles.first(),
      scene.bounds(),
      scene.options.modes.cropping.value_or(scene.bounds()));
  }
  else if (symbol == "k")
  {
    this->Tools.switch_plane(
      this->Interactor, this->Tiles.first(), this->View.volume_scene().bounds());
  }
  else
  {
    this->View.key(symbol);
  }
}

}
