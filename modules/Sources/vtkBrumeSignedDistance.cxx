#include "vtkBrumeSignedDistance.h"

#include "data-generators/shape_text.h"

#include "vtkMath.h"
#include "vtkObjectFactory.h"

#include <cmath>
#include <exception>

vtkStandardNewMacro(vtkBrumeSignedDistance);

vtkBrumeSignedDistance::vtkBrumeSignedDistance()
  : Description("(sphere 1)")
  , Shape(std::make_unique<brume::Shape>(brume::shapes::sphere(1.0)))
{
}

vtkBrumeSignedDistance::~vtkBrumeSignedDistance() = default;

void vtkBrumeSignedDistance::SetDescription(const char* text)
{
  const std::string description = text ? text : "";
  if (description == this->Description)
  {
    return;
  }
  try
  {
    this->Shape = std::make_unique<brume::Shape>(brume::shape_from_text(description));
    this->Description = description;
    this->Modified();
  }
  catch (const std::exception& problem)
  {
    vtkErrorMacro("the text describes no shape: " << problem.what());
  }
}

double vtkBrumeSignedDistance::EvaluateFunction(double x[3])
{
  return this->Shape->distance({ x[0], x[1], x[2] });
}

void vtkBrumeSignedDistance::EvaluateGradient(double x[3], double g[3])
{
  const glm::dvec3 slope = this->Shape->gradient({ x[0], x[1], x[2] }, this->DetailSize);
  g[0] = slope.x;
  g[1] = slope.y;
  g[2] = slope.z;
}

double vtkBrumeSignedDistance::GetLipschitz() const
{
  return this->Shape->lipschitz();
}

bool vtkBrumeSignedDistance::GetShapeBounds(double bounds[6]) const
{
  const brume::Box box = this->Shape->bounds();
  bool usable = true;
  for (int a = 0; a < 3; ++a)
  {
    usable = usable && std::isfinite(box.lower[a]) && std::isfinite(box.upper[a]) &&
             box.lower[a] < box.upper[a];
    bounds[2 * a] = box.lower[a];
    bounds[2 * a + 1] = box.upper[a];
  }
  if (!usable)
  {
    vtkMath::UninitializeBounds(bounds);
  }
  return usable;
}

void vtkBrumeSignedDistance::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Description: " << this->Description << "\n";
  os << indent << "DetailSize: " << this->DetailSize << "\n";
  os << indent << "Lipschitz: " << this->GetLipschitz() << "\n";
}
