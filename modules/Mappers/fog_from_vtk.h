// Fog props to scenes. Internal to Mappers.
#ifndef fog_from_vtk_h
#define fog_from_vtk_h

#include "scene_from_vtk.h"

#include "Transport/scene.h"

#include <string>

class vtkBrumeFog;
class vtkRenderer;

namespace brume
{

/// The first visible fog among a renderer's props; null for none.
vtkBrumeFog* find_fog(vtkRenderer* renderer);

/// Puts a fog into a scene, and its sky, if it has one, in the place of the scene's, with the lights of
/// the view; null takes out what fog the scene had. Returns an empty string, or what is wrong.
std::string add_fog(vtkBrumeFog* fog, const ViewFromVTK& view, Scene& scene);

/// A scene of a fog and nothing else.
std::string scene_of_fog(vtkBrumeFog* fog, const ViewFromVTK& view, Scene& scene);

}

#endif
