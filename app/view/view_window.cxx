#include "view_window_internals.h"

#include "x_input.h"

#include "Analysis/canvas.h"
#include "command.h"
#include "scene_file.h"

#include "vtkCamera.h"
#include "vtkCommand.h"
#include "vtkStringArray.h"

#include <filesystem>

namespace brume::app
{

ViewWindow::Internals::Internals(Viewer& viewer, const Settings& settings)
  : View(viewer)
  , Set(settings)
  , Tiles(this->Window)
{
}

bool ViewWindow::Internals::input_waits()
{
  return brume::app::input_waits(this->Window->GetGenericDisplayId());
}

void ViewWindow::Internals::observe()
{
  for (vtkCallbackCommand* ear : { this->Ear.Get(), this->DropEar.Get() })
  {
    ear->SetClientData(this);
    ear->SetCallback(
      [](vtkObject*, unsigned long event, void* data, void* call)
      {
        auto* self = static_cast<Internals*>(data);
        self->try_to([&] { self->on_event(event, call); });
      });
  }
  // While the mouse turns the camera or drags a tool VTK tells none but passive observers; these must
  // leave the interactor's observers alone, and other volumes hide the tools.
  this->Ear->SetPassiveObserver(1);
  for (const unsigned long event : { vtkCommand::RenderEvent,
         vtkCommand::TimerEvent,
         vtkCommand::ConfigureEvent,
         vtkCommand::ExposeEvent })
  {
    this->Interactor->AddObserver(event, this->Ear);
  }
  this->Interactor->AddObserver(vtkCommand::DropFilesEvent, this->DropEar);
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
  this->Style->Release = [this] { this->try_to([&] { this->View.release(); }); };
  this->Style->Wheel = [this, taken](int x, int y, int steps)
  { return taken([&] { return this->View.wheel(x, y, steps); }); };
  this->Style->Key = [this](const std::string& symbol, bool control)
  { this->try_to([&] { this->key(symbol, control); }); };
  this->Style->Done = [this] { this->try_to([&] { this->want_picture(false); }); };
  this->Tools.Boxed = [this](const CuttingTools::Bounds& bounds)
  { this->View.set_key("cropping", nlohmann::ordered_json(bounds)); };
  this->Tools.Taken = [this] { this->Style->LetGo(); };
  this->Tools.Planed = [this](const CuttingTools::Plane& plane) { this->set_plane(plane); };
}

void ViewWindow::Internals::set_plane(const CuttingTools::Plane& plane)
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

void ViewWindow::Internals::on_event(unsigned long event, void* call)
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

void ViewWindow::Internals::open(const std::string& path)
{
  this->try_to(
    [&]
    {
      if (path.empty())
      {
        throw Failure("what was dropped", "it is no file", "drop a volume or a scene file");
      }
      nlohmann::ordered_json next;
      if (std::filesystem::path(path).extension() == ".json")
      {
        next = read_scene(path);
      }
      else
      {
        next["input"] = std::filesystem::absolute(path).string();
      }
      this->View.open(next);
      this->Tools.hide(); // they are around the former volume
      this->OwnPlane.reset();
      this->View.say("opened " + std::filesystem::path(path).filename().string());
    });
}

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

ViewWindow::~ViewWindow()
{
  Internals& in = *this->Internal;
  in.Interactor->RemoveObserver(in.Ear);
  in.Interactor->RemoveObserver(in.DropEar);
  in.Recorder->SetInteractor(nullptr);
  in.Player->SetInteractor(nullptr);
  in.Tools.hide();
}

void ViewWindow::run()
{
  this->Internal->start_timer();
  this->Internal->Interactor->Start();
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
