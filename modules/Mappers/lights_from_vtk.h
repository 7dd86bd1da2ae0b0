// Lights, shading and camera as Transport's. Internal to Mappers.
#ifndef lights_from_vtk_h
#define lights_from_vtk_h

#include "Transport/scene.h"

#include <vector>

class vtkCamera;
class vtkLightCollection;
class vtkVolumeProperty;

namespace brume
{

/// The lights that are on; a headlight where there is none at all. `ambient` becomes the colour of
/// the ambient light.
std::vector<Light> lights_from_vtk(vtkLightCollection* lights,
  vtkCamera* camera,
  glm::dvec3& ambient);

Shading shading_from_vtk(vtkVolumeProperty* property,
  int component,
  const glm::dvec3& ambient,
  bool twoSided);

Camera camera_from_vtk(vtkCamera* camera, double aspect);

}

#endif
