#include "view_window.h"

#include "cutting_tools.h"
#include "recording.h"
#include "view_style.h"
#include "x_input.h"

#include "Analysis/canvas.h"
#include "atomic_file.h"
#include "command.h"
#include "film_io.h"
#include "interruption.h"

#include "vtkCallbackCommand.h"
#include "vtkCamera.h"
#include "vtkCommand.h"
#include "vtkImageData.h"
#include "vtkInteractorEventRecorder.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkRenderWindow.h"
#include "vtkRenderWindowInteractor.h"
#include "vtkRenderer.h"
#include "vtkSmartPointer.h"
#include "vtkStringArray.h"
#include "vtkTexture.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iostream>

namespace brume::app
{

namespace
{

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start)
{
  return std::chrono::duration<double>(Clock::now() - start).count();
}

constexpr unsigned long tick = 10;  ///< milliseconds between looks at what is left to do
constexpr unsigned long rest = 200; ///< the same where nothing is, for Ctrl-C
constexpr double flicker_seconds = 0.5;
constexpr double told_every = 0.1; ///< seconds between figures of progress
/// While events come faster than pictures, a picture is due after so many seconds all the same.
constexpr double longest_wait = 0.05;

/// A tile of the viewer on the window.
struct ShownTile
{
  vtkNew<vtkRenderer> renderer;
  vtkNew<vtkTexture> texture;
  vtkNew<vtkImageData> image;
  unsigned version = 0;
};

}

struct ViewWindow::Internals
{
  Internals(Viewer& viewer, const Settings& settings)
    : View(viewer)
    , Set(settings)
  {
  }

  Viewer& View;
  Settings Set;
  vtkNew<vtkRenderWindow> Window;
  vtkNew<vtkRenderWindowInteractor> Interactor;
  vtkNew<ViewStyle> Style;
  vtkNew<vtkCallbackCommand> Ear;
  vtkNew<vtkInteractorEventRecorder> Recorder;
  vtkNew<vtkInteractorEventRecorder> Player;
  vtkNew<vtkRenderer> Page; ///< what no tile covers
  std::vector<std::unique_ptr<ShownTile>> Tiles;
  CuttingTools Tools;
  std::optional<std::size_t> OwnPlane; ///< which of the scene's planes is the tool's
  ViewTimes Times;
  Clock::time_point LastFlick = Clock::now();
  Clock::time_point LastTold = LastFlick;
  std::optional<Clock::time_point> Event; ///< the first that is not shown yet
  vtkMTimeType CameraTime = 0;
  int Timer = -1;
  bool Resting = false; ///< the timer's pace
  bool Presenting = false;

  bool input_waits() { return brume::app::input_waits(this->Window->GetGenericDisplayId()); }

  void observe()
  {
    this->Ear->SetClientData(this);
    this->Ear->SetCallback(
      [](vtkObject*, unsigned long event, void* data, void* call)
      {
        auto* self = static_cast<Internals*>(data);
        self->try_to([&] { self->on_event(event, call); });
      });
    for (const unsigned long event : { vtkCommand::RenderEvent,
           vtkCommand::TimerEvent,
           vtkCommand::ConfigureEvent,
           vtkCommand::DropFilesEvent,
           vtkCommand::ExposeEvent })
    {
      this->Interactor->AddObserver(event, this->Ear);
    }
    const auto taken = [this](auto&& work)
    {
      bool takes = true;
      this->try_to([&] { takes = work(); });
      return takes;
    };
    this->Style->Press = [this, taken](int x, int y, bool right, bool twice)
    { return taken([&] { return this->View.press(x, y, right, twice); }); };
    this->Style->Drag = [this, taken](int x, int y)
    { return taken([&] { return this->View.drag(x, y); }); };
    this->Style->Release = [this, taken] { return taken([&] { return this->View.release(); }); };
    this->Style->Wheel = [this, taken](int x, int y, int steps)
    { return taken([&] { return this->View.wheel(x, y, steps); }); };
    this->Style->Key = [this](const std::string& symbol, bool control)
    { this->try_to([&] { this->key(symbol, control); }); };
    this->Style->Done = [this] { this->try_to([&] { this->want_picture(); }); };
    this->Tools.Boxed = [this](const CuttingTools::Bounds& bounds)
    { this->View.set_key("cropping", nlohmann::ordered_json(bounds)); };
    this->Tools.Planed = [this](const CuttingTools::Plane& plane) { this->set_plane(plane); };
  }

  /// The tool's plane, beside those that the scene has of its own.
  void set_plane(const CuttingTools::Plane& plane)
  {
    nlohmann::ordered_json planes = this->View.key_of_scene("clipping-plane");
    if (!planes.is_array())
    {
      planes = nlohmann::ordered_json::array();
    }
    if (this->OwnPlane && *this->OwnPlane < planes.size())
    {
      planes[*this->OwnPlane] = plane;
    }
    else
    {
      this->OwnPlane = planes.size();
      planes.push_back(plane);
    }
    this->View.set_key("clipping-plane", planes);
  }

  void on_event(unsigned long event, void* call)
  {
    switch (event)
    {
      case vtkCommand::ConfigureEvent:
      {
        const int* size = this->Window->GetSize();
        this->View.resize(size[0], size[1]);
        this->want_picture();
        break;
      }
      case vtkCommand::ExposeEvent:
        this->present();
        break;
      case vtkCommand::RenderEvent:
        this->want_picture();
        break;
      case vtkCommand::DropFilesEvent:
      {
        auto* names = static_cast<vtkStringArray*>(call);
        if (names && names->GetNumberOfValues() > 0)
        {
          this->open(names->GetValue(0));
          this->want_picture();
        }
        break;
      }
      default:
        this->on_timer();
        break;
    }
  }

  /// Something may have changed: soon there is a picture of it.
  void want_picture()
  {
    if (this->View.camera()->GetMTime() != this->CameraTime)
    {
      this->View.camera_moved();
    }
    if (!this->Event)
    {
      this->Event = Clock::now();
    }
    this->start_timer();
    // Several moves in a row make one picture.
    if (!this->input_waits() || seconds_since(*this->Event) > longest_wait)
    {
      this->show();
    }
  }

  void show()
  {
    const bool drew = this->View.stale();
    if (drew)
    {
      this->View.draft(
        [](double) { return !InterruptionWatch::requested(); }, [this] { this->present(); });
      this->CameraTime = this->View.camera()->GetMTime();
    }
    this->present();
    if (this->Event)
    {
      if (drew)
      {
        this->Times.responses.push_back(seconds_since(*this->Event));
      }
      this->Event.reset();
    }
  }

  void present()
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
    const std::vector<Tile>& tiles = this->View.tiles();
    const int* size = this->Window->GetSize();
    while (this->Tiles.size() > tiles.size())
    {
      this->Window->RemoveRenderer(this->Tiles.back()->renderer);
      this->Tiles.pop_back();
    }
    while (this->Tiles.size() < tiles.size())
    {
      auto shown = std::make_unique<ShownTile>();
      shown->texture->SetInputData(shown->image);
      shown->texture->MipmapOff();
      shown->renderer->SetBackgroundTexture(shown->texture);
      shown->renderer->TexturedBackgroundOn();
      shown->renderer->AutomaticLightCreationOff();
      this->Window->AddRenderer(shown->renderer);
      this->Tiles.push_back(std::move(shown));
    }
    for (std::size_t i = 0; i < tiles.size(); ++i)
    {
      const Tile& tile = tiles[i];
      ShownTile& shown = *this->Tiles[i];
      if (shown.version == tile.version)
      {
        continue;
      }
      shown.version = tile.version;
      const Box& box = tile.box;
      shown.renderer->SetViewport(double(box.x) / size[0],
        double(size[1] - box.y - box.height) / size[1],
        double(box.x + box.width) / size[0],
        double(size[1] - box.y) / size[1]);
      shown.renderer->SetInteractive(tile.picture);
      shown.renderer->SetActiveCamera(this->View.camera());
      vtkNew<vtkUnsignedCharArray> bytes;
      bytes->SetNumberOfComponents(3);
      // The viewer keeps the bitmap until it gives another.
      bytes->SetArray(const_cast<unsigned char*>(tile.bitmap.rgb.data()),
        static_cast<vtkIdType>(tile.bitmap.rgb.size()),
        1);
      shown.image->SetDimensions(tile.bitmap.width, tile.bitmap.height, 1);
      shown.image->GetPointData()->SetScalars(bytes);
      shown.image->Modified();
      shown.texture->SetInterpolate(
        tile.bitmap.width != box.width || tile.bitmap.height != box.height);
    }
    this->Window->Render();
    if (this->Times.first_picture == 0.0 && this->View.has_pictures())
    {
      this->Times.first_picture = seconds_since(this->Set.start);
    }
  }

  void set_timer(bool resting)
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
  void start_timer() { this->set_timer(false); }

  bool flickers() const { return this->View.settings().arrangement == Arrangement::Flicker; }

  void on_timer()
  {
    if (InterruptionWatch::requested())
    {
      this->Interactor->TerminateApp();
      return;
    }
    if (this->Event || this->View.stale())
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
      this->refine_once();
    }
    else if (!this->flickers())
    {
      this->set_timer(true);
    }
  }

  /// One better picture, unless the program is interrupted, or, with `heed`, the user does
  /// something. Whether there was one.
  bool refine_once(bool heed = true)
  {
    std::optional<Clock::time_point> asked;
    const auto start = Clock::now();
    auto looked = start;
    double deaf = 0.0;
    const KeepGoing go = [&](double done)
    {
      deaf = std::max(deaf, seconds_since(looked));
      looked = Clock::now();
      if (!asked && ((heed && this->input_waits()) || InterruptionWatch::requested()))
      {
        asked = Clock::now();
      }
      // VTK's mappers tell nothing, and another window must not be drawn while they draw.
      if (!asked && done > 0.0 && seconds_since(start) > 0.3 &&
          seconds_since(this->LastTold) > told_every)
      {
        this->LastTold = Clock::now();
        this->View.tell_progress(
          "refining: " + std::to_string(static_cast<int>(100.0 * done)) + " %");
        this->present();
      }
      return !asked;
    };
    const bool better = this->View.refine(go);
    this->Times.longest_deaf.push_back(std::max(deaf, seconds_since(looked)));
    if (asked)
    {
      this->Times.interruptions.push_back(seconds_since(*asked));
    }
    this->View.tell_progress("");
    if (better || this->View.finished())
    {
      this->present();
    }
    return better;
  }

  void open(const std::string& path)
  {
    this->try_to(
      [&]
      {
        this->Tools.hide(); // they are around the former volume
        this->OwnPlane.reset();
        const bool scene = std::filesystem::path(path).extension() == ".json";
        nlohmann::ordered_json next;
        if (scene)
        {
          next = read_scene(path);
        }
        else
        {
          next["input"] = std::filesystem::absolute(path).string();
        }
        this->View.open(next);
        this->View.say("opened " + std::filesystem::path(path).filename().string());
      });
  }

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
    }
  }

  void key(const std::string& symbol, bool control)
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
          const Shot& shot = this->View.shot(0);
          if (!shot.film)
          {
            throw Failure("EXR", "VTK's mappers make no film", "show one of Brume's first");
          }
          while (!shot.whole && this->refine_once(false))
          {
          }
          if (!shot.whole)
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
        this->Tiles.front()->renderer,
        scene.bounds(),
        scene.options.modes.cropping.value_or(scene.bounds()));
    }
    else if (symbol == "k")
    {
      this->Tools.switch_plane(
        this->Interactor, this->Tiles.front()->renderer, this->View.volume_scene().bounds());
    }
    else
    {
      this->View.key(symbol);
    }
  }

  void save_screenshot(const std::string& path)
  {
    this->present();
    const int* size = this->Window->GetSize();
    vtkNew<vtkUnsignedCharArray> bytes;
    this->Window->GetPixelData(0, 0, size[0] - 1, size[1] - 1, 0, bytes);
    Bitmap bitmap{ size[0], size[1], {} };
    bitmap.rgb.assign(bytes->GetPointer(0), bytes->GetPointer(0) + bytes->GetNumberOfValues());
    save_png(bitmap, path);
  }

  /// Refines all, whatever the user does but Ctrl-C.
  void settle()
  {
    this->View.go_on();
    this->show();
    while (!this->View.finished())
    {
      const bool better = this->refine_once(false);
      InterruptionWatch::check("view");
      if (!better && !this->View.finished())
      {
        throw Failure("view", "a picture could not be finished", "see its viewport");
      }
    }
  }

  /// Whether Escape waits: other input during a recording does nothing.
  bool escape_waits() { return escape_was_pressed(this->Window->GetGenericDisplayId()); }

  /// The pictures alone, without captions and panel.
  Bitmap pictures()
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

  std::string turntable(int pictures)
  {
    Recording recording(this->Set.folder, "turntable");
    const KeptCamera kept(this->View.camera());
    for (int i = 0; i < pictures && !this->escape_waits(); ++i)
    {
      this->View.say(
        "turntable: " + std::to_string(i) + " of " + std::to_string(pictures) + ", Escape ends it");
      this->settle();
      recording.add(this->pictures());
      this->View.camera()->Azimuth(360.0 / pictures);
      this->View.camera()->OrthogonalizeViewUp();
      this->View.camera_moved();
    }
    return recording.finish();
  }

  std::string series()
  {
    const int count = static_cast<int>(this->View.volume_scene().input.times.size());
    if (count < 2)
    {
      throw Failure("series", "the input has one time step", "open a series over time");
    }
    const int before = this->View.volume_scene().input.time_step;
    Recording recording(this->Set.folder, "series");
    for (int i = 0; i < count && !this->escape_waits(); ++i)
    {
      this->View.go_to_time(i);
      this->View.say(
        "series: " + std::to_string(i) + " of " + std::to_string(count) + ", Escape ends it");
      this->settle();
      recording.add(this->pictures());
    }
    this->View.go_to_time(before);
    return recording.finish();
  }
};

ViewWindow::ViewWindow(Viewer& viewer, const Settings& settings)
  : Internal(std::make_unique<Internals>(viewer, settings))
{
  Internals& in = *this->Internal;
  in.Window->SetSize(settings.width, settings.height);
  in.Window->SetWindowName(settings.title.c_str());
  in.Window->SetMultiSamples(0);
  in.Page->SetBackground(
    palette::page[0] / 255.0, palette::page[1] / 255.0, palette::page[2] / 255.0);
  in.Page->SetInteractive(0);
  in.Window->AddRenderer(in.Page);
  in.Interactor->SetRenderWindow(in.Window);
  in.Interactor->SetInteractorStyle(in.Style);
  in.Interactor->EnableRenderOff(); // events ask for pictures, and the viewer makes them
  in.observe();
  in.View.resize(settings.width, settings.height);
  in.show();
  in.Interactor->Initialize();
  const int* size = in.Window->GetSize(); // as the window manager grants it
  if (size[0] != settings.width || size[1] != settings.height)
  {
    in.View.resize(size[0], size[1]);
    in.show();
  }
}

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
    { "Panel", "drag a bar; right click: as it was at first" } };
}

ViewWindow::~ViewWindow()
{
  Internals& in = *this->Internal;
  in.Interactor->RemoveObserver(in.Ear);
  in.Recorder->SetInteractor(nullptr);
  in.Player->SetInteractor(nullptr);
  in.Tools.hide();
  in.Tiles.clear();
}

void ViewWindow::run()
{
  this->Internal->start_timer();
  this->Internal->Interactor->Start();
}

void ViewWindow::show()
{
  this->Internal->show();
}

void ViewWindow::settle()
{
  this->Internal->settle();
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

vtkRenderWindowInteractor* ViewWindow::interactor() const
{
  return this->Internal->Interactor;
}

vtkRenderWindow* ViewWindow::window() const
{
  return this->Internal->Window;
}

const ViewTimes& ViewWindow::times() const
{
  return this->Internal->Times;
}

}
