#include "vtkBrumeSignedDistanceSource.h"

#include "vtkBrumeSourceTools.h"

#include "data-generators/shape_text.h"

#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <stdexcept>

vtkStandardNewMacro(vtkBrumeSignedDistanceSource);

vtkBrumeSignedDistanceSource::vtkBrumeSignedDistanceSource()
{
  this->SetNumberOfInputPorts(0);
}

vtkBrumeSignedDistanceSource::~vtkBrumeSignedDistanceSource() = default;

void vtkBrumeSignedDistanceSource::SetDescription(const char* text)
{
  const std::string description = text ? text : "";
  if (description != this->Description)
  {
    this->Description = description;
    this->Modified();
  }
}

brume::Lattice vtkBrumeSignedDistanceSource::GetGrid(const brume::Shape& shape) const
{
  const double* b = this->Bounds;
  brume::Box box{ { b[0], b[2], b[4] }, { b[1], b[3], b[5] } };
  const int axes_set = (b[0] < b[1]) + (b[2] < b[3]) + (b[4] < b[5]);
  if (std::any_of(b, b + 6, [](double x) { return !std::isfinite(x); }) ||
      (axes_set != 0 && axes_set != 3))
  {
    throw std::invalid_argument("Bounds must be finite, each axis' lower end below its upper one; "
                                "or every lower end above its upper one for the shape's own box");
  }
  if (axes_set == 0)
  {
    box = shape.bounds();
    const glm::dvec3 side = box.upper - box.lower;
    const double longest = std::max({ side.x, side.y, side.z });
    if (!(std::min({ side.x, side.y, side.z }) > 0.0) || !std::isfinite(longest))
    {
      throw std::invalid_argument("the shape has no end, or no inside: set Bounds");
    }
    box.lower -= 0.05 * longest;
    box.upper += 0.05 * longest;
  }
  return brume::grid_over(box, this->Size);
}

int vtkBrumeSignedDistanceSource::RequestInformation(vtkInformation*,
  vtkInformationVector**,
  vtkInformationVector* outputs)
{
  try
  {
    const brume::Shape shape = brume::shape_from_text(this->Description);
    brume::describe_grid(this->GetGrid(shape), VTK_FLOAT, outputs->GetInformationObject(0));
  }
  catch (const std::exception& problem)
  {
    vtkErrorMacro("the description and the bounds make no volume: " << problem.what());
    return 0;
  }
  return 1;
}

int vtkBrumeSignedDistanceSource::RequestData(vtkInformation*,
  vtkInformationVector**,
  vtkInformationVector* outputs)
{
  vtkInformation* info = outputs->GetInformationObject(0);
  vtkImageData* image = vtkImageData::GetData(info);
  try
  {
    const brume::Shape shape = brume::shape_from_text(this->Description);
    const brume::Lattice grid = this->GetGrid(shape);
    const bool density = this->Quantity == Density;
    const brume::ShapeField field(shape,
      {},
      density ? brume::ShapeField::Quantity::density : brume::ShapeField::Quantity::distance,
      this->EdgeWidth * grid.spacing.x);
    this->AllocateOutputData(image, info);
    image->GetPointData()->GetScalars()->SetName(density ? "density" : "distance");
    const brume::Extent block = brume::extent_of(image->GetExtent());
    if (block.voxels() > 0 && !brume::sample(field,
                                0.0,
                                grid,
                                block,
                                static_cast<float*>(image->GetScalarPointer()),
                                brume::progress_of(this)))
    {
      image->Initialize();
    }
  }
  catch (const std::exception& problem)
  {
    image->Initialize();
    vtkErrorMacro("the shape could not be sampled: " << problem.what());
    return 0;
  }
  return 1;
}

void vtkBrumeSignedDistanceSource::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Description: " << this->Description << "\n";
  os << indent << "Quantity: " << (this->Quantity == Density ? "Density" : "Distance") << "\n";
  os << indent << "Size: " << this->Size << " voxels\n";
  os << indent << "EdgeWidth: " << this->EdgeWidth << " voxels\n";
  os << indent << "Bounds:";
  for (const double b : this->Bounds)
  {
    os << ' ' << b;
  }
  os << "\n";
}
