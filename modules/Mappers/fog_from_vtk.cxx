#include "fog_from_vtk.h"

#include "lights_from_vtk.h"
#include "vtkBrumeFog.h"

#include "vtkBrumeSky.h"

#include "vtkPropCollection.h"
#include "vtkRenderer.h"

namespace brume
{

vtkBrumeFog* find_fog(vtkRenderer* renderer)
{
  vtkPropCollection* props = renderer->GetViewProps();
  vtkCollectionSimpleIterator it;
  props->InitTraversal(it);
  while (vtkProp* prop = props->GetNextProp(it))
  {
    auto* fog = vtkBrumeFog::SafeDownCast(prop);
    if (fog && fog->GetVisibility())
    {
      return fog;
    }
  }
  return nullptr;
}

std::string add_fog(vtkBrumeFog* fog, const ViewFromVTK& view, Scene& scene)
{
  scene.fog = Fog();
  if (!fog)
  {
    return {};
  }
  fog->FillFog(scene.fog);
  vtkBrumeSky* sky = fog->GetSky();
  if (!sky)
  {
    return {};
  }
  glm::dvec3 ambient;
  scene.lights = lights_from_vtk(view.lights, view.camera, ambient);
  scene.sky = Sky();
  sky->FillSky(scene.sky);
  return sky->AppendEnvironmentLights(scene.lights);
}

std::string scene_of_fog(vtkBrumeFog* fog, const ViewFromVTK& view, Scene& scene)
{
  scene = Scene();
  scene.volumes.clear();
  glm::dvec3 ambient;
  scene.lights = lights_from_vtk(view.lights, view.camera, ambient);
  scene.camera = camera_from_vtk(view.camera, static_cast<double>(view.width) / view.height);
  return add_fog(fog, view, scene);
}

}
