// What the viewer's window shows: panel, captions, bitmaps of pictures.
#include "viewer.h"

#include "compose.h"

#include "display_options.h"
#include "optical_depth.h"
#include "volume_summary.h"

#include "Analysis/difference_picture.h"
#include "Analysis/figures.h"
#include "display_table.h"

#include "vtkBrumeSparseVolume.h"

#include "vtkImageData.h"
#include "vtkPointData.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace brume::app
{

namespace
{

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

/// The ends of a box along a direction.
std::pair<double, double> heights(const std::array<double, 6>& bounds, const Triple& up)
{
  const double length = std::sqrt(up[0] * up[0] + up[1] * up[1] + up[2] * up[2]);
  double low = 0.0;
  double high = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    const double a = up[axis] / length * bounds[2 * axis];
    const double b = up[axis] / length * bounds[2 * axis + 1];
    low += std::min(a, b);
    high += std::max(a, b);
  }
  return { low, high };
}

}

ControlScene Viewer::control_scene() const
{
  ControlScene scene;
  scene.options = &this->Volume.options;
  scene.exposure = this->Parsed->display().exposure;
  const std::array<double, 6> bounds = this->Volume.bounds();
  scene.size = std::max({ bounds[1] - bounds[0], bounds[3] - bounds[2], bounds[5] - bounds[4] });
  scene.size = scene.size > 0.0 ? scene.size : 1.0;
  std::tie(scene.low, scene.high) = heights(bounds, this->Volume.options.medium.up);
  scene.volume = this->Volume.volume != nullptr;
  vtkImageData* const image = this->Volume.input.image;
  scene.temperatures =
    image && image->GetPointData()->HasArray(this->Volume.options.medium.temperature_array.c_str());
  scene.first_sun = this->first_sun();
  scene.opacity_unit_distance = this->Volume.opacity_unit_distance;
  if (scene.volume)
  {
    vtkVolumeProperty* const property = this->Volume.volume->GetProperty();
    scene.shading = { property->GetShade() != 0,
      property->GetAmbient(),
      property->GetDiffuse(),
      property->GetSpecular(),
      property->GetSpecularPower() };
  }
  return scene;
}

PanelModel Viewer::panel_model()
{
  PanelModel model;
  model.page = this->Page;
  model.scroll = this->Scrolls[static_cast<std::size_t>(this->Page)];
  model.scene = this->control_scene();
  model.title = this->Volume.input.name;
  model.length_unit = this->Volume.input.length_unit;
  model.value_unit = this->Volume.input.value_unit;
  model.hint = this->line();
  model.times = this->Set.times;
  model.hand = this->Hand;
  model.chosen = this->Chosen;
  model.picker = this->Picker;
  model.curve = this->Parsed->display().display().curve;
  const auto own = std::find_if(
    this->Panes.begin(), this->Panes.end(), [](const Pane& pane) { return is_own(pane.kind); });
  model.shot = own != this->Panes.end() ? &own->painter->shot() : nullptr;
  model.sun_seen = this->sun_seen();
  const bool density = this->Volume.options.density();
  const Input& input = this->Volume.input;
  if (!density && this->Volume.volume)
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
  if (this->Page == ControlPage::Matter && density && this->Volume.volume && this->Figures.empty())
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
    std::vector<Caption> captions;
    for (std::size_t i = 0; i < this->Panes.size(); ++i)
    {
      this->put(2 * i, this->Boxes.pictures[i], this->bitmap_of(this->Panes[i]), true);
      captions.push_back({ title_of(this->Panes[i].kind), this->caption(this->Panes[i]) });
    }
    this->put_captions(captions);
    return;
  }
  this->Tiles.resize(2);
  const Pane& one = this->Panes[0];
  const Pane& two = this->Panes[1];
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
    const bool second =
      one.failure.empty() && (!two.failure.empty() || one.painter->shot().picture.rgb.empty());
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
  this->put_captions({ { names, figures } });
}

void Viewer::put_captions(const std::vector<Caption>& captions)
{
  // All in the letters of the longest that fits; what is cut is cut in letters that are read well.
  const Metrics metrics(this->Set.scale);
  int size = metrics.text;
  for (std::size_t i = 0; i < captions.size(); ++i)
  {
    const int fits = caption_size(captions[i], this->Boxes.captions[i].width, metrics);
    size = fits > 0 ? std::min(size, fits) : size;
  }
  for (std::size_t i = 0; i < captions.size(); ++i)
  {
    const Box& strip = this->Boxes.captions[i];
    this->put(
      2 * i + 1, strip, caption_of(captions[i], size, strip.width, strip.height, metrics), false);
  }
}

void Viewer::tile_panel()
{
  if (this->Boxes.panel.empty())
  {
    return;
  }
  const Box& box = this->Boxes.panel;
  this->Panel = draw_panel(this->panel_model(), box.width, box.height, Metrics(this->Set.scale));
  this->Scrolls[static_cast<std::size_t>(this->Page)] = this->Panel.scroll;
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
