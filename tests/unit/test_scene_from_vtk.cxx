// What the mapper makes of VTK's objects: the scene itself, before any ray is marched.
#include "../support/vtk_scenes.h"

#include "vtkBrumeRayMarchMapper.h"

#include "Transport/scene.h"

#include "vtkCommand.h"
#include "vtkContourValues.h"
#include "vtkFloatArray.h"
#include "vtkMatrix3x3.h"
#include "vtkPlane.h"
#include "vtkPlaneCollection.h"
#include "vtkTestErrorObserver.h"

#include <gtest/gtest.h>

#include <glm/matrix.hpp>

#include <set>

using namespace vtk_scenes;

namespace
{

struct Stage
{
  vtkSmartPointer<vtkVolume> volume = volume_of();
  vtkNew<vtkBrumeRayMarchMapper> mapper;
  vtkNew<vtkCamera> camera;
  vtkNew<vtkTest::ErrorObserver> errors;

  explicit Stage(vtkImageData* image)
  {
    mapper->AddObserver(vtkCommand::ErrorEvent, errors);
    mapper->AddObserver(vtkCommand::WarningEvent, errors);
    mapper->SetInputData(image);
    volume->SetMapper(mapper);
    look_at(camera, volume->GetCenter(), 100.0);
  }
  const brume::Scene& scene()
  {
    const brume::Scene* updated = mapper->UpdateScene(volume, camera, nullptr, 8, 8);
    EXPECT_NE(updated, nullptr) << errors->GetErrorMessage();
    static const brume::Scene none;
    EXPECT_NO_THROW(updated->validate());
    return updated ? *updated : none;
  }
  const brume::Volume& first() { return scene().volumes[0]; }
  vtkVolumeProperty* property() { return volume->GetProperty(); }
  void refuses(const char* words)
  {
    errors->Clear();
    EXPECT_EQ(mapper->UpdateScene(volume, camera, nullptr, 8, 8), nullptr) << words;
    EXPECT_NE(errors->GetErrorMessage().find(words), std::string::npos)
      << errors->GetErrorMessage();
  }
};

/// A piecewise linear table at a value, as Classification has it.
double at(const std::vector<double>& table,
  double lower,
  double upper,
  double value,
  int channels = 1,
  int channel = 0)
{
  const int nodes = static_cast<int>(table.size()) / channels;
  const double x = std::clamp((value - lower) / (upper - lower), 0.0, 1.0) * (nodes - 1);
  const int i = std::min(static_cast<int>(x), nodes - 2);
  const double f = x - i;
  return (1.0 - f) * table[channels * i + channel] + f * table[channels * (i + 1) + channel];
}
double opacity(const brume::Classification& c, double value)
{
  return at(c.opacity, c.lower, c.upper, value);
}
double colour(const brume::Classification& c, double value, int channel)
{
  return at(c.rgb, c.lower, c.upper, value, 3, channel);
}

bool keeps(const brume::Cropping& c, const glm::dvec3& index)
{
  int region = 0;
  for (int axis = 2; axis >= 0; --axis)
  {
    region = 3 * region + (index[axis] < c.lower[axis] ? 0 : index[axis] > c.upper[axis] ? 2 : 1);
  }
  return c.regions >> region & 1u;
}

vtkSmartPointer<vtkImageData> mask_image(int nx, int ny, int nz, int labels)
{
  return image(nx,
    ny,
    nz,
    VTK_UNSIGNED_CHAR,
    [labels](int i, int j, int k, int) { return (i + 2 * j + 3 * k) % labels; });
}

// Cropping. ------------------------------------------------------------------------------------

TEST(SceneFromVTK, CroppingIsOffUnlessAsked)
{
  Stage stage(ball_image(VTK_SHORT));
  EXPECT_FALSE(stage.first().cropping.enabled);
}

// Every direction that swaps and turns axes, with an origin, a spacing and an extent of their own:
// what VTK's planes keep at a place of the data is what index space keeps at that voxel.
TEST(SceneFromVTK, CroppingPlanesLieInTheDatasCoordinates)
{
  const int orders[][3] = { { 0, 1, 2 }, { 1, 2, 0 }, { 2, 1, 0 }, { 0, 2, 1 } };
  for (bool cells : { false, true })
  {
    for (const int* order : orders)
    {
      for (int signs = 0; signs < 8; ++signs)
      {
        const auto data = ball_image(VTK_SHORT, 20, cells);
        double direction[9] = {};
        for (int axis = 0; axis < 3; ++axis)
        {
          direction[3 * order[axis] + axis] = signs >> axis & 1 ? -1.0 : 1.0;
        }
        data->SetDirectionMatrix(direction);
        data->SetSpacing(1.5, 0.5, 2.0);
        int extent[6];
        data->GetExtent(extent);
        data->SetExtent(
          extent[0] + 3, extent[1] + 3, extent[2] - 4, extent[3] - 4, extent[4], extent[5]);
        data->SetOrigin(10.0, -20.0, 5.0);
        const double* b = data->GetBounds();
        double planes[6];
        for (int axis = 0; axis < 3; ++axis)
        {
          planes[2 * axis] = 0.7 * b[2 * axis] + 0.3 * b[2 * axis + 1];
          planes[2 * axis + 1] = 0.4 * b[2 * axis] + 0.6 * b[2 * axis + 1];
        }
        Stage stage(data);
        stage.mapper->CroppingOn();
        stage.mapper->SetCroppingRegionPlanes(planes);
        const int flags = 0x5a3c1e7 & 0x7ffffff;
        stage.mapper->SetCroppingRegionFlags(flags);
        const brume::Volume& v = stage.first();
        ASSERT_TRUE(v.cropping.enabled);
        int kept = 0;
        for (int i = 0; i < 1000; ++i)
        {
          glm::dvec3 index;
          for (int axis = 0; axis < 3; ++axis)
          {
            const int step = axis == 0 ? i % 10 : axis == 1 ? i / 10 % 10 : i / 100;
            index[axis] =
              v.grid.lower(axis) + (v.grid.upper(axis) - v.grid.lower(axis)) * (step + 0.37) / 10.0;
          }
          const glm::dvec3 place(v.data_from_index * glm::dvec4(index, 1.0));
          int region = 0;
          for (int axis = 2; axis >= 0; --axis)
          {
            region = 3 * region + (place[axis] < planes[2 * axis]        ? 0
                                    : place[axis] > planes[2 * axis + 1] ? 2
                                                                         : 1);
          }
          const bool truth = flags >> region & 1;
          kept += truth;
          ASSERT_EQ(keeps(v.cropping, index), truth) << order[0] << order[1] << signs << cells;
        }
        EXPECT_GT(kept, 100);
        EXPECT_LT(kept, 900);
      }
    }
  }
}

TEST(SceneFromVTK, CroppingOfAnObliqueImageGoesByItsOwnAxes)
{
  const auto data = ball_image(VTK_SHORT, 20);
  const double c = std::cos(0.3);
  const double s = std::sin(0.3);
  data->SetDirectionMatrix(c, -s, 0, s, c, 0, 0, 0, 1);
  data->SetOrigin(2, 3, 4);
  Stage stage(data);
  stage.mapper->CroppingOn();
  stage.mapper->SetCroppingRegionPlanes(4, 9, 5, 8, 6, 12);
  const brume::Cropping& cropping = stage.first().cropping;
  const double lower[3] = { 2, 2, 2 };
  const double upper[3] = { 7, 5, 8 };
  for (int axis = 0; axis < 3; ++axis)
  {
    EXPECT_NEAR(cropping.lower[axis], lower[axis], 1e-12);
    EXPECT_NEAR(cropping.upper[axis], upper[axis], 1e-12);
  }
  EXPECT_EQ(cropping.regions, 0x2000u);
}

TEST(SceneFromVTK, ClippingPlanesKeepTheSideOfTheirNormal)
{
  Stage stage(ball_image(VTK_SHORT));
  EXPECT_TRUE(stage.first().clipping_planes.empty());
  vtkNew<vtkPlane> plane;
  plane->SetOrigin(1, 2, 3);
  plane->SetNormal(0, 3, 4);
  stage.mapper->AddClippingPlane(plane);
  stage.volume->SetPosition(100, 0, 0); // planes are in the world
  const std::vector<glm::dvec4> planes = stage.first().clipping_planes;
  ASSERT_EQ(planes.size(), 1u);
  EXPECT_NEAR(glm::dot(planes[0], glm::dvec4(1, 2, 3, 1)), 0.0, 1e-12);
  EXPECT_GT(glm::dot(planes[0], glm::dvec4(1, 2 + 3, 3 + 4, 1)), 0.0);
  stage.mapper->RemoveAllClippingPlanes();
  EXPECT_TRUE(stage.first().clipping_planes.empty());
}

// Blend modes. ---------------------------------------------------------------------------------

TEST(SceneFromVTK, BlendModesAreVTKs)
{
  Stage stage(ball_image(VTK_SHORT));
  const std::pair<int, brume::BlendMode> modes[] = {
    { vtkVolumeMapper::COMPOSITE_BLEND, brume::BlendMode::Composite },
    { vtkVolumeMapper::MAXIMUM_INTENSITY_BLEND, brume::BlendMode::MaximumIntensity },
    { vtkVolumeMapper::MINIMUM_INTENSITY_BLEND, brume::BlendMode::MinimumIntensity },
    { vtkVolumeMapper::AVERAGE_INTENSITY_BLEND, brume::BlendMode::AverageIntensity },
    { vtkVolumeMapper::ADDITIVE_BLEND, brume::BlendMode::Additive },
    { vtkVolumeMapper::ISOSURFACE_BLEND, brume::BlendMode::Isosurface },
  };
  for (const auto& mode : modes)
  {
    stage.mapper->SetBlendMode(mode.first);
    EXPECT_EQ(stage.scene().blend_mode, mode.second);
  }
  EXPECT_EQ(stage.scene().isosurfaces, std::vector<double>{ 0.0 }); // VTK's default
  stage.mapper->SetAverageIPScalarRange(20, 120);
  stage.property()->GetIsoSurfaceValues()->SetValue(0, 150);
  stage.property()->GetIsoSurfaceValues()->SetValue(1, 50);
  const brume::Scene& scene = stage.scene();
  EXPECT_EQ(scene.average_range[0], 20);
  EXPECT_EQ(scene.average_range[1], 120);
  EXPECT_EQ(scene.isosurfaces, (std::vector<double>{ 50, 150 }));
  EXPECT_EQ(scene.volumes[0].grey_range[0], 0.0);
  EXPECT_EQ(scene.volumes[0].grey_range[1], scene.volumes[0].ranges->upper);
  stage.mapper->SetBlendModeToSlice();
  stage.refuses("SetSliceFunction");
  vtkNew<vtkPlane> plane;
  plane->SetOrigin(1, 2, 3);
  plane->SetNormal(0, 0, -1);
  stage.property()->SetSliceFunction(plane);
  EXPECT_EQ(stage.scene().blend_mode, brume::BlendMode::Slice);
  EXPECT_EQ(stage.scene().slice, glm::dvec4(0, 0, -1, 3));
}

// Components. ----------------------------------------------------------------------------------

TEST(SceneFromVTK, IndependentComponentsAreVolumesThatShareTheirVoxels)
{
  for (int type : { VTK_UNSIGNED_CHAR, VTK_SHORT, VTK_FLOAT, VTK_DOUBLE, VTK_INT })
  {
    for (int components = 1; components <= 4; ++components)
    {
      Stage stage(image(
        5,
        6,
        7,
        type,
        [](int i, int j, int k, int c) { return (1 + c) * (i + j + k); },
        components));
      vtkVolumeProperty* property = stage.property();
      for (int c = 0; c < components; ++c)
      {
        vtkNew<vtkPiecewiseFunction> opacities;
        opacities->AddPoint(0, 0.0);
        opacities->AddPoint(10 * (c + 1), 0.1 * (c + 1));
        property->SetScalarOpacity(c, opacities);
        property->SetScalarOpacityUnitDistance(c, 1.0 + c);
        property->SetShade(c, c % 2);
        property->SetDiffuse(c, 0.1 * c);
        property->SetComponentWeight(c, 1.0 - 0.2 * c);
        if (c == 2)
        {
          vtkNew<vtkPiecewiseFunction> grey;
          grey->AddPoint(0, 0.25);
          property->SetColor(c, grey);
        }
      }
      const brume::Scene& scene = stage.scene();
      ASSERT_EQ(scene.volumes.size(), std::size_t(components));
      std::set<std::uint64_t> revisions;
      for (int c = 0; c < components; ++c)
      {
        const brume::Volume& v = scene.volumes[c];
        EXPECT_EQ(v.grid.voxels, scene.volumes[0].grid.voxels);
        EXPECT_EQ(v.grid.components, components);
        EXPECT_EQ(v.grid.component, c);
        EXPECT_EQ(v.grid.colour, brume::VoxelColour::Value);
        EXPECT_EQ(v.ranges->upper, (1 + c) * 15.0f);
        EXPECT_NEAR(opacity(v.classification, 5.0 * (c + 1)), 0.05 * (c + 1), 1e-6);
        EXPECT_EQ(v.classification.unit_distance, 1.0 + c);
        EXPECT_EQ(v.shading.enabled, c % 2 == 1);
        EXPECT_EQ(v.shading.diffuse, 0.1 * c);
        EXPECT_EQ(v.weight, components > 1 ? 1.0 - 0.2 * c : 1.0);
        revisions.insert(v.data_revision);
        revisions.insert(v.medium_revision);
      }
      EXPECT_EQ(revisions.size(), 2u * components); // keys of caches: all different, none 0
      EXPECT_EQ(revisions.count(0), 0u);
      if (components > 2)
      {
        EXPECT_NEAR(colour(scene.volumes[2].classification, 7.0, 1), 0.25, 1e-12);
      }
      if (type == VTK_DOUBLE)
      {
        const auto* voxels = static_cast<const float*>(scene.volumes[0].grid.voxels);
        for (int c = 0; c < components; ++c)
        {
          EXPECT_EQ(voxels[components + c], 1.0f + c); // voxel (1, 0, 0)
        }
      }
    }
  }
}

// Of several, surfaces are those of the heaviest; and back again.
TEST(SceneFromVTK, SurfacesAreOfTheHeaviestComponent)
{
  Stage stage(image(5, 6, 7, VTK_SHORT,
    [](int i, int j, int k, int c) { return (1 + c) * (i + j + k); }, 3));
  stage.property()->SetComponentWeight(0, 0.3);
  stage.property()->SetComponentWeight(1, 0.4);
  stage.property()->SetComponentWeight(2, 0.9);
  EXPECT_EQ(stage.scene().mixture, brume::Mixture::Components);
  EXPECT_EQ(stage.first().grid.component, 0);
  stage.mapper->SetBlendModeToIsoSurface();
  EXPECT_EQ(stage.first().grid.component, 2);
  EXPECT_EQ(stage.first().weight, 0.9);
  EXPECT_EQ(stage.first().grey_range[1], 45.0);
  stage.mapper->SetBlendModeToMaximumIntensity();
  for (int c = 0; c < 3; ++c)
  {
    EXPECT_EQ(stage.scene().volumes[c].grid.component, c);
  }
}

TEST(SceneFromVTK, OfTwoDependentComponentsTheFirstIsColouredAndTheSecondIsSeen)
{
  for (int type : { VTK_UNSIGNED_SHORT, VTK_DOUBLE })
  {
    Stage stage(image(
      5,
      5,
      5,
      type,
      [](int i, int, int, int c) { return c == 0 ? 1000.0 + 100.0 * i : 10.0 * i; },
      2));
    stage.property()->IndependentComponentsOff();
    vtkNew<vtkColorTransferFunction> colours;
    colours->AddRGBPoint(1000, 1, 0, 0);
    colours->AddRGBPoint(1400, 0, 1, 0);
    stage.property()->SetColor(colours);
    vtkNew<vtkPiecewiseFunction> opacities;
    opacities->AddPoint(0, 0.0);
    opacities->AddPoint(40, 0.8);
    stage.property()->SetScalarOpacity(opacities);
    const brume::Scene& scene = stage.scene();
    ASSERT_EQ(scene.volumes.size(), 1u);
    const brume::Volume& v = scene.volumes[0];
    EXPECT_EQ(v.grid.component, 1);
    EXPECT_EQ(v.grid.components, 2);
    EXPECT_EQ(v.grid.colour, brume::VoxelColour::First);
    EXPECT_EQ(v.ranges->upper, 40.0f);
    EXPECT_NEAR(opacity(v.classification, 20), 0.4, 1e-3);
    EXPECT_NEAR(colour(v.classification, 1100, 0), 0.75, 1e-3);
    EXPECT_NEAR(colour(v.classification, 1100, 1), 0.25, 1e-3);
  }
}

TEST(SceneFromVTK, OfFourDependentComponentsThreeAreTheColour)
{
  Stage stage(image(
    5, 5, 5, VTK_UNSIGNED_CHAR, [](int, int, int, int c) { return 50 * c; }, 4));
  stage.property()->IndependentComponentsOff();
  const brume::Volume& v = stage.first();
  EXPECT_EQ(v.grid.component, 3);
  EXPECT_EQ(v.grid.colour, brume::VoxelColour::RGB);
  EXPECT_TRUE(v.classification.rgb.empty());
  EXPECT_EQ(v.ranges->upper, 150.0f);
}

TEST(SceneFromVTK, ComponentsAreReadAnewWhenTheirMeaningChanges)
{
  Stage stage(image(
    5, 5, 5, VTK_UNSIGNED_CHAR, [](int, int, int, int c) { return 50 * c; }, 4));
  EXPECT_EQ(stage.scene().volumes.size(), 4u);
  stage.property()->IndependentComponentsOff();
  EXPECT_EQ(stage.scene().volumes.size(), 1u);
  stage.property()->IndependentComponentsOn();
  EXPECT_EQ(stage.scene().volumes.size(), 4u);
}

TEST(SceneFromVTK, RefusesComponentsThatMeanNothing)
{
  Stage five(image(
    5, 5, 5, VTK_SHORT, [](int, int, int, int) { return 1.0; }, 5));
  five.refuses("components");
  Stage three(image(
    5, 5, 5, VTK_SHORT, [](int, int, int, int) { return 1.0; }, 3));
  three.property()->IndependentComponentsOff();
  three.refuses("components");
}

// 2D transfer functions. -----------------------------------------------------------------------

/// What OpenGL reads from a texture of such pixels at (u, v) in [0, 1].
double texture(vtkFloatArray* pixels, int width, int height, double u, double v, int channel)
{
  const auto texel = [&](int x, int y)
  {
    return pixels->GetComponent(
      std::clamp(y, 0, height - 1) * width + std::clamp(x, 0, width - 1), channel);
  };
  const double x = u * width - 0.5;
  const double y = v * height - 0.5;
  const int i = static_cast<int>(std::floor(x));
  const int j = static_cast<int>(std::floor(y));
  const double fx = x - i;
  const double fy = y - j;
  return (1 - fy) * ((1 - fx) * texel(i, j) + fx * texel(i + 1, j)) +
         fy * ((1 - fx) * texel(i, j + 1) + fx * texel(i + 1, j + 1));
}

TEST(SceneFromVTK, A2DFunctionIsReadAsOpenGLReadsItsTexture)
{
  for (int width : { 1, 2, 7 })
  {
    for (int height : { 1, 2, 5 })
    {
      const auto data = ball_image(VTK_SHORT); // values 0 to 199 and a little
      data->SetSpacing(1.0, 2.0, 3.0);
      Stage stage(data);
      vtkNew<vtkImageData> function;
      function->SetDimensions(width, height, 1);
      vtkNew<vtkFloatArray> pixels;
      pixels->SetNumberOfComponents(4);
      pixels->SetNumberOfTuples(width * height);
      for (vtkIdType i = 0; i < pixels->GetNumberOfValues(); ++i)
      {
        pixels->SetValue(i, static_cast<float>((i * 37 % 101) / 101.0));
      }
      function->GetPointData()->SetScalars(pixels);
      stage.property()->SetTransferFunction2D(function);
      const brume::Volume& v = stage.first();
      const brume::Classification& c = v.classification;
      ASSERT_FALSE(c.value_gradient.empty());
      EXPECT_TRUE(c.opacity.empty());
      const double lower = v.ranges->lower;
      const double width_of_range = v.ranges->upper - lower;
      EXPECT_NEAR(c.gradient_upper, 0.25 * width_of_range, 1e-9);
      EXPECT_NEAR(c.gradient_scale.y / c.gradient_scale.x, 2.0, 1e-12);
      EXPECT_NEAR((c.gradient_scale.x + c.gradient_scale.y + c.gradient_scale.z) / 3, 1.0, 1e-12);
      const int nodes = c.value_gradient_width;
      const int rows = static_cast<int>(c.value_gradient.size()) / (4 * nodes);
      for (double u : { 0.0, 0.03, 0.3, 0.5, 0.77, 1.0 })
      {
        for (double g : { 0.0, 0.04, 0.35, 0.5, 0.9, 1.0 })
        {
          const double value = lower + u * width_of_range;
          const double x =
            std::clamp((value - c.lower) / (c.upper - c.lower), 0.0, 1.0) * (nodes - 1);
          const double y = g * (rows - 1);
          const int i = std::min(static_cast<int>(x), nodes - 2);
          const int j = std::min(static_cast<int>(y), rows - 2);
          for (int channel = 0; channel < 4; ++channel)
          {
            const auto node = [&](int a, int b)
            { return c.value_gradient[4 * (b * nodes + a) + channel]; };
            const double fx = x - i;
            const double fy = y - j;
            const double read = (1 - fy) * ((1 - fx) * node(i, j) + fx * node(i + 1, j)) +
                                fy * ((1 - fx) * node(i, j + 1) + fx * node(i + 1, j + 1));
            ASSERT_NEAR(read, texture(pixels, width, height, u, g, channel), 1e-6)
              << width << height << " " << u << " " << g;
          }
        }
      }
    }
  }
}

TEST(SceneFromVTK, A2DFunctionMustBeThere)
{
  Stage stage(ball_image(VTK_SHORT));
  stage.property()->SetTransferFunctionMode(vtkVolumeProperty::TF_2D);
  stage.refuses("SetTransferFunction2D");
  stage.property()->SetTransferFunctionMode(vtkVolumeProperty::TF_1D);
  stage.scene();
}

// Masks. ---------------------------------------------------------------------------------------

TEST(SceneFromVTK, ABinaryMaskHidesItsZeros)
{
  Stage stage(ball_image(VTK_SHORT, 20));
  EXPECT_EQ(stage.first().mask.labels, nullptr);
  const auto mask = mask_image(20, 17, 22, 3);
  stage.mapper->SetMaskInput(mask);
  stage.mapper->SetMaskTypeToBinary();
  const brume::Volume& v = stage.first();
  EXPECT_EQ(v.mask.labels, mask->GetScalarPointer()); // as large: read in place
  EXPECT_EQ(v.mask.classification_of_label[0], brume::Mask::hidden);
  EXPECT_EQ(v.mask.classification_of_label[1], 0);
  EXPECT_EQ(v.mask.classification_of_label[2], 0);
  EXPECT_TRUE(v.label_classifications.empty());
}

TEST(SceneFromVTK, LabelsAreDrawnWithTheirFunctionsAndTheVolumesWhereTheyHaveNone)
{
  Stage stage(ball_image(VTK_SHORT, 20));
  stage.mapper->SetMaskInput(mask_image(20, 17, 22, 5));
  vtkNew<vtkPiecewiseFunction> opacities;
  opacities->AddPoint(0, 0.2);
  opacities->AddPoint(200, 0.4);
  vtkNew<vtkColorTransferFunction> colours;
  colours->AddRGBPoint(0, 0, 0, 0);
  colours->AddRGBPoint(200, 0, 1, 0);
  stage.property()->SetLabelScalarOpacity(1, opacities);
  stage.property()->SetLabelColor(3, colours);
  const brume::Volume& v = stage.first();
  const auto classification = [&](int label) -> const brume::Classification&
  {
    const int n = v.mask.classification_of_label[label];
    return n == 0 ? v.classification : v.label_classifications[n - 1];
  };
  for (int label : { 0, 1, 2, 3, 4 })
  {
    const brume::Classification& c = classification(label);
    EXPECT_EQ(c.lower, v.classification.lower); // as kernels want it
    EXPECT_EQ(c.upper, v.classification.upper);
    EXPECT_NEAR(opacity(c, 110), label == 1 ? 0.31 : 0.25, 1e-3) << label;
    EXPECT_NEAR(colour(c, 100, 1), label == 3 ? 0.5 : 0.4, 1e-3) << label;
    EXPECT_EQ(c.unit_distance, 2.0);
  }
  // A function that is changed in place.
  const std::uint64_t before = v.medium_revision;
  opacities->AddPoint(200, 0.8);
  EXPECT_NE(stage.first().medium_revision, before);
  EXPECT_NEAR(opacity(stage.first().label_classifications[0], 110), 0.2 + 0.6 * 0.55, 1e-3);
}

TEST(SceneFromVTK, LabelsBlendWithTheVolume)
{
  Stage stage(ball_image(VTK_SHORT, 20));
  stage.mapper->SetMaskInput(mask_image(20, 17, 22, 2));
  vtkNew<vtkPiecewiseFunction> opacities;
  opacities->AddPoint(0, 0.8);
  vtkNew<vtkColorTransferFunction> colours;
  colours->AddRGBPoint(0, 0, 1, 0);
  stage.property()->SetLabelScalarOpacity(1, opacities);
  stage.property()->SetLabelColor(1, colours);
  stage.mapper->SetMaskBlendFactor(0.25f);
  const brume::Classification& c = stage.first().label_classifications.at(0);
  EXPECT_NEAR(opacity(c, 110), 0.25 * 0.8 + 0.75 * 0.25, 1e-3);
  EXPECT_NEAR(colour(c, 100, 0), 0.75 * 0.55, 1e-3);
  EXPECT_NEAR(colour(c, 100, 1), 0.25 + 0.75 * 0.4, 1e-3);
  EXPECT_NEAR(colour(c, 10, 1), 0.25, 1e-3); // the volume's colour is not seen there
  stage.mapper->SetMaskBlendFactor(0.0f);
  EXPECT_EQ(stage.first().mask.classification_of_label[1], 0);
}

TEST(SceneFromVTK, GradientOpacityOfTheVolumeIsNotForLabels)
{
  Stage stage(ball_image(VTK_SHORT, 20));
  stage.mapper->SetMaskInput(mask_image(20, 17, 22, 3));
  vtkNew<vtkPiecewiseFunction> steep;
  steep->AddPoint(0, 0.0);
  steep->AddPoint(20, 1.0);
  stage.property()->SetGradientOpacity(steep);
  vtkNew<vtkPiecewiseFunction> half;
  half->AddPoint(0, 0.5);
  stage.property()->SetLabelGradientOpacity(2, half);
  const brume::Volume& v = stage.first();
  EXPECT_FALSE(v.classification.gradient_opacity.empty());
  EXPECT_EQ(v.mask.classification_of_label[0], 0);
  const auto& plain = v.label_classifications.at(v.mask.classification_of_label[1] - 1);
  EXPECT_TRUE(plain.gradient_opacity.empty());
  const auto& own = v.label_classifications.at(v.mask.classification_of_label[2] - 1);
  EXPECT_EQ(own.gradient_opacity.front(), 0.5);
  EXPECT_EQ(own.gradient_opacity.back(), 0.5);
}

TEST(SceneFromVTK, AMaskOfOtherDimensionsIsStretchedOverTheVolume)
{
  Stage stage(image(12, 6, 4, VTK_SHORT, [](int i, int, int, int) { return i; }));
  stage.mapper->SetMaskInput(mask_image(3, 6, 8, 250));
  const brume::Volume& v = stage.first();
  ASSERT_NE(v.mask.labels, nullptr);
  for (int k = 0; k < 4; ++k)
    for (int j = 0; j < 6; ++j)
      for (int i = 0; i < 12; ++i)
        ASSERT_EQ(v.mask.labels[(k * 6 + j) * 12 + i], i / 4 + 2 * j + 3 * (2 * k + 1));
}

TEST(SceneFromVTK, AMaskMustBeBytes)
{
  Stage stage(ball_image(VTK_SHORT, 20));
  stage.mapper->SetMaskInput(ball_image(VTK_SHORT, 20));
  stage.refuses("mask");
  stage.mapper->SetMaskInput(nullptr);
  EXPECT_EQ(stage.first().mask.labels, nullptr);
}

TEST(SceneFromVTK, AMaskMayBeOfCells)
{
  Stage stage(ball_image(VTK_SHORT, 20, true));
  const auto mask = image(
    20, 17, 22, VTK_UNSIGNED_CHAR, [](int i, int, int, int) { return i % 2; }, 1, true);
  stage.mapper->SetMaskInput(mask);
  stage.mapper->SetMaskTypeToBinary();
  EXPECT_EQ(stage.first().mask.labels, mask->GetCellData()->GetScalars()->GetVoidPointer(0));
}

// Revisions. -----------------------------------------------------------------------------------

TEST(SceneFromVTK, RevisionsChangeWithWhatTheyStandForAndNothingElse)
{
  const auto data = ball_image(VTK_SHORT, 20);
  Stage stage(data);
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
  changed(false, false, "nothing");
  stage.camera->Azimuth(10);
  stage.volume->SetPosition(1, 2, 3);
  stage.property()->GetScalarOpacity()->AddPoint(100, 0.3);
  changed(false, true, "a function");
  stage.mapper->SetBlendModeToMaximumIntensity();
  stage.mapper->CroppingOn();
  changed(false, false, "what is not kept");
  const auto mask = mask_image(20, 17, 22, 3);
  stage.mapper->SetMaskInput(mask);
  changed(true, true, "a mask");
  changed(false, false, "the same mask");
  static_cast<unsigned char*>(mask->GetScalarPointer())[5] = 7;
  mask->GetPointData()->GetScalars()->Modified();
  changed(true, true, "the mask's labels");
  stage.mapper->SetMaskTypeToBinary();
  changed(false, true, "what the mask means");
  stage.mapper->SetMaskInput(nullptr);
  changed(true, true, "no mask");
  data->GetPointData()->GetScalars()->SetTuple1(3, 9);
  data->GetPointData()->GetScalars()->Modified();
  changed(true, true, "voxels");
}

TEST(SceneFromVTK, NoTwoMappersShareARevision)
{
  Stage a(ball_image(VTK_SHORT, 20));
  Stage b(ball_image(VTK_SHORT, 20));
  EXPECT_NE(a.first().data_revision, b.first().data_revision);
  EXPECT_NE(a.first().medium_revision, b.first().medium_revision);
}

}
