// From VTK's objects to Transport's plain scene. Internal to Mappers.
#ifndef scene_from_vtk_h
#define scene_from_vtk_h

#include "grid_from_vtk.h"
#include "mask_from_vtk.h"

#include "Transport/scene.h"

#include <string>
#include <tuple>

class vtkCamera;
class vtkImageData;
class vtkLightCollection;
class vtkVolume;
class vtkVolumeMapper;
class vtkVolumeProperty;

namespace brume
{

/// What a view is made with.
struct ViewFromVTK
{
  vtkCamera* camera = nullptr;
  /// May be null or empty: a headlight then, as a vtkRenderer makes one.
  vtkLightCollection* lights = nullptr;
  int width = 1;  ///< pixels
  int height = 1; ///< pixels
  bool two_sided_lighting = true;
  int threads = 0;
};

/// A mapper's mask.
struct MaskSettings
{
  vtkImageData* image = nullptr;
  bool label_map = true;
  double blend_factor = 1.0;
};

/// Builds scenes and keeps what does not change from one to the next. A part is rebuilt when the
/// VTK objects that it comes from say that they were modified.
class SceneFromVTK
{
public:
  /// Brings the scene up to date. `extinction` > 0: values are a density, see Density; 0: they are
  /// classified. Returns an empty string, or what is wrong and what to do.
  std::string Update(vtkVolumeMapper* mapper,
    vtkVolume* volume,
    const MaskSettings& mask,
    double extinction,
    const ViewFromVTK& view);

  Scene& GetScene() { return this->TheScene; }

private:
  std::string UpdateMedia(
    vtkVolumeProperty* property, const MaskSettings& mask, double extinction);
  bool DrawsLabels(vtkVolumeProperty* property, const MaskSettings& mask) const;
  void UpdateLabels(vtkVolumeProperty* property, const MaskSettings& mask);

  Scene TheScene;
  GridFromVTK Source;
  MaskFromVTK Labels;

  using MediumKey = std::
    tuple<vtkVolumeProperty*, unsigned long, unsigned long, std::uint64_t, bool, double, double>;
  MediumKey LastMedium{ nullptr, 0, 0, 0, false, 0.0, 0.0 };
  std::uint64_t LastVoxels = 0;
};

}

#endif
