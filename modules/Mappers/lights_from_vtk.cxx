#include "lights_from_vtk.h"

#include "vtk_to_glm.h"

#include "vtkCamera.h"
#include "vtkLight.h"
#include "vtkLightCollection.h"
#include "vtkVolumeProperty.h"

#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

namespace brume
{

namespace
{

/// Where a light shines from and to in the world, headlights and camera lights included.
void light_in_world(vtkLight* light, vtkCamera* camera, glm::dvec3& position, glm::dvec3& focal)
{
  if (light->LightTypeIsHeadlight())
  {
    position = to_glm(camera->GetPosition());
    focal = to_glm(camera->GetFocalPoint());
    return;
  }
  position = to_glm(light->GetPosition());
  focal = to_glm(light->GetFocalPoint());
  vtkMatrix4x4* transform = light->LightTypeIsCameraLight()
                              ? camera->GetCameraLightTransformMatrix()
                              : light->GetTransformMatrix();
  if (transform)
  {
    const glm::dmat4 m = to_glm(transform);
    position = glm::dvec3(m * glm::dvec4(position, 1.0));
    focal = glm::dvec3(m * glm::dvec4(focal, 1.0));
  }
}

Light headlight(vtkCamera* camera)
{
  Light light;
  light.direction = to_glm(camera->GetDirectionOfProjection());
  return light;
}

}

std::vector<Light> lights_from_vtk(vtkLightCollection* lights,
  vtkCamera* camera,
  glm::dvec3& ambient)
{
  ambient = glm::dvec3(0.0);
  std::vector<Light> list;
  if (!lights || lights->GetNumberOfItems() == 0)
  {
    list.push_back(headlight(camera));
  }
  else
  {
    vtkCollectionSimpleIterator it;
    lights->InitTraversal(it);
    while (vtkLight* light = lights->GetNextLight(it))
    {
      if (!light->GetSwitch())
      {
        continue;
      }
      Light l;
      const double intensity = light->GetIntensity();
      l.diffuse = to_glm(light->GetDiffuseColor()) * intensity;
      l.specular = to_glm(light->GetSpecularColor()) * intensity;
      glm::dvec3 focal;
      light_in_world(light, camera, l.position, focal);
      const glm::dvec3 way = focal - l.position;
      l.direction =
        glm::length(way) > 0.0 ? glm::normalize(way) : to_glm(camera->GetDirectionOfProjection());
      l.positional = light->GetPositional() != 0;
      l.attenuation = to_glm(light->GetAttenuationValues());
      l.cone_angle = light->GetConeAngle();
      l.exponent = light->GetExponent();
      ambient += to_glm(light->GetAmbientColor()) * intensity;
      list.push_back(l);
    }
  }
  if (ambient == glm::dvec3(0.0))
  {
    // VTK's lights give no ambient light by themselves; its GPU mapper then takes white.
    ambient = glm::dvec3(1.0);
  }
  return list;
}

Shading shading_from_vtk(vtkVolumeProperty* property,
  int component,
  const glm::dvec3& ambient,
  bool twoSided)
{
  Shading shading;
  shading.enabled = property->GetShade(component) != 0;
  shading.ambient = property->GetAmbient(component);
  shading.diffuse = property->GetDiffuse(component);
  shading.specular = property->GetSpecular(component);
  shading.specular_power = property->GetSpecularPower(component);
  shading.two_sided = twoSided;
  shading.ambient_light = ambient;
  return shading;
}

Camera camera_from_vtk(vtkCamera* camera, double aspect)
{
  Camera result;
  result.clip_from_world = to_glm(camera->GetCompositeProjectionTransformMatrix(aspect, -1.0, 1.0));
  result.direction = to_glm(camera->GetDirectionOfProjection());
  return result;
}

}
