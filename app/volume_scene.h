// A scene ready to be drawn by any mapper: volume, property, camera, light.
#pragma once

#include "input.h"
#include "scene_options.h"

#include "vtkSmartPointer.h"

#include <array>
#include <string>
#include <vector>

class vtkBrumeFog;
class vtkBrumeMedium;
class vtkBrumePathTraceMapper;
class vtkBrumeRayMarchMapper;
class vtkBrumeSmartVolumeMapper;
class vtkBrumeVolumeMapper;
class vtkBrumeSky;
class vtkCamera;
class vtkImageData;
class vtkLightCollection;
class vtkPolyData;
class vtkVolume;

namespace brume::app
{

struct Preset;

struct VolumeScene
{
  SceneOptions options;
  Input input;
  const Preset* preset = nullptr; ///< null for a density (--extinction)
  std::string preset_reason; ///< why this preset; empty when the user named it
  /// With its property, without a mapper; null where surfaces stand in fog alone (no INPUT).
  vtkSmartPointer<vtkVolume> volume;
  vtkSmartPointer<vtkImageData> mask; ///< 0 or 1 for each voxel; null for none
  vtkSmartPointer<vtkCamera> camera; ///< clipping range fits the volume
  vtkSmartPointer<vtkLightCollection> lights; ///< as make_lights() settles them
  vtkSmartPointer<vtkBrumeMedium> medium;     ///< null for none
  vtkSmartPointer<vtkBrumeSky> sky;
  vtkSmartPointer<vtkBrumeFog> fog; ///< null for none
  std::vector<vtkSmartPointer<vtkPolyData>> meshes;
  double voxel_edge = 1.0;            ///< the smallest edge of a voxel, world units
  double opacity_unit_distance = 1.0; ///< world units

  std::array<double, 6> bounds() const; ///< of the input, or the meshes without one: x0, x1, y0, y1, z0, z1
  int width() const { return this->options.resolution[0]; }
  int height() const { return this->options.resolution[1]; }
};

/// Opens the input, with a progress bar, and settles all that the user left open:
/// - the preset from the data (choose_preset);
/// - the camera: all that the transfer functions let be seen, for patients from the front, a little from their left and above,
///   with the head up; otherwise from the front (−y), a little from the right and above, with z up;
/// - the background: black, or white behind a density that only absorbs.
/// Without an input the scene is its meshes and its fog.
/// Remarks (what the reader settled, which preset and why) go to standard error unless --quiet.
/// Throws Failure: BadCall for an unknown preset or sample, Failed for an input that cannot be read.
VolumeScene make_volume_scene(const SceneOptions& options);

/// Makes anew what these options have other than the scene's: look, light, matter, fog, modes, accuracy.
/// Input, mask, meshes and camera stay, and are not looked at. The options must
/// outlive the scene. Throws Failure for options that do not fit, and leaves the scene as it was.
void update(VolumeScene& scene, const SceneOptions& options);

/// The cropping planes in voxels, for mappers that do not know the image's place.
Cropping cropping_of_voxels(const VolumeScene& scene);

/// Fits the camera's clipping range to the volume and the meshes.
void fit_clipping_range(const VolumeScene& scene);

/// Gives the mapper all of the scene, and the volume the mapper; the camera's clipping range is fitted
/// to the volume and the meshes.
///@{
void set_up(const VolumeScene& scene, vtkBrumeRayMarchMapper* mapper);
void set_up(const VolumeScene& scene, vtkBrumePathTraceMapper* mapper);
/// With a --time-budget and no --tolerance the tolerance is 0: the best picture of the time.
void set_up(const VolumeScene& scene, vtkBrumeSmartVolumeMapper* mapper);
///@}

/// What a VTK object complained of, without the place in its source, one line; "see brume info" for an
/// empty text.
std::string words_of_vtk(const std::string& error);

}
