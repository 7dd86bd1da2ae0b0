// Small VTK scenes before each of the mappers: what is shown, what is refused, what is told.
#pragma once

#include "../support/vtk_scenes.h"

#include "Transport/marcher.h"
#include "Transport/reference.h"

#include "vtkBrumePathTraceMapper.h"
#include "vtkBrumeRayMarchMapper.h"
#include "vtkBrumeSmartVolumeMapper.h"

#include "vtkCommand.h"
#include "vtkFloatArray.h"
#include "vtkTestErrorObserver.h"
#include "vtkTypeTraits.h"

#include <glm/vec3.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace mapper_stage
{

using namespace vtk_scenes;
using brume::Film;

constexpr int size = 12;               ///< edge of pictures
constexpr int constant_size = 6;       ///< voxels of constant_image along each edge
constexpr double constant_depth = 5.0; ///< and the way through it
// Of a picture of constant_image as Stage::show has it.
constexpr int middle = size / 2 * size + size / 2;
constexpr int left_pixel = size / 2 * size + 2;
constexpr int right_pixel = size / 2 * size + size - 3;

inline vtkSmartPointer<vtkImageData> constant_image(int type, double value)
{
  auto data = vtkSmartPointer<vtkImageData>::New();
  data->SetDimensions(constant_size, constant_size, constant_size);
  auto scalars = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(type));
  scalars->SetNumberOfTuples(constant_size * constant_size * constant_size);
  scalars->Fill(value);
  data->GetPointData()->SetScalars(scalars);
  return data;
}

/// Whole numbers of 64 bits, whose extremes no double has.
inline void set_whole_extremes(vtkDataArray* values)
{
  const bool is_signed =
    values->GetDataType() == VTK_LONG || values->GetDataType() == VTK_LONG_LONG;
  for (vtkIdType i = 0; i < values->GetNumberOfTuples(); ++i)
  {
    const bool right = i % constant_size >= constant_size / 2;
    void* at = values->GetVoidPointer(i);
    if (is_signed)
    {
      *static_cast<std::int64_t*>(at) = right ? INT64_MAX : INT64_MIN;
    }
    else
    {
      *static_cast<std::uint64_t*>(at) = right ? UINT64_MAX : 0;
    }
  }
  values->Modified();
}

/// A volume before a mapper, seen along −z in parallel projection, linear between its voxels.
struct Stage
{
  using Points = std::vector<std::pair<double, double>>;

  vtkSmartPointer<vtkBrumeVolumeMapper> mapper;
  vtkSmartPointer<vtkVolume> volume = volume_of();
  vtkNew<vtkCamera> camera;
  vtkNew<vtkTest::ErrorObserver> errors;

  explicit Stage(vtkSmartPointer<vtkBrumeVolumeMapper> which)
    : mapper(which)
  {
    mapper->AddObserver(vtkCommand::ErrorEvent, errors);
    mapper->AddObserver(vtkCommand::WarningEvent, errors);
    volume->SetMapper(mapper);
  }

  void look_down(const glm::dvec3& centre, double half_height)
  {
    camera->ParallelProjectionOn();
    camera->SetParallelScale(half_height);
    camera->SetFocalPoint(centre.x, centre.y, centre.z);
    camera->SetPosition(centre.x, centre.y, centre.z + 1000.0);
    camera->SetViewUp(0.0, 1.0, 0.0);
    camera->SetClippingRange(1.0, 2000.0);
  }
  void show(vtkImageData* image)
  {
    mapper->SetInputDataObject(image);
    double bounds[6];
    image->GetBounds(bounds);
    look_down({ 0.5 * (bounds[0] + bounds[1]),
                0.5 * (bounds[2] + bounds[3]),
                0.5 * (bounds[4] + bounds[5]) },
      0.5 * (bounds[3] - bounds[2]));
  }
  void opacities(const Points& points)
  {
    vtkNew<vtkPiecewiseFunction> function;
    for (const auto& [value, opacity] : points)
    {
      function->AddPoint(value, opacity);
    }
    volume->GetProperty()->SetScalarOpacity(function);
  }
  /// Greys.
  void colours(const Points& points)
  {
    vtkNew<vtkColorTransferFunction> function;
    for (const auto& [value, grey] : points)
    {
      function->AddRGBPoint(value, grey, grey, grey);
    }
    volume->GetProperty()->SetColor(function);
  }
  void unit(double distance) { volume->GetProperty()->SetScalarOpacityUnitDistance(distance); }

  Film film(int edge = size)
  {
    errors->Clear();
    Film result(edge, edge);
    EXPECT_TRUE(mapper->RenderFilm(volume, camera, nullptr, result)) << errors->GetErrorMessage();
    return result;
  }
  Film reference(int edge = size)
  {
    Film result(edge, edge);
    brume::ReferenceSettings settings;
    settings.tolerance = 1e-5;
    const brume::Scene* scene = mapper->UpdateScene(volume, camera, nullptr, edge, edge);
    EXPECT_NE(scene, nullptr);
    if (scene)
    {
      brume::render_reference(*scene, settings, result);
    }
    return result;
  }
  /// The error that a render ends with; empty, and a failure of the test, if it does not.
  std::string refused()
  {
    errors->Clear();
    Film result(4, 4);
    EXPECT_FALSE(mapper->RenderFilm(volume, camera, nullptr, result));
    EXPECT_EQ(most_opaque(result), 0.0);
    return errors->GetErrorMessage();
  }
  double number(const char* key) const
  {
    return nlohmann::json::parse(mapper->GetStatistics()).at(key).get<double>();
  }
};

/// Each mapper before a fresh volume; the march with each SIMD target, if wanted.
inline void for_each_mapper(const std::function<void(Stage&, const std::string&)>& run,
  bool all_targets = true)
{
  std::istringstream names(brume::simd_targets());
  for (std::string target; names >> target;)
  {
    ASSERT_TRUE(brume::force_simd_target(target));
    Stage stage(vtkSmartPointer<vtkBrumeRayMarchMapper>::New());
    run(stage, "vtkBrumeRayMarchMapper, " + target);
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    all_targets = false; // kernels are not watched, and all else is the same
#endif
    if (!all_targets)
    {
      break;
    }
  }
  brume::force_simd_target("");
  auto paths = vtkSmartPointer<vtkBrumePathTraceMapper>::New();
  paths->SetSamplesPerPixel(8); // transmittance has no noise
  Stage traced(paths);
  run(traced, "vtkBrumePathTraceMapper");
  Stage smart(vtkSmartPointer<vtkBrumeSmartVolumeMapper>::New());
  run(smart, "vtkBrumeSmartVolumeMapper");
}

inline bool in_bounds(const Film& film)
{
  for (int c = 0; c < 3; ++c)
  {
    for (std::size_t i = 0; i < film.size(); ++i)
    {
      const float t = film.transmittance[c][i];
      const float l = film.radiance[c][i];
      if (!(t >= 0.0f && t <= 1.0f && l >= 0.0f && std::isfinite(l)))
      {
        return false;
      }
    }
  }
  return true;
}

/// The most of either, NaN if there is one.
inline double opacity_or_light(const Film& film)
{
  double most = 0.0;
  for (int c = 0; c < 3; ++c)
  {
    for (std::size_t i = 0; i < film.size(); ++i)
    {
      const double here =
        std::max(1.0 - double(film.transmittance[c][i]), double(film.radiance[c][i]));
      most = here <= most ? most : here;
    }
  }
  return most;
}

}
