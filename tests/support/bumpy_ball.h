// The volume that benchmarks share: a soft ball with bumps, inside and out, that rays can go
// through.
#pragma once

#include "vtkColorTransferFunction.h"
#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkPiecewiseFunction.h"
#include "vtkPointData.h"
#include "vtkSmartPointer.h"
#include "vtkVolumeProperty.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace bumpy_ball
{

/// Density in [0, 1] at a place given in radii from the centre; 0 from 1.1 radii on.
inline double density(double x, double y, double z)
{
  const double r = std::sqrt(x * x + y * y + z * z);
  if (r >= 1.1)
  {
    return 0.0;
  }
  const double surface = 0.9 + 0.1 * std::sin(9.0 * x) * std::sin(8.0 * y) * std::sin(7.0 * z);
  const double t = std::clamp((surface - r) / 0.5 + 0.2, 0.0, 1.0);
  const double edge = t * t * (3.0 - 2.0 * t);
  return edge * (0.75 + 0.25 * std::sin(14.0 * x) * std::sin(13.0 * y) * std::sin(15.0 * z));
}

/// A ball: its centre and its radius, where the volume's cube is [-1, 1]³.
struct Ball
{
  double x = 0.0, y = 0.0, z = 0.0;
  double radius = 0.85;
};

/// n³ voxels of unsigned integers over [-1, 1]³ with these balls in it, `largest` for density 1.
/// The spacing is such that the volume's edge is `edge` long; its corner is at the origin.
template <class T>
vtkSmartPointer<vtkImageData> image(int n,
  int vtk_type,
  double edge,
  const std::vector<Ball>& balls = { Ball() },
  double largest = double(T(-1)) - 5.0)
{
  auto data = vtkSmartPointer<vtkImageData>::New();
  data->SetDimensions(n, n, n);
  data->SetSpacing(edge / (n - 1), edge / (n - 1), edge / (n - 1));
  data->AllocateScalars(vtk_type, 1);
  data->GetPointData()->GetScalars()->SetName("density");
  auto* values = static_cast<T*>(data->GetScalarPointer());
  const double scale = 2.0 / (n - 1);
  tbb::parallel_for(0,
    n,
    [&](int k)
    {
      T* slice = values + static_cast<std::size_t>(k) * n * n;
      std::fill(slice, slice + static_cast<std::size_t>(n) * n, T(0));
      for (const Ball& ball : balls)
      {
        const double reach = 1.1 * ball.radius;
        const double z = k * scale - 1.0 - ball.z;
        if (std::abs(z) > reach)
        {
          continue;
        }
        const auto first = [&](double centre)
        { return std::max(0, int(std::floor((centre - reach + 1.0) / scale))); };
        const auto last = [&](double centre)
        { return std::min(n - 1, int(std::ceil((centre + reach + 1.0) / scale))); };
        for (int j = first(ball.y); j <= last(ball.y); ++j)
        {
          for (int i = first(ball.x); i <= last(ball.x); ++i)
          {
            const double d = density((i * scale - 1.0 - ball.x) / ball.radius,
              (j * scale - 1.0 - ball.y) / ball.radius,
              z / ball.radius);
            T& value = slice[static_cast<std::size_t>(j) * n + i];
            value = std::max(value, static_cast<T>(std::floor(largest * d + 0.5)));
          }
        }
      }
    });
  return data;
}

/// 27 balls that fill `occupied` of the cube, one in each of 3³ equal boxes, at fixed places.
inline std::vector<Ball> scattered(double occupied)
{
  std::vector<Ball> balls;
  const double pi = 3.14159265358979323846;
  // A ball's density ends between 0.9 and 1.1 radii.
  const double radius = std::cbrt(occupied * 8.0 / 27.0 * 3.0 / (4.0 * pi));
  std::uint32_t state = 1;
  const auto shift = [&]
  {
    state = state * 1664525u + 1013904223u; // Numerical Recipes' generator: any fixed one will do
    return (double(state >> 8) / (1 << 24) * 2.0 - 1.0) * std::max(0.0, 1.0 / 3.0 - 1.1 * radius);
  };
  for (int k = -1; k <= 1; ++k)
    for (int j = -1; j <= 1; ++j)
      for (int i = -1; i <= 1; ++i)
      {
        Ball ball;
        ball.x = i * 2.0 / 3.0 + shift();
        ball.y = j * 2.0 / 3.0 + shift();
        ball.z = k * 2.0 / 3.0 + shift();
        ball.radius = radius;
        balls.push_back(ball);
      }
  return balls;
}

/// Blue outside, warm inside. Through the middle of a ball of radius 0.85 in a volume whose edge is
/// `edge` long about an eighth of the light passes.
inline vtkSmartPointer<vtkVolumeProperty> property(double largest, double edge)
{
  auto result = vtkSmartPointer<vtkVolumeProperty>::New();
  vtkNew<vtkPiecewiseFunction> opacity;
  opacity->AddPoint(0.0, 0.0);
  opacity->AddPoint(largest, 0.02);
  vtkNew<vtkColorTransferFunction> colour;
  colour->AddRGBPoint(0.0, 0.1, 0.2, 0.9);
  colour->AddRGBPoint(0.5 * largest, 0.8, 0.7, 0.5);
  colour->AddRGBPoint(largest, 1.0, 0.6, 0.2);
  result->SetScalarOpacity(opacity);
  result->SetColor(colour);
  result->SetScalarOpacityUnitDistance(edge / 255.0);
  result->SetInterpolationTypeToLinear();
  result->SetAmbient(0.2);
  result->SetDiffuse(0.7);
  result->SetSpecular(0.3);
  result->SetSpecularPower(20.0);
  return result;
}

}
