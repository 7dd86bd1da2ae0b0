// The presets: a sound table, the scaling onto a volume's values, and the choice of one.
#include "command.h"
#include "presets.h"

#include <vtkColorTransferFunction.h>
#include <vtkDataArray.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPiecewiseFunction.h>
#include <vtkPointData.h>
#include <vtkShortArray.h>
#include <vtkSmartPointer.h>
#include <vtkUnsignedCharArray.h>
#include <vtkVolumeProperty.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

using namespace brume::app;

namespace
{

/// A cube of n voxels an edge whose values are value(i), i from 0 to n³ - 1.
template <class Array, class Function>
vtkSmartPointer<vtkImageData> cube(int n, double edge, const char* name, Function value)
{
  auto volume = vtkSmartPointer<vtkImageData>::New();
  volume->SetDimensions(n, n, n);
  volume->SetSpacing(edge / (n - 1), edge / (n - 1), edge / (n - 1));
  vtkNew<Array> values;
  values->SetName(name);
  values->SetNumberOfTuples(volume->GetNumberOfPoints());
  for (vtkIdType i = 0; i < values->GetNumberOfTuples(); ++i)
  {
    values->SetComponent(i, 0, value(i));
  }
  volume->GetPointData()->SetScalars(values);
  return volume;
}

/// Whole numbers in Hounsfield units: half air, `rest` for the others.
vtkSmartPointer<vtkImageData> scan(double rest)
{
  return cube<vtkShortArray>(
    20, 200, "scan", [rest](vtkIdType i) { return i % 2 ? -1000.0 : rest; });
}

double opacity_at(vtkVolumeProperty* property, double value)
{
  return property->GetScalarOpacity()->GetValue(value);
}

}

TEST(Presets, TheTableIsSound)
{
  std::set<std::string> names;
  for (const Preset& preset : presets())
  {
    SCOPED_TRACE(preset.name);
    EXPECT_TRUE(names.insert(preset.name).second) << "a name given twice";
    EXPECT_FALSE(preset.title.empty());
    EXPECT_FALSE(preset.description.empty());
    EXPECT_TRUE(preset.modality == "CT" || preset.modality == "MR" ||
      preset.modality == "any density");
    EXPECT_GT(preset.opacity_unit_distance, 0.0);
    EXPECT_GE(preset.colour.size(), 2u);
    EXPECT_GE(preset.opacity.size(), 2u);
    EXPECT_EQ(0.0, preset.opacity.front().opacity) << "the background must be clear";
    for (std::size_t i = 0; i < preset.colour.size(); ++i)
    {
      const ColourPoint& p = preset.colour[i];
      for (double c : { p.red, p.green, p.blue })
      {
        EXPECT_TRUE(c >= 0.0 && c <= 1.0);
      }
      EXPECT_TRUE(i == 0 || preset.colour[i - 1].value < p.value);
    }
    const double unit = preset.value_unit == ValueUnit::Hounsfield ? 1000.0 : 1.0;
    for (std::size_t i = 0; i < preset.opacity.size(); ++i)
    {
      const OpacityPoint& p = preset.opacity[i];
      EXPECT_TRUE(p.opacity >= 0.0 && p.opacity < 1.0) << "1 is no finite extinction";
      if (i > 0)
      {
        const OpacityPoint& q = preset.opacity[i - 1];
        ASSERT_LT(q.value, p.value);
        const double slope = std::abs(p.opacity - q.opacity) / (p.value - q.value) * unit;
        EXPECT_LT(slope, 8.0) << "a ramp this steep shows the steps of a mapper";
      }
    }
    EXPECT_EQ(&preset, &find_preset(preset.name));
  }
  for (const char* name : { "ct-bone", "ct-muscle", "ct-skin", "ct-angiography", "ct-lung",
         "mr-brain", "mr-skin", "mr-angiography", "mr-default", "cloud", "grey" })
  {
    EXPECT_EQ(1u, names.count(name)) << name;
  }
}

TEST(Presets, AnUnknownNameIsABadCallThatListsThemAll)
{
  try
  {
    find_preset("ct-bones");
    FAIL() << "no error";
  }
  catch (const Failure& failure)
  {
    const std::string text = failure.what();
    EXPECT_EQ(BadCall, failure.Status);
    EXPECT_EQ(0u, text.find("--preset ct-bones: ")) << text;
    for (const Preset& preset : presets())
    {
      EXPECT_NE(std::string::npos, text.find(preset.name)) << text;
    }
  }
}

TEST(RobustRange, IsBlindToSingleOutliers)
{
  auto volume = cube<vtkFloatArray>(
    20, 1, "x", [](vtkIdType i) { return i == 7 ? 1e30 : i == 9 ? -1e30 : (i % 1000) / 999.0; });
  const auto range = robust_range(volume);
  EXPECT_NEAR(0.0, range[0], 0.002);
  EXPECT_NEAR(1.0, range[1], 0.002);
}

TEST(RobustRange, PassesOverWhatIsNotFinite)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  auto volume = cube<vtkDoubleArray>(10, 1, "x",
    [=](vtkIdType i) { return i % 4 == 0 ? nan : i % 4 == 1 ? inf : i % 4 == 2 ? 2.0 : 6.0; });
  const auto range = robust_range(volume);
  EXPECT_EQ(2.0, range[0]);
  EXPECT_EQ(6.0, range[1]);
}

TEST(RobustRange, OfASmallObjectIsTheWholeRange)
{
  auto volume = cube<vtkFloatArray>(20, 1, "x", [](vtkIdType i) { return i == 77 ? 5.0 : 0.0; });
  const auto range = robust_range(volume);
  EXPECT_EQ(0.0, range[0]);
  EXPECT_EQ(5.0, range[1]);
}

TEST(RobustRange, OfOneValueIsNotEmpty)
{
  auto volume = cube<vtkFloatArray>(5, 1, "x", [](vtkIdType) { return 3.0; });
  const auto range = robust_range(volume);
  EXPECT_EQ(3.0, range[0]);
  EXPECT_EQ(4.0, range[1]);
}

TEST(RobustRange, OfALargeVolumeIsASampleThatIsFair)
{
  // 160³ values are sampled; a ramp along x tells whether the stride favours a column.
  auto volume =
    cube<vtkFloatArray>(160, 1, "x", [](vtkIdType i) { return static_cast<double>(i % 160); });
  const auto range = robust_range(volume);
  EXPECT_NEAR(0.0, range[0], 1.0);
  EXPECT_NEAR(159.0, range[1], 1.0);
}

TEST(RobustRange, OfNothingIsAFailure)
{
  vtkNew<vtkImageData> empty;
  EXPECT_THROW(robust_range(empty), Failure);
  EXPECT_THROW(robust_range(nullptr), Failure);
  auto nothing = cube<vtkFloatArray>(
    5, 1, "x", [](vtkIdType) { return std::numeric_limits<double>::quiet_NaN(); });
  EXPECT_THROW(robust_range(nothing), Failure);
}

TEST(ApplyPreset, HounsfieldUnitsAreTheDatasOwn)
{
  vtkNew<vtkVolumeProperty> property;
  const Preset& bone = find_preset("ct-bone");
  apply(bone, scan(400), property);
  for (const OpacityPoint& p : bone.opacity)
  {
    EXPECT_DOUBLE_EQ(p.opacity, opacity_at(property, p.value));
  }
  EXPECT_EQ(0.0, opacity_at(property, -1000));
  EXPECT_EQ(1.0, property->GetScalarOpacityUnitDistance());
  EXPECT_EQ(1, property->GetShade());
  EXPECT_EQ(bone.shading.specular, property->GetSpecular());
  EXPECT_EQ(VTK_LINEAR_INTERPOLATION, property->GetInterpolationType());
  double colour[3];
  property->GetRGBTransferFunction()->GetColor(bone.colour[1].value, colour);
  EXPECT_DOUBLE_EQ(bone.colour[1].green, colour[1]);
}

TEST(ApplyPreset, FractionsFollowTheRange)
{
  auto volume =
    cube<vtkFloatArray>(20, 200, "x", [](vtkIdType i) { return 100.0 + (i % 1000) * 400.0 / 999; });
  const Preset& preset = find_preset("mr-skin");
  const auto range = value_range(preset, volume);
  EXPECT_NEAR(100.0, range[0], 1.0);
  EXPECT_NEAR(500.0, range[1], 1.0);
  vtkNew<vtkVolumeProperty> property;
  apply(preset, volume, property);
  for (const OpacityPoint& p : preset.opacity)
  {
    EXPECT_NEAR(p.opacity, opacity_at(property, range[0] + p.value * (range[1] - range[0])), 1e-12);
  }
}

TEST(ApplyPreset, ACloudOfAnyScaleLooksTheSame)
{
  const Preset& cloud = find_preset("cloud");
  for (const double scale : { 1e-3, 1.0, 1e4 })
  {
    // Nowhere empty: 0 must still mean no cloud.
    auto volume = cube<vtkFloatArray>(20, 50 * scale, "density",
      [scale](vtkIdType i) { return scale * (0.5 + 0.5 * (i % 1000) / 999); });
    EXPECT_EQ(0.0, value_range(cloud, volume)[0]);
    EXPECT_NEAR(scale, value_range(cloud, volume)[1], 1e-2 * scale);
    EXPECT_NEAR(cloud.opacity_unit_distance * 50 * scale, opacity_unit_distance(cloud, volume),
      1e-9 * scale);
  }
}

TEST(ApplyPreset, ReplacesWhatWasThere)
{
  auto volume = scan(400);
  vtkNew<vtkVolumeProperty> property;
  apply(find_preset("ct-skin"), volume, property);
  apply(find_preset("ct-bone"), volume, property);
  EXPECT_EQ(0.0, opacity_at(property, 0));
  EXPECT_EQ(1, property->GetDisableGradientOpacity());
  EXPECT_EQ(1.0, property->GetGradientOpacity()->GetValue(123));
}

TEST(ApplyPreset, GradientOpacityIsScaledToo)
{
  auto volume =
    cube<vtkFloatArray>(20, 200, "x", [](vtkIdType i) { return (i % 1000) * 500.0 / 999; });
  Preset preset = find_preset("mr-default");
  preset.gradient_opacity = { { 0.0, 0.0 }, { 0.1, 1.0 } };
  vtkNew<vtkVolumeProperty> property;
  apply(preset, volume, property);
  const auto range = value_range(preset, volume);
  EXPECT_EQ(0, property->GetDisableGradientOpacity());
  EXPECT_NEAR(0.5, property->GetGradientOpacity()->GetValue(0.05 * (range[1] - range[0])), 1e-9);
}

TEST(ChoosePreset, LooksAtTheValues)
{
  const auto name = [](vtkImageData* volume, const VolumeHints& hints = {}) {
    const PresetChoice choice = choose_preset(volume, hints);
    EXPECT_FALSE(choice.reason.empty());
    EXPECT_EQ(choice.reason, choose_preset(volume, hints).reason) << "not the same twice";
    return choice.preset->name;
  };
  EXPECT_EQ("ct-bone", name(scan(400)));
  EXPECT_EQ("ct-muscle", name(scan(40)));
  EXPECT_EQ("ct-lung", name(scan(-700)));
  const auto with_bone = [](int one_in) {
    return cube<vtkShortArray>(20, 200, "scan",
      [one_in](vtkIdType i) { return i % 2 ? -1000.0 : i % one_in == 0 ? 700.0 : 40.0; });
  };
  EXPECT_EQ("ct-bone", name(with_bone(50)));    // 4 % of what is not air
  EXPECT_EQ("ct-muscle", name(with_bone(800))); // 0.25 %
  // No air to be seen, but the header knows.
  auto inside = cube<vtkShortArray>(20, 200, "scan", [](vtkIdType i) { return i % 2 ? -20 : 40; });
  EXPECT_EQ("grey", name(inside));
  EXPECT_EQ("ct-muscle", name(inside, { "CT", "" }));

  const auto ramp = [](vtkIdType i) { return static_cast<double>(i % 200); };
  EXPECT_EQ("mr-brain", name(cube<vtkUnsignedCharArray>(20, 200, "scan", ramp)));
  EXPECT_EQ("mr-default", name(cube<vtkUnsignedCharArray>(20, 40, "scan", ramp)));
  EXPECT_EQ("mr-default", name(cube<vtkShortArray>(20, 500, "scan", ramp)));

  const auto fraction = [](vtkIdType i) { return (i % 200) / 199.0; };
  EXPECT_EQ("cloud", name(cube<vtkFloatArray>(20, 1, "Density", fraction)));
  EXPECT_EQ("cloud", name(cube<vtkFloatArray>(20, 1, "x", fraction), { "", "cloud_density" }));
  EXPECT_EQ("grey", name(cube<vtkFloatArray>(20, 1, "temperature", fraction)));
  EXPECT_EQ("grey", name(cube<vtkFloatArray>(20, 1, "density_anomaly",
                      [](vtkIdType i) { return (i % 200) / 199.0 - 0.5; })));
  EXPECT_EQ("mr-default", name(cube<vtkFloatArray>(20, 1, "density", fraction), { "MR", "" }));
}
