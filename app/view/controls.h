// What can be turned in the window: each control is a key of the scene file, so that whatever is set by
// hand can be saved, and drawn by `brume render`.
#pragma once

#include "scene_options.h"
#include "tint.h"

#include <nlohmann/json.hpp>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace brume::app
{

/// The scene's sun: degrees around `up` and above the horizon.
struct SunAngles
{
  double azimuth = 0.0;
  double elevation = 0.0;
};

/// What a control needs to know besides the scene's keys.
struct ControlScene
{
  const SceneOptions* options = nullptr;
  double exposure = 0.0;              ///< stops
  bool volume = true;                 ///< whether it has one; else surfaces stand in fog alone
  bool temperatures = false;          ///< whether the input has the array of temperatures
  double size = 1.0;                  ///< longest edge of all that is drawn, world units
  double low = 0.0;                   ///< of all that is drawn, along `up`
  double high = 1.0;
  double opacity_unit_distance = 1.0; ///< world units, as it is drawn
  Shading shading{};                  ///< by the gradient, as it is drawn
  SunAngles first_sun;                ///< of a scene that has none yet
};

enum class ControlPage
{
  Light,
  Matter,
  Look,
  Plan,
};

enum class ControlScale
{
  Linear,
  Logarithmic,
  Whole, ///< whole numbers
};

/// A number that can be dragged, or turned by keys. Of a colour it is the largest channel.
struct Control
{
  const char* name; ///< for people, and as --play files and tests know it
  std::vector<std::string> keys; ///< of the scene file, that it sets or takes out
  /// "per unit length" and "length" of the data's unit; "emitted": the former for a density; "" for none.
  const char* unit;
  ControlPage page;
  ControlScale scale;
  /// The ends of its range.
  std::function<double(const ControlScene&)> lower;
  std::function<double(const ControlScene&)> upper;
  /// The value as it is drawn; empty where the scene has none.
  std::function<std::optional<double>(const ControlScene&)> get;
  /// Sets it in the scene's keys, and takes out what it excludes.
  std::function<void(nlohmann::ordered_json& scene, const ControlScene&, double value)> set;
  /// Why it means nothing in this scene, and is not shown; empty where it does.
  std::function<std::string(const ControlScene&)> inapplicable;
  const char* less = ""; ///< keys (X's names) that turn it down and up a fortieth of its range; "": none
  const char* more = "";
  /// The colour, linear, and what sets it; of what is no colour both are empty.
  ///@{
  std::function<Triple(const ControlScene&)> colour = {};
  std::function<void(nlohmann::ordered_json& scene, const ControlScene&, const Triple&)> set_colour = {};
  ///@}
  double first = 0.25; ///< place on its bar of a colour that the scene does not have yet
  /// Keys that its own must fit: a right click takes them back, too, where the scene would be refused otherwise.
  std::vector<std::string> partners = {};
};

/// All of them, in the order in which they are shown.
const std::vector<Control>& controls();

/// The place of a value on a control's bar, in [0, 1], and the value of a place; both are cut off at the
/// ends.
double place_of(const Control& control, const ControlScene& scene, double value);
double value_at(const Control& control, const ControlScene& scene, double place);

/// The colour of a control that has one, with another hue and saturation; what the scene does not have gets a
/// brightness of its own.
Triple tinted(const Control& control, const ControlScene& scene, double hue, double saturation);

/// The phase function's lobes, whichever key says them; one at least.
std::vector<LobeChoice> lobes_of(const MediumOptions& medium);

/// The scene's sun; empty where there is none.
std::optional<SunAngles> sun_angles(const MediumOptions& medium);
SunAngles sun_angles(const Triple& direction, const Triple& up);
Triple sun_direction(const SunAngles& angles, const Triple& up);

}
