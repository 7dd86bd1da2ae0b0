#include "ray_mappers.h"

#include "vtkBrumeMedium.h"
#include "vtkBrumePathTraceMapper.h"
#include "vtkBrumeRayMarchMapper.h"
#include "vtkBrumeSmartVolumeMapper.h"
#include "vtkBrumeSparseVolume.h"

#include "vtkCellData.h"
#include "vtkCommand.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkLight.h"
#include "vtkMatrix4x4.h"
#include "vtkPointData.h"
#include "vtkVolumeProperty.h"

#include "Transport/sparse_voxels.h"

#include <glm/ext/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <array>

namespace stability
{

namespace
{

vtkSmartPointer<vtkMatrix4x4> vtk_matrix(const glm::dmat4& m)
{
  auto matrix = vtkSmartPointer<vtkMatrix4x4>::New();
  for (int row = 0; row < 4; ++row)
  {
    for (int column = 0; column < 4; ++column)
    {
      matrix->SetElement(row, column, m[column][row]);
    }
  }
  return matrix;
}

/// Voxels of floats; the matrix as origin, spacing and direction, which need not be orthogonal.
vtkSmartPointer<vtkImageData> vtk_image(const Grid& grid, const glm::dmat4& data_from_index)
{
  // VTK's index space begins at the first point: half a cell before the first cell's centre.
  const glm::dmat4 from_points =
    grid.cell_centred ? glm::translate(data_from_index, glm::dvec3(-0.5)) : data_from_index;
  auto image = vtkSmartPointer<vtkImageData>::New();
  const int more = grid.cell_centred ? 1 : 0;
  const int last[3] = { grid.dims[0] - grid.padding_x - 1, grid.dims[1] - 1, grid.dims[2] - 1 };
  image->SetExtent(
    grid.first[0], last[0] + more, grid.first[1], last[1] + more, grid.first[2], last[2] + more);
  double direction[9];
  double spacing[3];
  for (int axis = 0; axis < 3; ++axis)
  {
    const glm::dvec3 column(from_points[axis]);
    spacing[axis] = glm::length(column);
    for (int row = 0; row < 3; ++row)
    {
      direction[3 * row + axis] = column[row] / spacing[axis];
    }
  }
  image->SetOrigin(from_points[3].x, from_points[3].y, from_points[3].z);
  image->SetSpacing(spacing);
  image->SetDirectionMatrix(direction);
  vtkNew<vtkFloatArray> values;
  const auto* voxels = static_cast<const float*>(grid.voxels);
  for (int k = grid.first[2]; k <= last[2]; ++k)
  {
    for (int j = grid.first[1]; j <= last[1]; ++j)
    {
      for (int i = grid.first[0]; i <= last[0]; ++i)
      {
        values->InsertNextValue(voxels[(k * grid.dims[1] + j) * grid.dims[0] + i]);
      }
    }
  }
  grid.cell_centred ? image->GetCellData()->SetScalars(values)
                    : image->GetPointData()->SetScalars(values);
  return image;
}

vtkSmartPointer<vtkLight> vtk_light(const Light& light)
{
  auto result = vtkSmartPointer<vtkLight>::New();
  const glm::dvec3 to = light.position + light.direction;
  result->SetLightTypeToSceneLight();
  result->SetPosition(light.position.x, light.position.y, light.position.z);
  result->SetFocalPoint(to.x, to.y, to.z);
  result->SetPositional(light.positional);
  result->SetAttenuationValues(light.attenuation.x, light.attenuation.y, light.attenuation.z);
  result->SetConeAngle(light.cone_angle);
  result->SetDiffuseColor(light.diffuse.x, light.diffuse.y, light.diffuse.z);
  return result;
}

/// A ray drawn by a mapper; lit, if wanted.
Film drawn(vtkBrumeVolumeMapper* mapper, const RampRay& ray, const Sends* sends = nullptr)
{
  RampScene ramp(ray);
  if (sends)
  {
    light_ramp(ray, ramp.scene, *sends);
  }
  const glm::dmat4 world = ray.world_from_data * ray.data_from_index;
  MapperScene stage(mapper,
    ramp.scene,
    vtk_camera(
      glm::dvec3(world * glm::dvec4(ray.from, 1.0)), glm::dvec3(world * glm::dvec4(ray.to, 1.0))));
  return stage.film(1);
}

constexpr double step = 0.37;

Pixel dimmed(const RampRay& ray)
{
  return { std::exp(-ray.optical_depth()), NAN };
}

}

std::vector<NamedMapper> new_mappers(double step, int paths, double tolerance)
{
  auto march = vtkSmartPointer<vtkBrumeRayMarchMapper>::New();
  march->SetAutoAdjustSampleDistances(0);
  march->SetSampleDistance(step);
  march->SetShadowMethodToRays();
  march->SetTolerance(0.0);
  auto path = vtkSmartPointer<vtkBrumePathTraceMapper>::New();
  path->SetSamplesPerPixel(paths);
  path->SetMaximumScatterings(1);
  path->SetTolerance(0.0);
  auto smart = vtkSmartPointer<vtkBrumeSmartVolumeMapper>::New();
  smart->SetTolerance(tolerance);
  std::vector<NamedMapper> all = { { "vtkBrumeRayMarchMapper", march },
    { "vtkBrumePathTraceMapper", path },
    { "vtkBrumeSmartVolumeMapper", smart } };
  for (const NamedMapper& one : all)
  {
    one.mapper->SetNumberOfThreads(1);
  }
  return all;
}

vtkSmartPointer<vtkCamera> vtk_camera(const View& view)
{
  auto camera = vtkSmartPointer<vtkCamera>::New();
  const glm::dvec3 eye = view.centre - glm::normalize(view.forward) * view.distance;
  camera->SetFocalPoint(view.centre.x, view.centre.y, view.centre.z);
  camera->SetPosition(eye.x, eye.y, eye.z);
  camera->SetViewUp(view.up.x, view.up.y, view.up.z);
  camera->SetParallelProjection(view.parallel);
  camera->SetParallelScale(view.half_height);
  camera->SetViewAngle(std::atan(view.half_height / view.distance) * 360.0 / pi);
  camera->SetClippingRange(view.near_plane, view.far_plane);
  return camera;
}

vtkSmartPointer<vtkCamera> vtk_camera(const glm::dvec3& from, const glm::dvec3& to)
{
  auto camera = vtkSmartPointer<vtkCamera>::New();
  const double length = glm::length(to - from);
  const bool steep = std::abs(to.x - from.x) >= 0.6 * length;
  camera->ParallelProjectionOn();
  camera->SetParallelScale(0.5 * length);
  camera->SetPosition(from.x, from.y, from.z);
  camera->SetFocalPoint(to.x, to.y, to.z);
  camera->SetViewUp(!steep, steep, 0.0);
  camera->SetClippingRange(0.0, length);
  return camera;
}

MapperScene::MapperScene(vtkBrumeVolumeMapper* mapper, const Scene& scene, vtkCamera* camera)
  : Mapper(mapper)
  , Camera(camera)
{
  mapper->AddObserver(vtkCommand::ErrorEvent, this->Errors);
  const brume::Volume& volume = scene.volumes[0];
  if (volume.grid.sparse)
  {
    vtkNew<vtkBrumeSparseVolume> sparse;
    // The scene keeps it for as long as this is.
    sparse->SetVoxels(
      std::shared_ptr<const SparseVoxels>(volume.grid.sparse, [](const SparseVoxels*) {}));
    const std::array<std::int32_t, 3>& first = volume.grid.sparse->origin();
    sparse->SetIndexToWorld(vtk_matrix(
      glm::translate(volume.data_from_index, -glm::dvec3(first[0], first[1], first[2]))));
    mapper->SetInputDataObject(sparse);
  }
  else
  {
    mapper->SetInputDataObject(vtk_image(volume.grid, volume.data_from_index));
  }
  mapper->SetExtinction(volume.density.extinction);
  vtkNew<vtkLight> off; // with no light at all there would be a headlight
  off->SwitchOff();
  this->Lights->AddItem(off);
  if (volume.medium.lit)
  {
    vtkNew<vtkBrumeMedium> medium;
    medium->SetExtinction(volume.density.extinction);
    medium->SetAlbedo(&volume.medium.albedo.x);
    medium->SetEmission(&volume.medium.emission.x);
    if (!volume.medium.lobes.empty())
    {
      medium->SetAnisotropy(volume.medium.lobes[0].anisotropy);
    }
    mapper->SetMedium(medium);
    for (const Light& light : scene.lights)
    {
      this->Lights->AddItem(vtk_light(light));
    }
  }
  this->Volume->SetUserMatrix(vtk_matrix(volume.world_from_data));
  this->Volume->GetProperty()->SetInterpolationType(
    volume.grid.linear ? VTK_LINEAR_INTERPOLATION : VTK_NEAREST_INTERPOLATION);
  this->Volume->SetMapper(mapper);
}

Film MapperScene::film(int edge)
{
  Film result(edge, edge);
  EXPECT_TRUE(this->Mapper->RenderFilm(this->Volume, this->Camera, this->Lights, result))
    << this->Errors->GetErrorMessage();
  return result;
}

bool MapperScene::refused_or_sane(int edge)
{
  Film result(edge, edge);
  if (!this->Mapper->RenderFilm(this->Volume, this->Camera, this->Lights, result))
  {
    return !this->Errors->GetErrorMessage().empty();
  }
  bool sane = all_finite(result);
  for (const float passes : result.transmittance[0])
  {
    sane = sane && passes >= 0.0f && passes <= 1.0f;
  }
  return sane;
}

RayIntegrator by_march_mapper()
{
  RayIntegrator one;
  one.name = "vtkBrumeRayMarchMapper";
  one.draw = [](const RampRay& ray, double&)
  {
    const Film film = drawn(new_mappers(step * longest_edge(ray))[0].mapper, ray);
    return Pixel{ film.transmittance[0][0], NAN };
  };
  one.truth = dimmed;
  return one;
}

RayIntegrator by_lit_march_mapper()
{
  RayIntegrator one;
  one.name = "vtkBrumeRayMarchMapper";
  one.bound = 5e-6;
  one.draw = [](const RampRay& ray, double&)
  {
    const Sends both = Sends::Both;
    const Film film = drawn(new_mappers(step * longest_edge(ray))[0].mapper, ray, &both);
    return Pixel{ film.transmittance[0][0], film.radiance[0][0] };
  };
  one.truth = [](const RampRay& ray) { return lit_truth(ray, Sends::Both); };
  return one;
}

RayIntegrator by_path_mapper()
{
  RayIntegrator one;
  one.name = "vtkBrumePathTraceMapper";
  one.draw = [](const RampRay& ray, double&) {
    return Pixel{ drawn(new_mappers(1.0)[1].mapper, ray).transmittance[0][0], NAN };
  };
  one.truth = dimmed;
  return one;
}

RayIntegrator by_lit_path_mapper()
{
  RayIntegrator one;
  one.name = "vtkBrumePathTraceMapper";
  one.random = true;
  one.bound = 4.5;
  one.draw = [](const RampRay& ray, double& error)
  {
    const Sends sunlight = Sends::Sunlight;
    const Film film = drawn(new_mappers(1.0, ray_paths)[1].mapper, ray, &sunlight);
    error = film.error[0] / 3.0;
    return Pixel{ film.transmittance[0][0], film.radiance[0][0] };
  };
  one.truth = [](const RampRay& ray) { return lit_truth(ray, Sends::Sunlight); };
  return one;
}

RayIntegrator by_smart_mapper()
{
  constexpr double tolerance = 1e-4;
  RayIntegrator one;
  one.name = "vtkBrumeSmartVolumeMapper";
  one.bound = tolerance;
  one.draw = [](const RampRay& ray, double&)
  {
    const Sends own = Sends::Glow;
    const Film film = drawn(new_mappers(1.0, 1, tolerance)[2].mapper, ray, &own);
    return Pixel{ film.transmittance[0][0], film.radiance[0][0] };
  };
  one.truth = [](const RampRay& ray) { return lit_truth(ray, Sends::Glow); };
  return one;
}

}
