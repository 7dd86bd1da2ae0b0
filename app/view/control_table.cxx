// All controls, in the order in which they are shown.
#include "controls.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace brume::app
{

namespace
{

using nlohmann::ordered_json;
using S = const ControlScene&;
using J = ordered_json&;

constexpr auto light = ControlPage::Light;
constexpr auto matter = ControlPage::Matter;
constexpr auto look = ControlPage::Look;
constexpr auto linear = ControlScale::Linear;
constexpr auto logarithmic = ControlScale::Logarithmic;

std::function<double(S)> constant(double value)
{
  return [value](S) { return value; };
}

std::string always(S)
{
  return {};
}

std::string of_composite(S s)
{
  return s.options->modes.blend_mode == "composite" ? "" : "light in matter is composite mode's";
}

/// Of what the volume is made of.
std::string of_matter(S s)
{
  return s.volume ? of_composite(s) : "there is no volume";
}

std::string of_densities(S s)
{
  return !s.volume              ? "there is no volume"
         : s.options->density() ? ""
                                : "the values are classified, not a density";
}

std::string of_classified(S s)
{
  return !s.volume              ? "there is no volume"
         : s.options->density() ? "the values are a density: turn the extinction"
                                : "";
}

std::string of_shaded(S s)
{
  const std::string before = of_classified(s);
  const std::string& mode = s.options->modes.blend_mode;
  return !before.empty()                                ? before
         : mode != "composite" && mode != "isosurface" ? "projections are not shaded"
         : s.shading.on                                 ? ""
                                                        : "gradient shading is off";
}

std::string of_fog(S s)
{
  return s.options->medium.has_fog() ? "" : "there is no fog";
}

/// Of what another control has put into the scene.
template <class Has>
std::function<std::string(S)> with(const char* what, const Has& has)
{
  return [what, has](S s)
  {
    const std::string before = of_matter(s);
    return !before.empty()          ? before
           : has(s.options->medium) ? ""
                                    : std::string("there is no ") + what;
  };
}

std::optional<double> positive(double value)
{
  return value > 0.0 ? std::optional<double>(value) : std::nullopt;
}

/// Sets a key, or takes it out at 0, which is "off".
void set_or_erase(J scene, const char* key, double value)
{
  if (value > 0.0)
  {
    scene[key] = value;
  }
  else
  {
    scene.erase(key);
  }
}

/// How a key of a colour is written.
enum class Channels
{
  Three,      ///< R, G, B
  OneOrThree, ///< one number for grey
};

void set_channels(J scene, const char* key, const Triple& colour, Channels channels)
{
  const bool grey = colour[0] == colour[1] && colour[0] == colour[2];
  if (channels == Channels::OneOrThree && grey)
  {
    scene[key] = colour[0];
    return;
  }
  scene[key] = { colour[0], colour[1], colour[2] };
}

/// A control of a colour's brightness; `black`: whether 0 is a colour, too, and not "off".
Control colour_control(Control control, const std::function<Triple(S)>& colour, Channels channels,
  bool black, const std::function<void(J, S)>& also = {})
{
  const std::string key = control.keys.front();
  control.colour = colour;
  control.set_colour = [key, channels, black, also](J scene, S s, const Triple& c)
  {
    if (!black && brightness_of(c) <= 0.0)
    {
      scene.erase(key);
      return;
    }
    set_channels(scene, key.c_str(), c, channels);
    if (also)
    {
      also(scene, s);
    }
  };
  control.set = [colour, set = control.set_colour](J scene, S s, double value)
  { set(scene, s, with_brightness(colour(s), value)); };
  if (!control.get)
  {
    control.get = [colour](S s) { return positive(brightness_of(colour(s))); };
  }
  return control;
}

void set_sun(J scene, S s, const SunAngles& angles)
{
  const Triple d = sun_direction(angles, s.options->medium.up);
  scene["sun-direction"] = { d[0], d[1], d[2] };
}

SunAngles sun_of(S s)
{
  return sun_angles(s.options->medium).value_or(s.first_sun);
}

/// A number of the medium that the scene has once it has a medium.
std::function<std::optional<double>(S)> of_medium(
  const std::function<double(const MediumOptions&)>& value)
{
  return [value](S s)
  {
    const MediumOptions& m = s.options->medium;
    return m.has_medium() ? std::optional<double>(value(m)) : std::nullopt;
  };
}

bool has_direction(const LobeChoice& lobe)
{
  return lobe.function == LobeChoice::Function::HenyeyGreenstein ||
         lobe.function == LobeChoice::Function::Schlick;
}

/// The phase function in the key that is simplest.
void set_lobes(J scene, const std::vector<LobeChoice>& lobes)
{
  for (const char* key : { "anisotropy", "phase", "lobes" })
  {
    scene.erase(key);
  }
  if (lobes.size() == 1 && lobes[0].function == LobeChoice::Function::HenyeyGreenstein)
  {
    scene["anisotropy"] = lobes[0].anisotropy;
    return;
  }
  ordered_json list = ordered_json::array();
  for (const LobeChoice& lobe : lobes)
  {
    const auto& names = lobe_functions();
    const auto name = std::find_if(
      names.begin(), names.end(), [&](const auto& n) { return n.second == lobe.function; });
    ordered_json entry{ { "function", name->first } };
    if (has_direction(lobe))
    {
      entry["anisotropy"] = lobe.anisotropy;
    }
    entry["weight"] = lobe.weight;
    list.push_back(entry);
  }
  scene["lobes"] = list;
}

std::optional<double> lobe_anisotropy(S s, std::size_t index)
{
  const std::vector<LobeChoice> lobes = lobes_of(s.options->medium);
  return s.options->medium.has_medium() && index < lobes.size() && has_direction(lobes[index])
           ? std::optional<double>(lobes[index].anisotropy)
           : std::nullopt;
}

void set_lobe_anisotropy(J scene, S s, std::size_t index, double value)
{
  std::vector<LobeChoice> lobes = lobes_of(s.options->medium);
  if (!has_direction(lobes.at(index)))
  {
    lobes[index].function = LobeChoice::Function::HenyeyGreenstein;
  }
  lobes[index].anisotropy = value;
  set_lobes(scene, lobes);
}

double weight_of(const std::vector<LobeChoice>& lobes)
{
  double sum = 0.0;
  for (const LobeChoice& lobe : lobes)
  {
    sum += lobe.weight;
  }
  return sum;
}

/// The second lobe's part of all weights; 0: there is none.
double second_part(const MediumOptions& medium)
{
  const std::vector<LobeChoice> lobes = lobes_of(medium);
  return lobes.size() < 2 ? 0.0 : lobes[1].weight / weight_of(lobes);
}

void set_second_part(J scene, S s, double part)
{
  std::vector<LobeChoice> lobes = lobes_of(s.options->medium);
  if (lobes.size() < 2)
  {
    // Some light comes back from droplets and cells.
    lobes.push_back({ LobeChoice::Function::HenyeyGreenstein, 0.0, -0.2 });
  }
  lobes[1].weight = 0.0;
  const double others = weight_of(lobes);
  for (LobeChoice& lobe : lobes)
  {
    lobe.weight *= (1.0 - part) / others;
  }
  lobes[1].weight = part;
  if (part <= 0.0)
  {
    lobes.erase(lobes.begin() + 1);
  }
  set_lobes(scene, lobes);
}

/// What matter may send at the most: four times a white source's radiance.
double most_emitted(S s)
{
  return s.options->density() ? 4.0 * brightness_of(s.options->extinction) : 4.0;
}

// clang-format off: a table
std::vector<Control> light_controls()
{
  const Control irradiance = colour_control(
    { "sun irradiance", { "sun-irradiance" }, "", light, linear, constant(0.0), constant(20.0),
      [](S s)
      {
        const MediumOptions& m = s.options->medium;
        return m.sun_direction ? std::optional<double>(brightness_of(m.sun_irradiance))
                               : std::nullopt;
      },
      {}, of_composite },
    [](S s) { return s.options->medium.sun_irradiance; }, Channels::Three, true,
    [](J j, S s)
    {
      if (!s.options->medium.sun_direction)
      {
        set_sun(j, s, s.first_sun);
      }
    });
  return {
    { "sun azimuth", { "sun-direction" }, "deg", light, linear, constant(-180.0), constant(180.0),
      [](S s)
      {
        const auto sun = sun_angles(s.options->medium);
        return sun ? std::optional<double>(sun->azimuth) : std::nullopt;
      },
      [](J j, S s, double v) {
        set_sun(j, s, { v, sun_of(s).elevation });
      },
      of_composite, "Left", "Right" },
    { "sun elevation", { "sun-direction" }, "deg", light, linear, constant(-90.0), constant(90.0),
      [](S s)
      {
        const auto sun = sun_angles(s.options->medium);
        return sun ? std::optional<double>(sun->elevation) : std::nullopt;
      },
      [](J j, S s, double v) {
        set_sun(j, s, { sun_of(s).azimuth, v });
      },
      of_composite, "Down", "Up" },
    irradiance,
    colour_control(
      { "sky radiance", { "sky-radiance" }, "", light, linear, constant(0.0), constant(2.0), {}, {},
        of_composite },
      [](S s) { return s.options->medium.sky_radiance; }, Channels::Three, false),
    colour_control(
      { "ground radiance", { "ground-radiance" }, "", light, linear, constant(0.0), constant(2.0),
        {}, {}, of_composite },
      [](S s) { return s.options->medium.ground_radiance; }, Channels::Three, false),
    { "environment rotation", { "environment-rotation" }, "deg", light, linear, constant(-180.0),
      constant(180.0),
      [](S s)
      {
        // Any number of turns is as good as none.
        return std::optional<double>(std::remainder(s.options->medium.environment_rotation, 360.0));
      },
      [](J j, S, double v) { j["environment-rotation"] = v; },
      [](S s)
      { return s.options->medium.environment.empty() ? "there is no environment" : of_composite(s); } },
    { "exposure", { "exposure" }, "stops", light, linear, constant(-8.0), constant(8.0),
      [](S s) { return std::optional<double>(s.exposure); },
      [](J j, S, double v) { j["exposure"] = v; }, always, "minus", "plus" },
  };
}

std::vector<Control> scattering_controls()
{
  Control albedo = colour_control(
    { "albedo", { "albedo" }, "", matter, linear, constant(0.0), constant(1.0),
      of_medium([](const MediumOptions& m) { return brightness_of(m.albedo); }), {}, of_matter },
    [](S s) { return s.options->medium.albedo; }, Channels::OneOrThree, true);
  albedo.first = 1.0;
  // More contribution than attenuation would make light from nothing.
  Control attenuation{ "octave attenuation", { "octave-attenuation" }, "", matter, linear, constant(0.0),
      constant(1.0),
      [](S s) { return std::optional<double>(s.options->medium.octave_attenuation); },
      [](J j, S s, double v)
      {
        j["octave-attenuation"] = v;
        if (s.options->medium.octave_contribution > v)
        {
          j["octave-contribution"] = v;
        }
      },
      with("second octave", [](const MediumOptions& m) { return m.octaves > 1; }) };
  attenuation.partners = { "octave-contribution" };
  Control contribution{ "octave contribution", { "octave-contribution" }, "", matter, linear, constant(0.0),
      [](S s) { return s.options->medium.octave_attenuation; },
      [](S s) { return std::optional<double>(s.options->medium.octave_contribution); },
      [](J j, S, double v) { j["octave-contribution"] = v; },
      with("second octave",
        [](const MediumOptions& m) { return m.octaves > 1 && m.octave_attenuation > 0.0; }) };
  contribution.partners = { "octave-attenuation" };
  return {
    { "extinction", { "extinction" }, "per unit length", matter, logarithmic,
      [](S s) { return 1e-3 / s.size; }, [](S s) { return 1e5 / s.size; },
      [](S s) { return positive(brightness_of(s.options->extinction)); },
      [](J j, S s, double v) {
        set_channels(
          j, "extinction", with_brightness(s.options->extinction, v), Channels::OneOrThree);
      },
      of_densities, "bracketleft", "bracketright" },
    { "opacity distance", { "opacity-unit-distance" }, "length", matter, logarithmic,
      [](S s) { return 1e-5 * s.size; }, [](S s) { return 10.0 * s.size; },
      [](S s) { return positive(s.opacity_unit_distance); },
      [](J j, S, double v) { j["opacity-unit-distance"] = v; }, of_classified, "bracketleft",
      "bracketright" },
    albedo,
    { "anisotropy", { "anisotropy", "phase", "lobes" }, "", matter, linear, constant(-0.95),
      constant(0.95), [](S s) { return lobe_anisotropy(s, 0); },
      [](J j, S s, double v) { set_lobe_anisotropy(j, s, 0, v); }, of_matter, "g", "h" },
    { "second lobe", { "anisotropy", "phase", "lobes" }, "", matter, linear, constant(0.0),
      constant(0.95), [](S s) { return positive(second_part(s.options->medium)); },
      [](J j, S s, double v) { set_second_part(j, s, v); }, of_matter },
    { "its anisotropy", { "anisotropy", "phase", "lobes" }, "", matter, linear, constant(-0.95),
      constant(0.95), [](S s) { return lobe_anisotropy(s, 1); },
      [](J j, S s, double v) { set_lobe_anisotropy(j, s, 1, v); },
      with("second lobe", [](const MediumOptions& m) { return lobes_of(m).size() > 1; }) },
    { "octaves", { "octaves" }, "", matter, ControlScale::Whole, constant(1.0), constant(16.0),
      of_medium([](const MediumOptions& m) { return m.octaves; }),
      [](J j, S, double v) { j["octaves"] = v; }, of_matter, "comma", "period" },
    attenuation,
    contribution,
    { "octave anisotropy", { "octave-anisotropy" }, "", matter, linear, constant(0.0),
      constant(1.0), [](S s) { return std::optional<double>(s.options->medium.octave_anisotropy); },
      [](J j, S, double v) { j["octave-anisotropy"] = v; },
      with("second octave", [](const MediumOptions& m) { return m.octaves > 1; }) },
  };
}

std::vector<Control> glow_controls()
{
  const auto black_body =
    with("black body", [](const MediumOptions& m) { return m.black_body > 0.0; });
  return {
    colour_control(
      { "emission", { "emission" }, "emitted", matter, linear, constant(0.0), most_emitted, {}, {},
        of_matter },
      [](S s) { return s.options->medium.emission; }, Channels::OneOrThree, false),
    { "black body", { "black-body" }, "emitted", matter, linear, constant(0.0), most_emitted,
      [](S s) { return positive(s.options->medium.black_body); },
      [](J j, S, double v) { set_or_erase(j, "black-body", v); },
      [](S s)
      {
        return s.temperatures || s.options->medium.black_body > 0.0
                 ? of_matter(s)
                 : "the input has no temperatures";
      } },
    { "white at", { "black-body-reference" }, "K", matter, logarithmic, constant(800.0),
      constant(20000.0),
      [](S s) { return std::optional<double>(s.options->medium.black_body_reference); },
      [](J j, S, double v) { j["black-body-reference"] = v; }, black_body },
    { "temperature scale", { "temperature-scale" }, "K", matter, logarithmic, constant(0.1),
      constant(1e4), [](S s) { return std::optional<double>(s.options->medium.temperature_scale); },
      [](J j, S, double v) { j["temperature-scale"] = v; }, black_body },
  };
}

std::vector<Control> unphysical_controls()
{
  const auto lining =
    with("silver lining", [](const MediumOptions& m) { return m.silver_lining.has_value(); });
  return {
    { "silver lining", { "silver-lining" }, "", matter, linear, constant(0.0), constant(4.0),
      [](S s) { return s.options->medium.silver_lining; },
      [](J j, S, double v) { set_or_erase(j, "silver-lining", v); }, of_matter },
    { "silver lining spread", { "silver-lining-spread" }, "", matter, logarithmic, constant(0.01),
      constant(1.0),
      [](S s) { return std::optional<double>(s.options->medium.silver_lining_spread); },
      [](J j, S, double v) { j["silver-lining-spread"] = v; }, lining },
    { "silver lining back", { "silver-lining-back" }, "", matter, linear, constant(0.0),
      constant(1.0),
      [](S s) { return std::optional<double>(s.options->medium.silver_lining_back); },
      [](J j, S, double v) { j["silver-lining-back"] = v; }, lining },
    { "powder", { "powder" }, "", matter, linear, constant(0.0), constant(1.0),
      [](S s) { return s.options->medium.powder; },
      [](J j, S, double v) { set_or_erase(j, "powder", v); }, of_matter },
    { "powder scale", { "powder-scale" }, "", matter, logarithmic, constant(0.01), constant(100.0),
      [](S s) { return std::optional<double>(s.options->medium.powder_scale); },
      [](J j, S, double v) { j["powder-scale"] = v; },
      with("powder", [](const MediumOptions& m) { return m.powder.has_value(); }) },
  };
}

std::vector<Control> fog_controls()
{
  const auto least = [](S s) { return 1e-3 / s.size; };
  return {
    { "fog extinction", { "fog-extinction" }, "per unit length", matter, logarithmic, least,
      [](S s) { return 1e2 / s.size; },
      [](S s) { return positive(brightness_of(s.options->medium.fog_extinction)); },
      [least](J j, S s, double v)
      {
        if (s.volume && v <= least(s))
        {
          j.erase("fog-extinction"); // the bar's end is "off"
          return;
        }
        set_channels(j, "fog-extinction", with_brightness(s.options->medium.fog_extinction, v),
          Channels::OneOrThree);
      },
      of_composite },
    colour_control(
      { "fog albedo", { "fog-albedo" }, "", matter, linear, constant(0.0), constant(1.0),
        [](S s) { return std::optional<double>(brightness_of(s.options->medium.fog_albedo)); }, {},
        of_fog },
      [](S s) { return s.options->medium.fog_albedo; }, Channels::OneOrThree, true),
    { "fog anisotropy", { "fog-anisotropy" }, "", matter, linear, constant(-0.95), constant(0.95),
      [](S s) { return std::optional<double>(s.options->medium.fog_anisotropy); },
      [](J j, S, double v) { j["fog-anisotropy"] = v; }, of_fog },
    { "fog falloff", { "fog-falloff" }, "per unit length", matter, linear, constant(0.0),
      [](S s) { return 20.0 / s.size; },
      [](S s) { return positive(s.options->medium.fog_falloff); },
      [](J j, S, double v) { set_or_erase(j, "fog-falloff", v); }, of_fog },
    { "fog base height", { "fog-base-height" }, "length", matter, linear,
      [](S s) { return s.low - s.size; }, [](S s) { return s.high + s.size; },
      [](S s) { return std::optional<double>(s.options->medium.fog_base_height); },
      [](J j, S, double v) { j["fog-base-height"] = v; }, of_fog },
  };
}

std::vector<Control> look_controls()
{
  return {
    { "ambient", { "ambient" }, "", look, linear, constant(0.0), constant(1.0),
      [](S s) { return std::optional<double>(s.shading.ambient); },
      [](J j, S, double v) { j["ambient"] = v; }, of_shaded },
    { "diffuse", { "diffuse" }, "", look, linear, constant(0.0), constant(1.0),
      [](S s) { return std::optional<double>(s.shading.diffuse); },
      [](J j, S, double v) { j["diffuse"] = v; }, of_shaded },
    { "specular", { "specular" }, "", look, linear, constant(0.0), constant(1.0),
      [](S s) { return std::optional<double>(s.shading.specular); },
      [](J j, S, double v) { j["specular"] = v; }, of_shaded },
    { "specular power", { "specular-power" }, "", look, logarithmic, constant(1.0),
      constant(128.0), [](S s) { return std::optional<double>(s.shading.power); },
      [](J j, S, double v) { j["specular-power"] = v; }, of_shaded },
    colour_control(
      { "background", { "background" }, "", look, linear, constant(0.0), constant(1.0),
        [](S s) { return std::optional<double>(brightness_of(s.options->background)); }, {},
        always },
      [](S s) { return s.options->background; }, Channels::Three, true),
    { "tolerance", { "tolerance" }, "of white", look, logarithmic, constant(1.0 / 2000.0),
      constant(0.1), [](S s) { return std::optional<double>(s.options->tolerance); },
      [](J j, S, double v) { j["tolerance"] = v; }, always, "less", "greater" },
  };
}

// clang-format on
std::vector<Control> make_controls()
{
  std::vector<Control> all;
  for (const auto make : { light_controls, scattering_controls, glow_controls, unphysical_controls,
         fog_controls, look_controls })
  {
    std::vector<Control> some = make();
    std::move(some.begin(), some.end(), std::back_inserter(all));
  }
  return all;
}

}

const std::vector<Control>& controls()
{
  static const std::vector<Control> all = make_controls();
  return all;
}

}
