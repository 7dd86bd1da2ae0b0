// What keys and the mouse do to the viewer.
#include "viewer.h"

#include "command.h"
#include "scene_lists.h"

#include "vtkCamera.h"
#include "vtkVolume.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <functional>

namespace brume::app
{

namespace
{

using nlohmann::ordered_json;

/// A key turns a control by this part of its range.
constexpr double key_step = 1.0 / 40.0;

/// X's names of keys, as people know them.
std::string readable(const std::string& symbol)
{
  static const std::pair<const char*, const char*> names[] = { { "bracketleft", "[" },
    { "bracketright", "]" },
    { "minus", "-" },
    { "plus", "+" },
    { "comma", "," },
    { "period", "." },
    { "less", "<" },
    { "greater", ">" },
    { "question", "?" },
    { "space", "Space" },
    { "Prior", "Page Up" },
    { "Next", "Page Down" } };
  for (const auto& [name, sign] : names)
  {
    if (symbol == name)
    {
      return sign;
    }
  }
  return symbol;
}

}

struct Viewer::Action
{
  const char* symbol;  ///< X's name of the key
  const char* meaning; ///< "" where another action's line tells it
  std::function<void(Viewer&)> run;
};

const std::vector<Viewer::Action>& Viewer::actions()
{
  static const std::vector<Action> all = {
    { "question",
      "these keys",
      [](Viewer& v)
      {
        v.Help = !v.Help;
        v.Tiles.clear();
        v.PicturesChanged = v.PanelChanged = true;
      } },
    { "1", "one viewport; 2, 3, 4: as many", [](Viewer& v) { v.show_viewports(1); } },
    { "2", "", [](Viewer& v) { v.show_viewports(2); } },
    { "3", "", [](Viewer& v) { v.show_viewports(3); } },
    { "4", "", [](Viewer& v) { v.show_viewports(4); } },
    { "m", "another mapper in the last viewport", [](Viewer& v) { v.next_mapper(); } },
    { "s", "side by side", [](Viewer& v) { v.arrange(Arrangement::SideBySide); } },
    { "w",
      "wipe: drag the line between two mappers",
      [](Viewer& v) { v.arrange(Arrangement::Wipe); } },
    { "f", "flicker between two mappers", [](Viewer& v) { v.arrange(Arrangement::Flicker); } },
    { "x",
      "difference of two mappers, amplified",
      [](Viewer& v) { v.arrange(Arrangement::Difference); } },
    { "p",
      "go on with path tracing, or stop at the ray march",
      [](Viewer& v) { v.switch_paths(); } },
    { "r", "the view as it was at first", [](Viewer& v) { v.reset_camera(); } },
    { "space",
      "pause refinement, and go on",
      [](Viewer& v)
      {
        v.Paused = !v.Paused;
        v.PanelChanged = true;
        v.say("");
      } },
    { "l", "sun on, or all light and matter off", [](Viewer& v) { v.switch_light(); } },
    { "Tab",
      "panel on or off",
      [](Viewer& v)
      {
        v.Set.panel = !v.Set.panel;
        v.resize(v.Window[0], v.Window[1]);
      } },
    { "n",
      "next page of the panel",
      [](Viewer& v)
      {
        v.Page = static_cast<ControlPage>((static_cast<int>(v.Page) + 1) % 4);
        v.PanelChanged = true;
      } },
    { "b",
      "background black, grey or white",
      [](Viewer& v)
      {
        const double now = v.Volume.options.background[0];
        const double next = now < 0.25 ? 0.5 : now < 0.75 ? 1.0 : 0.0;
        ordered_json scene = v.Scene;
        scene["background"] = { next, next, next };
        v.set(scene);
      } },
    { "Prior", "the time step before", [](Viewer& v) { v.step_time(-1); } },
    { "Next", "the next time step", [](Viewer& v) { v.step_time(1); } },
    { "BackSpace",
      "all controls as they were at first",
      [](Viewer& v)
      {
        ordered_json scene = v.First;
        for (const char* key : { "time", "time-step" }) // which of the input is shown
        {
          scene.erase(key);
          if (v.Scene.contains(key))
          {
            scene[key] = v.Scene[key];
          }
        }
        v.set(scene);
      } },
  };
  return all;
}

bool Viewer::key(const std::string& symbol)
{
  for (const Action& action : actions())
  {
    if (symbol == action.symbol)
    {
      action.run(*this);
      return true;
    }
  }
  const ControlScene scene = this->control_scene();
  for (const Control& control : controls())
  {
    const bool less = symbol == control.less;
    if ((less || symbol == control.more) && control.inapplicable(scene).empty())
    {
      this->nudge(control, less ? -key_step : key_step);
      return true;
    }
  }
  return false;
}

std::vector<std::pair<std::string, std::string>> Viewer::keys()
{
  std::vector<std::pair<std::string, std::string>> all;
  for (const Action& action : actions())
  {
    if (*action.meaning)
    {
      all.emplace_back(readable(action.symbol), action.meaning);
    }
  }
  for (const Control& control : controls())
  {
    const std::string both = readable(control.less) + "  " + readable(control.more);
    const auto same =
      std::find_if(all.begin(), all.end(), [&](const auto& row) { return row.first == both; });
    if (same != all.end())
    {
      same->second += std::string(" or ") + control.name;
    }
    else if (*control.less)
    {
      all.emplace_back(both, control.name);
    }
  }
  return all;
}

ordered_json Viewer::key_of_scene(const std::string& key) const
{
  return this->Scene.contains(key) ? this->Scene[key] : ordered_json();
}

void Viewer::set_key(const std::string& key, const ordered_json& value)
{
  ordered_json scene = this->Scene;
  scene.erase(key);
  if (!value.is_null())
  {
    scene[key] = value;
  }
  this->set(scene);
}

bool Viewer::press(int x, int y, bool right_button, bool twice)
{
  this->Hold = Held::Nothing;
  if (this->Help)
  {
    return this->key("question");
  }
  if (this->Boxes.panel.contains(x, y))
  {
    return this->press_panel(x - this->Boxes.panel.x, y - this->Boxes.panel.y, right_button, twice);
  }
  const Box& picture = this->Boxes.pictures.front();
  if (this->compares() && this->Set.arrangement == Arrangement::Wipe && picture.contains(x, y))
  {
    const int line = picture.x + static_cast<int>(this->Divider * picture.width);
    if (std::abs(x - line) <= Metrics(this->Set.scale).text)
    {
      this->Hold = Held::Divider;
      return true;
    }
  }
  return false;
}

bool Viewer::press_panel(int x, int y, bool right_button, bool twice)
{
  const HotSpot* spot = this->Panel.at(x, y);
  if (!spot)
  {
    return true;
  }
  this->HeldSpot = *spot;
  const int px = x + this->Boxes.panel.x;
  const int py = y + this->Boxes.panel.y;
  switch (spot->kind)
  {
    case HotSpot::Kind::Page:
      this->Page = static_cast<ControlPage>(spot->index);
      this->PanelChanged = true;
      break;
    case HotSpot::Kind::Control:
      if (right_button)
      {
        const std::string key = controls()[static_cast<std::size_t>(spot->index)].key;
        ordered_json scene = this->Scene;
        scene.erase(key);
        if (this->First.contains(key))
        {
          scene[key] = this->First[key];
        }
        this->set(scene);
        break;
      }
      this->Hold = Held::Control;
      this->drag(px, py);
      break;
    case HotSpot::Kind::Ball:
      this->Hold = Held::Ball;
      this->turn_sun(px, py);
      break;
    case HotSpot::Kind::Preset:
      this->step_preset(spot->index);
      break;
    case HotSpot::Kind::Effect:
      this->switch_effect(std::string(spot->name));
      break;
    case HotSpot::Kind::Shade:
    {
      ordered_json scene = this->Scene;
      const std::string now = this->Volume.options.shade;
      scene["shade"] = now == "preset" ? "on" : now == "on" ? "off" : "preset";
      this->set(scene);
      break;
    }
    case HotSpot::Kind::Curve:
    {
      const CurveField field = curve_field(this->panel_model(), spot->box);
      TransferFunction function = this->Function;
      int index = point_at(function, field, x, y, Metrics(this->Set.scale).text);
      if (right_button && index >= 0)
      {
        remove_point(function, index);
        this->set_function(function);
        break;
      }
      if (index < 0 && twice)
      {
        index = add_point(function, field.value_of(x), field.opacity_of(y));
        this->set_function(function);
      }
      if (index >= 0 && !right_button)
      {
        this->Hold = Held::Point;
        this->HeldPoint = index;
        this->PanelChanged = true;
      }
      else if (index < 0)
      {
        this->say("double click: a new point; right click: one less");
      }
      break;
    }
  }
  return true;
}

bool Viewer::drag(int x, int y)
{
  switch (this->Hold)
  {
    case Held::Nothing:
      return false;
    case Held::Control:
    {
      const Box& box = this->HeldSpot.box;
      const int left = this->Boxes.panel.x + box.x;
      this->turn(controls()[static_cast<std::size_t>(this->HeldSpot.index)],
        double(x - left) / std::max(box.width - 1, 1));
      return true;
    }
    case Held::Ball:
      this->turn_sun(x, y);
      return true;
    case Held::Point:
    {
      const PanelModel model = this->panel_model();
      if (!model.function || this->HeldPoint >= static_cast<int>(this->Function.opacity.size()))
      {
        this->Hold = Held::Nothing; // it went under the hand
        return false;
      }
      const CurveField field = curve_field(model, this->HeldSpot.box);
      TransferFunction function = this->Function;
      move_point(function,
        this->HeldPoint,
        field.value_of(x - this->Boxes.panel.x),
        field.opacity_of(y - this->Boxes.panel.y));
      this->set_function(function);
      return true;
    }
    case Held::Divider:
    {
      const Box& picture = this->Boxes.pictures.front();
      this->Divider = std::clamp(double(x - picture.x) / picture.width, 0.0, 1.0);
      this->PicturesChanged = true;
      return true;
    }
  }
  return false;
}

bool Viewer::release()
{
  const bool held = this->Hold != Held::Nothing;
  this->Hold = Held::Nothing;
  this->PanelChanged = this->PanelChanged || held;
  return held;
}

void Viewer::flick()
{
  if (this->compares() && this->Set.arrangement == Arrangement::Flicker)
  {
    this->SecondShown = !this->SecondShown;
    this->PicturesChanged = true;
  }
}

namespace
{

/// Right, up and toward the eye of a camera, in the world.
struct Axes
{
  glm::dvec3 right, up, eye;
};
Axes axes_of(vtkCamera* camera)
{
  double direction[3], up[3];
  camera->GetDirectionOfProjection(direction);
  camera->GetViewUp(up);
  Axes axes;
  axes.eye = -glm::normalize(glm::dvec3(direction[0], direction[1], direction[2]));
  axes.right = glm::normalize(glm::cross(glm::dvec3(up[0], up[1], up[2]), axes.eye));
  axes.up = glm::cross(axes.eye, axes.right);
  return axes;
}

}

SunAngles Viewer::first_sun() const
{
  const Axes axes = axes_of(this->Volume.camera);
  const glm::dvec3 sun = -0.6 * axes.right + 0.6 * axes.up + 0.7 * axes.eye;
  return sun_angles(Triple{ sun.x, sun.y, sun.z }, this->Volume.options.medium.up);
}

Triple Viewer::sun_seen() const
{
  const auto& direction = this->Volume.options.medium.sun_direction;
  if (!direction)
  {
    return { 0.0, 0.0, 0.0 };
  }
  const Axes axes = axes_of(this->Volume.camera);
  const glm::dvec3 sun =
    glm::normalize(glm::dvec3((*direction)[0], (*direction)[1], (*direction)[2]));
  return { glm::dot(sun, axes.right), glm::dot(sun, axes.up), glm::dot(sun, axes.eye) };
}

void Viewer::turn_sun(int x, int y)
{
  const Box& ball = this->HeldSpot.box;
  const double radius = 0.5 * (ball.width - 1);
  double u = (x - this->Boxes.panel.x - ball.x - radius) / radius;
  double v = -(y - this->Boxes.panel.y - ball.y - radius) / radius;
  // Beyond the rim the sun goes on behind the ball.
  const double length = std::sqrt(u * u + v * v);
  double front = 0.0;
  if (length > 1.0)
  {
    const double beyond = std::min(2.0 - length, 1.0);
    const double r = std::max(beyond, 0.0);
    u *= r / length;
    v *= r / length;
    front = -std::sqrt(std::max(1.0 - r * r, 0.0));
  }
  else
  {
    front = std::sqrt(1.0 - length * length);
  }
  const Axes axes = axes_of(this->Volume.camera);
  const glm::dvec3 sun = u * axes.right + v * axes.up + front * axes.eye;
  ordered_json scene = this->Scene;
  scene["sun-direction"] = { sun.x, sun.y, sun.z };
  this->set(scene);
}

void Viewer::turn(const Control& control, double place)
{
  const ControlScene now = this->control_scene();
  ordered_json scene = this->Scene;
  control.set(scene, now, value_at(control, now, place));
  this->set(scene);
}

void Viewer::nudge(const Control& control, double by)
{
  const ControlScene now = this->control_scene();
  const std::optional<double> value = control.get(now);
  double place = value ? place_of(control, now, *value) : 0.5;
  if (control.scale == ControlScale::Whole && value)
  {
    // Whole numbers by one.
    const double range = control.upper(now) - control.lower(now);
    by = (by > 0.0 ? 1.0 : -1.0) / range;
  }
  place += by;
  if (std::string(control.unit) == "deg" && control.upper(now) == 180.0)
  {
    place -= std::floor(place); // all around
  }
  this->turn(control, place);
}

void Viewer::set_function(const TransferFunction& function)
{
  ordered_json scene = this->Scene;
  scene["colour"] = list_of(function.colour);
  scene["opacity"] = list_of(function.opacity);
  this->set(scene);
}

void Viewer::step_preset(int by)
{
  const std::vector<Preset>& all = presets();
  const std::string now = this->Volume.preset ? this->Volume.preset->name : "";
  const auto found =
    std::find_if(all.begin(), all.end(), [&](const Preset& preset) { return preset.name == now; });
  const int count = static_cast<int>(all.size());
  const int index = found == all.end() ? 0 : static_cast<int>(found - all.begin());
  ordered_json scene = this->Scene;
  scene["preset"] = all[static_cast<std::size_t>((index + by + count) % count)].name;
  for (const char* key : { "colour", "opacity", "opacity-unit-distance" })
  {
    scene.erase(key);
  }
  this->set(scene);
}

void Viewer::switch_effect(const std::string& name)
{
  // Settled by the plan, forced on, forced off, and again.
  std::string key = name;
  std::replace(key.begin(), key.end(), ' ', '-');
  ordered_json scene = this->Scene;
  ordered_json forces = scene.value("force", ordered_json::object());
  if (!forces.contains(key))
  {
    forces[key] = true;
  }
  else if (forces[key] == true)
  {
    forces[key] = false;
  }
  else
  {
    forces.erase(key);
  }
  scene["force"] = forces;
  if (forces.empty())
  {
    scene.erase("force");
  }
  this->set(scene);
}

void Viewer::switch_light()
{
  ordered_json scene = this->Scene;
  if (this->Volume.options.medium.has_medium())
  {
    for (const char* key : { "sun-direction",
           "sun-irradiance",
           "sky-radiance",
           "ground-radiance",
           "environment",
           "environment-lights",
           "environment-rotation",
           "point-light",
           "lights",
           "albedo",
           "anisotropy",
           "phase",
           "lobes",
           "emission",
           "black-body",
           "temperature-array",
           "octaves",
           "octave-attenuation",
           "octave-contribution",
           "octave-anisotropy",
           "silver-lining",
           "silver-lining-spread",
           "silver-lining-back",
           "powder",
           "powder-form",
           "powder-scale" })
    {
      scene.erase(key);
    }
    if (!this->Volume.options.medium.has_fog())
    {
      scene.erase("shadows");
      scene.erase("shadow-sample-distance");
    }
  }
  else
  {
    const Triple d = sun_direction(this->control_scene().first_sun, this->Volume.options.medium.up);
    scene["sun-direction"] = { d[0], d[1], d[2] };
  }
  this->set(scene);
}

void Viewer::switch_paths()
{
  bool any = false;
  for (MapperKind& kind : this->Set.mappers)
  {
    if (!any && kind == MapperKind::RayMarch)
    {
      kind = MapperKind::PathTrace;
      any = true;
    }
    else if (!any && kind == MapperKind::PathTrace)
    {
      kind = MapperKind::RayMarch;
      any = true;
    }
  }
  if (any)
  {
    this->make_panes();
  }
}

void Viewer::next_mapper()
{
  const std::vector<MapperName>& all = mapper_names();
  MapperKind& kind = this->Set.mappers.back();
  for (std::size_t i = 0; i < all.size(); ++i)
  {
    if (all[i].kind == kind)
    {
      kind = all[(i + 1) % all.size()].kind;
      break;
    }
  }
  this->make_panes();
}

void Viewer::show_viewports(int count)
{
  std::vector<MapperKind>& mappers = this->Set.mappers;
  for (const MapperName& name : mapper_names())
  {
    const bool there = std::find(mappers.begin(), mappers.end(), name.kind) != mappers.end();
    if (static_cast<int>(mappers.size()) < count && !there)
    {
      mappers.push_back(name.kind);
    }
  }
  mappers.resize(std::min(mappers.size(), static_cast<std::size_t>(count)));
  if (this->Set.mappers.size() == 1)
  {
    this->Set.arrangement = Arrangement::SideBySide;
  }
  this->make_panes();
}

void Viewer::arrange(Arrangement arrangement)
{
  if (arrangement != Arrangement::SideBySide && this->Set.mappers.size() < 2)
  {
    this->show_viewports(2);
  }
  this->Set.arrangement = arrangement;
  this->SecondShown = false;
  this->resize(this->Window[0], this->Window[1]);
}

void Viewer::step_time(int by)
{
  const int count = static_cast<int>(this->Volume.input.times.size());
  if (count < 2)
  {
    this->say("no series: one time step");
    return;
  }
  const int step = std::clamp(this->Volume.input.time_step + by, 0, count - 1);
  try
  {
    this->go_to_time(step);
    this->say("time step " + std::to_string(step) + " of " + std::to_string(count - 1));
  }
  catch (const std::exception& failure)
  {
    this->say(failure.what());
  }
}

}
