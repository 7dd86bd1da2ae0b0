/**
 * @class   vtkBrumeSignedDistanceSource
 * @brief   a shape by signed distance, sampled at voxels
 *
 * Gives the density of matter that fills the shape ("density", from 0 to 1, the default), or the
 * signed distance itself ("distance", world units, below 0 inside). The shape is written down; the
 * language is in data-generators/shape_text.h, what each shape is and how exact its distance in
 * data-generators/shape.h.
 *
 * The volume fills Bounds or, where they are not set, the shape's own bounds and 5 % of their
 * longest side more on each side.
 *
 * Dense or sparse output and size are the superclass's, with another default: Size 128. Sparse
 * distances are a level set in a narrow band: distances beyond BandWidth are held to that, negative
 * inside, and the background is that width. Shapes whose text gives a distance that changes faster
 * than the place (see shape.h) have a band that is narrower by as much.
 *
 * @sa vtkBrumeSignedDistance
 */
#ifndef vtkBrumeSignedDistanceSource_h
#define vtkBrumeSignedDistanceSource_h

#include "vtkBrumeSampledSource.h"
#include "vtkBrumeSourcesModule.h" // for the export macro

#include <string> // for the shape's description

namespace brume
{
class Shape;
struct Box;
}

class VTKBRUMESOURCES_EXPORT vtkBrumeSignedDistanceSource : public vtkBrumeSampledSource
{
public:
  static vtkBrumeSignedDistanceSource* New();
  vtkTypeMacro(vtkBrumeSignedDistanceSource, vtkBrumeSampledSource);
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
   * Width over which the density passes from 1 to 0, in voxels, the surface in its middle: along
   * 3 t^2 - 2 t^3 of the signed distance. Default 2, range 0 (a step) to 100; outside it the
   * nearest end. Has no effect on the distance.
   */
  vtkSetClampMacro(EdgeWidth, double, 0.0, 100.0);
  vtkGetMacro(EdgeWidth, double);
  ///@}

  ///@{
  /**
   * Half width of the band of a sparse distance, in voxels. Default 3, as OpenVDB has it; range 1
   * to 100; outside it the nearest end. Has no effect on the density, nor on a dense distance.
   */
  vtkSetClampMacro(BandWidth, double, 1.0, 100.0);
  vtkGetMacro(BandWidth, double);
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

  std::shared_ptr<const brume::Field> MakeField() override;
  const char* GetFieldName() const override;
  float GetFieldBackground() const override;
  int GetFieldGridClass() const override;

  std::string Description = "(sphere 1)";
  int Quantity = Density;
  double EdgeWidth = 2.0;
  double BandWidth = 3.0;
  double Bounds[6] = { 1.0, -1.0, 1.0, -1.0, 1.0, -1.0 };

private:
  vtkBrumeSignedDistanceSource(const vtkBrumeSignedDistanceSource&) = delete;
  void operator=(const vtkBrumeSignedDistanceSource&) = delete;

  bool IsBand() const;

  // Throws std::invalid_argument where there is none.
  brume::Box GetBox(const brume::Shape& shape) const;

  float Band = 0.0f; // of the field, world units
};

#endif
