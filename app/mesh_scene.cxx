#include "mesh_scene.h"

#include "command.h"
#include "mesh_check.h"
#include "private_display.h"
#include "volume_scene.h"

#include "Transport/film.h"
#include "Transport/scene.h"

#include "vtkBrumeSky.h"

#include "vtkActor.h"
#include "vtkCellData.h"
#include "vtkCallbackCommand.h"
#include "vtkCamera.h"
#include "vtkCommand.h"
#include "vtkLight.h"
#include "vtkLightCollection.h"
#include "vtkNew.h"
#include "vtkOBJReader.h"
#include "vtkPLYReader.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkPolyDataMapper.h"
#include "vtkPolyDataNormals.h"
#include "vtkProperty.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkSTLReader.h"
#include "vtkUnsignedCharArray.h"
#include "vtkXMLPolyDataReader.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>

namespace brume::app
{

namespace
{

/// What a surface without colours of its own reflects.
constexpr double grey = 0.8;

/// VTK's readers and their parsers complain to standard error; while this lives, they do not.
class Silence
{
public:
  Silence() { vtkObject::GlobalWarningDisplayOff(); }
  ~Silence() { vtkObject::SetGlobalWarningDisplay(this->Former); }
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;

private:
  int Former = vtkObject::GetGlobalWarningDisplay();
};

template <class Reader>
vtkSmartPointer<vtkPolyData> read(const std::string& path)
{
  const Silence silence;
  vtkNew<Reader> reader;
  reader->SetFileName(path.c_str());
  reader->Update();
  vtkSmartPointer<vtkPolyData> mesh = reader->GetOutput();
  if (!mesh || mesh->GetNumberOfPolys() + mesh->GetNumberOfStrips() == 0)
  {
    throw Failure(
      path, "it holds no surface that can be read", "name a whole .vtp, .ply, .stl or .obj file");
  }
  return mesh;
}

void require_whole(const std::string& path, const std::string& wrong)
{
  if (!wrong.empty())
  {
    throw Failure(path, wrong, "name a whole .vtp, .ply, .stl or .obj file");
  }
}

vtkSmartPointer<vtkPolyData> with_normals(vtkPolyData* mesh)
{
  if (mesh->GetPointData()->GetNormals())
  {
    return mesh;
  }
  vtkNew<vtkPolyDataNormals> normals;
  normals->SetInputData(mesh);
  normals->SetFeatureAngle(60.0);
  normals->Update();
  return normals->GetOutput();
}

/// Colours of points or cells, red, green, blue in bytes; other scalars are no colours.
bool has_colours(vtkPolyData* mesh)
{
  const auto colours = [](vtkDataSetAttributes* data)
  {
    vtkDataArray* scalars = data->GetScalars();
    return scalars && vtkUnsignedCharArray::SafeDownCast(scalars) &&
      scalars->GetNumberOfComponents() >= 3;
  };
  return colours(mesh->GetPointData()) || colours(mesh->GetCellData());
}

/// A directional light as VTK shades by it: `colour` is what a white surface that faces it sends.
vtkSmartPointer<vtkLight> light_along(const glm::dvec3& travel, const glm::dvec3& colour)
{
  auto light = vtkSmartPointer<vtkLight>::New();
  light->SetLightTypeToSceneLight();
  light->SetPosition(-travel.x, -travel.y, -travel.z);
  light->SetFocalPoint(0.0, 0.0, 0.0);
  light->SetColor(colour.x, colour.y, colour.z);
  return light;
}

/// All that lights surfaces: the scene's lights, its environment's, and sky and ground as the light
/// from the twelve corners of an icosahedron, each for a twelfth of the sphere.
std::vector<vtkSmartPointer<vtkLight>> lights_of_surfaces(const VolumeScene& scene)
{
  std::vector<vtkSmartPointer<vtkLight>> lights;
  vtkCollectionSimpleIterator it;
  scene.lights->InitTraversal(it);
  while (vtkLight* light = scene.lights->GetNextLight(it))
  {
    auto copy = vtkSmartPointer<vtkLight>::New();
    copy->DeepCopy(light);
    lights.push_back(copy);
  }
  if (!scene.sky)
  {
    return lights;
  }
  std::vector<Light> environment;
  scene.sky->AppendEnvironmentLights(environment);
  for (const Light& light : environment)
  {
    lights.push_back(light_along(light.direction, light.diffuse));
  }
  Sky sky;
  scene.sky->FillSky(sky);
  const glm::dvec3 side = std::abs(sky.up.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 x = glm::normalize(glm::cross(side, sky.up));
  const glm::dvec3 y = glm::cross(sky.up, x);
  for (int corner = 0; corner < 12; ++corner)
  {
    // One above, five in a ring, five in a ring below, one below.
    const double height = corner == 0 ? 1.0 : corner == 11 ? -1.0 : corner < 6 ? std::sqrt(0.2) : -std::sqrt(0.2);
    const double angle = pi * (0.4 * corner + (corner < 6 ? 0.0 : 0.2));
    const double radius = std::sqrt(1.0 - height * height);
    const glm::dvec3 from =
      height * sky.up + radius * (std::cos(angle) * x + std::sin(angle) * y);
    const glm::dvec3 radiance = height > 0.0 ? sky.radiance : sky.ground;
    if (radiance != glm::dvec3(0.0))
    {
      lights.push_back(light_along(-from, radiance * (4.0 / 12.0))); // irradiance L 4π / 12, over π
    }
  }
  return lights;
}

/// What a window shows of surfaces, in more than its frame's 8 bits: shading is linear in the lights,
/// so that frames with brighter and dimmer lights are one picture with more steps and no ceiling.
class ManyExposures
{
public:
  ManyExposures(vtkRenderWindow* window, vtkRenderer* renderer, const VolumeScene& scene)
    : Window(window)
    , Lights(lights_of_surfaces(scene))
  {
    renderer->RemoveAllLights();
    for (vtkLight* light : this->Lights)
    {
      this->Intensities.push_back(light->GetIntensity());
      renderer->AddLight(light);
    }
  }

  /// R, G, B a pixel; of pixels without a surface it means nothing.
  std::vector<float> draw(bool draft)
  {
    std::vector<float> rgb;
    for (const double exposure : { 1.0 / 64.0, 1.0 / 8.0, 1.0, 8.0 }) // the brightest last
    {
      if (draft && exposure != 1.0)
      {
        continue;
      }
      for (std::size_t i = 0; i < this->Lights.size(); ++i)
      {
        this->Lights[i]->SetIntensity(exposure * this->Intensities[i]);
      }
      this->Window->Render();
      const int* size = this->Window->GetSize();
      vtkNew<vtkUnsignedCharArray> bytes;
      this->Window->GetPixelData(0, 0, size[0] - 1, size[1] - 1, 0, bytes);
      rgb.resize(static_cast<std::size_t>(bytes->GetNumberOfValues()));
      for (std::size_t i = 0; i < rgb.size(); ++i)
      {
        // Where this frame is not saturated it is finer than the ones before.
        const int byte = bytes->GetValue(static_cast<vtkIdType>(i));
        if (byte < 250 || exposure < 1.0 / 32.0 || draft)
        {
          rgb[i] = static_cast<float>(byte / 255.0 / exposure);
        }
      }
    }
    return rgb;
  }

private:
  vtkRenderWindow* Window;
  std::vector<vtkSmartPointer<vtkLight>> Lights;
  std::vector<double> Intensities; ///< of the lights in the scene
};

}

namespace
{

/// The picture of a frame that is `fine` times as wide and high: mean colours, and of the depths in a
/// pixel the second nearest, so that a surface counts where it fills half of the pixel and a lone speck
/// does not.
SurfacePicture averaged(const VolumeScene& scene, int fine, const std::vector<float>& rgb,
  const std::vector<float>& depths)
{
  SurfacePicture picture;
  const int samples = fine * fine;
  std::vector<float> nearest(static_cast<std::size_t>(samples));
  for (int y = 0; y < scene.height(); ++y)
  {
    for (int x = 0; x < scene.width(); ++x)
    {
      double sum[3] = { 0.0, 0.0, 0.0 };
      for (int n = 0; n < samples; ++n)
      {
        const std::size_t i = static_cast<std::size_t>(fine * y + n / fine) * fine * scene.width() +
          static_cast<std::size_t>(fine * x + n % fine);
        nearest[static_cast<std::size_t>(n)] = depths[i];
        for (int c = 0; c < 3; ++c)
        {
          sum[c] += depths[i] < 1.0f ? rgb[3 * i + c] : scene.options.background[c];
        }
      }
      std::sort(nearest.begin(), nearest.end());
      const float depth = nearest[samples > 1 ? 1 : 0];
      picture.depth.push_back(2.0f * depth - 1.0f); // [0, 1] to the clip cube's [-1, 1]
      for (const double value : sum)
      {
        picture.rgb.push_back(static_cast<float>(value / samples));
      }
    }
  }
  return picture;
}

}

vtkSmartPointer<vtkPolyData> open_mesh(const std::string& path)
{
  std::string ending = std::filesystem::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
    [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const bool known = ending == ".vtp" || ending == ".ply" || ending == ".stl" || ending == ".obj";
  if (!known)
  {
    throw Failure("--mesh " + path, "surfaces of this kind are not read",
      "name a .vtp, .ply, .stl or .obj file", BadCall);
  }
  std::error_code error;
  if (!std::filesystem::exists(path, error))
  {
    throw Failure(path, "no such file", "name one that is there");
  }
  if (std::filesystem::is_directory(path, error) || !std::ifstream(path))
  {
    throw Failure(path, "it cannot be read", "name a file that you may read");
  }
  require_whole(path, ending == ".ply" ? check_ply(path) : ending == ".obj" ? check_obj(path) : "");
  const vtkSmartPointer<vtkPolyData> mesh = ending == ".vtp" ? read<vtkXMLPolyDataReader>(path)
    : ending == ".ply"                                       ? read<vtkPLYReader>(path)
    : ending == ".stl"                                       ? read<vtkSTLReader>(path)
                                                             : read<vtkOBJReader>(path);
  require_whole(path, check_surface(mesh));
  return with_normals(mesh);
}

vtkSmartPointer<vtkActor> actor_of(vtkPolyData* mesh)
{
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(mesh);
  mapper->SetScalarVisibility(has_colours(mesh));
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  vtkProperty* property = actor->GetProperty();
  property->SetColor(grey, grey, grey);
  return actor;
}

struct MeshStage::Internals
{
  vtkNew<vtkRenderer> Renderer;
  vtkNew<vtkRenderWindow> Window;
  std::vector<vtkSmartPointer<vtkPolyData>> Meshes; ///< that the renderer has
  std::string Error;
};

MeshStage::MeshStage()
  : Internal(std::make_unique<Internals>())
{
  Internals& in = *this->Internal;
  vtkNew<vtkCallbackCommand> ear;
  ear->SetClientData(&in.Error);
  ear->SetCallback([](vtkObject*, unsigned long, void* data, void* text)
    { *static_cast<std::string*>(data) = static_cast<const char*>(text); });
  in.Window->AddObserver(vtkCommand::ErrorEvent, ear);
  in.Window->SetOffScreenRendering(1);
  in.Window->SetMultiSamples(0); // one depth a pixel
  in.Window->AddRenderer(in.Renderer);
  in.Renderer->AutomaticLightCreationOff();
}

MeshStage::~MeshStage() = default;

SurfacePicture MeshStage::draw(const VolumeScene& scene, bool draft)
{
  Internals& in = *this->Internal;
  const bool large = std::max(scene.width(), scene.height()) > 4096; // frames have a largest size
  const int fine = large || draft ? 1 : 2;
  in.Window->SetSize(fine * scene.width(), fine * scene.height());
  if (in.Meshes != scene.meshes)
  {
    in.Renderer->RemoveAllViewProps();
    in.Meshes = scene.meshes;
    for (vtkPolyData* mesh : in.Meshes)
    {
      in.Renderer->AddActor(actor_of(mesh));
    }
  }
  double background[3];
  std::copy(scene.options.background.begin(), scene.options.background.end(), background);
  in.Renderer->SetBackground(background);
  in.Renderer->SetActiveCamera(scene.camera);
  in.Error.clear();
  const std::vector<float> rgb = ManyExposures(in.Window, in.Renderer, scene).draw(draft);
  if (!in.Error.empty())
  {
    std::replace(in.Error.begin(), in.Error.end(), '\n', ' ');
    throw Failure("--mesh", in.Error, "leave it out");
  }
  std::vector<float> depths(rgb.size() / 3);
  in.Window->GetZbufferData(
    0, 0, fine * scene.width() - 1, fine * scene.height() - 1, depths.data());
  return averaged(scene, fine, rgb, depths);
}

SurfacePicture draw_meshes(const VolumeScene& scene)
{
  if (scene.meshes.empty())
  {
    return {};
  }
  const PrivateDisplay display;
  if (!display.available())
  {
    throw Failure("--mesh", display.reason(), "or leave it out: volumes alone need no display");
  }
  return MeshStage().draw(scene);
}

std::vector<float> over_scene(
  const Film& film, const VolumeScene& scene, const SurfacePicture& surfaces)
{
  if (surfaces.rgb.empty())
  {
    return over_background(film, scene.options.background.data());
  }
  std::vector<float> rgb = surfaces.rgb;
  for (std::size_t i = 0; i < film.size(); ++i)
  {
    for (int c = 0; c < 3; ++c)
    {
      rgb[3 * i + c] = film.radiance[c][i] + film.transmittance[c][i] * rgb[3 * i + c];
    }
  }
  return rgb;
}

}
