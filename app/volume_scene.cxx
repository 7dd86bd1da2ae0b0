#include "volume_scene.h"

#include "command.h"
#include "presets.h"

#include "vtkBrumeVolumeMapper.h"

#include "vtkCamera.h"
#include "vtkImageData.h"
#include "vtkLight.h"
#include "vtkLightCollection.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"

#include <algorithm>
#include <cmath>
#include <iostream>

namespace brume::app
{

namespace
{

/// How much of the picture the volume's box may fill when the camera is placed by itself.
constexpr double fill = 0.96;

/// Places the camera so that the eight corners of the image are within the picture.
void fit_camera(vtkImageData* image, vtkCamera* camera, double aspect, const double toward_eye[3],
  const double view_up[3])
{
  double corners[8][3];
  double centre[3] = { 0, 0, 0 };
  int extent[6];
  image->GetExtent(extent);
  for (int corner = 0; corner < 8; ++corner)
  {
    const int i = extent[corner & 1];
    const int j = extent[2 + ((corner >> 1) & 1)];
    const int k = extent[4 + ((corner >> 2) & 1)];
    image->TransformIndexToPhysicalPoint(i, j, k, corners[corner]);
    for (int axis = 0; axis < 3; ++axis)
    {
      centre[axis] += corners[corner][axis] / 8.0;
    }
  }
  double back[3] = { toward_eye[0], toward_eye[1], toward_eye[2] };
  double right[3];
  double up[3];
  vtkMath::Normalize(back);
  vtkMath::Cross(view_up, back, right);
  vtkMath::Normalize(right);
  vtkMath::Cross(back, right, up);
  const double tangent =
    std::tan(vtkMath::RadiansFromDegrees(0.5 * camera->GetViewAngle())) * fill;
  double distance = 0.0;
  for (const auto& corner : corners)
  {
    double d[3];
    vtkMath::Subtract(corner, centre, d);
    const double high = std::abs(vtkMath::Dot(d, up));
    const double wide = std::abs(vtkMath::Dot(d, right)) / aspect;
    distance = std::max(distance, vtkMath::Dot(d, back) + std::max(high, wide) / tangent);
  }
  camera->SetFocalPoint(centre);
  camera->SetPosition(centre[0] + back[0] * distance, centre[1] + back[1] * distance,
    centre[2] + back[2] * distance);
  camera->SetViewUp(view_up);
}

vtkSmartPointer<vtkCamera> make_camera(const SceneOptions& options, const Input& input)
{
  auto camera = vtkSmartPointer<vtkCamera>::New();
  camera->SetViewAngle(options.camera_view_angle);
  const double aspect = double(options.resolution[0]) / options.resolution[1];
  const double patient[3] = { -0.45, 0.85, 0.35 };
  const double thing[3] = { 0.45, -0.85, 0.3 };
  const std::array<double, 3> up = options.camera_view_up.value_or(std::array<double, 3>{ 0, 0, 1 });
  fit_camera(input.image, camera, aspect, input.patient_axes ? patient : thing, up.data());
  if (options.camera_focal_point)
  {
    camera->SetFocalPoint(options.camera_focal_point->data());
  }
  if (options.camera_position)
  {
    camera->SetPosition(options.camera_position->data());
  }
  if (camera->GetDistance() <= 0.0 ||
    vtkMath::Distance2BetweenPoints(camera->GetPosition(), camera->GetFocalPoint()) == 0.0)
  {
    throw Failure("--camera-position", "the eye is at the focal point",
      "move one of them: --camera-focal-point", BadCall);
  }
  double along[3];
  double cross[3];
  camera->GetDirectionOfProjection(along);
  vtkMath::Cross(along, up.data(), cross);
  if (vtkMath::Norm(cross) < 1e-6 * vtkMath::Norm(up.data()) || vtkMath::Norm(up.data()) == 0.0)
  {
    throw Failure("--camera-view-up", "up is along the line of sight",
      "give another direction, such as 0,1,0", BadCall);
  }
  if (options.camera_parallel_scale)
  {
    camera->ParallelProjectionOn();
    camera->SetParallelScale(*options.camera_parallel_scale);
  }
  return camera;
}

double smallest_edge(vtkImageData* image)
{
  double spacing[3];
  image->GetSpacing(spacing);
  return std::min({ std::abs(spacing[0]), std::abs(spacing[1]), std::abs(spacing[2]) });
}

}

VolumeScene make_volume_scene(const SceneOptions& options)
{
  VolumeScene scene;
  scene.options = options;
  if (!options.preset.empty())
  {
    scene.preset = &find_preset(options.preset); // before the work of reading
  }
  scene.input = open_input_with_bar(options.input, options.quiet);
  vtkImageData* image = scene.input.image;
  if (!scene.preset)
  {
    const PresetChoice choice = choose_preset(image);
    scene.preset = choice.preset;
    scene.preset_reason = choice.reason;
  }
  if (!options.quiet)
  {
    for (const std::string& message : scene.input.messages)
    {
      std::cerr << "brume: " << options.input << ": " << message << '\n';
    }
    if (options.verbose && !scene.preset_reason.empty())
    {
      std::cerr << "brume: " << options.input << ": preset " << scene.preset->name << ": "
                << scene.preset_reason << '\n';
    }
  }

  vtkNew<vtkVolumeProperty> property;
  apply(*scene.preset, image, property);
  if (options.opacity_unit_distance)
  {
    property->SetScalarOpacityUnitDistance(*options.opacity_unit_distance);
  }
  if (options.shade != "preset")
  {
    property->SetShade(options.shade == "on");
  }
  property->SetInterpolationType(
    options.interpolation == "nearest" ? VTK_NEAREST_INTERPOLATION : VTK_LINEAR_INTERPOLATION);
  scene.opacity_unit_distance = property->GetScalarOpacityUnitDistance();
  scene.voxel_edge = smallest_edge(image);
  scene.volume = vtkSmartPointer<vtkVolume>::New();
  scene.volume->SetProperty(property);
  scene.camera = make_camera(options, scene.input);
  vtkNew<vtkLight> light;
  light->SetLightTypeToHeadlight();
  // VTK's CPU mapper takes ambient light from the lights, its GPU mapper does not: white serves both.
  light->SetAmbientColor(1.0, 1.0, 1.0);
  scene.lights = vtkSmartPointer<vtkLightCollection>::New();
  scene.lights->AddItem(light);
  return scene;
}

}
