// Changes of the scene and of what is shown: what keys and the mouse ask for.
#include "viewer.h"

#include "command.h"
#include "scene_lists.h"

#include "vtkCamera.h"
#include "vtkVolume.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <set>

namespace brume::app
{

using nlohmann::ordered_json;

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
  const ordered_json before = this->Scene;
  ordered_json scene = before;
  control.set(scene, now, value_at(control, now, place));
  this->set(scene);
  this->note_others(control, before);
}

void Viewer::turn_held(const Control& control, double place)
{
  if (!this->BeforeDrag)
  {
    this->BeforeDrag = std::make_shared<const DragStart>(
      DragStart{ this->Scene, this->Volume.options, this->Others[&control] });
  }
  const std::shared_ptr<const DragStart> start = this->BeforeDrag; // set() ends it
  ControlScene from = this->control_scene();
  from.options = &start->options;
  ordered_json scene = start->scene;
  control.set(scene, from, value_at(control, from, place));
  this->set(scene);
  this->BeforeDrag = start;
  this->Others[&control] = start->others;
  this->note_others(control, start->scene);
}

void Viewer::note_others(const Control& control, const ordered_json& before)
{
  if (this->Scene == before)
  {
    return;
  }
  this->keep_own(control);
  const auto value = [](const ordered_json& scene, const std::string& key)
  { return scene.contains(key) ? scene[key] : ordered_json(); };
  std::set<std::string> keys;
  for (const auto& item : before.items())
  {
    keys.insert(item.key());
  }
  for (const auto& item : this->Scene.items())
  {
    keys.insert(item.key());
  }
  for (const std::string& own : control.keys)
  {
    keys.erase(own);
  }
  std::map<std::string, OthersKey>& others = this->Others[&control];
  for (const std::string& key : keys)
  {
    const ordered_json was = value(before, key);
    const ordered_json is = value(this->Scene, key);
    if (was == is)
    {
      continue;
    }
    const auto noted = others.find(key);
    // What it has changed already was something else before that.
    if (noted == others.end() || noted->second.after != was)
    {
      others[key].before = was;
    }
    others[key].after = is;
  }
}

void Viewer::keep_own(const Control& control)
{
  for (auto& [other, keys] : this->Others)
  {
    for (const std::string& own : control.keys)
    {
      keys.erase(own);
    }
  }
}

void Viewer::restore(const Control& control)
{
  ordered_json scene = this->Scene;
  const auto take_back = [&](const std::vector<std::string>& keys)
  {
    for (const std::string& key : keys)
    {
      scene.erase(key);
      if (this->First.contains(key))
      {
        scene[key] = this->First[key];
      }
    }
  };
  take_back(control.keys);
  for (const auto& [key, other] : this->Others[&control])
  {
    if (this->key_of_scene(key) == other.after) // else somebody meant it
    {
      scene.erase(key);
      if (!other.before.is_null())
      {
        scene[key] = other.before;
      }
    }
  }
  if (!this->set(scene))
  {
    take_back(control.partners);
    if (!this->set(scene))
    {
      return;
    }
  }
  this->Others.erase(&control);
  this->keep_own(control);
}

void Viewer::tint(int index, double hue, double saturation)
{
  if (index == HotSpot::chosen_point)
  {
    const double brightness = brightness_of(this->chosen_colour());
    this->set_chosen_colour(colour_of({ hue, saturation, brightness > 0.0 ? brightness : 1.0 }));
    return;
  }
  const Control& control = controls()[static_cast<std::size_t>(index)];
  const ControlScene now = this->control_scene();
  const ordered_json before = this->Scene;
  ordered_json scene = before;
  control.set_colour(scene, now, tinted(control, now, hue, saturation));
  this->set(scene);
  this->note_others(control, before);
}

Triple Viewer::chosen_colour() const
{
  const std::size_t i = static_cast<std::size_t>(this->Chosen);
  if (this->Chosen < 0 || i >= this->Function.colour.size())
  {
    return { 1.0, 1.0, 1.0 };
  }
  const ColourPoint& p = this->Function.colour[i];
  return { p.red, p.green, p.blue };
}

void Viewer::set_chosen_colour(const Triple& colour)
{
  const std::size_t i = static_cast<std::size_t>(this->Chosen);
  if (this->Chosen < 0 || i >= this->Function.colour.size())
  {
    return;
  }
  TransferFunction function = this->Function;
  function.colour[i] = { function.colour[i].value, colour[0], colour[1], colour[2] };
  this->set_function(function);
}

void Viewer::choose_point(int index)
{
  this->Chosen = index;
  this->PanelChanged = true;
  if (index >= 0)
  {
    this->Picker = HotSpot::chosen_point;
  }
  else if (this->Picker == HotSpot::chosen_point)
  {
    this->Picker.reset();
  }
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
  // All that a preset has to say.
  for (const char* key : { "colour",
         "opacity",
         "opacity-unit-distance",
         "ambient",
         "diffuse",
         "specular",
         "specular-power" })
  {
    scene.erase(key);
  }
  this->choose_point(-1);
  this->Hand = {};
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
  this->Others.clear();
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
