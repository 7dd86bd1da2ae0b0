/**
 * @class vtkBrumeEnvironmentReader
 * @brief Reads a picture of light from all around, for vtkBrumeSky.
 *
 * Opens OpenEXR and Radiance HDR files (by their content, whatever their name) that hold a
 * latitude–longitude map: twice as wide as high, linear light, channels R, G and B. The output is
 * a vtkImageData of one slice with the point scalars "radiance", 3 components of float, rows from
 * the bottom up, as vtkBrumeSky::SetEnvironmentMap takes it:
 *
 * @code
 * vtkNew<vtkBrumeEnvironmentReader> reader;
 * reader->SetFileName("sky.hdr");
 * reader->Update();
 * sky->SetEnvironmentMap(reader->GetOutput());
 * @endcode
 *
 * When something is wrong the output is empty, ErrorEvent is invoked, and GetErrorMessage() holds
 * one line.
 */
#ifndef vtkBrumeEnvironmentReader_h
#define vtkBrumeEnvironmentReader_h

#include "vtkBrumeIOModule.h"
#include "vtkImageAlgorithm.h"

#include <memory> // for std::unique_ptr

class VTKBRUMEIO_EXPORT vtkBrumeEnvironmentReader : public vtkImageAlgorithm
{
public:
  static vtkBrumeEnvironmentReader* New();
  vtkTypeMacro(vtkBrumeEnvironmentReader, vtkImageAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The file to read. Default: none.
   */
  vtkSetFilePathMacro(FileName);
  vtkGetFilePathMacro(FileName);
  ///@}

  ///@{
  /**
   * The most bytes that reading may take; a picture that would take more is an error. Default: 0,
   * three quarters of the machine's memory.
   */
  vtkSetClampMacro(MaximumMemory, vtkTypeInt64, 0, VTK_TYPE_INT64_MAX);
  vtkGetMacro(MaximumMemory, vtkTypeInt64);
  ///@}

  /**
   * What went wrong in the last update, "FILE: what is wrong: what to do", without a line end;
   * empty when nothing did. Valid until the next update.
   */
  const char* GetErrorMessage() const;

protected:
  vtkBrumeEnvironmentReader();
  ~vtkBrumeEnvironmentReader() override;
  int RequestInformation(vtkInformation*,
    vtkInformationVector**,
    vtkInformationVector* outputVector) override;
  int RequestData(vtkInformation*,
    vtkInformationVector**,
    vtkInformationVector* outputVector) override;

  char* FileName = nullptr;
  vtkTypeInt64 MaximumMemory = 0;

private:
  vtkBrumeEnvironmentReader(const vtkBrumeEnvironmentReader&) = delete;
  void operator=(const vtkBrumeEnvironmentReader&) = delete;

  struct Internals;
  std::unique_ptr<Internals> Internal;
};

#endif
