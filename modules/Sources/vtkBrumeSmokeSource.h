/**
 * @class   vtkBrumeSmokeSource
 * @brief   a plume of hot smoke: density and temperature
 *
 * Gives a vtkImageData with two arrays of floats on its points: "density", the scalars, in [0, 1]
 * without a unit (multiply by an extinction, 4 to 20 per metre for the default width), and
 * "temperature" in kelvin. vtkBrumeMedium makes it glow by both.
 *
 * World units are metres: the volume fills a box of Width x Width x 2 Width, x and y around 0, z up
 * from 0. Nothing of the smoke comes nearer to the box's faces than 0.02 Width. The formula and its
 * sources: data-generators/plume.h.
 *
 * The source makes the pieces that it is asked for; together they equal the whole, to the bit. The
 * same settings give the same bytes on every machine and with any number of threads. It reports
 * progress, and stops soon after AbortExecute is set: the output is then empty, and the next update
 * starts over. A setting that is not a number is an error, and gives an empty output.
 *
 * @sa vtkBrumeCloudSource
 */
#ifndef vtkBrumeSmokeSource_h
#define vtkBrumeSmokeSource_h

#include "vtkBrumeSourcesModule.h" // for the export macro
#include "vtkImageAlgorithm.h"

namespace brume
{
struct PlumeOptions;
}

class VTKBRUMESOURCES_EXPORT vtkBrumeSmokeSource : public vtkImageAlgorithm
{
public:
  static vtkBrumeSmokeSource* New();
  vtkTypeMacro(vtkBrumeSmokeSource, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Voxels along the longest side of the volume (z). Voxels are cubes. Default 256, range 2 to
   * 4096; outside it the nearest end.
   */
  vtkSetClampMacro(Size, int, 2, 4096);
  vtkGetMacro(Size, int);
  ///@}

  ///@{
  /**
   * Which plume. Default 1, any value.
   */
  vtkSetMacro(Seed, int);
  vtkGetMacro(Seed, int);
  ///@}

  ///@{
  /**
   * The moment that is made where the pipeline asks for none (UPDATE_TIME_STEP), in seconds: the
   * turbulence has risen for so long. Default 0, any finite value.
   */
  vtkSetMacro(Time, double);
  vtkGetMacro(Time, double);
  ///@}

  ///@{
  /**
   * The moments that the pipeline is told of (TIME_STEPS): so many, evenly from StartTime to
   * EndTime, in seconds. Any other moment can be asked for, too. Default 101 from 0 to 10; the
   * number from 1 to 1e6, outside it the nearest end. An EndTime that is not after StartTime leaves
   * StartTime alone.
   */
  vtkSetMacro(StartTime, double);
  vtkGetMacro(StartTime, double);
  vtkSetMacro(EndTime, double);
  vtkGetMacro(EndTime, double);
  vtkSetClampMacro(NumberOfTimeSteps, int, 1, 1000000);
  vtkGetMacro(NumberOfTimeSteps, int);
  ///@}

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

protected:
  vtkBrumeSmokeSource();
  ~vtkBrumeSmokeSource() override;

  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

  int Size = 256;
  int Seed = 1;
  double Time = 0.0;
  double StartTime = 0.0;
  double EndTime = 10.0;
  int NumberOfTimeSteps = 101;
  double Width = 4.0;
  double Rise = 1.2;
  double AirTemperature = 300.0;
  double SourceTemperature = 1900.0;

private:
  vtkBrumeSmokeSource(const vtkBrumeSmokeSource&) = delete;
  void operator=(const vtkBrumeSmokeSource&) = delete;

  brume::PlumeOptions GetOptions() const;
};

#endif
