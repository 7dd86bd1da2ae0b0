// From VTK's objects to Transport's plain scene. Internal to Mappers.
#ifndef scene_from_vtk_h
#define scene_from_vtk_h

#include "Transport/scene.h"

#include <memory>
#include <string>
#include <tuple>
#include <vector>

class vtkCamera;
class vtkDataArray;
class vtkDataSet;
class vtkLight;
class vtkLightCollection;
class vtkVolume;
class vtkVolumeMapper;
class vtkVolumeProperty;

namespace brume
{

/// Builds scenes and keeps what does not change from one to the next. A part is rebuilt when the
/// VTK objects that it comes from say that they were modified.
class SceneFromVTK
{
public:
  /// Brings the scene up to date for a picture of width × height pixels. `lights` may be null or
  /// empty: a headlight then, as a vtkRenderer makes one. Returns an empty string, or what is wrong
  /// and what to do.
  std::string Update(vtkVolumeMapper* mapper, vtkVolume* volume, vtkCamera* camera,
    vtkLightCollection* lights, int width, int height, bool twoSidedLighting, int threads);

  Scene& GetScene() { return this->TheScene; }

private:
  std::string UpdateGrid(vtkVolumeMapper* mapper, vtkVolumeProperty* property);
  std::string UpdateClassification(vtkVolumeProperty* property);
  void UpdateShading(vtkVolumeProperty* property, vtkLightCollection* lights, vtkCamera* camera,
    bool twoSidedLighting);
  void UpdateCamera(vtkCamera* camera, double aspect);
  void MeasureRange();

  Scene TheScene;
  int NumberOfThreads = 0;
  double Range[2] = { 0.0, 0.0 };
  double Spacing[3] = { 1.0, 1.0, 1.0 };
  /// Voxels that could not be read in place: converted or padded.
  std::vector<unsigned char> Converted;

  using DataKey = std::tuple<vtkDataArray*, unsigned long, unsigned long, int, int, int, int>;
  DataKey LastData{ nullptr, 0, 0, 0, 0, 0, 0 };
  using MediumKey = std::tuple<vtkVolumeProperty*, unsigned long, std::uint64_t>;
  MediumKey LastMedium{ nullptr, 0, 0 };
};

}

#endif
