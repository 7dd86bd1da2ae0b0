// The options of light, matter, fog and effects; the same for every subcommand that draws.
#pragma once

#include "vtkSmartPointer.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

class vtkBrumeFog;
class vtkBrumeMedium;
class vtkBrumeRayMarchMapper;
class vtkBrumeSky;
class vtkImageData;
class vtkLightCollection;

namespace CLI
{
class App;
class Option;
}

namespace brume::app
{

using Triple = std::array<double, 3>;
constexpr double pi = 3.14159265358979323846;

/// A light of a scene file, in the words of vtkLight.
struct LightChoice
{
  enum class Type
  {
    Directional, ///< from far away along `direction`
    Point,       ///< all around from `position`
    Spot,        ///< from `position` along `direction`, in a cone
    Headlight,   ///< from the camera along its line of sight
  };
  Type type = Type::Directional;
  Triple position{ 0.0, 0.0, 0.0 };
  Triple direction{ 0.0, 0.0, -1.0 }; ///< in which the light travels
  Triple colour{ 1.0, 1.0, 1.0 };
  double intensity = 1.0;               ///< its irradiance is π · intensity · colour
  Triple attenuation{ 1.0, 0.0, 0.0 };  ///< 1 / (a + b d + c d²) at the distance d; point and spot
  double cone_angle = 30.0;             ///< degrees from the axis; spot
  double exponent = 1.0;                ///< of the cosine from the axis; spot
};

/// A part of a phase function.
struct LobeChoice
{
  enum class Function
  {
    Isotropic,
    Rayleigh,
    HenyeyGreenstein,
    Schlick,
  };
  Function function = Function::Isotropic;
  double weight = 1.0;
  double anisotropy = 0.0;
};

/// The functions by the names that options and scene files give them; a long name after its short
/// one.
const std::vector<std::pair<const char*, LobeChoice::Function>>& lobe_functions();

/// What the user says of light, matter, fog and effects. Units and ranges: --help.
struct MediumOptions
{
  // Light.
  std::optional<Triple> sun_direction;
  Triple sun_irradiance{ pi, pi, pi };
  std::vector<std::string> point_lights; ///< "X,Y,Z" or "X,Y,Z,R,G,B" each
  std::vector<LightChoice> lights;       ///< of a scene file
  Triple sky_radiance{ 0.0, 0.0, 0.0 };
  Triple ground_radiance{ 0.0, 0.0, 0.0 };
  Triple up{ 0.0, 0.0, 1.0 };
  std::string environment; ///< a file; empty for none
  int environment_lights = 16;
  double environment_rotation = 0.0;

  // Matter.
  Triple albedo{ 1.0, 1.0, 1.0 };
  double anisotropy = 0.0;
  std::string phase;            ///< lobes in words; empty for none
  std::vector<LobeChoice> lobes; ///< of a scene file
  Triple emission{ 0.0, 0.0, 0.0 };
  double black_body = 0.0;
  double black_body_reference = 1500.0;
  std::string temperature_array = "temperature";
  double temperature_scale = 1.0;
  int octaves = 1;
  double octave_attenuation = 0.5;
  double octave_contribution = 0.5;
  double octave_anisotropy = 0.5;
  std::optional<double> silver_lining;
  double silver_lining_spread = 0.2;
  double silver_lining_back = 0.0;
  std::optional<double> powder;
  std::string powder_form = "exponential";
  double powder_scale = 1.0;

  // Fog.
  Triple fog_extinction{ 0.0, 0.0, 0.0 };
  Triple fog_albedo{ 1.0, 1.0, 1.0 };
  double fog_anisotropy = 0.0;
  double fog_falloff = 0.0;
  double fog_base_height = 0.0;

  // How it is drawn.
  std::string shadows = "automatic";
  double shadow_sample_distance = 0.0;
  std::vector<std::string> forces; ///< "NAME=on" or "NAME=off" each

  // Which options were given: those that make a medium, those that make light (of these), those of
  // fog, those of how a medium is drawn.
  std::vector<const CLI::Option*> medium_switches;
  std::vector<const CLI::Option*> light_switches;
  std::vector<const CLI::Option*> fog_switches;
  std::vector<const CLI::Option*> effect_switches;

  bool has_medium() const; ///< whether the volume's matter is lit
  bool has_lights() const; ///< whether the scene has any light but the headlight
  bool has_fog() const;
  /// An option that VTK's own mappers know nothing of, as the user wrote it; empty for none.
  std::string beyond_stock_mappers() const;
};

/// Declares them on a subcommand; they are read into `options`, which must outlive the parse.
void add_medium_options(CLI::App& command, MediumOptions& options);

/// What single options cannot tell: throws Failure (BadCall) for those that do not fit together.
void check(const MediumOptions& options);

/// The lights: sun, point lights, those of the scene file; a headlight where the scene has no light
/// at all, and one that is off where sky or environment are all the light.
vtkSmartPointer<vtkLightCollection> make_lights(const MediumOptions& options);

/// The medium, with the extinction of a density in R, G and B, or 0, 0, 0 for classified values; null
/// where the options ask for none and the extinction is the same in R, G and B.
vtkSmartPointer<vtkBrumeMedium> make_medium(const MediumOptions& options, const Triple& extinction);

/// Sky, ground and environment, of which the last may take `max_memory` bytes (0: three quarters of the
/// machine's). `environment`: its picture, where it was read before; null reads it. Throws Failure for an
/// environment that cannot be read.
vtkSmartPointer<vtkBrumeSky> make_sky(const MediumOptions& options, std::int64_t max_memory,
  vtkImageData* environment = nullptr);

/// The fog, lit by this sky too; null for none.
vtkSmartPointer<vtkBrumeFog> make_fog(const MediumOptions& options, vtkBrumeSky* sky);

/// Shadows and forced effects.
void apply(const MediumOptions& options, vtkBrumeRayMarchMapper* mapper);

}
