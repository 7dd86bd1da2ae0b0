// Small VTK scenes for the tests of the mappers.
#pragma once

#include "Transport/film.h"

#include "vtkCamera.h"
#include "vtkCellData.h"
#include "vtkColorTransferFunction.h"
#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkPiecewiseFunction.h"
#include "vtkPointData.h"
#include "vtkSmartPointer.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"

#include <algorithm>
#include <cmath>

namespace vtk_scenes
{

/// A ball with a soft edge, off the centre, in [0, 200].
inline double ball(double x, double y, double z)
{
  const double r = std::sqrt((x - 0.1) * (x - 0.1) + y * y + (z + 0.15) * (z + 0.15));
  return 200.0 / (1.0 + std::exp(12.0 * (r - 0.6 - 0.06 * std::sin(7.0 * x) * std::sin(6.0 * y))));
}

template <class Value>
vtkSmartPointer<vtkImageData> image(
  int nx, int ny, int nz, int type, Value value, int components = 1, bool cells = false)
{
  auto data = vtkSmartPointer<vtkImageData>::New();
  const int more = cells ? 1 : 0;
  data->SetDimensions(nx + more, ny + more, nz + more);
  auto scalars = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(type));
  scalars->SetName("values");
  scalars->SetNumberOfComponents(components);
  scalars->SetNumberOfTuples(vtkIdType(nx) * ny * nz);
  vtkIdType at = 0;
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i, ++at)
        for (int c = 0; c < components; ++c)
          scalars->SetComponent(at, c, std::floor(value(i, j, k, c)));
  if (cells)
    data->GetCellData()->SetScalars(scalars);
  else
    data->GetPointData()->SetScalars(scalars);
  return data;
}

inline vtkSmartPointer<vtkImageData> ball_image(int type, int n = 32, bool cells = false)
{
  return image(
    n, n - 3, n + 2, type,
    [n](int i, int j, int k, int)
    { return ball(2.0 * i / (n - 1) - 1, 2.0 * j / (n - 4) - 1, 2.0 * k / (n + 1) - 1); },
    1, cells);
}

/// Warm inside, blue outside, half of it gone in two units.
inline vtkSmartPointer<vtkVolume> volume_of(double opacity = 0.5)
{
  auto volume = vtkSmartPointer<vtkVolume>::New();
  vtkNew<vtkPiecewiseFunction> opacities;
  opacities->AddPoint(20, 0.0);
  opacities->AddPoint(200, opacity);
  vtkNew<vtkColorTransferFunction> colours;
  colours->AddRGBPoint(0, 0.1, 0.2, 0.9);
  colours->AddRGBPoint(200, 1.0, 0.6, 0.2);
  vtkVolumeProperty* property = volume->GetProperty();
  property->SetScalarOpacity(opacities);
  property->SetColor(colours);
  property->SetInterpolationTypeToLinear();
  property->SetScalarOpacityUnitDistance(2.0);
  return volume;
}

inline void look_at(vtkCamera* camera, const double centre[3], double distance)
{
  camera->SetFocalPoint(centre);
  camera->SetPosition(
    centre[0] + 0.45 * distance, centre[1] - 0.35 * distance, centre[2] + 0.82 * distance);
  camera->SetViewUp(0, 1, 0);
}

inline double difference(const brume::Film& a, const brume::Film& b)
{
  double most = 0.0;
  for (int c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < a.size(); ++i)
      most = std::max({ most, double(std::abs(a.radiance[c][i] - b.radiance[c][i])),
        double(std::abs(a.transmittance[c][i] - b.transmittance[c][i])) });
  return most;
}

inline double most_opaque(const brume::Film& film)
{
  return 1.0 - *std::min_element(film.transmittance[0].begin(), film.transmittance[0].end());
}

}
