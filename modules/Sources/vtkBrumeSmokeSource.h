/**
 * @class   vtkBrumeSmokeSource
 * @brief   a plume of hot smoke: density and temperature
 *
 * Dense, the output has two arrays of floats on its points: "density", the scalars, in [0, 1]
 * without a unit (multiply by an extinction, 4 to 20 per metre for the default width), and
 * "temperature" in kelvin. vtkBrumeMedium makes it glow by both. A sparse volume holds one of them,
 * SparseQuantity says which. Size, seed, time steps and sparse output are the superclass's, with
 * another default: time steps from 0 to 10 s.
 *
 * World units are metres: the volume fills a box of Width x Width x 2 Width, x and y around 0, z up
 * from 0. Nothing of the smoke comes nearer to the box's faces than 0.02 Width. The formula and its
 * sources: data-generators/plume.h.
 *
 * @sa vtkBrumeCloudSource
 */
#ifndef vtkBrumeSmokeSource_h
#define vtkBrumeSmokeSource_h

#include "vtkBrumeFieldSource.h"
#include "vtkBrumeSourcesModule.h" // for the export macro

namespace brume
{
struct PlumeOptions;
}

class VTKBRUMESOURCES_EXPORT vtkBrumeSmokeSource : public vtkBrumeFieldSource
{
public:
  static vtkBrumeSmokeSource* New();
  vtkTypeMacro(vtkBrumeSmokeSource, vtkBrumeFieldSource);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Width of the box, in metres; the plume grows with it. Default 4, range 0.01 to 1e6; outside it
   * the nearest end.
   */
  vtkSetClampMacro(Width, double, 0.01, 1e6);
  vtkGetMacro(Width, double);
  ///@}

  ///@{
  /**
   * How fast the turbulence rises, in metres a second. Default 1.2, any finite value.
   */
  vtkSetMacro(Rise, double);
  vtkGetMacro(Rise, double);
  ///@}

  ///@{
  /**
   * Temperature of the air around and of the source, in kelvin. Default 300 and 1900; above 0, and
   * the source not colder than the air.
   */
  vtkSetMacro(AirTemperature, double);
  vtkGetMacro(AirTemperature, double);
  vtkSetMacro(SourceTemperature, double);
  vtkGetMacro(SourceTemperature, double);
  ///@}

  enum Quantities
  {
    Density = 0,
    Temperature = 1 ///< kelvin; its background is AirTemperature
  };

  ///@{
  /**
   * What a sparse volume holds; a dense one holds both. Default Density; other values become the
   * nearest.
   */
  vtkSetClampMacro(SparseQuantity, int, Density, Temperature);
  vtkGetMacro(SparseQuantity, int);
  void SetSparseQuantityToDensity() { this->SetSparseQuantity(Density); }
  void SetSparseQuantityToTemperature() { this->SetSparseQuantity(Temperature); }
  ///@}

protected:
  vtkBrumeSmokeSource();
  ~vtkBrumeSmokeSource() override;

  std::shared_ptr<const brume::Field> MakeField() override;
  const char* GetFieldName() const override;
  float GetFieldBackground() const override;
  bool FillImage(vtkImageData* image,
    const brume::Field& field,
    const brume::Lattice& grid,
    double time) override;

  double Width = 4.0;
  double Rise = 1.2;
  double AirTemperature = 300.0;
  double SourceTemperature = 1900.0;
  int SparseQuantity = Density;

private:
  vtkBrumeSmokeSource(const vtkBrumeSmokeSource&) = delete;
  void operator=(const vtkBrumeSmokeSource&) = delete;

  brume::PlumeOptions GetOptions() const;
  bool IsTemperature() const;
};

#endif
