/**
 * @class   vtkBrumeSampledSource
 * @brief   a scalar that is a function of place, sampled dense or sparse
 *
 * What the sources of clouds, fog, particles, smoke and shapes have in common: they give one scalar
 * at the voxels of a grid.
 *
 * Dense (the default) the output is a vtkImageData of floats: the source makes the pieces that it
 * is asked for; together they equal the whole, to the bit. Sparse (SparseOn()) it is a
 * vtkBrumeSparseVolume with voxels only where there is something, made without a dense volume on
 * the way; it has no extents, and is whole for piece 0 and empty for all others. Either holds the
 * same voxels (but for distances, see vtkBrumeSignedDistanceSource). Where nothing is to be seen a
 * sparse volume has no voxels.
 *
 * The same settings give the same bytes on every machine and with any number of threads. The source
 * reports progress, and stops soon after AbortExecute is set: the output is then empty, and the
 * next update starts over. A setting that makes no volume is an error, and gives an empty output.
 *
 * @sa vtkBrumeFieldSource, for what depends on chance and moves
 */
#ifndef vtkBrumeSampledSource_h
#define vtkBrumeSampledSource_h

#include "vtkBrumeSourcesModule.h" // for the export macro
#include "vtkImageAlgorithm.h"

#include <memory> // for the field that is kept

class vtkBrumeSparseVolume;

namespace brume
{
class Field;
struct Lattice;
}

class VTKBRUMESOURCES_EXPORT vtkBrumeSampledSource : public vtkImageAlgorithm
{
public:
  vtkTypeMacro(vtkBrumeSampledSource, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Voxels along the longest side of the volume. Voxels are cubes; the other sides get as many as
   * fit, at least 2. Default 256 (of particles and shapes 128), range 2 to 4096; outside it the
   * nearest end.
   */
  vtkSetClampMacro(Size, int, 2, 4096);
  vtkGetMacro(Size, int);
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
  vtkBrumeSampledSource();
  ~vtkBrumeSampledSource() override;

  /**
   * The field of the present settings, whose bounds are the volume's. Throws std::invalid_argument
   * where they make none.
   */
  virtual std::shared_ptr<const brume::Field> MakeField() = 0;

  /**
   * The time of the last change of what the field is made from.
   */
  virtual vtkMTimeType GetFieldMTime();

  /**
   * What the output's scalars are called, and of a sparse one the value of "nothing" and the class
   * (vtkBrumeSparseVolume::GridClasses). Here "density", 0 and a fog volume.
   */
  virtual const char* GetFieldName() const;
  virtual float GetFieldBackground() const;
  virtual int GetFieldGridClass() const;

  /**
   * Tells the pipeline of the moments, of what moves, and gives the moment that it asks for. Here
   * there are none, and the moment is 0. The first throws std::invalid_argument.
   */
  virtual void DescribeTime(vtkInformation* info);
  virtual double GetMoment(vtkInformation* info);

  /**
   * Does what comes before the values of a moment, with progress from 0 to GetPreparedShare();
   * false where it was stopped. Here nothing, and 0.
   */
  virtual bool Prepare(const brume::Field& field, double time);
  virtual double GetPreparedShare() const;

  /**
   * Fills the output, which is allocated, and not empty, with a block of the field; false where it
   * was stopped. Here by brume::sample().
   */
  virtual bool FillImage(vtkImageData* image,
    const brume::Field& field,
    const brume::Lattice& grid,
    double time);

  int FillOutputPortInformation(int, vtkInformation*) override;
  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

  /**
   * The field, made anew where it changed.
   */
  const brume::Field& GetField();

  int Size = 256;
  bool Sparse = false;

private:
  vtkBrumeSampledSource(const vtkBrumeSampledSource&) = delete;
  void operator=(const vtkBrumeSampledSource&) = delete;

  std::shared_ptr<const brume::Field> Kept; // from piece to piece
  vtkMTimeType KeptTime = 0;                // what GetFieldMTime() was when it was made
};

#endif
