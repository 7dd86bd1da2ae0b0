/**
 * @class   vtkBrumePhantomSource
 * @brief   scans that nobody had to be scanned for, and fields whose truth is known
 *
 * Made of formulas, as a vtkImageData.
 *
 * Scans in Hounsfield units (air -1000, water 0, enamel 2600; each tissue's number in
 * data-generators/hounsfield.h), 16-bit integers in [-1024, 3071], point scalars named
 * "Hounsfield". World units are millimetres, coordinates are RAS+: x grows from the patient's left
 * to the patient's right, y from back to front, z from foot to crown, with the origin at the middle
 * of the volume (DICOM's axes are LPS: x and y the other way).
 * - HeadCT: a box of 192 x 240 x 256 mm, so that Size = 256 gives 192 x 240 x 256 voxels of 1 mm.
 * To tell left from right there is a ceramic bead (4 mm radius, 2800 HU) on the patient's left
 *   temple, at (-75, 22, 24). What anatomy there is: data-generators/head_ct.h.
 * - TorsoCT: a box of 400 x 280 x 560 mm, from the neck to the hips; liver on the right, the
 * heart's tip on the left. What anatomy there is: data-generators/torso_ct.h.
 *
 * Fields of floats named "density", without a unit, in the box [-1, 1]^3 world units, each of which
 * knows its exact integral along any ray (GetOpticalDepth): data-generators/exact_field.h and
 * shepp_logan.h.
 * - SheppLogan: ten ellipsoids, the head phantom of Shepp and Logan in three dimensions.
 * - Constant: Density everywhere.
 * - Ramp: from 0 at x = -1 to Density at x = 1.
 * - Ball: Density within Radius of the middle.
 * - SoftBall: Density (1 - r^2/Radius^2).
 * - Slab: Density between two planes, Thickness apart, the middle between them.
 * - Checker: Cells along each axis, Density and 0 by turns.
 *
 * The source makes the pieces that it is asked for; together they equal the whole, to the bit. The
 * same settings give the same bytes on every machine and with any number of threads. It reports
 * progress, and stops soon after AbortExecute is set: the output is then empty, and the next update
 * starts over. A setting that makes no phantom is an error, and gives an empty output.
 *
 * @sa vtkBrumeCloudSource
 */
#ifndef vtkBrumePhantomSource_h
#define vtkBrumePhantomSource_h

#include "vtkBrumeSourcesModule.h" // for the export macro
#include "vtkImageAlgorithm.h"

#include <memory> // for the phantom that is kept

namespace brume
{
class ExactField;
class PaintedVolume;
struct Box;
}

class VTKBRUMESOURCES_EXPORT vtkBrumePhantomSource : public vtkImageAlgorithm
{
public:
  static vtkBrumePhantomSource* New();
  vtkTypeMacro(vtkBrumePhantomSource, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum Kinds
  {
    KindHeadCT = 0,     ///< CT of a head, with contrast medium in its vessels
    KindTorsoCT = 1,    ///< CT of a torso, likewise
    KindSheppLogan = 2, ///< the fields, see above
    KindConstant = 3,
    KindRamp = 4,
    KindBall = 5,
    KindSoftBall = 6,
    KindSlab = 7,
    KindChecker = 8
  };

  ///@{
  /**
   * What is made. Default KindHeadCT; other values become the nearest.
   */
  vtkSetClampMacro(Kind, int, KindHeadCT, KindChecker);
  vtkGetMacro(Kind, int);
  void SetKindToHeadCT() { this->SetKind(KindHeadCT); }
  void SetKindToTorsoCT() { this->SetKind(KindTorsoCT); }
  void SetKindToSheppLogan() { this->SetKind(KindSheppLogan); }
  void SetKindToConstant() { this->SetKind(KindConstant); }
  void SetKindToRamp() { this->SetKind(KindRamp); }
  void SetKindToBall() { this->SetKind(KindBall); }
  void SetKindToSoftBall() { this->SetKind(KindSoftBall); }
  void SetKindToSlab() { this->SetKind(KindSlab); }
  void SetKindToChecker() { this->SetKind(KindChecker); }
  ///@}

  ///@{
  /**
   * Voxels along the longest side of the volume (for the scans: z). Voxels are cubes; the other
   * sides get as many as fit, at least 2. Default 256, range 2 to 4096; outside it the nearest end.
   */
  vtkSetClampMacro(Size, int, 2, 4096);
  vtkGetMacro(Size, int);
  ///@}

  ///@{
  /**
   * Of scans: which patient and which noise: the folds of the brain, the sponge of the bones, the
   * scanner's noise. Places and sizes of the organs stay. Default 1, any value.
   */
  vtkSetMacro(Seed, int);
  vtkGetMacro(Seed, int);
  ///@}

  ///@{
  /**
   * Of scans: standard deviation of the scanner's noise, in Hounsfield units: Gaussian, and
   * independent in each voxel. Default 10, as a usual head scan has; 0 is none. Range 0 to 1000;
   * outside it the nearest end.
   */
  vtkSetClampMacro(NoiseLevel, double, 0.0, 1000.0);
  vtkGetMacro(NoiseLevel, double);
  ///@}

  ///@{
  /**
   * Width over which a tissue passes into the next, in voxels: the partial volume of a voxel and
   * the blur of a scanner. Of fields with edges each voxel is the mean of a cube so wide;
   * GetOpticalDepth is always that of the sharp field. Default 2, range 0.1 to 10; outside it the
   * nearest end. Small widths give stairs.
   */
  vtkSetClampMacro(EdgeWidth, double, 0.1, 10.0);
  vtkGetMacro(EdgeWidth, double);
  ///@}

  ///@{
  /**
   * Of the fields, but SheppLogan: the density, without a unit. Default 1, range 0 to 1e6; outside
   * it the nearest end.
   */
  vtkSetClampMacro(Density, double, 0.0, 1e6);
  vtkGetMacro(Density, double);
  ///@}

  ///@{
  /**
   * Of SheppLogan: on, the default, raised contrast (Yu, Ye and Wang 2004); off, densities relative
   * to water (Kak and Slaney 1988).
   */
  vtkSetMacro(RaisedContrast, bool);
  vtkGetMacro(RaisedContrast, bool);
  vtkBooleanMacro(RaisedContrast, bool);
  ///@}

  ///@{
  /**
   * Of Ball and SoftBall: the radius, world units. Default 0.8, range 1e-3 to 1; outside it the
   * nearest end.
   */
  vtkSetClampMacro(Radius, double, 1e-3, 1.0);
  vtkGetMacro(Radius, double);
  ///@}

  ///@{
  /**
   * Of Slab: the distance between its planes, world units (default 0.5, range 1e-3 to 4; outside it
   * the nearest end), and their normal (default along z; not of length 0, any length else).
   */
  vtkSetClampMacro(Thickness, double, 1e-3, 4.0);
  vtkGetMacro(Thickness, double);
  vtkSetVector3Macro(Normal, double);
  vtkGetVector3Macro(Normal, double);
  ///@}

  ///@{
  /**
   * Of Checker: cells along each axis. Default 8, range 1 to 1000; outside it the nearest end.
   */
  vtkSetClampMacro(Cells, int, 1, 1000);
  vtkGetMacro(Cells, int);
  ///@}

  /**
   * Of the fields: the exact integral of the density along the ray origin + s
   * direction/|direction|, from s = `from` to `to` in world units (both may be infinite). With an
   * extinction per world unit it is the optical depth once multiplied by that. Not a number for
   * scans, for a direction of length 0 and for settings that make no field.
   */
  double GetOpticalDepth(const double origin[3], const double direction[3], double from, double to);

protected:
  vtkBrumePhantomSource();
  ~vtkBrumePhantomSource() override;

  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

  int Kind = KindHeadCT;
  int Size = 256;
  int Seed = 1;
  double NoiseLevel = 10.0;
  double EdgeWidth = 2.0;
  double Density = 1.0;
  bool RaisedContrast = true;
  double Radius = 0.8;
  double Thickness = 0.5;
  double Normal[3] = { 0.0, 0.0, 1.0 };
  int Cells = 8;

private:
  vtkBrumePhantomSource(const vtkBrumePhantomSource&) = delete;
  void operator=(const vtkBrumePhantomSource&) = delete;

  bool IsScan() const { return this->Kind <= KindTorsoCT; }
  brume::Box GetBox() const;
  std::unique_ptr<brume::ExactField> MakeField() const; // throws std::invalid_argument

  std::shared_ptr<const brume::PaintedVolume> Scan; // kept from piece to piece
  vtkMTimeType ScanTime = 0;                        // this object's time of change when it was made
};

#endif
