/**
 * @class   vtkBrumeFieldSource
 * @brief   a density that is a function of place and time, sampled dense or sparse
 *
 * What vtkBrumeCloudSource and vtkBrumeFogSource have in common. Gives a density in [0, 1], without
 * a unit, named "density": multiply by an extinction per metre to get the medium's extinction.
 * World units are metres and seconds, z is up.
 *
 * Dense (the default) the output is a vtkImageData of floats: the source makes the pieces that it
 * is asked for; together they equal the whole, to the bit. Sparse (SparseOn()) it is a
 * vtkBrumeSparseVolume with voxels only where there is something, made without a dense volume on
 * the way; it has no extents, and is whole for piece 0 and empty for all others. Either holds the
 * same voxels. Where nothing is to be seen a sparse volume has no voxels.
 *
 * The same settings give the same bytes on every machine and with any number of threads. The source
 * reports progress, and stops soon after AbortExecute is set: the output is then empty, and the
 * next update starts over. A setting that makes no volume is an error, and gives an empty output.
 *
 * Time: the source has TIME_STEPS (NumberOfTimeSteps of them, from StartTime to EndTime) and a
 * TIME_RANGE. Any moment can be asked for by UPDATE_TIME_STEP, not those of the steps alone; where
 * none is asked for it is Time. The output carries the moment in DATA_TIME_STEP.
 */
#ifndef vtkBrumeFieldSource_h
#define vtkBrumeFieldSource_h

#include "vtkBrumeSourcesModule.h" // for the export macro
#include "vtkImageAlgorithm.h"

#include <memory> // for the field that is kept

class vtkBrumeSparseVolume;

namespace brume
{
class Field;
}

class VTKBRUMESOURCES_EXPORT vtkBrumeFieldSource : public vtkImageAlgorithm
{
public:
  vtkTypeMacro(vtkBrumeFieldSource, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Voxels along the longest side of the volume. Voxels are cubes; the other sides get as many as
   * fit, at least 2. Default 256, range 2 to 4096; outside it the nearest end.
   */
  vtkSetClampMacro(Size, int, 2, 4096);
  vtkGetMacro(Size, int);
  ///@}

  ///@{
  /**
   * Which one of its kind. Default 1, any value.
   */
  vtkSetMacro(Seed, int);
  vtkGetMacro(Seed, int);
  ///@}

  ///@{
  /**
   * The moment, in seconds, where the pipeline asks for none: the wind has blown for so long.
   * Default 0, any finite value.
   */
  vtkSetMacro(Time, double);
  vtkGetMacro(Time, double);
  ///@}

  ///@{
  /**
   * The moments that the pipeline is told of: so many, evenly from StartTime to EndTime, in
   * seconds. Default 101 from 0 to 100; the number from 1 to 1e6, outside it the nearest end. An
   * EndTime that is not after StartTime leaves StartTime alone.
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
   * Whether the output is a vtkBrumeSparseVolume in place of a vtkImageData. Default off. The
   * output port's data object is another one after this changes: ask for it again.
   */
  vtkSetMacro(Sparse, bool);
  vtkGetMacro(Sparse, bool);
  vtkBooleanMacro(Sparse, bool);
  ///@}

  /**
   * The output where it is sparse; null where it is dense. (GetOutput() is the dense one.)
   */
  vtkBrumeSparseVolume* GetSparseOutput();

  vtkTypeBool ProcessRequest(vtkInformation*,
    vtkInformationVector**,
    vtkInformationVector*) override;

protected:
  vtkBrumeFieldSource();
  ~vtkBrumeFieldSource() override;

  /**
   * The field of the present settings. Throws std::invalid_argument where they make none.
   */
  virtual std::shared_ptr<const brume::Field> MakeField() = 0;

  /**
   * The time of the last change of what the field is made from.
   */
  virtual vtkMTimeType GetFieldMTime();

  int FillOutputPortInformation(int, vtkInformation*) override;
  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

  /**
   * The field, made anew where it changed.
   */
  const brume::Field& GetField();

  int Size = 256;
  int Seed = 1;
  double Time = 0.0;
  double StartTime = 0.0;
  double EndTime = 100.0;
  int NumberOfTimeSteps = 101;
  bool Sparse = false;

private:
  vtkBrumeFieldSource(const vtkBrumeFieldSource&) = delete;
  void operator=(const vtkBrumeFieldSource&) = delete;

  std::shared_ptr<const brume::Field> Kept; // from piece to piece
  vtkMTimeType KeptTime = 0;                // what GetFieldMTime() was when it was made
};

#endif
