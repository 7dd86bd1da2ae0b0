// Scenes of Transport before the mappers: as vtkImageData, vtkVolume, vtkLight and vtkCamera. And
// the mappers as integrators of single rays, each the middle of a parallel view from one of its
// ends to the other.
//
// What a camera of VTK cannot tell: a direction's parts below 1e-16 of it, since it keeps
// directions as unit vectors, and matrices that are no numbers.
#pragma once

#include "ray_integrators.h"

#include "vtkBrumeVolumeMapper.h"

#include "vtkCamera.h"
#include "vtkLightCollection.h"
#include "vtkNew.h"
#include "vtkSmartPointer.h"
#include "vtkTestErrorObserver.h"
#include "vtkVolume.h"

namespace stability
{

struct NamedMapper
{
  std::string name;
  vtkSmartPointer<vtkBrumeVolumeMapper> mapper;
};

/// One of each, new: the march with fixed steps and shadow rays, paths that scatter once, and the
/// smart mapper with a tolerance.
std::vector<NamedMapper> new_mappers(double step, int paths = 1, double tolerance = 1e-6);

/// The camera of a view; and one whose middle line runs from one place to another.
vtkSmartPointer<vtkCamera> vtk_camera(const View& view);
vtkSmartPointer<vtkCamera> vtk_camera(const glm::dvec3& from, const glm::dvec3& to);

/// The first volume of a scene, a density, lit or not, dense or sparse, and all lights, before a
/// mapper.
class MapperScene
{
public:
  MapperScene(vtkBrumeVolumeMapper* mapper, const Scene& scene, vtkCamera* camera);

  /// A picture of so many pixels along each edge; expected to be drawn.
  Film film(int edge);
  /// Whether a picture is refused with an error, or else is in bounds: never NaN.
  bool refused_or_sane(int edge);

private:
  vtkSmartPointer<vtkBrumeVolumeMapper> Mapper;
  vtkSmartPointer<vtkCamera> Camera;
  vtkNew<vtkVolume> Volume;
  vtkNew<vtkLightCollection> Lights;
  vtkNew<vtkTest::ErrorObserver> Errors;
};

/// Transmittance, by fixed steps; and lit by a sun behind the camera, with shadow rays, and
/// glowing.
RayIntegrator by_march_mapper();
RayIntegrator by_lit_march_mapper();
/// Transmittance; and lit, scattering once.
RayIntegrator by_path_mapper();
RayIntegrator by_lit_path_mapper();
/// Transmittance and glow, whatever it chooses.
RayIntegrator by_smart_mapper();

}
