// Media, skies and effect plans as VTK objects: defaults, ranges, what never gets in, what is told.
#include "vtkBrumeEffectPlan.h"
#include "vtkBrumeMedium.h"
#include "vtkBrumeSky.h"

#include "Transport/effect_plan.h"
#include "Transport/environment.h"
#include "Transport/scene.h"

#include "vtkCallbackCommand.h"
#include "vtkCommand.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkPointData.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include <functional>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

namespace
{

const double nan = std::numeric_limits<double>::quiet_NaN();
const double inf = std::numeric_limits<double>::infinity();

/// Counts an object's warnings in place of printing them.
struct Ear
{
  vtkNew<vtkCallbackCommand> command;
  int warnings = 0;
  std::string last;

  explicit Ear(vtkObject* object)
  {
    command->SetClientData(this);
    command->SetCallback(
      [](vtkObject*, unsigned long, void* self, void* text)
      {
        ++static_cast<Ear*>(self)->warnings;
        static_cast<Ear*>(self)->last = static_cast<const char*>(text);
      });
    object->AddObserver(vtkCommand::WarningEvent, command);
    object->AddObserver(vtkCommand::ErrorEvent, command);
  }
};

std::string printed(vtkObject* object)
{
  std::ostringstream out;
  object->PrintSelf(out, vtkIndent());
  return out.str();
}

brume::Medium medium_of(vtkBrumeMedium* medium)
{
  brume::Medium result;
  medium->FillMedium(result);
  return result;
}

void expect_rgb(const double* rgb, double r, double g, double b)
{
  EXPECT_EQ(rgb[0], r);
  EXPECT_EQ(rgb[1], g);
  EXPECT_EQ(rgb[2], b);
}

// vtkBrumeMedium. ------------------------------------------------------------------------------

// The defaults of the class are those of the plain struct, but that it is lit.
TEST(Medium, DefaultsAreTransports)
{
  vtkNew<vtkBrumeMedium> medium;
  const brume::Medium plain;
  const brume::Medium m = medium_of(medium);
  EXPECT_TRUE(m.lit);
  EXPECT_EQ(m.albedo, plain.albedo);
  EXPECT_TRUE(m.lobes.empty());
  EXPECT_EQ(m.octaves.count, plain.octaves.count);
  EXPECT_EQ(m.octaves.attenuation, plain.octaves.attenuation);
  EXPECT_EQ(m.octaves.contribution, plain.octaves.contribution);
  EXPECT_EQ(m.octaves.anisotropy, plain.octaves.anisotropy);
  EXPECT_EQ(m.emission, plain.emission);
  EXPECT_EQ(m.black_body, plain.black_body);
  EXPECT_EQ(m.black_body_reference, plain.black_body_reference);
  EXPECT_EQ(m.temperature.voxels, nullptr);
  EXPECT_EQ(m.temperature_scale, plain.temperature_scale);
  EXPECT_FALSE(m.silver_lining.enabled);
  EXPECT_EQ(m.silver_lining.strength, plain.silver_lining.strength);
  EXPECT_EQ(m.silver_lining.spread, plain.silver_lining.spread);
  EXPECT_EQ(m.silver_lining.back, plain.silver_lining.back);
  EXPECT_FALSE(m.powder.enabled);
  EXPECT_EQ(m.powder.strength, plain.powder.strength);
  EXPECT_EQ(m.powder.form, plain.powder.form);
  EXPECT_EQ(m.powder.scale, plain.powder.scale);
  expect_rgb(medium->GetExtinction(), 0, 0, 0);
  EXPECT_STREQ(medium->GetDensityArrayName(), "");
  EXPECT_STREQ(medium->GetTemperatureArrayName(), "");
}

/// A setting of one number, with the ends of its range; `refuses`: outside of it warns and keeps.
struct Setting
{
  const char* name;
  std::function<void(vtkBrumeMedium*, double)> set;
  std::function<double(vtkBrumeMedium*)> get;
  std::function<double(const brume::Medium&)> filled;
  double lower, upper, good;
  bool refuses = false;
};

const double most = std::numeric_limits<double>::max();

#define BRUME_SETTING(name, field, lower, upper, good, refuses)                                    \
  Setting                                                                                          \
  {                                                                                                \
#name, [](vtkBrumeMedium * m, double v) { m->Set##name(v); },                                  \
      [](vtkBrumeMedium * m) { return m->Get##name(); },                                           \
        [](const brume::Medium& m) { return double(m.field); }, lower, upper, good, refuses        \
  }

const Setting settings[] = {
  BRUME_SETTING(BlackBody, black_body, 0, most, 3, false),
  BRUME_SETTING(BlackBodyReference, black_body_reference, 800, 1e5, 2000, false),
  BRUME_SETTING(TemperatureScale, temperature_scale, 1e-300, most, 12, true),
  BRUME_SETTING(OctaveAttenuation, octaves.attenuation, 0, 1, 0.7, false),
  BRUME_SETTING(OctaveAnisotropy, octaves.anisotropy, 0, 1, 0.3, false),
  BRUME_SETTING(SilverLiningStrength, silver_lining.strength, 0, most, 2.5, false),
  BRUME_SETTING(SilverLiningSpread, silver_lining.spread, 1e-4, 1, 0.05, false),
  BRUME_SETTING(SilverLiningBack, silver_lining.back, 0, 1, 0.25, false),
  BRUME_SETTING(PowderStrength, powder.strength, 0, 1, 0.75, false),
  BRUME_SETTING(PowderScale, powder.scale, 1e-300, most, 4, true),
};

TEST(Medium, NumbersKeepToTheirRangesAndNaNNeverGetsIn)
{
  for (const Setting& s : settings)
  {
    SCOPED_TRACE(s.name);
    vtkNew<vtkBrumeMedium> medium;
    Ear ear(medium);
    const vtkMTimeType before = medium->GetMTime();
    s.set(medium, s.good);
    EXPECT_EQ(s.get(medium), s.good);
    EXPECT_EQ(s.filled(medium_of(medium)), s.good);
    EXPECT_GT(medium->GetMTime(), before);
    const vtkMTimeType set = medium->GetMTime();
    s.set(medium, s.good);
    EXPECT_EQ(medium->GetMTime(), set) << "the same value modifies nothing";
    EXPECT_EQ(ear.warnings, 0);
    for (double bad : { nan, inf, -inf })
    {
      s.set(medium, bad);
      EXPECT_EQ(s.get(medium), s.good);
      EXPECT_NE(ear.last.find(s.name), std::string::npos) << ear.last;
    }
    EXPECT_EQ(ear.warnings, 3);
    EXPECT_EQ(medium->GetMTime(), set);
    s.set(medium, -7.0);
    EXPECT_EQ(s.get(medium), s.refuses ? s.good : s.lower);
    EXPECT_EQ(ear.warnings, s.refuses ? 4 : 3);
    if (s.upper < most)
    {
      s.set(medium, s.upper + 1.0);
      EXPECT_EQ(s.get(medium), s.upper);
    }
    EXPECT_NE(printed(medium).find(std::string(s.name) + ": "), std::string::npos);
  }
}

TEST(Medium, ColoursKeepToTheirRangesAndNaNNeverGetsIn)
{
  vtkNew<vtkBrumeMedium> medium;
  Ear ear(medium);
  medium->SetExtinction(0.5);
  expect_rgb(medium->GetExtinction(), 0.5, 0.5, 0.5);
  medium->SetExtinction(0.1, -2.0, 3.0);
  expect_rgb(medium->GetExtinction(), 0.1, 0.0, 3.0);
  medium->SetAlbedo(0.9, -0.1, 1.5);
  expect_rgb(medium->GetAlbedo(), 0.9, 0.0, 1.0);
  medium->SetEmission(1.0, -2.0, 30.0);
  expect_rgb(medium->GetEmission(), 1.0, 0.0, 30.0);
  EXPECT_EQ(ear.warnings, 0);
  const vtkMTimeType time = medium->GetMTime();
  for (double bad : { nan, inf, -inf })
  {
    for (int channel = 0; channel < 3; ++channel)
    {
      double rgb[3] = { 0.25, 0.25, 0.25 };
      rgb[channel] = bad;
      medium->SetExtinction(rgb);
      medium->SetAlbedo(rgb);
      medium->SetEmission(rgb);
    }
  }
  EXPECT_EQ(ear.warnings, 27);
  EXPECT_EQ(medium->GetMTime(), time);
  expect_rgb(medium->GetExtinction(), 0.1, 0.0, 3.0);
  EXPECT_EQ(medium_of(medium).albedo, glm::dvec3(0.9, 0.0, 1.0));
  EXPECT_EQ(medium_of(medium).emission, glm::dvec3(1.0, 0.0, 30.0));
}

TEST(Medium, OctavesNeverMakeLight)
{
  vtkNew<vtkBrumeMedium> medium;
  Ear ear(medium);
  medium->SetNumberOfOctaves(99);
  EXPECT_EQ(medium->GetNumberOfOctaves(), 16);
  medium->SetNumberOfOctaves(-1);
  EXPECT_EQ(medium->GetNumberOfOctaves(), 1);
  medium->SetNumberOfOctaves(6);
  EXPECT_EQ(medium_of(medium).octaves.count, 6);
  medium->SetOctaveContribution(0.6); // above ½
  EXPECT_EQ(medium->GetOctaveContribution(), 0.5);
  EXPECT_EQ(ear.warnings, 1);
  EXPECT_NE(ear.last.find("OctaveAttenuation first"), std::string::npos) << ear.last;
  medium->SetOctaveAttenuation(0.8);
  medium->SetOctaveContribution(0.6);
  EXPECT_EQ(medium_of(medium).octaves.contribution, 0.6);
  medium->SetOctaveContribution(nan);
  medium->SetOctaveContribution(-1.0);
  EXPECT_EQ(medium->GetOctaveContribution(), 0.0);
  EXPECT_EQ(ear.warnings, 2);
  medium->SetOctaveContribution(0.6);
  medium->SetOctaveAttenuation(0.3); // takes the contribution with it
  EXPECT_EQ(medium->GetOctaveContribution(), 0.3);
  medium->SetOctaveAttenuation(nan);
  EXPECT_EQ(medium->GetOctaveAttenuation(), 0.3);
  EXPECT_EQ(medium->GetOctaveContribution(), 0.3);
}

TEST(Medium, LobesAreKeptAsGiven)
{
  vtkNew<vtkBrumeMedium> medium;
  Ear ear(medium);
  medium->AddIsotropicLobe(0.5);
  medium->AddRayleighLobe(1.5);
  medium->AddHenyeyGreensteinLobe(2.0, 0.8);
  medium->AddSchlickLobe(4.0, -7.0); // clamped
  ASSERT_EQ(medium->GetNumberOfLobes(), 4);
  const int functions[] = { vtkBrumeMedium::IsotropicLobe,
    vtkBrumeMedium::RayleighLobe,
    vtkBrumeMedium::HenyeyGreensteinLobe,
    vtkBrumeMedium::SchlickLobe };
  const double weights[] = { 0.5, 1.5, 2.0, 4.0 };
  const double anisotropies[] = { 0.0, 0.0, 0.8, -0.9999 };
  const brume::Medium m = medium_of(medium);
  ASSERT_EQ(m.lobes.size(), 4u);
  for (int i = 0; i < 4; ++i)
  {
    EXPECT_EQ(medium->GetLobeFunction(i), functions[i]);
    EXPECT_EQ(medium->GetLobeWeight(i), weights[i]);
    EXPECT_EQ(medium->GetLobeAnisotropy(i), anisotropies[i]);
    EXPECT_EQ(int(m.lobes[i].function), functions[i]);
    EXPECT_EQ(m.lobes[i].weight, weights[i]);
    EXPECT_EQ(m.lobes[i].anisotropy, anisotropies[i]);
  }
  EXPECT_NEAR(medium->GetAnisotropy(), (2.0 * 0.8 - 4.0 * 0.9999) / 8.0, 1e-15);
  EXPECT_EQ(ear.warnings, 0);
  const vtkMTimeType time = medium->GetMTime();
  medium->AddIsotropicLobe(0.0);
  medium->AddRayleighLobe(-1.0);
  medium->AddIsotropicLobe(nan);
  medium->AddSchlickLobe(inf, 0.5);
  medium->AddHenyeyGreensteinLobe(1.0, nan);
  medium->AddSchlickLobe(1.0, inf);
  EXPECT_EQ(ear.warnings, 6);
  EXPECT_EQ(medium->GetNumberOfLobes(), 4);
  EXPECT_EQ(medium->GetMTime(), time);
  for (int none : { -1, 4 })
  {
    EXPECT_EQ(medium->GetLobeFunction(none), vtkBrumeMedium::IsotropicLobe);
    EXPECT_EQ(medium->GetLobeWeight(none), 0.0);
    EXPECT_EQ(medium->GetLobeAnisotropy(none), 0.0);
  }
  medium->RemoveAllLobes();
  EXPECT_EQ(medium->GetNumberOfLobes(), 0);
  EXPECT_GT(medium->GetMTime(), time);
  EXPECT_EQ(medium->GetAnisotropy(), 0.0);
}

TEST(Medium, AnisotropyIsOneHenyeyGreensteinLobe)
{
  vtkNew<vtkBrumeMedium> medium;
  Ear ear(medium);
  medium->AddRayleighLobe();
  medium->SetAnisotropy(0.85);
  ASSERT_EQ(medium->GetNumberOfLobes(), 1);
  EXPECT_EQ(medium->GetLobeFunction(0), vtkBrumeMedium::HenyeyGreensteinLobe);
  EXPECT_EQ(medium->GetAnisotropy(), 0.85);
  const vtkMTimeType time = medium->GetMTime();
  medium->SetAnisotropy(0.85);
  EXPECT_EQ(medium->GetMTime(), time);
  medium->SetAnisotropy(nan);
  EXPECT_EQ(medium->GetAnisotropy(), 0.85);
  EXPECT_EQ(ear.warnings, 1);
  medium->SetAnisotropy(-1.0);
  EXPECT_EQ(medium->GetAnisotropy(), -0.9999);
  medium->SetAnisotropy(0.0);
  EXPECT_EQ(medium->GetNumberOfLobes(), 0);
}

TEST(Medium, WhatIsNotPhysicalHasASwitch)
{
  vtkNew<vtkBrumeMedium> medium;
  medium->SilverLiningOn();
  medium->PowderOn();
  medium->SetPowderFormToHeight();
  brume::Medium m = medium_of(medium);
  EXPECT_TRUE(m.silver_lining.enabled);
  EXPECT_TRUE(m.powder.enabled);
  EXPECT_EQ(m.powder.form, brume::Powder::Form::Height);
  medium->SilverLiningOff();
  medium->PowderOff();
  medium->SetPowderForm(-3);
  m = medium_of(medium);
  EXPECT_FALSE(m.silver_lining.enabled);
  EXPECT_FALSE(m.powder.enabled);
  EXPECT_EQ(m.powder.form, brume::Powder::Form::Exponential);
}

TEST(Medium, PrintsEverySetting)
{
  vtkNew<vtkBrumeMedium> medium;
  medium->SetDensityArrayName("soot");
  medium->SetTemperatureArrayName("kelvins");
  medium->AddSchlickLobe(3.0, 0.5);
  const std::string text = printed(medium);
  for (const char* words : { "Extinction: ",
         "Albedo: 1 1 1",
         "DensityArrayName: soot",
         "Emission: ",
         "BlackBody: ",
         "BlackBodyReference: 1500",
         "TemperatureArrayName: kelvins",
         "TemperatureScale: ",
         "schlick, weight 3, g 0.5",
         "Anisotropy: 0.5",
         "NumberOfOctaves: 1",
         "OctaveAttenuation: ",
         "OctaveContribution: ",
         "OctaveAnisotropy: ",
         "SilverLining: Off",
         "SilverLiningStrength: ",
         "SilverLiningSpread: ",
         "SilverLiningBack: ",
         "Powder: Off",
         "PowderStrength: ",
         "PowderForm: exponential",
         "PowderScale: " })
  {
    EXPECT_NE(text.find(words), std::string::npos) << words << "\n" << text;
  }
}

// vtkBrumeSky. ---------------------------------------------------------------------------------

vtkSmartPointer<vtkImageData> map_of(int width, int height, int components = 3)
{
  auto map = vtkSmartPointer<vtkImageData>::New();
  map->SetDimensions(width, height, 1);
  map->AllocateScalars(VTK_FLOAT, components);
  auto* pixels = static_cast<float*>(map->GetScalarPointer());
  for (int i = 0; i < width * height * components; ++i)
  {
    pixels[i] = float(1 + i % 7);
  }
  return map;
}

TEST(Sky, KeepsItsRangesAndNaNNeverGetsIn)
{
  vtkNew<vtkBrumeSky> sky;
  Ear ear(sky);
  expect_rgb(sky->GetSkyRadiance(), 0, 0, 0);
  expect_rgb(sky->GetGroundRadiance(), 0, 0, 0);
  expect_rgb(sky->GetUp(), 0, 0, 1);
  EXPECT_EQ(sky->GetNumberOfEnvironmentLights(), 16);
  EXPECT_EQ(sky->GetEnvironmentRotation(), 0.0);
  EXPECT_EQ(sky->GetEnvironmentMap(), nullptr);
  sky->SetSkyRadiance(0.5, -1.0, 2.0);
  sky->SetGroundRadiance(-0.5, 0.1, 0.2);
  sky->SetUp(0.0, 3e200, 4e200);
  sky->SetNumberOfEnvironmentLights(0);
  EXPECT_EQ(sky->GetNumberOfEnvironmentLights(), 1);
  sky->SetNumberOfEnvironmentLights(1000000);
  EXPECT_EQ(sky->GetNumberOfEnvironmentLights(), 1024);
  sky->SetEnvironmentRotation(-720.5);
  EXPECT_EQ(ear.warnings, 0);
  for (double bad : { nan, inf, -inf })
  {
    sky->SetSkyRadiance(0, bad, 0);
    sky->SetGroundRadiance(bad, 0, 0);
    sky->SetUp(0, bad, 0);
    sky->SetUp(bad, 1, 0);
    sky->SetUp(1, 1, bad);
    sky->SetEnvironmentRotation(bad);
  }
  sky->SetUp(0, 0, 0);
  EXPECT_EQ(ear.warnings, 19);
  brume::Sky plain;
  sky->FillSky(plain);
  EXPECT_EQ(plain.radiance, glm::dvec3(0.5, 0.0, 2.0));
  EXPECT_EQ(plain.ground, glm::dvec3(0.0, 0.1, 0.2));
  EXPECT_LT(glm::length(plain.up - glm::dvec3(0.0, 0.6, 0.8)), 1e-15);
  EXPECT_EQ(sky->GetEnvironmentRotation(), -720.5);
}

TEST(Sky, AMapBecomesLights)
{
  vtkNew<vtkBrumeSky> sky;
  std::vector<brume::Light> lights(2);
  EXPECT_EQ(sky->AppendEnvironmentLights(lights), "");
  EXPECT_EQ(lights.size(), 2u);
  const auto map = map_of(32, 16, 4); // the fourth component is not read
  sky->SetEnvironmentMap(map);
  sky->SetUp(0, 1, 0);
  sky->SetEnvironmentRotation(30);
  sky->SetNumberOfEnvironmentLights(5);
  EXPECT_EQ(sky->AppendEnvironmentLights(lights), "");
  ASSERT_EQ(lights.size(), 7u);
  brume::EnvironmentMap plain;
  plain.width = 32;
  plain.height = 16;
  for (int i = 0; i < 32 * 16; ++i)
  {
    for (int c = 0; c < 3; ++c)
    {
      plain.rgb.push_back(float(map->GetPointData()->GetScalars()->GetComponent(i, c)));
    }
  }
  const std::vector<brume::Light> expected = brume::environment_lights(
    plain, 5, brume::world_from_environment(glm::dvec3(0.0, 1.0, 0.0), 30.0));
  for (int i = 0; i < 5; ++i)
  {
    EXPECT_EQ(lights[2 + i].diffuse, expected[i].diffuse);
    EXPECT_EQ(lights[2 + i].direction, expected[i].direction);
  }
}

TEST(Sky, LightsFollowTheMapAndTheSettings)
{
  vtkNew<vtkBrumeSky> sky;
  const auto map = map_of(8, 4);
  sky->SetEnvironmentMap(map);
  sky->SetNumberOfEnvironmentLights(1);
  const auto light = [&]
  {
    std::vector<brume::Light> lights;
    EXPECT_EQ(sky->AppendEnvironmentLights(lights), "");
    EXPECT_EQ(lights.size(), 1u);
    return lights.at(0);
  };
  const brume::Light first = light();
  EXPECT_EQ(light().diffuse, first.diffuse);
  sky->SetEnvironmentRotation(90);
  EXPECT_GT(glm::length(light().direction - first.direction), 0.01);
  EXPECT_EQ(light().diffuse, first.diffuse);
  auto* pixels = static_cast<float*>(map->GetScalarPointer());
  for (int i = 0; i < 8 * 4 * 3; ++i)
  {
    pixels[i] *= 2.0f;
  }
  const vtkMTimeType before = sky->GetMTime();
  map->GetPointData()->GetScalars()->Modified();
  EXPECT_GT(sky->GetMTime(), before);
  EXPECT_EQ(light().diffuse, 2.0 * first.diffuse);
}

TEST(Sky, RefusesAMapThatIsNoPicture)
{
  vtkNew<vtkBrumeSky> sky;
  std::vector<brume::Light> lights;
  const auto expect_refused = [&](vtkImageData* map)
  {
    sky->SetEnvironmentMap(map);
    EXPECT_NE(sky->AppendEnvironmentLights(lights).find("SetEnvironmentMap"), std::string::npos);
    EXPECT_NE(sky->AppendEnvironmentLights(lights), "") << "and again";
    EXPECT_TRUE(lights.empty());
  };
  expect_refused(map_of(8, 4, 1));
  vtkNew<vtkImageData> empty;
  expect_refused(empty);
  vtkNew<vtkImageData> deep;
  deep->SetDimensions(8, 4, 2);
  deep->AllocateScalars(VTK_FLOAT, 3);
  expect_refused(deep);
  sky->SetEnvironmentMap(map_of(8, 4));
  EXPECT_EQ(sky->AppendEnvironmentLights(lights), "");
  EXPECT_FALSE(lights.empty());
}

TEST(Sky, PrintsEverySetting)
{
  vtkNew<vtkBrumeSky> sky;
  EXPECT_NE(printed(sky).find("EnvironmentMap: (none)"), std::string::npos);
  sky->SetEnvironmentMap(map_of(8, 4));
  const std::string text = printed(sky);
  for (const char* words : { "SkyRadiance: 0 0 0",
         "GroundRadiance: 0 0 0",
         "Up: 0 0 1",
         "EnvironmentMap: 8 x 4 pixels",
         "EnvironmentRotation: 0",
         "NumberOfEnvironmentLights: 16" })
  {
    EXPECT_NE(text.find(words), std::string::npos) << words << "\n" << text;
  }
}

// vtkBrumeEffectPlan. --------------------------------------------------------------------------

TEST(EffectPlan, NamesEveryEffectOnce)
{
  ASSERT_EQ(vtkBrumeEffectPlan::GetNumberOfEffects(), brume::effect_count);
  for (int i = 0; i < brume::effect_count; ++i)
  {
    const std::string name = vtkBrumeEffectPlan::GetEffectName(i);
    EXPECT_EQ(name, brume::effect_name(static_cast<brume::Effect>(i)));
    EXPECT_EQ(vtkBrumeEffectPlan::GetEffectIndex(name.c_str()), i);
  }
  EXPECT_EQ(vtkBrumeEffectPlan::GetEffectIndex("phase-anisotropy"), 3);
  EXPECT_EQ(vtkBrumeEffectPlan::GetEffectIndex("Phase_Anisotropy"), 3);
  EXPECT_EQ(vtkBrumeEffectPlan::GetEffectIndex("phase anisotropy "), -1);
  EXPECT_EQ(vtkBrumeEffectPlan::GetEffectIndex(""), -1);
  EXPECT_EQ(vtkBrumeEffectPlan::GetEffectIndex(nullptr), -1);
  EXPECT_EQ(vtkBrumeEffectPlan::GetEffectName(-1), nullptr);
  EXPECT_EQ(vtkBrumeEffectPlan::GetEffectName(brume::effect_count), nullptr);
}

TEST(EffectPlan, TellsWhatWasPlanned)
{
  vtkNew<vtkBrumeEffectPlan> plan;
  EXPECT_FALSE(plan->GetPlanned());
  EXPECT_TRUE(plan->GetEffectOn("shadows"));
  EXPECT_EQ(plan->GetErrorBound(), 0.0);
  brume::EffectPlan settled;
  for (int i = 0; i < brume::effect_count; ++i)
  {
    settled.effects[i].effect = static_cast<brume::Effect>(i);
    settled.effects[i].reason = "reason " + std::to_string(i);
  }
  auto& shadows = settled.effects[int(brume::Effect::Shadows)];
  shadows.on = false;
  shadows.forced = true;
  shadows.error_bound = 0.25;
  const vtkMTimeType time = plan->GetMTime();
  plan->SetPlan(settled);
  EXPECT_EQ(plan->GetMTime(), time);
  EXPECT_TRUE(plan->GetPlanned());
  EXPECT_FALSE(plan->GetEffectOn("shadows"));
  EXPECT_TRUE(plan->GetEffectForced("shadows"));
  EXPECT_EQ(plan->GetEffectErrorBound("shadows"), 0.25);
  EXPECT_STREQ(plan->GetEffectReason("shadows"), "reason 5");
  EXPECT_TRUE(plan->GetEffectOn("absorption"));
  EXPECT_FALSE(plan->GetEffectForced("absorption"));
  EXPECT_EQ(plan->GetErrorBound(), 0.25);
  for (int none : { -1, brume::effect_count })
  {
    EXPECT_FALSE(plan->GetEffectOn(none));
    EXPECT_FALSE(plan->GetEffectForced(none));
    EXPECT_STREQ(plan->GetEffectReason(none), "");
    EXPECT_EQ(plan->GetEffectErrorBound(none), 0.0);
  }
  EXPECT_FALSE(plan->GetEffectOn("no such"));
  EXPECT_STREQ(plan->GetEffectReason("no such"), "");
  const std::string text = printed(plan);
  EXPECT_NE(text.find("shadows: Off (forced), at most 0.25: reason 5"), std::string::npos) << text;
  EXPECT_NE(text.find("Planned: Yes"), std::string::npos);
}

TEST(EffectPlan, TakesOrders)
{
  vtkNew<vtkBrumeEffectPlan> plan;
  Ear ear(plan);
  EXPECT_TRUE(plan->GetForces().empty());
  const vtkMTimeType time = plan->GetMTime();
  EXPECT_TRUE(plan->Force("silver-lining", false));
  EXPECT_TRUE(plan->Force("SHADOWS", true));
  EXPECT_GT(plan->GetMTime(), time);
  const vtkMTimeType forced = plan->GetMTime();
  EXPECT_TRUE(plan->Force("shadows", true));
  EXPECT_EQ(plan->GetMTime(), forced);
  const std::map<brume::Effect, bool> expected{ { brume::Effect::SilverLining, false },
    { brume::Effect::Shadows, true } };
  EXPECT_EQ(plan->GetForces(), expected);
  EXPECT_EQ(ear.warnings, 0);
  EXPECT_FALSE(plan->Force("shadow", true));
  EXPECT_NE(ear.last.find("name one of absorption, emission"), std::string::npos) << ear.last;
  EXPECT_FALSE(plan->Force(nullptr, true));
  EXPECT_EQ(ear.warnings, 2);
  EXPECT_EQ(plan->GetForces(), expected);
  EXPECT_NE(printed(plan).find("silver lining: Off"), std::string::npos);
  plan->ForceNothing();
  EXPECT_TRUE(plan->GetForces().empty());
  EXPECT_GT(plan->GetMTime(), forced);
}

}
