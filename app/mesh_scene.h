// Surfaces of a scene: read from files, and drawn by VTK in a window that nobody sees.
#pragma once

#include "vtkSmartPointer.h"

#include <memory>
#include <string>
#include <vector>

class vtkActor;
class vtkPolyData;

namespace brume
{
struct Film;
}

namespace brume::app
{

struct VolumeScene;

/// A surface from a .vtp, .ply, .stl or .obj file, with normals. Throws Failure for a file that
/// cannot be read or holds no surface, BadCall for one of another kind.
vtkSmartPointer<vtkPolyData> open_mesh(const std::string& path);

/// What of a picture the surfaces make.
struct SurfacePicture
{
  std::vector<float> rgb;   ///< R, G, B a pixel, rows from the bottom up; the background elsewhere
  std::vector<float> depth; ///< as vtkBrumeVolumeMapper::SetSurfaceDepth takes it
};

/// VTK's drawing of surfaces in a window that nobody sees, kept from picture to picture. Needs a display
/// (private_display.h), which must be there before it is made.
class MeshStage
{
public:
  MeshStage();
  ~MeshStage();
  MeshStage(const MeshStage&) = delete;
  MeshStage& operator=(const MeshStage&) = delete;

  /// As draw_meshes(). A draft has one sample a pixel, and light beyond white is cut off. Throws Failure
  /// for what VTK complains of.
  SurfacePicture draw(const VolumeScene& scene, bool draft = false);

private:
  struct Internals;
  std::unique_ptr<Internals> Internal;
};

/// Draws the scene's meshes, diffuse, in the light of its lights, environment, sky and ground; the
/// camera's clipping range must be fitted to them and to the volume (set_up). Needs a display (private_display.h):
/// throws Failure where there is none. Volumes throw no shadows on surfaces, nor they on volumes.
SurfacePicture draw_meshes(const VolumeScene& scene);

/// A surface as draw_meshes() shows it, for another renderer: grey or in its own colours, diffuse.
vtkSmartPointer<vtkActor> actor_of(vtkPolyData* mesh);

/// The film over the surfaces, or over the scene's background where it has none: R, G, B a pixel.
std::vector<float> over_scene(
  const Film& film, const VolumeScene& scene, const SurfacePicture& surfaces);

}
