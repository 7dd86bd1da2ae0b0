#include "medium_options.h"

#include "command.h"
#include "option_checks.h"
#include "phase_words.h"

#include "Transport/effects.h"
#include "Transport/medium.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>

namespace brume::app
{

namespace
{

bool any(double v)
{
  return std::abs(v) <= 1e30;
}
bool not_negative(double v)
{
  return v >= 0.0 && v <= 1e30;
}
bool positive(double v)
{
  return v > 0.0 && v <= 1e30;
}
bool fraction(double v)
{
  return v >= 0.0 && v <= 1.0;
}
bool inside_one(double v)
{
  return v > -1.0 && v < 1.0;
}

const char* const a_fraction = "a number from 0 to 1";
const char* const a_positive = "a number greater than 0";
const char* const a_not_negative = "a number of 0 or more";

/// The options of one group of --help.
struct Group
{
  CLI::App& command;
  const char* name;

  CLI::Option* number(const char* option, double& value, const char* type, const char* text,
    const char* what, bool (*good)(double)) const
  {
    return this->command.add_option(option, value, text)
      ->type_name(type)
      ->check(app::number(what, good))
      ->group(this->name);
  }
  CLI::Option* number(const char* option, std::optional<double>& value, const char* type,
    const char* text, const char* what, bool (*good)(double)) const
  {
    return this->command.add_option(option, value, text)
      ->type_name(type)
      ->check(app::number(what, good))
      ->group(this->name);
  }
  /// Three numbers.
  template <class Value>
  CLI::Option* triple(const char* option, Value& value, const char* type, const char* text,
    const char* what, bool (*good)(double)) const
  {
    return this->command.add_option(option, value, text)
      ->delimiter(',')
      ->type_name(type)
      ->check(app::number(what, good))
      ->group(this->name);
  }
  /// One number for R, G and B, or three.
  CLI::Option* channels(const char* option, Triple& value, const char* type, const char* text,
    const char* what, bool (*good)(double)) const
  {
    return this->command
      .add_option_function<std::string>(
        option, [&value](const std::string& t) { value = three_of(split_numbers(t)); }, text)
      ->type_name(type)
      ->check(numbers(what, { 1, 3 }, good))
      ->group(this->name);
  }
};

std::string hyphened(std::string name)
{
  std::replace(name.begin(), name.end(), ' ', '-');
  return name;
}

std::vector<std::string> effect_names()
{
  std::vector<std::string> names;
  for (int i = 0; i < effect_count; ++i)
  {
    names.push_back(hyphened(effect_name(static_cast<Effect>(i))));
  }
  return names;
}

void add_light_options(CLI::App& command, MediumOptions& o)
{
  const Group light{ command, "Light (of a medium: any of these makes the volume scatter)" };
  CLI::Option* sun = light.triple("--sun-direction", o.sun_direction, "X,Y,Z",
    "From the scene toward the sun, any length [no sun]", "a number from -1e30 to 1e30", any);
  CLI::Option* irradiance = light.triple("--sun-irradiance", o.sun_irradiance, "R,G,B",
    "Of the sun, on a surface that faces it, 0 or more [3.14159 each: a white surface then has the "
    "radiance 1, as under a vtkLight of intensity 1]",
    a_not_negative, not_negative);
  irradiance->needs(sun);
  CLI::Option* sky = light.triple("--sky-radiance", o.sky_radiance, "R,G,B",
    "Of the sky, the half of all directions around --up, 0 or more [0,0,0]", a_not_negative,
    not_negative);
  CLI::Option* ground = light.triple("--ground-radiance", o.ground_radiance, "R,G,B",
    "Of the ground, the other half, 0 or more [0,0,0]", a_not_negative, not_negative);
  light.triple("--up", o.up, "X,Y,Z",
    "Away from the ground, any length; fog's heights are along it, too [0,0,1]",
    "a number from -1e30 to 1e30", any);
  CLI::Option* environment =
    command
      .add_option("--environment", o.environment,
        "A picture of the light from all directions (.hdr, .exr: latitude and longitude, linear), its "
        "top at --up [none]")
      ->type_name("FILE")
      ->group(light.name);
  command
    .add_option("--environment-lights", o.environment_lights,
      "How many directional lights the environment becomes, 1 to 1024 [16]")
    ->type_name("N")
    ->check(number("a whole number from 1 to 1024",
      [](double v) { return v >= 1 && v <= 1024 && v == std::floor(v); }))
    ->needs(environment)
    ->group(light.name);
  light
    .number("--environment-rotation", o.environment_rotation, "DEG",
      "Turns the environment about --up, by the right hand, in degrees [0]",
      "a number from -1e6 to 1e6", [](double v) { return std::abs(v) <= 1e6; })
    ->needs(environment);
  CLI::Option* point =
    command
      .add_option("--point-light", o.point_lights,
        "A lamp at X,Y,Z in world units, and its irradiance on a surface that faces it, 0 or more, "
        "the same at all distances [3.14159 each]; may be given several times. Scene files have "
        "lamps that fall off, and spots")
      ->allow_extra_args(false)
      ->type_name("X,Y,Z[,R,G,B]")
      ->check(numbers("a place, or a place and an irradiance: three or six numbers", { 3, 6 }, any))
      ->check(irradiance_of_point())
      ->group(light.name);
  o.light_switches = { sun, sky, ground, environment, point };
}

void add_matter_options(CLI::App& command, MediumOptions& o)
{
  const Group matter{ command, "Matter (any of these makes the volume scatter)" };
  CLI::Option* albedo = matter.channels("--albedo", o.albedo, "A[,A,A]",
    "Part of the light taken from a ray that is scattered, the rest is absorbed; one number or R, G "
    "and B, 0 to 1. Of classified values the colour is multiplied in [1]",
    "one or three numbers from 0 to 1", fraction);
  CLI::Option* anisotropy = matter.number("--anisotropy", o.anisotropy, "G",
    "Mean cosine of the angle of scattering, between -1 (back) and 1 (straight on), by Henyey's and "
    "Greenstein's phase function [0]",
    "a number between -1 and 1", inside_one);
  CLI::Option* phase =
    command
      .add_option("--phase", o.phase,
        "Phase function as a sum of lobes, FUNCTION[:G][:WEIGHT] each: hg:G, schlick:G, rayleigh, "
        "isotropic; such as hg:0.8:0.7,rayleigh:0.3 [isotropic]")
      ->type_name("LOBE[,LOBE]")
      ->check(phase_words())
      ->excludes(anisotropy)
      ->group(matter.name);
  CLI::Option* emission = matter.channels("--emission", o.emission, "E[,E,E]",
    "Radiance that matter sends by itself per world unit and unit of density (of classified values: "
    "per unit of optical depth, times the colour), 0 or more [0]",
    "one or three numbers of 0 or more", not_negative);
  CLI::Option* black_body = matter.number("--black-body", o.black_body, "S",
    "How much of a black body's radiance at the temperature of the place matter sends, per world unit "
    "and unit of density (of classified values: per unit of optical depth), 0 or more [0]",
    a_not_negative, not_negative);
  matter
    .number("--black-body-reference", o.black_body_reference, "K",
      "The temperature whose black body has the luminance 1, 800 to 100000 kelvin [1500]",
      "a temperature from 800 to 100000 kelvin", [](double v) { return v >= 800 && v <= 1e5; })
    ->needs(black_body);
  command
    .add_option("--temperature-array", o.temperature_array,
      "The array of INPUT that holds temperatures [temperature]")
    ->type_name("NAME")
    ->needs(black_body)
    ->group(matter.name);
  matter
    .number("--temperature-scale", o.temperature_scale, "K",
      "Kelvin in one unit of that array, greater than 0 [1]", a_positive, positive)
    ->needs(black_body);

  CLI::Option* octaves =
    command
      .add_option("--octaves", o.octaves,
        "Multiple scattering as a sum of so many single scatterings in ever thinner matter, 1 to 16; "
        "an approximation [1: single scattering]")
      ->type_name("N")
      ->check(number("a whole number from 1 to 16",
        [](double v) { return v >= 1 && v <= most_octaves && v == std::floor(v); }))
      ->group(matter.name);
  matter
    .number("--octave-attenuation", o.octave_attenuation, "A",
      "What each octave leaves of the extinction toward the light, 0 to 1 [0.5]", a_fraction,
      fraction)
    ->needs(octaves);
  matter
    .number("--octave-contribution", o.octave_contribution, "B",
      "What each octave leaves of the light, 0 to --octave-attenuation [0.5]", a_fraction, fraction)
    ->needs(octaves);
  matter
    .number("--octave-anisotropy", o.octave_anisotropy, "C",
      "What each octave leaves of the anisotropy, 0 to 1 [0.5]", a_fraction, fraction)
    ->needs(octaves);

  CLI::Option* lining = matter.number("--silver-lining", o.silver_lining, "STRENGTH",
    "Brighten the rim of matter before a light, 0 or more; not physical [off]", a_not_negative,
    not_negative);
  matter
    .number("--silver-lining-spread", o.silver_lining_spread, "S",
      "Width of the rim, 0.0001 to 1: 1 - G of a Henyey-Greenstein lobe [0.2]",
      "a number from 0.0001 to 1", [](double v) { return v >= 1e-4 && v <= 1.0; })
    ->needs(lining);
  matter
    .number("--silver-lining-back", o.silver_lining_back, "B",
      "Part of it that shines back toward the light, 0 to 1 [0]", a_fraction, fraction)
    ->needs(lining);
  CLI::Option* powder = matter.number("--powder", o.powder, "STRENGTH",
    "Darken thin matter, 0 to 1; not physical [off]", a_fraction, fraction);
  command
    .add_option("--powder-form", o.powder_form,
      "How: exponential, 1 - STRENGTH e^-2d, or height, by the height in the volume's box, too "
      "[exponential]")
    ->type_name("FORM")
    ->check(one_of({ "exponential", "height" }))
    ->needs(powder)
    ->group(matter.name);
  matter
    .number("--powder-scale", o.powder_scale, "S",
      "d is this times the density, greater than 0 [1]", a_positive, positive)
    ->needs(powder);
  o.medium_switches = { albedo, anisotropy, phase, emission, black_body, octaves, lining, powder };
}

void add_fog_options(CLI::App& command, MediumOptions& o)
{
  const Group fog{ command, "Fog without bounds" };
  CLI::Option* extinction = fog.channels("--fog-extinction", o.fog_extinction, "S[,S,S]",
    "Extinction of fog per world unit at its base height; one number or R, G and B, 0 or more [0: no "
    "fog]",
    "one or three numbers of 0 or more", not_negative);
  fog
    .channels("--fog-albedo", o.fog_albedo, "A[,A,A]",
      "Part of what fog takes that it scatters, 0 to 1 [1]", "one or three numbers from 0 to 1",
      fraction)
    ->needs(extinction);
  fog
    .number("--fog-anisotropy", o.fog_anisotropy, "G",
      "Mean cosine of the angle of scattering, between -1 and 1 [0]", "a number between -1 and 1",
      inside_one)
    ->needs(extinction);
  fog
    .number("--fog-falloff", o.fog_falloff, "F",
      "Fog thins with the height along --up by e^-F each world unit, 0 or more [0: everywhere the "
      "same]",
      a_not_negative, not_negative)
    ->needs(extinction);
  fog
    .number("--fog-base-height", o.fog_base_height, "H",
      "Height at which it has --fog-extinction, world units [0]", "a number from -1e30 to 1e30", any)
    ->needs(extinction);
  o.fog_switches = { extinction };
}

void add_effect_options(CLI::App& command, MediumOptions& o)
{
  const Group cost{ command, "Accuracy and cost" };
  CLI::Option* shadows =
    command
      .add_option("--shadows", o.shadows,
        "How light is dimmed on its way through a medium: automatic, none, rays (toward each light "
        "from each sample), volume (swept once) or functions (of depth, a map for each light) "
        "[automatic]")
      ->type_name("METHOD")
      ->check(one_of({ "automatic", "none", "rays", "volume", "functions" }))
      ->group(cost.name);
  CLI::Option* distance = cost.number("--shadow-sample-distance", o.shadow_sample_distance, "D",
    "Between the samples or nodes of shadows, in world units, greater than 0 [chosen]", a_positive,
    positive);
  CLI::Option* force =
    command
      .add_option("--force", o.forces,
        "Simulate an effect, or leave it out, whatever the plan says; may be given several times: " +
          listed(effect_names()) + " [brume plan tells what is chosen]")
      ->allow_extra_args(false)
      ->type_name("NAME=on|off")
      ->check(switch_of(effect_names()))
      ->group(cost.name);
  o.effect_switches = { shadows, distance, force };
}

const CLI::Option* first_given(const std::vector<const CLI::Option*>& options)
{
  const auto given = std::find_if(options.begin(), options.end(),
    [](const CLI::Option* option) { return option->count() > 0; });
  return given == options.end() ? nullptr : *given;
}

bool is_zero(const Triple& v)
{
  return v[0] == 0.0 && v[1] == 0.0 && v[2] == 0.0;
}

}

bool MediumOptions::has_lights() const
{
  return !this->lights.empty() || first_given(this->light_switches);
}

bool MediumOptions::has_medium() const
{
  return this->has_lights() || !this->lobes.empty() || first_given(this->medium_switches);
}

bool MediumOptions::has_fog() const
{
  return !is_zero(this->fog_extinction);
}

std::string MediumOptions::beyond_stock_mappers() const
{
  for (const auto& list :
    { this->light_switches, this->medium_switches, this->fog_switches, this->effect_switches })
  {
    if (const CLI::Option* option = first_given(list))
    {
      return option->get_name();
    }
  }
  return !this->lights.empty() ? "lights" : !this->lobes.empty() ? "lobes" : "";
}

void add_medium_options(CLI::App& command, MediumOptions& o)
{
  add_light_options(command, o);
  add_matter_options(command, o);
  add_fog_options(command, o);
  add_effect_options(command, o);
}

void check(const MediumOptions& o)
{
  if (o.sun_direction && is_zero(*o.sun_direction))
  {
    throw Failure("--sun-direction", "0,0,0 is no direction",
      "give the direction from the scene toward the sun, such as 1,0,1", BadCall);
  }
  if (is_zero(o.up))
  {
    throw Failure("--up", "0,0,0 is no direction", "give another one, such as 0,1,0", BadCall);
  }
  if (o.octave_contribution > o.octave_attenuation)
  {
    throw Failure("--octave-contribution",
      "more than --octave-attenuation it would make light from nothing",
      "give at most that", BadCall);
  }
  const bool lit = o.has_medium() || o.has_fog();
  if (!lit && (o.shadows != "automatic" || o.shadow_sample_distance > 0.0))
  {
    throw Failure(o.shadows != "automatic" ? "--shadows" : "--shadow-sample-distance",
      "there is no medium that could be lit",
      "add one of light or matter, such as --albedo 1, or leave it out", BadCall);
  }
  if (o.shadow_sample_distance > 0.0 && o.shadows == "none")
  {
    throw Failure("--shadow-sample-distance", "there are no shadows with --shadows none",
      "leave one of them out", BadCall);
  }
}

}
