/**
 * @class   vtkBrumeSignedDistance
 * @brief   a shape by signed distance, as an implicit function
 *
 * Takes a shape written down, as in
 *
 *   (smooth-unite 0.3 (sphere 1) (move 0 0 1.2 (box 0.5 0.5 0.5 0.1)))
 *
 * and is its signed distance: below 0 inside, above 0 outside, in world units. All of VTK's filters
 * that take an implicit function take it: vtkSampleFunction, vtkCutter, vtkClipDataSet, … The
 * language is in data-generators/shape_text.h, what each shape is and how exact its distance in
 * data-generators/shape.h. SetTransform of the superclass works as everywhere in VTK; Lipschitz and
 * bounds are those of the shape without it.
 *
 * Any number of threads may evaluate it at once, while no setting changes.
 *
 * @sa vtkBrumeSignedDistanceSource
 */
#ifndef vtkBrumeSignedDistance_h
#define vtkBrumeSignedDistance_h

#include "vtkBrumeSourcesModule.h" // for the export macro
#include "vtkImplicitFunction.h"

#include <memory> // for the shape
#include <string> // for its description

namespace brume
{
class Shape;
}

class VTKBRUMESOURCES_EXPORT vtkBrumeSignedDistance : public vtkImplicitFunction
{
public:
  static vtkBrumeSignedDistance* New();
  vtkTypeMacro(vtkBrumeSignedDistance, vtkImplicitFunction);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The shape. Default "(sphere 1)". A text that describes none is an error, which tells the line
   * and the column, and leaves the shape that was there; null counts as an empty text.
   */
  void SetDescription(const char* text);
  const char* GetDescription() const { return this->Description.c_str(); }
  ///@}

  ///@{
  /**
   * About the size of the shape's details, in world units: gradients are central differences over
   * 2e-5 of it. Default 1, range 1e-9 to 1e9; outside it the nearest end.
   */
  vtkSetClampMacro(DetailSize, double, 1e-9, 1e9);
  vtkGetMacro(DetailSize, double);
  ///@}

  ///@{
  /**
   * The signed distance at a place, and its gradient: of length 1 where the distance is exact and
   * smooth, at most Lipschitz everywhere. Not a number where the place is not.
   */
  using Superclass::EvaluateFunction;
  double EvaluateFunction(double x[3]) override;
  void EvaluateGradient(double x[3], double g[3]) override;
  ///@}

  /**
   * The shape's Lipschitz constant: the distance to the surface is no less than
   * |EvaluateFunction|/Lipschitz.
   */
  double GetLipschitz() const;

  /**
   * A box that holds the inside, as xmin, xmax, ymin, … False if it has faces at infinity, or the
   * inside is known to be empty; the values are then as VTK has them for no bounds.
   */
  bool GetShapeBounds(double bounds[6]) const;

  /**
   * The shape itself, for those who use data-generators.
   */
  const brume::Shape& GetShape() const { return *this->Shape; }

protected:
  vtkBrumeSignedDistance();
  ~vtkBrumeSignedDistance() override;

  std::string Description;
  double DetailSize = 1.0;

private:
  vtkBrumeSignedDistance(const vtkBrumeSignedDistance&) = delete;
  void operator=(const vtkBrumeSignedDistance&) = delete;

  std::unique_ptr<brume::Shape> Shape;
};

#endif
