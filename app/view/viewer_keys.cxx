// What keys do in the viewer.
#include "viewer.h"

#include <algorithm>
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
        v.pause(!v.Paused);
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
        v.Others.clear();
        v.set(scene);
      } },
  };
  return all;
}

bool Viewer::key(const std::string& symbol)
{
  if (symbol.empty())
  {
    return false;
  }
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

}
