// The viewer's scene and pictures. What keys and the mouse do: viewer_input.cxx.
#include "viewer.h"

#include "compose.h"

#include "display_options.h"

#include "command.h"
#include "optical_depth.h"
#include "volume_summary.h"

#include "Analysis/difference_picture.h"
#include "Analysis/figures.h"
#include "display_table.h"

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

constexpr int histogram_bins = 256;

const char* title_of(MapperKind kind)
{
  for (const MapperName& name : mapper_names())
  {
    if (name.kind == kind)
    {
      return name.title;
    }
  }
  return "";
}

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
  this->FirstCamera = vtkSmartPointer<vtkCamera>::New();
  this->FirstCamera->DeepCopy(this->Volume.camera);
}

void Viewer::take(const ordered_json& scene)
{
  const ParsedScene parsed(with_size(scene, this->Boxes.pictures.front()));
  VolumeScene volume = make_volume_scene(parsed.options());
  if (!volume.volume)
  {
    throw Failure("INPUT", "it is missing", "name a volume", BadCall);
  }
  this->Scene = scene;
  this->Parsed = parsed;
  this->Volume = std::move(volume);
  this->Values.reset();
  this->Figures.clear();
  this->Hold = Held::Nothing;
  this->Function = function_of(this->Volume.volume->GetProperty());
  this->make_panes();
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
    pane.painter = make_painter(kind);
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

void Viewer::set(ordered_json scene)
{
  try
  {
    drop_orphans(scene);
    const ParsedScene parsed(with_size(scene, this->Boxes.pictures.front()));
    update(this->Volume, parsed.options());
    this->Parsed = parsed;
    this->Scene = scene;
    this->Hint.clear();
  }
  catch (const std::exception& failure)
  {
    this->say(failure.what());
    return;
  }
  this->Function = function_of(this->Volume.volume->GetProperty());
  this->Figures.clear();
  this->give_scene();
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
  fit_clipping_range(this->Volume);
  const Box& box = this->Boxes.pictures.front();
  const double seconds = this->Set.draft_seconds / static_cast<double>(this->Panes.size());
  for (Pane& pane : this->Panes)
  {
    const bool done =
      this->draw(pane, [&](Painter& p) { return p.draft(box.width, box.height, seconds, go); });
    if (!done && pane.failure.empty())
    {
      return; // ended: what ended it asks for another
    }
    if (first && drawn && &pane == &this->Panes.front() && this->Panes.size() > 1)
    {
      drawn();
    }
  }
  this->Stale = false;
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

ControlScene Viewer::control_scene() const
{
  ControlScene scene;
  scene.options = &this->Volume.options;
  scene.exposure = this->Parsed->display().exposure;
  const std::array<double, 6> bounds = this->Volume.bounds();
  scene.size = std::max({ bounds[1] - bounds[0], bounds[3] - bounds[2], bounds[5] - bounds[4] });
  scene.size = scene.size > 0.0 ? scene.size : 1.0;
  scene.first_sun = this->first_sun();
  scene.opacity_unit_distance = this->Volume.opacity_unit_distance;
  return scene;
}

PanelModel Viewer::panel_model()
{
  PanelModel model;
  model.page = this->Page;
  model.scene = this->control_scene();
  model.title = this->Volume.input.name;
  model.length_unit = this->Volume.input.length_unit;
  model.value_unit = this->Volume.input.value_unit;
  model.hint = this->line();
  model.times = this->Set.times;
  model.point = this->Hold == Held::Point ? this->HeldPoint : -1;
  const auto own = std::find_if(
    this->Panes.begin(), this->Panes.end(), [](const Pane& pane) { return is_own(pane.kind); });
  model.shot = own != this->Panes.end() ? &own->painter->shot() : nullptr;
  model.sun_seen = this->sun_seen();
  const bool density = this->Volume.options.density();
  const Input& input = this->Volume.input;
  if (!density)
  {
    model.preset = this->Volume.preset ? this->Volume.preset->name : "";
    if (!this->Volume.options.opacity.empty() || !this->Volume.options.colour.empty())
    {
      model.preset += ", changed";
    }
    model.function = &this->Function;
    if (this->Page == ControlPage::Look && !this->Values)
    {
      const VolumeSummary summary = input.sparse ? summarize(input.sparse, histogram_bins)
                                                 : summarize(input.image, 0, histogram_bins);
      this->Values = Histogram{ summary.minimum,
        summary.minimum + summary.bin_width * double(summary.histogram.size()),
        summary.histogram };
    }
    model.histogram = this->Values ? &*this->Values : nullptr;
  }
  if (this->Page == ControlPage::Matter && density && this->Figures.empty())
  {
    const double extinction = std::max({ this->Volume.options.extinction[0],
      this->Volume.options.extinction[1],
      this->Volume.options.extinction[2] });
    const std::string unit = input.length_unit.empty() ? "units" : input.length_unit;
    this->Figures.emplace_back("mean free path, density 1", with_unit(1.0 / extinction, unit));
    if (input.image)
    {
      double depth = 0.0;
      for (const AxisDepth& axis : optical_depths(input.image, extinction))
      {
        depth = std::max(depth, axis.largest);
      }
      this->Figures.emplace_back("largest optical depth", figure(depth));
    }
  }
  if (this->Page == ControlPage::Matter)
  {
    model.figures = this->Figures;
  }
  if (this->Page == ControlPage::Light && this->Volume.options.medium.sun_direction)
  {
    const Triple& d = *this->Volume.options.medium.sun_direction;
    model.figures = { { "toward the sun",
      figure(d[0], 2) + ", " + figure(d[1], 2) + ", " + figure(d[2], 2) } };
  }
  return model;
}

std::string Viewer::caption(const Pane& pane) const
{
  // Without a panel its line is here.
  if (this->Boxes.panel.empty() && !this->line().empty() && &pane == &this->Panes.front())
  {
    return this->line();
  }
  const Shot& shot = pane.painter->shot();
  if (!pane.failure.empty() || shot.picture.rgb.empty())
  {
    return pane.failure.empty() ? "drawing" : "no picture";
  }
  std::string text = shot.state;
  if (this->Set.times)
  {
    text += ", " + figure(1e3 * shot.seconds) + " ms";
  }
  if (shot.error)
  {
    text += ", error " + figure(*shot.error, 2);
  }
  return text;
}

Bitmap Viewer::bitmap_of(const Pane& pane) const
{
  const Box& box = this->Boxes.pictures.front();
  const Shot& shot = pane.painter->shot();
  if (!pane.failure.empty() || shot.picture.rgb.empty())
  {
    return page_of({ pane.failure.empty() ? "drawing ..." : pane.failure },
      box.width,
      box.height,
      Metrics(this->Set.scale));
  }
  const Picture& picture = shot.picture;
  const DisplayTable table(this->Parsed->display().display());
  Bitmap bitmap{ picture.width, picture.height, {} };
  bitmap.rgb.resize(picture.rgb.size());
  std::transform(picture.rgb.begin(), picture.rgb.end(), bitmap.rgb.begin(), table);
  return bitmap;
}

void Viewer::put(std::size_t index, const Box& box, Bitmap bitmap, bool picture)
{
  if (this->Tiles.size() <= index)
  {
    this->Tiles.resize(index + 1);
  }
  this->Tiles[index] = { box, std::move(bitmap), picture, ++this->Version };
}

void Viewer::tile_pictures()
{
  const Metrics metrics(this->Set.scale);
  const Box& box = this->Boxes.pictures.front();
  if (this->Help)
  {
    const int width = this->Boxes.panel.empty() ? this->Window[0] : this->Boxes.panel.x;
    this->Tiles.resize(1);
    std::vector<std::pair<std::string, std::string>> rows = keys();
    rows.insert(rows.end(), this->Set.more_keys.begin(), this->Set.more_keys.end());
    this->put(
      0, { 0, 0, width, this->Window[1] }, table_of(rows, width, this->Window[1], metrics), true);
    return;
  }
  if (!this->compares())
  {
    this->Tiles.resize(2 * this->Panes.size());
    for (std::size_t i = 0; i < this->Panes.size(); ++i)
    {
      const Box& strip = this->Boxes.captions[i];
      this->put(2 * i, this->Boxes.pictures[i], this->bitmap_of(this->Panes[i]), true);
      this->put(2 * i + 1,
        strip,
        caption_of(title_of(this->Panes[i].kind),
          this->caption(this->Panes[i]),
          strip.width,
          strip.height,
          metrics),
        false);
    }
    return;
  }
  this->Tiles.resize(2);
  const Pane& one = this->Panes[0];
  const Pane& two = this->Panes[1];
  const Box& strip = this->Boxes.captions.front();
  std::string names = title_of(one.kind);
  std::string figures;
  if (this->Set.arrangement == Arrangement::Flicker)
  {
    const Pane& due = this->SecondShown ? two : one;
    const Pane& other = this->SecondShown ? one : two;
    const bool waits = due.failure.empty() && due.painter->shot().picture.rgb.empty();
    const Pane& shown = waits && !other.painter->shot().picture.rgb.empty() ? other : due;
    this->put(0, box, this->bitmap_of(shown), true);
    names = title_of(shown.kind);
    figures = this->caption(shown);
  }
  else if (!one.failure.empty() || !two.failure.empty() ||
           one.painter->shot().picture.rgb.empty() || two.painter->shot().picture.rgb.empty())
  {
    // What failed says why; of two that are being drawn the first has its picture first.
    const bool second = one.failure.empty() &&
                        (!two.failure.empty() || one.painter->shot().picture.rgb.empty());
    this->put(0, box, this->bitmap_of(second ? two : one), true);
  }
  else if (this->Set.arrangement == Arrangement::Wipe)
  {
    const auto whole = [&](const Pane& pane)
    {
      const Bitmap small = this->bitmap_of(pane);
      Picture numbers{ small.width, small.height, { small.rgb.begin(), small.rgb.end() } };
      if (small.width == box.width && small.height == box.height)
      {
        return small;
      }
      const Picture large = resized(numbers, box.width, box.height);
      Bitmap bitmap{ box.width, box.height, {} };
      bitmap.rgb.resize(large.rgb.size());
      std::transform(large.rgb.begin(),
        large.rgb.end(),
        bitmap.rgb.begin(),
        [](float v) { return static_cast<unsigned char>(std::lround(v)); });
      return bitmap;
    };
    this->put(0,
      box,
      wiped(whole(one), whole(two), static_cast<int>(this->Divider * (box.width - 1))),
      true);
    names += std::string(" | ") + title_of(two.kind);
    figures = this->caption(one) + " | " + this->caption(two);
  }
  else
  {
    const DifferencePicture difference =
      difference_picture(resized(one.painter->shot().picture, box.width, box.height),
        resized(two.painter->shot().picture, box.width, box.height));
    this->put(0, box, difference.bitmap, true);
    names += std::string(" - ") + title_of(two.kind);
    figures = difference_label(difference.kind, difference.gain);
  }
  this->put(1, strip, caption_of(names, figures, strip.width, strip.height, metrics), false);
}

void Viewer::tile_panel()
{
  if (this->Boxes.panel.empty())
  {
    return;
  }
  const Box& box = this->Boxes.panel;
  this->Panel = draw_panel(this->panel_model(), box.width, box.height, Metrics(this->Set.scale));
  this->put(this->Tiles.size(), box, this->Panel.bitmap, false);
}

const std::vector<Tile>& Viewer::tiles()
{
  const bool panel = !this->Boxes.panel.empty();
  const bool had_panel =
    panel && !this->Tiles.empty() && this->Tiles.back().box.x == this->Boxes.panel.x;
  if (this->PicturesChanged || this->Tiles.empty())
  {
    Tile kept;
    if (had_panel)
    {
      kept = std::move(this->Tiles.back());
      this->Tiles.pop_back();
    }
    this->tile_pictures();
    if (had_panel)
    {
      this->Tiles.push_back(std::move(kept));
    }
    this->PicturesChanged = false;
  }
  if (panel && (this->PanelChanged || !had_panel))
  {
    if (had_panel)
    {
      this->Tiles.pop_back();
    }
    this->tile_panel();
  }
  this->PanelChanged = false;
  return this->Tiles;
}

}
