// VTK's and Brume's objects from the options of light and matter.
#include "medium_options.h"

#include "command.h"
#include "option_checks.h"
#include "phase_words.h"

#include "vtkBrumeEffectPlan.h"
#include "vtkBrumeEnvironmentReader.h"
#include "vtkBrumeFog.h"
#include "vtkBrumeMedium.h"
#include "vtkBrumeRayMarchMapper.h"
#include "vtkBrumeSky.h"

#include "vtkCallbackCommand.h"
#include "vtkCommand.h"
#include "vtkImageData.h"
#include "vtkLight.h"
#include "vtkLightCollection.h"
#include "vtkMath.h"
#include "vtkNew.h"

#include <algorithm>
#include <cmath>

namespace brume::app
{

namespace
{

/// A scene light that shines from a place to another, of this colour.
vtkSmartPointer<vtkLight> light_of(const Triple& from, const Triple& to, const Triple& colour)
{
  auto light = vtkSmartPointer<vtkLight>::New();
  light->SetLightTypeToSceneLight();
  light->SetPosition(from[0], from[1], from[2]);
  light->SetFocalPoint(to[0], to[1], to[2]);
  light->SetColor(colour[0], colour[1], colour[2]);
  // The mappers take ambient light of surfaces from the lights: white, as of the headlight.
  light->SetAmbientColor(1.0, 1.0, 1.0);
  return light;
}

/// The colour of a vtkLight of an irradiance.
Triple colour_of_irradiance(const Triple& irradiance)
{
  return { irradiance[0] / pi, irradiance[1] / pi, irradiance[2] / pi };
}

Triple unit(const Triple& v)
{
  const double largest = std::max({ std::abs(v[0]), std::abs(v[1]), std::abs(v[2]) });
  const Triple s{ v[0] / largest, v[1] / largest, v[2] / largest };
  const double length = std::sqrt(s[0] * s[0] + s[1] * s[1] + s[2] * s[2]);
  return { s[0] / length, s[1] / length, s[2] / length };
}

vtkSmartPointer<vtkLight> light_of(const LightChoice& choice)
{
  if (choice.type == LightChoice::Type::Headlight)
  {
    auto light = vtkSmartPointer<vtkLight>::New();
    light->SetLightTypeToHeadlight();
    light->SetColor(choice.colour.data());
    light->SetAmbientColor(1.0, 1.0, 1.0);
    light->SetIntensity(choice.intensity);
    return light;
  }
  const bool placed = choice.type != LightChoice::Type::Directional;
  const Triple way = unit(choice.direction);
  const Triple from = placed ? choice.position : Triple{ -way[0], -way[1], -way[2] };
  const Triple to{ from[0] + way[0], from[1] + way[1], from[2] + way[2] };
  vtkSmartPointer<vtkLight> light = light_of(from, to, choice.colour);
  light->SetIntensity(choice.intensity);
  light->SetPositional(placed);
  if (placed)
  {
    light->SetAttenuationValues(choice.attenuation.data());
    light->SetConeAngle(choice.type == LightChoice::Type::Spot ? choice.cone_angle : 180.0);
    light->SetExponent(choice.exponent);
  }
  return light;
}

vtkSmartPointer<vtkImageData> read_environment(const std::string& path, std::int64_t max_memory)
{
  vtkNew<vtkBrumeEnvironmentReader> reader;
  vtkNew<vtkCallbackCommand> ear; // in place of the standard error stream; GetErrorMessage tells
  ear->SetCallback([](vtkObject*, unsigned long, void*, void*) {});
  reader->AddObserver(vtkCommand::ErrorEvent, ear);
  reader->SetFileName(path.c_str());
  reader->SetMaximumMemory(max_memory);
  reader->Update();
  if (*reader->GetErrorMessage())
  {
    throw Failure(reader->GetErrorMessage());
  }
  return reader->GetOutput();
}

}

vtkSmartPointer<vtkLightCollection> make_lights(const MediumOptions& o)
{
  auto lights = vtkSmartPointer<vtkLightCollection>::New();
  if (o.sun_direction)
  {
    lights->AddItem(light_of(
      unit(*o.sun_direction), { 0.0, 0.0, 0.0 }, colour_of_irradiance(o.sun_irradiance)));
  }
  for (const std::string& text : o.point_lights)
  {
    const std::vector<double> v = split_numbers(text);
    LightChoice point;
    point.type = LightChoice::Type::Point;
    point.position = { v[0], v[1], v[2] };
    point.colour = v.size() == 6 ? colour_of_irradiance({ v[3], v[4], v[5] }) : Triple{ 1.0, 1.0, 1.0 };
    lights->AddItem(light_of(point));
  }
  for (const LightChoice& choice : o.lights)
  {
    lights->AddItem(light_of(choice));
  }
  if (lights->GetNumberOfItems() == 0)
  {
    // A collection without a light would get a headlight; one with a light that is off does not.
    LightChoice headlight;
    headlight.type = LightChoice::Type::Headlight;
    vtkSmartPointer<vtkLight> light = light_of(headlight);
    light->SetSwitch(!o.has_lights());
    lights->AddItem(light);
  }
  return lights;
}

vtkSmartPointer<vtkBrumeMedium> make_medium(const MediumOptions& o, const Triple& extinction)
{
  const bool grey = extinction[0] == extinction[1] && extinction[0] == extinction[2];
  if (!o.has_medium() && grey)
  {
    return nullptr;
  }
  auto medium = vtkSmartPointer<vtkBrumeMedium>::New();
  medium->SetExtinction(extinction.data());
  if (!o.has_medium())
  {
    medium->SetAlbedo(0.0); // coloured absorption alone
    return medium;
  }
  medium->SetAlbedo(o.albedo.data());
  std::vector<LobeChoice> lobes = o.lobes;
  if (!o.phase.empty())
  {
    std::string wrong;
    lobes = read_lobes(o.phase, wrong);
  }
  medium->SetAnisotropy(o.anisotropy);
  for (const LobeChoice& lobe : lobes)
  {
    switch (lobe.function)
    {
      case LobeChoice::Function::Isotropic:
        medium->AddIsotropicLobe(lobe.weight);
        break;
      case LobeChoice::Function::Rayleigh:
        medium->AddRayleighLobe(lobe.weight);
        break;
      case LobeChoice::Function::HenyeyGreenstein:
        medium->AddHenyeyGreensteinLobe(lobe.weight, lobe.anisotropy);
        break;
      case LobeChoice::Function::Schlick:
        medium->AddSchlickLobe(lobe.weight, lobe.anisotropy);
        break;
    }
  }
  medium->SetEmission(o.emission.data());
  medium->SetBlackBody(o.black_body);
  medium->SetBlackBodyReference(o.black_body_reference);
  if (o.black_body > 0.0)
  {
    medium->SetTemperatureArrayName(o.temperature_array.c_str());
  }
  medium->SetTemperatureScale(o.temperature_scale);
  medium->SetNumberOfOctaves(o.octaves);
  medium->SetOctaveAttenuation(o.octave_attenuation);
  medium->SetOctaveContribution(o.octave_contribution);
  medium->SetOctaveAnisotropy(o.octave_anisotropy);
  medium->SetSilverLining(o.silver_lining.has_value());
  medium->SetSilverLiningStrength(o.silver_lining.value_or(1.0));
  medium->SetSilverLiningSpread(o.silver_lining_spread);
  medium->SetSilverLiningBack(o.silver_lining_back);
  medium->SetPowder(o.powder.has_value());
  medium->SetPowderStrength(o.powder.value_or(1.0));
  medium->SetPowderForm(o.powder_form == "height" ? vtkBrumeMedium::HeightPowder
                                                  : vtkBrumeMedium::ExponentialPowder);
  medium->SetPowderScale(o.powder_scale);
  return medium;
}

vtkSmartPointer<vtkBrumeSky> make_sky(
  const MediumOptions& o, std::int64_t max_memory, vtkImageData* environment)
{
  if (!o.has_medium() && !o.has_fog())
  {
    return nullptr;
  }
  auto sky = vtkSmartPointer<vtkBrumeSky>::New();
  sky->SetSkyRadiance(o.sky_radiance.data());
  sky->SetGroundRadiance(o.ground_radiance.data());
  sky->SetUp(unit(o.up).data());
  if (!o.environment.empty())
  {
    sky->SetEnvironmentMap(
      environment ? environment : read_environment(o.environment, max_memory).Get());
    sky->SetEnvironmentRotation(o.environment_rotation);
    sky->SetNumberOfEnvironmentLights(o.environment_lights);
  }
  return sky;
}

vtkSmartPointer<vtkBrumeFog> make_fog(const MediumOptions& o, vtkBrumeSky* sky)
{
  if (!o.has_fog())
  {
    return nullptr;
  }
  auto fog = vtkSmartPointer<vtkBrumeFog>::New();
  fog->SetExtinction(o.fog_extinction.data());
  fog->SetAlbedo(o.fog_albedo.data());
  fog->SetAnisotropy(o.fog_anisotropy);
  fog->SetFalloff(o.fog_falloff);
  fog->SetBaseHeight(o.fog_base_height);
  fog->SetSky(sky);
  return fog;
}

void apply(const MediumOptions& o, vtkBrumeRayMarchMapper* mapper)
{
  static const std::vector<std::pair<const char*, int>> methods{
    { "automatic", vtkBrumeRayMarchMapper::AutomaticShadows },
    { "none", vtkBrumeRayMarchMapper::NoShadows },
    { "rays", vtkBrumeRayMarchMapper::RayShadows },
    { "volume", vtkBrumeRayMarchMapper::VolumeShadows },
    { "functions", vtkBrumeRayMarchMapper::FunctionShadows },
  };
  for (const auto& method : methods)
  {
    if (o.shadows == method.first)
    {
      mapper->SetShadowMethod(method.second);
    }
  }
  mapper->SetShadowSampleDistance(o.shadow_sample_distance);
  mapper->GetEffectPlan()->ForceNothing(); // a mapper may have had others
  for (const std::string& force : o.forces)
  {
    const std::size_t equal = force.find('=');
    mapper->GetEffectPlan()->Force(force.substr(0, equal).c_str(), force.substr(equal + 1) == "on");
  }
}

}
