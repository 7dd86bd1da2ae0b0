/**
 * @class vtkBrumeOpenVDBReader
 * @brief Reads a grid of an OpenVDB file as a sparse volume.
 *
 * The output is one vtkBrumeSparseVolume. Voxels and tiles go from the file straight into its
 * bricks, on all processors; the volume is never made dense. Floats, floats that were saved in half
 * precision (they stay so in memory) and doubles (rounded to floats) are read, under any affine
 * transform. Values of inactive voxels and tiles count as they do in OpenVDB: as values. Beyond the
 * box around what is stored the volume ends, whatever the background.
 *
 * A level set (distances to a surface) becomes a density, or stays what it is (SetLevelSets). Grids
 * of other types and perspective (frustum) transforms are refused with a word on
 * what to do. When something is wrong the output is empty, ErrorEvent is invoked, and
 * GetErrorMessage() holds one line.
 *
 * Blocks of any of OpenVDB's compressions are decompressed as the voxels are read. A file must not
 * be changed while it is read.
 */
#ifndef vtkBrumeOpenVDBReader_h
#define vtkBrumeOpenVDBReader_h

#include "vtkBrumeIOModule.h"
#include "vtkDataObjectAlgorithm.h"

#include <memory> // for std::unique_ptr

class vtkBrumeSparseVolume;

class VTKBRUMEIO_EXPORT vtkBrumeOpenVDBReader : public vtkDataObjectAlgorithm
{
public:
  static vtkBrumeOpenVDBReader* New();
  vtkTypeMacro(vtkBrumeOpenVDBReader, vtkDataObjectAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The file to read. A name that is no file and holds %d, %04d, #### or * in place of a number stands
   * for a series over time, one file a volume, at the times that their numbers are: the output
   * information's TIME_STEPS(). The one nearest to UPDATE_TIME_STEP() is read, without a request the
   * first. Default: none.
   */
  vtkSetFilePathMacro(FileName);
  vtkGetFilePathMacro(FileName);
  ///@}

  ///@{
  /**
   * The grid to read, by its name; "NAME[1]" is the second of a name. Default: none, which takes
   * the first in the file that can be read, a level set only where there is no other.
   */
  vtkSetStringMacro(GridName);
  vtkGetStringMacro(GridName);
  ///@}

  /** What becomes of a level set. */
  enum LevelSetModes
  {
    LevelSetsAsFog = 0,      ///< a density: 0 outside and at the surface, rising to 1 at the band's
                             ///< depth, 1 below it (openvdb::tools::sdfToFogVolume)
    LevelSetsAsDistances = 1 ///< as it is: world units, negative within, the band's width beyond it
  };
  ///@{
  /**
   * What becomes of level sets. Default: fog.
   */
  vtkSetClampMacro(LevelSets, int, LevelSetsAsFog, LevelSetsAsDistances);
  vtkGetMacro(LevelSets, int);
  ///@}

  ///@{
  /**
   * The most bytes that the sparse voxels may take. A grid that would take more is an error before
   * its voxels are read. Default: 0, three quarters of the machine's memory.
   */
  vtkSetClampMacro(MaximumMemory, vtkTypeInt64, 0, VTK_TYPE_INT64_MAX);
  vtkGetMacro(MaximumMemory, vtkTypeInt64);
  ///@}

  ///@{
  /**
   * What the file holds, known after UpdateInformation(): the names of its grids in their order,
   * the type of their values ("float", "half", "vec3s", …), and what they are ("fog volume", "level
   * set", "unknown"). Null for an index that there is not.
   */
  int GetNumberOfGrids() const;
  const char* GetNameOfGrid(int index) const;
  const char* GetTypeOfGrid(int index) const;
  const char* GetKindOfGrid(int index) const;
  ///@}

  /**
   * Which grid the output is, -1 before an update and after one that failed.
   */
  vtkGetMacro(GridIndex, int);

  ///@{
  /**
   * The units of lengths and values, and whether the world's axes are a patient's (RAS+): what
   * vtkBrumeOpenVDBWriter left in the grid's metadata; empty and false without it.
   */
  const char* GetLengthUnit() const;
  const char* GetValueUnit() const;
  bool GetPatientAxes() const;
  ///@}

  /**
   * What went wrong in the last update, "FILE: what is wrong: what to do", without a line end;
   * empty when nothing did. Valid until the next update.
   */
  const char* GetErrorMessage() const;

  ///@{
  /**
   * What the reader settled by itself in the last update and the user may want to know, one line
   * each. GetMessage returns null beyond the last.
   */
  int GetNumberOfMessages() const;
  const char* GetMessage(int index) const;
  ///@}

  vtkBrumeSparseVolume* GetOutput();

  /** Whether a file's content is OpenVDB's. Never reports an error. */
  static bool CanReadFile(const char* path);

protected:
  vtkBrumeOpenVDBReader();
  ~vtkBrumeOpenVDBReader() override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestDataObject(vtkInformation*,
    vtkInformationVector**,
    vtkInformationVector* outputVector) override;
  int RequestInformation(vtkInformation*,
    vtkInformationVector**,
    vtkInformationVector* outputVector) override;
  int RequestData(vtkInformation*,
    vtkInformationVector**,
    vtkInformationVector* outputVector) override;

  char* FileName = nullptr;
  char* GridName = nullptr;
  int GridIndex = -1;
  int LevelSets = LevelSetsAsFog;
  vtkTypeInt64 MaximumMemory = 0;

private:
  vtkBrumeOpenVDBReader(const vtkBrumeOpenVDBReader&) = delete;
  void operator=(const vtkBrumeOpenVDBReader&) = delete;

  /// Runs work(), and puts what it throws into GetErrorMessage() and vtkErrorMacro.
  template <class Work>
  void Guard(const Work& work);

  struct Internals;
  std::unique_ptr<Internals> Internal;
};

#endif
