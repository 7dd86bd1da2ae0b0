// What the mapper makes of a medium, a sky and lights: the scene itself, before any ray is marched.
#include "../support/sparse_grids.h"
#include "../support/vtk_scenes.h"

#include "vtkBrumeEffectPlan.h"
#include "vtkBrumeMedium.h"
#include "vtkBrumeRayMarchMapper.h"
#include "vtkBrumeSky.h"
#include "vtkBrumeSparseVolume.h"

#include "Transport/scene.h"

#include "vtkCallbackCommand.h"
#include "vtkCommand.h"
#include "vtkFloatArray.h"
#include "vtkLight.h"
#include "vtkLightCollection.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include <string>
#include <vector>

using namespace vtk_scenes;

namespace
{

struct Stage
{
  vtkSmartPointer<vtkVolume> volume = volume_of();
  vtkNew<vtkBrumeRayMarchMapper> mapper;
  vtkNew<vtkBrumeMedium> medium;
  vtkNew<vtkBrumeSky> sky;
  vtkNew<vtkCamera> camera;
  vtkSmartPointer<vtkLightCollection> lights;
  vtkNew<vtkCallbackCommand> ear;
  std::vector<std::string> messages;

  explicit Stage(vtkDataObject* input, bool with_medium = true)
  {
    ear->SetClientData(&messages);
    ear->SetCallback(
      [](vtkObject*, unsigned long, void* messages, void* text)
      {
        static_cast<std::vector<std::string>*>(messages)->emplace_back(
          static_cast<const char*>(text));
      });
    mapper->AddObserver(vtkCommand::ErrorEvent, ear);
    mapper->AddObserver(vtkCommand::WarningEvent, ear);
    mapper->SetInputDataObject(input);
    mapper->SetMedium(with_medium ? medium.Get() : nullptr);
    volume->SetMapper(mapper);
    const double centre[3] = { 10, 10, 10 };
    look_at(camera, centre, 100.0);
  }
  const brume::Scene& scene()
  {
    const brume::Scene* updated = mapper->UpdateScene(volume, camera, lights, 8, 8);
    static const brume::Scene none;
    EXPECT_NE(updated, nullptr) << said();
    EXPECT_NO_THROW(updated ? updated->validate() : none.validate());
    return updated ? *updated : none;
  }
  const brume::Volume& first() { return scene().volumes[0]; }
  std::string said() const { return messages.empty() ? "" : messages.back(); }
  void refuses(const char* words)
  {
    messages.clear();
    EXPECT_EQ(mapper->UpdateScene(volume, camera, lights, 8, 8), nullptr) << words;
    EXPECT_NE(said().find(words), std::string::npos) << said();
  }
};

/// A ball with two arrays more: "soot", half of it, and "kelvins" of a type, which grow along x and
/// y.
vtkSmartPointer<vtkImageData> burning_ball(int type = VTK_FLOAT, bool cells = false, int nx = 20)
{
  const auto value = [nx](int i, int j, int k, int)
  { return ball(2.0 * (i + 0.5) / nx - 1, 2.0 * j / 16 - 1, 2.0 * k / 21 - 1); };
  auto data = image(nx, 17, 22, VTK_SHORT, value, 1, cells);
  const auto other = [&](const char* name, int array_type, auto f)
  {
    const auto more = image(nx, 17, 22, array_type, f, 1, cells);
    vtkDataSetAttributes* from = cells ? static_cast<vtkDataSetAttributes*>(more->GetCellData())
                                       : static_cast<vtkDataSetAttributes*>(more->GetPointData());
    vtkDataSetAttributes* to = cells ? static_cast<vtkDataSetAttributes*>(data->GetCellData())
                                     : static_cast<vtkDataSetAttributes*>(data->GetPointData());
    from->GetScalars()->SetName(name);
    to->AddArray(from->GetScalars());
  };
  other(
    "soot", VTK_UNSIGNED_CHAR, [&](int i, int j, int k, int c) { return 0.5 * value(i, j, k, c); });
  other("kelvins", type, [](int i, int j, int, int) { return 100.0 * (i + 1) + j; });
  return data;
}

vtkSmartPointer<vtkBrumeSparseVolume> sparse_ball()
{
  auto volume = vtkSmartPointer<vtkBrumeSparseVolume>::New();
  volume->SetVoxels(sparse_grids::make_sparse(brume::VoxelType::Float32,
    { { 0, 0, 0 } },
    { { 20, 20, 20 } },
    0.0,
    [](int i, int j, int k)
    {
      const double v = ball(0.1 * i - 1, 0.1 * j - 1, 0.1 * k - 1);
      return v < 5.0 ? 0.0 : v;
    }));
  return volume;
}

vtkSmartPointer<vtkImageData> map_of(float red)
{
  auto map = vtkSmartPointer<vtkImageData>::New();
  map->SetDimensions(8, 4, 1);
  map->AllocateScalars(VTK_FLOAT, 3);
  map->GetPointData()->GetScalars()->Fill(red);
  return map;
}

// What the values are. -------------------------------------------------------------------------

TEST(SceneMedium, WithoutOneNothingIsLit)
{
  Stage stage(burning_ball(), false);
  const brume::Scene& scene = stage.scene();
  EXPECT_FALSE(scene.volumes[0].medium.lit);
  EXPECT_EQ(scene.volumes[0].meaning, brume::ValueMeaning::Classified);
  EXPECT_EQ(scene.volumes[0].density.channels, glm::dvec3(1.0));
  EXPECT_EQ(scene.sky.radiance, glm::dvec3(0.0));
  EXPECT_EQ(scene.lights.size(), 1u);
  EXPECT_EQ(stage.mapper->GetMedium(), nullptr);
  EXPECT_EQ(stage.mapper->GetSky(), nullptr);
  EXPECT_NE(stage.mapper->GetEffectPlan(), nullptr);
  EXPECT_TRUE(stage.messages.empty()) << stage.said();
}

TEST(SceneMedium, SettingsArriveWhole)
{
  Stage stage(burning_ball());
  stage.medium->SetAlbedo(0.9, 0.8, 0.7);
  stage.medium->AddHenyeyGreensteinLobe(2.0, 0.6);
  stage.medium->AddRayleighLobe(1.0);
  stage.medium->SetNumberOfOctaves(5);
  stage.medium->SetEmission(1, 2, 3);
  stage.medium->SilverLiningOn();
  stage.medium->PowderOn();
  brume::Medium expected;
  stage.medium->FillMedium(expected);
  const brume::Medium& m = stage.first().medium;
  EXPECT_TRUE(m.lit);
  EXPECT_EQ(m.albedo, expected.albedo);
  ASSERT_EQ(m.lobes.size(), 2u);
  EXPECT_EQ(m.lobes[0].anisotropy, 0.6);
  EXPECT_EQ(m.octaves.count, 5);
  EXPECT_EQ(m.emission, glm::dvec3(1, 2, 3));
  EXPECT_TRUE(m.silver_lining.enabled);
  EXPECT_TRUE(m.powder.enabled);
  EXPECT_EQ(m.temperature.voxels, nullptr);
}

TEST(SceneMedium, AnExtinctionMakesTheValuesADensityByChannel)
{
  Stage stage(burning_ball());
  EXPECT_EQ(stage.first().meaning, brume::ValueMeaning::Classified);
  stage.medium->SetExtinction(0.1, 0.4, 0.2);
  const brume::Volume& v = stage.first();
  EXPECT_EQ(v.meaning, brume::ValueMeaning::Density);
  EXPECT_EQ(v.density.extinction, 0.4);
  EXPECT_LT(glm::length(v.density.channels - glm::dvec3(0.25, 1.0, 0.5)), 1e-15);
  // It counts before the mapper's own, which counts where the medium has none.
  stage.mapper->SetExtinction(7.0);
  EXPECT_EQ(stage.first().density.extinction, 0.4);
  stage.medium->SetExtinction(0.0);
  EXPECT_EQ(stage.first().meaning, brume::ValueMeaning::Density);
  EXPECT_EQ(stage.first().density.extinction, 7.0);
  EXPECT_EQ(stage.first().density.channels, glm::dvec3(1.0));
  EXPECT_TRUE(stage.first().medium.lit);
  stage.mapper->SetExtinction(0.0);
  EXPECT_EQ(stage.first().meaning, brume::ValueMeaning::Classified);
}

TEST(SceneMedium, EveryComponentIsLit)
{
  Stage stage(image(
    5, 6, 7, VTK_SHORT, [](int i, int j, int k, int c) { return (1 + c) * (i + j + k); }, 3));
  stage.medium->SetAlbedo(0.5);
  for (const brume::Volume& v : stage.scene().volumes)
  {
    EXPECT_TRUE(v.medium.lit);
    EXPECT_EQ(v.medium.albedo, glm::dvec3(0.5));
  }
}

TEST(SceneMedium, ADensityMayBeAnotherArray)
{
  const auto data = burning_ball();
  Stage stage(data);
  EXPECT_EQ(stage.first().grid.type, brume::VoxelType::Int16);
  stage.medium->SetDensityArrayName("soot");
  const brume::Volume& v = stage.first();
  EXPECT_EQ(v.grid.type, brume::VoxelType::UInt8);
  EXPECT_EQ(v.grid.voxels, data->GetPointData()->GetArray("soot")->GetVoidPointer(0));
  EXPECT_FLOAT_EQ(v.ranges->upper, float(data->GetPointData()->GetArray("soot")->GetRange()[1]));
  stage.medium->SetDensityArrayName("sot");
  stage.refuses("the input's points have no array 'sot'");
  EXPECT_NE(stage.said().find("one of theirs: values, soot, kelvins"), std::string::npos)
    << stage.said();
  stage.medium->SetDensityArrayName(nullptr);
  EXPECT_EQ(stage.first().grid.type, brume::VoxelType::Int16);
}

TEST(SceneMedium, ASparseVolumeHasNoArrays)
{
  Stage stage(sparse_ball());
  stage.medium->SetExtinction(0.1);
  EXPECT_TRUE(stage.first().medium.lit);
  stage.medium->SetDensityArrayName("soot");
  stage.refuses("a sparse volume has one grid and no array 'soot'");
  stage.medium->SetDensityArrayName(nullptr);
  stage.medium->SetBlackBody(1.0);
  stage.medium->SetTemperatureArrayName("kelvins");
  stage.refuses("a sparse volume has no temperatures");
}

// Temperatures. --------------------------------------------------------------------------------

TEST(SceneMedium, TemperaturesLieOnTheVoxelsLattice)
{
  for (int type : { VTK_FLOAT, VTK_DOUBLE, VTK_SHORT, VTK_UNSIGNED_INT })
  {
    for (bool cells : { false, true })
    {
      for (int nx : { 20, 1 }) // one voxel along x is padded to two
      {
        SCOPED_TRACE(std::to_string(type) + (cells ? " cells " : " points ") + std::to_string(nx));
        const auto data = burning_ball(type, cells, nx);
        Stage stage(data);
        stage.medium->SetTemperatureArrayName("kelvins");
        EXPECT_EQ(stage.first().medium.temperature.voxels, nullptr) << "nothing glows yet";
        stage.medium->SetBlackBody(2.0);
        stage.medium->SetTemperatureScale(3.0);
        const brume::Volume& v = stage.first();
        const brume::Grid& t = v.medium.temperature;
        EXPECT_EQ(v.medium.black_body, 2.0);
        EXPECT_EQ(v.medium.temperature_scale, 3.0);
        ASSERT_NE(t.voxels, nullptr);
        ASSERT_EQ(t.type, brume::VoxelType::Float32);
        EXPECT_EQ(t.components, 1);
        EXPECT_EQ(t.component, 0);
        EXPECT_EQ(t.cell_centred, v.grid.cell_centred);
        EXPECT_EQ(t.padding_x, v.grid.padding_x);
        EXPECT_EQ(t.linear, v.grid.linear);
        for (int axis = 0; axis < 3; ++axis)
        {
          EXPECT_EQ(t.dims[axis], v.grid.dims[axis]);
        }
        EXPECT_NO_THROW(t.validate());
        const auto* voxels = static_cast<const float*>(t.voxels);
        for (int j : { 0, 16 })
        {
          for (int i = 0; i < t.dims[0]; ++i)
          {
            EXPECT_EQ(voxels[j * t.dims[0] + i], 100.0f * (std::min(i, nx - 1) + 1) + j);
          }
        }
        if (type == VTK_FLOAT && nx > 1 && !cells)
        {
          EXPECT_EQ(t.voxels, data->GetPointData()->GetArray("kelvins")->GetVoidPointer(0));
        }
        stage.volume->GetProperty()->SetInterpolationTypeToNearest();
        EXPECT_FALSE(stage.first().medium.temperature.linear);
      }
    }
  }
}

TEST(SceneMedium, BlackBodiesNeedTemperatures)
{
  const auto data = burning_ball();
  Stage stage(data);
  stage.medium->SetBlackBody(1.0);
  stage.refuses("SetTemperatureArrayName");
  stage.medium->SetTemperatureArrayName("heat");
  stage.refuses("the input's points have no array 'heat'");
  EXPECT_NE(stage.said().find("values, soot, kelvins"), std::string::npos) << stage.said();
  vtkNew<vtkFloatArray> vectors;
  vectors->SetName("heat");
  vectors->SetNumberOfComponents(3);
  vectors->SetNumberOfTuples(data->GetNumberOfPoints());
  data->GetPointData()->AddArray(vectors);
  stage.refuses("of 3 components");
  stage.medium->SetTemperatureArrayName("kelvins");
  EXPECT_NE(stage.first().medium.temperature.voxels, nullptr);
  stage.medium->SetBlackBody(0.0);
  EXPECT_EQ(stage.first().medium.temperature.voxels, nullptr);
}

// Lights. --------------------------------------------------------------------------------------

TEST(SceneMedium, SkyAndEnvironmentAreThereWithAMedium)
{
  Stage stage(burning_ball());
  stage.sky->SetSkyRadiance(1, 2, 3);
  stage.sky->SetGroundRadiance(0.5, 0.25, 0.125);
  stage.sky->SetUp(0, 2, 0);
  stage.mapper->SetSky(stage.sky);
  const brume::Scene& scene = stage.scene();
  EXPECT_EQ(scene.sky.radiance, glm::dvec3(1, 2, 3));
  EXPECT_EQ(scene.sky.ground, glm::dvec3(0.5, 0.25, 0.125));
  EXPECT_EQ(scene.sky.up, glm::dvec3(0, 1, 0));
  EXPECT_EQ(scene.lights.size(), 1u); // the headlight
  stage.sky->SetNumberOfEnvironmentLights(4);
  stage.sky->SetEnvironmentMap(map_of(2.0f));
  EXPECT_EQ(stage.scene().lights.size(), 5u);
  EXPECT_EQ(stage.scene().lights.size(), 5u) << "and no more the second time";
  double irradiance = 0.0;
  for (std::size_t i = 1; i < 5; ++i)
  {
    irradiance += std::acos(-1.0) * stage.scene().lights[i].diffuse.x;
  }
  EXPECT_NEAR(irradiance, 2.0 * 4.0 * std::acos(-1.0), 1e-6);
  vtkNew<vtkImageData> wrong;
  stage.sky->SetEnvironmentMap(wrong);
  stage.refuses("SetEnvironmentMap");
  stage.mapper->SetSky(nullptr);
  EXPECT_EQ(stage.scene().sky.radiance, glm::dvec3(0.0));
  EXPECT_EQ(stage.scene().lights.size(), 1u);
}

TEST(SceneMedium, EveryLightThatIsOnLights)
{
  Stage stage(burning_ball());
  stage.lights = vtkSmartPointer<vtkLightCollection>::New();
  vtkNew<vtkLight> sun;
  sun->SetLightTypeToSceneLight();
  sun->SetPosition(0, 0, 5);
  sun->SetFocalPoint(0, 0, 0);
  sun->SetColor(1.0, 0.5, 0.25);
  sun->SetIntensity(3.0);
  vtkNew<vtkLight> lamp;
  lamp->SetLightTypeToSceneLight();
  lamp->PositionalOn();
  lamp->SetPosition(1, 2, 3);
  lamp->SetAttenuationValues(0, 0, 1);
  lamp->SetConeAngle(20);
  lamp->SetExponent(4);
  vtkNew<vtkLight> off;
  off->SwitchOff();
  stage.lights->AddItem(sun);
  stage.lights->AddItem(off);
  stage.lights->AddItem(lamp);
  const std::vector<brume::Light> lights = stage.scene().lights;
  ASSERT_EQ(lights.size(), 2u);
  EXPECT_EQ(lights[0].diffuse, glm::dvec3(3.0, 1.5, 0.75));
  EXPECT_EQ(lights[0].direction, glm::dvec3(0, 0, -1));
  EXPECT_FALSE(lights[0].positional);
  EXPECT_TRUE(lights[1].positional);
  EXPECT_EQ(lights[1].position, glm::dvec3(1, 2, 3));
  EXPECT_EQ(lights[1].attenuation, glm::dvec3(0, 0, 1));
  EXPECT_EQ(lights[1].cone_angle, 20);
  EXPECT_EQ(lights[1].exponent, 4);
  sun->SwitchOff();
  lamp->SwitchOff();
  EXPECT_TRUE(stage.scene().lights.empty());
}

// What is ignored. -----------------------------------------------------------------------------

TEST(SceneMedium, IsIgnoredWithOneWarningWhereThereIsNoLightInMatter)
{
  Stage stage(burning_ball());
  stage.medium->SetExtinction(0.1);
  stage.medium->SetDensityArrayName("soot");
  stage.mapper->SetSky(stage.sky);
  stage.scene();
  EXPECT_TRUE(stage.messages.empty()) << stage.said();
  for (int mode : { vtkVolumeMapper::MAXIMUM_INTENSITY_BLEND, vtkVolumeMapper::ADDITIVE_BLEND })
  {
    stage.mapper->SetBlendMode(mode);
    const brume::Volume& v = stage.first();
    EXPECT_FALSE(v.medium.lit);
    EXPECT_EQ(v.meaning, brume::ValueMeaning::Classified);
    EXPECT_EQ(v.grid.type, brume::VoxelType::Int16);
  }
  ASSERT_EQ(stage.messages.size(), 1u);
  EXPECT_NE(stage.said().find("Medium in a blend mode other than composite is not supported"),
    std::string::npos)
    << stage.said();
  stage.mapper->SetBlendModeToComposite();
  EXPECT_TRUE(stage.first().medium.lit);
  stage.mapper->SetMedium(nullptr);
  stage.scene();
  stage.scene();
  ASSERT_EQ(stage.messages.size(), 2u);
  EXPECT_NE(stage.said().find("Sky without a Medium"), std::string::npos) << stage.said();
}

// What is kept. --------------------------------------------------------------------------------

TEST(SceneMedium, OnlyWhatChangesMatterChangesRevisions)
{
  const auto data = burning_ball();
  Stage stage(data);
  stage.medium->SetExtinction(0.1);
  stage.mapper->SetSky(stage.sky);
  stage.lights = vtkSmartPointer<vtkLightCollection>::New();
  vtkNew<vtkLight> sun;
  stage.lights->AddItem(sun);
  std::uint64_t voxels = stage.first().data_revision;
  std::uint64_t medium = stage.first().medium_revision;
  const auto changed = [&](bool data_too, bool medium_too, const char* what)
  {
    const brume::Volume& v = stage.first();
    EXPECT_EQ(v.data_revision != voxels, data_too) << what;
    EXPECT_EQ(v.medium_revision != medium, medium_too) << what;
    voxels = v.data_revision;
    medium = v.medium_revision;
  };
  stage.medium->SetAlbedo(0.5);
  stage.medium->SetAnisotropy(0.8);
  stage.medium->AddRayleighLobe(0.5);
  stage.medium->SetNumberOfOctaves(4);
  stage.medium->SetEmission(1.0);
  stage.medium->SilverLiningOn();
  stage.medium->PowderOn();
  sun->SetPosition(1, 2, 3);
  sun->SetIntensity(2);
  stage.sky->SetSkyRadiance(1, 1, 1);
  stage.sky->SetEnvironmentMap(map_of(1.0f));
  changed(false, false, "light");
  stage.medium->SetExtinction(0.2);
  changed(false, true, "extinction");
  stage.medium->SetExtinction(0.2, 0.1, 0.2);
  changed(false, true, "a channel's extinction");
  stage.medium->SetTemperatureArrayName("kelvins");
  changed(false, false, "temperatures that nobody reads");
  stage.medium->SetBlackBody(1.0);
  changed(false, true, "temperatures");
  stage.medium->SetBlackBody(2.0);
  changed(false, false, "how much glows");
  data->GetPointData()->GetArray("kelvins")->SetComponent(0, 0, 7000.0);
  data->GetPointData()->GetArray("kelvins")->Modified();
  EXPECT_EQ(static_cast<const float*>(stage.first().medium.temperature.voxels)[0], 7000.0f);
  medium = stage.first().medium_revision;
  voxels = stage.first().data_revision;
  stage.medium->SetDensityArrayName("soot");
  changed(true, true, "another array");
  stage.medium->SetExtinction(0.0);
  changed(false, true, "classified");
  stage.mapper->SetMedium(nullptr);
  changed(true, true, "no medium: the first array again");
}

TEST(SceneMedium, TheMapperChangesWithWhatItHas)
{
  Stage stage(burning_ball());
  stage.mapper->SetSky(stage.sky);
  const auto map = map_of(1.0f);
  stage.sky->SetEnvironmentMap(map);
  vtkMTimeType time = stage.mapper->GetMTime();
  const auto grows = [&](const char* what)
  {
    EXPECT_GT(stage.mapper->GetMTime(), time) << what;
    time = stage.mapper->GetMTime();
  };
  stage.medium->SetAlbedo(0.5);
  grows("medium");
  stage.sky->SetSkyRadiance(1, 1, 1);
  grows("sky");
  map->GetPointData()->GetScalars()->Modified();
  grows("map");
  stage.mapper->GetEffectPlan()->Force("shadows", false);
  grows("forces");
  stage.mapper->SetSky(nullptr);
  grows("no sky");
  stage.mapper->SetSky(nullptr);
  EXPECT_EQ(stage.mapper->GetMTime(), time);
  stage.mapper->SetMedium(nullptr);
  grows("no medium");
}

TEST(SceneMedium, ShadowSettingsKeepTheirRanges)
{
  vtkNew<vtkBrumeRayMarchMapper> mapper;
  std::vector<std::string> messages;
  vtkNew<vtkCallbackCommand> ear;
  ear->SetClientData(&messages);
  ear->SetCallback([](vtkObject*, unsigned long, void* list, void* text)
    { static_cast<std::vector<std::string>*>(list)->emplace_back(static_cast<char*>(text)); });
  mapper->AddObserver(vtkCommand::WarningEvent, ear);
  EXPECT_EQ(mapper->GetShadowMethod(), vtkBrumeRayMarchMapper::AutomaticShadows);
  EXPECT_EQ(mapper->GetShadowSampleDistance(), 0.0);
  mapper->SetShadowMethod(99);
  EXPECT_EQ(mapper->GetShadowMethod(), vtkBrumeRayMarchMapper::FunctionShadows);
  mapper->SetShadowMethodToRays();
  mapper->SetShadowSampleDistance(0.25);
  for (double bad : { -1.0, std::nan(""), HUGE_VAL })
  {
    mapper->SetShadowSampleDistance(bad);
  }
  EXPECT_EQ(mapper->GetShadowSampleDistance(), 0.25);
  EXPECT_EQ(messages.size(), 3u);
  std::ostringstream text;
  mapper->PrintSelf(text, vtkIndent());
  for (const char* words :
    { "ShadowMethod: rays", "ShadowSampleDistance: 0.25", "Medium: ", "Sky: ", "EffectPlan:" })
  {
    EXPECT_NE(text.str().find(words), std::string::npos) << words;
  }
}

}
