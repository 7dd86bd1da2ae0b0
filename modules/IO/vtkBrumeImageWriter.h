/**
 * @class vtkBrumeImageWriter
 * @brief Writes a volume on a regular grid, to scale and upright, in the format its name ends in.
 *
 * | ending | format |
 * |---|---|
 * | .vti | VTK XML image data, with all arrays of the points |
 * | .nrrd | NRRD |
 * | .mha | MetaImage in one file |
 * | .nii, .nii.gz | NIfTI-1 |
 *
 * All but VTI hold the scalars alone. Spacing, origin and direction go into the file's own terms,
 * as vtkBrumeImageReader reads them, so that what is written comes back in its place: left-handed
 * directions too, which come back with an axis stored in reverse. What a format cannot hold, or
 * holds in a way that other programs do not know, is told by GetMessage().
 *
 * A file is written beside its place and moved there when it is whole; after an error, or when
 * AbortExecute is set in an observer of ProgressEvent, there is the old one or none. When something
 * is wrong ErrorEvent is invoked and GetErrorMessage() holds one line; Write() then returns 0.
 */
#ifndef vtkBrumeImageWriter_h
#define vtkBrumeImageWriter_h

#include "vtkBrumeIOModule.h"
#include "vtkWriter.h"

#include <memory> // for std::unique_ptr
#include <string> // for std::string

class vtkImageData;

class VTKBRUMEIO_EXPORT vtkBrumeImageWriter : public vtkWriter
{
public:
  static vtkBrumeImageWriter* New();
  vtkTypeMacro(vtkBrumeImageWriter, vtkWriter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The file to write. Its ending chooses the format. Default: none.
   */
  vtkSetFilePathMacro(FileName);
  vtkGetFilePathMacro(FileName);
  ///@}

  ///@{
  /**
   * The unit of spacing and origin ("mm", "m"), and that of the values ("HU"). Default: empty,
   * which means unknown.
   */
  vtkSetStdStringFromCharMacro(LengthUnit);
  vtkGetCharFromStdStringMacro(LengthUnit);
  vtkSetStdStringFromCharMacro(ValueUnit);
  vtkGetCharFromStdStringMacro(ValueUnit);
  ///@}

  ///@{
  /**
   * Whether the world's axes are a patient's: RAS+, in LengthUnit. Default: off.
   */
  vtkSetMacro(PatientAxes, bool);
  vtkGetMacro(PatientAxes, bool);
  vtkBooleanMacro(PatientAxes, bool);
  ///@}

  ///@{
  /**
   * Whether voxels are deflated: NRRD, MetaImage and VTI, which leave the choice. Default: off.
   */
  vtkSetMacro(Compress, bool);
  vtkGetMacro(Compress, bool);
  vtkBooleanMacro(Compress, bool);
  ///@}

  /** Whether a name ends in one of the above. */
  static bool CanWriteFile(const char* path);

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
  vtkBrumeImageWriter();
  ~vtkBrumeImageWriter() override;
  int FillInputPortInformation(int port, vtkInformation* info) override;
  void WriteData() override;

  char* FileName = nullptr;
  std::string LengthUnit;
  std::string ValueUnit;
  bool PatientAxes = false;
  bool Compress = false;

private:
  vtkBrumeImageWriter(const vtkBrumeImageWriter&) = delete;
  void operator=(const vtkBrumeImageWriter&) = delete;

  void WriteVTI(vtkImageData* image);

  struct Internals;
  std::unique_ptr<Internals> Internal;
};

#endif
