// Settings of the stock mappers that are not followed warn once, by name; and docs/user/drop-in.md
// names every setting that the stock mappers have.
#include "../support/vtk_scenes.h"

#include "vtkBrumeRayMarchMapper.h"

#include "vtkCallbackCommand.h"
#include "vtkCommand.h"
#include "vtkFloatArray.h"
#include "vtkPlane.h"
#include "vtkVersion.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <functional>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

using namespace vtk_scenes;

namespace
{

struct Stage
{
  vtkSmartPointer<vtkVolume> volume = volume_of();
  vtkNew<vtkBrumeRayMarchMapper> mapper;
  vtkNew<vtkCamera> camera;
  std::vector<std::string> warnings;

  explicit Stage(int components = 1)
  {
    vtkNew<vtkCallbackCommand> listen;
    listen->SetClientData(this);
    listen->SetCallback([](vtkObject*, unsigned long, void* self, void* text)
      { static_cast<Stage*>(self)->warnings.emplace_back(static_cast<const char*>(text)); });
    mapper->AddObserver(vtkCommand::WarningEvent, listen);
    mapper->AddObserver(vtkCommand::ErrorEvent, listen);
    mapper->SetInputData(image(6, 6, 6, VTK_UNSIGNED_CHAR,
      [](int i, int, int, int) { return 30.0 * i; }, components));
    volume->SetMapper(mapper);
    look_at(camera, volume->GetCenter(), 20.0);
    camera->SetClippingRange(1, 60);
  }
  vtkVolumeProperty* property() { return volume->GetProperty(); }
  void draw()
  {
    brume::Scene const* scene = mapper->UpdateScene(volume, camera, nullptr, 8, 8);
    ASSERT_NE(scene, nullptr);
  }
  int told(const std::string& name) const
  {
    int count = 0;
    for (const std::string& warning : warnings)
    {
      count += warning.find(name + " is not supported and is ignored") != std::string::npos;
    }
    return count;
  }
};

struct Ignored
{
  std::string name;
  std::function<void(Stage&)> set;
  std::function<void(Stage&)> again; ///< another value that is not followed either
  int components = 1;
};

void give_label(Stage& stage)
{
  vtkNew<vtkPiecewiseFunction> function;
  function->AddPoint(0, 0.5);
  vtkNew<vtkColorTransferFunction> colour;
  colour->AddRGBPoint(0, 1, 0, 0);
  stage.property()->SetLabelScalarOpacity(1, function);
  stage.property()->SetLabelColor(1, colour);
  stage.mapper->SetMaskInput(
    image(6, 6, 6, VTK_UNSIGNED_CHAR, [](int i, int, int, int) { return i % 2; }));
}

void give_2d_function(Stage& stage)
{
  vtkNew<vtkImageData> function;
  function->SetDimensions(2, 2, 1);
  function->AllocateScalars(VTK_FLOAT, 4);
  function->GetPointData()->GetScalars()->Fill(0.5);
  stage.property()->SetTransferFunction2D(0, function);
}

std::vector<Ignored> all_ignored()
{
  const auto nothing = [](Stage&) {};
  std::vector<Ignored> all = {
    { "InteractiveSampleDistance", [](Stage& s) { s.mapper->SetInteractiveSampleDistance(4); },
      [](Stage& s) { s.mapper->SetInteractiveSampleDistance(5); } },
    { "UseDepthPass", [](Stage& s) { s.mapper->UseDepthPassOn(); }, nothing },
    { "MaxMemoryInBytes", [](Stage& s) { s.mapper->SetMaxMemoryInBytes(1000); }, nothing },
    { "MaxMemoryFraction", [](Stage& s) { s.mapper->SetMaxMemoryFraction(0.3f); }, nothing },
    { "RenderToImage", [](Stage& s) { s.mapper->RenderToImageOn(); }, nothing },
    { "DepthImageScalarType",
      [](Stage& s) { s.mapper->SetDepthImageScalarTypeToUnsignedChar(); },
      [](Stage& s) { s.mapper->SetDepthImageScalarTypeToUnsignedShort(); } },
    { "ClampDepthToBackface", [](Stage& s) { s.mapper->ClampDepthToBackfaceOn(); }, nothing },
    { "Transfer2DYAxisArray", [](Stage& s) { s.mapper->SetTransfer2DYAxisArray("y"); }, nothing },
    { "Partitions", [](Stage& s) { s.mapper->SetPartitions(2, 1, 1); },
      [](Stage& s) { s.mapper->SetPartitions(2, 2, 2); } },
    { "ScalarOpacityRangeType",
      [](Stage& s)
      {
        s.mapper->SetScalarOpacityRangeType(vtkBrumeRayMarchMapper::NATIVE);
        s.property()->GetScalarOpacity()->ClampingOff();
      },
      nothing },
    { "ColorRangeType",
      [](Stage& s)
      {
        s.mapper->SetColorRangeType(vtkBrumeRayMarchMapper::NATIVE);
        s.property()->GetRGBTransferFunction()->ClampingOff();
      },
      nothing },
    { "GradientOpacityRangeType",
      [](Stage& s) { s.mapper->SetGradientOpacityRangeType(vtkBrumeRayMarchMapper::NATIVE); },
      nothing },
    { "UseClippedVoxelIntensity",
      [](Stage& s) { s.property()->UseClippedVoxelIntensityOn(); }, nothing },
    { "TransferFunctionMode TF_2D of dependent components",
      [](Stage& s)
      {
        s.property()->IndependentComponentsOff();
        give_2d_function(s);
      },
      nothing, 2 },
    { "MaskInput as a label map of independent components", give_label, nothing, 2 },
    { "MaskInput as a label map with TransferFunctionMode TF_2D",
      [](Stage& s)
      {
        give_label(s);
        give_2d_function(s);
      },
      nothing },
    { "LabelColor of four dependent components",
      [](Stage& s)
      {
        s.property()->IndependentComponentsOff();
        give_label(s);
      },
      nothing, 4 },
  };
  return all;
}

TEST(IgnoredSettings, NothingIsToldOfWhatIsFollowed)
{
  Stage stage;
  stage.mapper->SetImageSampleDistance(2.0f);
  stage.mapper->SetMinimumImageSampleDistance(0.5f);
  stage.mapper->SetMaximumImageSampleDistance(5.0f);
  stage.mapper->UseJitteringOn();
  stage.mapper->LockSampleDistanceToInputSpacingOn();
  stage.mapper->SetFinalColorWindow(2.0f);
  stage.mapper->CroppingOn();
  stage.mapper->AddClippingPlane(vtkNew<vtkPlane>());
  stage.mapper->SetBlendModeToMaximumIntensity();
  stage.mapper->SetColorRangeType(vtkBrumeRayMarchMapper::NATIVE);
  stage.mapper->SetScalarOpacityRangeType(vtkBrumeRayMarchMapper::NATIVE);
  stage.property()->SetComponentWeight(0, 0.5);
  give_label(stage);
  stage.draw();
  EXPECT_TRUE(stage.warnings.empty()) << stage.warnings[0];
}

TEST(IgnoredSettings, EachWarnsOnceByName)
{
  for (const Ignored& ignored : all_ignored())
  {
    Stage stage(ignored.components);
    EXPECT_EQ(stage.told(ignored.name), 0) << ignored.name;
    ignored.set(stage);
    stage.draw();
    EXPECT_EQ(stage.told(ignored.name), 1) << ignored.name;
    stage.draw();
    ignored.again(stage);
    stage.camera->Azimuth(3);
    stage.draw();
    EXPECT_EQ(stage.told(ignored.name), 1) << ignored.name;
  }
}

TEST(IgnoredSettings, StatisticsListThemAsLongAsTheyAreSet)
{
  Stage stage;
  const double black[3] = { 0, 0, 0 };
  vtkNew<vtkImageData> picture;
  const auto listed = [&]
  {
    EXPECT_TRUE(
      stage.mapper->RenderImage(stage.volume, stage.camera, nullptr, 8, 8, black, picture));
    return nlohmann::json::parse(stage.mapper->GetStatistics())["ignored_settings"].dump();
  };
  EXPECT_EQ(listed(), "[]");
  stage.mapper->UseDepthPassOn();
  EXPECT_EQ(listed(), "[\"UseDepthPass\"]");
  stage.mapper->UseDepthPassOff();
  EXPECT_EQ(listed(), "[]");
}

std::string text_of(const std::string& file)
{
  std::ifstream in(file);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

// Read from VTK's own headers, so that none is forgotten.
TEST(DropInTable, NamesEverySettingOfTheStockMappers)
{
  const std::string page = text_of(BRUME_SOURCE_FOLDER "/docs/user/drop-in.md");
  ASSERT_FALSE(page.empty());
  std::set<std::string> named;
  const std::regex word("[A-Za-z0-9]+");
  for (std::sregex_iterator it(page.begin(), page.end(), word), end; it != end; ++it)
  {
    named.insert(it->str());
  }
  const std::string folder = BRUME_VTK_HEADERS;
  if (text_of(folder + "/vtkVolumeMapper.h").empty() ||
    std::string(vtkVersion::GetVTKVersion()).substr(0, 3) != "9.1")
  {
    GTEST_SKIP() << "the table is of VTK 9.1, whose headers are not here";
  }
  int seen = 0;
  for (const char* name : { "vtkAbstractVolumeMapper", "vtkVolumeMapper", "vtkVolumeProperty",
         "vtkFixedPointVolumeRayCastMapper", "vtkGPUVolumeRayCastMapper",
         "vtkOpenGLGPUVolumeRayCastMapper" })
  {
    std::string header = text_of(folder + "/" + name + ".h");
    header = header.substr(0, header.find("\nprotected:"));
    const std::regex setter(
      "vtkSet[A-Za-z0-9]*Macro\\(([A-Za-z0-9]+)|(?:void|bool) +Set([A-Za-z0-9]+)\\(|void "
      "+((?:Add|Select|Create)[A-Za-z0-9]+)\\(");
    for (std::sregex_iterator it(header.begin(), header.end(), setter), end; it != end; ++it)
    {
      std::string setting = (*it)[3].matched ? (*it)[3].str()
        : "Set" + ((*it)[1].matched ? (*it)[1].str() : (*it)[2].str());
      // SetFooToBar is a value of SetFoo.
      const std::size_t to = setting.find("To", 4);
      const bool value = to != std::string::npos && named.count(setting.substr(0, to)) > 0;
      EXPECT_TRUE(value || named.count(setting) > 0) << name << "::" << setting;
      ++seen;
    }
  }
  EXPECT_GT(seen, 80);
}

// And of each setting that is ignored with a warning the page says so in its row.
TEST(DropInTable, SaysWhatIsIgnored)
{
  const std::string page = text_of(BRUME_SOURCE_FOLDER "/docs/user/drop-in.md");
  for (const Ignored& ignored : all_ignored())
  {
    const std::string setting = ignored.name.substr(0, ignored.name.find(' '));
    bool said = false;
    std::istringstream lines(page);
    for (std::string line; std::getline(lines, line);)
    {
      said = said ||
        (line.find("Set" + setting) != std::string::npos &&
          line.find("warns") != std::string::npos);
    }
    EXPECT_TRUE(said) << setting;
  }
}

}
