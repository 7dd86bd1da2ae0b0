#include "vtkBrumeSignedDistanceSource.h"

#include "vtkBrumeSparseVolume.h"

#include "data-generators/sampling.h"
#include "data-generators/shape_text.h"

#include "vtkObjectFactory.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

vtkStandardNewMacro(vtkBrumeSignedDistanceSource);

vtkBrumeSignedDistanceSource::vtkBrumeSignedDistanceSource()
{
  this->Size = 128;
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

brume::Box vtkBrumeSignedDistanceSource::GetBox(const brume::Shape& shape) const
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
  return box;
}

bool vtkBrumeSignedDistanceSource::IsBand() const
{
  return this->Sparse && this->Quantity == Distance;
}

std::shared_ptr<const brume::Field> vtkBrumeSignedDistanceSource::MakeField()
{
  using brume::ShapeField;
  const brume::Shape shape = brume::shape_from_text(this->Description);
  const brume::Box box = this->GetBox(shape);
  const double spacing = brume::grid_over(box, this->Size).spacing.x;
  this->Band = static_cast<float>(this->BandWidth * spacing);
  return std::make_shared<const ShapeField>(shape,
    box,
    this->Quantity == Density ? ShapeField::Quantity::density : ShapeField::Quantity::distance,
    this->EdgeWidth * spacing,
    this->IsBand() ? double(this->Band) : std::numeric_limits<double>::infinity());
}

const char* vtkBrumeSignedDistanceSource::GetFieldName() const
{
  return this->Quantity == Density ? "density" : "distance";
}

float vtkBrumeSignedDistanceSource::GetFieldBackground() const
{
  return this->IsBand() ? this->Band : 0.0f;
}

int vtkBrumeSignedDistanceSource::GetFieldGridClass() const
{
  return this->IsBand() ? vtkBrumeSparseVolume::GridClassLevelSet
                        : vtkBrumeSparseVolume::GridClassFogVolume;
}

void vtkBrumeSignedDistanceSource::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Description: " << this->Description << "\n";
  os << indent << "Quantity: " << (this->Quantity == Density ? "Density" : "Distance") << "\n";
  os << indent << "EdgeWidth: " << this->EdgeWidth << " voxels\n";
  os << indent << "BandWidth: " << this->BandWidth << " voxels\n";
  os << indent << "Bounds:";
  for (const double b : this->Bounds)
  {
    os << ' ' << b;
  }
  os << "\n";
}
