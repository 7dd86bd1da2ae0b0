// The same hard cases before VTK's own mappers, beside Brume's. What Brume promises is asserted;
// what the others do is told.
//
// All get the same volume, property, camera and sample distance, one ray a pixel, no lights.
// vtkFixedPointVolumeRayCastMapper is read from its picture of 15 bits,
// vtkOpenGLGPUVolumeRayCastMapper from a window of 8 bits: half a level of its figures is rounding.
// Why they differ is in VTK's sources; the words below say it briefly.
#include "hard_case.h"

#include "../support/stock_pictures.h"

#include "vtkVersion.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <limits>
#include <sstream>

using namespace stock_pictures;
using brume_tests::HardCase;
using vtk_scenes::ball_image;
using vtk_scenes::image;

namespace
{

const char* const march = "vtkBrumeRayMarchMapper";
const char* const cpu = "vtkFixedPointVolumeRayCastMapper";
const char* const gpu = "vtkOpenGLGPUVolumeRayCastMapper";

/// What Brume promises of a picture against the truth, in levels: its mapper's default tolerance.
constexpr double promised = 0.004 * 255.0;
/// And of a picture against that of the same scene in another guise.
constexpr double same = 0.01;

/// Brume's picture with steps chosen by its tolerance, for cases that are hard for a fixed step.
Picture brume_of_own_steps(const Scene& scene)
{
  Scene own = scene;
  own.mapper = [](vtkVolumeMapper* mapper)
  {
    if (auto* march = vtkBrumeRayMarchMapper::SafeDownCast(mapper))
    {
      march->AutoAdjustSampleDistancesOn();
    }
  };
  return brume_picture(own);
}

/// A scene by each mapper, and what it is held against.
struct Pictures
{
  Picture brume, of_cpu, of_gpu;
  std::vector<Picture> truths; ///< one for all, or one each

  /// Against one truth.
  Pictures(const Scene& scene, const Picture& truth, bool own_steps = false)
    : brume(own_steps ? brume_of_own_steps(scene) : brume_picture(scene))
    , of_cpu(fixed_point_picture(scene))
    , of_gpu(gpu_picture(scene))
    , truths{ truth, truth, truth }
  {
    keep(scene.name, { truth, brume, of_cpu, of_gpu });
  }
  /// Against each mapper's own picture of another scene.
  Pictures(const Scene& scene, const Scene& other)
    : brume(brume_picture(scene))
    , of_cpu(fixed_point_picture(scene))
    , of_gpu(gpu_picture(scene))
    , truths{ brume_picture(other), fixed_point_picture(other), gpu_picture(other) }
  {
    keep(scene.name, { truths[0], brume, truths[1], of_cpu, truths[2], of_gpu });
  }

  /// Brume's figure is expected, the others' are told.
  template <class Figure>
  void measure(HardCase& one, const Figure& figure, double bound, const std::string& unit) const
  {
    one.measure(figure(this->brume, this->truths[0]), bound, unit, march);
    one.tell(figure(this->of_cpu, this->truths[1]), unit, cpu);
    one.tell(figure(this->of_gpu, this->truths[2]), unit, gpu);
  }
};

/// Differences of two pictures, in levels, of channels that show something in one of them; sorted.
std::vector<double> differences(const Picture& a, const Picture& b)
{
  std::vector<double> all;
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    if (a[i] != 0.0 || b[i] != 0.0)
    {
      all.push_back(255.0 * std::abs(a[i] - b[i]));
    }
  }
  std::sort(all.begin(), all.end());
  return all;
}

double worst(const Picture& a, const Picture& b)
{
  const std::vector<double> all = differences(a, b);
  return all.empty() ? 0.0 : all.back();
}

double mean(const Picture& a, const Picture& b)
{
  double sum = 0.0;
  const std::vector<double> all = differences(a, b);
  for (const double each : all)
  {
    sum += each / static_cast<double>(all.size());
  }
  return sum;
}

double worst_of_99(const Picture& a, const Picture& b)
{
  const std::vector<double> all = differences(a, b);
  return all.empty() ? 0.0 : all[(all.size() - 1) * 99 / 100];
}

/// Pixels that differ by more than two levels.
double changed(const Picture& a, const Picture& b)
{
  int count = 0;
  for (std::size_t i = 0; i < a.size(); i += 3)
  {
    bool differs = false;
    for (std::size_t c = i; c < i + 3; ++c)
    {
      differs = differs || !(255.0 * std::abs(a[c] - b[c]) <= 2.0);
    }
    count += differs;
  }
  return count;
}

/// Of the pixel in the middle.
double middle(const Picture& a, const Picture& b)
{
  const std::size_t at = 3 * (static_cast<std::size_t>(size) / 2 * size + size / 2);
  return 255.0 * std::abs(a[at] - b[at]);
}

Picture even_picture(double value)
{
  return Picture(3 * static_cast<std::size_t>(size) * size, value);
}

Scene ball(const std::string& name)
{
  Scene scene;
  scene.name = name;
  scene.image = ball_image(VTK_FLOAT);
  return scene;
}

/// Opacities by value, white.
std::function<void(vtkVolume*)> white(const std::vector<std::pair<double, double>>& points,
  double unit = 1.0)
{
  return [=](vtkVolume* volume)
  {
    vtkNew<vtkPiecewiseFunction> opacities;
    for (const auto& [value, opacity] : points)
    {
      opacities->AddPoint(value, opacity);
    }
    vtkNew<vtkColorTransferFunction> colours;
    colours->AddRGBPoint(0.0, 1.0, 1.0, 1.0);
    colours->AddRGBPoint(255.0, 1.0, 1.0, 1.0);
    volume->GetProperty()->SetScalarOpacity(opacities);
    volume->GetProperty()->SetColor(colours);
    volume->GetProperty()->SetScalarOpacityUnitDistance(unit);
  };
}

/// Even matter, whatever the values are: its optical depth over a length.
std::function<void(vtkVolume*)> even(double depth, double length, double unit = 1.0)
{
  const double opacity = -std::expm1(-depth * unit / length);
  return white({ { 0.0, opacity }, { 255.0, opacity } }, unit);
}

/// Values that do not matter, but are not all the same.
vtkSmartPointer<vtkImageData> box_image(int nx, int ny, int nz)
{
  return image(nx,
    ny,
    nz,
    VTK_UNSIGNED_CHAR,
    [](int i, int j, int k, int) { return (7 * i + 5 * j + 3 * k) % 64; });
}

/// Looks along an axis, in parallel projection, from `away`; pixels are `pitch` apart.
std::function<void(vtkCamera*)> along(int axis,
  const glm::dvec3& centre,
  double pitch,
  double away = 100.0)
{
  return [=](vtkCamera* camera)
  {
    glm::dvec3 eye = centre;
    eye[axis] += away;
    camera->ParallelProjectionOn();
    camera->SetParallelScale(0.5 * size * pitch);
    camera->SetFocalPoint(centre.x, centre.y, centre.z);
    camera->SetPosition(eye.x, eye.y, eye.z);
    camera->SetViewUp(axis == 1, axis != 1, 0.0);
  };
}

/// Looks at a centre, askew.
std::function<void(vtkCamera*)> askew(const glm::dvec3& centre, double distance)
{
  return [=](vtkCamera* camera)
  {
    const double place[3] = { centre.x, centre.y, centre.z };
    vtk_scenes::look_at(camera, place, distance);
  };
}

std::string of(const char* what, double number)
{
  std::ostringstream text;
  text << what << number;
  return text.str();
}

class Peers : public testing::Test
{
protected:
  static void SetUpTestSuite()
  {
    size = 128; // so that centres of pixels can be in planes of voxels without rounding
    vtkNew<vtkRenderWindow> window;
    window->SetOffScreenRendering(1);
    window->Render();
    std::istringstream lines(window->ReportCapabilities());
    std::string renderer = "an unknown renderer";
    const std::string key = "OpenGL renderer string:";
    for (std::string line; std::getline(lines, line);)
    {
      if (line.find(key) != std::string::npos)
      {
        renderer = line.substr(line.find(key) + key.size());
        renderer.erase(0, renderer.find_first_not_of(' '));
      }
    }
    brume_tests::introduce_group("Peers",
      std::string("Some of these cases before the mappers of VTK ") + vtkVersion::GetVTKVersion() +
        ", beside `" + march +
        "`: the same volume, property, camera and sample distance (half a voxel where nothing else "
        "is said, and not adjusted), a ray a pixel, no lights. Brume's figures have a bound, the "
        "others' are told. They are levels of a screen of 8 bits, of the worst pixel if nothing "
        "else is said. `" +
        cpu + "` is read from its picture of 15 bits, `" + gpu +
        "` from a window of 8 bits, so that half a level is rounding; its OpenGL was " + renderer +
        ".");
  }
};

void spoil(vtkImageData* image, double value)
{
  vtkDataArray* values = image->GetPointData()->GetScalars();
  for (vtkIdType i = 3; i < values->GetNumberOfTuples(); i += 97)
  {
    values->SetComponent(i, 0, value);
  }
}

}

TEST_F(Peers, VoxelsThatAreNoNumbers)
{
  const struct
  {
    const char* name;
    const char* file;
    double value;
    const char* of_cpu;
  } cases[] = { { "NaN voxels",
                  "nan",
                  std::numeric_limits<double>::quiet_NaN(),
                  "NaN becomes an integer as the processor has it, here that of the least value" },
    { "infinite voxels",
      "infinite",
      std::numeric_limits<double>::infinity(),
      "nothing is drawn: its table reaches from the least to the largest value, and all others "
      "fall on its first entry" },
    { "voxels of −∞",
      "minus-infinite",
      -std::numeric_limits<double>::infinity(),
      "nothing is drawn: its table begins at the least value" } };
  for (const auto& each : cases)
  {
    HardCase one("Peers",
      each.name,
      "one in an interpolation of eight spreads to all around it",
      "one voxel in 97, against the same volume with 0 in its place");
    Scene clean = ball("clean");
    spoil(clean.image, 0.0);
    Scene spoilt = ball(each.file);
    spoil(spoilt.image, each.value);
    const Pictures pictures(spoilt, clean);
    pictures.measure(one, worst, same, "levels");
    pictures.measure(one, changed, 0.0, "of 16384 pixels changed by more than two");
    one.tell(each.of_cpu, cpu);
    one.tell("texture filtering spreads it to the eight cells around", gpu);
  }
}

TEST_F(Peers, FarOrigins)
{
  HardCase one("Peers",
    "origins 1e3, 1e5 and 1e7 extents away",
    "single precision would see one voxel",
    "against the same scene at the origin");
  for (const double extents : { 1e3, 1e5, 1e7 })
  {
    const glm::dvec3 away = glm::dvec3(31.0, -31.0, 31.0) * extents;
    Scene far = ball(of("far-", extents));
    far.image->SetOrigin(away.x, away.y, away.z);
    far.camera = askew(away + glm::dvec3(15.5, 14.0, 16.5), 90.0);
    const Pictures pictures(far, ball("near"));
    pictures.measure(one, worst, same, of("levels at ", extents));
  }
  one.tell("its matrices and the rays' places in the world are floats", gpu);
}

TEST_F(Peers, LevelRays)
{
  // Cases are told as they end, the last one first.
  HardCase edge("Peers",
    "level rays along an edge of the box",
    "in two faces at once",
    "the same box, pixels on an edge");
  HardCase face("Peers",
    "level rays in a face of the box",
    "the box is closed: at its lower and at its upper end the way is as long as within",
    "the same box, pixels in a face");
  HardCase plane("Peers",
    "level rays in planes of voxels, and along lines of them",
    "a ray that stands on the border of two cells is in both",
    "an even box of 8³ cells along each axis, four pixels a voxel, half a voxel within its faces: "
    "against 1 − e^(−τ)");
  constexpr double pitch = 0.25;
  constexpr double depth = 1.5;
  for (int axis = 0; axis < 3; ++axis)
  {
    Scene scene;
    scene.name = std::string("level-") + "xyz"[axis];
    scene.image = box_image(9, 9, 9);
    scene.volume = even(depth, 8.0);
    // Pixels' centres lie on planes of voxels.
    const glm::dvec3 up(axis == 1, axis != 1, 0.0);
    glm::dvec3 forward(0.0);
    forward[axis] = -1.0;
    const glm::dvec3 right = glm::cross(forward, up);
    const glm::dvec3 centre = glm::dvec3(4.0) - (up + right) * 0.5 * pitch;
    scene.camera = along(axis, centre, pitch);
    const Pictures pictures(scene, even_picture(-std::expm1(-depth)));
    /// The worst of the pixels that are in so many faces and else at least half a voxel within.
    const auto in_faces = [&](int faces)
    {
      return [=](const Picture& a, const Picture& b)
      {
        double most = 0.0;
        for (int y = 0; y < size; ++y)
        {
          for (int x = 0; x < size; ++x)
          {
            const glm::dvec3 place = centre + right * ((x + 0.5 - 0.5 * size) * pitch) +
                                     up * ((y + 0.5 - 0.5 * size) * pitch);
            int on = 0;
            bool within = true;
            for (int other = 0; other < 3; ++other)
            {
              const double v = place[other];
              const bool faced = other != axis && (v == 0.0 || v == 8.0);
              on += faced;
              within = within && (other == axis || faced || (v >= 0.5 && v <= 7.5));
            }
            if (within && on == faces)
            {
              const std::size_t at = 3 * (static_cast<std::size_t>(y) * size + x);
              most = std::max(most, 255.0 * std::abs(a[at] - b[at]));
            }
          }
        }
        return most;
      };
    };
    pictures.measure(plane, in_faces(0), same, "levels");
    pictures.measure(face, in_faces(1), same, "levels");
    pictures.measure(edge, in_faces(2), same, "levels");
  }
  plane.tell("whole steps, the first one behind the near face: one too few of sixteen", gpu);
  for (HardCase* one : { &face, &edge })
  {
    one->tell("not drawn: counts as outside", cpu);
    one->tell("drawn on one side, as triangles are filled", gpu);
  }
}

TEST_F(Peers, Steps)
{
  HardCase soft("Peers",
    "step change: a soft ball at the same steps",
    "halving the step must not change a picture beyond its error",
    "against the reference in double precision");
  HardCase box("Peers",
    "step change: an even box at steps of 1, ½, ¼ and ⅛ voxel",
    "rays are no whole number of steps long, and opacities are told of another length than a step",
    "opacity of a unit distance of 3 voxels, seen askew: against 1 − e^(−τ)");
  for (const auto& [step, name] :
    { std::pair(1.0, "1"), std::pair(0.5, "½"), std::pair(0.25, "¼"), std::pair(0.125, "⅛") })
  {
    Scene scene;
    scene.name = of("step-box-", step);
    scene.step = step;
    scene.image = box_image(9, 9, 9);
    scene.volume = even(1.5, 8.0, 3.0);
    scene.camera = askew(glm::dvec3(4.0), 26.0);
    const Pictures pictures(scene, reference_picture(scene));
    pictures.measure(box, worst, same, std::string("levels at ") + name);
    pictures.measure(box, mean, same, std::string("on average at ") + name);
    Scene smooth = ball(of("step-ball-", step));
    smooth.step = step;
    const Pictures balls(smooth, reference_picture(smooth));
    balls.measure(soft, worst, promised, std::string("levels at ") + name);
  }
  box.tell("whole steps from the near plane; a pixel's width is missing along some edges", cpu);
  box.tell("whole steps, the first one behind the near face", gpu);
  soft.tell("opacities of a step have 15 bits: short steps round worse", cpu);
}

TEST_F(Peers, Spacing)
{
  HardCase one("Peers",
    "spacing of 1e-6 and 1e6",
    "lengths, opacities' unit distance and steps are far from 1",
    "against the same scene with a spacing of 1");
  for (const double edge : { 1e-6, 1e6 })
  {
    Scene scene = ball(of("spacing-", edge));
    scene.image->SetSpacing(edge, edge, edge);
    scene.step = 0.5 * edge;
    scene.volume = [=](vtkVolume* volume)
    { volume->GetProperty()->SetScalarOpacityUnitDistance(2.0 * edge); };
    scene.camera = askew(glm::dvec3(15.5, 14.0, 16.5) * edge, 90.0 * edge);
    const Pictures pictures(scene, ball("spacing-1"));
    pictures.measure(one, worst, same, of("levels at ", edge));
  }
}

TEST_F(Peers, UnevenSpacing)
{
  HardCase one("Peers",
    "spacing uneven by 1e4",
    "a step that is right across the sheet is 5e-5 voxels along it",
    "a ball pressed flat, seen askew: against the reference");
  Scene scene = ball("uneven");
  scene.image->SetSpacing(1.0, 1.0, 1e-4);
  scene.step = 5e-5;
  scene.volume = [](vtkVolume* volume)
  { volume->GetProperty()->SetScalarOpacityUnitDistance(2e-4); };
  scene.camera = [](vtkCamera* camera)
  {
    camera->ParallelProjectionOn();
    camera->SetParallelScale(18.0);
    camera->SetFocalPoint(15.5, 14.0, 16.5e-4);
    camera->SetPosition(45.5, 14.0, 60.0);
    camera->SetViewUp(0.0, 1.0, 0.0);
  };
  const Pictures pictures(scene, reference_picture(scene));
  pictures.measure(one, worst, promised, "levels");
  one.tell("black lines: a ray's step along the sheet is less than its 15 bits hold", cpu);
}

TEST_F(Peers, ThinVolumes)
{
  HardCase one("Peers",
    "a volume of one and of two layers of voxels",
    "one layer has no thickness, two have that of a cell: rays in them are two steps long",
    "an even sheet, seen askew: against nothing, and against 1 − e^(−τ)");
  for (const auto& [layers, name] : { std::pair(1, "one"), std::pair(2, "two") })
  {
    Scene scene;
    scene.name = of("layers-", layers);
    scene.image = box_image(25, 25, layers);
    scene.volume = even(std::log(2.0), 1.0);
    scene.camera = askew(glm::dvec3(12.0, 12.0, 0.0), 70.0);
    const Pictures pictures(scene, reference_picture(scene));
    pictures.measure(one, worst, same, std::string("levels of ") + name);
  }
  one.tell("whole steps from the near plane: two or three from pixel to pixel", cpu);
  one.tell("one layer is drawn as a step thick; whole steps", gpu);
}

TEST_F(Peers, ThinShell)
{
  HardCase one("Peers",
    "a transfer function with two steps: a shell a fifth of a voxel thick",
    "fixed steps leap over it",
    "steps of ½ and of ⅛ voxel, Brume's own by its tolerance: against the reference");
  for (const auto& [step, name] : { std::pair(0.5, "½"), std::pair(0.125, "⅛") })
  {
    Scene scene = ball(of("shell-", step));
    scene.step = step;
    scene.volume = white({ { 0.0, 0.0 },
                           { 98.0, 0.0 },
                           { 98.001, 0.9 },
                           { 102.0, 0.9 },
                           { 102.001, 0.0 },
                           { 255.0, 0.0 } },
      0.2);
    const Pictures pictures(scene, reference_picture(scene), true);
    pictures.measure(
      one, worst_of_99, promised, std::string("levels, 99 of 100 pixels, at ") + name);
  }
  for (const char* by : { cpu, gpu })
  {
    one.tell("a step has its sample's opacity; neither chooses steps by the functions", by);
  }
}

TEST_F(Peers, OneLitVoxel)
{
  HardCase one("Peers",
    "one lit voxel in 128³",
    "coarse rays and leaps miss it; its opacity changes within a step",
    "pixels of 1¼ and of ⅛ voxel, Brume's steps by its tolerance: against the reference");
  Scene scene;
  scene.image = image(128,
    128,
    128,
    VTK_UNSIGNED_CHAR,
    [](int i, int j, int k, int) { return i == 71 && j == 40 && k == 99 ? 255 : 0; });
  scene.volume = white({ { 0.0, 0.0 }, { 255.0, 0.9 } });
  for (const auto& [pitch, name] : { std::pair(1.25, "1¼"), std::pair(0.125, "⅛") })
  {
    scene.name = of("voxel-", pitch);
    scene.camera = along(2, glm::dvec3(71.0 - 0.5 * pitch, 40.0 - 0.5 * pitch, 64.0), pitch, 300.0);
    const Pictures pictures(scene, reference_picture(scene), true);
    pictures.measure(one, worst, promised, std::string("levels by ") + name);
  }
}

TEST_F(Peers, CameraInside)
{
  HardCase one("Peers",
    "a camera inside the matter",
    "rays begin at the near plane, not at the box",
    "even matter, 60°: against e^(−τ) from the near plane on");
  Scene scene = ball("inside");
  scene.volume = even(0.05, 1.0);
  scene.camera = [](vtkCamera* camera)
  {
    camera->SetPosition(15.0, 14.0, 16.0);
    camera->SetFocalPoint(20.0, 12.0, 11.0);
    camera->SetViewUp(0.0, 1.0, 0.0);
    camera->SetViewAngle(60.0);
  };
  const Pictures pictures(scene, reference_picture(scene));
  pictures.measure(one, worst, promised, "levels");
  for (const char* by : { cpu, gpu })
  {
    one.tell("whole steps show as rings", by);
  }
}

TEST_F(Peers, OpticalDepths)
{
  HardCase one("Peers",
    "optical depths of 1e-8 to 1e6 along 1024 voxels",
    "the opacity of a step is less than a table's entry holds, or 1",
    "steps of ¼ voxel: against 1 − e^(−τ)");
  for (const double depth : { 1e-8, 1e-2, 0.05, 0.7, 1e6 })
  {
    Scene scene;
    scene.name = of("depth-", depth);
    scene.image = box_image(9, 9, 1025);
    scene.step = 0.25;
    scene.volume = even(depth, 1024.0, depth > 1.0 ? 1.0 : 1024.0);
    scene.camera = along(2, glm::dvec3(3.9, 3.9, 512.0), 0.25, 2000.0);
    const Pictures pictures(scene, even_picture(-std::expm1(-depth)));
    pictures.measure(one, middle, promised, of("levels at ", depth));
  }
  one.tell(
    "opacities of a step have 15 bits: below 2⁻¹⁶ they are 0, and above by up to that off", cpu);
}

TEST_F(Peers, Constants)
{
  HardCase one("Peers",
    "constant volumes of 7, 1e30 and −1e30",
    "the range of values is empty: a table's scale divides by it",
    "an opacity of ½ along the way");
  for (const double value : { 7.0, 1e30, -1e30 })
  {
    Scene scene;
    scene.name = of("constant-", value);
    scene.image = image(9, 9, 9, VTK_FLOAT, [=](int, int, int, int) { return value; });
    scene.volume = white({ { value - 0.5 * std::abs(value), 0.0 }, { value, 0.5 } }, 8.0);
    scene.camera = along(2, glm::dvec3(3.9, 3.9, 4.0), 0.25);
    const Pictures pictures(scene, even_picture(0.5));
    pictures.measure(one, middle, promised, of("levels at ", value));
  }
  one.tell("whole steps, the first one behind the near face: one too few of sixteen", gpu);
}
