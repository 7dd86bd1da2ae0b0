/**
 * @class   vtkBrumeSignedDistanceSource
 * @brief   a shape by signed distance, sampled at voxels
 *
 * Gives a vtkImageData of floats: the density of matter that fills the shape ("density", from 0 to
 * 1, the default), or the signed distance itself ("distance", world units, below 0 inside). The
 * shape is written down; the language is in data-generators/shape_text.h, what each shape is and
 * how exact its distance in data-generators/shape.h.
 *
 * The volume fills Bounds or, where they are not set, the shape's own bounds and 5 % of their
 * longest side more on each side.
 *
 * The source makes the pieces that it is asked for; together they equal the whole, to the bit. The
 * same settings give the same bytes on every machine and with any number of threads. It reports
 * progress, and stops soon after AbortExecute is set: the output is then empty, and the next update
 * starts over.
 *
 * @sa vtkBrumeSignedDistance
 */
#ifndef vtkBrumeSignedDistanceSource_h
#define vtkBrumeSignedDistanceSource_h

#include "vtkBrumeSourcesModule.h" // for the export macro
#include "vtkImageAlgorithm.h"

#include <string> // for the shape's description

namespace brume
{
class Shape;
struct Lattice;
}

class VTKBRUMESOURCES_EXPORT vtkBrumeSignedDistanceSource : public vtkImageAlgorithm
{
public:
  static vtkBrumeSignedDistanceSource* New();
  vtkTypeMacro(vtkBrumeSignedDistanceSource, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The shape. Default "(sphere 1)". A text that describes none is an error when the source is
   * updated, which tells the line and the column, and gives an empty output; null counts as an
   * empty text.
   */
  void SetDescription(const char* text);
  const char* GetDescription() const { return this->Description.c_str(); }
  ///@}

  enum Quantities
  {
    Density = 0, ///< 1 inside, 0 outside, passing over EdgeWidth
    Distance = 1 ///< the signed distance, world units
  };

  ///@{
  /**
   * What the voxels hold. Default Density; other values become the nearest.
   */
  vtkSetClampMacro(Quantity, int, Density, Distance);
  vtkGetMacro(Quantity, int);
  void SetQuantityToDensity() { this->SetQuantity(Density); }
  void SetQuantityToDistance() { this->SetQuantity(Distance); }
  ///@}

  ///@{
  /**
   * Voxels along the longest side of the volume. Voxels are cubes; the other sides get as many as
   * fit, at least 2. Default 128, range 2 to 4096; outside it the nearest end.
   */
  vtkSetClampMacro(Size, int, 2, 4096);
  vtkGetMacro(Size, int);
  ///@}

  ///@{
  /**
   * Width over which the density passes from 1 to 0, in voxels, the surface in its middle: along
   * 3 t^2 - 2 t^3 of the signed distance. Default 2, range 0 (a step) to 100; outside it the
   * nearest end. Has no effect on the distance.
   */
  vtkSetClampMacro(EdgeWidth, double, 0.0, 100.0);
  vtkGetMacro(EdgeWidth, double);
  ///@}

  ///@{
  /**
   * The box of the volume, xmin, xmax, ymin, …, in world units. Default 1, -1, …: none, the shape's
   * own. A shape with no end (a plane, copies without end) needs them.
   */
  vtkSetVector6Macro(Bounds, double);
  vtkGetVector6Macro(Bounds, double);
  ///@}

protected:
  vtkBrumeSignedDistanceSource();
  ~vtkBrumeSignedDistanceSource() override;

  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

  std::string Description = "(sphere 1)";
  int Quantity = Density;
  int Size = 128;
  double EdgeWidth = 2.0;
  double Bounds[6] = { 1.0, -1.0, 1.0, -1.0, 1.0, -1.0 };

private:
  vtkBrumeSignedDistanceSource(const vtkBrumeSignedDistanceSource&) = delete;
  void operator=(const vtkBrumeSignedDistanceSource&) = delete;

  // Throws std::invalid_argument where there is none.
  brume::Lattice GetGrid(const brume::Shape& shape) const;
};

#endif
