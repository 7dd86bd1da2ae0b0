// The viewer's scene and pictures. Its tiles: viewer_tiles.cxx; what keys and the mouse do:
// viewer_keys.cxx, viewer_mouse.cxx, and what they change: viewer_changes.cxx.
#include "viewer.h"

#include "fog_painter.h"

#include "command.h"

#include "vtkBrumeSparseVolume.h"

#include "vtkCamera.h"
#include "vtkImageData.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"
#include "vtkBrumeFog.h"
#include "vtkBrumeMedium.h"
#include "vtkBrumeSky.h"
#include "vtkLightCollection.h"
#include "vtkNew.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <utility>

namespace brume::app
{

namespace
{

using nlohmann::ordered_json;

ordered_json triple(const double v[3])
{
  return { v[0], v[1], v[2] };
}

/// The options of a scene for pictures of this size.
ordered_json with_size(ordered_json scene, const Box& box)
{
  scene["resolution"] = { std::max(box.width, 1), std::max(box.height, 1) };
  return scene;
}

}

Viewer::Viewer(const ordered_json& scene, const Settings& settings)
  : Set(settings)
  , Window(settings.window)
{
  if (this->Set.mappers.empty())
  {
    this->Set.mappers = { MapperKind::RayMarch };
  }
  this->Boxes = lay_out(this->Window[0],
    this->Window[1],
    Metrics(this->Set.scale),
    this->panes_drawn() > 1 && this->Set.arrangement != Arrangement::SideBySide
      ? 1
      : static_cast<int>(this->Set.mappers.size()),
    this->Set.panel);
  this->open(scene);
}

Viewer::~Viewer() = default;

vtkCamera* Viewer::camera() const
{
  return this->Volume.camera;
}

int Viewer::panes_drawn() const
{
  return static_cast<int>(this->Set.mappers.size());
}

bool Viewer::compares() const
{
  return this->Set.arrangement != Arrangement::SideBySide && this->Set.mappers.size() > 1;
}

void Viewer::open(const ordered_json& scene)
{
  this->take(scene);
  this->First = scene;
  this->Others.clear();
  this->FirstCamera = vtkSmartPointer<vtkCamera>::New();
  this->FirstCamera->DeepCopy(this->Volume.camera);
}

void Viewer::take(const ordered_json& scene)
{
  const ParsedScene parsed(with_size(scene, this->Boxes.pictures.front()));
  refuse_empty(parsed.options());
  VolumeScene volume = make_volume_scene(parsed.options());
  this->Scene = scene;
  this->Parsed = parsed;
  this->Volume = std::move(volume);
  this->Values.reset();
  this->Figures.clear();
  this->Hold = Held::Nothing;
  this->BeforeDrag.reset();
  this->Hand = {};
  this->choose_point(-1);
  this->read_function();
  this->make_panes();
}

void Viewer::read_function()
{
  this->Function =
    this->Volume.volume ? function_of(this->Volume.volume->GetProperty()) : TransferFunction{};
}

void Viewer::open_keeping(const ordered_json& scene)
{
  vtkNew<vtkCamera> camera;
  camera->DeepCopy(this->Volume.camera);
  this->take(scene);
  this->Volume.camera->DeepCopy(camera);
  this->camera_moved();
}

void Viewer::reload()
{
  this->open_keeping(ordered_json(this->Scene));
}

void Viewer::go_to_time(int step)
{
  ordered_json scene = this->Scene;
  scene.erase("time");
  scene["time-step"] = step;
  this->open_keeping(scene);
}

void Viewer::make_panes()
{
  this->Panes.clear();
  for (const MapperKind kind : this->Set.mappers)
  {
    Pane pane;
    pane.kind = kind;
    pane.painter = this->Volume.volume ? make_painter(kind) : make_fog_painter(kind);
    this->Panes.push_back(std::move(pane));
  }
  this->give_scene();
  this->resize(this->Window[0], this->Window[1]);
}

void Viewer::give_scene()
{
  for (Pane& pane : this->Panes)
  {
    pane.failure.clear();
    try
    {
      pane.painter->set_scene(this->Volume);
    }
    catch (const std::exception& failure)
    {
      pane.failure = failure.what();
    }
  }
  this->changed();
}

void Viewer::changed()
{
  this->Stale = true;
  this->PanelChanged = true;
}

void Viewer::resize(int width, int height)
{
  this->Window = { std::max(width, 1), std::max(height, 1) };
  this->Boxes = lay_out(this->Window[0],
    this->Window[1],
    Metrics(this->Set.scale),
    this->compares() ? 1 : static_cast<int>(this->Panes.size()),
    this->Set.panel);
  this->Tiles.clear();
  this->PicturesChanged = true;
  this->changed();
}

ordered_json Viewer::scene() const
{
  ordered_json scene = with_size(this->Scene, this->Boxes.pictures.front());
  vtkCamera* camera = this->Volume.camera;
  scene["camera-position"] = triple(camera->GetPosition());
  scene["camera-focal-point"] = triple(camera->GetFocalPoint());
  scene["camera-view-up"] = triple(camera->GetViewUp());
  scene["camera-view-angle"] = camera->GetViewAngle();
  scene.erase("camera-parallel-scale");
  if (camera->GetParallelProjection())
  {
    scene["camera-parallel-scale"] = camera->GetParallelScale();
  }
  return scene;
}

bool Viewer::set(ordered_json scene)
{
  try
  {
    drop_orphans(scene);
    const ParsedScene parsed(with_size(scene, this->Boxes.pictures.front()));
    refuse_empty(parsed.options());
    update(this->Volume, parsed.options());
    this->Parsed = parsed;
    this->Scene = scene;
    this->BeforeDrag.reset();
    this->Hint.clear();
  }
  catch (const std::exception& failure)
  {
    this->say(failure.what());
    return false;
  }
  this->read_function();
  this->Figures.clear();
  this->give_scene();
  return true;
}

void Viewer::reset_camera()
{
  this->Volume.camera->DeepCopy(this->FirstCamera);
  this->camera_moved();
}

void Viewer::camera_moved()
{
  // The ball shows the sun as the camera sees it.
  this->PanelChanged = this->PanelChanged || (this->Page == ControlPage::Light &&
                                               this->Volume.options.medium.sun_direction);
  this->Stale = true;
}

template <class Draw>
bool Viewer::draw(Pane& pane, const Draw& draw_it)
{
  try
  {
    const bool drawn = draw_it(*pane.painter);
    if (drawn)
    {
      pane.failure.clear();
      this->PicturesChanged = true;
    }
    return drawn;
  }
  catch (const std::bad_alloc&)
  {
    pane.failure =
      "memory: there is not enough: close other programs or take a smaller volume or window";
  }
  catch (const std::exception& failure)
  {
    pane.failure = failure.what();
  }
  this->PicturesChanged = true;
  return false;
}

bool Viewer::has_pictures() const
{
  return std::any_of(this->Panes.begin(),
    this->Panes.end(),
    [](const Pane& pane) { return !pane.painter->shot().picture.rgb.empty(); });
}

void Viewer::draft(const KeepGoing& go, const std::function<void()>& drawn)
{
  const bool first = !this->has_pictures();
  this->Stale = false; // what changes while pictures are drawn marks it again
  fit_clipping_range(this->Volume);
  const Box& box = this->Boxes.pictures.front();
  const double seconds = this->Set.draft_seconds / static_cast<double>(this->Panes.size());
  for (Pane& pane : this->Panes)
  {
    const bool done =
      this->draw(pane, [&](Painter& p) { return p.draft(box.width, box.height, seconds, go); });
    if (!done && pane.failure.empty())
    {
      this->Stale = true; // what ended it asks for another
      return;
    }
    if (first && drawn && &pane == &this->Panes.front() && this->Panes.size() > 1)
    {
      drawn();
    }
  }
}

void Viewer::pause(bool paused)
{
  this->Paused = paused;
  this->PanelChanged = true;
}

bool Viewer::finished() const
{
  return this->Paused ||
         std::all_of(this->Panes.begin(),
           this->Panes.end(),
           [](const Pane& pane) { return !pane.failure.empty() || pane.painter->finished(); });
}

bool Viewer::refine(const KeepGoing& go)
{
  if (this->Paused)
  {
    return false;
  }
  const Box& box = this->Boxes.pictures.front();
  // Whole pictures everywhere before better ones anywhere.
  for (const bool whole : { false, true })
  {
    for (Pane& pane : this->Panes)
    {
      if (pane.failure.empty() && !pane.painter->finished() && pane.painter->shot().whole == whole)
      {
        const bool drawn =
          this->draw(pane, [&](Painter& p) { return p.refine(box.width, box.height, go); });
        this->PanelChanged = this->PanelChanged || drawn;
        return drawn || !pane.failure.empty();
      }
    }
  }
  return false;
}

const Shot& Viewer::shot(int viewport) const
{
  return this->Panes.at(static_cast<std::size_t>(viewport)).painter->shot();
}

const std::string& Viewer::failure(int viewport) const
{
  return this->Panes.at(static_cast<std::size_t>(viewport)).failure;
}

void Viewer::say(const std::string& hint)
{
  const std::string before = this->line();
  this->Hint = hint;
  if (this->line() != before)
  {
    this->PanelChanged = true;
    this->PicturesChanged = this->PicturesChanged || this->Boxes.panel.empty();
  }
}

void Viewer::tell_progress(const std::string& progress)
{
  const std::string before = this->line();
  this->Progress = progress;
  if (this->line() != before)
  {
    this->PanelChanged = true;
    this->PicturesChanged = this->PicturesChanged || this->Boxes.panel.empty();
  }
}

std::string Viewer::line() const
{
  return !this->Progress.empty()              ? this->Progress
         : this->Paused && this->Hint.empty() ? "paused"
                                              : this->Hint;
}

}
