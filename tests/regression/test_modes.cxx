// The modes of the stock mappers: the same scene drawn by them and by Brume, live. Errors are in
// levels of an 8-bit screen (1/255); each bound is about twice what was measured, and what is left
// has the causes that docs/user/drop-in.md lists: above all where samples lie, and VTK's tables.
#include "../support/stock_pictures.h"

#include "vtkContourValues.h"
#include "vtkPlane.h"

#include <cmath>

using namespace stock_pictures;
using vtk_scenes::ball_image;
using vtk_scenes::image;

namespace
{

/// Bounds of the mean and of the 99.9th percentile, in levels; no test against a mapper that has
/// none.
struct Bounds
{
  double mean = 0.0;
  double p999 = 0.0;
};

void compare(const Scene& scene, Bounds cpu, Bounds gpu)
{
  const Picture brume = brume_picture(scene);
  EXPECT_GT(brightest(brume), 0.2) << scene.name;
  std::vector<Picture> pictures{ brume };
  const auto check = [&](const char* mapper, const Picture& picture, Bounds bounds)
  {
    const Errors errors = errors_of(brume, picture);
    std::cout << scene.name << ", " << mapper << ": mean " << errors.mean << ", p99.9 "
              << errors.p999 << " of 255\n";
    EXPECT_LE(errors.mean, bounds.mean) << scene.name << ", " << mapper;
    EXPECT_LE(errors.p999, bounds.p999) << scene.name << ", " << mapper;
    pictures.push_back(picture);
  };
  if (cpu.p999 > 0.0)
  {
    check("CPU", fixed_point_picture(scene), cpu);
  }
  if (gpu.p999 > 0.0)
  {
    check("GPU", gpu_picture(scene), gpu);
  }
  keep(scene.name, pictures);
}

Scene of(const char* name, int type = VTK_UNSIGNED_CHAR)
{
  Scene scene;
  scene.name = name;
  scene.image = ball_image(type);
  return scene;
}

// Cropping and clipping. The GPU mapper's cropping planes are up to half a voxel off, since it
// takes them to the texture of voxels as though these were cells; its rays begin a whole step after
// a clipping plane. A surface cut through dense matter shows both.
// ---------------------------------

TEST(Modes, CroppingToABox)
{
  Scene scene = of("crop-box");
  scene.mapper = [](vtkVolumeMapper* mapper)
  {
    mapper->CroppingOn();
    mapper->SetCroppingRegionPlanes(8, 22, 5, 20, 12, 28);
  };
  compare(scene, { 0.2, 13 }, { 0.8, 42 });
}

TEST(Modes, CroppingToRegions)
{
  for (int flags : { VTK_CROP_FENCE, VTK_CROP_INVERTED_CROSS, 0x5a3c1e7 })
  {
    Scene scene = of("crop-regions");
    scene.name += std::to_string(flags);
    scene.mapper = [flags](vtkVolumeMapper* mapper)
    {
      mapper->CroppingOn();
      mapper->SetCroppingRegionPlanes(10, 20, 9, 18, 12, 22);
      mapper->SetCroppingRegionFlags(flags);
    };
    compare(scene, { 0.35, 12 }, { 0.9, 42 });
  }
}

TEST(Modes, ClippingPlanesOfAPropThatWasMoved)
{
  Scene scene = of("clip");
  scene.volume = [](vtkVolume* volume)
  {
    volume->SetOrigin(15.5, 14, 16.5);
    volume->RotateWXYZ(30, 1, 1, 0);
  };
  scene.mapper = [](vtkVolumeMapper* mapper)
  {
    vtkNew<vtkPlane> a;
    a->SetOrigin(13, 14, 16);
    a->SetNormal(1, 0.3, 0.1);
    vtkNew<vtkPlane> b;
    b->SetOrigin(15, 19, 16);
    b->SetNormal(0.2, -1, 0.4);
    mapper->AddClippingPlane(a);
    mapper->AddClippingPlane(b);
  };
  compare(scene, { 0.2, 7 }, { 1.0, 30 });
}

// Components. ----------------------------------------------------------------------------------

/// Two balls, each in a component of its own, that do not meet, or do.
vtkSmartPointer<vtkImageData> two_balls(int type, bool meet = false)
{
  return image(
    32, 29, 34, type,
    [meet](int i, int j, int k, int c)
    {
      const double x = i - (meet ? 14.0 + 3.0 * c : 8.0 + 15.0 * c);
      const double r = std::sqrt(x * x + (j - 14.0) * (j - 14.0) + (k - 16.0) * (k - 16.0));
      return 200.0 / (1.0 + std::exp(2.0 * (r - 5.0)));
    },
    2);
}

TEST(Modes, IndependentComponents)
{
  for (int type : { VTK_UNSIGNED_CHAR, VTK_SHORT, VTK_FLOAT, VTK_UNSIGNED_SHORT })
  {
    const bool meet = type == VTK_UNSIGNED_SHORT;
    Scene scene = of(meet ? "independent-meet" : "independent");
    scene.name += std::to_string(type);
    scene.image = two_balls(type, meet);
    scene.volume = [](vtkVolume* volume)
    {
      vtkNew<vtkPiecewiseFunction> opacities;
      opacities->AddPoint(60, 0.0);
      opacities->AddPoint(200, 0.6);
      vtkNew<vtkColorTransferFunction> colours;
      colours->AddRGBPoint(0, 0, 1, 0);
      colours->AddRGBPoint(200, 0.2, 0.9, 0.8);
      volume->GetProperty()->SetScalarOpacity(1, opacities);
      volume->GetProperty()->SetColor(1, colours);
      volume->GetProperty()->SetScalarOpacityUnitDistance(1, 3.0);
      volume->GetProperty()->IndependentComponentsOn();
    };
    compare(scene, { 0.1, 6 }, { 0.1, 5.3 });
  }
}

/// Functions of the first component, whichever carries the value. The GPU mapper takes the unit
/// distance of the last.
void dependent(vtkVolume* volume)
{
  vtkVolumeProperty* property = volume->GetProperty();
  property->IndependentComponentsOff();
  property->SetScalarOpacityUnitDistance(1, property->GetScalarOpacityUnitDistance());
  property->SetScalarOpacityUnitDistance(3, property->GetScalarOpacityUnitDistance());
}

TEST(Modes, TwoDependentComponents)
{
  Scene scene = of("dependent-two");
  scene.image = image(
    32,
    29,
    34,
    VTK_UNSIGNED_SHORT,
    [](int i, int j, int k, int c)
    {
      return c == 0 ? 6.0 * j
                    : vtk_scenes::ball(2.0 * i / 31 - 1, 2.0 * j / 28 - 1, 2.0 * k / 33 - 1);
    },
    2);
  scene.volume = dependent;
  compare(scene, { 0.25, 2.5 }, { 0.25, 3 });
}

TEST(Modes, FourDependentComponents)
{
  Scene scene = of("dependent-four");
  scene.image = image(
    32,
    29,
    34,
    VTK_UNSIGNED_CHAR,
    [](int i, int j, int k, int c)
    {
      // All from 0 to 255: the GPU mapper confuses that with the range that a component has.
      const double v[4] = { 255.0 * i / 31,
        255.0 * j / 28,
        255.0 * k / 33,
        1.28 * vtk_scenes::ball(2.0 * i / 31 - 1, 2.0 * j / 28 - 1, 2.0 * k / 33 - 1) };
      return v[c];
    },
    4);
  scene.volume = dependent;
  compare(scene, { 0.2, 2.5 }, { 0.2, 3 });
}

// 2D transfer functions. The GPU mapper takes their opacity for one step, whatever its length:
// a unit distance of one step makes the two agree. ------------------------------------------------

TEST(Modes, A2DTransferFunction)
{
  for (bool shade : { false, true })
  {
    Scene scene = of(shade ? "tf2d-shaded" : "tf2d", VTK_UNSIGNED_SHORT);
    scene.volume = [shade](vtkVolume* volume)
    {
      constexpr int width = 32;
      constexpr int height = 16;
      vtkNew<vtkImageData> function;
      function->SetDimensions(width, height, 1);
      function->AllocateScalars(VTK_FLOAT, 4);
      for (int y = 0; y < height; ++y)
      {
        for (int x = 0; x < width; ++x)
        {
          auto* pixel = static_cast<float*>(function->GetScalarPointer(x, y, 0));
          pixel[0] = x / 31.0f;
          pixel[1] = y / 15.0f;
          pixel[2] = 1.0f - x / 31.0f;
          pixel[3] = x > 8 ? 0.02f + 0.01f * y : 0.0f;
        }
      }
      volume->GetProperty()->SetTransferFunction2D(function);
      volume->GetProperty()->SetScalarOpacityUnitDistance(0.5);
      volume->GetProperty()->SetShade(shade);
    };
    compare(scene, {}, { 1.0, 48 });
  }
}

// Masks: the GPU mapper alone has them. Its labels' opacities are of one step, too. --------------

vtkSmartPointer<vtkImageData> stripes(int labels)
{
  return image(32,
    29,
    34,
    VTK_UNSIGNED_CHAR,
    [labels](int i, int j, int, int) { return (i / 6 + j / 7) % labels; });
}

TEST(Modes, ABinaryMask)
{
  Scene scene = of("mask-binary");
  scene.mask = stripes(2);
  scene.binary = true;
  compare(scene, {}, { 0.55, 26 });
}

TEST(Modes, ALabelMap)
{
  for (float blend : { 1.0f, 0.4f, 0.0f })
  {
    Scene scene = of("mask-labels");
    scene.name += std::to_string(blend).substr(0, 3);
    scene.mask = stripes(3);
    scene.blend = blend;
    scene.volume = [](vtkVolume* volume)
    {
      vtkVolumeProperty* property = volume->GetProperty();
      property->SetScalarOpacityUnitDistance(0.5);
      property->GetScalarOpacity()->RemoveAllPoints();
      property->GetScalarOpacity()->AddPoint(0, 0.01);
      property->GetScalarOpacity()->AddPoint(200, 0.08);
      vtkNew<vtkPiecewiseFunction> opacities;
      opacities->AddPoint(20, 0.0);
      opacities->AddPoint(200, 0.2);
      vtkNew<vtkColorTransferFunction> red;
      red->AddRGBPoint(0, 1, 0, 0);
      red->AddRGBPoint(200, 1, 0.3, 0);
      vtkNew<vtkColorTransferFunction> green;
      green->AddRGBPoint(0, 0, 1, 0.2);
      green->AddRGBPoint(200, 0.3, 1, 0);
      property->SetLabelColor(1, red);
      property->SetLabelScalarOpacity(1, opacities);
      property->SetLabelColor(2, green);
    };
    compare(scene, {}, { 1.3, 17 });
  }
}

// Projections, surfaces and slices. Brume draws the limit of small steps, in double precision here;
// the stock mappers take samples half a voxel and less apart. -----------------------------------

void compare_truth(Scene scene, Bounds cpu, Bounds gpu)
{
  const Picture truth = reference_picture(scene);
  EXPECT_GT(brightest(truth), 0.15) << scene.name;
  std::vector<Picture> pictures{ truth };
  const auto check = [&](const char* mapper, const Picture& picture, Bounds bounds)
  {
    const Errors errors = errors_of(truth, picture);
    std::cout << scene.name << ", " << mapper << ": mean " << errors.mean << ", p99 "
              << errors.p99 << ", p99.9 " << errors.p999 << " of 255\n";
    EXPECT_LE(errors.mean, bounds.mean) << scene.name << ", " << mapper;
    EXPECT_LE(errors.p999, bounds.p999) << scene.name << ", " << mapper;
    pictures.push_back(picture);
  };
  check("Brume", brume_picture(scene), { 0.005, 0.15 });
  if (cpu.p999 > 0.0)
  {
    check("CPU", fixed_point_picture(scene), cpu);
  }
  if (gpu.p999 > 0.0)
  {
    check("GPU", gpu_picture(scene), gpu);
  }
  keep(scene.name, pictures);
}

Scene blended(const char* name, int mode, std::function<void(vtkVolume*)> volume = [](vtkVolume*) {})
{
  Scene scene = of(name, VTK_UNSIGNED_SHORT);
  scene.step = 0.1;
  scene.volume = std::move(volume);
  scene.mapper = [mode](vtkVolumeMapper* mapper) { mapper->SetBlendMode(mode); };
  return scene;
}

TEST(Modes, MaximumIntensity)
{
  compare_truth(blended("mip", vtkVolumeMapper::MAXIMUM_INTENSITY_BLEND), { 0.06, 1.4 }, { 0.1, 1.1 });
}

TEST(Modes, MinimumIntensity)
{
  const auto seen = [](vtkVolume* volume)
  {
    volume->GetProperty()->GetScalarOpacity()->RemoveAllPoints();
    // What is largest everywhere cannot be seen: the CPU mapper's outline is a step short.
    volume->GetProperty()->GetScalarOpacity()->AddPoint(150, 0.8);
    volume->GetProperty()->GetScalarOpacity()->AddPoint(205, 0.0);
  };
  Scene scene = blended("minip", vtkVolumeMapper::MINIMUM_INTENSITY_BLEND, seen);
  scene.image = image(32, 29, 34, VTK_UNSIGNED_SHORT,
    [](int i, int j, int k, int)
    { return 210.0 - vtk_scenes::ball(2.0 * i / 31 - 1, 2.0 * j / 28 - 1, 2.0 * k / 33 - 1); });
  compare_truth(scene, { 0.35, 7 }, { 0.15, 2 }); // the CPU mapper's values have 15 bits
}

TEST(Modes, AverageIntensity)
{
  for (bool part : { false, true })
  {
    Scene scene = blended(part ? "average-part" : "average",
      vtkVolumeMapper::AVERAGE_INTENSITY_BLEND,
      [](vtkVolume* volume) { volume->GetProperty()->GetScalarOpacity()->AddPoint(200, 1.0); });
    scene.mapper = [part](vtkVolumeMapper* mapper)
    {
      mapper->SetBlendModeToAverageIntensity();
      if (part)
      {
        mapper->SetAverageIPScalarRange(50, 150);
      }
    };
    compare_truth(scene, {}, { 0.11, 2.7 });
  }
}

TEST(Modes, Additive)
{
  compare_truth(blended("additive", vtkVolumeMapper::ADDITIVE_BLEND,
                  [](vtkVolume* volume)
                  { volume->GetProperty()->SetScalarOpacityUnitDistance(10.0); }),
    {}, { 0.1, 1.1 });
}

TEST(Modes, Isosurfaces)
{
  for (bool shade : { false, true })
  {
    compare_truth(blended(shade ? "isosurface-shaded" : "isosurface",
                    vtkVolumeMapper::ISOSURFACE_BLEND,
                    [shade](vtkVolume* volume)
                    {
                      vtkVolumeProperty* property = volume->GetProperty();
                      property->SetShade(shade);
                      property->GetScalarOpacity()->RemoveAllPoints();
                      property->GetScalarOpacity()->AddPoint(0, 0.3);
                      property->GetScalarOpacity()->AddPoint(200, 0.9);
                      property->GetIsoSurfaceValues()->SetValue(0, 130);
                      property->GetIsoSurfaceValues()->SetValue(1, 50);
                    }),
      {}, { 0.75, 14 }); // the GPU mapper takes the gradient up to a step behind the surface
  }
}

// The GPU mapper takes the plane to its texture as it does the cropping planes: half a voxel off.
TEST(Modes, Slice)
{
  compare_truth(blended("slice", vtkVolumeMapper::SLICE_BLEND,
                  [](vtkVolume* volume)
                  {
                    vtkNew<vtkPlane> plane;
                    plane->SetOrigin(15, 14, 16);
                    plane->SetNormal(0.5, -0.2, 0.8);
                    volume->GetProperty()->SetSliceFunction(plane);
                    volume->GetProperty()->GetScalarOpacity()->AddPoint(0, 0.3);
                    volume->GetProperty()->GetScalarOpacity()->AddPoint(200, 1.0);
                  }),
    {}, { 2.8, 44 });
}

// Of independent components the projections add up by weight. The GPU mapper's minimum is none.
TEST(Modes, ProjectionsOfIndependentComponents)
{
  for (int mode : { vtkVolumeMapper::MAXIMUM_INTENSITY_BLEND,
         vtkVolumeMapper::AVERAGE_INTENSITY_BLEND, vtkVolumeMapper::ADDITIVE_BLEND })
  {
    Scene scene = blended("components", mode,
      [](vtkVolume* volume)
      {
        vtkNew<vtkPiecewiseFunction> opacities;
        opacities->AddPoint(60, 0.0);
        opacities->AddPoint(200, 0.6);
        vtkNew<vtkColorTransferFunction> colours;
        colours->AddRGBPoint(0, 0, 1, 0);
        colours->AddRGBPoint(200, 0.2, 0.9, 0.8);
        vtkVolumeProperty* property = volume->GetProperty();
        property->GetScalarOpacity()->AddPoint(200, 0.9);
        property->SetScalarOpacity(1, opacities);
        property->SetColor(1, colours);
        property->SetScalarOpacityUnitDistance(0, 6.0);
        property->SetScalarOpacityUnitDistance(1, 8.0);
        property->SetComponentWeight(0, 0.9);
        property->SetComponentWeight(1, 0.5);
      });
    scene.name += std::to_string(mode);
    scene.image = two_balls(VTK_UNSIGNED_SHORT);
    const bool cpu = mode == vtkVolumeMapper::MAXIMUM_INTENSITY_BLEND;
    compare_truth(scene, cpu ? Bounds{ 0.05, 2.8 } : Bounds{}, { 0.05, 1.2 });
  }
}

// Thumbnails. The CPU mapper's loses the rest of a division by 128, and with it up to a level.
TEST(Modes, CanonicalViews)
{
  Scene scene = of("canonical");
  double direction[3] = { 0.3, -0.4, -1.0 };
  double up[3] = { 0, 1, 0 };
  const auto picture = [&](auto* mapper)
  {
    Window w(scene);
    mapper->SetAutoAdjustSampleDistances(0);
    mapper->SetSampleDistance(0.5);
    mapper->SetInputData(scene.image);
    mapper->CroppingOn(); // not heeded
    w.volume->SetMapper(mapper);
    vtkNew<vtkImageData> image;
    image->SetDimensions(size, size, 1);
    image->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
    mapper->CreateCanonicalView(
      w.volume, image, vtkVolumeMapper::COMPOSITE_BLEND, direction, up);
    EXPECT_TRUE(mapper->GetCropping());
    Picture result;
    for (vtkIdType i = 0; i < 3 * size * size; ++i)
      result.push_back(static_cast<unsigned char*>(image->GetScalarPointer())[i] / 255.0);
    return result;
  };
  const Picture ours = picture(vtkNew<vtkBrumeRayMarchMapper>().Get());
  const Picture theirs = picture(vtkNew<vtkFixedPointVolumeRayCastMapper>().Get());
  const Errors errors = errors_of(ours, theirs);
  std::cout << "canonical, CPU: mean " << errors.mean << ", p99.9 " << errors.p999 << "\n";
  keep("canonical", { ours, theirs });
  EXPECT_GT(brightest(ours), 0.4);
  EXPECT_LE(errors.mean, 0.6);
  EXPECT_LE(errors.p999, 4.0);
}

}
