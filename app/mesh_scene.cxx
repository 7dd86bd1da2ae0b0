#include "mesh_scene.h"

#include "command.h"
#include "private_display.h"
#include "volume_scene.h"

#include "vtkActor.h"
#include "vtkCellData.h"
#include "vtkCallbackCommand.h"
#include "vtkCamera.h"
#include "vtkCommand.h"
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

#include <algorithm>
#include <cctype>
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

vtkSmartPointer<vtkActor> actor_of(vtkPolyData* mesh, const MediumOptions& light)
{
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(mesh);
  mapper->SetScalarVisibility(has_colours(mesh));
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  vtkProperty* property = actor->GetProperty();
  property->SetColor(grey, grey, grey);
  // A diffuse surface between two even halves of the sphere has their mean where it stands upright.
  double ambient[3];
  for (int c = 0; c < 3; ++c)
  {
    ambient[c] = grey * 0.5 * (light.sky_radiance[c] + light.ground_radiance[c]);
  }
  property->SetAmbientColor(ambient);
  property->SetAmbient(light.has_lights() ? 1.0 : 0.0);
  return actor;
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
  return with_normals(ending == ".vtp" ? read<vtkXMLPolyDataReader>(path)
      : ending == ".ply"               ? read<vtkPLYReader>(path)
      : ending == ".stl"               ? read<vtkSTLReader>(path)
                                       : read<vtkOBJReader>(path));
}

SurfacePicture draw_meshes(const VolumeScene& scene)
{
  SurfacePicture picture;
  if (scene.meshes.empty())
  {
    return picture;
  }
  const PrivateDisplay display;
  if (!display.available())
  {
    throw Failure("--mesh", display.reason(), "or leave it out: volumes alone need no display");
  }
  std::string error;
  vtkNew<vtkCallbackCommand> ear;
  ear->SetClientData(&error);
  ear->SetCallback([](vtkObject*, unsigned long, void* data, void* text)
    { *static_cast<std::string*>(data) = static_cast<const char*>(text); });
  vtkNew<vtkRenderer> renderer;
  vtkNew<vtkRenderWindow> window;
  window->AddObserver(vtkCommand::ErrorEvent, ear);
  window->SetOffScreenRendering(1);
  window->SetMultiSamples(0); // one depth a pixel
  window->SetSize(scene.width(), scene.height());
  window->AddRenderer(renderer);
  for (vtkPolyData* mesh : scene.meshes)
  {
    renderer->AddActor(actor_of(mesh, scene.options.medium));
  }
  double background[3];
  std::copy(scene.options.background.begin(), scene.options.background.end(), background);
  renderer->SetBackground(background);
  renderer->AutomaticLightCreationOff();
  renderer->SetLightCollection(scene.lights);
  renderer->SetActiveCamera(scene.camera);
  window->Render();
  if (!error.empty())
  {
    std::replace(error.begin(), error.end(), '\n', ' ');
    throw Failure("--mesh", error, "leave it out");
  }
  const int right = scene.width() - 1;
  const int top = scene.height() - 1;
  vtkNew<vtkUnsignedCharArray> bytes;
  window->GetPixelData(0, 0, right, top, 0, bytes);
  picture.depth.resize(static_cast<std::size_t>(scene.width()) * scene.height());
  window->GetZbufferData(0, 0, right, top, picture.depth.data());
  for (std::size_t i = 0; i < picture.depth.size(); ++i)
  {
    const bool surface = picture.depth[i] < 1.0f;
    picture.depth[i] = 2.0f * picture.depth[i] - 1.0f; // [0, 1] to the clip cube's [-1, 1]
    for (int c = 0; c < 3; ++c)
    {
      picture.rgb.push_back(surface
          ? bytes->GetValue(static_cast<vtkIdType>(3 * i) + c) / 255.0f
          : static_cast<float>(scene.options.background[c]));
    }
  }
  return picture;
}

}
