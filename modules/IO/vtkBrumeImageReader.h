/**
 * @class vtkBrumeImageReader
 * @brief Reads a scan or any other volume on a regular grid, upright and to scale.
 *
 * Opens DICOM (files, and folders with any below them), NIfTI-1, NIfTI-2 and Analyze 7.5 (.nii,
 * .nii.gz, .hdr with .img), MetaImage (.mha, .mhd), NRRD (.nrrd, .nhdr), TIFF of several pages,
 * numbered TIFF or PNG pictures and folders of them, raw voxels with a sidecar, VTK XML image data
 * (.vti) and legacy VTK structured points (.vtk). The format is found in the file's content; its name
 * counts only where the content says nothing.
 *
 * The output is one vtkImageData with point scalars. Spacing, origin and direction matrix are set,
 * so that world = origin + direction * (spacing ∘ ijk). Where the format tells how the patient
 * lies, the world is RAS+ in millimetres: x grows to the patient's right, y to the front, z
 * upwards; see GetPatientAxes(). The direction matrix is always a rotation: a left-handed file has
 * one index axis reversed in memory (docs/user/input.md tells which, and gives each format's rule).
 * Values are those the file means: a slope and intercept in the header are applied, and the
 * scalars are then float (double for stored integers of 32 bits or more and for doubles).
 *
 * Nothing of the volume's size is allocated before the header has been checked against the length
 * of the file. When something is wrong, the output is empty, ErrorEvent is invoked, and
 * GetErrorMessage() holds one line. No message of an inner reader reaches the standard error
 * stream; with an observer of ErrorEvent on this object, nothing at all does. To that end,
 * VTK's own readers (.vti, and rare layouts of .vtk), OpenImageIO (pictures) and GDCM (compressed
 * DICOM) run in a process of their own, with bounds on time and memory: what a damaged file does to
 * them stays there.
 */
#ifndef vtkBrumeImageReader_h
#define vtkBrumeImageReader_h

#include "vtkBrumeIOModule.h"
#include "vtkImageAlgorithm.h"

#include <memory>

class VTKBRUMEIO_EXPORT vtkBrumeImageReader : public vtkImageAlgorithm
{
public:
  static vtkBrumeImageReader* New();
  vtkTypeMacro(vtkBrumeImageReader, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The file to read: for a pair of header and data (.hdr/.img, .mhd, .nhdr) the header; of
   * .hdr/.img either; of DICOM a file or a folder, with all that is below it. A name that is no file and holds %d, %04d, #### or * in place of a number stands
   * for a series over time, one file a volume, at the times that their numbers are; of pictures of one
   * page for their stack. Default: none.
   */
  vtkSetFilePathMacro(FileName);
  vtkGetFilePathMacro(FileName);
  ///@}

  ///@{
  /**
   * Of a folder that holds several series: the one to read, by its number from 1 on in the list
   * that the error without a choice gives, or by its UID. Default: none, which reads the only one.
   */
  vtkSetStringMacro(Series);
  vtkGetStringMacro(Series);
  ///@}

  ///@{
  /**
   * The series of a folder of DICOM, known after UpdateInformation() whether or not it succeeded:
   * what people know them by ("CT, Head 5.0, 512 x 512 x 40"), and their UIDs. The index is one less
   * than the number that SetSeries() takes. Null for an index that there is not.
   */
  int GetNumberOfSeries() const;
  const char* GetNameOfSeries(int index) const;
  const char* GetUIDOfSeries(int index) const;
  ///@}

  ///@{
  /**
   * The most bytes that reading may take: stored numbers and values together. A file that would take
   * more is an error before anything of that size is allocated. Default: 0, three quarters of the
   * machine's memory.
   */
  vtkSetClampMacro(MaximumMemory, vtkTypeInt64, 0, VTK_TYPE_INT64_MAX);
  vtkGetMacro(MaximumMemory, vtkTypeInt64);
  ///@}

  /**
   * What went wrong in the last update, "FILE: what is wrong: what to do", without a line end;
   * empty when nothing did. Valid until the next update.
   */
  const char* GetErrorMessage() const;

  ///@{
  /**
   * What the reader settled by itself in the last update and the user may want to know, one line
   * each: "a series of 4 volumes, at 0 to 6 s; that at 0 is taken". GetMessage returns null beyond the last.
   */
  int GetNumberOfMessages() const;
  const char* GetMessage(int index) const;
  ///@}

  /** The format, for people: "NIfTI-1 (gzip)". Empty before an update. */
  const char* GetFormat() const;

  /** Unit of spacing and origin: "mm", or as the format names it; empty where it names none. */
  const char* GetLengthUnit() const;

  /**
   * Unit of the times of a series: "s", or as the format names it; empty where it names none. The
   * times themselves are the output information's TIME_STEPS(), which is there where the file holds
   * more than one volume; the volume whose time is nearest to UPDATE_TIME_STEP() is read, without a
   * request the first.
   */
  const char* GetTimeUnit() const;

  /** Unit of the values: "HU" for a CT that says so, or as the format names it; empty if unknown. */
  const char* GetValueUnit() const;

  /**
   * Whether the file told how the patient lies, so that the world's axes are the patient's (RAS+,
   * mm). Otherwise the axes are the file's own.
   */
  bool GetPatientAxes() const;

  /** Whether a file's content is of a format that this class reads. Never reports an error. */
  static bool CanReadFile(const char* path);

protected:
  vtkBrumeImageReader();
  ~vtkBrumeImageReader() override;
  int RequestInformation(
    vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector) override;
  int RequestData(
    vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector) override;

  char* FileName = nullptr;
  char* Series = nullptr;
  vtkTypeInt64 MaximumMemory = 0;

private:
  vtkBrumeImageReader(const vtkBrumeImageReader&) = delete;
  void operator=(const vtkBrumeImageReader&) = delete;

  struct Internals;
  std::unique_ptr<Internals> Internal;
};

#endif
