/**
 * @class vtkBrumeOpenVDBWriter
 * @brief Writes volumes, sparse or dense, as the grids of an OpenVDB file.
 *
 * Each input connection gives one grid of floats, or, of a vtkImageData with several arrays of one
 * component on its points, one grid an array. Their names are those of the volumes and arrays,
 * "density" where there is none.
 *
 * A vtkBrumeSparseVolume stays sparse: bricks become leaves, tiles stay tiles, the matrix from
 * index to world is kept whatever it is (scaled, rotated, sheared, mirrored), and so is every
 * value. OpenVDB's mark of active voxels is set where a value differs from the background (of a
 * level set: where it is nearer to the surface than the background), since sparse volumes do not
 * keep it.
 *
 * Of a vtkImageData voxels within Tolerance of Background become background and inactive, and take
 * no space; blocks of 8³ of one value become tiles. Voxel (i, j, k) of its extent is the grid's,
 * under the image's spacing, origin and direction. A dense volume ends at its outer voxels, a
 * sparse one falls off to the background beyond them.
 *
 * Numbers other than float are rounded to single precision. Units and a patient's axes go into
 * metadata (length_unit, value_unit, axes) that vtkBrumeOpenVDBReader reads. What could not be held
 * is told by GetMessage().
 *
 * The file is written beside its place and moved there when it is whole; after an error, or when
 * AbortExecute is set in an observer of ProgressEvent, there is the old one or none. When something
 * is wrong ErrorEvent is invoked and GetErrorMessage() holds one line; Write() then returns 0.
 */
#ifndef vtkBrumeOpenVDBWriter_h
#define vtkBrumeOpenVDBWriter_h

#include "vtkBrumeIOModule.h"
#include "vtkWriter.h"

#include <memory> // for std::unique_ptr
#include <string> // for std::string

class VTKBRUMEIO_EXPORT vtkBrumeOpenVDBWriter : public vtkWriter
{
public:
  static vtkBrumeOpenVDBWriter* New();
  vtkTypeMacro(vtkBrumeOpenVDBWriter, vtkWriter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The file to write, whatever its ending. Default: none.
   */
  vtkSetFilePathMacro(FileName);
  vtkGetFilePathMacro(FileName);
  ///@}

  ///@{
  /**
   * Whether values are written in half precision: 11 bits, up to 65504. Default: off, which still
   * keeps a sparse volume that is in half precision as it is.
   */
  vtkSetMacro(Half, bool);
  vtkGetMacro(Half, bool);
  vtkBooleanMacro(Half, bool);
  ///@}

  ///@{
  /**
   * Of dense volumes, the value of what is not stored, and how far from it a value may be to be
   * left out. Defaults: 0 and 0, in the units of the values; Tolerance is 0 or more. Sparse volumes
   * have a background of their own.
   */
  vtkSetMacro(Background, double);
  vtkGetMacro(Background, double);
  vtkSetClampMacro(Tolerance, double, 0.0, 1e300);
  vtkGetMacro(Tolerance, double);
  ///@}

  ///@{
  /**
   * The background of the arrays of this name alone, such as the air's of a "temperature". Default:
   * none has one of its own.
   */
  void SetArrayBackground(const char* name, double background);
  void ClearArrayBackgrounds();
  ///@}

  /** What OpenVDB says that the values are. */
  enum GridClasses
  {
    GridClassAutomatic =
      0, ///< as a sparse volume has it; of dense ones fog unless a value is negative
    GridClassUnknown = 1,
    GridClassFogVolume = 2, ///< a density, 0 where there is nothing
    GridClassLevelSet = 3   ///< the distance to a surface, in world units, negative within
  };
  ///@{
  /**
   * The class of all grids. Default: automatic. A dense volume that becomes a level set is cut to a
   * band around the surface: distances beyond BandWidth become that width, negative within, and
   * inactive; Background and Tolerance are not used.
   */
  vtkSetClampMacro(GridClass, int, GridClassAutomatic, GridClassLevelSet);
  vtkGetMacro(GridClass, int);
  ///@}

  ///@{
  /**
   * The half width of a level set's band, in world units. Default 0: three times the longest edge
   * of a voxel, as OpenVDB has it. 0 or more.
   */
  vtkSetClampMacro(BandWidth, double, 0.0, 1e300);
  vtkGetMacro(BandWidth, double);
  ///@}

  ///@{
  /**
   * The unit of spacing and origin ("mm", "m"), and that of the values ("HU"); empty: unknown.
   */
  vtkSetStdStringFromCharMacro(LengthUnit);
  vtkGetCharFromStdStringMacro(LengthUnit);
  vtkSetStdStringFromCharMacro(ValueUnit);
  vtkGetCharFromStdStringMacro(ValueUnit);
  ///@}

  ///@{
  /**
   * Whether the world's axes are a patient's (RAS+). Default: off.
   */
  vtkSetMacro(PatientAxes, bool);
  vtkGetMacro(PatientAxes, bool);
  vtkBooleanMacro(PatientAxes, bool);
  ///@}

  /**
   * What went wrong in the last Write(), "FILE: what is wrong: what to do"; empty when nothing did.
   */
  const char* GetErrorMessage() const;

  ///@{
  /**
   * What the format could not hold in the last Write(), one line each; null beyond the last.
   */
  int GetNumberOfMessages() const;
  const char* GetMessage(int index) const;
  ///@}

protected:
  vtkBrumeOpenVDBWriter();
  ~vtkBrumeOpenVDBWriter() override;
  int FillInputPortInformation(int port, vtkInformation* info) override;
  void WriteData() override;

  char* FileName = nullptr;
  bool Half = false;
  double Background = 0.0;
  double Tolerance = 0.0;
  int GridClass = GridClassAutomatic;
  double BandWidth = 0.0;
  std::string LengthUnit;
  std::string ValueUnit;
  bool PatientAxes = false;

private:
  vtkBrumeOpenVDBWriter(const vtkBrumeOpenVDBWriter&) = delete;
  void operator=(const vtkBrumeOpenVDBWriter&) = delete;

  struct Internals;
  std::unique_ptr<Internals> Internal;
};

#endif
