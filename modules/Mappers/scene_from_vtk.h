// From VTK's objects to Transport's plain scene. Internal to Mappers.
#ifndef scene_from_vtk_h
#define scene_from_vtk_h

#include "grid_from_vtk.h"
#include "mask_from_vtk.h"
#include "temperature_from_vtk.h"

#include "Transport/scene.h"

#include <array>
#include <string>
#include <tuple>

class vtkBrumeMedium;
class vtkBrumeSky;
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

/// What a mapper has that says what the matter is and what lights it.
struct MatterSettings
{
  /// > 0: values are a density of this, see Density; 0: they are classified.
  double extinction = 0.0;
  vtkBrumeMedium* medium = nullptr; ///< null: the matter is not lit
  vtkBrumeSky* sky = nullptr;       ///< null: none; read with a medium alone
};

/// Whether a medium is followed in a blend mode of vtkVolumeMapper: in composite mode alone.
bool follows_medium(int blend_mode);

/// Builds scenes and keeps what does not change from one to the next. A part is rebuilt when the
/// VTK objects that it comes from say that they were modified.
class SceneFromVTK
{
public:
  /// Brings the scene up to date. Returns an empty string, or what is wrong and what to do.
  std::string Update(vtkVolumeMapper* mapper,
    vtkVolume* volume,
    const MaskSettings& mask,
    const MatterSettings& matter,
    const ViewFromVTK& view);

  Scene& GetScene() { return this->TheScene; }

private:
  std::string UpdateMedia(
    vtkVolumeProperty* property, const MaskSettings& mask, const Density& density);
  std::string UpdateLight(vtkBrumeMedium* medium, vtkBrumeSky* sky);
  bool DrawsLabels(vtkVolumeProperty* property, const MaskSettings& mask) const;
  void UpdateLabels(vtkVolumeProperty* property, const MaskSettings& mask);

  Scene TheScene;
  GridFromVTK Source;
  MaskFromVTK Labels;
  TemperatureFromVTK Temperature;

  /// The property and its time, that of labels' functions, the voxels, the mask's meaning, the
  /// density's extinction and channels, the temperatures.
  using MediumKey = std::tuple<vtkVolumeProperty*,
    unsigned long,
    unsigned long,
    std::uint64_t,
    bool,
    double,
    std::array<double, 4>,
    std::uint64_t>;
  MediumKey LastMedium{ nullptr, 0, 0, 0, false, 0.0, {}, 0 };
  std::uint64_t LastVoxels = 0;
};

}

#endif
