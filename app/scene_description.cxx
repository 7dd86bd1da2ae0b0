#include "scene_description.h"

#include "presets.h"
#include "volume_scene.h"

#include "Transport/sparse_voxels.h"

#include "vtkBrumeSparseVolume.h"

#include "vtkCamera.h"
#include "vtkImageData.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"

#include <sstream>

namespace brume::app
{

namespace
{

std::string text(double value)
{
  std::ostringstream out;
  out << value;
  return out.str();
}

std::string length(double value, const std::string& unit)
{
  return text(value) + (unit.empty() ? "" : " " + unit);
}

std::string in_words(const Triple& v)
{
  return v[0] == v[1] && v[0] == v[2] ? text(v[0])
                                      : text(v[0]) + ", " + text(v[1]) + ", " + text(v[2]);
}

std::string in_words(const LightChoice& light)
{
  const std::string shine = ", colour " + in_words(light.colour) + ", intensity " + text(light.intensity);
  switch (light.type)
  {
    case LightChoice::Type::Directional:
      return "directional along " + in_words(light.direction) + shine;
    case LightChoice::Type::Point:
      return "point light at " + in_words(light.position) + shine;
    case LightChoice::Type::Spot:
      return "spot at " + in_words(light.position) + " along " + in_words(light.direction) + ", " +
        text(light.cone_angle) + "° from its axis" + shine;
    default:
      return "headlight" + shine;
  }
}

std::vector<std::string> lights_in_words(const VolumeScene& scene)
{
  const MediumOptions& o = scene.options.medium;
  std::vector<std::string> words;
  if (o.sun_direction)
  {
    words.push_back(
      "sun toward " + in_words(*o.sun_direction) + ", irradiance " + in_words(o.sun_irradiance));
  }
  for (const std::string& light : o.point_lights)
  {
    words.push_back("point light " + light);
  }
  for (const LightChoice& light : o.lights)
  {
    words.push_back(in_words(light));
  }
  const Triple none{ 0.0, 0.0, 0.0 };
  if (o.sky_radiance != none)
  {
    words.push_back("sky, radiance " + in_words(o.sky_radiance));
  }
  if (o.ground_radiance != none)
  {
    words.push_back("ground, radiance " + in_words(o.ground_radiance));
  }
  if (!o.environment.empty())
  {
    words.push_back("environment " + o.environment);
  }
  return words.empty()
    ? std::vector<std::string>{ "headlight, white, intensity 1, with white ambient light" }
    : words;
}

/// Terms of gradient shading.
std::string shading_in_words(vtkVolumeProperty* property)
{
  return "ambient " + text(property->GetAmbient()) + ", diffuse " + text(property->GetDiffuse()) +
    ", specular " + text(property->GetSpecular()) + ", power " + text(property->GetSpecularPower());
}

}

SceneDescription describe(const VolumeScene& scene, double step)
{
  SceneDescription d;
  const std::string& unit = scene.input.length_unit;
  vtkVolumeProperty* property = scene.volume->GetProperty();
  d.input = scene.input.name;
  if (vtkBrumeSparseVolume* sparse = scene.input.sparse)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      d.dimensions[axis] = sparse->GetVoxels()->dims()[axis] - sparse->GetVoxels()->first()[axis];
    }
    sparse->GetSpacing(d.spacing.data());
  }
  else
  {
    scene.input.image->GetDimensions(d.dimensions.data());
    scene.input.image->GetSpacing(d.spacing.data());
  }
  d.unit = unit;
  d.preset = scene.preset ? scene.preset->name : "";
  d.width = scene.width();
  d.height = scene.height();
  d.step = step;
  d.step_voxels = step / scene.voxel_edge;
  d.opacity_unit_distance = scene.preset ? scene.opacity_unit_distance : 0.0;
  scene.camera->GetPosition(d.camera.position.data());
  scene.camera->GetFocalPoint(d.camera.focal_point.data());
  scene.camera->GetViewUp(d.camera.view_up.data());
  d.camera.view_angle = scene.camera->GetViewAngle();
  d.camera.parallel = scene.camera->GetParallelProjection() != 0;
  d.camera.parallel_scale = scene.camera->GetParallelScale();
  d.background = scene.options.background;
  d.shading = property->GetShade() != 0;
  d.interpolation = scene.options.interpolation;
  d.lights = lights_in_words(scene);
  const std::string all = "all mappers";
  if (scene.preset)
  {
    d.matched = { { "transfer functions", scene.preset->title + " (" + scene.preset->name + ")", all },
      { "opacity unit distance", length(scene.opacity_unit_distance, unit), all } };
  }
  else
  {
    const Triple& extinction = scene.options.extinction;
    d.matched = { { "extinction", in_words(extinction) + " per " + (unit.empty() ? "world unit" : unit) +
                      " and unit of density; as opacities of a table in VTK's",
                    all },
      { "what a density scatters",
        scene.options.medium.has_medium()
          ? "its albedo as a colour, shaded by the gradient as a diffuse surface"
          : "nothing: it absorbs",
        "VTK's" } };
  }
  const std::vector<MatchedSetting> rest{
    { "sample distance", length(step, unit) + " (" + text(d.step_voxels) + " voxel)", all },
    { "interpolation", d.interpolation, all },
    { "blend mode", scene.options.modes.blend_mode, all },
    { "shading", d.shading ? "on: " + shading_in_words(property) : "off", all },
    { "camera", d.camera.parallel ? "parallel" : "perspective", all },
    { "resolution", std::to_string(d.width) + " x " + std::to_string(d.height), all },
    { "jitter", "off", "vtk-gpu" },
    { "automatic sample distance", "off", all },
    { "what is timed",
      "the ray casting alone, tables and uploads of the warm-up left out; vtk-gpu: the whole frame",
      all },
    { "threads",
      scene.options.threads ? std::to_string(scene.options.threads) : "all processors",
      "raymarch, vtk-fixed-point" },
  };
  d.matched.insert(d.matched.end(), rest.begin(), rest.end());
  return d;
}

}
