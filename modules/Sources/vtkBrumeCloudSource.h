/**
 * @class   vtkBrumeCloudSource
 * @brief   a cumulus: flat base, cauliflower top, wispy edges
 *
 * Gives the density of a fair-weather cloud as a vtkImageData of floats. Point scalars are named
 * "density" and lie in [0, 1], without a unit: multiply by an extinction per metre (0.02 to 0.1 for
 * real cumulus) to get the medium's extinction.
 *
 * World units are metres: the volume fills a box of Width x Width x 0.6 Width, x and y around 0, z
 * up from 0. The cloud's base is at 0.08 Width. Nothing of the cloud comes nearer to the box's
 * faces than 0.02 Width, so from Size = 26 on all outer voxels are exactly 0. The formula and its
 * sources: data-generators/cumulus.h.
 *
 * The source makes the pieces that it is asked for; together they equal the whole, to the bit. The
 * same settings give the same bytes on every machine and with any number of threads. It reports
 * progress, and stops soon after AbortExecute is set: the output is then empty, and the next update
 * starts over. A setting that is not a number is an error, and gives an empty output.
 *
 * @sa vtkBrumePhantomSource
 */
#ifndef vtkBrumeCloudSource_h
#define vtkBrumeCloudSource_h

#include "vtkBrumeSourcesModule.h" // for the export macro
#include "vtkImageAlgorithm.h"

#include <memory> // for the cloud that is kept

namespace brume
{
class Cumulus;
}

class VTKBRUMESOURCES_EXPORT vtkBrumeCloudSource : public vtkImageAlgorithm
{
public:
  static vtkBrumeCloudSource* New();
  vtkTypeMacro(vtkBrumeCloudSource, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Voxels along the longest side of the volume (x and y). Voxels are cubes. Default 256, range 2
   * to 4096; outside it the nearest end.
   */
  vtkSetClampMacro(Size, int, 2, 4096);
  vtkGetMacro(Size, int);
  ///@}

  ///@{
  /**
   * Which cloud. Default 1, any value.
   */
  vtkSetMacro(Seed, int);
  vtkGetMacro(Seed, int);
  ///@}

  ///@{
  /**
   * The moment, in seconds: the wind has carried the noise through the cloud for so long. The cloud
   * boils, and stays in its box. Default 0, any finite value.
   */
  vtkSetMacro(Time, double);
  vtkGetMacro(Time, double);
  ///@}

  ///@{
  /**
   * Width of the box, in metres. The cloud grows with it, its detail (DetailSize, WarpSize,
   * WarpAmplitude) does not. Default 2000, range 1 to 1e6; outside it the nearest end.
   */
  vtkSetClampMacro(Width, double, 1.0, 1e6);
  vtkGetMacro(Width, double);
  ///@}

  ///@{
  /**
   * Size of the largest bulges of the noise, in metres. Default 160, range 0.1 to 1e6; outside it
   * the nearest end.
   */
  vtkSetClampMacro(DetailSize, double, 0.1, 1e6);
  vtkGetMacro(DetailSize, double);
  ///@}

  ///@{
  /**
   * Octaves of the noise, each half as large and half as strong as the one before. Default 5, range
   * 1 to 8; outside it the nearest end. More costs time, and shows only if voxels are small enough.
   */
  vtkSetClampMacro(Octaves, int, 1, 8);
  vtkGetMacro(Octaves, int);
  ///@}

  ///@{
  /**
   * How much cloud there is where the noise is 0: larger fills the cloud and smooths it, smaller
   * frays it. Without a unit, default 0.12, range 0 to 1; outside it the nearest end.
   */
  vtkSetClampMacro(Offset, double, 0.0, 1.0);
  vtkGetMacro(Offset, double);
  ///@}

  ///@{
  /**
   * How fast density climbs to 1 behind the cloud's edge: large is crisp, small is soft. Without a
   * unit, default 4, range 0.1 to 100; outside it the nearest end.
   */
  vtkSetClampMacro(Crispness, double, 0.1, 100.0);
  vtkGetMacro(Crispness, double);
  ///@}

  ///@{
  /**
   * The domain warp: how far, at most and along each axis, the noise pushes the cloud about, in
   * metres. Default 50, 0 is none; a negative one counts as 0, more than 0.06 Width as 0.06 Width.
   */
  vtkSetMacro(WarpAmplitude, double);
  vtkGetMacro(WarpAmplitude, double);
  ///@}

  ///@{
  /**
   * Size of the domain warp's eddies, in metres. Default 300, range 0.1 to 1e6; outside it the
   * nearest end.
   */
  vtkSetClampMacro(WarpSize, double, 0.1, 1e6);
  vtkGetMacro(WarpSize, double);
  ///@}

  ///@{
  /**
   * The wind that carries the noise, in metres a second along x, y and z. Default (4, 1, 1.5), any
   * finite value.
   */
  vtkSetVector3Macro(Wind, double);
  vtkGetVector3Macro(Wind, double);
  ///@}

protected:
  vtkBrumeCloudSource();
  ~vtkBrumeCloudSource() override;

  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

  int Size = 256;
  int Seed = 1;
  double Time = 0.0;
  double Width = 2000.0;
  double DetailSize = 160.0;
  int Octaves = 5;
  double Offset = 0.12;
  double Crispness = 4.0;
  double WarpAmplitude = 50.0;
  double WarpSize = 300.0;
  double Wind[3] = { 4.0, 1.0, 1.5 };

private:
  vtkBrumeCloudSource(const vtkBrumeCloudSource&) = delete;
  void operator=(const vtkBrumeCloudSource&) = delete;

  // The cloud of the present settings; throws std::invalid_argument where they make none.
  const brume::Cumulus& GetCloud();

  std::unique_ptr<brume::Cumulus> Cloud; // kept from piece to piece
  vtkMTimeType CloudTime = 0;            // this object's time of change when it was made
};

#endif
