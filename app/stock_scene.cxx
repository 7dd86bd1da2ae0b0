#include "stock_scene.h"

#include "vtkBrumeFog.h"
#include "vtkBrumeMedium.h"
#include "vtkBrumeSky.h"
#include "vtkBrumeSparseVolume.h"

#include "vtkCamera.h"
#include "vtkColorTransferFunction.h"
#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkLightCollection.h"
#include "vtkNew.h"
#include "vtkPiecewiseFunction.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"

#include <algorithm>
#include <cmath>

namespace brume::app
{

namespace
{

constexpr int opacity_points = 1024;

bool any(const Triple& v)
{
  return v != Triple{ 0.0, 0.0, 0.0 };
}

/// The opacity of a voxel's edge of density, and one colour.
vtkSmartPointer<vtkVolumeProperty> property_of_density(const VolumeScene& scene)
{
  auto property = vtkSmartPointer<vtkVolumeProperty>::New();
  property->SetInterpolationType(scene.volume->GetProperty()->GetInterpolationType());
  double range[2];
  scene.input.image->GetPointData()->GetScalars()->GetFiniteRange(range);
  const double largest = std::max(range[1], 1e-30);
  vtkNew<vtkPiecewiseFunction> opacity;
  for (int i = 0; i <= opacity_points; ++i)
  {
    const double density = largest * i / opacity_points;
    opacity->AddPoint(
      density, -std::expm1(-scene.options.extinction[0] * density * scene.voxel_edge));
  }
  const bool lit = scene.options.medium.has_medium();
  const Triple colour = lit ? scene.options.medium.albedo : Triple{ 0.0, 0.0, 0.0 };
  vtkNew<vtkColorTransferFunction> colours;
  colours->AddRGBPoint(0.0, colour[0], colour[1], colour[2]);
  property->SetScalarOpacity(opacity);
  property->SetColor(colours);
  property->SetScalarOpacityUnitDistance(scene.voxel_edge);
  property->SetShade(lit);
  property->SetAmbient(0.0);
  property->SetDiffuse(1.0);
  property->SetSpecular(0.0);
  return property;
}

}

std::string not_drawn_by_stock(const SceneOptions& options, const Input& input)
{
  if (input.sparse)
  {
    return "it would need the volume dense";
  }
  const Triple& extinction = options.extinction;
  if (extinction[0] != extinction[1] || extinction[0] != extinction[2])
  {
    return "it has one opacity for red, green and blue, and this extinction has three";
  }
  return {};
}

std::vector<std::string> left_out_by_stock(const SceneOptions& options)
{
  const MediumOptions& medium = options.medium;
  std::vector<std::string> words;
  const auto add = [&](bool there, const char* name)
  {
    if (there)
    {
      words.emplace_back(name);
    }
  };
  add(medium.has_medium(), "light scattered in the medium");
  add(medium.has_medium(), "shadows in the medium");
  add(any(medium.emission) || medium.black_body > 0.0, "light that the medium emits");
  add(any(medium.sky_radiance) || any(medium.ground_radiance), "light of sky and ground");
  add(!medium.environment.empty(), "light of the environment");
  add(medium.has_fog(), "fog");
  return words;
}

VolumeScene stock_scene(const VolumeScene& scene)
{
  VolumeScene stock = scene;
  stock.volume = vtkSmartPointer<vtkVolume>::New();
  if (scene.options.density())
  {
    stock.volume->SetProperty(property_of_density(scene));
    stock.opacity_unit_distance = scene.voxel_edge;
  }
  else
  {
    stock.volume->SetProperty(scene.volume->GetProperty());
  }
  stock.options.extinction = { 0.0, 0.0, 0.0 };
  stock.medium = nullptr;
  stock.sky = nullptr;
  stock.fog = nullptr;
  return stock;
}

}
