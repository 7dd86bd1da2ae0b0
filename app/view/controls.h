// What can be turned in the window: each control is a key of the scene file, so that whatever is set by
// hand can be saved, and drawn by `brume render`.
#pragma once

#include "scene_options.h"

#include <nlohmann/json.hpp>

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
  double size = 1.0;                  ///< longest edge of the volume, world units
  double opacity_unit_distance = 1.0; ///< world units, as it is drawn
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

/// A number that can be dragged, or turned by keys.
struct Control
{
  const char* name; ///< for people, and as --play files and tests know it
  const char* key;  ///< of the scene file
  const char* unit; ///< "" for none
  ControlPage page;
  ControlScale scale;
  const char* less; ///< keys (X's names) that turn it down and up a fortieth of its range; "": none
  const char* more;
  /// The ends of its range.
  double (*lower)(const ControlScene&);
  double (*upper)(const ControlScene&);
  /// The value as it is drawn; empty where the scene has none, or it means nothing there.
  std::optional<double> (*get)(const ControlScene&);
  /// Sets it in the scene's keys, and takes out what it excludes.
  void (*set)(nlohmann::ordered_json& scene, const ControlScene&, double value);
  /// Why it means nothing in this scene; empty where it does.
  std::string (*inapplicable)(const ControlScene&);
};

/// All of them, in the order in which they are shown.
const std::vector<Control>& controls();

/// The place of a value on a control's bar, in [0, 1], and the value of a place; both are cut off at the
/// ends.
double place_of(const Control& control, const ControlScene& scene, double value);
double value_at(const Control& control, const ControlScene& scene, double place);

/// The scene's sun; empty where there is none.
std::optional<SunAngles> sun_angles(const MediumOptions& medium);
SunAngles sun_angles(const Triple& direction, const Triple& up);
Triple sun_direction(const SunAngles& angles, const Triple& up);

}
