/**
 * @class   vtkBrumePhantomSource
 * @brief   a scan that nobody had to be scanned for
 *
 * Gives the CT of a head made of formulas, as a vtkImageData of 16-bit integers in Hounsfield units
 * (air -1000, water 0, enamel 2600; each tissue's number in data-generators/hounsfield.h). Point
 * scalars are named "Hounsfield" and lie in [-1024, 3071].
 *
 * World units are millimetres, coordinates are RAS+: x grows from the patient's left to the
 * patient's right, y from back to front, z from foot to crown, with the origin at the middle of the
 * volume (DICOM's axes are LPS: x and y the other way). The volume fills a box of 192 x 240 x 256
 * mm, so that Size = 256 gives 192 x 240 x 256 voxels of 1 mm. To tell left from right there is a
 * ceramic bead (4 mm radius, 2800 HU) on the patient's left temple, at (-75, 22, 24). What anatomy
 * there is: data-generators/head_ct.h.
 *
 * The source makes the pieces that it is asked for; together they equal the whole, to the bit. The
 * same settings give the same bytes on every machine and with any number of threads. It reports
 * progress, and stops soon after AbortExecute is set: the output is then empty, and the next update
 * starts over.
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
class HeadCT;
}

class VTKBRUMESOURCES_EXPORT vtkBrumePhantomSource : public vtkImageAlgorithm
{
public:
  static vtkBrumePhantomSource* New();
  vtkTypeMacro(vtkBrumePhantomSource, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum Kinds
  {
    KindHeadCT = 0 ///< CT of a head, with contrast medium in its vessels
  };

  ///@{
  /**
   * What is scanned. Default KindHeadCT, at present the only one; other values become the nearest.
   */
  vtkSetClampMacro(Kind, int, KindHeadCT, KindHeadCT);
  vtkGetMacro(Kind, int);
  void SetKindToHeadCT() { this->SetKind(KindHeadCT); }
  ///@}

  ///@{
  /**
   * Voxels along the longest side of the volume (for the head: z). Voxels are cubes; the other
   * sides get as many as fit, at least 2. Default 256, range 2 to 4096; outside it the nearest end.
   */
  vtkSetClampMacro(Size, int, 2, 4096);
  vtkGetMacro(Size, int);
  ///@}

  ///@{
  /**
   * Which patient and which noise: the folds of the brain, the sponge of the bones, the scanner's
   * noise. Places and sizes of the organs stay. Default 1, any value.
   */
  vtkSetMacro(Seed, int);
  vtkGetMacro(Seed, int);
  ///@}

  ///@{
  /**
   * Standard deviation of the scanner's noise, in Hounsfield units: Gaussian, and independent in
   * each voxel. Default 10, as a usual head scan has; 0 is none. Range 0 to 1000; outside it the
   * nearest end.
   */
  vtkSetClampMacro(NoiseLevel, double, 0.0, 1000.0);
  vtkGetMacro(NoiseLevel, double);
  ///@}

  ///@{
  /**
   * Width over which a tissue passes into the next, in voxels: the partial volume of a voxel and
   * the blur of a scanner. Default 2, range 0.1 to 10; outside it the nearest end. Small widths
   * give stairs.
   */
  vtkSetClampMacro(EdgeWidth, double, 0.1, 10.0);
  vtkGetMacro(EdgeWidth, double);
  ///@}

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

private:
  vtkBrumePhantomSource(const vtkBrumePhantomSource&) = delete;
  void operator=(const vtkBrumePhantomSource&) = delete;

  std::unique_ptr<brume::HeadCT> Head; // kept from piece to piece
  vtkMTimeType HeadTime = 0;           // this object's time of change when it was made
};

#endif
