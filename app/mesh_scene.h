// Surfaces of a scene: read from files, and drawn by VTK in a window that nobody sees.
#pragma once

#include "vtkSmartPointer.h"

#include <string>
#include <vector>

class vtkPolyData;

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

/// Draws the scene's meshes with its lights (and, as ambient light, the mean of sky and ground), the
/// camera's clipping range fitted to them and to the volume. Needs a display (private_display.h):
/// throws Failure where there is none. The colours come from a frame of 8 bits.
SurfacePicture draw_meshes(const VolumeScene& scene);

}
